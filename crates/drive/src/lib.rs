//! A whole drive of the rover, on one renderer or on two in lockstep, and what it leaves behind.

mod animation;
mod eye;
mod figures;
mod folder;
mod job;
mod maps;
mod page;
mod picture;
mod pointing;
mod run;
mod screen;
mod summary;
mod sun;
mod trace;
mod truth;
mod view;
mod warnings;

pub use folder::{WrittenDrive, occupancy, posts, write_drive};
pub use job::{DriveError, DriveJob};
pub use maps::camera_info::camera_info;
pub use maps::occupancy::{Occupancy, OccupancyGrid, occupancy_files, write_occupancy};
pub use maps::ply::{MarkedPoint, write_ply};
pub use maps::vectors::{VectorOnMap, vectors_csv, vectors_geojson};
pub use pointing::{Lever, Moved, pointing_table};
pub use run::{DriveProgress, DriveRun, drive};
pub use screen::drive_screen;
pub use summary::drive_json;
pub use sun::Sun;
pub use trace::{FluxTrace, StageTrace, Trace};
pub use truth::{NoiseLevel, Said, TRUTH_HEAD, TruthMatrix};
pub use view::View;

#[cfg(test)]
#[path = "../tests/unit/drive.rs"]
mod tests;
