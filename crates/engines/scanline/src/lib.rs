//! The first renderer: the paper's scanline algorithm. (§4, §5, §6)
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Every triangle of the terrain is projected forward onto a sensor's projection plane (SPP) and scanned row by row;
//! each cell keeps the nearest face. The camera uses the perspective transformation, a beam the cylindrical one of
//! figure 7. Source: J. J. Nitao and D. H. Cronquist, "Computer modelling: a structured light vision system for a Mars
//! rover", 1990. The files, with the numbers of its steps in §4:
//!
//! ```text
//! 1, 3  skip               faces that cannot be seen, by rules that never change a map
//!       printed_skip       the same rules as the paper prints them
//!       clusters           neighbouring faces, skipped together
//! 2     sensor_from_scene  the motion into the sensor's frame
//!       vertices           the vertices in that frame and on the SPP
//!       perspective        the camera's transformation
//!       cylindrical        a beam's transformation (figure 7)
//!       transformation     the interface of the two
//!       edges              the edges of a face, alike in both of its neighbours
//!       clip               the part of a face at or beyond the SPP (figure 9)
//!       stripe             the part within a beam's stripe, with straight sides (figure 8)
//! 4a    scan               two triangles with a common horizontal side (figure 4)
//! 4b    raster             a row from left to right; the nearest face is kept (figure 5)
//!       bands              the main loop over faces and rows
//! ```
//!
//! The faces that the pencils hit decide what the camera sees of them (§5, §6). With the numbers of the steps in §3:
//!
//! ```text
//! 3     points             the pencils' points on the camera's image
//! 5     bins               those points, sorted by pixel
//!       occluders          the faces that may hide them, clipped to the part at or beyond the camera's SPP
//!       occlusion          every face against the points in the pixels that it touches, at their own positions
//!       printed_occlusion  against the centres of those pixels, and within the upper beam's extent, as printed
//!       rounding           the tolerance for faces that contain a point
//! 4     shares             the power of each pencil, by column
//!       flux               equation (1), the radiometric model, and the tables of the pixels
//!       returns            steps 3, 5 and 4 for all beams, and the sums on the image
//! ```
//!
//! The rest: `spp` (points and lines on the SPP), `plane` (the plane of a face), `tables` (§5, "pre-computed tables"),
//! `cache`, `options`, and `renderer`, which has [`Scanline`].
//!
//! Where the paper approximates there is a switch ([`Switches`]). All are `exact` by default:
//!
//! | switch | `paper` | `exact` |
//! | --- | --- | --- |
//! | `beam-edges` | clip to the stripe, project the vertices, straight lines between them (`stripe`) | a row is a plane of space, which cuts a side in one point (`cylindrical`) |
//! | `skip-rules` | 1b, 3a, 3b, 3c as printed (`printed_skip`) | conservative forms (`skip`); skipping never changes a map |
//! | `facing` | faces turned away from the camera's axis occlude | every face occludes |
//! | `extent` | faces not past the upper beam's farthest hit occlude | faces at any depth occlude |
//! | `place` | a point is compared at the centre of its pixel | a point is compared at its own position on the image |
//!
//! "Without using square roots" (§5): along a row 1/t is affine in x in *both* transformations. So the nearest face has
//! the largest 1/t, and the range follows from a table of |q|.
//!
//! Bands of rows are scanned in parallel. Of equally near faces a cell keeps the one with the lowest index, whichever comes
//! first, so the number of threads changes no bit of a frame.
//!
//! # Example
//!
//! A camera of three pixels looks straight down from 10 m at a horizontal triangle. (The README of this crate has the
//! whole scene.)
//!
//! ```
//! # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
//! # use doc::scene_above;
//! use raypencil_scanline::Scanline;
//! use raypencil_scene::{Renderer, Request};
//!
//! let scene = scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]], 20.0);
//! let frame = Scanline::exact().render(&scene, &Request::MAPS);
//!
//! // The pixels look along x/z = -3/4, 0 and 3/4. The depth is 10 m; the range is measured along the ray:
//! // 10 m sqrt(1 + 9/16) = 12.5 m.
//! let maps = frame.camera.expect("asked for");
//! let (depth, range) = (maps.depth.expect("asked for"), maps.range.expect("asked for"));
//! assert_eq!([0, 1, 2].map(|i| depth.at(i, 0).get()), [Some(10.0); 3]);
//! assert_eq!([0, 1, 2].map(|i| range.at(i, 0).get()), [Some(12.5), Some(10.0), Some(12.5)]);
//! ```

mod bands;
mod bins;
mod cache;
mod clip;
mod clusters;
mod cylindrical;
mod edges;
#[cfg(test)]
#[path = "../tests/unit/fixtures.rs"]
mod fixtures;
mod flux;
mod occluders;
mod occlusion;
mod options;
mod perspective;
mod plane;
mod points;
mod printed_occlusion;
mod printed_skip;
mod raster;
mod renderer;
mod returns;
mod rounding;
mod scan;
mod sensor_from_scene;
mod shares;
mod skip;
mod spp;
mod stripe;
mod tables;
mod transformation;
mod vertices;

pub use options::ScanlineOptions;
pub use raypencil_scene::{Fidelity, Switches, UnknownSwitch};
pub use renderer::Scanline;

/// Compiles the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_scanline;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
