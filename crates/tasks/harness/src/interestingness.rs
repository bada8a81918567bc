//! Interestingness tests of the reduction: do two renderers still differ by a class, and on which ray first?

use raypencil_judge::{
    Class, FirstOfClass, Judge, JudgeShare, Side, class_of_ray, compare_judged, first_of_class,
};
use raypencil_scene::{Place, Request, Scene, SensorId, Switches};

use crate::renderers::{Contender, attribute};

/// An interestingness test: whether two renderers differ by `class` at a given ray, or, without one, at any ray.
///
/// The referee rules on every ray that is compared: a ray that the reduction moves to another cell must not leave the
/// sample.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// use raypencil_harness::{contender, first_interesting_ray, is_interesting_in_class};
/// use raypencil_judge::{Class, JudgeShare};
/// # use raypencil_scene::{Atmosphere, FluxModel, Scene, rig};
///
/// # let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
/// let pair = ["scanline", "tracer"].map(|name| contender(name).expect("a renderer's name"));
/// let pair = [&pair[0], &pair[1]];
/// // Both renderers are right on the pyramids: no ray is a defect, so there is nothing to reduce.
/// assert!(!is_interesting_in_class(pair, Class::Defect)(&scene, None));
/// assert!(first_interesting_ray(pair, &scene, Class::Defect, JudgeShare::Sample).is_none());
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn is_interesting_in_class<'a>(
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

/// The first ray on which two renderers differ by `class`: where a reduction begins. The referee rules on `share` of
/// the rays that agree.
pub fn first_interesting_ray(
    contenders: [&Contender; 2],
    scene: &Scene,
    class: Class,
    share: JudgeShare,
) -> Option<FirstOfClass> {
    compared(contenders, scene, &Request::EVERYTHING, share, |judge, a, b| first_of_class(judge, a, b, class))
}

/// Renders the scene with both contenders, attributes errors to the paper's approximations, and passes both sides to
/// `ask`.
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
        let approximations = contenders[side].approximations();
        let precision = contenders[side].renderer.precision();
        let approximates = approximations != Switches::EXACT;
        approximates.then(|| attribute(&judge, &outputs[side], approximations, precision))
    });
    let [a, b] = [0, 1].map(|side| Side {
        name: contenders[side].renderer.name(),
        output: &outputs[side],
        precision: contenders[side].renderer.precision(),
        attributions: attributions[side].as_ref(),
    });
    ask(&judge, a, b)
}
