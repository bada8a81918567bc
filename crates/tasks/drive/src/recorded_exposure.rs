//! Record of one exposure of a drive, for comparison with that of another renderer: its lit pixels and a digest of its
//! digital numbers. The light gives the numbers again, so that images need not be kept.

use raypencil_rover::Exposure;
use raypencil_scene::{Image, Scene};
use sha2::{Digest, Sha256};

use crate::background::Background;
use crate::job::DriveJob;
use crate::sun::Sun;

/// Maximum number of lit pixels that are kept per frame and renderer: 128 MiB. A vertical scan behind blurring optics
/// has more.
pub(crate) const MAX_LIT_PIXELS: usize = 1 << 23;

#[derive(Debug, Clone)]
pub(crate) struct RecordedExposure {
    /// Index of the exposure in the drive, which selects the camera's noise.
    number: u64,
    /// Scenes of the exposure, if the sun shone on it, and how many of them are of the image with the laser on.
    scenes: (Vec<Scene>, usize),
    pub(crate) exposure: Exposure,
    /// Columns and rows of the image.
    pub(crate) size: (u32, u32),
    /// Indices of the lit pixels in row-major order, and their flux in watts. `None`: more than there is room for.
    pub(crate) lit: Option<Vec<(u32, f64)>>,
    /// SHA-256 of the digital numbers.
    pub(crate) digest: [u8; 32],
}

impl RecordedExposure {
    /// Records an exposure with room for `room` lit pixels. `flux` is the laser's light, watts per pixel; `numbers` are
    /// the digital numbers.
    pub(crate) fn new(
        exposure: Exposure,
        number: u64,
        scenes: (Vec<Scene>, usize),
        flux: &Image<f64>,
        numbers: &Image<i32>,
        room: usize,
    ) -> Self {
        let mut hasher = Sha256::new();
        let mut bytes = Vec::new();
        for row in numbers.cells().chunks(numbers.width().max(1) as usize) {
            bytes.clear();
            bytes.extend(row.iter().flat_map(|number| number.to_le_bytes()));
            hasher.update(&bytes);
        }
        let lit = || flux.cells().iter().enumerate().filter(|(_, watts)| **watts != 0.0);
        let fits = lit().nth(room).is_none();
        Self {
            number,
            scenes,
            exposure,
            size: (flux.width(), flux.height()),
            lit: fits.then(|| lit().map(|(index, &watts)| (index as u32, watts)).collect()),
            digest: hasher.finalize().into(),
        }
    }

    /// Number of lit pixels that are kept.
    pub(crate) fn lit_pixels(&self) -> usize {
        self.lit.as_ref().map_or(0, Vec::len)
    }

    /// Digital numbers of the exposure, computed once more from its lit pixels.
    pub(crate) fn numbers(&self, lit: &[(u32, f64)], job: &DriveJob, sun: Option<&Sun>) -> Image<i32> {
        let mut flux = Image::filled(self.size.0, self.size.1, 0.0);
        for &(index, watts) in lit {
            flux.cells_mut()[index as usize] = watts;
        }
        let (scenes, of_lit) = &self.scenes;
        let background = sun.and_then(|sun| {
            let images: Vec<_> = scenes.iter().map(|scene| sun.background(job, scene)).collect();
            Background::new(&images.iter().collect::<Vec<_>>(), *of_lit, &job.plan.times)
        });
        job.expose(&flux, background.as_ref(), self.number, &mut None)
    }
}
