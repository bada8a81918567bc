//! What a drive leaves behind, in the formats of those who use it. `docs/drive.md` has the conventions.

mod camera_info;
mod geotiff;
mod occupancy;
mod ply;
mod vectors;
mod yaml;

pub use camera_info::camera_info;
pub use geotiff::write_geotiff;
pub use occupancy::{Occupancy, OccupancyGrid, occupancy_files, write_occupancy};
pub use ply::{MarkedPoint, write_ply};
pub use vectors::{VectorOnMap, vectors_csv, vectors_geojson};
