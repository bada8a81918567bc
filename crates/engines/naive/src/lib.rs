//! A third renderer, by brute force: every ray is tested against every face.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! It is written from the contract alone: its own rotation, its own rays, its own triangle test, no tables, no tree,
//! no order of faces. It is slow, and its purpose is to be wrong: a [`Fault`] can be injected into it, and a
//! comparison with another renderer, or a reference pack, must find it. The [`Clause`]s of the contract say which faults
//! break which clause.
//!
//! ```text
//! naive.rs                 the renderer
//! rays.rs  quaternion.rs   the rays of a sensor, in the scene
//! hits.rs                  the first hit of a ray
//! light.rs                 visibility and flux
//! fault.rs                 the mistakes that can be injected
//! slack.rs                 clauses that are kept with a tolerance
//! injected.rs              which of both is there
//! clause.rs                the clauses of the contract
//! ```

mod clause;
mod fault;
mod hits;
mod injected;
mod light;
mod naive;
mod quaternion;
mod rays;
mod slack;

pub use clause::{Clause, ClauseKind};
pub use fault::{Fault, FaultKind};
pub use naive::{Lax, Naive};
pub use slack::{Slack, SlackUnit};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
