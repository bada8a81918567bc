//! Step 6: the image that the optics make of points of light, and an account of where the light went.

use raypencil_scene::{Camera, Image, SceneError};

use crate::check::check_range;
use crate::{Dust, PointSource, Psf, SplatImage, ThinLens, binned, convolve, splat, splat_defocused};

/// What the camera's optics do to an image.
#[derive(Debug, Clone, PartialEq)]
pub struct Optics {
    /// Cells to the side of a pixel in which blur is computed. Memory and time grow as its square.
    pub oversampling: u32,
    /// The depth at which the lens is sharp, metres; `None`: it is sharp everywhere.
    pub focus: Option<f64>,
    /// Blurs, one after another.
    pub blurs: Vec<Psf>,
    /// Dust on the lens.
    pub dust: Option<Dust>,
}

/// An image on its way through the optics.
#[derive(Debug, Clone, PartialEq)]
pub struct OpticsOutput {
    /// After the blurs, watts per cell.
    pub fine: Image<f64>,
    /// The same, watts per pixel.
    pub pixels: Image<f64>,
    /// After the dust, watts per pixel: what falls on the sensor.
    pub optical: Image<f64>,
    /// Where the light went.
    pub budget: FluxBudget,
}

/// Where the light went, watts. `entered` is the sum of all others, but for rounding.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FluxBudget {
    /// What came.
    pub entered: f64,
    /// Fell beside the image.
    pub missed: f64,
    /// Was blurred over the sides of the image.
    pub blurred_out: f64,
    /// Was absorbed by dust.
    pub absorbed: f64,
    /// Was scattered by dust beside the image.
    pub scattered_out: f64,
    /// Falls on the sensor.
    pub arrived: f64,
}

impl Optics {
    /// Sharp and clean: every point lands in its pixel.
    pub const PERFECT: Self = Self { oversampling: 1, focus: None, blurs: Vec::new(), dust: None };

    /// The image of points of light.
    ///
    /// # Panics
    /// If the optics are not valid.
    pub fn form(&self, camera: &Camera, sources: impl IntoIterator<Item = PointSource>) -> OpticsOutput {
        let mut entered = 0.0;
        let sources = sources.into_iter().inspect(|source| entered += source.watts);
        let SplatImage { image, lost } = match self.focus {
            None => splat(camera.width, camera.height, self.oversampling, sources),
            Some(focus) => {
                let lens = ThinLens::for_camera(camera, focus);
                let (pitch, s) = (camera.pixel_pitch, self.oversampling);
                splat_defocused(camera.width, camera.height, s, pitch, &lens, sources)
            }
        };
        let mut imaged = self.filter(camera, image);
        imaged.budget.entered = entered;
        imaged.budget.missed = lost;
        imaged
    }

    /// What becomes of a fine image, whose light is already where a sharp lens would bring it: `camera.width`
    /// times `oversampling` cells wide, and high likewise.
    ///
    /// # Panics
    /// If the image has another size.
    pub fn filter(&self, camera: &Camera, fine: Image<f64>) -> OpticsOutput {
        let size = (camera.width * self.oversampling, camera.height * self.oversampling);
        assert_eq!((fine.width(), fine.height()), size, "cells of the fine image");
        let cell = camera.pixel_pitch.map(|pitch| pitch / f64::from(self.oversampling));
        let mut budget = FluxBudget { entered: fine.cells().iter().sum(), ..FluxBudget::default() };
        let mut fine = fine;
        for blur in &self.blurs {
            let blurred = convolve(&fine, &blur.kernel(cell, self.oversampling));
            fine = blurred.image;
            budget.blurred_out += blurred.lost;
        }
        let pixels = binned(&fine, self.oversampling);
        let optical = match self.dust {
            None => pixels.clone(),
            Some(dust) => {
                let dusted = dust.apply(&pixels, camera.pixel_pitch);
                budget.absorbed = dusted.absorbed;
                budget.scattered_out = dusted.lost;
                dusted.image
            }
        };
        budget.arrived = optical.cells().iter().sum();
        OpticsOutput { fine, pixels, optical, budget }
    }

    /// What becomes of an image that is known by pixels only, as a sun-lit background is: dust acts on it; blur,
    /// narrow beside the pixels, is left out.
    pub fn veil(&self, camera: &Camera, pixels: &Image<f64>) -> Image<f64> {
        self.dust.map_or_else(|| pixels.clone(), |dust| dust.apply(pixels, camera.pixel_pitch).image)
    }

    /// Refuses optics that make no image, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(field, "oversampling", f64::from(self.oversampling), 1.0, 64.0, "cells")?;
        if let Some(focus) = self.focus {
            check_range(field, "focus", focus, 1e-3, f64::INFINITY, "m")?;
        }
        for (index, blur) in self.blurs.iter().enumerate() {
            blur.validate(&format!("{field}.blurs[{index}]"))?;
        }
        self.dust.map_or(Ok(()), |dust| dust.validate(&format!("{field}.dust")))
    }
}
