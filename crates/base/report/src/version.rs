//! The version that reports name.

/// Version of raypencil.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
