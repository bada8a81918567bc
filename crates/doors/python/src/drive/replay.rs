//! A second rover that is given the stripes of the first, without rendering anything: its frames are those of the first.
//!
//! A drive keeps no points and no maps of its frames. By the same stripes this rover makes the same ones, as one does that
//! is given the stripes of a recording (`docs/guide/drive.md`).

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use raypencil::drive::DriveJob;
use raypencil::rover::{CameraImage, Drive, DriveFrame, ElevationMap, Exposure, StripeExtractor, Stripes};
use raypencil::{Image, Precision, RenderOutput, Renderer, Request, Scene, SceneError};

use super::tee::Seen;

/// One frame, and the map after it.
#[derive(Debug)]
pub(super) struct ReplayedFrame {
    pub frame: DriveFrame,
    pub map: ElevationMap,
    /// The images of the frame, but those of a scan.
    pub images: Vec<(Exposure, CameraImage)>,
}

/// No light, in an image of one pixel: nobody looks at it.
struct Dark;

impl Renderer for Dark {
    fn name(&self) -> &str {
        "dark"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, _request: &Request) -> RenderOutput {
        let flux = vec![Image::filled(1, 1, 0.0); scene.beams().len()];
        RenderOutput { camera: None, beams: Vec::new(), returns: Vec::new(), flux, stages: Vec::new() }
    }
}

/// The stripes of the first rover in place of any others.
#[derive(Debug)]
struct Given {
    seen: Mutex<Receiver<Seen>>,
    images: Sender<(Exposure, CameraImage)>,
}

impl StripeExtractor for Given {
    fn stripes(&self, exposure: Exposure, _image: &CameraImage) -> Result<Stripes, SceneError> {
        let ended = |_| SceneError::new("drive", "ended", "the stripes of another exposure");
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner).recv().map_err(ended)?;
        if seen.exposure != exposure {
            let expected = format!("{exposure:?}");
            return Err(SceneError::new("drive.exposure", format!("{:?}", seen.exposure), expected));
        }
        if let Some(image) = seen.image {
            // The other end is on this thread.
            let _ = self.images.send((exposure, image));
        }
        Ok(seen.stripes)
    }
}

/// Follows the drive to its end, or until nobody takes the frames.
pub(super) fn replay(
    job: &DriveJob,
    seen: Receiver<Seen>,
    frames: &SyncSender<Box<ReplayedFrame>>,
) -> Result<(), SceneError> {
    let (images, kept) = channel();
    let given = Given { seen: Mutex::new(seen), images };
    let mut drive = Drive::new(job.plan.clone(), Arc::clone(&job.mesh))?.with_extractor(Arc::new(given));
    while let Some(frame) = drive.step(&Dark, &mut |_, flux| CameraImage::Flux(flux))? {
        let map = drive.mapper().expect("a frame was driven").map().clone();
        let replayed = ReplayedFrame { frame, map, images: kept.try_iter().collect() };
        if frames.send(Box::new(replayed)).is_err() {
            break;
        }
    }
    Ok(())
}
