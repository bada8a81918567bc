//! Mutants of a crate, all of them in one build.
//!
//! A crate is rewritten so that every drawn mutant is compiled in, behind a number that the variable `MUTANT` holds:
//!
//! ```text
//! a + b    (match crate::mutant_of_now() { 0..=6 | 9.. => (a + b), 7 => ((a) - (b)), _ => ((a) * (b)) })
//! ```
//!
//! So the compiler runs a few times for the whole crate, not once for each mutant, and then the tests run once for each.
//!
//! ```text
//! kinds      other operators, and values that a function gives at once
//! places     the places of a crate that can be changed: its mutants
//! rewrite    a file with its mutants
//! build      the one build, without those that do not compile
//! ask        one run of the tests, stopped at the first that fails
//! record     what came out, and the table of it
//! session    the steps one after the other
//! ```
#![cfg_attr(not(test), warn(clippy::all))]

mod ask;
mod build;
mod kinds;
mod places;
mod record;
mod rewrite;
mod session;

pub use places::Mutant;
pub use record::{HEAD, Outcome, row};
pub use session::{Asked, Options, list, run};

/// Any error, with its words.
pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;
