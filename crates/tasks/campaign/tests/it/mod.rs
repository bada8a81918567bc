//! The tests of this crate by its public items, one program together with its unit tests.

mod cases;
mod hostile;
mod own_scenes;
mod summary;
