//! Results by quantity and by sensor: class counts, largest errors with their places, defects, causes.

use std::collections::BTreeMap;

use crate::class::{Class, ClassCounts};
use crate::difference::Difference;
use crate::judge::hash;
use crate::listed_defect::ListedDefect;
use crate::quantity::{Item, Quantity};
use raypencil_scene::{Image, Maybe, Place, SensorId, Switches};

/// The largest value of something, and the ray that has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Largest {
    /// The value.
    pub value: f64,
    /// The first ray in reading order that has it; for the NaN of a value with a ruling, the last.
    pub place: Place,
    /// The referee's ruling on that ray, in words; `compare` keeps none.
    pub ruling: Option<String>,
}

impl Largest {
    /// Replaces the largest value so far if `value` is larger.
    ///
    /// NaN counts as the largest: a bound that is not a number bounds nothing. Rules on a second NaN: see "Two rules"
    /// on the first page of this crate.
    #[inline]
    pub(crate) fn update(slot: &mut Option<Self>, value: f64, place: Place, ruling: Option<&str>) {
        let is_larger = |largest: &Self| {
            value > largest.value || value.is_nan() && (ruling.is_some() || !largest.value.is_nan())
        };
        if slot.as_ref().is_none_or(is_larger) {
            *slot = Some(Self { value, place, ruling: ruling.map(String::from) });
        }
    }

    fn add(slot: &mut Option<Self>, later: &Option<Self>) {
        if let Some(Self { value, place, ruling }) = later {
            Self::update(slot, *value, *place, ruling.as_deref());
        }
    }
}

/// A ray on which an item is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrongRay {
    /// The ray.
    pub place: Place,
    /// Ratio of the error to its bound; `None` for what is right or wrong and has no size, such as a face.
    pub ratio: Option<f64>,
}

impl WrongRay {
    /// The higher, the sooner the ray is kept: the ratio, NaN above all. Rays without one rank by a fixed hash, which
    /// spreads those that are kept over the sensor, and below all ratios, which are above 1.
    fn rank(&self) -> f64 {
        match self.ratio {
            Some(ratio) if ratio.is_nan() => f64::INFINITY,
            Some(ratio) => ratio,
            None => hash(self.place) as f64 / u64::MAX as f64,
        }
    }
}

/// Maximum number of wrong rays that are kept for each item of a sensor, to choose the listed defects from.
const MAX_WRONG_RAYS_KEPT: usize = 8;

/// One quantity over many rays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ItemTally {
    /// Rays of which it was compared, by class.
    pub by_class: ClassCounts,
    /// Rays of which a side does not state it, or stores it in a type that cannot hold it.
    pub not_compared: u64,
    /// `check`: rays on which it does not agree, in reading order.
    pub others: Vec<(Place, Class)>,
    /// `check`: rays whose storage cannot hold it, in reading order. They are among those not compared.
    pub unjudged: Vec<Place>,
    /// `check`: the largest error in units in the last place of the storage.
    pub worst_ulps: Option<Largest>,
    /// The largest error in the quantity's unit. `compare`: over rays of which both sides name the same face or tie.
    pub worst_error: Option<Largest>,
    /// The largest ratio of an error to its bound.
    pub worst_ratio: Option<Largest>,
    /// The worst of the rays on which it is wrong, at most 8: those with the largest ratio first.
    pub worst_rays: Vec<WrongRay>,
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

    /// Enters the error of one ray into the largest ones.
    #[inline]
    pub(crate) fn enter(&mut self, difference: &Difference, place: Place, ruling: Option<&str>) {
        Largest::update(&mut self.worst_error, difference.error, place, ruling);
        if let Some(ratio) = difference.ratio() {
            Largest::update(&mut self.worst_ratio, ratio, place, ruling);
        }
        if let Some(ulps) = difference.ulps {
            Largest::update(&mut self.worst_ulps, ulps, place, ruling);
        }
    }

    /// Keeps a wrong ray, if it is among the worst so far. Of equals the first stays.
    pub(crate) fn offer(&mut self, ray: WrongRay) {
        let at = self.worst_rays.partition_point(|kept| kept.rank() >= ray.rank());
        if at < MAX_WRONG_RAYS_KEPT {
            self.worst_rays.insert(at, ray);
            self.worst_rays.truncate(MAX_WRONG_RAYS_KEPT);
        }
    }

    /// Adds the tally of later rays.
    pub fn add(&mut self, later: &Self) {
        add_counts(&mut self.by_class, &later.by_class);
        self.not_compared += later.not_compared;
        self.others.extend_from_slice(&later.others);
        self.unjudged.extend_from_slice(&later.unjudged);
        Largest::add(&mut self.worst_ulps, &later.worst_ulps);
        Largest::add(&mut self.worst_error, &later.worst_error);
        Largest::add(&mut self.worst_ratio, &later.worst_ratio);
        later.worst_rays.iter().for_each(|ray| self.offer(*ray));
    }
}

fn add_counts(counts: &mut ClassCounts, later: &ClassCounts) {
    for (mine, theirs) in counts.iter_mut().zip(later) {
        *mine += theirs;
    }
}

/// The tally of each item that was asked about, in the order of items.
///
/// A quantity without a beam and by the scene's model is found by its index, since each ray enters a dozen of them; the
/// rest, the fluxes of single beams and of the other model, are few.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ItemTallies {
    /// In the order of [`Quantity::ALL`].
    of_quantities: [Option<Box<ItemTally>>; Quantity::ALL.len()],
    of_fluxes: BTreeMap<Item, ItemTally>,
}

impl ItemTallies {
    /// The tally of an item, if it was asked about.
    pub fn get(&self, item: Item) -> Option<&ItemTally> {
        if item.is_plain() {
            self.of_quantities[item.quantity as usize].as_deref()
        } else {
            self.of_fluxes.get(&item)
        }
    }

    /// The tally of an item, which is asked about from now on.
    #[inline]
    pub fn entry(&mut self, item: Item) -> &mut ItemTally {
        if item.is_plain() {
            self.of_quantities[item.quantity as usize].get_or_insert_default()
        } else {
            self.of_fluxes.entry(item).or_default()
        }
    }

    /// Each item and its tally.
    pub fn iter(&self) -> impl Iterator<Item = (Item, &ItemTally)> {
        Quantity::ALL.into_iter().flat_map(|quantity| {
            let plain = self.of_quantities[quantity as usize].as_deref();
            let of_quantity = move |item: &Item| item.quantity == quantity;
            let fluxes = self.of_fluxes.iter().filter(move |(item, _)| of_quantity(item));
            let plain = plain.map(|tally| (Item::from(quantity), tally));
            plain.into_iter().chain(fluxes.map(|(item, tally)| (*item, tally)))
        })
    }

    /// Each tally, to be changed; not in the order of items.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut ItemTally> {
        self.of_quantities.iter_mut().flatten().map(|tally| &mut **tally).chain(self.of_fluxes.values_mut())
    }
}

/// Effect of one set of the paper's approximations on a sensor's rays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ApproximationTally {
    /// Rays.
    pub rays: u64,
    /// Rays that truly hit and are stated to miss.
    pub lost: u64,
    /// Rays that truly miss and are stated to hit.
    pub added: u64,
    /// Sum over pencils of the absolute change of their flux, watts (`eq1`: W/m).
    pub flux_changed: f64,
    /// The largest error of a range, metres, over rays that truly hit and are stated to hit another face.
    pub worst_range: Option<Largest>,
}

impl ApproximationTally {
    /// Adds the tally of later rays.
    pub fn add(&mut self, later: &Self) {
        self.rays += later.rays;
        self.lost += later.lost;
        self.added += later.added;
        self.flux_changed += later.flux_changed;
        Largest::add(&mut self.worst_range, &later.worst_range);
    }
}

/// The tally of each set of approximations that caused a difference.
pub type ApproximationTallies = BTreeMap<Switches, ApproximationTally>;

/// A ray that is a defect, or (`check`) undecided.
#[derive(Debug, Clone, PartialEq)]
pub struct Defect {
    /// The ray.
    pub place: Place,
    /// The worst quantity; of several the first that was entered.
    pub item: Item,
    /// The answers in words. `compare`: of each side; `check`: stated, true, and the ruling.
    pub what: String,
}

/// A ray whose class is not [`Class::Agree`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DifferingRay {
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
    /// Its class.
    pub class: Class,
    /// The worst quantity; of several the first that was entered.
    pub item: Item,
    /// `compare`: the approximations of the paper that cause the difference; none for other classes.
    pub causes: Switches,
}

/// Defects that are described for each sensor; all are counted.
const MAX_DEFECTS_DESCRIBED: usize = 100;

/// One sensor, judged.
#[derive(Debug, Clone)]
pub struct SensorResult {
    /// The sensor.
    pub sensor: SensorId,
    /// Rays of which anything was compared, by the worst class of their quantities.
    pub by_class: ClassCounts,
    /// Rays of which nothing was compared.
    pub not_compared: u64,
    /// Rays that the referee ruled on. `check`: those whose answer is not the exact one; `compare`: also a sample of
    /// those that agree.
    pub judged: u64,
    /// Each quantity. `compare` has all of [`Quantity::ALL`], `check` those that were asked about.
    pub items: ItemTallies,
    /// Every ray that does not agree, in reading order.
    pub differing: Vec<DifferingRay>,
    /// The first defects, in reading order.
    pub defects: Vec<Defect>,
    /// The worst and most telling defects, for reports: `listed` has the rule by which they are chosen.
    pub listed: Vec<ListedDefect>,
    /// `compare`: rays of [`Class::Approximation`] by cause. They add up to that class.
    pub approximations: ApproximationTallies,
    /// `compare`: difference of the ranges, metres: `b - a`, where both sides hit.
    pub range_difference: Option<Image<Maybe<f64>>>,
}

impl SensorResult {
    /// A sensor of which nothing is judged yet.
    pub(crate) fn new(sensor: SensorId) -> Self {
        Self {
            sensor,
            by_class: [0; Class::COUNT],
            not_compared: 0,
            judged: 0,
            items: ItemTallies::default(),
            differing: Vec::new(),
            defects: Vec::new(),
            listed: Vec::new(),
            approximations: BTreeMap::new(),
            range_difference: None,
        }
    }

    /// The same with a tally of every quantity: reports of `compare` list also those that a sensor does not have.
    pub(crate) fn with_all_quantities(sensor: SensorId) -> Self {
        let mut result = Self::new(sensor);
        for quantity in Quantity::ALL {
            result.tally(quantity.into());
        }
        result
    }

    /// Rays of which anything was compared: the sum of the classes.
    pub fn compared(&self) -> u64 {
        self.by_class.iter().sum()
    }

    /// Rays in a class.
    pub fn of(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }

    #[inline]
    pub(crate) fn tally(&mut self, item: Item) -> &mut ItemTally {
        self.items.entry(item)
    }

    /// Describes a defect, if there are not too many yet.
    pub(crate) fn describe(&mut self, defect: impl FnOnce() -> Defect) {
        if self.defects.len() < MAX_DEFECTS_DESCRIBED {
            self.defects.push(defect());
        }
    }

    pub(crate) fn add(&mut self, later: Self) {
        add_counts(&mut self.by_class, &later.by_class);
        self.not_compared += later.not_compared;
        self.judged += later.judged;
        for (item, tally) in later.items.iter() {
            self.tally(item).add(tally);
        }
        self.differing.extend(later.differing);
        let room = MAX_DEFECTS_DESCRIBED.saturating_sub(self.defects.len());
        self.defects.extend(later.defects.into_iter().take(room));
        for (cause, tally) in later.approximations {
            self.approximations.entry(cause).or_default().add(&tally);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(i: u32) -> Place {
        Place { sensor: SensorId::Camera, i, j: 0 }
    }

    /// The tally of some errors, each of the ray of its index, with a bound of 2.
    fn tally(errors: &[f64], ruling: Option<&str>) -> ItemTally {
        let mut tally = ItemTally::default();
        for (i, error) in errors.iter().enumerate() {
            let difference = Difference::computed(Quantity::Range, *error, Some(2.0));
            tally.enter(&difference, place(i as u32), ruling);
        }
        tally
    }

    #[test]
    fn the_first_of_equal_errors_is_the_largest() {
        // 3 is found at rays 1 and 2; its ratio is 3/2.
        let all = tally(&[1.0, 3.0, 3.0], None);
        assert_eq!(all.worst_error, Some(Largest { value: 3.0, place: place(1), ruling: None }));
        assert_eq!(all.worst_ratio, Some(Largest { value: 1.5, place: place(1), ruling: None }));
        assert_eq!(all.worst_ulps, None);
    }

    #[test]
    fn nan_is_the_largest_the_first_of_two_renderers_and_the_last_of_a_recording() {
        for (ruling, expected) in [(None, 1), (Some("exact"), 3)] {
            let found = tally(&[1.0, f64::NAN, 5.0, f64::NAN, 7.0], ruling).worst_error.unwrap();
            assert!(found.value.is_nan());
            assert_eq!(found.place, place(expected), "{ruling:?}");
            // Adding up two parts finds the same as entering all.
            let mut parts = tally(&[1.0, f64::NAN, 5.0, 0.0, 7.0], ruling);
            let mut later = ItemTally::default();
            later.enter(&Difference::computed(Quantity::Range, f64::NAN, None), place(3), ruling);
            parts.add(&later);
            assert_eq!(parts.worst_error.unwrap().place, place(expected), "{ruling:?}");
        }
    }

    #[test]
    fn the_largest_ratios_are_kept_whatever_the_order() {
        // Ratios 1.01 to 1.20 and NaN, which is kept first; of the twenty others the largest seven.
        let rays: Vec<WrongRay> = (1..=20)
            .map(|k| WrongRay { place: place(k), ratio: Some(1.0 + f64::from(k) / 100.0) })
            .chain([WrongRay { place: place(99), ratio: Some(f64::NAN) }])
            .collect();
        let kept = |rays: &mut dyn Iterator<Item = &WrongRay>| -> Vec<u32> {
            let mut tally = ItemTally::default();
            rays.for_each(|ray| tally.offer(*ray));
            tally.worst_rays.iter().map(|ray| ray.place.i).collect()
        };
        assert_eq!(kept(&mut rays.iter()), [99, 20, 19, 18, 17, 16, 15, 14]);
        assert_eq!(kept(&mut rays.iter().rev()), [99, 20, 19, 18, 17, 16, 15, 14]);
        // Without ratios the kept rays are spread: they are not the first eight of a thousand.
        let wrong: Vec<WrongRay> = (0..1000).map(|i| WrongRay { place: place(i), ratio: None }).collect();
        assert!(kept(&mut wrong.iter()).iter().any(|i| *i >= 500));
    }

    #[test]
    fn equal_numbers_agree_without_a_bound_and_nan_never_does() {
        let is_within = |error, bound| Difference::computed(Quantity::Range, error, bound).is_within();
        assert!(is_within(0.0, None) && is_within(0.0, Some(f64::NAN)) && is_within(2.0, Some(2.0)));
        assert!(!is_within(1e-300, None) && !is_within(2.5, Some(2.0)));
        assert!(!is_within(f64::NAN, Some(f64::INFINITY)) && !is_within(1.0, Some(f64::NAN)));
    }
}
