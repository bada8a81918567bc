//! The bench of a pack: beams and faces that are added to a scene, so that its rays decide every clause of the contract.
//!
//! Ordinary ground seldom meets a limit: no ray of a scene at random runs exactly through an edge, or ends at the maximum
//! range. So a pack has sensors that are built for them:
//!
//! ```text
//! rows.rs        rows of faces, each for one boundary of the contract
//! beams.rs       the beams before them, of dyadic numbers and exact rotations
//! furniture.rs   plates before the camera and the ordinary beams
//! faces.rs       how faces are added
//! ```

mod beams;
mod faces;
mod furniture;
mod rows;

use std::sync::Arc;

use raypencil_scene::{Scene, SceneError};
use raypencil_scene_io::{Subject, scene_sha256};

use crate::bench::beams::bench_beams;
use crate::bench::faces::AddedFaces;
use crate::bench::furniture::{backward_beam, before_beam, before_camera};
use crate::write::PackError;

/// Reflectivity of the bench: unlike that of the ground, so that a flux tells the material.
const BENCH_REFLECTIVITY: f64 = 0.6;

/// Number of beams that [`with_bench`] adds.
pub const BENCH_BEAMS: usize = 4;

/// A subject whose scene has a bench, with the digest of that scene.
///
/// # Errors
/// As [`with_bench`].
pub fn benched(subject: Subject) -> Result<Subject, PackError> {
    let scene = with_bench(&subject.scene)
        .map_err(|source| PackError::NoBench { name: subject.name.clone(), source })?;
    Ok(Subject { sha256: scene_sha256(&scene), scene, ..subject })
}

/// A scene with a bench: its own sensors first, then [`BENCH_BEAMS`] beams more; its own faces first, then those of the
/// bench.
///
/// ```
/// use raypencil_pack::{BENCH_BEAMS, with_bench};
/// use raypencil_scene_io::{Overrides, load};
///
/// let scene = load("pyramids", &Overrides::default())?.scene;
/// let benched = with_bench(&scene)?;
/// assert_eq!(benched.beams().len(), scene.beams().len() + BENCH_BEAMS);
/// assert_eq!(benched.mesh().faces()[..9], scene.mesh().faces()[..9]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// More than 64 beams in all.
pub fn with_bench(scene: &Scene) -> Result<Scene, SceneError> {
    let mut faces = AddedFaces::default();
    let camera = *scene.camera();
    before_camera(&camera, &mut faces);
    for beam in scene.beams() {
        before_beam(beam, &camera, &mut faces);
    }
    let mut beams = scene.beams().to_vec();
    beams.push(backward_beam(&camera, &mut faces));
    beams.extend(bench_beams(&mut faces));
    let mesh = faces.added_to(scene.mesh(), BENCH_REFLECTIVITY)?;
    Scene::new(Arc::new(mesh), camera, beams, scene.atmosphere(), scene.flux_model())?
        .with_ray_sets(scene.ray_sets().to_vec())
}
