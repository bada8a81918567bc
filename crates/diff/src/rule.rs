//! Who is right where two recordings of one scene differ: the referee on each cell beyond what is allowed.
//!
//! A difference that both sides may have, by the truth and the arithmetic that they declare, is none of either's
//! faults; a cell on which one is wrong fails whatever the share of cells that is allowed.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::cells::{Differs, Thresholds, differs};
use crate::difference::{Difference, Sides};
use raypencil_judge::{Check, Class, Item, Quantity, Truth, Wrong};
use raypencil_scene::Place;

/// What the referee says of the cells that differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Rulings {
    /// Channels of the scene that have such cells, by key.
    pub channels: BTreeMap<String, ChannelRuling>,
    /// Channels with such cells that are none of the scene's: what was allowed decides.
    pub not_ruled: Vec<String>,
}

/// One channel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChannelRuling {
    /// Cells ruled on, by what A and B say there.
    pub by_class: BTreeMap<(Class, Class), u64>,
    /// Cells of which nothing can be told on one side: what was allowed decides.
    pub not_judged: u64,
    /// The first cells on which a side is wrong, which side, and why.
    pub wrong: Vec<RuledCell>,
}

/// A cell on which a side is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct RuledCell {
    /// Which ray.
    pub place: Place,
    /// `A`, `B` or `A and B`.
    pub who: &'static str,
    /// What is said, what is true, and the ruling.
    pub what: String,
}

/// How many cells of a channel are described; all are counted.
const DESCRIBED: usize = 5;

impl ChannelRuling {
    /// Cells on which a side is wrong, or the referee's budget ran out.
    pub fn faults(&self) -> u64 {
        self.by_class.iter().filter(|((a, b), _)| *a.max(b) >= Class::Undecided).map(|(_, count)| count).sum()
    }
}

/// Rules on each cell that differs by more than is allowed, by the checks of both sides against the truth.
pub fn rule(difference: &Difference, sides: &Sides, truth: &Truth<'_>, checks: [&Check; 2]) -> Rulings {
    let lookup = checks.map(Lookup::new);
    let mut rulings = Rulings { channels: BTreeMap::new(), not_ruled: Vec::new() };
    for channel in difference.channels.iter().filter(|channel| channel.differing > 0) {
        let Some((sensor, item)) = item_of(truth, &channel.key) else {
            rulings.not_ruled.push(channel.key.clone());
            continue;
        };
        let [a, b] = sides.channels.map(|channels| &channels.by_key[&channel.key].values);
        let mut ruling = ChannelRuling::default();
        for index in 0..channel.cells() as usize {
            let (x, y) = (a.real(index), b.real(index));
            if !exceeds(&difference.thresholds, x, y, channel.storage.ulp(x.abs().max(y.abs()))) {
                continue;
            }
            let (i, j) = (index as u32 % channel.width, index as u32 / channel.width);
            let place = Place { sensor, i, j };
            let [Some(of_a), Some(of_b)] = lookup.each_ref().map(|lookup| lookup.class(item, place)) else {
                ruling.not_judged += 1;
                continue;
            };
            *ruling.by_class.entry((of_a, of_b)).or_default() += 1;
            if of_a.max(of_b) >= Class::Undecided && ruling.wrong.len() < DESCRIBED {
                let (who, side) = match (of_a >= Class::Undecided, of_b >= Class::Undecided) {
                    (true, true) => ("A and B", 0),
                    (true, false) => ("A", 0),
                    _ => ("B", 1),
                };
                let what = lookup[side].words(place);
                ruling.wrong.push(RuledCell { place, who, what });
            }
        }
        rulings.channels.insert(channel.key.clone(), ruling);
    }
    rulings
}

fn exceeds(thresholds: &Thresholds, x: f64, y: f64, ulp: f64) -> bool {
    match differs(x, y) {
        Differs::Same => false,
        Differs::Incomparable => true,
        Differs::By(by) => !thresholds.allow(x, y, by, ulp),
    }
}

/// What one side's check says of each ray.
struct Lookup<'a> {
    others: HashMap<(Item, Place), Class>,
    unjudged: HashSet<(Item, Place)>,
    wrong: HashMap<Place, &'a Wrong>,
}

impl<'a> Lookup<'a> {
    fn new(check: &'a Check) -> Self {
        let items = check.sensors.iter().flat_map(|sensor| &sensor.items);
        let others = items.flat_map(|(item, tally)| {
            tally.others.iter().map(move |(place, class)| ((*item, *place), *class))
        });
        let items = check.sensors.iter().flat_map(|sensor| &sensor.items);
        let unjudged = items.flat_map(|(item, tally)| tally.unjudged.iter().map(|place| (*item, *place)));
        let wrong = check.sensors.iter().flat_map(|sensor| &sensor.wrong).map(|one| (one.place, one));
        Self { others: others.collect(), unjudged: unjudged.collect(), wrong: wrong.collect() }
    }

    /// The class of a quantity of a ray, if it was judged. Whether something is hit goes before its values.
    fn class(&self, item: Item, place: Place) -> Option<Class> {
        if self.unjudged.contains(&(item, place)) {
            return None;
        }
        let of = |item: Item| self.others.get(&(item, place)).copied().unwrap_or(Class::Agree);
        // What a pencil delivers goes with whether and where it is seen.
        let of_visibility = match item.quantity {
            Quantity::PencilFlux => of(Quantity::Visible.into()).max(of(Quantity::Pixel.into())),
            _ => Class::Agree,
        };
        Some(of(item).max(of_visibility).max(of(Quantity::Hit.into())).max(of(Quantity::Face.into())))
    }

    fn words(&self, place: Place) -> String {
        self.wrong.get(&place).map_or("one of many wrong rays".into(), |wrong| wrong.what.clone())
    }
}

/// The sensor and quantity of a channel, if it is one of the scene's.
fn item_of(truth: &Truth<'_>, key: &str) -> Option<(raypencil_scene::SensorId, Item)> {
    let (sensor, name) = key.split_once('/')?;
    let sensor = truth.scene().sensors().find(|one| one.to_string() == sensor)?;
    Some((sensor, raypencil_judge::item_of_channel(truth.scene(), sensor, name)?))
}
