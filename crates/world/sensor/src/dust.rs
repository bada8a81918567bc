//! Dust on the front of the lens: it absorbs light and scatters a part of the rest. (Paper, step 6)

use raypencil_scene::{Image, SceneError, check_range};

use crate::{ImageLength, Kernel, convolve};

/// Dust on the lens, evenly spread and far out of focus: it casts no shape on the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dust {
    /// Transmission: fraction of the light that passes, scattered or not.
    pub transmission: f64,
    /// Fraction of the transmitted light that is scattered into the halo.
    pub halo_share: f64,
    /// Standard deviation of the halo, a Gaussian. The halo is computed on the camera's pixels, so it should be
    /// some pixels wide.
    pub halo_sigma: ImageLength,
}

/// Image after the dust.
#[derive(Debug, Clone, PartialEq)]
pub struct DustedImage {
    /// Watts per pixel.
    pub image: Image<f64>,
    /// Flux absorbed by the dust, watts.
    pub absorbed: f64,
    /// Flux that the halo scattered beside the image, watts.
    pub lost: f64,
}

impl Dust {
    /// Image after the dust: T ((1 - h) image + h (image * Gaussian)). `pixel_pitch` is the camera's, metres.
    ///
    /// ```
    /// use raypencil_scene::Image;
    /// use raypencil_sensor::{Dust, ImageLength};
    ///
    /// let dust = Dust { transmission: 0.9, halo_share: 0.25, halo_sigma: ImageLength::Pixels(2.0) };
    /// let mut point = Image::filled(101, 101, 0.0);
    /// point.set(50, 50, 1.0);
    /// let dusted = dust.apply(&point, [9e-6, 9e-6]);
    /// // A tenth is absorbed; the halo, 12 pixels to each side, stays within the image.
    /// assert!((dusted.absorbed - 0.1).abs() < 1e-15);
    /// assert_eq!(dusted.lost, 0.0);
    /// assert!((dusted.image.cells().iter().sum::<f64>() - 0.9).abs() < 1e-12);
    /// ```
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

    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    /// Names the first invalid field, as a part of `field`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.transmission"), self.transmission, 0.0, 1.0, "")?;
        check_range(|| format!("{field}.halo_share"), self.halo_share, 0.0, 1.0, "")?;
        self.halo_sigma.validate(&format!("{field}.halo_sigma"))
    }
}
