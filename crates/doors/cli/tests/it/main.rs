//! The tests of this crate, one program.

mod command;
mod folder_walk;
mod malformed;
