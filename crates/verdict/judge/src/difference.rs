//! How far a stated value is from another one, and how far it may be.

use crate::answer::{StatedHit, StatedReturn};
use crate::bounds::{HitBounds, ReturnBounds};
use crate::quantity::{Item, Quantity};
use raypencil_scene::{Hit, HitQuantity, HitValue, Return};

/// Error of one value of one ray.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Difference {
    pub(crate) item: Item,
    /// Absolute error in the quantity's unit; for a vector its length.
    pub(crate) error: f64,
    /// Error that rounding explains; `None` if nothing is known that a bound could be derived from.
    pub(crate) bound: Option<f64>,
    /// Error in units in the last place of the storage, if the value was stored in a file. For a vector, the largest
    /// error of a component in units in the last place of its largest component.
    pub(crate) ulps: Option<f64>,
    /// Whether the storage is so coarse that half a unit in its last place is as large as the exact value.
    pub(crate) is_unrepresentable: bool,
}

impl Difference {
    /// A difference of values that were not stored.
    pub(crate) fn computed(item: impl Into<Item>, error: f64, bound: Option<f64>) -> Self {
        Self { item: item.into(), error, bound, ulps: None, is_unrepresentable: false }
    }

    /// Whether rounding explains the error. Equal numbers agree even where no bound is known; NaN never agrees.
    pub(crate) fn is_within(&self) -> bool {
        self.error == 0.0 || self.error <= self.bound.unwrap_or(0.0)
    }

    /// Ratio of the error to its bound; without an error 0, also where the bound is 0.
    pub(crate) fn ratio(&self) -> Option<f64> {
        self.bound.map(|bound| if self.error == 0.0 { 0.0 } else { self.error / bound })
    }
}

/// A stated value beside the exact one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StatedValue {
    pub(crate) item: Item,
    stated: HitValue,
    exact: HitValue,
    /// Error that the arithmetic explains.
    pub(crate) bound: f64,
}

impl StatedValue {
    /// A number; `None` if it is not stated.
    pub(crate) fn scalar(item: impl Into<Item>, stated: Option<f64>, exact: f64, bound: f64) -> Option<Self> {
        let [stated, exact] = [stated?, exact].map(HitValue::Scalar);
        Some(Self { item: item.into(), stated, exact, bound })
    }

    /// Whether it is a number.
    pub(crate) fn is_scalar(&self) -> bool {
        matches!(self.stated, HitValue::Scalar(_))
    }

    /// Each component, stated and exact.
    pub(crate) fn components(&self) -> impl ExactSizeIterator<Item = (f64, f64)> {
        components_of(&self.stated, &self.exact)
    }

    /// Length of a vector of what belongs to each component.
    pub(crate) fn length(&self, of_component: impl Fn(f64, f64) -> f64) -> f64 {
        length(self.components().map(|(stated, exact)| of_component(stated, exact)))
    }

    /// Absolute error.
    pub(crate) fn error(&self) -> f64 {
        distance(&self.stated, &self.exact)
    }

    /// The difference, the value not having been stored.
    pub(crate) fn difference(&self) -> Difference {
        Difference::computed(self.item, self.error(), Some(self.bound))
    }
}

fn components_of<'v>(a: &'v HitValue, b: &'v HitValue) -> impl ExactSizeIterator<Item = (f64, f64)> + 'v {
    a.components().iter().copied().zip(b.components().iter().copied())
}

/// Length of a vector. A single component is its own length: its square may vanish or overflow.
fn length(mut components: impl ExactSizeIterator<Item = f64>) -> f64 {
    match components.len() {
        1 => components.next().unwrap_or(0.0),
        _ => components.fold(0.0, |sum, component| sum + component * component).sqrt(),
    }
}

/// Distance of two values of one quantity, in its unit.
pub(crate) fn distance(a: &HitValue, b: &HitValue) -> f64 {
    length(components_of(a, b).map(|(a, b)| (a - b).abs()))
}

/// The stated values of a hit beside those of an exact hit.
pub(crate) fn hit_values(stated: &StatedHit<'_>, exact: &Hit, bounds: &HitBounds) -> Vec<StatedValue> {
    let value = |quantity: HitQuantity| {
        let (stated, exact) = (stated.value(quantity)?, exact.value(quantity));
        Some(StatedValue {
            item: Quantity::from(quantity).into(),
            stated,
            exact,
            bound: bounds.of_quantity(quantity),
        })
    };
    HitQuantity::ALL.into_iter().filter_map(value).collect()
}

/// The stated values of a return, but for its flux, beside those of an exact return.
pub(crate) fn return_values(
    stated: &StatedReturn,
    exact: &Return,
    bounds: &ReturnBounds,
) -> impl Iterator<Item = StatedValue> {
    let values = [
        StatedValue::scalar(Quantity::CameraDepth, stated.depth, exact.depth, bounds.depth),
        StatedValue::scalar(
            Quantity::CosOffAxis,
            stated.cos_off_axis,
            exact.cos_off_axis,
            bounds.cos_off_axis,
        ),
        StatedValue::scalar(Quantity::CosView, stated.cos_view, exact.cos_view, bounds.cos_view),
    ];
    values.into_iter().flatten()
}
