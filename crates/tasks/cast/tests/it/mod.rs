//! The tests of this crate by its public items, one program together with its unit tests.

mod bags;
mod bounds;
mod cloud;
mod clouds_of_others;
mod columns;
mod lidar;
mod packs;
mod reported;
mod returns;
mod shortest_range;
mod written;
