//! Trials: how many sampled values a set of corrections leaves off, and which channels each correction helps.

use std::collections::BTreeSet;

use raypencil_scene::Place;

use crate::agree_after::is_near_after;
use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::correction::{Correction, corrected};
use crate::lengths::{MIN_ROUNDED_LENGTHS, QUANTUM_DIGITS};

/// Sampled rays and their exact values, channel by channel.
#[derive(Debug)]
pub(crate) struct Trial<'t> {
    pub(crate) case: Case<'t>,
    pub(crate) channels: Vec<Channel>,
    /// The sampled rays of each channel, with the exact value.
    samples: Vec<Vec<(Place, Value)>>,
    /// Values that are off without any correction, by channel.
    uncorrected: Vec<Off>,
}

/// Sampled values that are off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Off {
    pub(crate) held: u32,
    /// Those whose ray no cell holds after a correction: it is not told whether they are right, so they are as wrong as
    /// before.
    pub(crate) lost: u32,
}

impl Off {
    const NEVER: Self = Self { held: u32::MAX, lost: 0 };

    fn all(self) -> u32 {
        self.held.saturating_add(self.lost)
    }
}

/// Corrections, and the channels to which each belongs.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    pub(crate) corrections: Vec<Correction>,
    /// For each channel, bit k: correction k is applied.
    pub(crate) applied: Vec<(Channel, usize)>,
    /// Sampled values that are off after it.
    pub(crate) off: Off,
}

/// Values off under one correction, by channel; `None`: the correction does not touch the channel.
pub(crate) type Single = Vec<Option<Off>>;

impl<'t> Trial<'t> {
    pub(crate) fn new(case: Case<'t>, places: &[Place]) -> Self {
        let channels = case.channels();
        let exact = |channel: &Channel| {
            let own = places.iter().filter(|place| place.sensor == channel.sensor);
            own.map(|place| (*place, channel.at(case.truth.answers(), *place))).collect()
        };
        let samples = channels.iter().map(exact).collect();
        let mut trial = Self { case, channels, samples, uncorrected: Vec::new() };
        trial.uncorrected = (0..trial.channels.len()).map(|index| trial.off(index, &[])).collect();
        trial
    }

    /// Sampled values that are off without any correction.
    pub(crate) fn off_uncorrected(&self) -> u32 {
        self.uncorrected.iter().map(|off| off.all()).sum()
    }

    /// Number of sampled values.
    pub(crate) fn sampled(&self) -> usize {
        self.samples.iter().map(Vec::len).sum()
    }

    /// Values of one channel that are off after some corrections.
    fn off(&self, index: usize, corrections: &[&Correction]) -> Off {
        let (case, channel) = (self.case, self.channels[index]);
        let mut off = Off::default();
        for (place, exact) in &self.samples[index] {
            let is_off =
                |value, by: &[&Correction]| !is_near_after(case, channel, *place, by, [value, *exact]);
            match corrected(case, channel, *place, corrections) {
                Some(value) => off.held += u32::from(is_off(value, corrections)),
                None => off.lost += u32::from(is_off(channel.at(&case.recorded.answers, *place), &[])),
            }
        }
        off
    }

    /// Whether a channel holds too few numbers, of too few steps, to show how its lengths grow: one length everywhere of 1 step may be
    /// nearly anything.
    fn is_coarse(&self, index: usize) -> bool {
        let channel = self.channels[index];
        let Some(storage) = self.case.recorded.storage.get(&(channel.sensor, channel.item)) else {
            return false;
        };
        let (mut numbers, mut is_short) = (BTreeSet::new(), false);
        for (place, _) in &self.samples[index] {
            if let Value::Number(number) = channel.at(&self.case.recorded.answers, *place) {
                is_short |= number.abs() < QUANTUM_DIGITS * storage.ulp(number);
                numbers.insert(number.to_bits());
            }
        }
        is_short && numbers.len() < MIN_ROUNDED_LENGTHS
    }

    /// What one correction leaves off.
    pub(crate) fn single(&self, correction: &Correction) -> Single {
        let one = |(index, channel): (usize, &Channel)| {
            let is_told = !(correction.is_of_the_size_of_lengths() && self.is_coarse(index));
            (correction.touches(*channel) && is_told).then(|| self.off(index, &[correction]))
        };
        self.channels.iter().enumerate().map(one).collect()
    }

    /// The best use of one correction, or `None` if it helps no channel.
    pub(crate) fn plan_of_one(&self, one: &Correction, single: &Single) -> Option<Plan> {
        self.plan(vec![one.clone()], |index| {
            [self.uncorrected[index], single[index].unwrap_or(Off::NEVER), Off::NEVER, Off::NEVER]
        })
    }

    /// The best use of two corrections, or `None` if one of them helps no channel.
    pub(crate) fn plan_of_two(&self, [a, b]: [&Correction; 2], singles: [&Single; 2]) -> Option<Plan> {
        self.plan(vec![a.clone(), b.clone()], |index| {
            let own = self.uncorrected[index];
            let [of_a, of_b] = [singles[0][index], singles[1][index]];
            let both = if of_a.is_some() && of_b.is_some() { self.off(index, &[a, b]) } else { Off::NEVER };
            [own, of_a.unwrap_or(Off::NEVER), of_b.unwrap_or(Off::NEVER), both]
        })
    }

    /// Chooses for each channel the corrections that leave the fewest values off; among equals the most of them: a
    /// mistake is made everywhere, also where no sampled ray tells. Each must help some channel.
    fn plan(&self, corrections: Vec<Correction>, off: impl Fn(usize) -> [Off; 4]) -> Option<Plan> {
        let mut plan = Plan { corrections, applied: Vec::new(), off: Off::default() };
        let mut used = 0;
        for (index, channel) in self.channels.iter().enumerate() {
            let off = off(index);
            let best = (0..4_usize)
                .min_by_key(|subset| (off[*subset].all(), std::cmp::Reverse(subset.count_ones())))
                .expect("four subsets");
            plan.applied.push((*channel, best));
            plan.off.held += off[best].held;
            plan.off.lost += off[best].lost;
            for (bit, one) in plan.corrections.iter().enumerate() {
                // What is said of all lengths, or of all hits, must be true of each.
                let is_of_each = one.is_of_all_lengths() || one.is_of_all_hits() && channel.is_of_hit();
                if is_of_each && one.touches(*channel) && best >> bit & 1 == 0 {
                    return None;
                }
            }
            // A correction helps where more values are off without it.
            let helps = |bit: &usize| best & bit != 0 && off[best & !bit].all() > off[best].all();
            used |= [1, 2].into_iter().filter(helps).sum::<usize>();
        }
        // Two that undo one another help each the other, and together nothing.
        let helps = plan.off.all() < self.off_uncorrected();
        (helps && used == (1 << plan.corrections.len()) - 1).then_some(plan)
    }
}
