//! A recording judged by the truth, ray by ray and quantity by quantity.
//!
//! What is exact, ties, or is right for a ray that the declared arithmetic may have displaced is no fault; every
//! value must be that of the face that is named, to within what the arithmetic and the storage explain. What is
//! not said is not compared, which is no pass.

pub(crate) mod doubt;
pub(crate) mod pencil;
pub(crate) mod pixel;
pub(crate) mod ray;
pub(crate) mod said;
pub(crate) mod tally;
pub(crate) mod truth;

use rayon::prelude::*;
use std::collections::BTreeMap;

use crate::check::doubt::alternatives;
use crate::check::pencil::{Landing, judge_back};
use crate::check::pixel::BeamImage;
use crate::check::ray::{Judged, judge_hit};
use crate::check::said::SaidBack;
use crate::class::{Class, Item};
use crate::recorded::Recorded;
use raypencil_scene::Place;
use raypencil_scene::{Progress, SensorId};

pub use crate::check::tally::{ItemTally, Largest, SensorCheck, Wrong};
pub use crate::check::truth::Truth;

/// A recording judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Each sensor, the camera first.
    pub sensors: Vec<SensorCheck>,
}

impl Check {
    /// Rays in a class, over all sensors.
    pub fn of(&self, class: Class) -> u64 {
        self.sensors.iter().map(|sensor| sensor.by_class[class as usize]).sum()
    }

    /// Rays of which anything was compared.
    pub fn compared(&self) -> u64 {
        self.sensors.iter().map(SensorCheck::compared).sum()
    }

    /// Each quantity over all sensors.
    pub fn totals(&self) -> BTreeMap<Item, ItemTally> {
        let mut totals: BTreeMap<Item, ItemTally> = BTreeMap::new();
        for (item, tally) in self.sensors.iter().flat_map(|sensor| &sensor.items) {
            totals.entry(*item).or_default().add(tally.clone());
        }
        totals
    }

    /// Whether something was compared, and nothing of it is a defect or undecided.
    pub fn passes(&self) -> bool {
        self.compared() > 0 && self.of(Class::Defect) == 0 && self.of(Class::Undecided) == 0
    }
}

/// Judges a recording of the truth's scene.
pub fn check(truth: &Truth<'_>, recorded: &Recorded, progress: &dyn Progress) -> Check {
    let scene = truth.scene();
    // The beams first: a pixel is judged by the pencils that land there.
    let mut images = Vec::new();
    let mut beams = Vec::new();
    for beam in 0..scene.beams().len() {
        let sensor = SensorId::Beam(beam);
        progress.stage(&format!("{sensor}: judging"));
        let (checked, delivered) = check_beam(truth, recorded, beam);
        let mut image = BeamImage::empty(truth, beam);
        delivered.iter().for_each(|landing| image.land(landing));
        let light = &recorded.answers.light[beam];
        let says_image = light.image.is_some() || light.other_image.is_some();
        if says_image && !SaidBack::tells_light(light) {
            progress.stage(&format!("{sensor}: pencils that may go either way"));
            let possible: Vec<_> = places(truth, sensor)
                .into_par_iter()
                .map(|place| alternatives(truth, recorded, place))
                .collect();
            possible.into_iter().for_each(|possible| image.may_land(possible));
        }
        images.push(image);
        beams.push(checked);
    }
    progress.stage("camera: judging");
    let camera = by_rows(truth, SensorId::Camera, |place, row| {
        let mut judged = Judged::new(place, row);
        judge_hit(truth, recorded, &mut judged);
        images.iter().for_each(|image| image.judge(truth, recorded, &mut judged));
        judged.finish();
    });
    Check { sensors: std::iter::once(camera).chain(beams).collect() }
}

/// A beam's pencils, and what each delivers in row-major order. The truth's own, if the recording does not tell.
fn check_beam(truth: &Truth<'_>, recorded: &Recorded, beam: usize) -> (SensorCheck, Vec<Landing>) {
    let sensor = SensorId::Beam(beam);
    let (width, height) = truth.scene().size(sensor).expect("a sensor of this scene");
    let rows: Vec<(SensorCheck, Vec<Landing>)> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = SensorCheck::new(sensor);
            let delivered = (0..width).map(|i| {
                let mut judged = Judged::new(Place { sensor, i, j }, &mut row);
                let reference = judge_hit(truth, recorded, &mut judged);
                let delivered = judge_back(truth, recorded, &mut judged, &reference);
                judged.finish();
                delivered
            });
            let delivered = delivered.collect();
            (row, delivered)
        })
        .collect();
    let mut all = SensorCheck::new(sensor);
    let mut delivered = Vec::with_capacity(width as usize * height as usize);
    for (row, of_row) in rows {
        all.add(row);
        delivered.extend(of_row);
    }
    (all, delivered)
}

/// Rows in parallel, added up in their order: the result does not depend on threads.
fn by_rows(
    truth: &Truth<'_>,
    sensor: SensorId,
    judge: impl Fn(Place, &mut SensorCheck) + Sync,
) -> SensorCheck {
    let (width, height) = truth.scene().size(sensor).expect("a sensor of this scene");
    let rows: Vec<SensorCheck> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = SensorCheck::new(sensor);
            (0..width).for_each(|i| judge(Place { sensor, i, j }, &mut row));
            row
        })
        .collect();
    let mut all = SensorCheck::new(sensor);
    rows.into_iter().for_each(|row| all.add(row));
    all
}

fn places(truth: &Truth<'_>, sensor: SensorId) -> Vec<Place> {
    let (width, height) = truth.scene().size(sensor).expect("a sensor of this scene");
    (0..height).flat_map(|j| (0..width).map(move |i| Place { sensor, i, j })).collect()
}
