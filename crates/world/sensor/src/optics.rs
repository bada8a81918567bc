//! Step 6 of the paper: the image that the optics make of points of light, and the balance of its flux.

use raypencil_scene::{Camera, Image, SceneError, check_range};

use crate::{
    Dust, PointSource, Psf, Speckle, SpecklePattern, SplatImage, ThinLens, binned, convolve, splat,
    splat_defocused,
};

/// Optics of a camera: focus, blurs and dust.
#[derive(Debug, Clone, PartialEq)]
pub struct Optics {
    /// Cells along the side of a pixel in which blur is computed. Memory and time grow with its square.
    pub oversampling: u32,
    /// Depth at which the lens is in focus, metres; `None` for a lens that is sharp at all depths.
    pub focus: Option<f64>,
    /// Blurs, applied one after another.
    pub blurs: Vec<Psf>,
    /// Dust on the lens.
    pub dust: Option<Dust>,
    /// Speckle of the laser's light; `None`: light without interference.
    pub speckle: Option<Speckle>,
}

/// Image after each stage of the optics.
#[derive(Debug, Clone, PartialEq)]
pub struct OpticsOutput {
    /// Image after the blurs and the speckle, watts per cell.
    pub fine: Image<f64>,
    /// The same image, watts per pixel.
    pub pixels: Image<f64>,
    /// Image after the dust, watts per pixel: the flux on the sensor.
    pub optical: Image<f64>,
    /// Balance of the flux.
    pub budget: FluxBudget,
}

/// Balance of the flux, watts: `entered` is the sum of all others, but for rounding.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FluxBudget {
    /// Flux of all sources.
    pub entered: f64,
    /// Flux that fell beside the image.
    pub missed: f64,
    /// Flux that blurs moved over the sides of the image.
    pub blurred_out: f64,
    /// Flux that the speckle took away; negative if it brought some. Its expectation is 0.
    pub speckled: f64,
    /// Flux absorbed by dust.
    pub absorbed: f64,
    /// Flux that dust scattered beside the image.
    pub scattered_out: f64,
    /// Flux on the sensor.
    pub arrived: f64,
}

impl Optics {
    /// Sharp and clean optics: every point lands in its pixel.
    pub const PERFECT: Self =
        Self { oversampling: 1, focus: None, blurs: Vec::new(), dust: None, speckle: None };

    /// Forms the image of points of light, with the first pattern of speckle if there is speckle.
    ///
    /// # Panics
    /// If the optics are not valid.
    ///
    /// # Example
    ///
    /// ```
    /// # use raypencil_scene::{Camera, Lens};
    /// use raypencil_sensor::{Optics, PointSource};
    ///
    /// # let camera = Camera {
    /// #     width: 32, height: 32, pixel_pitch: [9e-6; 2], focal_length: 8e-3, principal_point: [16.0; 2],
    /// #     aperture: 2e-3, lens: Lens::CLEAR, max_range: 20.0,
    /// # };
    /// let source = PointSource { x: 16.5, y: 16.5, watts: 1.0, depth: 4.0 };
    /// // Perfect optics put all light into its pixel.
    /// assert_eq!(Optics::PERFECT.form_image(&camera, [source]).optical.at(16, 16), 1.0);
    /// // Dusty optics absorb a tenth, and every part of the flux is accounted for.
    /// let budget = Optics::dusty().form_image(&camera, [source]).budget;
    /// assert!((budget.absorbed - 0.1).abs() < 1e-3);
    /// let out = budget.missed + budget.blurred_out + budget.absorbed + budget.scattered_out + budget.arrived;
    /// assert!((budget.entered - out).abs() < 1e-12);
    /// ```
    pub fn form_image(
        &self,
        camera: &Camera,
        sources: impl IntoIterator<Item = PointSource>,
    ) -> OpticsOutput {
        self.form_speckled(camera, sources, SpecklePattern::default())
    }

    /// The same with a pattern of speckle. Without speckle all patterns give the same image.
    ///
    /// # Panics
    /// If the optics are not valid.
    pub fn form_speckled(
        &self,
        camera: &Camera,
        sources: impl IntoIterator<Item = PointSource>,
        pattern: SpecklePattern,
    ) -> OpticsOutput {
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
        let mut imaged = self.filter(camera, image, pattern);
        imaged.budget.entered = entered;
        imaged.budget.missed = lost;
        imaged
    }

    /// Filters a fine image, whose light is already where a sharp lens would bring it. It is `camera.width` times
    /// `oversampling` cells wide, and high likewise. `pattern` chooses the speckle.
    ///
    /// # Panics
    /// If the image has another size.
    pub fn filter(&self, camera: &Camera, fine: Image<f64>, pattern: SpecklePattern) -> OpticsOutput {
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
        if let Some(speckle) = self.speckle {
            budget.speckled = speckle.apply(&mut fine, cell, pattern);
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

    /// Filters an image that is known by pixels only, such as a sun-lit background. Dust acts on it; blur, which
    /// is narrow relative to the pixels, is left out.
    pub fn filter_pixels(&self, camera: &Camera, pixels: &Image<f64>) -> Image<f64> {
        self.dust.map_or_else(|| pixels.clone(), |dust| dust.apply(pixels, camera.pixel_pitch).image)
    }

    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    /// Names the first invalid field, as a part of `field`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.oversampling"), f64::from(self.oversampling), 1.0, 64.0, "cells")?;
        if let Some(focus) = self.focus {
            check_range(|| format!("{field}.focus"), focus, 1e-3, f64::INFINITY, "m")?;
        }
        for (index, blur) in self.blurs.iter().enumerate() {
            blur.validate(&format!("{field}.blurs[{index}]"))?;
        }
        self.dust.map_or(Ok(()), |dust| dust.validate(&format!("{field}.dust")))?;
        self.speckle.map_or(Ok(()), |speckle| speckle.validate(&format!("{field}.speckle")))
    }
}
