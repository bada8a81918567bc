//! Helpers that the whole-house tests share.
