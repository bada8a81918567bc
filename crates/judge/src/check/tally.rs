//! How a recording fares, quantity by quantity.

use std::collections::BTreeMap;

use crate::check::said::Difference;
use crate::class::{Class, Item};
use raypencil_scene::Place;
use raypencil_scene::SensorId;

/// The largest of something, where, and what the referee says of that ray.
#[derive(Debug, Clone, PartialEq)]
pub struct Largest {
    /// The value.
    pub value: f64,
    /// The first ray in reading order that has it.
    pub place: Place,
    /// The ruling, in words.
    pub ruling: String,
}

/// One quantity of one sensor.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ItemTally {
    /// Rays of which it was compared, by class, in the order of [`Class`].
    pub by_class: [u64; 6],
    /// Those that do not agree, in reading order.
    pub others: Vec<(Place, Class)>,
    /// Rays of which it is not said, or is said in a type that cannot hold it.
    pub not_compared: u64,
    /// The latter, in reading order.
    pub unjudged: Vec<Place>,
    /// The largest error in units of the last place of the storage.
    pub ulps: Option<Largest>,
    /// The largest error in the quantity's unit.
    pub error: Option<Largest>,
    /// The largest ratio of an error to its bound.
    pub ratio: Option<Largest>,
}

impl ItemTally {
    /// Rays of which it was compared.
    pub fn compared(&self) -> u64 {
        self.by_class.iter().sum()
    }

    /// Rays in a class.
    pub fn of(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }

    pub(super) fn enter(&mut self, difference: &Difference, place: Place, ruling: &str) {
        let Difference { error, ulps, bound, .. } = *difference;
        let ratio = if error == 0.0 { 0.0 } else { error / bound };
        for (slot, value) in [(&mut self.ulps, ulps), (&mut self.error, error), (&mut self.ratio, ratio)] {
            // What is not a number counts as largest.
            if slot.as_ref().is_none_or(|largest| value > largest.value || value.is_nan()) {
                *slot = Some(Largest { value, place, ruling: ruling.to_string() });
            }
        }
    }

    pub(super) fn add(&mut self, later: Self) {
        for (mine, theirs) in self.by_class.iter_mut().zip(later.by_class) {
            *mine += theirs;
        }
        self.others.extend(later.others);
        self.unjudged.extend(later.unjudged);
        self.not_compared += later.not_compared;
        for (mine, theirs) in
            [(&mut self.ulps, later.ulps), (&mut self.error, later.error), (&mut self.ratio, later.ratio)]
        {
            if let Some(theirs) = theirs
                && mine.as_ref().is_none_or(|mine| theirs.value > mine.value || theirs.value.is_nan())
            {
                *mine = Some(theirs);
            }
        }
    }
}

/// A ray on which the recording is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Wrong {
    /// Which ray.
    pub place: Place,
    /// The quantity that is worst.
    pub item: Item,
    /// What is said, what is true, and the ruling, in words.
    pub what: String,
}

/// How many rays are described; all are counted.
const DESCRIBED: usize = 100;

/// One sensor of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorCheck {
    /// Which sensor.
    pub sensor: SensorId,
    /// Rays of which anything was compared, by the worst class of its quantities, in the order of [`Class`].
    pub by_class: [u64; 6],
    /// Rays of which nothing was said.
    pub not_compared: u64,
    /// Rays on which the referee ruled: those whose answer is not the exact one.
    pub ruled: u64,
    /// Each quantity.
    pub items: BTreeMap<Item, ItemTally>,
    /// The first wrong rays, in reading order.
    pub wrong: Vec<Wrong>,
}

impl SensorCheck {
    pub(super) fn new(sensor: SensorId) -> Self {
        Self {
            sensor,
            by_class: [0; 6],
            not_compared: 0,
            ruled: 0,
            items: BTreeMap::new(),
            wrong: Vec::new(),
        }
    }

    /// Rays of which anything was compared.
    pub fn compared(&self) -> u64 {
        self.by_class.iter().sum()
    }

    /// Adds what is said of later rays.
    pub(super) fn add(&mut self, later: Self) {
        for (mine, theirs) in self.by_class.iter_mut().zip(later.by_class) {
            *mine += theirs;
        }
        self.not_compared += later.not_compared;
        self.ruled += later.ruled;
        for (item, tally) in later.items {
            self.items.entry(item).or_default().add(tally);
        }
        let room = DESCRIBED.saturating_sub(self.wrong.len());
        self.wrong.extend(later.wrong.into_iter().take(room));
    }
}
