//! Helpers that the whole-house tests share.

pub mod naive;
