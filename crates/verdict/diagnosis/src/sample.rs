//! Rays on which corrections are tried: some that are wrong, and some of all.

use std::collections::BTreeSet;

use raypencil_judge::{Check, Class, Quantity};
use raypencil_scene::{Place, Scene, SensorId};

use crate::channel::hit_quantity;

/// A ray that sorts: sensor, row, column.
pub(crate) type Key = (SensorId, u32, u32);

pub(crate) fn key(place: Place) -> Key {
    (place.sensor, place.j, place.i)
}

fn place((sensor, j, i): Key) -> Place {
    Place { sensor, i, j }
}

#[derive(Debug)]
pub(crate) struct WrongRays {
    pub(crate) all: BTreeSet<Key>,
    /// Those of which what they meet is wrong, and not only what comes back.
    pub(crate) of_hits: BTreeSet<Key>,
}

impl WrongRays {
    pub(crate) fn of(check: &Check) -> Self {
        let mut found = Self { all: BTreeSet::new(), of_hits: BTreeSet::new() };
        for (item, tally) in check.sensors.iter().flat_map(|sensor| sensor.items.iter()) {
            let is_of_hit = matches!(item.quantity, Quantity::Hit | Quantity::Face)
                || hit_quantity(item.quantity).is_some();
            for (place, _) in tally.others.iter().filter(|(_, class)| *class >= Class::Undecided) {
                found.all.insert(key(*place));
                if is_of_hit {
                    found.of_hits.insert(key(*place));
                }
            }
        }
        found
    }
}

/// At most `count` of some rays, evenly spaced.
pub(crate) fn some_of(rays: &BTreeSet<Key>, count: usize) -> Vec<Place> {
    let step = rays.len().div_ceil(count).max(1);
    rays.iter().step_by(step).map(|key| place(*key)).collect()
}

/// At least 32 rays of each sensor, and about `count` together, with every column and row alike.
pub(crate) fn spread_over(scene: &Scene, count: u64) -> Vec<Place> {
    let each = (count / (1 + scene.beams().len() as u64)).max(32);
    let mut places = Vec::new();
    for sensor in scene.sensors() {
        let (width, height) = scene.size(sensor).expect("a sensor of this scene");
        let cells = u64::from(width) * u64::from(height);
        let step = cells.div_ceil(each).max(1);
        for k in 0..cells.div_ceil(step) {
            // A multiplicative hash moves each ray within its step, so that no column is preferred.
            let index = (k * step + (k.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) % step).min(cells - 1);
            places.push(Place {
                sensor,
                i: (index % u64::from(width)) as u32,
                j: (index / u64::from(width)) as u32,
            });
        }
    }
    places
}
