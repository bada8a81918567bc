//! The search for the simplest interesting scene: the fewest faces first, then the simplest rig, then short numbers.
//!
//! Changes that keep the ray in question come first, smaller sensors among them, since they make every later call of
//! the test cheap. The search is deterministic if the interestingness test is.

use raypencil_scene::{Place, Progress, Scene};

use crate::faces::{ddmin, keep_near_ray, keep_nearest, remove_single_faces};
use crate::reducer::{InterestingnessTest, NotInteresting, Reducer};
use crate::reduction::Reduction;
use crate::sensors::{cut_others, cut_to_ray};
use crate::short_numbers::shorten_numbers;
use crate::simplest_values::simplify_values;

/// Number of calls of the interestingness test that is enough for most scenes.
///
/// ddmin takes some hundred calls on grounds of which a few faces matter. Short numbers take up to 30 calls for each
/// number of the rig and of the remaining vertices.
pub const MINIMISE_BUDGET: u64 = 4000;

/// Maximum number of rounds. A shorter number may make a face superfluous, and fewer faces allow shorter numbers. Each
/// round changes less; three are enough for all but contrived tests.
const MAX_ROUNDS: u32 = 3;

/// Result of a search: the simplest scene found.
#[derive(Debug, Clone)]
pub struct Minimised {
    /// The scene. It has at least one face, so that it can be written to files.
    pub scene: Scene,
    /// The ray in question, if there was one. Its cell and the index of its beam may have changed.
    pub place: Option<Place>,
    /// Number of calls of the interestingness test.
    pub calls: u64,
    /// Whether the search ended within its budget. Then no single face can be removed.
    pub is_finished: bool,
    /// Number of faces of the given scene.
    pub faces_before: usize,
    /// Number of faces of the scene found.
    pub faces_after: usize,
}

/// Reduces `scene` to exactly the ray at `place` and to the `faces` faces nearest to it, with a few calls of the test.
///
/// A step after which the scene is not interesting is left out. If `scene` itself is not interesting, it is returned
/// unchanged.
///
/// ```
/// use std::sync::Arc;
///
/// use raypencil_minimise::reduce_to_ray;
/// use raypencil_scene::{Atmosphere, FluxModel, Mounted, Place, Pose, Scene, SensorId, Silent, rig};
/// use raypencil_terrain::RandomGround;
///
/// let mesh = Arc::new(RandomGround::plain(7, 500, 20.0).build().into_mesh()?);
/// let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(64, 48, 1e-5, 1e-2) };
/// let air = Atmosphere { attenuation: 0.0 };
/// let scene = Scene::new(mesh, camera, Vec::new(), air, FluxModel::Radiometric)?;
/// let place = Place { sensor: SensorId::Camera, i: 5, j: 40 };
/// let (reduced, moved) = reduce_to_ray(&scene, place, 8, &|_, _| true, &Silent);
/// // The only pixel of the reduced camera has exactly the ray of pixel (5, 40).
/// assert_eq!((reduced.mesh().faces().len(), moved.i, moved.j), (8, 0, 0));
/// assert_eq!(reduced.ray(SensorId::Camera, 0, 0), scene.ray(SensorId::Camera, 5, 40));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn reduce_to_ray(
    scene: &Scene,
    place: Place,
    faces: usize,
    is_interesting: &InterestingnessTest<'_>,
    progress: &dyn Progress,
) -> (Scene, Place) {
    let first = Reduction::of(scene, Some(place));
    let Ok(mut reducer) = Reducer::begin(first, is_interesting, MINIMISE_BUDGET, progress) else {
        return (scene.clone(), place);
    };
    cut_to_ray(&mut reducer);
    keep_nearest(&mut reducer, faces);
    cut_others(&mut reducer);
    let place = reducer.best().place.unwrap_or(place);
    (reducer.into_scene(), place)
}

/// Finds the simplest interesting scene, beginning with `scene`.
///
/// `place` is the ray in question, if it is known. Then the faces near it are tried first, which takes a few calls on a
/// ground of a million faces, and its sensor is cut down to it. `is_interesting` is called at least once and at most
/// `budget` times; [`MINIMISE_BUDGET`] is enough for most scenes.
///
/// ```
/// use std::sync::Arc;
///
/// use raypencil_minimise::{MINIMISE_BUDGET, minimise};
/// use raypencil_scene::{Atmosphere, FluxModel, Mounted, Pose, Scene, Silent, rig};
/// use raypencil_terrain::RandomGround;
///
/// let mesh = Arc::new(RandomGround::plain(7, 500, 20.0).build().into_mesh()?);
/// let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(64, 48, 1e-5, 1e-2) };
/// let air = Atmosphere { attenuation: 0.125 };
/// let scene = Scene::new(mesh, camera, Vec::new(), air, FluxModel::Radiometric)?;
/// // Only the air is interesting: one face and one pixel are left of the rest.
/// let found = minimise(&scene, None, &|scene, _| scene.atmosphere().attenuation > 0.0, MINIMISE_BUDGET, &Silent)?;
/// assert_eq!((found.faces_after, found.is_finished), (1, true));
/// assert_eq!((found.scene.camera().sensor.width, found.scene.camera().sensor.height), (1, 1));
/// assert_eq!(found.scene.atmosphere().attenuation, 0.125);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// `scene` itself is not interesting.
pub fn minimise(
    scene: &Scene,
    place: Option<Place>,
    is_interesting: &InterestingnessTest<'_>,
    budget: u64,
    progress: &dyn Progress,
) -> Result<Minimised, NotInteresting> {
    let faces_before = scene.mesh().faces().len();
    let mut reducer = Reducer::begin(Reduction::of(scene, place), is_interesting, budget, progress)?;
    for round in 0..MAX_ROUNDS {
        let before = reducer.best().clone();
        cut_to_ray(&mut reducer);
        if round == 0 {
            keep_near_ray(&mut reducer);
        }
        cut_others(&mut reducer);
        ddmin(&mut reducer);
        simplify_values(&mut reducer);
        shorten_numbers(&mut reducer);
        if *reducer.best() == before || reducer.is_spent() {
            break;
        }
    }
    // The later changes may have made a face superfluous.
    remove_single_faces(&mut reducer);
    let is_finished = !reducer.is_spent();
    let calls = reducer.calls();
    let Reduction { place, .. } = *reducer.best();
    let scene = reducer.into_scene();
    let faces_after = scene.mesh().faces().len();
    Ok(Minimised { scene, place, calls, is_finished, faces_before, faces_after })
}
