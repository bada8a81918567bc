//! The tests of this crate by its public items, one program together with its unit tests.

#[path = "../common/mod.rs"]
mod common;
mod flux;
mod maps;
mod visibility;
