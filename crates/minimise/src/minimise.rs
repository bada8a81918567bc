//! The plainest scene that still shows something: fewest faces first, then the plainest rig, then short numbers.
//!
//! ```text
//! draft       a scene taken apart
//! trials      what is kept: a change of which the predicate still holds
//! sensors     no beam that is not needed; of a sensor the one ray in question
//! exact       when a smaller sensor has the very same ray
//! faces       delta debugging, from the faces near the ray (near)
//! plain       no profile, filter, air, second material
//! numbers     poses, sensors and vertices in fewer binary digits
//! shows       ready predicates: two renderers differ so
//! reproducer  the result as files
//! ```
//!
//! What leaves the ray as it is goes first, the sensors' sizes too, for it makes every later question cheap. All of it
//! is deterministic if the predicate is.

use crate::draft::Draft;
use crate::trials::{NotShown, Trials};
use crate::{faces, numbers, plain, sensors};
use raypencil_scene::Place;
use raypencil_scene::{Progress, Scene};

/// A budget of predicate calls that is enough for most scenes: ddmin takes some hundred on grounds of which a few
/// faces matter, short numbers up to 30 for each number of the rig and of the vertices that are left.
pub const MINIMISE_BUDGET: u64 = 4000;

/// How often all of it is done over: a short number may make a face superfluous, and fewer faces allow for shorter
/// numbers. Each time changes less; three are enough for all but contrived predicates.
const ROUNDS: u32 = 3;

/// The plainest scene that was found.
#[derive(Debug, Clone)]
pub struct Minimised {
    /// The scene. It has at least one face, so that it can be written.
    pub scene: Scene,
    /// The ray in question, if there was one: in another cell, and of a beam with another index, where sensors got
    /// smaller and beams fewer.
    pub place: Option<Place>,
    /// How often the predicate was asked.
    pub calls: u64,
    /// Whether the search came to its end within its budget. Then no face can be left out.
    pub is_finished: bool,
    /// Faces of the scene that was given.
    pub faces_before: usize,
    /// Faces of this one.
    pub faces_after: usize,
}

/// The scene of one ray of `scene`, the very same, with the `faces` nearest to it, as far as `shows` holds of each step. It
/// is `scene` itself if `shows` does not hold of that.
pub fn single_ray(
    scene: &Scene,
    place: Place,
    faces: usize,
    shows: &dyn Fn(&Scene, Option<Place>) -> bool,
    progress: &dyn Progress,
) -> (Scene, Place) {
    let Ok(mut trials) = Trials::begin(Draft::of(scene, Some(place)), shows, MINIMISE_BUDGET, progress)
    else {
        return (scene.clone(), place);
    };
    sensors::cut_to_ray(&mut trials);
    faces::nearest(&mut trials, faces);
    sensors::cut_others(&mut trials);
    let place = trials.best().place.unwrap_or(place);
    (trials.into_scene(), place)
}

/// Finds the plainest scene of which `shows` holds, beginning with `scene`.
///
/// `place` is the ray in question, if it is known: then the faces near it are tried first, which takes a few calls on
/// a ground of a million faces, and its sensor is cut down to it. `shows` is told where that ray is in the scene that
/// it is asked about. It is asked at most `budget` times, once at least; [`MINIMISE_BUDGET`] is enough for most.
///
/// # Errors
/// If `shows` does not hold for `scene` itself.
pub fn minimise(
    scene: &Scene,
    place: Option<Place>,
    shows: &dyn Fn(&Scene, Option<Place>) -> bool,
    budget: u64,
    progress: &dyn Progress,
) -> Result<Minimised, NotShown> {
    let faces_before = scene.mesh().faces().len();
    let mut trials = Trials::begin(Draft::of(scene, place), shows, budget, progress)?;
    for round in 0..ROUNDS {
        let before = trials.best().clone();
        sensors::cut_to_ray(&mut trials);
        if round == 0 {
            faces::coarse(&mut trials);
        }
        sensors::cut_others(&mut trials);
        faces::fewest(&mut trials);
        plain::plainest(&mut trials);
        numbers::shortest(&mut trials);
        if *trials.best() == before || trials.is_spent() {
            break;
        }
    }
    // Whatever has changed since, no face is superfluous.
    faces::single_removals(&mut trials);
    let is_finished = !trials.is_spent();
    let calls = trials.calls();
    let Draft { place, .. } = *trials.best();
    let scene = trials.into_scene();
    let faces_after = scene.mesh().faces().len();
    Ok(Minimised { scene, place, calls, is_finished, faces_before, faces_after })
}
