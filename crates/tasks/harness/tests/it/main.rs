//! The tests of this crate by its public items: a program of its own, because the fixtures of `raypencil-tests` are made by
//! the library, and to its unit tests they would be values of another crate.

mod formats;
mod numbers;
mod output;
mod reports;
mod summary_schema;
mod verdicts;
mod warnings;
