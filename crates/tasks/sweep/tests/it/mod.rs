//! The tests of this crate by its public items, one program together with its unit tests.

mod charts;
mod finished;
mod sweep;
