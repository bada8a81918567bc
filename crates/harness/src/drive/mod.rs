//! Whole drives: images of one renderer or of two in lockstep, developed, extracted and mapped; and the folder that a
//! drive leaves behind. (Paper, §7 and §8, figures 11 to 16) `docs/drive.md` describes it.
//!
//! ```text
//! job       what is driven: a scene, its [drive] or a built-in drive, as the rover's plan
//! plan      what the rover is told
//! warnings  what may spoil it
//! chain     its camera: a preset, and what the scene file has in its place
//! eye       step 6 around a renderer: the optics
//! sun       the sun behind the stripes
//! run       frame by frame, one side or two
//! truth     obstacle maps against the true ground
//! pointing  blur against errors of attitude
//! trace     where the two sides part: pixels, edges, cells, labels
//! view      what the camera sees, for people
//! drawing   marks on a page, as SVG
//! paint     SVG as PNG
//! figures   figures 11 to 16 of the paper
//! folder    every file
//! ```

mod animation;
mod chain;
mod drawing;
mod eye;
mod figures;
mod folder;
mod job;
mod page;
mod paint;
mod plan;
mod pointing;
mod run;
mod screen;
mod summary;
mod sun;
#[cfg(test)]
mod tests;
mod trace;
mod truth;
mod view;
mod warnings;

pub use folder::{WrittenDrive, write_drive};
pub use job::{DriveError, DriveJob};
pub use pointing::{Lever, Moved, pointing_table};
pub use run::{DriveProgress, DriveRun, drive};
pub use screen::drive_screen;
pub use summary::drive_json;
pub use trace::{FluxTrace, StageTrace, Trace};
pub use truth::{NoiseLevel, Said, TRUTH_HEAD, TruthMatrix};
