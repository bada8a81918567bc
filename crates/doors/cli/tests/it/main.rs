//! The tests of this crate, one program.

mod command;
mod malformed;
