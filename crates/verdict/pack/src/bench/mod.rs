//! The bench of a pack: beams and faces that are added to a scene, so that its rays decide every clause of the contract.
//!
//! Ordinary ground seldom meets a limit: no ray of a scene at random runs exactly through an edge, or ends at the maximum
//! range. So a pack has sensors that are built for them:
//!
//! ```text
//! rows.rs        rows of faces, each for one boundary of the contract
//! beams.rs       the beams before them, of dyadic numbers and exact rotations
//! furniture.rs   plates before the camera and the ordinary beams
//! bites.rs       beams whose pencils pass limits at given distances
//! lattice.rs     corners in f32 for a wanted value
//! faces.rs       how faces are added
//! ```

mod beams;
mod bites;
mod faces;
mod furniture;
mod lattice;
mod rows;

use std::sync::Arc;

use raypencil_scene::{Beam, Camera, Mounted, Scene, SceneError};

use crate::bench::beams::bench_beams;
pub use crate::bench::bites::BITING_BEAMS;
use crate::bench::bites::biting_beams;
use crate::bench::faces::AddedFaces;
use crate::bench::furniture::{backward_beam, before_beam, before_camera};

/// Reflectivity of the bench: unlike that of the ground, so that a flux tells the material.
const BENCH_REFLECTIVITY: f64 = 0.6;

/// Which bench it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Edition {
    /// That of the packs with the version 1.0.0: each clause is met, at a distance of its own.
    First,
    /// With beams that pass each limit at distances down to what rounding excuses.
    Second,
}

/// Whether a scene ends in a bench: its last beams are those that [`with_bench`] adds for its camera.
pub(crate) fn has_bench(scene: &Scene) -> bool {
    let Some(first) = scene.beams().len().checked_sub(BENCH_BEAMS) else { return false };
    scene.beams()[first..] == added_beams(scene.camera(), Edition::Second, &mut AddedFaces::default())
}

/// The beams of a bench, each before its faces.
fn added_beams(camera: &Mounted<Camera>, edition: Edition, faces: &mut AddedFaces) -> Vec<Mounted<Beam>> {
    let mut beams = vec![backward_beam(camera, faces)];
    beams.extend(bench_beams(faces));
    if edition == Edition::Second {
        beams.extend(biting_beams(camera, faces));
    }
    beams
}

/// Number of beams that [`with_bench`] adds.
pub const BENCH_BEAMS: usize = 7;

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
    with_bench_of(scene, Edition::Second)
}

/// A scene with the bench of an edition.
pub(crate) fn with_bench_of(scene: &Scene, edition: Edition) -> Result<Scene, SceneError> {
    let mut faces = AddedFaces::default();
    let camera = *scene.camera();
    before_camera(&camera, &mut faces);
    for beam in scene.beams() {
        before_beam(beam, &camera, &mut faces);
    }
    let mut beams = scene.beams().to_vec();
    beams.extend(added_beams(&camera, edition, &mut faces));
    let mesh = faces.added_to(scene.mesh(), BENCH_REFLECTIVITY)?;
    Scene::new(Arc::new(mesh), camera, beams, scene.atmosphere(), scene.flux_model())?
        .with_ray_sets(scene.ray_sets().to_vec())
}
