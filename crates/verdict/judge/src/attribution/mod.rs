//! Why a renderer that follows the paper into error differs from the contract, ray by ray.
//!
//! A difference is put down to an approximation only if two things hold:
//!
//! 1. *It restores.* With the switches of the cause on `exact`, and all others as they are, the same
//!    algorithm gives an answer that the referee admits.
//! 2. *It is confirmed.* The referee finds, from the paper's text and by itself, that the approximations lose
//!    every true face that the answer leaves out and add the one that it names
//!    ([`raypencil_referee::Referee::explain`]), and each switch of the set is the reason for one of them.
//!    Where one approximation hides what another does (the true face is lost by either alone, say), the reason
//!    is sought in the answers that are left wrong when only a part of the set is exact.
//!
//! One of the smallest sets that do both is the cause. (A smaller set may restore an answer by luck, as where one
//! rule skips what another adds; it is not confirmed then.) An answer that no set explains has no cause, and is a
//! defect.

pub(crate) mod cause;
pub(crate) mod context;
mod find;
mod geometry;
mod visibility;
