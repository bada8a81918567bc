//! A recording judged by the truth, ray by ray and quantity by quantity.
//!
//! An answer is no fault if it is exact, ties, or is right for a ray that the declared arithmetic may have displaced.
//! Every value must be that of the face that is named, to within the error that the arithmetic and the storage explain.
//! A channel that is absent is not compared, which is no pass.

pub(crate) mod ground_truth;
mod hit;
mod pencil;
mod pixel;
pub(crate) mod single;
mod single_text;
mod stored;
mod uncertain;

use rayon::prelude::*;
use std::collections::BTreeMap;

use crate::check::ground_truth::GroundTruth;
use crate::check::hit::judge_hit;
use crate::check::pencil::{PencilContribution, judge_return, tells_light};
use crate::check::pixel::BeamImage;
use crate::check::uncertain::uncertain_fluxes;
use crate::class::Class;
use crate::entry::RayEntry;
use crate::item_value::{ItemValue, difference_unit};
use crate::listed::{Described, list_defects};
use crate::quantity::Item;
use crate::recorded::Recorded;
use crate::tally::{ItemTally, SensorResult};
use raypencil_scene::{Place, Progress, SensorId};

/// A recording judged.
#[derive(Debug, Clone)]
pub struct Check {
    /// Each sensor, the camera first.
    pub sensors: Vec<SensorResult>,
}

impl Check {
    /// Rays in a class, over all sensors.
    pub fn of(&self, class: Class) -> u64 {
        self.sensors.iter().map(|sensor| sensor.by_class[class as usize]).sum()
    }

    /// Rays of which anything was compared.
    pub fn compared(&self) -> u64 {
        self.sensors.iter().map(SensorResult::compared).sum()
    }

    /// Each quantity over all sensors.
    pub fn totals(&self) -> BTreeMap<Item, ItemTally> {
        let mut totals: BTreeMap<Item, ItemTally> = BTreeMap::new();
        for (item, tally) in self.sensors.iter().flat_map(|sensor| sensor.items.iter()) {
            totals.entry(item).or_default().add(tally);
        }
        totals
    }

    /// Whether something was compared, and nothing of it is a defect or undecided.
    pub fn passes(&self) -> bool {
        self.compared() > 0 && self.of(Class::Defect) == 0 && self.of(Class::Undecided) == 0
    }
}

/// Judges a recording of the truth's scene.
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
/// use raypencil_judge::{GroundTruth, Quantity, Recorded, check};
/// use raypencil_referee::ExactRenderer;
/// use raypencil_scene::{Precision, Renderer, Request, Silent};
///
/// let output = ExactRenderer.render(&scene, &Request::MAPS);
/// let recorded = Recorded::of_output("exact", &scene, &output, Precision::F64);
/// let found = check(&GroundTruth::certified(&scene, &Silent), &recorded, &Silent);
///
/// // The five columns of pixels from x = -1 m to x = 0 hit the wall: 45 ranges, all of them exact.
/// assert!(found.passes());
/// assert_eq!(found.compared(), 81);
/// let ranges = &found.totals()[&Quantity::Range.into()];
/// assert_eq!(ranges.compared(), 45);
/// assert_eq!(ranges.worst_ulps.as_ref().unwrap().value, 0.0);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn check(truth: &GroundTruth<'_>, recorded: &Recorded, progress: &dyn Progress) -> Check {
    check_rays(truth, recorded, &|_| true, progress)
}

/// Judges some rays of a recording: those that are asked for.
///
/// The flux of a pixel is the sum over pencils. It is judged rightly only if all pencils are asked for.
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
/// // Rows 0, 3 and 6 of nine: 27 of 81 pixels.
/// use raypencil_judge::{GroundTruth, Recorded, check_rays};
/// use raypencil_referee::ExactRenderer;
/// use raypencil_scene::{Precision, Renderer, Request, Silent};
///
/// let output = ExactRenderer.render(&scene, &Request::MAPS);
/// let recorded = Recorded::of_output("exact", &scene, &output, Precision::F64);
/// let truth = GroundTruth::certified(&scene, &Silent);
/// assert_eq!(check_rays(&truth, &recorded, &|place| place.j % 3 == 0, &Silent).compared(), 27);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn check_rays(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    is_asked: &(dyn Fn(Place) -> bool + Sync),
    progress: &dyn Progress,
) -> Check {
    let scene = truth.scene();
    // The beams first: a pixel is judged by the pencils that land there.
    let mut images = Vec::new();
    let mut beams = Vec::new();
    for beam in 0..scene.beams().len() {
        let sensor = SensorId::Beam(beam);
        progress.stage(&format!("{sensor}: judging"));
        let (checked, delivered) = check_beam(truth, recorded, beam, is_asked);
        let mut image = BeamImage::empty(truth, beam);
        delivered.iter().for_each(|contribution| image.add(contribution));
        let light = &recorded.answers.light[beam];
        let says_image = light.image.is_some() || light.other_image.is_some();
        if says_image && !tells_light(light) {
            progress.stage(&format!("{sensor}: pencils that may go either way"));
            let uncertain: Vec<_> = places(truth, sensor)
                .into_par_iter()
                .map(|place| uncertain_fluxes(truth, recorded, place))
                .collect();
            uncertain.into_iter().for_each(|fluxes| image.add_uncertain(fluxes));
        }
        images.push(image);
        beams.push(checked);
    }
    progress.stage("camera: judging");
    let camera = by_rows(truth, SensorId::Camera, |place, row| {
        if is_asked(place) {
            judge_ray(truth, recorded, &images, RayEntry::checked(place, row));
        }
    });
    let mut sensors: Vec<SensorResult> = std::iter::once(camera).chain(beams).collect();
    progress.stage("listing the worst defects");
    let model = scene.flux_model();
    list_defects(truth.judge(), &mut sensors, |place, item| Described {
        said: ItemValue::of_answers(&recorded.answers, model, place, item)
            .map(|value| (recorded.name.clone(), value))
            .into_iter()
            .collect(),
        truth: ItemValue::of_answers(truth.answers(), model, place, item),
        difference_unit: difference_unit(model, item),
        what: what_is_wrong(truth, recorded, &images, place),
    });
    Check { sensors }
}

/// Judges one ray: its hit; then a pencil's return, or what the beams whose images are given deliver into a pixel.
fn judge_ray(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    images: &[BeamImage],
    mut entry: RayEntry<'_>,
) -> PencilContribution {
    let assumed = judge_hit(truth, recorded, &mut entry);
    let contribution = judge_return(truth, recorded, &mut entry, &assumed);
    if entry.place.sensor == SensorId::Camera {
        images.iter().for_each(|image| image.judge(truth, recorded, &mut entry));
    }
    entry.finish(String::new);
    contribution
}

/// All that is wrong with one ray, in words: the ray is judged once more by itself.
fn what_is_wrong(truth: &GroundTruth<'_>, recorded: &Recorded, images: &[BeamImage], place: Place) -> String {
    let mut alone = SensorResult::new(place.sensor);
    judge_ray(truth, recorded, images, RayEntry::checked(place, &mut alone));
    alone.defects.pop().map_or(String::new(), |defect| defect.what)
}

/// Judges a beam's pencils, and gives what each contributes to the image, in row-major order: the true light where the
/// recording does not tell.
fn check_beam(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    beam: usize,
    is_asked: &(dyn Fn(Place) -> bool + Sync),
) -> (SensorResult, Vec<PencilContribution>) {
    let sensor = SensorId::Beam(beam);
    let (width, height) = truth.scene().size(sensor).expect("a sensor of this scene");
    let rows: Vec<(SensorResult, Vec<PencilContribution>)> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = SensorResult::new(sensor);
            let delivered = (0..width).map(|i| {
                let place = Place { sensor, i, j };
                if !is_asked(place) {
                    return PencilContribution::default();
                }
                judge_ray(truth, recorded, &[], RayEntry::checked(place, &mut row))
            });
            let delivered = delivered.collect();
            (row, delivered)
        })
        .collect();
    let mut all = SensorResult::new(sensor);
    let mut delivered = Vec::with_capacity(width as usize * height as usize);
    for (row, of_row) in rows {
        all.add(row);
        delivered.extend(of_row);
    }
    (all, delivered)
}

/// Judges rows in parallel and adds them up in their order: the result does not depend on threads.
fn by_rows(
    truth: &GroundTruth<'_>,
    sensor: SensorId,
    judge: impl Fn(Place, &mut SensorResult) + Sync,
) -> SensorResult {
    let (width, height) = truth.scene().size(sensor).expect("a sensor of this scene");
    let rows: Vec<SensorResult> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = SensorResult::new(sensor);
            (0..width).for_each(|i| judge(Place { sensor, i, j }, &mut row));
            row
        })
        .collect();
    let mut all = SensorResult::new(sensor);
    rows.into_iter().for_each(|row| all.add(row));
    all
}

fn places(truth: &GroundTruth<'_>, sensor: SensorId) -> Vec<Place> {
    let (width, height) = truth.scene().size(sensor).expect("a sensor of this scene");
    (0..height).flat_map(|j| (0..width).map(move |i| Place { sensor, i, j })).collect()
}
