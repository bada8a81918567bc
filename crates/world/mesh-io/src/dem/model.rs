//! An elevation model in memory, and the ground through its posts.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use raypencil_files::{Fault, FileError};
use raypencil_scene::{Material, Mesh};
use raypencil_terrain::{Ground, HeightGrid, simplify};

use crate::dem::coordinate_system::AxisSystem;
use crate::dem::outliers::{Posts, Spikes};
use crate::dem::registration::Registration;

/// Allowed range of the maximum error of a simplified ground, metres.
pub const MAX_ERROR_RANGE_M: RangeInclusive<f64> = 1e-6..=1e6;

/// Number of f32 steps from a power of two to the next, 2^23.
const F32_STEPS: f64 = 8_388_608.0;

/// An elevation model, or its part inside a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Dem {
    /// The file.
    pub file: PathBuf,
    /// Heights in the global frame, metres: x to the east, y to the north, as on the map.
    pub posts: HeightGrid,
    /// Meaning of a pixel.
    pub registration: Registration,
    /// Coordinate system of x and y. The posts are in metres; here is what the file has.
    pub map: AxisSystem,
    /// Coordinate system of the heights.
    pub heights: AxisSystem,
    /// Sample that stands for "not known", beside NaN; `None` if the file names none.
    pub nodata: Option<f64>,
    /// Samples that stand for it by the caller's word.
    pub given_nodata: Vec<f64>,
    /// Number of posts whose height is not known.
    pub unknown: usize,
}

impl Dem {
    /// Posts that stand out by more than the rest of the model is high: spikes and pits.
    pub fn spikes(&self) -> Option<Spikes> {
        let HeightGrid { columns, spacing, heights, .. } = &self.posts;
        Posts { heights, columns: *columns as usize, spacing: *spacing, metre: 1.0 }.spikes()
    }

    /// Ground through all posts, with the one material `ground`.
    ///
    /// With `max_error`, metres, the ground has fewer faces; no known post is farther from it along z.
    ///
    /// # Panics
    /// If `max_error` is not above zero.
    pub fn ground(&self, max_error: Option<f64>, reflectivity: f64) -> Ground {
        let material = Material { name: "ground".to_string(), reflectivity };
        match max_error {
            Some(max_error) => simplify(&self.posts, max_error, material),
            None => self.posts.ground(material),
        }
    }

    /// Mesh of [`Dem::ground`].
    ///
    /// # Errors
    /// A `max_error` outside 1e-6 to 1e6 m; no cell with four known posts; a reflectivity outside 0 to 1; posts that
    /// single precision cannot hold apart, because they are too close together or too far from the scene origin.
    pub fn mesh(&self, max_error: Option<f64>, reflectivity: f64) -> Result<Mesh, FileError> {
        let unfit = |place: &str, found: String, expected: String| {
            FileError::Dem(Fault::new(place, found, expected).in_file(&self.file))
        };
        if let Some(value) = max_error.filter(|value| !MAX_ERROR_RANGE_M.contains(value)) {
            return Err(unfit("largest error", format!("{value} m"), "1e-6 to 1e6 m".to_string()));
        }
        let ground = self.ground(max_error, reflectivity);
        if ground.faces.is_empty() {
            let found = format!("{} of {} posts not known", self.unknown, self.posts.heights.len());
            return Err(unfit("samples", found, "a cell with four known posts".to_string()));
        }
        let origin = self.file.display().to_string();
        let mesh = ground.into_mesh().map_err(|source| FileError::Scene { origin, source })?;
        // An f32 of size `reach` has steps of at most 2^-23 of it; four steps keep columns and rows apart.
        let reach =
            mesh.bounds().map_or(0.0, |[low, high]| low.abs().max(high.abs()).truncate().max_element());
        let needed = 4.0 * reach / F32_STEPS;
        let spacing = self.posts.spacing.min_element();
        if spacing < needed {
            let found = format!("posts {spacing} m apart, up to {reach} m from the scene origin");
            let expected = format!("at least {needed} m apart: vertices are offsets in single precision");
            return Err(unfit("spacing", found, expected));
        }
        Ok(mesh)
    }
}
