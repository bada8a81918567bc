//! The scoreboard: raypencil's renderers and candidates, all checked against the exact answers.
//!
//! Maps are judged as by `check`. The images of a Monte Carlo renderer are not sums over pencils: they have the same
//! expectation, and are compared by their own standard errors.

use raypencil_diagnosis::{Diagnosis, diagnose};
use raypencil_judge::{Answers, Check, Class, GroundTruth, ListedDefect, Recorded, check, listed_defects};
use raypencil_scene::Progress;
use raypencil_scene_io::Subject;

use crate::candidate::Candidate;
use crate::monte_carlo::{ImageComparison, REALISATIONS, Z_TEST_LIMITS, compare_images, expected_images};
use crate::radiance::{RadianceComparison, compare_radiance};
use crate::rendered::Rendered;

/// The check of one of raypencil's renderers.
#[derive(Debug)]
pub struct RendererReport {
    /// The renderer's name.
    pub name: String,
    /// The check of its maps.
    pub check: Check,
}

/// The check of a candidate.
#[derive(Debug)]
pub struct CandidateReport {
    /// The recording.
    pub candidate: Candidate,
    /// The check of its maps.
    pub check: Check,
    /// Why rays are wrong, where a mistake explains it.
    pub diagnosis: Option<Diagnosis>,
    /// The comparisons of its Monte Carlo images, in the order of [`Candidate::images`].
    pub images: Vec<ImageComparison>,
    /// The comparisons of its radiance maps, in the order of [`Candidate::radiance`].
    pub radiance: Vec<RadianceComparison>,
}

impl CandidateReport {
    /// Name of a miss's folder, for the miss number `index` from 0.
    pub(crate) fn miss_name(&self, index: usize) -> String {
        format!("{}-{}", folder_name(&self.candidate.name), index + 1)
    }

    /// The worst and most telling rays that it answers wrongly, as [`listed_defects`] orders them.
    pub fn misses(&self) -> impl Iterator<Item = &ListedDefect> {
        listed_defects(&self.check.sensors).into_iter()
    }

    /// Rays that it answers wrongly, or that the referee could not decide.
    pub fn wrong_rays(&self) -> u64 {
        self.check.of(Class::Defect) + self.check.of(Class::Undecided)
    }

    /// Its Monte Carlo images that the limits refuse.
    pub fn wrong_images(&self) -> usize {
        self.images.iter().filter(|image| !image.is_within(&Z_TEST_LIMITS)).count()
    }

    /// Its radiance maps of which a ray is wrong.
    pub fn wrong_radiance(&self) -> usize {
        self.radiance.iter().filter(|map| map.wrong > 0).count()
    }

    /// Whether something of it was compared, and no ray, image or radiance map is wrong.
    pub fn passes(&self) -> bool {
        self.check.passes() && self.wrong_images() == 0 && self.wrong_radiance() == 0
    }
}

/// The checks of all renderers and candidates of one scene.
#[derive(Debug)]
pub struct Scoreboard {
    /// raypencil's own renderers.
    pub ours: Vec<RendererReport>,
    /// The candidates.
    pub candidates: Vec<CandidateReport>,
    /// The exact answers, correctly rounded.
    pub exact: Answers,
}

/// Checks `rendered` and `candidates` against the exact answer to every ray of the scene.
pub(crate) fn evaluate(
    subject: &Subject,
    rendered: &[Rendered],
    candidates: Vec<Candidate>,
    progress: &dyn Progress,
) -> Scoreboard {
    let scene = &subject.scene;
    let truth = GroundTruth::certified(scene, progress);
    let ours = rendered.iter().map(|side| {
        let recorded = Recorded::of_output(&side.name, scene, &side.output, side.precision);
        RendererReport { name: side.name.clone(), check: check(&truth, &recorded, progress) }
    });
    let ours = ours.collect();
    let has_images = candidates.iter().any(|candidate| !candidate.images.is_empty());
    let expected = if has_images { expected_images(scene, REALISATIONS, progress) } else { Vec::new() };
    let report = |candidate: Candidate| {
        let check = check(&truth, &candidate.recorded, progress);
        let diagnosis = (!check.passes())
            .then(|| {
                progress.stage(&format!(
                    "looking for a mistake that explains what is wrong of {}",
                    candidate.name
                ));
                diagnose(&truth, &candidate.recorded, &check)
            })
            .flatten();
        let images = candidate.images.iter().map(|image| compare_images(image, &expected[image.beam]));
        let radiance = candidate.radiance.iter().map(|map| compare_radiance(&truth, map));
        CandidateReport {
            check,
            diagnosis,
            images: images.collect(),
            radiance: radiance.collect(),
            candidate,
        }
    };
    let candidates = candidates.into_iter().map(report).collect();
    Scoreboard { ours, candidates, exact: truth.into_answers() }
}

/// A program's name reduced to what a folder's name may have: lower-case letters, digits and `-`.
fn folder_name(name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
    let parts: Vec<&str> = plain.split('-').filter(|part| !part.is_empty()).collect();
    // A published name: reports of earlier versions have it.
    if parts.is_empty() { "outsider".into() } else { parts.join("-") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn program_names_become_folder_names() {
        assert_eq!(folder_name("Mitsuba 3"), "mitsuba-3");
        assert_eq!(folder_name("../../x"), "x");
        assert_eq!(folder_name("***"), "outsider");
    }
}
