//! Random numbers that the tests of this crate share.

pub mod splitmix;

pub use splitmix::SplitMix64;
