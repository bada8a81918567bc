//! Point spread functions: what the optics make of a point. (Paper, §5; Goodman, Introduction to Fourier Optics,
//! its reference 3)

use raypencil_scene::{SceneError, check_range};

use crate::Kernel;

/// Length on the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ImageLength {
    /// Pixels of the camera, across and down alike.
    Pixels(f64),
    /// Metres on the image plane.
    Metres(f64),
}

impl ImageLength {
    /// Length in cells across and down: cells of `cell` metres, `oversampling` of them along the side of a pixel.
    pub(crate) fn in_cells(self, cell: [f64; 2], oversampling: u32) -> [f64; 2] {
        match self {
            Self::Pixels(pixels) => [pixels * f64::from(oversampling); 2],
            Self::Metres(metres) => cell.map(|size| metres / size),
        }
    }

    pub(crate) fn validate(self, field: &str) -> Result<(), SceneError> {
        match self {
            Self::Pixels(pixels) => check_range(|| format!("{field}.pixels"), pixels, 0.0, 1e3, "pixels"),
            Self::Metres(metres) => check_range(|| format!("{field}.metres"), metres, 0.0, 1e-2, "m"),
        }
    }
}

/// Point spread function, the same everywhere on the image.
#[derive(Debug, Clone, PartialEq)]
pub enum Psf {
    /// Gaussian: the sum of many small aberrations, or the diffusion of charge.
    Gaussian {
        /// Standard deviation along each axis.
        sigma: ImageLength,
    },
    /// Diffraction pattern of a round aperture.
    Airy {
        /// Wavelength, metres.
        wavelength: f64,
        /// Focal length over aperture diameter.
        f_number: f64,
        /// Number of dark rings within the kernel. The cost grows with its square. The light beyond (2 / (pi^2
        /// rings), 2.5 % with 8) is returned into the kernel by normalisation.
        rings: u32,
    },
    /// Measured kernel on the cells of the fine image.
    Sampled(Kernel),
}

impl Psf {
    /// Kernel on cells of `cell` metres, `oversampling` of them along the side of a pixel.
    pub fn kernel(&self, cell: [f64; 2], oversampling: u32) -> Kernel {
        match self {
            Self::Gaussian { sigma } => Kernel::gaussian(sigma.in_cells(cell, oversampling)),
            Self::Airy { wavelength, f_number, rings } => Kernel::airy(*wavelength, *f_number, *rings, cell),
            Self::Sampled(kernel) => kernel.clone(),
        }
    }

    /// Checks that a kernel can be made.
    ///
    /// # Errors
    /// Names the first invalid field, as a part of `field`.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        match self {
            Self::Gaussian { sigma } => sigma.validate(&format!("{field}.sigma")),
            Self::Airy { wavelength, f_number, rings } => {
                check_range(|| format!("{field}.wavelength"), *wavelength, 1e-8, 1e-3, "m")?;
                check_range(|| format!("{field}.f_number"), *f_number, 0.1, 1e4, "")?;
                check_range(|| format!("{field}.rings"), f64::from(*rings), 1.0, 100.0, "rings")
            }
            // A kernel is valid by construction.
            Self::Sampled(_) => Ok(()),
        }
    }
}
