//! Factor, offset and quantum of stated lengths, found from them.

use std::collections::BTreeSet;

use crate::case::Case;
use crate::channel::{Value, hit_quantity};
use crate::correction::{Correction, corrected};
use crate::forward::{is_half, is_rounded, z_buffer, z_buffer_slack};
use crate::mistake::{Length, Mistake};
use crate::numbers::{middle, plainest, plainest_between, rounded_to_digits};
use raypencil_files::Storage;
use raypencil_scene::{HitQuantity, Place};

/// Values from which a number is found, at least.
const MIN_VALUES: usize = 12;

/// Width of the middle half of what should be one number, relative to the lengths, at most: single precision leaves less.
const MAX_SPREAD: f64 = 4e-7;

/// A number that is found is so many times the width of what it is found from.
const SIGNIFICANT: f64 = 16.0;

/// Share of the lengths that must be multiples of a quantum. Tuned: an edge may say otherwise.
const MIN_SHARE_OF_MULTIPLES: f64 = 0.95;

/// Share of the depths that must follow the law of a z-buffer. Tuned: an edge may say otherwise.
const MIN_SHARE_OF_LAW: f64 = 0.95;

/// Digits of the depth of a z-buffer's plane, at most.
const MAX_DIGITS: usize = 9;

/// Multiples of a quantum that must occur, at least, if lengths are rounded to it. Tuned: a large quantum makes 0 of all lengths, or 0 and
/// one more, and so explains any that are short.
pub(crate) const MIN_ROUNDED_LENGTHS: usize = 3;

/// A quantum is so many times the last digit of the file's numbers: every number is a multiple of the last digit.
pub(crate) const QUANTUM_DIGITS: f64 = 16.0;

/// Cosine of the angle between two planes that count as two. In one plane, a factor is the same as another place of the
/// sensor: nothing tells them apart.
pub(crate) const MAX_COSINE_OF_TWO_PLANES: f64 = 0.999;

/// Stated and exact lengths, the coarsest last digit of the stated, and the longest exact one.
struct Pairs {
    of: Length,
    values: Vec<(f64, f64)>,
    /// Whether they end in several planes.
    has_planes: bool,
    storage: Storage,
    ulp: f64,
    longest: f64,
}

impl Pairs {
    fn new(case: Case<'_>, places: &[Place], base: Option<&Correction>, of: Length) -> Option<Self> {
        let wanted = if of == Length::Depth { HitQuantity::Depth } else { HitQuantity::Range };
        let corrections: Vec<&Correction> = base.into_iter().collect();
        let mut pairs =
            Self { of, values: Vec::new(), has_planes: false, storage: Storage::F64, ulp: 0.0, longest: 0.0 };
        let mut first_normal = None;
        for channel in case.channels() {
            if hit_quantity(channel.item.quantity) != Some(wanted) {
                continue;
            }
            pairs.storage = *case.recorded.storage.get(&(channel.sensor, channel.item))?;
            for place in places.iter().filter(|place| place.sensor == channel.sensor) {
                let exact = channel.at(case.truth.answers(), *place);
                let stated = corrected(case, channel, *place, &corrections);
                if let (Some(Value::Number(stated)), Value::Number(exact)) = (stated, exact) {
                    pairs.values.push((stated, exact));
                    if let Some(hit) = case.truth.hit(*place) {
                        let first = *first_normal.get_or_insert(hit.normal);
                        pairs.has_planes |= first.dot(hit.normal) < MAX_COSINE_OF_TWO_PLANES;
                    }
                    pairs.ulp = pairs.ulp.max(pairs.storage.ulp(stated));
                    pairs.longest = pairs.longest.max(exact);
                }
            }
        }
        (pairs.values.len() >= MIN_VALUES).then_some(pairs)
    }

    /// Factor, offset, or both.
    fn affine(&self) -> Vec<Mistake> {
        if !self.has_planes {
            return Vec::new();
        }
        let of = self.of;
        let narrow = MAX_SPREAD * self.longest + self.ulp;
        let mut found = Vec::new();
        let mut offsets: Vec<f64> = self.values.iter().map(|(stated, exact)| stated - exact).collect();
        if let Some((offset, spread)) = middle(&mut offsets, MIN_VALUES)
            && spread <= narrow
            && offset.abs() > SIGNIFICANT * (spread + f64::EPSILON * self.longest)
        {
            let of_ray = |stated: f64, exact: f64| stated - exact;
            let offset = self.told(offset, spread + 4.0 * f64::EPSILON * self.longest, &of_ray);
            found.push(Mistake::Affine { of, factor: 1.0, offset });
        }
        let ratio = |(stated, exact): &(f64, f64)| (*exact > 0.0).then(|| stated / exact);
        let mut factors: Vec<f64> = self.values.iter().filter_map(ratio).collect();
        if let Some((factor, spread)) = middle(&mut factors, MIN_VALUES)
            && (spread * self.longest <= narrow || self.is_factor_of_steps(factor, narrow))
            && (factor - 1.0).abs() > SIGNIFICANT * (spread + f64::EPSILON)
        {
            let of_ray = |stated: f64, exact: f64| stated / exact;
            let factor = self.told(factor, spread + 4.0 * f64::EPSILON, &of_ray);
            found.push(Mistake::Affine { of, factor, offset: 0.0 });
        }
        if found.is_empty() {
            found.extend(self.line(narrow));
        }
        found
    }

    /// Whether what a factor leaves of lengths in steps is as narrow as a step: of the shortest the ratios are the widest.
    fn is_factor_of_steps(&self, factor: f64, narrow: f64) -> bool {
        let mut left: Vec<f64> = self.values.iter().map(|(stated, exact)| stated - factor * exact).collect();
        let spread = middle(&mut left, MIN_VALUES).map(|(_, spread)| spread);
        matches!(self.storage, Storage::Steps(_)) && spread.is_some_and(|spread| spread <= narrow)
    }

    /// The plainest number that each ray allows whose last digit was rounded; without one, the plainest near the median.
    fn told(&self, median: f64, uncertainty: f64, of_ray: &dyn Fn(f64, f64) -> f64) -> f64 {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for (stated, exact) in &self.values {
            let half = 0.5 * self.storage.ulp(*stated);
            let number = of_ray(*stated, *exact);
            let rounding = 4.0 * f64::EPSILON * number.abs().max(f64::EPSILON * exact);
            let [a, b] = [of_ray(stated - half, *exact) - rounding, of_ray(stated + half, *exact) + rounding];
            // Edges say something else.
            if (number - median).abs() <= 8.0 * uncertainty + (b - a) {
                (low, high) = (low.max(a), high.min(b));
            }
        }
        if low < high { plainest_between(low, high) } else { plainest(median, uncertainty) }
    }

    /// Factor and offset, by the slopes from each length to one that is longer than half of the others.
    fn line(&self, narrow: f64) -> Option<Mistake> {
        let mut by_length = self.values.clone();
        by_length.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (short, long) = by_length.split_at(by_length.len() / 2);
        let slope = |(a, b): (&(f64, f64), &(f64, f64))| (b.1 > a.1).then(|| (b.0 - a.0) / (b.1 - a.1));
        let mut slopes: Vec<f64> = short.iter().zip(long).filter_map(slope).collect();
        let (factor, spread) = middle(&mut slopes, MIN_VALUES / 2)?;
        let factor = plainest(factor, spread + 4.0 * f64::EPSILON);
        let mut offsets: Vec<f64> =
            self.values.iter().map(|(stated, exact)| stated - factor * exact).collect();
        let (offset, spread) = middle(&mut offsets, MIN_VALUES)?;
        let offset = plainest(offset, spread + self.ulp + 8.0 * f64::EPSILON * self.longest);
        let is_found = spread <= narrow && factor != 1.0 && offset != 0.0 && factor > 0.0;
        is_found.then_some(Mistake::Affine { of: self.of, factor, offset })
    }

    /// The law of a z-buffer: linear in the reciprocal of the depth, by the same slopes and then by least squares.
    fn z_buffer(&self) -> Option<Mistake> {
        if self.of != Length::Depth {
            return None;
        }
        let slack = z_buffer_slack(self.storage);
        let mut by_reciprocal: Vec<(f64, f64)> = self
            .values
            .iter()
            .filter(|(_, exact)| *exact > 0.0)
            .map(|(stated, exact)| (*stated, 1.0 / exact))
            .collect();
        by_reciprocal.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (low, high) = by_reciprocal.split_at(by_reciprocal.len() / 2);
        let slope = |(a, b): (&(f64, f64), &(f64, f64))| (b.1 > a.1).then(|| (b.0 - a.0) / (b.1 - a.1));
        let mut slopes: Vec<f64> = low.iter().zip(high).filter_map(slope).collect();
        let (slope, _) = middle(&mut slopes, MIN_VALUES / 2)?;
        let mut rests: Vec<f64> = by_reciprocal.iter().map(|(stated, u)| stated - slope * u).collect();
        let (rest, spread) = middle(&mut rests, MIN_VALUES)?;
        // Edges say something else.
        let near = 8.0 * (spread + slack);
        by_reciprocal.retain(|(stated, u)| (stated - rest - slope * u).abs() <= near);
        let [rest, slope] = line_through(&by_reciprocal)?;
        let share = |low: f64, at: [f64; 2]| {
            let is = |(stated, exact): &&(f64, f64)| (z_buffer(*exact, low, at) - stated).abs() <= slack;
            self.values.iter().filter(is).count() as f64 / self.values.len() as f64
        };
        // Numbers that the slack does not tell apart follow any law.
        if !are_several_multiples(by_reciprocal.iter().map(|(stated, _)| *stated), 2.0 * slack) {
            return None;
        }
        // One over the depth has a name of its own.
        if share(0.0, [f64::INFINITY, 1.0]) >= MIN_SHARE_OF_LAW {
            return None;
        }
        // The plainest numbers that are right: infinity, of which the reciprocal is 0, then few digits before many.
        let depth = |reciprocal: f64, digits: usize| match digits {
            0 => f64::INFINITY,
            digits => rounded_to_digits(1.0 / reciprocal, digits),
        };
        let law = |low: f64, digits: [usize; 2]| {
            // The reciprocals of the depths at both ends.
            let at = [depth((low - rest) / slope, digits[0]), depth((1.0 - rest) / slope, digits[1])];
            let is_law = at[0] > 0.0 && at[1] > 0.0 && at[0] != at[1];
            (is_law && share(low, at) >= MIN_SHARE_OF_LAW).then_some(Mistake::ZBuffer {
                low,
                low_at: at[0],
                one_at: at[1],
            })
        };
        let pairs = (0..=2 * MAX_DIGITS).flat_map(|all| {
            (all.saturating_sub(MAX_DIGITS)..=all.min(MAX_DIGITS)).map(move |one| [one, all - one])
        });
        pairs
            .flat_map(|digits| [0.0, -1.0].map(|low| (low, digits)))
            .find_map(|(low, digits)| law(low, digits))
    }

    /// The largest quantum of which nearly all lengths are multiples.
    /// And half precision, which within one power of two is a grid: which of both it is, all wrong rays say, and not these few.
    fn rounded(&self) -> Vec<Mistake> {
        let share = |quantum: f64, down: bool| {
            let is = |(stated, exact): &&(f64, f64)| is_rounded(self.storage, *stated, *exact, quantum, down);
            self.values.iter().filter(is).count() as f64 / self.values.len() as f64
        };
        let right = |(stated, exact): &&(f64, f64)| (stated - exact).abs() <= self.ulp;
        if 2 * self.values.iter().filter(right).count() > self.values.len() {
            return Vec::new();
        }
        // One length everywhere, or two, is no half precision either.
        let stated: BTreeSet<u64> = self.values.iter().map(|(stated, _)| stated.to_bits()).collect();
        if stated.len() < MIN_ROUNDED_LENGTHS {
            return Vec::new();
        }
        let halves = self.values.iter().filter(|(stated, exact)| is_half(*stated, *exact)).count();
        let of_halves = halves as f64 / self.values.len() as f64;
        let is = |quantum: f64, down: bool| {
            let on_grid = self
                .values
                .iter()
                .filter(|(stated, exact)| is_rounded(self.storage, *stated, *exact, quantum, down));
            share(quantum, down) >= MIN_SHARE_OF_MULTIPLES
                && are_several_multiples(on_grid.map(|(stated, _)| *stated), quantum)
        };
        let found = rounded_to(self.ulp, |quantum| is(quantum, false) || is(quantum, true));
        let found = found.map(|quantum| (quantum, !is(quantum, false)));
        let multiples = found.map(|(quantum, down)| Mistake::Rounded { of: self.of, quantum, down });
        let half = (of_halves >= MIN_SHARE_OF_MULTIPLES).then_some(Mistake::HalfPrecision(self.of));
        multiples.into_iter().chain(half).collect()
    }
}

/// The line y = a + b x through pairs (y, x), by least squares: a and b.
fn line_through(pairs: &[(f64, f64)]) -> Option<[f64; 2]> {
    let count = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (y, x) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let square: f64 = pairs.iter().map(|pair| (pair.1 - x) * (pair.1 - x)).sum();
    let product: f64 = pairs.iter().map(|pair| (pair.0 - y) * (pair.1 - x)).sum();
    let slope = product / square;
    (pairs.len() >= MIN_VALUES && slope.is_finite() && slope != 0.0).then_some([y - slope * x, slope])
}

/// The largest quantum that `is_grid` says the lengths lie on, and that they have digits beside.
pub(crate) fn rounded_to(ulp: f64, is_grid: impl Fn(f64) -> bool) -> Option<f64> {
    quanta().into_iter().filter(|quantum| *quantum >= QUANTUM_DIGITS * ulp).find(|quantum| is_grid(*quantum))
}

/// Whether some lengths are several different multiples of a quantum: one everywhere, or two, is no grid of lengths.
pub(crate) fn are_several_multiples(stated: impl Iterator<Item = f64>, quantum: f64) -> bool {
    // 0 in place of -0.
    let multiples: BTreeSet<u64> =
        stated.map(|stated| ((stated / quantum).round() + 0.0).to_bits()).collect();
    multiples.len() >= MIN_ROUNDED_LENGTHS
}

/// Quanta that are tried, metres, the largest first: 1, 2 and 5 of each decimal place, and powers of two.
fn quanta() -> Vec<f64> {
    let decimal = |place: i32| [1, 2, 5].map(|digit| format!("{digit}e{place}").parse().unwrap_or(1.0));
    let mut all: Vec<f64> = (-7..=0).flat_map(decimal).collect();
    all.extend((1..=20).map(|halvings| 1.0 / f64::from(1_u32 << halvings)));
    all.sort_by(|a, b| b.total_cmp(a));
    all
}

/// Factor, offset and quantum of ranges and of depths, found after `base`; and of both where both are there.
pub(crate) fn lengths(case: Case<'_>, places: &[Place], base: Option<&Correction>) -> Vec<Correction> {
    let of = |length| {
        Pairs::new(case, places, base, length).map_or(Vec::new(), |pairs| {
            let mut found = pairs.affine();
            found.extend(pairs.rounded());
            if found.is_empty() {
                found.extend(pairs.z_buffer());
            }
            found
        })
    };
    let [ranges, depths] = [of(Length::Range), of(Length::Depth)];
    // Of both, where both say so; without depths or ranges there is nothing that is said of both.
    let of_both = ranges.iter().filter_map(|mistake| {
        let with = |of| match *mistake {
            Mistake::Affine { factor, offset, .. } => Mistake::Affine { of, factor, offset },
            Mistake::Rounded { quantum, down, .. } => Mistake::Rounded { of, quantum, down },
            Mistake::HalfPrecision(_) => Mistake::HalfPrecision(of),
            other => other,
        };
        depths.contains(&with(Length::Depth)).then(|| with(Length::All))
    });
    let of_both: Vec<Mistake> = of_both.collect();
    of_both.into_iter().chain(ranges).chain(depths).map(Correction::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_needs_twelve_pairs_that_differ_in_x() {
        // y = 2 - 3 x at x = 0 to 11.
        let pairs: Vec<(f64, f64)> = (0..12).map(f64::from).map(|x| (2.0 - 3.0 * x, x)).collect();
        assert_eq!(line_through(&pairs), Some([2.0, -3.0]));
        assert_eq!(line_through(&pairs[1..]), None);
        let above_each_other: Vec<(f64, f64)> = pairs.iter().map(|(y, _)| (*y, 5.0)).collect();
        assert_eq!(line_through(&above_each_other), None);
        let level: Vec<(f64, f64)> = pairs.iter().map(|(_, x)| (5.0, *x)).collect();
        assert_eq!(line_through(&level), None);
    }

    #[test]
    fn short_lengths_are_no_multiples_of_a_long_quantum() {
        let exact = || (0..24).map(|k| 1.05 + f64::from(k) / 12.0);
        let of = |storage: Storage, made: fn(f64) -> f64| {
            let values = exact().map(|exact| (made(exact), exact)).collect();
            let ulp = storage.ulp(made(2.9));
            Pairs { of: Length::Depth, values, has_planes: true, storage, ulp, longest: 2.97 }.rounded()
        };
        let told = |quantum, down| vec![Mistake::Rounded { of: Length::Depth, quantum, down }];
        // Lengths of less than a last digit are 0 for all that half precision shows: rounded down to 5 m, so are these.
        assert_eq!(of(Storage::F16, |exact| 1e-9 * exact), []);
        // 1 and 2 m: rounded down to 1 m, or one of two constants.
        assert_eq!(of(Storage::F64, f64::floor), []);
        assert_eq!(of(Storage::F64, |exact| (2.0 * exact).floor() / 2.0), told(0.5, true));
        assert_eq!(of(Storage::F64, f64::round), told(1.0, false));
        // -0 and 0 are one multiple.
        assert!(!are_several_multiples([-0.1, 0.1, 1.0].into_iter(), 1.0));
        assert!(are_several_multiples([-0.1, 1.0, 2.0].into_iter(), 1.0));
    }

    #[test]
    fn nearly_all_depths_must_follow_the_law_of_a_z_buffer() {
        // 1 to 3.3 m, with 0 at 0.5 m and 1 at 100 m; of the last ones of so many something else is stated.
        let of = |others: usize| {
            let value = |k: u32| {
                let exact = 1.0 + 0.1 * f64::from(k);
                let stated = if k >= 24 - others as u32 { 0.125 } else { z_buffer(exact, 0.0, [0.5, 100.0]) };
                (stated, exact)
            };
            let values = (0..24).map(value).collect();
            let (of, storage) = (Length::Depth, Storage::F64);
            Pairs { of, values, has_planes: true, storage, ulp: storage.ulp(1.0), longest: 3.3 }.z_buffer()
        };
        let law = Some(Mistake::ZBuffer { low: 0.0, low_at: 0.5, one_at: 100.0 });
        // 23 of 24 are more than 95 %, and 22 of 24 fewer.
        assert_eq!([of(0), of(1), of(2)], [law, law, None]);
    }

    #[test]
    fn quanta_go_from_five_metres_to_a_ten_millionth() {
        let all = quanta();
        assert_eq!((all.len(), all[0], all[1], all[all.len() - 1]), (44, 5.0, 2.0, 1e-7));
        assert!(all.is_sorted_by(|a, b| a >= b) && all.contains(&0.05) && all.contains(&0.0625));
    }
}
