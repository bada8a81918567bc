//! How far a displacement must go until some linear conditions hold, by the larger of |a| and |b|.
//!
//! Conditions g_i = c_i + x_i a + y_i b >= 0 bound a convex region of the plane. If its least size is r, the dual of
//! this linear program says that some weights w_i >= 0 prove it: G = sum w_i g_i is at most C + r (|X| + |Y|) on a square
//! of radius r, so r >= -C / (|X| + |Y|), and the best weights reach it. The dual's basic solutions have one weight, or
//! two that make X or Y vanish; or three that make both vanish with C < 0, which proves that nothing fulfils the
//! conditions. So all singles, pairs and triples are tried. Any of them is a valid lower bound, certain or not.

use std::cmp::Ordering;

use super::flat::Linear;
use crate::number::{Dyadic, Interval, Number};
use crate::rounding::quotient;

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

fn is_negative<T: Number>(x: &T) -> bool {
    x.sign() == Some(Ordering::Less)
}

fn is_zero<T: Number>(x: &T) -> bool {
    x.sign() == Some(Ordering::Equal)
}

/// Bounds of the least size, in D times the mesh's unit, of a displacement at which all conditions hold; `None` if
/// certainly none exists. The upper bound is valid in exact numbers only: in intervals doubtful conditions are left out.
pub(super) fn least_size<T: Bounded>(conditions: &[Linear<T>]) -> Option<[f64; 2]> {
    let mut bounds = [0.0_f64; 2];
    // -C / (|X| + |Y|), where C is certainly negative.
    let mut prove = |c: &T, x: &T, y: &T| -> bool {
        let slope = x.abs().add(&y.abs());
        if is_zero(&slope) {
            return false;
        }
        let [low, high] = T::quotient_between(&T::of(0.0).sub(c), &slope);
        bounds = [bounds[0].max(low), bounds[1].max(high)];
        true
    };
    for condition in conditions.iter().filter(|condition| is_negative(&condition.c)) {
        if !prove(&condition.c, &condition.x, &condition.y) {
            return None;
        }
    }
    for (k, one) in conditions.iter().enumerate() {
        for other in &conditions[k + 1..] {
            if !is_negative(&one.c) && !is_negative(&other.c) {
                continue;
            }
            for along_x in [true, false] {
                let slope = |linear: &Linear<T>| if along_x { linear.x.clone() } else { linear.y.clone() };
                let (of_one, of_other) = (slope(one), slope(other));
                let are_opposite = matches!(
                    (of_one.sign(), of_other.sign()),
                    (Some(Ordering::Less), Some(Ordering::Greater))
                        | (Some(Ordering::Greater), Some(Ordering::Less))
                );
                if !are_opposite {
                    continue;
                }
                let sum = one.scaled(&of_other.abs()).add(&other.scaled(&of_one.abs()));
                // One of the slopes vanishes by the choice of the weights.
                let (x, y) = if along_x { (T::of(0.0), sum.y) } else { (sum.x, T::of(0.0)) };
                if is_negative(&sum.c) && !prove(&sum.c, &x, &y) {
                    return None;
                }
            }
        }
    }
    (!is_empty(conditions)).then_some(bounds)
}

/// Whether three of the conditions certainly exclude one another.
fn is_empty<T: Bounded>(conditions: &[Linear<T>]) -> bool {
    let cross = |a: &Linear<T>, b: &Linear<T>| a.x.mul(&b.y).sub(&a.y.mul(&b.x));
    let count = conditions.len();
    for i in 0..count {
        for j in i + 1..count {
            let of_k = cross(&conditions[i], &conditions[j]);
            let Some(turn @ (Ordering::Less | Ordering::Greater)) = of_k.sign() else { continue };
            for k in j + 1..count {
                let [a, b, c] = [i, j, k].map(|index| &conditions[index]);
                if ![a, b, c].iter().any(|condition| is_negative(&condition.c)) {
                    continue;
                }
                let (of_i, of_j) = (cross(b, c), cross(c, a));
                // The slopes vanish in sum with these weights, which must have one sign.
                let weights = [&of_i, &of_j, &of_k];
                if weights.iter().any(|weight| weight.sign() != Some(turn)) {
                    continue;
                }
                let sum = a.c.mul(&of_i).add(&b.c.mul(&of_j)).add(&c.c.mul(&of_k));
                let negative = if turn == Ordering::Greater { Ordering::Less } else { Ordering::Greater };
                if sum.sign() == Some(negative) {
                    return true;
                }
            }
        }
    }
    false
}
