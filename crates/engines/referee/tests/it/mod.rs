//! The tests of this crate by its public items, one program together with its unit tests.

mod cast;
mod cast_margins;
mod cast_ruling;
mod digest;
mod light;
mod margins;
mod verdicts;
mod visibility_margins;
#[path = "../common/wall.rs"]
mod wall;
