//! The tests of this crate by its public items, one program together with its unit tests.

mod conventions;
mod honest;
mod lateral;
mod walls;
mod wrong_pencils;
