//! Which mistakes `diagnose` names: on candidates made from the exact answers.

pub(crate) mod candidates;
mod coarse;
mod drawn;
mod light;
mod one;
pub(crate) mod rays;
mod sensors;
mod two;
mod words;
mod wrong_renderers;
