//! What reports are made of: text, scales, pictures, plots, drawings.

mod colour;
mod drawing;
pub mod page;
mod paint;
mod picture;
mod plot;
mod scale;
mod text;

pub use colour::Colour;
pub use drawing::{Anchor, Drawing, INK, LETTERS, Mark, SOFT};
pub use page::{PAGE_END, page_head};
pub use picture::{ColourMap, Picture, Reduction};
pub use plot::{Bar, Plot, Ring, cells_axis, reduced_to, shape, stretch};
pub use scale::{Scale, Spread, Tick};
pub use text::{count, counted, list, number, quantity, time};

/// Version of raypencil that a report names.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
