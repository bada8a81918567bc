//! How far a displacement must go until some linear conditions hold, by the larger of |a| and |b|.
//!
//! Conditions g_i = c_i + x_i a + y_i b >= 0 bound a convex region of the plane. If its least size is r, the dual of
//! this linear program says that some weights w_i >= 0 prove it: G = sum w_i g_i is at most C + r (|X| + |Y|) on a square
//! of radius r, so r >= -C / (|X| + |Y|), and the best weights reach it. The dual's basic solutions have one weight, or
//! two that make X or Y vanish; or three that make both vanish with C < 0, which proves that nothing fulfils the
//! conditions. So all singles, pairs and triples are tried. Any of them is a valid lower bound, certain or not.

use std::cell::OnceCell;
use std::cmp::Ordering;

use super::flat::Linear;
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::rounding::quotient;

/// A number whose absolute value and quotients can be bounded in f64.
pub(super) trait Bounded: Number {
    fn abs(&self) -> Self;
    /// Two f64 numbers between which p / q lies; 0 and infinity if nothing is certain. p and q are not negative.
    fn quotient_between(p: &Self, q: &Self) -> [f64; 2];
}

impl Bounded for Interval {
    fn abs(&self) -> Self {
        match self.sign() {
            Some(Ordering::Less) => self.negated(),
            Some(_) => *self,
            None => Self::between(0.0, self.magnitude()),
        }
    }

    fn quotient_between(p: &Self, q: &Self) -> [f64; 2] {
        let quotient = p.over(*q);
        // NaN, from numbers beyond f64, gives way to the other argument.
        [quotient.low.max(0.0), if quotient.high.is_nan() { f64::INFINITY } else { quotient.high }]
    }
}

impl Bounded for Dyadic {
    fn abs(&self) -> Self {
        if self.sign() == Some(Ordering::Less) { Self::of(0.0).sub(self) } else { self.clone() }
    }

    fn quotient_between(p: &Self, q: &Self) -> [f64; 2] {
        let nearest = quotient(p, q).double;
        if nearest == 0.0 && p.sign() == Some(Ordering::Equal) {
            return [0.0; 2];
        }
        [nearest.next_down().max(0.0), nearest.next_up()]
    }
}

/// A condition in intervals, and without rounding where that was needed.
#[derive(Debug)]
pub(super) struct LazyLinear {
    fast: Linear<Interval>,
    exact: OnceCell<Linear<Dyadic>>,
}

impl LazyLinear {
    pub(super) fn new(fast: Linear<Interval>) -> Self {
        Self { fast, exact: OnceCell::new() }
    }

    /// The condition without rounding, which `form` gives.
    pub(super) fn exact(&self, form: impl FnOnce() -> Linear<Dyadic>) -> &Linear<Dyadic> {
        self.exact.get_or_init(form)
    }
}

/// A basic solution of the dual.
#[derive(Debug, Clone, Copy)]
enum Weights {
    One(usize),
    /// Two conditions, with weights that make X vanish, or else Y.
    Two(usize, usize, bool),
}

impl Weights {
    /// Of so many conditions.
    fn all(count: usize) -> impl Iterator<Item = Self> {
        let pairs = (0..count).flat_map(move |one| (one + 1..count).map(move |other| (one, other)));
        let twos = pairs.flat_map(|(one, other)| [true, false].map(|along_x| Self::Two(one, other, along_x)));
        (0..count).map(Self::One).chain(twos)
    }
}

/// What weights prove.
enum Proof<T> {
    /// Certainly nothing.
    Nothing,
    /// That nothing fulfils the conditions.
    Empty,
    /// At least p / q, both not negative.
    AtLeast(T, T),
    /// These numbers do not tell which.
    Uncertain,
}

fn proof<'c, T: Bounded + 'c>(weights: Weights, condition: impl Fn(usize) -> &'c Linear<T>) -> Proof<T> {
    // Conditions that hold at 0 both prove nothing.
    let is_not_negative = |linear: &Linear<T>| linear.c.sign().is_some_and(Ordering::is_ge);
    let sum = match weights {
        Weights::One(one) => condition(one).clone(),
        Weights::Two(one, other, along_x) => {
            let (one, other) = (condition(one), condition(other));
            if is_not_negative(one) && is_not_negative(other) {
                return Proof::Nothing;
            }
            let slope = |linear: &'c Linear<T>| if along_x { &linear.x } else { &linear.y };
            let (of_one, of_other) = (slope(one), slope(other));
            match (of_one.sign(), of_other.sign()) {
                (Some(Ordering::Less), Some(Ordering::Greater))
                | (Some(Ordering::Greater), Some(Ordering::Less)) => {}
                (Some(_), Some(_)) => return Proof::Nothing,
                _ => return Proof::Uncertain,
            }
            let sum = one.scaled(&of_other.abs()).add(&other.scaled(&of_one.abs()));
            // One of the slopes vanishes by the choice of the weights.
            if along_x { Linear { x: T::of(0.0), ..sum } } else { Linear { y: T::of(0.0), ..sum } }
        }
    };
    match sum.c.sign() {
        Some(Ordering::Less) => {
            let slope = sum.x.abs().add(&sum.y.abs());
            match slope.sign() {
                Some(Ordering::Equal) => Proof::Empty,
                _ => Proof::AtLeast(T::of(0.0).sub(&sum.c), slope),
            }
        }
        Some(_) => Proof::Nothing,
        None => Proof::Uncertain,
    }
}

/// Bounds of the least size, in D times the mesh's unit, of a displacement at which all conditions hold; `None` if none
/// exists, or if the size `is_enough` to be of no interest. `exact` forms a condition without rounding.
///
/// In intervals first: only weights that may prove the most are looked at exactly.
pub(super) fn least_size(
    conditions: &[LazyLinear],
    exact: impl Fn(usize) -> Linear<Dyadic>,
    is_enough: impl Fn(f64) -> bool,
) -> Option<[f64; 2]> {
    let mut least = 0.0_f64;
    // The weights that may prove something, and at most how much.
    let mut candidates: Vec<(Weights, f64)> = Vec::new();
    for weights in Weights::all(conditions.len()) {
        match proof(weights, |index| &conditions[index].fast) {
            Proof::Nothing => {}
            Proof::Empty => return None,
            Proof::AtLeast(p, q) => {
                let [low, high] = Interval::quotient_between(&p, &q);
                least = least.max(low);
                candidates.push((weights, high));
            }
            Proof::Uncertain => candidates.push((weights, f64::INFINITY)),
        }
        if is_enough(least) {
            return None;
        }
    }
    let mut uncertain = Vec::new();
    for triple in triples(conditions.len()) {
        match excludes(triple.map(|index| &conditions[index].fast)) {
            Some(true) => return None,
            Some(false) => {}
            None => uncertain.push(triple),
        }
    }
    let exact = |index: usize| conditions[index].exact(|| exact(index));
    let mut bounds = [0.0_f64; 2];
    for (weights, _) in candidates.iter().filter(|(_, high)| *high >= least) {
        match proof(*weights, exact) {
            Proof::Nothing | Proof::Uncertain => {}
            Proof::Empty => return None,
            Proof::AtLeast(p, q) => {
                let [low, high] = Dyadic::quotient_between(&p, &q);
                bounds = [bounds[0].max(low), bounds[1].max(high)];
            }
        }
    }
    let is_possible =
        !is_enough(bounds[0]) && !uncertain.iter().any(|triple| excludes(triple.map(exact)) == Some(true));
    is_possible.then_some(bounds)
}

/// All three of so many.
pub(super) fn triples(count: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..count).flat_map(move |i| (i + 1..count).flat_map(move |j| (j + 1..count).map(move |k| [i, j, k])))
}

/// Whether three conditions exclude one another; `None` if these numbers do not tell.
fn excludes<T: Number>([a, b, c]: [&Linear<T>; 3]) -> Option<bool> {
    if [a, b, c].iter().all(|condition| condition.c.sign().is_some_and(Ordering::is_ge)) {
        return Some(false);
    }
    let cross = |a: &Linear<T>, b: &Linear<T>| a.x.mul(&b.y).sub(&a.y.mul(&b.x));
    // The slopes vanish in sum with these weights, which must have one sign.
    let weights = [cross(b, c), cross(c, a), cross(a, b)];
    let signs = weights.each_ref().map(Number::sign);
    let has = |sign: Ordering| signs.contains(&Some(sign));
    if has(Ordering::Equal) || (has(Ordering::Less) && has(Ordering::Greater)) {
        return Some(false);
    }
    let [Some(turn), Some(_), Some(_)] = signs else { return None };
    let [of_a, of_b, of_c] = weights;
    let sum = a.c.mul(&of_a).add(&b.c.mul(&of_b)).add(&c.c.mul(&of_c));
    Some(sum.sign()? == turn.reverse())
}
