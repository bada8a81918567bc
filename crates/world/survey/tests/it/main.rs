//! The tests of this crate, one program.

mod warnings;
mod whereabouts;
