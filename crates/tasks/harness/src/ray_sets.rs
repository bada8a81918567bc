//! Sets of rays of a scene: the tracer's answers against the exact ones.
//!
//! `scanline` draws the images of cameras and beams and answers no other rays, so there is no pair of renderers to compare:
//! each ray of a set is ruled on.

use std::path::{Path, PathBuf};

use raypencil_cast::{
    Answers, CastCounts, CastSource, Comparison, PcdData, Questions, Stated, cast_with, compare_with,
    write_set,
};
use raypencil_files::FolderError;
use raypencil_referee::ExactCast;
use raypencil_report::{count, counted};
use raypencil_scene::{NamedRaySet, Precision, Progress, Scene, Triangles};
use raypencil_scene_io::{Subject, scene_sha256};
use raypencil_tracer::TracerCast;

/// The renderer that answers rays of no sensor.
const WITH: &str = "tracer";

/// A set of rays, answered.
#[derive(Debug)]
pub struct RaySetResult {
    /// Index of the set in the scene.
    pub index: usize,
    /// Name of the set.
    pub name: String,
    /// The exact answers.
    pub answers: Answers,
    /// The tracer's first hits against them; `None` if the tracer is not among the renderers.
    pub comparison: Option<Comparison>,
}

impl RaySetResult {
    /// Number of rays.
    pub fn rays(&self) -> u64 {
        self.answers.first.len() as u64
    }

    /// Number of rays that hit.
    pub fn hits(&self) -> u64 {
        self.answers.counts().0 as u64
    }

    /// Number of rays whose nearest hit is too near for the sensor.
    pub fn too_near(&self) -> u64 {
        self.answers.too_near() as u64
    }

    /// Rays by what became of them; all 0 if nothing was compared.
    pub fn counts(&self) -> CastCounts {
        self.comparison.as_ref().map(Comparison::counts).unwrap_or_default()
    }

    /// The result in words.
    pub fn words(&self) -> String {
        let mut all = format!("{}, {} hit", counted(self.rays(), "ray", "rays"), count(self.hits()));
        if self.too_near() > 0 {
            all += &format!(", {} too near", count(self.too_near()));
        }
        if self.comparison.is_none() {
            return format!("{all}; not compared, only the {WITH} answers them");
        }
        let CastCounts { same, rounding, wrong, .. } = self.counts();
        let [same, rounding, wrong] = [same, rounding, wrong].map(count);
        format!("{all}; {WITH}: {same} same, {rounding} rounding, {wrong} wrong")
    }
}

/// The first hits of all sets of a scene by one renderer, written as `cast` writes sets: `rays/NAME/` has arrays, point
/// clouds and pictures. Returns the paths of their `summary.json`; `None` if this renderer answers no rays of no sensor.
///
/// # Errors
/// A folder or a file that cannot be written; the message names it.
pub fn write_ray_sets(
    subject: &Subject,
    renderer: &str,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Option<Vec<PathBuf>>, FolderError> {
    if subject.scene.ray_sets().is_empty() {
        return Ok(Some(Vec::new()));
    }
    let mesh = Triangles::from(subject.scene.mesh().as_ref());
    let tracer = (renderer == WITH).then(|| TracerCast::new(&mesh));
    let exact = (renderer == "referee").then(|| ExactCast::new(&mesh));
    let mut written = Vec::new();
    for set in subject.scene.ray_sets() {
        let (rays, sides) = (set.set.rays(), set.set.sides());
        let answers = match (&tracer, &exact) {
            (Some(tracer), _) => Answers::traced(tracer, rays, sides),
            (None, Some(exact)) => cast_with(exact, rays, sides, Questions::default(), progress),
            (None, None) => return Ok(None),
        };
        written.push(write_ray_set(subject, set, &mesh, &answers, folder)?);
    }
    Ok(Some(written))
}

/// Where mesh and rays of a set come from.
pub(crate) fn source_of(subject: &Subject, set: &NamedRaySet) -> CastSource {
    CastSource {
        mesh: format!("the terrain of {}, in the scene frame", subject.name),
        mesh_sha256: vec![scene_sha256(&subject.scene)],
        rays: format!("rays {} of {}", set.name, subject.name),
        origin: subject.scene.mesh().origin().to_array(),
        ..CastSource::default()
    }
}

/// The folder of one set.
pub(crate) fn write_ray_set(
    subject: &Subject,
    set: &NamedRaySet,
    mesh: &Triangles,
    answers: &Answers,
    folder: &Path,
) -> Result<PathBuf, FolderError> {
    let source = source_of(subject, set);
    write_set(
        &folder.join("rays").join(&set.name),
        answers,
        (mesh, set, set.set.sides()),
        &source,
        PcdData::Binary,
    )
}

/// Answers all sets of a scene. `renderers` are the names of those that take part.
pub(crate) fn answer_ray_sets(
    scene: &Scene,
    renderers: &[String],
    progress: &dyn Progress,
) -> Vec<RaySetResult> {
    if scene.ray_sets().is_empty() {
        return Vec::new();
    }
    // The scene's vertices are f32 offsets, which f64 holds as they are.
    let mesh = Triangles::from(scene.mesh().as_ref());
    progress.stage(&format!("rays: building trees of {} faces", mesh.faces().len()));
    let exact = ExactCast::new(&mesh);
    let tracer = renderers.iter().any(|name| name == WITH).then(|| TracerCast::new(&mesh));
    let answer = |(index, set): (usize, &NamedRaySet)| {
        progress.stage(&format!("rays {}: answering", set.name));
        let (rays, sides) = (set.set.rays(), set.set.sides());
        let answers = cast_with(&exact, rays, sides, Questions::default(), progress);
        let comparison = tracer.as_ref().map(|tracer| {
            let stated = Stated::of(&Answers::traced(tracer, rays, sides));
            compare_with(&exact, &mesh, rays, sides, &stated, Precision::F64)
        });
        RaySetResult { index, name: set.name.clone(), answers, comparison }
    };
    scene.ray_sets().iter().enumerate().map(answer).collect()
}
