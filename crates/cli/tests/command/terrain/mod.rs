//! `terrain`: grounds as files.

mod generate;
mod import;
mod inspect;
