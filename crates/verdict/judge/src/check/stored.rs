//! Differences of values that a recording stores in files.

use crate::difference::{Difference, StatedValue};
use crate::quantity::Item;
use crate::recorded::Recorded;
use raypencil_files::Storage;
use raypencil_scene::SensorId;

/// The difference of a value that was stored so.
pub(super) fn stored_difference(value: &StatedValue, storage: Storage) -> Difference {
    let largest = value.components().fold(0.0, |largest: f64, (_, exact)| largest.max(exact.abs()));
    // The last place of the largest component: a component near 0 has a far smaller one.
    let last_place = storage.ulp(largest);
    let mut ulps = 0.0_f64;
    for (stated, exact) in value.components() {
        let error = (stated - exact).abs();
        if error > 0.0 {
            ulps = ulps.max(error / last_place);
        }
    }
    // The stated value was rounded once to be stored, the exact one once to f64.
    let rounding = value.length(|stated, exact| 0.5 * (storage.ulp(stated) + Storage::F64.ulp(exact)));
    Difference {
        item: value.item,
        error: value.error(),
        bound: Some(value.bound + rounding),
        ulps: Some(ulps),
        is_unrepresentable: largest > 0.0 && 0.5 * last_place >= largest,
    }
}

impl Recorded {
    /// How a quantity is stored; f64 if that is not known.
    pub(super) fn storage_of(&self, sensor: SensorId, item: Item) -> Storage {
        self.storage.get(&(sensor, item)).copied().unwrap_or(Storage::F64)
    }

    /// The differences of some values of a sensor's ray.
    pub(super) fn differences(
        &self,
        sensor: SensorId,
        values: impl IntoIterator<Item = StatedValue>,
    ) -> Vec<Difference> {
        let stored = |value: StatedValue| stored_difference(&value, self.storage_of(sensor, value.item));
        values.into_iter().map(stored).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Quantity;

    #[test]
    fn a_value_of_at_most_half_the_smallest_number_cannot_be_stored() {
        let smallest = [
            (Storage::F16, libm::scalbn(1.0, -24)),
            (Storage::F32, libm::scalbn(1.0, -149)),
            (Storage::F64, f64::from_bits(1)),
        ];
        for (storage, smallest) in smallest {
            let is_unrepresentable = |exact: f64| {
                let value = StatedValue::scalar(Quantity::PencilFlux, Some(0.0), exact, 0.0);
                stored_difference(&value.unwrap(), storage).is_unrepresentable
            };
            // Half of it lies between 0 and the number, and rounds to 0, which is even. More rounds up.
            assert!(!is_unrepresentable(smallest) && !is_unrepresentable(0.0), "{storage:?}");
            if storage != Storage::F64 {
                let half = 0.5 * smallest;
                let found = [half.next_down(), half, half.next_up()].map(is_unrepresentable);
                assert_eq!(found, [true, true, false], "{storage:?}");
                assert_eq!([-half, -half.next_up()].map(is_unrepresentable), [true, false], "{storage:?}");
            }
        }
    }
}
