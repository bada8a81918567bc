//! Dust on the front of the lens: it takes light away, and spreads some of what is left. (Paper, step 6)

use raypencil_scene::{Image, SceneError};

use crate::check::check_range;
use crate::{Extent, Kernel, convolve};

/// Dust on the lens, evenly spread and far out of focus: it has no shape on the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dust {
    /// The share of light that it lets through, scattered or not.
    pub transmission: f64,
    /// The share of that light that it scatters into the halo.
    pub halo_share: f64,
    /// Standard deviation of the halo, a Gaussian. It is spread on the camera's pixels, not on the finer image, so
    /// it should be some pixels wide.
    pub halo_sigma: Extent,
}

/// An image seen through dust.
#[derive(Debug, Clone, PartialEq)]
pub struct DustedImage {
    /// Watts per pixel.
    pub image: Image<f64>,
    /// What the dust swallowed, watts.
    pub absorbed: f64,
    /// What its halo sent beside the image, watts.
    pub lost: f64,
}

impl Dust {
    /// What arrives: T ((1 - h) image + h (image * Gaussian)). `pixel_pitch` is the camera's, metres.
    pub fn apply(&self, image: &Image<f64>, pixel_pitch: [f64; 2]) -> DustedImage {
        let halo = convolve(image, &Kernel::gaussian(self.halo_sigma.in_cells(pixel_pitch, 1)));
        let straight = self.transmission * (1.0 - self.halo_share);
        let scattered = self.transmission * self.halo_share;
        let cells = image.cells().iter().zip(halo.image.cells());
        let cells = cells.map(|(sharp, wide)| straight * sharp + scattered * wide).collect();
        DustedImage {
            image: Image::from_cells(image.width(), image.height(), cells),
            absorbed: (1.0 - self.transmission) * image.cells().iter().sum::<f64>(),
            lost: scattered * halo.lost,
        }
    }

    /// Refuses dust that would make light, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(field, "transmission", self.transmission, 0.0, 1.0, "of 1")?;
        check_range(field, "halo_share", self.halo_share, 0.0, 1.0, "of 1")?;
        self.halo_sigma.validate(&format!("{field}.halo_sigma"))
    }
}
