//! Recording of a drive: images, stripes, points, poses, maps and labels, frame by frame, for other people's programs.
//!
//! `docs/formats/recording.md` describes the files.
//!
//! ```text
//! contents   what is recorded
//! images     digital images, PNG and NPY
//! points     edges and points
//! poses      true, believed and sensed poses
//! sectors    sectors with their reasons, and vectors
//! maps       snapshots of the elevation map
//! ros        the house's things as messages of ROS 2
//! bag        all of them as a bag of ROS 2
//! setup      all that defines the algorithms
//! recording  Recording: all of them, in one folder
//! ```

mod bag;
mod contents;
mod images;
mod maps;
mod points;
mod poses;
#[expect(clippy::module_inception, reason = "the folder is named by what it makes")]
mod recording;
mod ros;
mod sectors;
mod setup;

pub use contents::RecordContents;
pub(crate) use recording::Recording;
