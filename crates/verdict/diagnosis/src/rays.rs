//! Mistakes of the rays themselves: a renderer with one of them is cast, and its answers are compared.

use rayon::prelude::*;

use crate::agree::{is_near, tolerance};
use crate::cast::{CastHit, Rules, cast, pairs_of_wrong_rules, wrong_rules};
use crate::channel::{Channel, Value, channels_of};
use crate::correction::{Case, Correction, corrected};
use crate::diagnosis::Diagnosis;
use crate::mistake::Mistake;
use crate::sample::{WrongRays, some_of, spread_over};
use raypencil_judge::Quantity;
use raypencil_scene::Place;

/// Tests of a ray and a face for one set of rules, at most, beyond the first rays. A test takes nanoseconds.
const MAX_RAY_FACE_TESTS: u64 = 1 << 24;

/// Rays that are cast, at least and at most: half of them wrong ones.
const CAST_RAYS: std::ops::RangeInclusive<u64> = 128..=2048;

/// Share of the wrong rays, and of all rays, that a renderer with the mistake must give. Tuned: a ray near an edge may
/// go either way.
const MIN_SHARE_OF_WRONG: f64 = 0.95;
const MIN_SHARE_OF_ALL: f64 = 0.98;

/// Share of the wrong rays that may be near the truth as well. Tuned: nearly all of them must tell the two apart.
const MAX_SHARE_NEAR_TRUTH: f64 = 0.1;

/// Rays cast by the rules of each mistake.
#[derive(Debug)]
pub(crate) struct CastTrial<'t> {
    case: Case<'t>,
    channels: Vec<Channel>,
    /// The wrong rays, and then rays of all.
    places: Vec<Place>,
    /// Number of the wrong rays at the beginning.
    wrong: usize,
    renders: Vec<(Mistake, Vec<Option<CastHit>>)>,
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
    pub(crate) fn new(case: Case<'t>, wrong: &WrongRays) -> Self {
        let scene = case.truth.scene();
        let faces = scene.mesh().faces().len().max(1) as u64;
        let rays = (MAX_RAY_FACE_TESTS / faces).clamp(*CAST_RAYS.start(), *CAST_RAYS.end());
        let channels: Vec<Channel> = channels_of(case.recorded).into_iter().filter(is_compared).collect();
        let of_channels = |place: &Place| channels.iter().any(|channel| channel.sensor == place.sensor);
        let mut places = some_of(&wrong.of_hits, rays as usize / 2);
        places.retain(of_channels);
        let wrong = places.len();
        places.extend(spread_over(scene, rays / 2).into_iter().filter(of_channels));
        let mut trial = Self { case, channels, places, wrong, renders: Vec::new() };
        if wrong > 0 {
            let renders = wrong_rules().into_iter().map(|(mistake, rules)| (mistake, trial.render(rules)));
            trial.renders = renders.collect();
        }
        trial
    }

    /// The rays by some rules.
    fn render(&self, rules: Rules) -> Vec<Option<CastHit>> {
        self.places.par_iter().map(|place| cast(self.case.truth.scene(), *place, rules)).collect()
    }

    /// The best explanation by rays of two mistakes.
    pub(crate) fn explain_by_two(&self) -> Option<Diagnosis> {
        let rules = if self.wrong == 0 { Vec::new() } else { pairs_of_wrong_rules() };
        let found = rules.into_iter().filter_map(|(mistakes, rules)| {
            let agree = self.agreeing(&self.render(rules), None)?;
            Some(Diagnosis { mistakes: mistakes.to_vec(), agree, tried: self.places.len() as u64 })
        });
        // Among equals the first.
        found.reduce(|best, other| if other.agree > best.agree { other } else { best })
    }

    /// The best explanation by rays of one mistake, after at most one correction.
    pub(crate) fn explain(&self, correction: Option<&Correction>) -> Option<Diagnosis> {
        let found = self.renders.iter().filter_map(|(mistake, render)| {
            let agree = self.agreeing(render, correction)?;
            let mistakes = correction.map(|one| one.mistake).into_iter().chain([*mistake]).collect();
            Some(Diagnosis { mistakes, agree, tried: self.places.len() as u64 })
        });
        // Among equals the first.
        found.reduce(|best, other| if other.agree > best.agree { other } else { best })
    }

    /// Rays on which all compared channels agree with a render; `None` if it explains too few.
    fn agreeing(&self, render: &[Option<CastHit>], correction: Option<&Correction>) -> Option<u64> {
        let case = self.case;
        let mut near_render = vec![true; self.places.len()];
        let mut near_truth = vec![true; self.places.len()];
        let mut is_used = correction.is_none();
        for channel in &self.channels {
            let near = |corrections: &[&Correction]| -> Vec<(usize, bool, bool)> {
                let own = self.places.iter().enumerate().filter(|(_, place)| place.sensor == channel.sensor);
                own.map(|(index, place)| {
                    let Some(value) = corrected(case, *channel, *place, corrections) else {
                        return (index, true, false);
                    };
                    let exact = channel.at(case.truth.answers(), *place);
                    let of_render = is_near_render(case, *channel, value, render[index]);
                    (index, of_render, is_near(case, *channel, *place, value, exact))
                })
                .collect()
            };
            let count = |near: &[(usize, bool, bool)]| near.iter().filter(|(_, near, _)| *near).count();
            let plain = near(&[]);
            let other = correction.filter(|one| one.touches(*channel)).map(|one| near(&[one]));
            let chosen = match other {
                Some(other) if count(&other) > count(&plain) => {
                    is_used = true;
                    other
                }
                _ => plain,
            };
            for (index, of_render, of_truth) in chosen {
                near_render[index] &= of_render;
                near_truth[index] &= of_truth;
            }
        }
        let count = |of: &[bool]| of.iter().filter(|near| **near).count() as f64;
        let (wrong, all) = near_render.split_at(self.wrong);
        let is_explained = count(wrong) >= MIN_SHARE_OF_WRONG * wrong.len() as f64
            && count(all) >= MIN_SHARE_OF_ALL * all.len() as f64;
        let is_new = match correction {
            // The wrong rays are those that are not near the truth before the correction.
            Some(_) => near_truth.iter().zip(&near_render).any(|(truth, render)| *render && !*truth),
            None => count(&near_truth[..self.wrong]) <= MAX_SHARE_NEAR_TRUTH * self.wrong as f64,
        };
        (is_used && is_explained && is_new).then(|| count(&near_render) as u64)
    }
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
