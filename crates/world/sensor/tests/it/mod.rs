//! The tests of this crate by its public items, one program together with its unit tests.

mod chain;
mod noise;
mod optics;
mod speckle;
