//! The tests of this crate by its public items, one program together with its unit tests.

mod bag;
mod clouds;
mod poses;
