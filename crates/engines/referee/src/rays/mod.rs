//! The contract's rays, without a division, and how they change as they are displaced.

pub(crate) mod displacement;
pub(crate) mod form;
pub(crate) mod moving_ray;
pub(crate) mod ray;
