//! The search for an injected fault: the first scene that reveals it, then the smallest.

use raypencil::Scene;
use raypencil::harness::{Contender, first_interesting_ray, is_interesting_in_class};
use raypencil::judge::{Class, JudgeShare, Quantity};
use raypencil::minimise::{MINIMISE_BUDGET, Minimised, minimise};
use raypencil::tracer::Tracer;
use raypencil::{Place, Silent};

use super::files::{self, FileFault};
use super::scenes::scenes_of;
use crate::naive::{Fault, FaultKind, Naive};

/// How a fault was detected.
#[derive(Debug)]
pub struct Detection {
    /// The first scene that reveals it.
    pub scene: &'static str,
    /// The quantity with the largest error on the first wrong ray. `None` if the reader refused the file.
    pub quantity: Option<Quantity>,
    /// The first wrong ray. `None` if the reader refused the file.
    pub place: Option<Place>,
    /// Rays compared up to the detection, those of earlier scenes included.
    pub compared: u64,
    /// The smallest scene that still reveals it.
    pub smallest: Minimised,
}

/// Compares the faulty renderer with the tracer on the scenes of the fault's kind, and minimises the first scene that
/// reveals the fault. `None` if no scene does.
pub fn detect(fault: Fault) -> Option<Detection> {
    let mut before = 0;
    let (honest, faulty) = (Contender::from(Tracer::new()), Contender::from(Naive { fault: Some(fault) }));
    for (name, scene) in scenes_of(fault.kind()) {
        let Some(first) =
            first_interesting_ray([&honest, &faulty], &scene, Class::Defect, JudgeShare::Sample)
        else {
            before += rays(&scene);
            continue;
        };
        let smallest =
            minimise(&scene, Some(first.place), &shows_fault(fault), MINIMISE_BUDGET, &Silent).ok()?;
        let (quantity, place) = (Some(first.quantity), Some(first.place));
        return Some(Detection { scene: name, quantity, place, compared: before + first.compared, smallest });
    }
    None
}

/// A test whether a scene reveals a fault as a defect, and shows no defect without the fault. The second condition
/// keeps the search from ending at another weakness of the naive renderer.
pub fn shows_fault(fault: Fault) -> impl Fn(&Scene, Option<Place>) -> bool {
    let honest = Contender::from(Tracer::new());
    let [faulty, sound] = [Some(fault), None].map(|fault| Contender::from(Naive { fault }));
    move |scene, place| {
        is_interesting_in_class([&honest, &faulty], Class::Defect)(scene, place)
            && !is_interesting_in_class([&honest, &sound], Class::Defect)(scene, place)
    }
}

/// [`detect`] for a fault of files: a check takes the place of the comparison.
pub fn detect_file(fault: FileFault) -> Option<Detection> {
    let mut before = 0;
    for (name, scene) in scenes_of(FaultKind::Files) {
        let (place, quantity, compared) = match files::check_files(&scene, Some(fault)) {
            None => {
                before += rays(&scene);
                continue;
            }
            Some(files::FileRejection::Refused(_)) => (None, None, 0),
            Some(files::FileRejection::Wrong(place, item, compared)) => {
                (Some(place), Some(item.quantity), compared)
            }
        };
        let shows = |scene: &Scene, place: Option<Place>| {
            let is_same = match files::check_files(scene, Some(fault)) {
                None => false,
                Some(files::FileRejection::Refused(_)) => quantity.is_none(),
                Some(files::FileRejection::Wrong(first, ..)) => place == Some(first),
            };
            is_same && files::check_files(scene, None).is_none()
        };
        let smallest = minimise(&scene, place, &shows, MINIMISE_BUDGET, &Silent).ok()?;
        return Some(Detection { scene: name, quantity, place, compared: before + compared, smallest });
    }
    None
}

/// The number of rays of a scene.
fn rays(scene: &Scene) -> u64 {
    let sizes = scene.sensors().filter_map(|sensor| scene.size(sensor));
    sizes.map(|(width, height)| u64::from(width) * u64::from(height)).sum()
}
