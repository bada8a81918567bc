//! A point cloud against a pack of rays.
//!
//! ```text
//! file       a file of a cloud: PCD, PLY or a bag
//! assign     the ray of each point: by channel and time, by order, or by direction
//! rules      which of these it is, and which other ones a mistake may have followed
//! read       a cloud, its points on their rays, and what is stated by them
//! turn       how a spinning head turns, from its rays and their times
//! fit        numbers of a mistake, from the points
//! mistakes   what a simulator of a sensor may do otherwise
//! ```

mod assign;
mod file;
pub(super) mod fit;
mod mistakes;
mod read;
mod rules;
mod turn;

pub(super) use file::bag_within;
pub use file::{is_bag_of_clouds, is_cloud, no_cloud, stated_points};
pub(super) use mistakes::of_cloud;
pub use read::CloudFacts;
pub(super) use read::{CloudCase, read_cloud_of};
