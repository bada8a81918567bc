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

use crate::candidate::Outsider;
use crate::monte_carlo::{self, ImageComparison, compare_images, expected_images};
use crate::radiance::{RadianceComparison, compare_radiance};
use crate::rendered::Rendered;
use raypencil_judge::{Check, Defect, GroundTruth, Recorded, check};
use raypencil_scene::Progress;
use raypencil_scene_io::Subject;

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
        format!("{}-{}", folder_name(&self.outsider.name), index + 1)
    }

    /// The first rays on which it is wrong, sensor by sensor in reading order.
    pub fn misses(&self) -> impl Iterator<Item = &Defect> {
        self.check.sensors.iter().flat_map(|sensor| &sensor.defects)
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
    let truth = GroundTruth::certified(scene, progress);
    let ours = rendered.iter().map(|side| {
        let recorded = Recorded::of_output(&side.name, scene, &side.output, side.precision);
        Held { name: side.name.clone(), check: check(&truth, &recorded, progress) }
    });
    let ours = ours.collect();
    let has_images = outsiders.iter().any(|outsider| !outsider.images.is_empty());
    let expected = if has_images { expected_images(scene, monte_carlo::DRAWS, progress) } else { Vec::new() };
    let hold = |outsider: Outsider| {
        let check = check(&truth, &outsider.recorded, progress);
        let images = outsider.images.iter().map(|image| compare_images(image, &expected[image.beam]));
        let radiance = outsider.radiance.iter().map(|map| compare_radiance(&truth, map));
        HeldOutsider { check, images: images.collect(), radiance: radiance.collect(), outsider }
    };
    Panel { ours, outsiders: outsiders.into_iter().map(hold).collect() }
}

/// A name as a folder may be called: letters, digits and `-`.
pub(crate) fn folder_name(name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
    let parts: Vec<&str> = plain.split('-').filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { "outsider".into() } else { parts.join("-") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_is_a_fit_folder() {
        assert_eq!(folder_name("Mitsuba 3"), "mitsuba-3");
        assert_eq!(folder_name("../../x"), "x");
        assert_eq!(folder_name("***"), "outsider");
    }
}
