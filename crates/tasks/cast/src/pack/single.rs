//! Whether wrong values look like those of single precision. Its bounds are wide: they also excuse a constant length or rounded decimals
//! of a hundred millionth.

use std::collections::BTreeMap;

use raypencil_referee::ExactCast;

use super::moved::{Length, follow_a_rule, lengths_off};
use super::trial::Trial;
use crate::comparison::CastValue;

/// Wrong rays that are looked at, at most.
const MAX_LOOKED: usize = 400;

/// Numbers of which signs and sizes say something, at least.
const MIN_NUMBERS: usize = 12;

/// A value that is nearer to the exact one, as a part of it, is not wrong: a few roundings of double precision.
const RIGHT: f64 = 16.0 * f64::EPSILON;

/// Least error in the middle, as a part of the number. Rounding to single precision alone leaves 2^-26 or more.
const LEAST_ERROR: f64 = 1.0 / (1_u64 << 28) as f64;

/// Error of lengths in the middle, at most, in roundings of the largest coordinate that a ray sees, along the normal of the face. Tuned:
/// a program that tests triangles as Moeller and Trumbore do leaves 0.4 there, one whose rays alone are of single precision 0.2.
const MAX_ROUNDINGS: f64 = 2.0;

/// Distances between rays, in the order of the pack, at which signs are compared, at most: the channels of most sensors.
const MAX_APART: usize = 128;

/// Pairs of signs that say something, at least. Of 64 random ones three in four agree once in 16,000 times.
const MIN_PAIRS: usize = 64;

/// A wrong number.
struct Off {
    /// The index of its ray in the pack, and which part of its value it is.
    place: (usize, usize),
    value: CastValue,
    stated: f64,
    exact: f64,
    /// Whether its type holds single precision or less, whatever was computed.
    is_stored_so: bool,
}

impl Off {
    /// How far it is off, as a part of the exact number.
    fn size(&self) -> f64 {
        ((self.stated - self.exact) / self.exact).abs()
    }
}

/// Whether numbers of double precision of rays that lie so many apart are off to the same side, or to opposite sides, of three pairs in
/// four: rounding is off to either.
fn has_an_order(numbers: &[Off]) -> bool {
    let mut of_parts: BTreeMap<(&str, usize), BTreeMap<usize, bool>> = BTreeMap::new();
    for off in numbers.iter().filter(|off| !off.is_stored_so) {
        let (ray, part) = off.place;
        of_parts.entry((off.value.name(), part)).or_default().insert(ray, off.stated > off.exact);
    }
    let is_ordered = |signs: &BTreeMap<usize, bool>, apart: usize| {
        let pairs = signs.iter().filter_map(|(ray, sign)| Some(sign == signs.get(&(ray + apart))?));
        let (all, same) = pairs.fold((0, 0), |(all, same), is_same| (all + 1, same + usize::from(is_same)));
        all >= MIN_PAIRS && (4 * same > 3 * all || 4 * same < all)
    };
    of_parts.values().any(|signs| (1..=MAX_APART).any(|apart| is_ordered(signs, apart)))
}

impl Trial {
    /// Whether lengths of the first rays, so many, are off by no more than a few roundings of single precision and by no rule; and most
    /// wrong numbers, or most of one value, are of single precision, or are off by as much as its rounding and to both sides. Lengths have to be off to both sides by themselves: what moves or turns a sensor makes them all longer, or all
    /// shorter, where points go to either side of it. The sides of numbers in double precision have to have no order: what a sensor does
    /// otherwise is off to one side on all neighbouring rays, or on all rays of a channel.
    pub(super) fn looks_single(&self, exact: &ExactCast<'_>, wrong: usize) -> bool {
        let numbers: Vec<Off> =
            (0..wrong.min(self.rays.len()).min(MAX_LOOKED)).flat_map(|ray| self.off(exact, ray)).collect();
        let most = |count: usize, of: usize| count * 10 >= of * 9;
        let is_single = |off: &&Off| !off.is_stored_so && off.stated == f64::from(off.stated as f32);
        // Signs of a few say nothing: each has to be a number of single precision, or to be stored as one.
        if numbers.len() < MIN_NUMBERS {
            let is_off_so = |off: &Off| off.is_stored_so && off.size() >= LEAST_ERROR;
            return numbers.iter().all(|off| is_single(&off) || is_off_so(off));
        }
        let rays = || 0..wrong.min(self.rays.len());
        let mut is_free = true;
        for value in [CastValue::T, CastValue::Range] {
            let lengths = lengths_off(self, exact, value, rays());
            let mut sizes: Vec<f64> = lengths.iter().map(Length::roundings).collect();
            sizes.sort_by(f64::total_cmp);
            let Some(middle) = sizes.get(sizes.len() / 2) else { continue };
            let rule = follow_a_rule(&lengths);
            if *middle > MAX_ROUNDINGS || rule == Some(true) {
                return false;
            }
            is_free &= rule == Some(false);
        }
        let of_value = |value: CastValue| numbers.iter().filter(move |off| off.value == value);
        let is_single_value = |value: CastValue| {
            let all = of_value(value).count();
            all >= MIN_NUMBERS && most(of_value(value).filter(is_single).count(), all)
        };
        if most(numbers.iter().filter(is_single).count(), numbers.len())
            || CastValue::ALL.into_iter().any(is_single_value)
        {
            return true;
        }
        // Doubles that are off by little may be of a mesh whose corners are off by little: where too few rays share a face, nothing
        // tells the two apart.
        if !is_free && numbers.iter().any(|off| !off.is_stored_so) {
            return false;
        }
        // Away from 0, or towards it.
        let are_one_sided = |is_asked: &dyn Fn(&Off) -> bool| {
            let asked = || numbers.iter().filter(|off| is_asked(off));
            let (all, away) =
                (asked().count(), asked().filter(|off| off.stated.abs() > off.exact.abs()).count());
            all >= MIN_NUMBERS && (most(away, all) || most(all - away, all))
        };
        let is_one_sided = are_one_sided(&|_| true)
            || [CastValue::T, CastValue::Range]
                .into_iter()
                .any(|length| are_one_sided(&|off| off.value == length));
        let mut sizes: Vec<f64> = numbers.iter().map(Off::size).collect();
        sizes.sort_by(f64::total_cmp);
        !is_one_sided && sizes[sizes.len() / 2] >= LEAST_ERROR && !has_an_order(&numbers)
    }

    /// The numbers of a ray that are off.
    fn off(&self, exact: &ExactCast<'_>, index: usize) -> Vec<Off> {
        let ray = &self.rays[index];
        let stated = self.stated.face.as_ref().and_then(|faces| faces[index]);
        let face = stated.or_else(|| exact.reading(ray, self.sides).hit().map(|faces| faces[0]));
        let hit = face.filter(|_| self.stated.speaks(index).1).and_then(|face| exact.meeting(ray, face));
        let Some(hit) = hit else { return Vec::new() };
        let of_value = |value: CastValue| {
            let stated = self.stated.part(value, index).filter(|_| value != CastValue::Side)?;
            let is_stored_so = self.stated.stored.of(value, index) > 0.0;
            let pairs = stated.into_iter().zip(value.exact(&hit)).enumerate();
            let ray = self.indices[index];
            let off =
                move |(part, (stated, exact))| Off { place: (ray, part), value, stated, exact, is_stored_so };
            Some(pairs.map(off))
        };
        let all = CastValue::ALL.into_iter().filter_map(of_value).flatten();
        all.filter(|off| (off.stated - off.exact).abs() > RIGHT * off.exact.abs()).collect()
    }
}
