//! The tests of this crate by its public items, one program together with its unit tests.

mod lidar;
mod packs;
mod reported;
mod shortest_range;
