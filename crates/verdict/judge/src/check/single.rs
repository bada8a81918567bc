//! One ray of a recording against the exact answer, which is computed for that ray alone.

use crate::check::ground_truth::GroundTruth;
use crate::check::hit::judge_hit;
use crate::check::pencil::judge_return;
use crate::class::{COMPARE_CLASSES, Class};
use crate::entry::RayEntry;
use crate::item_value::{ItemValue, difference_unit};
use crate::quantity::{Item, Quantity};
use crate::recorded::Recorded;
use crate::scene_answers::{Answers, BeamLight};
use crate::tally::{ItemTally, SensorResult};
use raypencil_referee::{Format, Referee};
use raypencil_scene::{
    HitQuantity, HitRasterMut, Maybe, Place, Quantities, Returns, Sampling, Scene, SensorId, SensorMap,
};

/// One ray of a recording, judged.
#[derive(Debug, Clone)]
pub struct CheckedRay {
    /// The ray.
    pub place: Place,
    /// The worst class of its items; `None` if nothing of it is given.
    pub class: Option<Class>,
    /// The referee's ruling in words.
    pub ruling: String,
    /// All that is wrong, in words; empty if nothing is.
    pub what: String,
    /// Each quantity of the ray. The flux of a pixel, a sum over many pencils, is here only if the exact images are known,
    /// and without a class.
    pub items: Vec<CheckedItem>,
}

/// One item of a ray, judged.
#[derive(Debug, Clone)]
pub struct CheckedItem {
    /// The item.
    pub item: Item,
    /// What the recording says; `None` if it does not give the item.
    pub said: Option<String>,
    /// What is true.
    pub truth: String,
    /// How far the recording is from the truth, in `difference_unit`; `None` if one of both is no number.
    pub difference: Option<f64>,
    /// Unit of the difference; empty for a pure number.
    pub difference_unit: &'static str,
    /// Ratio of the error to its bound, held to the face that is judged; `None` without numbers.
    pub ratio: Option<f64>,
    /// Whether the error of that ratio is the difference. It is another one where the answer is judged against another face than the
    /// exact one, or by its own visibility.
    pub is_ratio_of_difference: bool,
    /// The class; `None` if the item was not compared.
    pub class: Option<Class>,
}

/// Whether two errors are one, but for the rounding of its computation. Without numbers there is none to take for another.
fn is_same_error(difference: Option<f64>, judged: Option<f64>) -> bool {
    let (Some(difference), Some(judged)) = (difference, judged) else { return true };
    // As many digits as are shown.
    difference == judged || (difference.abs() - judged.abs()).abs() <= 1e-3 * difference.abs()
}

/// Judges one ray of a recording as [`crate::check()`] does, without the exact answers to all others. `None`: the scene
/// has no such ray.
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
/// use raypencil_judge::{Class, Recorded, check_ray};
/// use raypencil_referee::ExactRenderer;
/// use raypencil_scene::{Maybe, Place, Precision, Renderer, Request, SensorId};
///
/// let mut output = ExactRenderer.render(&scene, &Request::MAPS);
/// output.camera.as_mut().unwrap().range.as_mut().unwrap().set(4, 4, Maybe::some(2.5));
/// let recorded = Recorded::of_output("mine", &scene, &output, Precision::F64);
/// let ray = check_ray(&scene, &recorded, Place { sensor: SensorId::Camera, i: 4, j: 4 }).unwrap();
///
/// // Pixel (4, 4) looks along z: its range is 2 m.
/// let range = &ray.items[2];
/// assert_eq!((range.said.as_deref(), range.truth.as_str()), (Some("2.5 m"), "2 m"));
/// assert_eq!((range.difference, range.class), (Some(0.5), Some(Class::Defect)));
/// assert_eq!(ray.class, Some(Class::Defect));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn check_ray(scene: &Scene, recorded: &Recorded, place: Place) -> Option<CheckedRay> {
    let Place { sensor, i, j } = place;
    scene.ray(sensor, i, j)?;
    let truth = GroundTruth::of_answers(scene, answers_to_one_ray(scene, place));
    check_ray_against(&truth, recorded, place)
}

/// As [`check_ray`], where the exact answers to all rays are there already.
pub fn check_ray_against(truth: &GroundTruth<'_>, recorded: &Recorded, place: Place) -> Option<CheckedRay> {
    let (scene, Place { sensor, i, j }) = (truth.scene(), place);
    scene.ray(sensor, i, j)?;
    let mut result = SensorResult::new(sensor);
    let mut entry = RayEntry::checked(place, &mut result);
    let assumed = judge_hit(truth, recorded, &mut entry);
    if sensor != SensorId::Camera {
        judge_return(truth, recorded, &mut entry, &assumed);
    }
    let ruling = entry.ruling().to_string();
    entry.finish(String::new);

    let model = scene.flux_model();
    let item = |item: Item| {
        let tally = result.items.get(item).cloned().unwrap_or_default();
        // Without a channel nothing is said, whatever other channels tell of the ray.
        let is_given = item.quantity == Quantity::Hit || recorded.storage.contains_key(&(sensor, item));
        let said = ItemValue::of_answers(&recorded.answers, model, place, item).filter(|_| is_given);
        let exact = ItemValue::of_answers(truth.answers(), model, place, item)?;
        let class = class_of(&tally);
        // The ranges of one face are no difference of the face.
        let is_range_of_face =
            matches!(item.quantity, Quantity::Hit | Quantity::Face) && class == Some(Class::Agree);
        let difference = said.as_ref().filter(|_| !is_range_of_face).and_then(|said| said.distance(&exact));
        let judged = tally.worst_error.as_ref().map(|largest| largest.value);
        Some(CheckedItem {
            item,
            difference,
            is_ratio_of_difference: is_same_error(difference, judged),
            difference_unit: difference_unit(model, item),
            said: said.map(|said| said.words),
            truth: exact.words,
            ratio: tally.worst_ratio.as_ref().map(|largest| largest.value),
            class,
        })
    };
    let plain = Quantity::ALL.into_iter().filter(|one| one.is_of(sensor) && *one != Quantity::PixelFlux);
    let other = (sensor != SensorId::Camera).then(|| Item::pencil_flux(true));
    let beams = if sensor == SensorId::Camera { scene.beams().len() } else { 0 };
    let images = (0..beams).map(Item::of_image);
    Some(CheckedRay {
        place,
        class: (result.compared() > 0).then(|| class_of_counts(&result.by_class)).flatten(),
        ruling,
        what: result.defects.first().map_or(String::new(), |defect| defect.what.clone()),
        items: plain.map(Item::from).chain(other).chain(images).filter_map(item).collect(),
    })
}

fn class_of(tally: &ItemTally) -> Option<Class> {
    class_of_counts(&tally.by_class)
}

/// The class of the one ray that is counted.
fn class_of_counts(counts: &[u64; Class::COUNT]) -> Option<Class> {
    COMPARE_CLASSES.into_iter().find(|class| counts[*class as usize] > 0)
}

/// The exact answers to one ray; all other cells are empty and must not be asked for.
fn answers_to_one_ray(scene: &Scene, Place { sensor, i, j }: Place) -> Answers {
    let mut answers = Answers::none(scene);
    let (width, height) = scene.size(sensor).expect("a sensor of this scene");
    let referee = Referee::new(scene);
    let hit = referee.values(sensor, i, j).map(|hit| hit.in_format(Format::Double));
    let map = match sensor {
        SensorId::Camera => &mut answers.maps[0],
        SensorId::Beam(beam) => &mut answers.maps[beam + 1],
    };
    *map = SensorMap::empty(sensor, width, height, Quantities::ALL);
    if let Some(hit) = &hit {
        if let Some(faces) = &mut map.face {
            faces.set(i, j, Maybe::some(hit.face));
        }
        for quantity in HitQuantity::ALL {
            let value = hit.value(quantity);
            match map.raster_mut(quantity) {
                HitRasterMut::Scalar(Some(image)) => image.set(i, j, value.scalar().into()),
                HitRasterMut::Vector(Some(image)) => image.set(i, j, value.vector().into()),
                HitRasterMut::Scalar(None) | HitRasterMut::Vector(None) => {}
            }
        }
    }
    let SensorId::Beam(beam) = sensor else { return answers };
    let mut returns = Returns::empty(width, height);
    let mut other_flux = returns.flux.clone();
    let light = referee.light(beam, Sampling::Centres);
    if let Some(exact) = light.and_then(|light| light.returned(i, j)) {
        let model = scene.flux_model();
        let [own, other] = [model, model.other()].map(|model| exact.in_format(Format::Double, model));
        if let Some(image) = &mut returns.visible {
            image.set(i, j, own.visible);
        }
        if let Some(image) = &mut returns.pixel {
            image.set(i, j, own.pixel.into());
        }
        for (image, value) in [
            (&mut returns.depth, own.depth),
            (&mut returns.cos_off_axis, own.cos_off_axis),
            (&mut returns.cos_view, own.cos_view),
        ] {
            if let Some(image) = image {
                image.set(i, j, Maybe::some(value));
            }
        }
        for (image, flux) in [(&mut returns.flux, own.flux), (&mut other_flux, other.flux)] {
            if let Some(image) = image {
                image.set(i, j, flux);
            }
        }
    }
    answers.light[beam] = BeamLight { returns, image: None, other_flux, other_image: None };
    answers
}
