//! The simplest scene that still shows a difference.

mod draft;
mod exact;
mod faces;
mod near;
mod numbers;
mod plain;
mod search;
mod sensors;
mod trials;

pub use search::{MINIMISE_BUDGET, Minimised, minimise, single_ray};
pub use trials::NotShown;

#[cfg(test)]
#[path = "../tests/unit/search.rs"]
mod tests;
