//! The part of a report that answers when asked: maps that zoom, every differing ray, and its geometry.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! A report is one file. What it shows is a *page model*, a JSON document, beside packed arrays of numbers; a script of our
//! own turns both into panels in the reader's browser. Nothing is fetched. `docs/formats/report-page.md` describes the
//! model for people who want to read a report by a program.
//!
//! ```text
//! arrays            arrays of numbers inside a page: packed, deflated, in base64
//! derived           the values of a hit that the page computes by itself
//! channels          one side's channels of one sensor
//! pair, sensor      the classes of every ray; geometry and margins
//! switch_words      the paper's approximations in words
//! script            the modules of `script/`, put together
//! page              the whole
//! described         which rays a page describes in full
//! raster_page       rasters without a scene
//! ```
//!
//! Sizes: of a sensor the page stores faces, visibility, pixels and flux of the first side, and of the others what
//! differs. Range, depth, point, normal and incidence are computed in the page; a cell whose recording has other bits is
//! stored.

mod arrays;
mod channels;
mod derived;
mod described;
mod page;
mod pair;
mod raster_page;
mod script;
mod sensor;
mod switch_words;

pub use arrays::{Arrays, Change, Packed};
pub use channels::SideMaps;
pub use described::{RayToDescribe, rays_to_describe};
pub use page::{DescribedRay, ExplorerPage, SideKind, without_explorer};
pub use pair::{ComparedMaps, SensorPair};
pub use raster_page::{
    DifferingCell, RasterAxes, RasterAxis, RasterChannel, RasterGroup, RasterPage, RasterSolid,
};
pub use sensor::RayMargins;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
