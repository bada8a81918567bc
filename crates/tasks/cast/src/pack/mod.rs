//! Packs of rays: a mesh, rays on it and their exact answers, for other people's programs.
//!
//! ```text
//! write       the files of a pack, and how many of its rays test what
//! read        a pack, after its digests are checked
//! scan        times, channels and poses of a sensor's scan, beside its rays
//! candidate   another program's arrays
//! unread      files beside these that no name fits
//! clouds/     another program's point cloud
//! lengths     a factor or a length by which arrays are off
//! decimals    arrays that are rounded to decimals
//! moved       errors of lengths that follow from a mesh whose corners are elsewhere
//! steps       the step of which numbers are multiples
//! single      whether wrong values look like those of single precision
//! trial       a question and its stated answers, as mistakes change them
//! arrays      orders, axes and constants for no hit that an array may have
//! mistakes    what a candidate may do otherwise, in words, and what undoes it
//! explain     which of these, or which two, explain why a candidate is wrong
//! kept_answers   whether the answers that a pack keeps are the exact ones
//! check       a candidate against a pack
//! report      the check in the form of every check
//! ```

mod arrays;
mod candidate;
mod check;
mod clouds;
mod decimals;
mod explain;
mod hits_alone;
mod kept_answers;
mod lengths;
mod mistakes;
mod moved;
mod read;
mod report;
mod scan;
mod single;
mod steps;
mod trial;
mod unread;
mod write;

pub use candidate::{CandidateConventions, CloudConventions, read_candidate as read_stated};
pub use check::{AskedBy, CastGround, RayPackChecked, check_ray_pack, check_stated_rays};
pub use clouds::{CloudFacts, is_bag_of_clouds, is_cloud, no_cloud, stated_points};
pub use read::{is_ray_pack, ray_pack_len};
pub use write::{RayPackCounts, write_ray_pack, write_scan_pack};

/// File that marks a pack of rays. It is written last.
const PACK_NAME: &str = "raypack.json";
/// Number of the format of `raypack.json`.
const PACK_FORMAT: u64 = 1;
