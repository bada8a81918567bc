//! A planted fault from the first scene that catches it to the smallest that does.

use raypencil::Scene;
use raypencil::harness::{Contender, first_shown, shows_class};
use raypencil::judge::{Class, JudgeShare, Quantity};
use raypencil::minimise::{MINIMISE_BUDGET, Minimised, minimise};
use raypencil::tracer::Tracer;
use raypencil::{Place, Silent};

use super::scenes_of;
use crate::files::{self, FileFault};
use crate::naive::{Fault, Kind, Naive};

/// How a fault was found.
#[derive(Debug)]
pub struct Catch {
    /// The scene.
    pub scene: &'static str,
    /// The quantity that is worst on the first ray that shows it; `None` if a file was refused unread.
    pub quantity: Option<Quantity>,
    /// That ray.
    pub place: Option<Place>,
    /// Rays compared until then, on this scene and those before it that did not catch it.
    pub compared: u64,
    /// The smallest scene that still shows it.
    pub smallest: Minimised,
}

/// Looks for a fault on the scenes of its kind, with the tracer for company, and minimises the first that catches it.
/// `None` if none does.
pub fn hunt(fault: Fault) -> Option<Catch> {
    let mut before = 0;
    let (honest, faulty) = (Contender::from(Tracer::new()), Contender::from(Naive { fault: Some(fault) }));
    for (name, scene) in scenes_of(fault.kind()) {
        let Some(first) = first_shown([&honest, &faulty], &scene, Class::Defect, JudgeShare::Sample) else {
            before += rays(&scene);
            continue;
        };
        let smallest =
            minimise(&scene, Some(first.place), &shows_fault(fault), MINIMISE_BUDGET, &Silent).ok()?;
        let (quantity, place) = (Some(first.quantity), Some(first.place));
        return Some(Catch { scene: name, quantity, place, compared: before + first.compared, smallest });
    }
    None
}

/// Whether a scene shows a fault as a defect, and nothing without it: a search must not end at another weakness of
/// the naive renderer.
pub fn shows_fault(fault: Fault) -> impl Fn(&Scene, Option<Place>) -> bool {
    let honest = Contender::from(Tracer::new());
    let [faulty, sound] = [Some(fault), None].map(|fault| Contender::from(Naive { fault }));
    move |scene, place| {
        shows_class([&honest, &faulty], Class::Defect)(scene, place)
            && !shows_class([&honest, &sound], Class::Defect)(scene, place)
    }
}

/// The same for a fault of files, found by a check.
pub fn hunt_file(fault: FileFault) -> Option<Catch> {
    let mut before = 0;
    for (name, scene) in scenes_of(Kind::Files) {
        let (place, quantity, compared) = match files::caught(&scene, Some(fault)) {
            None => {
                before += rays(&scene);
                continue;
            }
            Some(files::Caught::Refused(_)) => (None, None, 0),
            Some(files::Caught::Wrong(place, item, compared)) => (Some(place), Some(item.quantity), compared),
        };
        let shows = |scene: &Scene, place: Option<Place>| {
            let is_it = match files::caught(scene, Some(fault)) {
                None => false,
                Some(files::Caught::Refused(_)) => quantity.is_none(),
                Some(files::Caught::Wrong(first, ..)) => place == Some(first),
            };
            is_it && files::caught(scene, None).is_none()
        };
        let smallest = minimise(&scene, place, &shows, MINIMISE_BUDGET, &Silent).ok()?;
        return Some(Catch { scene: name, quantity, place, compared: before + compared, smallest });
    }
    None
}

/// How many rays a scene has.
fn rays(scene: &Scene) -> u64 {
    let sizes = scene.sensors().filter_map(|sensor| scene.size(sensor));
    sizes.map(|(width, height)| u64::from(width) * u64::from(height)).sum()
}
