//! The extraction of stripes, which also tells what it saw.

use std::collections::HashSet;
use std::sync::mpsc::SyncSender;
use std::sync::{Mutex, PoisonError};

use raypencil::SceneError;
use raypencil::rover::{CameraImage, Exposure, StripeExtractor, Stripes};

/// What was seen in one exposure.
#[derive(Debug)]
pub(super) struct Seen {
    pub exposure: Exposure,
    /// The image, but not those of a scan: there are hundreds of them in one frame.
    pub image: Option<CameraImage>,
    pub stripes: Stripes,
}

/// What tells the exposures of a frame apart: the step of a scan, and the lit beam.
type Key = (Option<u32>, Option<usize>);

/// The rover's own extraction, or somebody's stripes.
#[derive(Debug)]
pub(super) struct Tee {
    extraction: Box<dyn StripeExtractor>,
    keeps_images: bool,
    listener: SyncSender<Seen>,
    /// The frame, and its exposures that were told: with two renderers each comes twice, first that of the first.
    told: Mutex<(u64, HashSet<Key>)>,
}

impl Tee {
    pub(super) fn new(
        extraction: Box<dyn StripeExtractor>,
        keeps_images: bool,
        listener: SyncSender<Seen>,
    ) -> Self {
        Self { extraction, keeps_images, listener, told: Mutex::default() }
    }

    fn is_news(&self, exposure: Exposure) -> bool {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.0 != exposure.frame {
            *told = (exposure.frame, HashSet::new());
        }
        told.1.insert((exposure.step, exposure.beam))
    }
}

impl StripeExtractor for Tee {
    fn stripes(&self, exposure: Exposure, image: &CameraImage) -> Result<Stripes, SceneError> {
        let stripes = self.extraction.stripes(exposure, image)?;
        if self.is_news(exposure) {
            let is_kept = self.keeps_images && exposure.step.is_none();
            let seen = Seen { exposure, image: is_kept.then(|| image.clone()), stripes: stripes.clone() };
            // Waits until there is room; nobody listens any more if the drive was given up.
            self.listener
                .send(seen)
                .map_err(|_| SceneError::new("drive", "given up", "somebody who takes its frames"))?;
        }
        Ok(stripes)
    }

    fn left_over(&self) -> Option<String> {
        self.extraction.left_over()
    }
}
