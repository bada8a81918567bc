//! The rules of section 7, each alone, on inputs made by hand.

use super::common;

mod between_points;
mod elevation_map;
mod limits;
mod localisation;
mod mapper;
mod mended;
mod obstacle_map;
mod rig;
mod traversability;
mod triangulation;
mod vehicle;
