//! The tests of this crate, one program.

mod facing;
mod warnings;
mod whereabouts;
