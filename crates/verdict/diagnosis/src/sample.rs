//! Rays on which corrections are tried: some that are wrong, and some of all.

use std::collections::BTreeSet;

use raypencil_judge::{Check, Class, Quantity};
use raypencil_scene::{Place, Scene, SensorId};

use crate::channel::{Channel, hit_quantity};

/// A ray that sorts: sensor, row, column.
pub(crate) type Key = (SensorId, u32, u32);

pub(crate) fn key(place: Place) -> Key {
    (place.sensor, place.j, place.i)
}

pub(crate) fn place((sensor, j, i): Key) -> Place {
    Place { sensor, i, j }
}

#[derive(Debug)]
pub(crate) struct WrongRays {
    pub(crate) all: BTreeSet<Key>,
    /// Those of which what they meet is wrong, and not only what comes back.
    pub(crate) of_hits: BTreeSet<Key>,
    /// The wrong values.
    pub(crate) values: Vec<(Channel, Place)>,
    /// Rays of which anything was compared.
    pub(crate) compared: u64,
}

impl WrongRays {
    /// The wrong rays of some sensors.
    pub(crate) fn of(check: &Check, sensors: &[SensorId]) -> Self {
        let mut found =
            Self { all: BTreeSet::new(), of_hits: BTreeSet::new(), values: Vec::new(), compared: 0 };
        for result in check.sensors.iter().filter(|result| sensors.contains(&result.sensor)) {
            found.compared += result.compared();
            for (item, tally) in result.items.iter() {
                let is_of_hit = matches!(item.quantity, Quantity::Hit | Quantity::Face)
                    || hit_quantity(item.quantity).is_some();
                for (place, _) in tally.others.iter().filter(|(_, class)| *class >= Class::Undecided) {
                    found.all.insert(key(*place));
                    found.values.push((Channel { sensor: result.sensor, item }, *place));
                    if is_of_hit {
                        found.of_hits.insert(key(*place));
                    }
                }
            }
        }
        found
    }

    /// Rays that are compared and not wrong.
    pub(crate) fn right(&self) -> u64 {
        self.compared.saturating_sub(self.all.len() as u64)
    }
}

/// At most `count` of some rays, evenly spaced.
pub(crate) fn some_of(rays: &BTreeSet<Key>, count: usize) -> Vec<Place> {
    let step = rays.len().div_ceil(count).max(1);
    rays.iter().step_by(step).map(|key| place(*key)).collect()
}

/// At least 32 rays of each of some sensors, and about `count` together, with every column and row alike.
pub(crate) fn spread_over(scene: &Scene, sensors: &[SensorId], count: u64) -> Vec<Place> {
    let each = (count / (sensors.len().max(1) as u64)).max(32);
    let mut places = Vec::new();
    for &sensor in sensors {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::it::candidates::pyramids;

    #[test]
    fn of_some_rays_at_most_so_many_are_taken_and_of_all_at_least_32_of_each_sensor() {
        let camera = |i: u32| (SensorId::Camera, 0, i);
        for (rays, count, expected) in [(8, 8, 8), (9, 8, 5), (15, 8, 8), (16, 8, 8), (17, 8, 6)] {
            let rays: BTreeSet<Key> = (0..rays).map(camera).collect();
            assert_eq!(some_of(&rays, count).len(), expected, "{} {count}", rays.len());
        }
        let sensors = [SensorId::Camera, SensorId::Beam(0)];
        let places = spread_over(pyramids().scene, &sensors, 10);
        for sensor in sensors {
            let own = places.iter().filter(|place| place.sensor == sensor);
            let own: BTreeSet<Key> = own.map(|place| key(*place)).collect();
            assert!((32..64).contains(&own.len()), "{sensor}: {}", own.len());
        }
    }
}
