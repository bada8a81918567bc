//! How far a stated value is from another one, and how far it may be.

use glam::DVec3;

use crate::answer::{StatedHit, StatedReturn};
use crate::bounds::{HitBounds, ReturnBounds};
use crate::quantity::{Item, Quantity};
use raypencil_scene::{Hit, Return};

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

/// A number, or a vector of three.
#[derive(Debug, Clone, Copy)]
enum Components {
    Scalar([f64; 1]),
    Vector([f64; 3]),
}

impl Components {
    fn as_slice(&self) -> &[f64] {
        match self {
            Self::Scalar(components) => components,
            Self::Vector(components) => components,
        }
    }
}

/// A stated value beside the exact one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StatedValue {
    pub(crate) item: Item,
    stated: Components,
    exact: Components,
    /// Error that the arithmetic explains.
    pub(crate) bound: f64,
}

impl StatedValue {
    /// A number; `None` if it is not stated.
    pub(crate) fn scalar(item: impl Into<Item>, stated: Option<f64>, exact: f64, bound: f64) -> Option<Self> {
        let stated = Components::Scalar([stated?]);
        Some(Self { item: item.into(), stated, exact: Components::Scalar([exact]), bound })
    }

    fn vector(quantity: Quantity, stated: Option<DVec3>, exact: DVec3, bound: f64) -> Option<Self> {
        let [stated, exact] = [stated?, exact].map(|vector| Components::Vector(vector.to_array()));
        Some(Self { item: quantity.into(), stated, exact, bound })
    }

    /// Whether it is a number.
    pub(crate) fn is_scalar(&self) -> bool {
        matches!(self.stated, Components::Scalar(_))
    }

    /// Each component, stated and exact.
    pub(crate) fn components(&self) -> impl Iterator<Item = (f64, f64)> {
        self.stated.as_slice().iter().copied().zip(self.exact.as_slice().iter().copied())
    }

    /// Length of a vector of the components' errors, or of what else belongs to each of them. A single one is its own
    /// length: its square may vanish or overflow.
    pub(crate) fn length(&self, of_component: impl Fn(f64, f64) -> f64) -> f64 {
        let mut lengths = self.components().map(|(stated, exact)| of_component(stated, exact));
        match self.stated {
            Components::Scalar(_) => lengths.next().unwrap_or(0.0),
            Components::Vector(_) => lengths.fold(0.0, |sum, length| sum + length * length).sqrt(),
        }
    }

    /// Absolute error.
    pub(crate) fn error(&self) -> f64 {
        self.length(|stated, exact| (stated - exact).abs())
    }

    /// The difference, the value not having been stored.
    pub(crate) fn difference(&self) -> Difference {
        Difference::computed(self.item, self.error(), Some(self.bound))
    }
}

/// The stated values of a hit beside those of an exact hit.
pub(crate) fn hit_values(stated: &StatedHit, exact: &Hit, bounds: &HitBounds) -> Vec<StatedValue> {
    let values = [
        StatedValue::scalar(Quantity::Range, stated.range, exact.range, bounds.range),
        StatedValue::scalar(Quantity::Depth, stated.depth, exact.depth, bounds.range),
        StatedValue::vector(Quantity::Point, stated.point, exact.point, bounds.point),
        StatedValue::vector(Quantity::Normal, stated.normal, exact.normal, bounds.normal),
        StatedValue::scalar(
            Quantity::CosIncidence,
            stated.cos_incidence,
            exact.cos_incidence,
            bounds.cos_incidence,
        ),
    ];
    values.into_iter().flatten().collect()
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
