//! Two renderers' outputs of one scene, ray by ray: what agrees, and what each difference is.
//!
//! A ray is a cell of a sensor: a pencil or a pixel. Its class is the worst of its quantities', and the classes of all
//! rays add up to those compared. The referee rules on every ray whose two answers differ, and on a sample of those
//! that agree: two renderers may share a mistake.

mod agreeing;
mod flux_pair;
mod hit;
mod pencil;
mod pixel;
mod ray;
pub(crate) mod side;
pub(crate) mod single;

use rayon::prelude::*;

use crate::answer::{StatedHit, StatedReturn};
use crate::compare::agreeing::AgreeingPixels;
use crate::compare::flux_pair::FluxPair;
use crate::compare::pixel::BeamImages;
use crate::compare::ray::{ComparedRays, compare_ray};
use crate::compare::side::Side;
use crate::item_value::{ItemValue, difference_unit};
use crate::judge::{Judge, JudgeShare};
use crate::listed::{Described, list_defects};
use crate::quantity::{Item, Quantity};
use crate::tally::SensorResult;
use raypencil_referee::Format;
use raypencil_scene::{Image, Place, Sampling, Scene, SensorId, SensorMap};

/// Compares two outputs of `scene`, sensor by sensor, with a judge of its own.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// # use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene};
/// # let corners = vec![[0.125, -40.0, 2.0], [-90.0, 0.0, 2.0], [0.125, 40.0, 2.0]];
/// # let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
/// # let wall = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], vec![plaster])?;
/// # let camera = Camera {
/// #     width: 9, height: 9, pixel_pitch: [0.0625; 2], focal_length: 0.5, principal_point: [4.5; 2],
/// #     aperture: 0.01, lens: Lens::CLEAR, max_range: 20.0,
/// # };
/// # let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(wall), camera, vec![], air, FluxModel::Radiometric)?;
/// // A wall at z = 2 m that ends at x = 1/8 m, before a camera of 9 x 9 pixels at the origin that looks along z.
/// use raypencil_judge::{Class, Quantity, Side, compare};
/// use raypencil_referee::ExactRenderer;
/// use raypencil_scene::{Maybe, Precision, Renderer, Request};
///
/// let right = ExactRenderer.render(&scene, &Request::MAPS);
/// let mut wrong = right.clone();
/// wrong.camera.as_mut().unwrap().range.as_mut().unwrap().set(4, 4, Maybe::some(2.001));
/// let side = |name, output| Side { name, output, precision: Precision::F64, attributions: None };
/// let sensors = compare(&scene, side("right", &right), side("wrong", &wrong));
///
/// // Pixel (4, 4) looks along z: its range is 2 m. An error of 1 mm is 10^10 times more than rounding explains.
/// assert_eq!(sensors[0].of(Class::Agree), 80);
/// assert_eq!(sensors[0].of(Class::Defect), 1);
/// assert_eq!(sensors[0].defects[0].item.quantity, Quantity::Range);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn compare(scene: &Scene, a: Side<'_>, b: Side<'_>) -> Vec<SensorResult> {
    compare_judged(&Judge::new(scene, JudgeShare::Sample), a, b)
}

/// Compares two outputs of the judge's scene, sensor by sensor, the camera first.
pub fn compare_judged(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>) -> Vec<SensorResult> {
    let (beams, light) = compare_beams(judge, a, b);
    let (camera, _) = compare_sensor(judge, SensorId::Camera, a, b, &light);
    let mut sensors: Vec<SensorResult> = std::iter::once(camera).chain(beams).collect();
    list_defects(judge, &mut sensors, |place, item| describe(judge, [a, b], &light, place, item));
    sensors
}

/// What both sides say of a ray, and what is true.
fn describe(
    judge: &Judge<'_>,
    [a, b]: [Side<'_>; 2],
    light: &[BeamImages<'_>],
    place: Place,
    item: Item,
) -> Described {
    let Place { sensor, i, j } = place;
    let model = judge.scene().flux_model();
    let said = [a, b].into_iter().filter_map(|side| {
        let hit = StatedHit::of(side.output.map(sensor)?, i, j);
        let back = match sensor {
            SensorId::Camera => None,
            SensorId::Beam(beam) => side.output.returns.get(beam),
        };
        let back = back.map(|returns| StatedReturn::of(returns, None, i, j));
        Some((side.name.to_string(), ItemValue::stated(&hit, back.as_ref(), model, item)?))
    });
    let exact = judge.referee().values(sensor, i, j).map(|hit| hit.in_format(Format::Double));
    let back = match sensor {
        SensorId::Camera => None,
        SensorId::Beam(beam) => {
            let light = judge.referee().light(beam, Sampling::Centres);
            let back = light.and_then(|light| light.returned(i, j));
            back.map(|back| back.in_format(Format::Double, model))
        }
    };
    let what = match (a.output.map(sensor), b.output.map(sensor)) {
        (Some(of_a), Some(of_b)) => {
            let mut alone = ComparedRays::none(sensor);
            compare_ray(judge, place, (of_a, a), (of_b, b), light, &mut alone);
            alone.result.defects.pop().map_or(String::new(), |defect| defect.what)
        }
        _ => String::new(),
    };
    Described {
        said: said.collect(),
        truth: ItemValue::exact(exact.as_ref(), back.as_ref(), model, item),
        difference_unit: difference_unit(model, item),
        what,
    }
}

/// Compares the beams, which come first: a pixel's flux is judged by the pencils that contribute to it.
fn compare_beams<'f>(
    judge: &Judge<'_>,
    a: Side<'f>,
    b: Side<'f>,
) -> (Vec<SensorResult>, Vec<BeamImages<'f>>) {
    let mut light = Vec::new();
    let mut beams = Vec::new();
    for index in 0..judge.scene().beams().len() {
        let (comparison, pencils) = compare_sensor(judge, SensorId::Beam(index), a, b, &[]);
        beams.push(comparison);
        light.extend(images_of(judge, index, [a, b], pencils));
    }
    (beams, light)
}

/// The images of a beam, if both sides have one and the pencils to judge it by. Pencils are compared only where both
/// sides tell their hits.
fn images_of<'f>(
    judge: &Judge<'_>,
    beam: usize,
    sides: [Side<'f>; 2],
    pencils: Vec<FluxPair>,
) -> Option<BeamImages<'f>> {
    let tells_pencils = sides.iter().all(|side| {
        let returns = side.output.returns.get(beam);
        side.output.map(SensorId::Beam(beam)).is_some_and(tells_hits)
            && returns.is_some_and(|returns| returns.pixel.is_some() && returns.flux.is_some())
    });
    let [of_a, of_b] = sides.map(|side| side.output.flux.get(beam));
    let images = [of_a?, of_b?];
    let [a, b] = sides.map(|side| side.precision.unit_roundoff);
    tells_pencils.then(|| BeamImages::new(judge.scene(), images, pencils, a.max(b)))
}

fn compare_sensor(
    judge: &Judge<'_>,
    sensor: SensorId,
    a: Side<'_>,
    b: Side<'_>,
    light: &[BeamImages<'_>],
) -> (SensorResult, Vec<FluxPair>) {
    if let (Some(of_a), Some(of_b)) = (a.output.map(sensor), b.output.map(sensor))
        && tells_hits(of_a)
        && tells_hits(of_b)
    {
        return compare_maps(judge, sensor, (of_a, a), (of_b, b), light);
    }
    let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
    let not_compared = u64::from(width) * u64::from(height);
    let mut result = SensorResult { not_compared, ..SensorResult::with_all_quantities(sensor) };
    for quantity in Quantity::ALL.into_iter().filter(|quantity| quantity.is_of(sensor)) {
        result.tally(Item::from(quantity)).not_compared = not_compared;
    }
    (result, Vec::new())
}

/// Whether a map tells of each ray if it hits.
fn tells_hits(map: &SensorMap) -> bool {
    map.range.is_some() || map.face.is_some()
}

fn compare_maps(
    judge: &Judge<'_>,
    sensor: SensorId,
    (map_a, a): (&SensorMap, Side<'_>),
    (map_b, b): (&SensorMap, Side<'_>),
    light: &[BeamImages<'_>],
) -> (SensorResult, Vec<FluxPair>) {
    let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
    // Rows in parallel, added up in their order: the result does not depend on threads.
    let rows: Vec<ComparedRays> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = ComparedRays::none(sensor);
            let mut agreeing = match sensor {
                SensorId::Camera => AgreeingPixels::new(judge, (map_a, a), (map_b, b), light),
                SensorId::Beam(_) => None,
            };
            for place in (0..width).map(|i| Place { sensor, i, j }) {
                if !agreeing.as_mut().is_some_and(|agreeing| agreeing.enter(place, &mut row)) {
                    compare_ray(judge, place, (map_a, a), (map_b, b), light, &mut row);
                }
            }
            row
        })
        .collect();
    let mut all = ComparedRays::none(sensor);
    for row in rows {
        all.result.add(row.result);
        all.range_differences.extend(row.range_differences);
        all.light.extend(row.light);
    }
    let range_difference = Some(Image::from_cells(width, height, all.range_differences));
    (SensorResult { range_difference, ..all.result }, all.light)
}
