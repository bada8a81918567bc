use rayon::prelude::*;
use std::collections::BTreeMap;

use crate::class::{CLASSES, Class, Quantity};
use raypencil_scene::{Image, Maybe, Place, SensorId, Switches};

/// The largest of something, and where it was found first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// The first place in reading order that has it.
    pub place: Place,
}

impl Worst {
    pub(crate) fn keep(slot: &mut Option<Self>, value: f64, place: Place) {
        // NaN counts as worst: a bound that is not a number bounds nothing.
        if slot.is_none_or(|worst| value > worst.value || (value.is_nan() && !worst.value.is_nan())) {
            *slot = Some(Self { value, place });
        }
    }
}

/// How one quantity fared over many rays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    /// Rays by class, in the order of [`Class`].
    pub by_class: [u64; CLASSES],
    /// Rays of which one side does not say it.
    pub not_compared: u64,
    /// The largest difference, in [`Quantity::unit`], over rays that hit the same face or tie.
    pub worst_error: Option<Worst>,
    /// The largest ratio of a difference to its bound.
    pub worst_ratio: Option<Worst>,
}

impl Tally {
    /// Rays in a class.
    pub fn of(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }

    /// Adds what is said of later rays.
    pub fn add(&mut self, later: &Self) {
        for (mine, theirs) in self.by_class.iter_mut().zip(later.by_class) {
            *mine += theirs;
        }
        self.not_compared += later.not_compared;
        for (mine, theirs) in
            [(&mut self.worst_error, later.worst_error), (&mut self.worst_ratio, later.worst_ratio)]
        {
            if let Some(worst) = theirs {
                Worst::keep(mine, worst.value, worst.place);
            }
        }
    }
}

/// What one set of the paper's approximations did to a sensor's rays.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ApproximationTally {
    /// Rays.
    pub rays: u64,
    /// Those that hit in truth, and miss.
    pub lost: u64,
    /// Those that miss in truth, and hit.
    pub added: u64,
    /// By how much it changed the flux of pencils, each difference taken positive, watts (`eq1`: W/m).
    pub flux_changed: f64,
    /// The largest error of a range, metres, over rays that hit in truth and hit another face.
    pub worst_range: Option<Worst>,
}

impl ApproximationTally {
    /// Adds what is said of later rays.
    pub fn add(&mut self, later: &Self) {
        self.rays += later.rays;
        self.lost += later.lost;
        self.added += later.added;
        self.flux_changed += later.flux_changed;
        if let Some(worst) = later.worst_range {
            Worst::keep(&mut self.worst_range, worst.value, worst.place);
        }
    }
}

/// The tallies of each set of approximations that caused a difference.
pub type ApproximationTallies = BTreeMap<Switches, ApproximationTally>;

/// A ray on which the two sides differ beyond doubt.
#[derive(Debug, Clone, PartialEq)]
pub struct Defect {
    /// Which ray.
    pub place: Place,
    /// The quantity that is worst.
    pub quantity: Quantity,
    /// What each side says, in words.
    pub what: String,
}

/// The comparison of one sensor's maps.
#[derive(Debug, Clone)]
pub struct SensorComparison {
    /// Whose maps.
    pub sensor: SensorId,
    /// Rays compared at least by hit or miss.
    pub compared: u64,
    /// Rays whose maps one side does not have at all.
    pub not_compared: u64,
    /// Rays by class, in the order of [`Class`]; they add up to `compared`.
    pub by_class: [u64; CLASSES],
    /// Rays that the referee ruled on.
    pub judged: u64,
    /// Rays of [`Class::Approximation`] by cause; they add up to that class.
    pub approximations: ApproximationTallies,
    /// Each quantity by itself.
    pub quantities: Vec<(Quantity, Tally)>,
    /// The first defects, in reading order.
    pub defects: Vec<Defect>,
    /// Difference of the ranges, metres: `b - a`, where both hit.
    pub range_difference: Option<Image<Maybe<f64>>>,
}

impl SensorComparison {
    /// Rays in a class.
    pub fn of(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }
}

/// How many defects a comparison describes; all are counted.
pub(crate) const DEFECTS_DESCRIBED: usize = 100;
