//! Renderers that others wrote, and those of this house, all held to the same truth.
//!
//! ```text
//! recording    what somebody recorded of a scene: maps, images by chance, radiance
//! chance       an image by chance against pencils drawn at random, pixel by pixel
//! radiance     radiance along single rays against the closed form
//! reproducer   a miss as a pack of its one ray
//! ```
//!
//! Maps are judged as by `check`. Images of another kind of renderer are no sums over pencils: they have the same
//! expectation, and are compared by their own scatter.

mod chance;
mod radiance;
mod recording;
mod reproducer;

use crate::check::{Check, Truth, Wrong, check};
use crate::recorded::Recorded;
use crate::run::{Progress, Rendered, Subject};

pub use chance::{CHANCE_LIMITS, ChanceLimits, Estimate, ImageComparison, compare_images, expected_images};
pub use radiance::{RadianceComparison, compare_radiance};
pub use recording::{OutsideError, Outsider, RadianceMap, WayImage};
pub(crate) use recording::{is_of_outsiders, note, resolution_of};
pub use reproducer::{MissReproducer, write_misses};

/// A renderer held to the truth.
#[derive(Debug)]
pub struct Held {
    /// Its name.
    pub name: String,
    /// How its maps fare.
    pub check: Check,
}

/// An outsider held to the truth.
#[derive(Debug)]
pub struct HeldOutsider {
    /// What it recorded.
    pub outsider: Outsider,
    /// How its maps fare.
    pub check: Check,
    /// How its images by chance fare.
    pub images: Vec<ImageComparison>,
    /// How its radiance fares.
    pub radiance: Vec<RadianceComparison>,
}

impl HeldOutsider {
    /// The name of the folder of a miss, counted from 0.
    pub(crate) fn miss_name(&self, index: usize) -> String {
        format!("{}-{}", reproducer::folder_name(&self.outsider.name), index + 1)
    }

    /// The first rays on which it is wrong, sensor by sensor in reading order.
    pub fn misses(&self) -> impl Iterator<Item = &Wrong> {
        self.check.sensors.iter().flat_map(|sensor| &sensor.wrong)
    }
}

/// Everyone's answers to one scene, held to the truth.
#[derive(Debug)]
pub struct Panel {
    /// The renderers of this house.
    pub ours: Vec<Held>,
    /// Those of others.
    pub outsiders: Vec<HeldOutsider>,
}

/// Holds `rendered` and `outsiders` to the truth about the scene.
pub fn panel(
    subject: &Subject,
    rendered: &[Rendered],
    outsiders: Vec<Outsider>,
    progress: &dyn Progress,
) -> Panel {
    let scene = &subject.scene;
    let truth = Truth::certified(scene, progress);
    let ours = rendered.iter().map(|side| {
        let recorded = Recorded::of_frame(&side.name, scene, &side.frame, side.resolution);
        Held { name: side.name.clone(), check: check(&truth, &recorded, progress) }
    });
    let ours = ours.collect();
    let has_images = outsiders.iter().any(|outsider| !outsider.images.is_empty());
    let expected = if has_images { expected_images(scene, chance::DRAWS, progress) } else { Vec::new() };
    let hold = |outsider: Outsider| {
        let check = check(&truth, &outsider.recorded, progress);
        let images = outsider.images.iter().map(|image| compare_images(image, &expected[image.beam]));
        let radiance = outsider.radiance.iter().map(|map| compare_radiance(&truth, map));
        HeldOutsider { check, images: images.collect(), radiance: radiance.collect(), outsider }
    };
    Panel { ours, outsiders: outsiders.into_iter().map(hold).collect() }
}
