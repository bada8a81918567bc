//! The tests of this crate by its public items, one program together with its unit tests.

#[path = "../common/mod.rs"]
mod common;
mod drive;
mod ground;
mod motion;
mod pyramids;
mod rules;
