//! A point cloud against a pack of rays.
//!
//! ```text
//! file       a file of a cloud: PCD, PLY or a bag
//! assign     the ray of each point: by channel and time, by order, or by direction
//! keys       what the fields of a cloud say of these: channel and time
//! each_key   the same of each by itself, of points that are laid without them
//! beams      the returns of beams with a width, a ray for each
//! numbers    by which rules simulators count them
//! rules      which rule it is, and which other ones a mistake may have followed
//! read       a cloud, its points on their rays, and what is stated by them
//! turn       how a spinning head turns, from its rays and their times
//! fit        numbers of a mistake, from the points
//! list       mistakes in a list, and what undoes most of them
//! mistakes   what a simulator of a sensor may do otherwise
//! places     the same of points in the place of others
//! limits     the same of its ranges, its misses and the steps of its numbers
//! ```

mod assign;
mod beams;
mod each_key;
mod file;
pub(super) mod fit;
mod keys;
mod limits;
mod list;
mod mistakes;
mod numbers;
mod places;
mod read;
mod rules;
mod turn;

pub(super) use beams::BeamQuestion;
pub(super) use file::bag_within;
pub use file::{is_bag_of_clouds, is_cloud, no_cloud, stated_points};
pub(super) use mistakes::of_cloud;
pub use read::CloudFacts;
pub(super) use read::{CloudCase, read_cloud_of};
