//! How large a mistake passes: for each [`Slack`], the smallest size that a pack's bench notices.
//!
//! A renderer that keeps a clause with a tolerance answers the pencils of the bench, and is checked as any candidate is. The
//! size of its tolerance falls until no answer is wrong.

use std::sync::Arc;

use rayon::prelude::*;
use raypencil_judge::{Class, GroundTruth, Recorded, check_ray_against};
use raypencil_naive::{Lax, Slack, SlackUnit};
use raypencil_scene::{
    Hit, Pixel, Place, Precision, Progress, RenderOutput, Renderer, Request, Returns, Scene, SceneError,
    SensorId, Silent,
};

use crate::bench::BENCH_BEAMS;

/// Decades that are tried, as exponents of ten: below the last nothing is left of a double's digits.
const DECADES: std::ops::RangeInclusive<i32> = -16..=-1;

/// Largest sizes that a pack with a [bench](crate::with_bench) may leave unnoticed in double precision, by the slack's unit. Tuned: some
/// times what `docs/evidence/slack.md` shows.
const MAX_CELLS: f64 = 1e-7;
const MAX_PIXELS: f64 = 1e-7;
const MAX_COSINE: f64 = 1e-6;
const MAX_SHARE: f64 = 1e-6;
/// The same for the two ends of shadow rays: biases are the commonest mistake of all.
const MAX_SHADOW_BIAS: f64 = 1e-9;

/// How large a tolerance of one clause may be before it is noticed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sharpness {
    /// The clause and how it is kept.
    pub slack: Slack,
    /// The smallest size that was noticed, in the slack's unit, found by halving; the next smaller one was not. `None`: not even the
    /// largest is.
    pub noticed: Option<f64>,
    /// Whether the next smaller size changed answers as well, each so little that rounding excuses it. Else no ray of the bench
    /// passes the limit closer.
    pub excused: bool,
}

impl Sharpness {
    /// Whether a pack with a bench is as sharp here as it has to be, in double precision.
    pub fn suffices(&self) -> bool {
        let most = match (self.slack, self.slack.unit()) {
            (Slack::ShadowStartsAway | Slack::ShadowStopsShort, _) => MAX_SHADOW_BIAS,
            (_, SlackUnit::Cells) => MAX_CELLS,
            (_, SlackUnit::Pixels) => MAX_PIXELS,
            (_, SlackUnit::Cosine) => MAX_COSINE,
            (_, SlackUnit::Share) => MAX_SHARE,
        };
        self.noticed.is_some_and(|noticed| noticed <= most)
    }
}

/// A scene of the bench alone: the same mesh and camera, and the last beams.
struct Bench {
    scene: Scene,
    request: Request,
}

impl Bench {
    fn of(scene: &Scene) -> Result<Self, SceneError> {
        let first = scene.beams().len().saturating_sub(BENCH_BEAMS);
        let beams = scene.beams()[first..].to_vec();
        let mesh = Arc::clone(scene.mesh());
        let bench = Scene::new(mesh, *scene.camera(), beams, scene.atmosphere(), scene.flux_model())?;
        Ok(Self { scene: bench, request: Request { camera: false, ..Request::EVERYTHING } })
    }

    fn places(&self) -> Vec<Place> {
        let sensors = self.scene.sensors().filter(|sensor| *sensor != SensorId::Camera);
        let of_sensor = |sensor: SensorId| {
            let (columns, rows) = self.scene.size(sensor).unwrap_or_default();
            (0..rows).flat_map(move |j| (0..columns).map(move |i| Place { sensor, i, j }))
        };
        sensors.flat_map(of_sensor).collect()
    }
}

/// What an output says of a pencil, as bits: NaN equals NaN.
fn said(output: &RenderOutput, Place { sensor, i, j }: Place) -> [u64; 16] {
    let mut bits = [0; 16];
    if let Some(Hit { face, range, point, normal, depth, cos_incidence }) =
        output.map(sensor).and_then(|map| map.hit(i, j))
    {
        bits[0] = 1 + u64::from(face.0);
        let values = [range, point.x, point.y, point.z, normal.x, normal.y, normal.z, depth, cos_incidence];
        bits[1..].iter_mut().zip(values).for_each(|(bits, value)| *bits = value.to_bits());
    }
    let SensorId::Beam(beam) = sensor else { return bits };
    let Returns { visible, pixel, depth, cos_off_axis, cos_view, flux, .. } = &output.returns[beam];
    bits[10] = visible.as_ref().map_or(0, |image| u64::from(image.at(i, j)));
    let pixel = pixel.as_ref().and_then(|image| image.at(i, j).get());
    bits[11] = pixel.map_or(u64::MAX, |Pixel { i, j }| u64::from(i) << 32 | u64::from(j));
    for (bits, image) in bits[12..].iter_mut().zip([depth, cos_off_axis, cos_view]) {
        *bits = image.as_ref().and_then(|image| image.at(i, j).get()).map_or(u64::MAX, f64::to_bits);
    }
    bits[15] = flux.as_ref().map_or(u64::MAX, |image| image.at(i, j).to_bits());
    bits
}

/// What is done with a function that says what a slack of some size does to the answers of a bench, in some precision.
type ByChange<'a, R> = &'a dyn Fn(&dyn Fn(Slack, f64, Precision) -> Change) -> R;

/// Measures by a scene's bench.
fn by_bench<R>(scene: &Scene, of: ByChange<'_, R>) -> Result<R, SceneError> {
    let bench = Bench::of(scene)?;
    let truth = GroundTruth::certified(&bench.scene, &Silent);
    let places = bench.places();
    let honest = Lax { slack: Slack::ShiftRight, size: 0.0 }.render(&bench.scene, &bench.request);
    Ok(of(&|slack, size, precision| {
        let lax = Lax { slack, size }.render(&bench.scene, &bench.request);
        let recorded = Recorded::of_output("lax", &bench.scene, &lax, precision);
        let changed: Vec<Place> =
            places.iter().copied().filter(|place| said(&lax, *place) != said(&honest, *place)).collect();
        let is_wrong = |place: &Place| {
            let checked = check_ray_against(&truth, &recorded, *place);
            checked.is_some_and(|checked| checked.class == Some(Class::Defect))
        };
        match changed.par_iter().any(is_wrong) {
            true => Change::Wrong,
            false if changed.is_empty() => Change::Nothing,
            false => Change::Excused,
        }
    }))
}

/// The sizes that are tried of a slack, the smallest first.
fn sizes(slack: Slack) -> Vec<f64> {
    let sizes = DECADES.flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| size(digit, decade)));
    sizes.filter(|size| *size <= slack.largest()).collect()
}

/// The sharpness of a scene's bench for candidates that compute in `precision`, slack by slack.
///
/// # Errors
/// As [`Scene::new`].
pub fn sharpness(
    scene: &Scene,
    precision: Precision,
    progress: &dyn Progress,
) -> Result<Vec<Sharpness>, SceneError> {
    by_bench(scene, &|changes| {
        let smallest = |slack: Slack| {
            progress.stage(&format!("sharpness: {}", slack.key()));
            let sizes = sizes(slack);
            // By halving: `noticed` is noticed, and `passes` is not.
            let (mut noticed, mut passes, mut of_passing) = (None, None, Change::Nothing);
            let Some(mut at) = sizes.len().checked_sub(1) else {
                return Sharpness { slack, noticed: None, excused: false };
            };
            loop {
                match changes(slack, sizes[at], precision) {
                    Change::Wrong => noticed = Some(at),
                    other => (passes, of_passing) = (Some(at), other),
                }
                let first = passes.map_or(0, |passes| passes + 1);
                match noticed {
                    Some(noticed) if first < noticed => at = (first + noticed) / 2,
                    _ => break,
                }
            }
            let excused = of_passing == Change::Excused;
            Sharpness { slack, noticed: noticed.map(|place| sizes[place]), excused }
        };
        Slack::ALL.iter().copied().map(smallest).collect()
    })
}

/// The place of the first of some statements on sizes that is not so: the stated size is noticed in its precision, and the next
/// smaller one is not. That takes two renderings, where finding the size takes six.
///
/// # Errors
/// As [`Scene::new`].
pub(crate) fn first_false(
    scene: &Scene,
    stated: &[(Slack, Precision, Option<f64>)],
) -> Result<Option<usize>, SceneError> {
    by_bench(scene, &|changes| {
        let is_so = |(slack, precision, noticed): &(Slack, Precision, Option<f64>)| {
            let sizes = sizes(*slack);
            let place = match noticed {
                None => Some(sizes.len()),
                Some(noticed) => sizes.iter().position(|size| size == noticed),
            };
            place.is_some_and(|place| {
                let is_noticed = |size: &f64| changes(*slack, *size, *precision) == Change::Wrong;
                sizes.get(place).is_none_or(is_noticed)
                    && !place.checked_sub(1).map(|below| &sizes[below]).is_some_and(is_noticed)
            })
        };
        stated.iter().position(|one| !is_so(one))
    })
}

/// What a slack does to the answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Change {
    Nothing,
    Excused,
    Wrong,
}

/// The number `digit` times ten to the `decade`, as its text reads.
fn size(digit: f64, decade: i32) -> f64 {
    format!("{digit}e{decade}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
#[path = "../tests/unit/sharpness.rs"]
mod tests;
