//! Mistakes of the rays themselves: a renderer with one of them is cast, and its answers are compared.

use std::sync::OnceLock;

use rayon::prelude::*;

use crate::agree::{is_near, tolerance};
use crate::calibrate::calibrations;
use crate::case::Case;
use crate::cast::{Cast, CastHit, cast};
use crate::channel::{Channel, Value};
use crate::correction::{Correction, corrected};
use crate::cuts::{hits, split};
use crate::mistake::Mistake;
use crate::numbers::plainest_between;
use crate::rules::{Numbers, Rules, near_limit, pairs_of_wrong_rules, wrong_poses, wrong_rules};
use crate::sample::{WrongRays, key, some_of, spread_over};
use crate::tally::{MIN_WRONG_RAYS, Tally};
use raypencil_judge::Quantity;
use raypencil_scene::{Place, SensorId};

/// Tests of a ray and a face for one set of rules, at most, beyond the first rays. A test takes nanoseconds.
const MAX_RAY_FACE_TESTS: u64 = 1 << 24;

/// Rays that are cast, at least and at most: half of them wrong ones.
const CAST_RAYS: std::ops::RangeInclusive<u64> = 128..=4096;

/// Wrong rays that are cast first: rules that do not explain nearly all of them are given up.
const FIRST_RAYS: usize = 32;

/// Share of the first wrong rays that rules must explain to be tried on all. Tuned: of 32 rays three may be edges.
const MIN_SHARE_OF_FIRST: f64 = 0.9;

/// Share of the wrong rays that may be near the truth as well. Tuned: nearly all of them must tell the two apart.
const MAX_SHARE_NEAR_TRUTH: f64 = 0.1;

type Render = Vec<Cast>;

/// A reason of rays, and what it explains.
#[derive(Debug, Clone)]
pub(crate) struct ByRays {
    pub(crate) mistakes: Vec<Mistake>,
    pub(crate) rules: Rules,
    pub(crate) tally: Tally,
}

/// Rays cast by the rules of each mistake.
#[derive(Debug)]
pub(crate) struct CastTrial<'t> {
    case: Case<'t>,
    channels: Vec<Channel>,
    wrong: Vec<Place>,
    right: Vec<Place>,
    /// Wrong and right rays in all, of which these are some.
    all: [u64; 2],
    rules: Vec<(Mistake, Rules)>,
    /// The first wrong rays by each rule, once they are asked for.
    first: Vec<OnceLock<Render>>,
}

/// The quantities that are compared: a renderer that hits backs may turn normals and cosines or not.
fn is_compared(channel: &Channel) -> bool {
    matches!(channel.item.quantity, Quantity::Face | Quantity::Range | Quantity::Depth | Quantity::Point)
}

/// What a channel holds of a hit.
fn value_of(channel: Channel, hit: Option<CastHit>) -> Value {
    let Some(hit) = hit else { return Value::Nothing };
    match channel.item.quantity {
        Quantity::Face => Value::Face(hit.face),
        Quantity::Range => Value::Number(hit.range),
        Quantity::Depth => Value::Number(hit.depth),
        Quantity::Point => Value::Vector(hit.point),
        _ => Value::Nothing,
    }
}

impl<'t> CastTrial<'t> {
    pub(crate) fn new(case: Case<'t>, wrong_rays: &WrongRays) -> Self {
        let scene = case.truth.scene();
        let faces = scene.mesh().faces().len().max(1) as u64;
        let rays = (MAX_RAY_FACE_TESTS / faces).clamp(*CAST_RAYS.start(), *CAST_RAYS.end());
        let channels: Vec<Channel> = case.channels().into_iter().filter(is_compared).collect();
        let of_channels = |place: &Place| channels.iter().any(|channel| channel.sensor == place.sensor);
        let mut wrong = some_of(&wrong_rays.of_hits, rays as usize / 2);
        wrong.retain(of_channels);
        // The first of them are spread over all.
        let step = wrong.len().div_ceil(FIRST_RAYS).max(1);
        let order = (0..step).flat_map(|start| wrong.iter().skip(start).step_by(step));
        let wrong: Vec<Place> = order.copied().collect();
        let mut right = spread_over(scene, case.sensors, rays / 2);
        right.retain(|place| of_channels(place) && !wrong_rays.all.contains(&key(*place)));
        let all = [wrong_rays.of_hits.len() as u64, wrong_rays.right()];
        let mut rules = Vec::new();
        if wrong.len() as u64 >= MIN_WRONG_RAYS {
            rules = wrong_rules();
            rules.extend(near_limit_of(case, wrong_rays));
            if let [sensor] = *case.sensors {
                rules.extend(wrong_poses(scene, sensor));
            }
            rules.extend(calibrations(case, &wrong));
        }
        let first = rules.iter().map(|_| OnceLock::new()).collect();
        Self { case, channels, wrong, right, all, rules, first }
    }

    fn render(&self, places: &[Place], rules: Rules) -> Render {
        places.par_iter().map(|place| cast(self.case.truth.scene(), *place, rules)).collect()
    }

    fn first_places(&self) -> &[Place] {
        &self.wrong[..self.wrong.len().min(FIRST_RAYS)]
    }

    /// Explanations by rays of two mistakes.
    pub(crate) fn explain_by_two(&self) -> Vec<ByRays> {
        let pairs = if self.rules.is_empty() { Vec::new() } else { pairs_of_wrong_rules() };
        let explain = |(mistakes, rules): ([Mistake; 2], Rules)| {
            let first = self.render(self.first_places(), rules);
            let tally = self.tally(rules, &first, None)?;
            // The pair is told only where each alone says less.
            let is_needed = mistakes.iter().all(|one| {
                let alone = self.rules.iter().find(|(mistake, _)| mistake == one);
                alone.is_none_or(|(_, alone)| self.differing(rules, *alone) >= MIN_WRONG_RAYS)
            });
            is_needed.then(|| ByRays { mistakes: mistakes.to_vec(), rules, tally })
        };
        pairs.into_iter().filter_map(explain).collect()
    }

    /// Wrong rays that two sets of rules answer otherwise.
    fn differing(&self, a: Rules, b: Rules) -> u64 {
        let [a, b] = [a, b].map(|rules| self.render(&self.wrong, rules));
        let face = |cast: &Cast| cast.hit.map(|hit| (hit.face, hit.range));
        a.iter().zip(&b).filter(|(a, b)| face(a) != face(b)).count() as u64
    }

    /// Explanations by rays of one mistake, after at most one correction.
    pub(crate) fn explain(&self, correction: Option<&Correction>) -> Vec<ByRays> {
        let explain = |((mistake, rules), first): (&(Mistake, Rules), &OnceLock<Render>)| {
            // A shift and another point of the cell undo each other in part: a corner and a shift are another corner.
            let is_shift = correction.is_some_and(|one| matches!(one.mistake, Mistake::Shifted { .. }));
            if is_shift && rules.numbers != Numbers::SCENE {
                return None;
            }
            // So do cells in another order and a sensor that looks elsewhere altogether: upside down, rows are reversed.
            let is_order = correction.is_some_and(|one| {
                matches!(one.mistake, Mistake::RowsReversed | Mistake::ColumnsReversed | Mistake::Transposed)
            });
            if is_order && matches!(mistake, Mistake::PoseInverted | Mistake::QuaternionOrder) {
                return None;
            }
            let first = first.get_or_init(|| self.render(self.first_places(), *rules));
            let tally = self.tally(*rules, first, correction)?;
            let mistakes = correction.map(|one| one.mistake).into_iter().chain([*mistake]).collect();
            Some(ByRays { mistakes, rules: *rules, tally })
        };
        self.rules.iter().zip(&self.first).filter_map(explain).collect()
    }

    /// What rules explain, given the first wrong rays by them; `None` if that is too little.
    pub(crate) fn tally(
        &self,
        rules: Rules,
        first: &[Cast],
        correction: Option<&Correction>,
    ) -> Option<Tally> {
        if self.wrong.is_empty() {
            return None;
        }
        // A correction belongs to the channels in which more of the first rays agree with it.
        let places = self.first_places();
        let count = |near: &[bool]| near.iter().filter(|near| **near).count();
        let mut chosen: Vec<Option<&Correction>> = Vec::new();
        for channel in &self.channels {
            let of = |one: Option<&Correction>| count(&self.near_render(*channel, places, first, one));
            let better = correction.filter(|one| one.touches(*channel) && of(Some(*one)) > of(None));
            chosen.push(better);
        }
        if correction.is_some() && chosen.iter().all(Option::is_none) {
            return None;
        }
        // What is said of all lengths must be true of each.
        let is_left_out = |(channel, chosen): (&Channel, &Option<&Correction>)| {
            chosen.is_none() && correction.is_some_and(|one| one.is_of_all_lengths() && one.touches(*channel))
        };
        if self.channels.iter().zip(&chosen).any(is_left_out) {
            return None;
        }
        let near = |places: &[Place], render: &[Cast]| {
            let mut near = vec![true; places.len()];
            for (channel, one) in self.channels.iter().zip(&chosen) {
                let of_channel = self.near_render(*channel, places, render, *one);
                near.iter_mut().zip(of_channel).for_each(|(near, one)| *near &= one);
            }
            near
        };
        if (count(&near(places, first)) as f64) < MIN_SHARE_OF_FIRST * places.len() as f64 {
            return None;
        }
        // Of rays that meet an edge, rounding decides what they hit: they show nothing, unless edges are what it is about.
        let near_and_all = |places: &[Place]| {
            let render = self.render(places, rules);
            let near = near(places, &render);
            let shows = |(near, cast): &(bool, &Cast)| *near || rules.edges_open || !cast.is_on_edge;
            let shown: Vec<bool> =
                near.into_iter().zip(&render).filter(shows).map(|(near, _)| near).collect();
            [count(&shown) as u64, shown.len() as u64]
        };
        let [[explained, wrong], [kept, right]] =
            [&self.wrong, &self.right].map(|places| near_and_all(places));
        let tally = Tally { explained, wrong, broken: right - kept, right };
        // What is near the truth, too, shows nothing. Of a pair, neither half may be idle.
        let near_truth = |corrections: &[Option<&Correction>]| {
            let mut near = vec![true; self.wrong.len()];
            for (channel, one) in self.channels.iter().zip(corrections) {
                let corrections: Vec<&Correction> = one.iter().copied().collect();
                let own =
                    near.iter_mut().zip(&self.wrong).filter(|(_, place)| place.sensor == channel.sensor);
                for (near, place) in own {
                    let exact = channel.at(self.case.truth.answers(), *place);
                    let value = corrected(self.case, *channel, *place, &corrections);
                    // A ray that stands in no cell shows nothing either.
                    *near &= value.is_none_or(|value| is_near(self.case, *channel, *place, value, exact));
                }
            }
            count(&near)
        };
        let is_new = match correction {
            Some(_) => (self.wrong.len() - near_truth(&chosen)) as u64 >= MIN_WRONG_RAYS,
            None => near_truth(&chosen) as f64 <= MAX_SHARE_NEAR_TRUTH * self.wrong.len() as f64,
        };
        // Rays through other places are known by what they meet: to miss everything, nearly any will do.
        let is_met = rules.numbers == Numbers::SCENE || self.stated_hits(&chosen) >= MIN_WRONG_RAYS;
        (is_new && is_met && tally.is_enough(MIN_WRONG_RAYS, self.all)).then_some(tally)
    }

    /// Wrong rays of which the recording says that they meet something, after the correction that was chosen for each channel.
    fn stated_hits(&self, chosen: &[Option<&Correction>]) -> u64 {
        let says_hit = |place: &&Place| {
            self.channels.iter().zip(chosen).filter(|(channel, _)| channel.sensor == place.sensor).any(
                |(channel, one)| {
                    let corrections: Vec<&Correction> = one.iter().copied().collect();
                    let value = corrected(self.case, *channel, **place, &corrections);
                    value.is_some_and(|value| value != Value::Nothing)
                },
            )
        };
        self.wrong.iter().filter(says_hit).count() as u64
    }

    /// Whether what is stated is near a render, for each place.
    fn near_render(
        &self,
        channel: Channel,
        places: &[Place],
        render: &[Cast],
        correction: Option<&Correction>,
    ) -> Vec<bool> {
        let corrections: Vec<&Correction> = correction.into_iter().collect();
        let near = |(place, cast): (&Place, &Cast)| {
            place.sensor != channel.sensor
                || corrected(self.case, channel, *place, &corrections)
                    .is_none_or(|value| is_near_render(self.case, channel, value, cast.hit))
        };
        places.iter().zip(render).map(near).collect()
    }
}

/// A limit of t above 1 that separates the wrong rays from the right ones.
fn near_limit_of(case: Case<'_>, wrong: &WrongRays) -> Option<(Mistake, Rules)> {
    let [sensor] = *case.sensors else { return None };
    let scene = case.truth.scene();
    let axis = match sensor {
        SensorId::Camera => scene.camera().sensor.focal_length,
        SensorId::Beam(beam) => scene.beams()[beam].sensor.grid_distance,
    };
    let depths = case.truth.answers().map(sensor).depth.as_ref()?;
    let mut rays = hits(case, sensor, wrong, |place| Some(depths.at(place.i, place.j).get()? / axis));
    let [low, high] = split(&mut rays, false)?.between;
    near_limit(plainest_between(low.next_up(), high)).filter(|_| low >= 1.0)
}

/// Whether a stated value is near that of a cast ray.
fn is_near_render(case: Case<'_>, channel: Channel, stated: Value, hit: Option<CastHit>) -> bool {
    match (stated, value_of(channel, hit), hit) {
        (Value::Vector(stated), Value::Vector(point), Some(hit)) => {
            (stated - point).length() <= tolerance(case, channel) * (point.length() + hit.range)
        }
        (Value::Number(stated), Value::Number(cast), _) => {
            (stated - cast).abs() <= tolerance(case, channel) * cast.abs()
        }
        (stated, cast, _) => stated == cast,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::it::candidates::walls;
    use crate::it::rays::{RIGHT, Tracer, traced};
    use raypencil_judge::check;
    use raypencil_scene::Silent;

    #[test]
    fn of_two_rules_each_must_change_what_the_other_gives() {
        let bench = walls();
        let told = |tracer: Tracer| {
            let candidate = traced(tracer);
            let found = check(&bench.truth, &candidate, &Silent);
            let sensors = [SensorId::Camera];
            let wrong = WrongRays::of(&found, &sensors);
            let case = Case { truth: &bench.truth, recorded: &candidate, sensors: &sensors, tolerance: 1e-9 };
            let pairs = CastTrial::new(case, &wrong).explain_by_two();
            pairs.into_iter().map(|pair| pair.mistakes).collect::<Vec<_>>()
        };
        let near = Tracer { t_min: 0.0, ..RIGHT };
        // No ray meets an edge of the panel before the plane: whether edges are open changes nothing.
        assert_eq!(told(near), Vec::<Vec<Mistake>>::new());
        let both = vec![Mistake::NearPlaneIgnored, Mistake::MaximumRangeIgnored];
        assert_eq!(told(Tracer { max_range: 1e9, ..near }), [both]);
    }
}
