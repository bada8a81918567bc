//! Any rays on any mesh, answered exactly.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! ```text
//! answers        what is asked, and the answers of the referee
//! columns        the values of first hits that are asked for, an array each
//! cloud          the points that are hit, as PLY and PCD
//! bag            the same as a bag of ROS 2, with the sensor's poses and the clock
//! comparison/    another program's first hits against the exact ones
//! page           the answers as a page that answers when asked
//! pack/          packs of rays: a mesh, rays, exact answers; the check of a candidate, and what explains its mistakes
//! pcd_data       how the points of PCD are stored: as they are, or compressed
//! range_picture  ranges as a picture, and the points from above
//! returns        the returns of beams with a width
//! warnings       what looks wrong in rays and their mesh
//! write          answers as NPY arrays, and their summary
//! text           the answers to one ray, and counts of many, as text and as JSON
//! ```
//!
//! The contract of such a ray, and why its answers can be exact, is on the first page of `raypencil-referee`'s module
//! `cast`; the files are described in `docs/guide/cast.md`.
//!
//! ```
//! use raypencil_cast::{Questions, cast, rays_from_bytes};
//! use raypencil_scene::{Sides, Silent, Triangles};
//!
//! // Two squares of two faces each, at z = 0 and z = 1. A ray through both diagonals meets two faces at a time.
//! let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
//! let vertices = [square(0.0), square(1.0)].concat();
//! let mesh = Triangles::new(vertices, vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])?;
//! let rays = rays_from_bytes(b"0.5,0.5,4,0,0,-1", "here".as_ref())?;
//! let questions = Questions { all: true, ..Questions::default() };
//! let answers = cast(&mesh, &rays.rays, Sides::Both, questions, &Silent);
//! let first = answers.first[0].hit().unwrap();
//! assert_eq!((first.face.0, first.t, first.ties), (2, 3.0, 2));
//! assert_eq!(answers.all.unwrap()[0].iter().map(|group| group.t).collect::<Vec<_>>(), [3.0, 4.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answers;
mod bag;
mod cloud;
mod columns;
mod comparison;
mod layout;
mod pack;
mod page;
mod page_solid;
mod pcd_data;
mod range_picture;
mod returns;
mod scans;
mod text;
mod warnings;
mod write;

pub use answers::{
    AllColumns, Answers, DecidedCounts, FirstHit, GroupAtT, Questions, cast, cast_beside_first, cast_with,
    traced_beside_first,
};
pub use bag::{BagFields, BagForm, write_scan_bag};
pub use cloud::{CloudFrame, CloudMap, write_pcd, write_ply};
pub use columns::{Caster, ColumnsPart, FirstColumns, ReadingCounts, Values};
pub use comparison::{
    CastCounts, CastValue, Comparison, RayVerdict, Stated, StoredErrors, ValueTally, Wrong, compare,
    compare_with, comparison_headline, comparison_json, comparison_text, write_comparison,
};
pub use layout::PageScan;
pub use pack::{
    AskedBy, CandidateConventions, CastGround, CloudConventions, CloudFacts, RayPackChecked, RayPackCounts,
    check_ray_pack, check_stated_rays, is_bag_of_clouds, is_cloud, is_ray_pack, no_cloud, ray_pack_len,
    read_stated, stated_points, write_ray_pack, write_scan_pack,
};
pub use page::{CastPage, ComparedHits, write_cast_page};
pub use pcd_data::PcdData;
pub use range_picture::{range_picture, top_picture};
pub use raypencil_files::{RayArray, rays_from_bytes, read_rays};
pub use raypencil_rosbag::CloudChoice;
pub use returns::{BeamReturn, BeamReturns, Footprint};
pub use scans::{ScansWritten, SetOfScans, write_scans};
pub use text::{counts_text, ray_json, ray_text};
pub use warnings::{CastSeen, MeshHome, cast_warnings, cast_warnings_of, open_edges};
pub use write::{CastSource, write_answers, write_set};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_cast;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
