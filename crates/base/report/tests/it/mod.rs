//! Everything that reports are made of, by its public items.

mod axes;
mod document;
mod drawing;
mod junit;
mod picture;
mod plot;
mod scale;
mod table;
mod text;
