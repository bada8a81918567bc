//! The scoreboard: raypencil's renderers and candidates, all checked against the exact answers.
//!
//! Maps are judged as by `check`. The images of a Monte Carlo renderer are not sums over pencils: they have the same
//! expectation, and are compared by their own standard errors.

use raypencil_cast::{AskedBy, CastGround, RayPackChecked, check_stated_rays};
use raypencil_diagnosis::{Diagnosis, diagnose};
use raypencil_files::RayArray;
use raypencil_judge::{Answers, Check, Class, GroundTruth, ListedDefect, Recorded, check, listed_defects};
use raypencil_referee::ExactCast;
use raypencil_scene::{NamedRaySet, Progress, Triangles};
use raypencil_scene_io::{Subject, scene_sha256};

use crate::candidate::Candidate;
use crate::monte_carlo::{ImageComparison, REALISATIONS, Z_TEST_LIMITS, compare_images, expected_images};
use crate::radiance::{RadianceComparison, compare_radiance};
use crate::ray_set_packs::CheckedRaySet;
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
    /// The checks of every set of rays of the scene, by the rule of `check`.
    pub ray_sets: Vec<CheckedRaySet>,
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

    /// The checks of the sets of rays that it answers, by their names.
    pub fn given_sets(&self) -> impl Iterator<Item = (&str, &RayPackChecked)> {
        self.ray_sets.iter().filter_map(|set| Some((set.name.as_str(), set.checked.as_ref()?)))
    }

    /// Rays of which something was compared, of sensors and of sets.
    pub fn compared(&self) -> u64 {
        let of_sets: u64 = self.given_sets().map(|(_, set)| set.comparison.counts().all()).sum();
        self.check.compared() + of_sets
    }

    /// Rays that it answers wrongly, or that the referee could not decide.
    pub fn wrong_rays(&self) -> u64 {
        let of_sets: u64 = self.given_sets().map(|(_, set)| set.comparison.counts().wrong).sum();
        self.check.of(Class::Defect) + self.check.of(Class::Undecided) + of_sets
    }

    /// Sets of rays that it answers and of which no ray meets anything: to agree on them proves nothing.
    pub fn idle_sets(&self) -> impl Iterator<Item = &str> {
        self.given_sets().filter(|(_, set)| set.comparison.met == 0).map(|(name, _)| name)
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
        let is_right = self.compared() > 0 && self.wrong_rays() == 0 && self.idle_sets().next().is_none();
        is_right && self.wrong_images() == 0 && self.wrong_radiance() == 0
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
    let has_sets = candidates.iter().any(|candidate| !candidate.ray_sets.is_empty());
    // The scene's vertices are f32 offsets, which f64 holds as they are.
    let mesh = has_sets.then(|| Triangles::from(scene.mesh().as_ref()));
    let exact = mesh.as_ref().map(ExactCast::new);
    let terrain = mesh.as_ref().zip(exact.as_ref());
    let report = |candidate: Candidate| {
        let ray_sets = check_ray_sets(subject, &candidate, terrain, progress);
        let check = check(&truth, &candidate.recorded, progress);
        let diagnosis = (check.of(Class::Defect) + check.of(Class::Undecided) > 0)
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
            ray_sets,
            candidate,
        }
    };
    let candidates = candidates.into_iter().map(report).collect();
    Scoreboard { ours, candidates, exact: truth.into_answers() }
}

/// Checks what a candidate answers to each set of rays of the scene, on the terrain's triangles.
fn check_ray_sets(
    subject: &Subject,
    candidate: &Candidate,
    terrain: Option<(&Triangles, &ExactCast<'_>)>,
    progress: &dyn Progress,
) -> Vec<CheckedRaySet> {
    let check = |(index, set): (usize, &NamedRaySet)| {
        let given = candidate.ray_sets.iter().find(|given| given.index == index);
        let checked = given.zip(terrain).map(|(given, (mesh, exact))| {
            let asked_by = AskedBy {
                name: subject.name.clone(),
                sha256: scene_sha256(&subject.scene),
                // A scene file's own mesh may have other coordinates than the scene; those of a pack are the scene's.
                cast_command: format!(
                    "raypencil pack {} --no-bench -o pack && raypencil cast pack/rays/{}",
                    // Renderers, which a pack does not take, are named last.
                    subject.arguments.split(" --with ").next().unwrap_or_default(),
                    set.name
                ),
            };
            let ground = CastGround { mesh, exact, sides: set.set.sides() };
            let rays = RayArray { shape: set.shape.clone(), rays: set.set.rays().to_vec() };
            let stated = (candidate.name.clone(), given.stated.clone());
            check_stated_rays(asked_by, (ground, rays), stated, candidate.recorded.precision, progress)
        });
        CheckedRaySet { name: set.name.clone(), rays: set.set.rays().len() as u64, checked }
    };
    subject.scene.ray_sets().iter().enumerate().map(check).collect()
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
