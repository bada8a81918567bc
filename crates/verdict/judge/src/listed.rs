//! The defects that reports list: of all wrong rays the worst and the most telling.
//!
//! The rule, for each sensor:
//!
//! 1. Of each item the eight worst rays are kept: those with the largest ratio of the error to its bound. What has no
//!    ratio (hit, face, visible, pixel) keeps eight rays that a fixed hash spreads over the sensor.
//! 2. The referee tells for each of them how far the ray is from another answer. Rays with a larger ratio come first,
//!    and among rays without one those with the larger margin: no rounding explains them.
//! 3. The list takes the first ray of each item in turn, then the second of each, and so on. Hits come before faces,
//!    visibility and pixels, and these before values. No ray is listed twice.
//!
//! [`listed_defects`] takes turns between the sensors by the same order.

use rayon::prelude::*;

use crate::item_value::ItemValue;
use crate::judge::Judge;
use crate::listed_defect::{DefectMargin, ListedDefect};
use crate::quantity::{Item, Quantity};
use crate::tally::{SensorResult, WrongRay};
use raypencil_scene::{Place, SensorId};

/// Maximum number of listed defects of a sensor.
const MAX_LISTED_DEFECTS: usize = 12;

/// What is known of one wrong ray from its sides.
pub(crate) struct Described {
    pub(crate) said: Vec<(String, ItemValue)>,
    pub(crate) truth: Option<ItemValue>,
    pub(crate) difference_unit: &'static str,
    pub(crate) what: String,
}

/// Chooses the listed defects of each sensor, and describes them.
pub(crate) fn list_defects(
    judge: &Judge<'_>,
    sensors: &mut [SensorResult],
    describe: impl Fn(Place, Item) -> Described + Sync,
) {
    for sensor in sensors {
        let chosen = choose(judge, sensor);
        sensor.listed = chosen
            .into_par_iter()
            .map(|(item, ray, margin)| {
                let Described { said, truth, difference_unit, what } = describe(ray.place, item);
                let far =
                    |from: &ItemValue| said.iter().filter_map(|(_, one)| one.distance(from)).reduce(f64::max);
                let difference = match &truth {
                    Some(truth) => far(truth),
                    None => said.first().and_then(|(_, first)| far(first)),
                };
                ListedDefect {
                    place: ray.place,
                    item,
                    said: said.into_iter().map(|(who, value)| (who, value.words)).collect(),
                    truth: truth.map_or(String::new(), |truth| truth.words),
                    difference,
                    difference_unit,
                    ratio: ray.ratio,
                    margin,
                    what,
                }
            })
            .collect();
    }
}

/// The listed defects of several sensors, by turns: the first of each sensor, hits before values, then the second.
pub fn listed_defects(sensors: &[SensorResult]) -> Vec<&ListedDefect> {
    let longest = sensors.iter().map(|sensor| sensor.listed.len()).max().unwrap_or(0);
    let mut all = Vec::new();
    for turn in 0..longest {
        let mut of_turn: Vec<&ListedDefect> =
            sensors.iter().filter_map(|sensor| sensor.listed.get(turn)).collect();
        of_turn.sort_by_key(|defect| kind(defect.item.quantity));
        all.extend(of_turn);
    }
    all
}

/// Place of a quantity in the lists: hits before values.
fn kind(quantity: Quantity) -> usize {
    match quantity {
        Quantity::Hit => 0,
        Quantity::Face => 1,
        Quantity::Visible => 2,
        Quantity::Pixel => 3,
        other => 4 + other as usize,
    }
}

type Chosen = (Item, WrongRay, Option<DefectMargin>);

/// The listed rays of one sensor, by the rule of this file's head.
fn choose(judge: &Judge<'_>, sensor: &SensorResult) -> Vec<Chosen> {
    let mut items: Vec<(Item, &[WrongRay])> = sensor
        .items
        .iter()
        .filter(|(_, tally)| !tally.worst_rays.is_empty())
        .map(|(item, tally)| (item, tally.worst_rays.as_slice()))
        .collect();
    items.sort_by_key(|(item, _)| kind(item.quantity));
    let ranked: Vec<Vec<Chosen>> = items
        .into_par_iter()
        .map(|(item, rays)| {
            let mut rays: Vec<Chosen> =
                rays.iter().map(|ray| (item, *ray, margin(judge, ray.place, item.quantity))).collect();
            // Stable: of equals the order in which they were kept.
            rays.sort_by(|(_, a, of_a), (_, b, of_b)| {
                let ratio = |ray: &WrongRay| match ray.ratio {
                    Some(ratio) if ratio.is_nan() => f64::INFINITY,
                    Some(ratio) => ratio,
                    None => 0.0,
                };
                let lo = |margin: &Option<DefectMargin>| margin.as_ref().map_or(0.0, |margin| margin.lo);
                ratio(b).total_cmp(&ratio(a)).then(lo(of_b).total_cmp(&lo(of_a)))
            });
            rays
        })
        .collect();
    let longest = ranked.iter().map(Vec::len).max().unwrap_or(0);
    let mut chosen: Vec<Chosen> = Vec::new();
    for turn in 0..longest {
        for rays in &ranked {
            let Some(ray) = rays.get(turn) else { continue };
            let is_new = chosen.iter().all(|(_, other, _)| other.place != ray.1.place);
            if is_new && chosen.len() < MAX_LISTED_DEFECTS {
                chosen.push(ray.clone());
            }
        }
    }
    chosen
}

/// How far a ray is from another answer to this quantity.
fn margin(judge: &Judge<'_>, Place { sensor, i, j }: Place, quantity: Quantity) -> Option<DefectMargin> {
    let referee = judge.referee();
    match (quantity, sensor) {
        (Quantity::PixelFlux, _) => return None,
        (Quantity::Visible | Quantity::Pixel | Quantity::PencilFlux, SensorId::Beam(beam)) => {
            // A pencil that hits nothing has the margin of its miss.
            if let Some(margins) = referee.visibility_margins(beam, i, j) {
                if quantity != Quantity::Pixel {
                    let (lo, hi) = (margins.visibility.lo, margins.visibility.hi);
                    return Some(DefectMargin { of: "visibility", unit: "cells", lo, hi });
                }
                if let Some([lo, hi]) = margins.landing {
                    return Some(DefectMargin { of: "landing", unit: "pixels", lo, hi });
                }
            }
        }
        _ => {}
    }
    let margins = referee.margins(sensor, i, j)?;
    let (of, margin) = match quantity {
        Quantity::Hit => ("surface", margins.surface),
        _ => ("face", margins.face),
    };
    Some(DefectMargin { of, unit: "cells", lo: margin.lo, hi: margin.hi })
}
