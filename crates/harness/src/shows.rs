//! Ready predicates: two renderers differ by a class. And the ray to begin with.

use crate::renderers::{Contender, attribute};
use raypencil_judge::{
    Class, FirstOfClass, Judge, JudgeShare, Side, class_of_ray, compare_judged, first_of_class,
};
use raypencil_scene::Place;
use raypencil_scene::{Request, Scene, SensorId, Switches};

/// Whether two renderers differ by `class`: at the place that is asked about, or, if none is, at any ray.
///
/// The referee rules on every ray that is looked at, for a ray that is moved to another cell must not leave the sample.
pub fn shows_class<'a>(
    contenders: [&'a Contender; 2],
    class: Class,
) -> impl Fn(&Scene, Option<Place>) -> bool + 'a {
    move |scene, place| {
        let maps_camera = place.is_none_or(|place| place.sensor == SensorId::Camera);
        let request = Request { camera: maps_camera, ..Request::EVERYTHING };
        compared(contenders, scene, &request, JudgeShare::All, |judge, a, b| match place {
            Some(place) => class_of_ray(judge, a, b, place).is_some_and(|(of_ray, _)| of_ray == class),
            None => compare_judged(judge, a, b).iter().any(|sensor| sensor.of(class) > 0),
        })
    }
}

/// The first ray on which two renderers differ by `class`, with which [`raypencil_minimise::minimise::minimise`] may begin. Of the rays that
/// agree the referee rules on `share`.
pub fn first_shown(
    contenders: [&Contender; 2],
    scene: &Scene,
    class: Class,
    share: JudgeShare,
) -> Option<FirstOfClass> {
    compared(contenders, scene, &Request::EVERYTHING, share, |judge, a, b| first_of_class(judge, a, b, class))
}

/// Has both render the scene, finds what the paper's approximations did, and hands it all to `ask`.
fn compared<T>(
    contenders: [&Contender; 2],
    scene: &Scene,
    request: &Request,
    share: JudgeShare,
    ask: impl FnOnce(&Judge<'_>, Side<'_>, Side<'_>) -> T,
) -> T {
    let outputs = contenders.map(|contender| contender.renderer.render(scene, request));
    let judge = Judge::new(scene, share);
    let attributions = [0, 1].map(|side| {
        let made_with = contenders[side].approximations();
        let precision = contenders[side].renderer.precision();
        let errs = made_with != Switches::EXACT;
        errs.then(|| attribute(&judge, &outputs[side], made_with, precision))
    });
    let [a, b] = [0, 1].map(|side| Side {
        name: contenders[side].renderer.name(),
        output: &outputs[side],
        precision: contenders[side].renderer.precision(),
        attributions: attributions[side].as_ref(),
    });
    ask(&judge, a, b)
}
