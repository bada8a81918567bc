//! Which rays a page describes in full.

use raypencil_judge::{Class, SensorResult};
use raypencil_scene::{Place, SensorMap};

/// Maximum number of rays that a page describes in full. Each takes about 1.5 kB before it is deflated.
const MAX_DESCRIBED_RAYS: usize = 1000;

/// A ray that two sides do not answer alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayToDescribe {
    /// The ray.
    pub place: Place,
    /// Index of the pair of its sensor.
    pub pair: usize,
    /// Its class.
    pub class: Class,
    /// Difference of the ranges, metres; where one side hits nothing, the range of the other.
    pub size: f64,
}

impl RayToDescribe {
    /// The rays of a pair that are not `agree`. `maps` are those of both sides, if they have one.
    pub fn of<'r>(
        pair: usize,
        result: &'r SensorResult,
        maps: [Option<&'r SensorMap>; 2],
    ) -> impl Iterator<Item = Self> + 'r {
        result.differing.iter().map(move |ray| {
            let ranges = maps.map(|map| map?.range.as_ref()?.at(ray.i, ray.j).get());
            let size = match ranges {
                [Some(a), Some(b)] => (a - b).abs(),
                [Some(one), None] | [None, Some(one)] => one,
                [None, None] => 0.0,
            };
            let place = Place { sensor: result.sensor, i: ray.i, j: ray.j };
            Self { place, pair, class: ray.class, size }
        })
    }
}

/// At most a thousand of these rays: the worst half by class and size, and a sample of the others, spread evenly in
/// reading order.
pub fn rays_to_describe(mut all: Vec<RayToDescribe>) -> Vec<RayToDescribe> {
    if all.len() <= MAX_DESCRIBED_RAYS {
        return all;
    }
    // Stable: of equals the first in reading order.
    all.sort_by(|a, b| b.class.cmp(&a.class).then(b.size.total_cmp(&a.size)));
    let mut others = all.split_off(MAX_DESCRIBED_RAYS / 2);
    others.sort_by_key(|ray| (ray.pair, ray.place.sensor, ray.place.j, ray.place.i));
    let room = MAX_DESCRIBED_RAYS - all.len();
    let count = others.len();
    let mut next = 0;
    all.extend(others.into_iter().enumerate().filter_map(|(index, ray)| {
        let is_due = index * room >= next * count && next < room;
        next += usize::from(is_due);
        is_due.then_some(ray)
    }));
    all
}

#[cfg(test)]
#[path = "../tests/unit/described.rs"]
mod tests;
