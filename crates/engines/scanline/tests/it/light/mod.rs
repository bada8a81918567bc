//! The camera's view of the pencils, on scenes whose numbers are derived beside them.

mod closed_form;
mod hidden;
mod requests;
mod rig;
mod watertight;
