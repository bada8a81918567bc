//! Injected faults: a comparison or a check must find each of them.
//!
//! * [`geometry`] and [`light`]: small scenes that reveal faults of the [`naive`](crate::naive) renderer.
//! * [`files`]: correct maps with a fault of writing.
//! * [`scenes_of`]: the scenes for each kind of fault.
//! * [`detection`]: the first scene that reveals a fault, and the smallest that still does.

pub mod detection;
pub mod files;
pub mod geometry;
pub mod light;
mod scenes;

pub use scenes::scenes_of;
