//! The rules of section 7, each alone, on inputs made by hand.

#[path = "../common/mod.rs"]
mod common;

mod elevation_map;
mod localisation;
mod mapper;
mod mended;
mod obstacle_map;
mod rig;
mod traversability;
mod triangulation;
mod vehicle;
