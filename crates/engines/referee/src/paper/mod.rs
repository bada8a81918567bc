//! Whether an approximation of the paper accounts for an answer against the contract.

pub(crate) mod approximations;
pub(crate) mod hit;
pub(crate) mod raster;
pub(crate) mod visibility;
