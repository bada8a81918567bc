//! `terrain`: terrains as files.

mod generate;
mod import;
mod inspect;
