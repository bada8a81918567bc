//! Rules on the cells of two recordings of one scene that differ by more than is allowed: which side is right.
//!
//! A difference that the truth and both declared arithmetics explain is no fault of either side. A cell on which a side
//! is wrong fails its channel, whatever share of differing cells is allowed.

use std::collections::{BTreeMap, HashMap, HashSet};

use raypencil_judge::{Check, Class, Defect, GroundTruth, Item, Quantity, item_of_channel};
use raypencil_scene::{Place, SensorId};

use crate::cells::{Comparison, Thresholds, compare_numbers, number};
use crate::difference::{Difference, Sides};
use crate::rulings::{ChannelRuling, RuledCell, Rulings};

/// Maximum number of wrong cells per channel that are described; all are counted.
const MAX_DESCRIBED_CELLS: usize = 5;

/// Rules on each cell that differs by more than is allowed. `checks` are the checks of A and B against `truth`.
///
/// Add the result to the difference with [`Difference::with_rulings`].
pub fn rule(difference: &Difference, sides: &Sides, truth: &GroundTruth<'_>, checks: [&Check; 2]) -> Rulings {
    let lookup = checks.map(ClassLookup::new);
    let mut rulings = Rulings { channels: BTreeMap::new(), not_ruled: Vec::new() };
    for channel in difference.channels.iter().filter(|channel| channel.differing > 0) {
        let Some((sensor, item)) = item_of(truth, &channel.key) else {
            rulings.not_ruled.push(channel.key.clone());
            continue;
        };
        let [a, b] = sides.channels.map(|channels| &channels.by_key[&channel.key].values);
        let mut ruling = ChannelRuling::default();
        for index in 0..channel.cells() as usize {
            let (x, y) = (number(a, b, index), number(b, a, index));
            if !exceeds(&difference.thresholds, x, y, channel.storage.ulp(x.abs().max(y.abs()))) {
                continue;
            }
            let (i, j) = (index as u32 % channel.width, index as u32 / channel.width);
            let place = Place { sensor, i, j };
            let [Some(class_a), Some(class_b)] = lookup.each_ref().map(|lookup| lookup.class(item, place))
            else {
                ruling.not_judged += 1;
                continue;
            };
            *ruling.by_class.entry((class_a, class_b)).or_default() += 1;
            if class_a.max(class_b) >= Class::Undecided && ruling.wrong.len() < MAX_DESCRIBED_CELLS {
                let (who, side) = match (class_a >= Class::Undecided, class_b >= Class::Undecided) {
                    (true, true) => ("A and B", 0),
                    (true, false) => ("A", 0),
                    _ => ("B", 1),
                };
                let what = lookup[side].description(place);
                ruling.wrong.push(RuledCell { place, who, what });
            }
        }
        rulings.channels.insert(channel.key.clone(), ruling);
    }
    rulings
}

/// Whether two numbers differ by more than is allowed.
fn exceeds(thresholds: &Thresholds, x: f64, y: f64, ulp: f64) -> bool {
    match compare_numbers(x, y) {
        Comparison::Equal => false,
        Comparison::Incomparable => true,
        Comparison::Apart(difference) => !thresholds.allow(x, y, difference, ulp),
    }
}

/// The class of each ray according to the check of one side.
struct ClassLookup<'a> {
    /// Classes other than `Agree`.
    others: HashMap<(Item, Place), Class>,
    /// Rays that were not judged.
    unjudged: HashSet<(Item, Place)>,
    /// The wrong rays that are described.
    wrong: HashMap<Place, &'a Defect>,
}

impl<'a> ClassLookup<'a> {
    fn new(check: &'a Check) -> Self {
        let items = check.sensors.iter().flat_map(|sensor| sensor.items.iter());
        let others = items.flat_map(|(item, tally)| {
            tally.others.iter().map(move |(place, class)| ((item, *place), *class))
        });
        let items = check.sensors.iter().flat_map(|sensor| sensor.items.iter());
        let unjudged = items.flat_map(|(item, tally)| tally.unjudged.iter().map(move |place| (item, *place)));
        let wrong = check.sensors.iter().flat_map(|sensor| &sensor.defects).map(|one| (one.place, one));
        Self { others: others.collect(), unjudged: unjudged.collect(), wrong: wrong.collect() }
    }

    /// The class of a quantity of a ray: the worst of its own and those of hit and face. `None`: it was not judged.
    fn class(&self, item: Item, place: Place) -> Option<Class> {
        if self.unjudged.contains(&(item, place)) {
            return None;
        }
        let class = |item: Item| self.others.get(&(item, place)).copied().unwrap_or(Class::Agree);
        // A pencil's flux depends on whether and where the camera sees it.
        let visibility = match item.quantity {
            Quantity::PencilFlux => class(Quantity::Visible.into()).max(class(Quantity::Pixel.into())),
            _ => Class::Agree,
        };
        Some(class(item).max(visibility).max(class(Quantity::Hit.into())).max(class(Quantity::Face.into())))
    }

    /// What is wrong with a ray, in words.
    fn description(&self, place: Place) -> String {
        self.wrong.get(&place).map_or("one of many wrong rays".into(), |wrong| wrong.what.clone())
    }
}

/// The sensor and quantity of a channel. `None`: the scene has no such channel.
fn item_of(truth: &GroundTruth<'_>, key: &str) -> Option<(SensorId, Item)> {
    let (sensor, name) = key.split_once('/')?;
    let sensor = truth.scene().sensors().find(|one| one.to_string() == sensor)?;
    Some((sensor, item_of_channel(truth.scene(), sensor, name)?))
}
