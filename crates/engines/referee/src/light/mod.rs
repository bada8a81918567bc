//! A pencil's share of the beam's power, and the flux that arrives.

pub(crate) mod beam_returns;
pub(crate) mod flux;
pub(crate) mod shares;
