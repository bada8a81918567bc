//! `terrain`: grounds as files.

mod import;
mod inspect;
