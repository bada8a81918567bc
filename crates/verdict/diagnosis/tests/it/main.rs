//! Which mistakes `diagnose` names: on candidates made from the exact answers.

mod candidates;
mod one;
mod rays;
mod two;
mod words;
