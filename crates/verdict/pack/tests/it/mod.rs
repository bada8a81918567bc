//! The tests of this crate by its public items, one program together with its unit tests.

mod check;
mod half;
mod input;
mod manifest;
