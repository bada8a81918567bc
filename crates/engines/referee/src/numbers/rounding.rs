//! Exact quotients and square roots, correctly rounded to f64 and to f32. Nothing here is approximate.
//!
//! p / q is cut off after at least 70 bits, and the remainder tells whether it is exact. The same holds for the root:
//! R = floor(sqrt(p / q)) in units of its last place is exact if R^2 = p / q. 70 bits and this flag decide every
//! rounding to 53 or fewer bits, also that of a number exactly between two neighbours.

use std::cmp::Ordering;

use dashu_int::ops::{BitTest, DivRem, SquareRootRem};
use dashu_int::{Sign, UBig};

use crate::numbers::number::Dyadic;

/// A real number, correctly rounded: the nearest f64, and the f32 nearest to the number itself (not to the f64). Ties
/// go to the even neighbour, as in IEEE 754.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounded {
    /// The nearest f64.
    pub double: f64,
    /// The nearest f32.
    pub single: f32,
}

/// A floating-point format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// IEEE 754 binary64.
    Double,
    /// IEEE 754 binary32.
    Single,
}

impl Rounded {
    /// The number 0.
    pub const ZERO: Self = Self { double: 0.0, single: 0.0 };

    /// The number in a format; an f32 is returned as f64.
    pub fn in_format(&self, format: Format) -> f64 {
        match format {
            Format::Double => self.double,
            Format::Single => f64::from(self.single),
        }
    }

    /// The rounding of a number from its nearest f64 and the side of that f64 on which the number lies. The side
    /// matters only where the f64 is a midpoint of two f32.
    pub(crate) fn beside(double: f64, side: Ordering) -> Self {
        let single = double as f32;
        let away = double - f64::from(single);
        // The other neighbour, if it is as near.
        let other = if away > 0.0 { single.next_up() } else { single.next_down() };
        let is_midpoint = away != 0.0 && f64::from(other) - double == away;
        let upper = if away > 0.0 { other } else { single };
        let lower = if away > 0.0 { single } else { other };
        let single = match side {
            Ordering::Greater if is_midpoint => upper,
            Ordering::Less if is_midpoint => lower,
            _ => single,
        };
        Self { double, single }
    }
}

/// The leading bits of a real number, and whether they are the whole number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LeadingBits {
    is_negative: bool,
    /// At least [`MIN_BITS`] bits if the number is not exact.
    bits: u128,
    /// The exponent of the last bit.
    exponent: i64,
    is_exact: bool,
}

/// Number of bits that decides any rounding to 53, with room to spare.
const MIN_BITS: usize = 70;

/// Number of bits of a square whose root has so many.
const MIN_BITS_OF_SQUARE: usize = 2 * MIN_BITS + 1;

impl LeadingBits {
    /// (magnitude + a part of 1, unless it is exact) 2^exponent. An inexact magnitude has at least [`MIN_BITS`] bits.
    pub(crate) fn of(is_negative: bool, magnitude: UBig, exponent: i64, is_exact: bool) -> Self {
        debug_assert!(is_exact || magnitude.bit_len() >= MIN_BITS, "bits of a number that was cut off");
        let dropped = magnitude.bit_len().saturating_sub(128);
        let is_exact = is_exact && magnitude.trailing_zeros().is_none_or(|zeros| zeros >= dropped);
        let bits = u128::try_from(magnitude >> dropped).unwrap_or(u128::MAX);
        Self { is_negative, bits, exponent: exponent + dropped as i64, is_exact }
    }

    /// The number rounded to both formats.
    pub(crate) fn rounded(&self) -> Rounded {
        // Exact, because every f32 is an f64.
        Rounded { double: self.nearest(53, -1022, 1023), single: self.nearest(24, -126, 127) as f32 }
    }

    /// The nearest number of `digits` bits with exponents from `least` to `most`, subnormal below, ties to even.
    fn nearest(&self, digits: i64, least: i64, most: i64) -> f64 {
        let signed = |x: f64| if self.is_negative { -x } else { x };
        if self.bits == 0 {
            // Only 0 has no leading bit.
            return 0.0;
        }
        let leading = self.exponent + 127 - i64::from(self.bits.leading_zeros());
        if leading > most {
            return signed(f64::INFINITY);
        }
        // Below `least` the last place stays where it is, and digits are lost.
        let last = (leading - digits + 1).max(least - digits + 1);
        let dropped = last - self.exponent;
        if dropped <= 0 {
            // All bits fit: exact.
            return signed(libm::scalbn(self.bits as f64, self.exponent as i32));
        }
        if dropped > 128 {
            return signed(0.0);
        }
        let kept = self.bits.checked_shr(dropped as u32).unwrap_or(0);
        let half = 1_u128 << (dropped - 1);
        let rest = if dropped == 128 { self.bits } else { self.bits & ((half << 1) - 1) };
        let up = match rest.cmp(&half) {
            Ordering::Less => false,
            Ordering::Greater => true,
            Ordering::Equal => !self.is_exact || kept & 1 == 1,
        };
        let kept = kept + u128::from(up);
        let value = libm::scalbn(kept as f64, last as i32);
        // The carry may have gone beyond the largest number.
        let too_large = libm::scalbn(1.0, most as i32) * 2.0;
        signed(if value >= too_large { f64::INFINITY } else { value })
    }
}

/// By how many bits p must be shifted so that p / q has this many, or one more.
fn shift_for(bits: usize, p: &UBig, q: &UBig) -> usize {
    (q.bit_len() + bits).saturating_sub(p.bit_len())
}

/// p / q, correctly rounded; q is not 0.
pub(crate) fn quotient(p: &Dyadic, q: &Dyadic) -> Rounded {
    let ((sign_p, p, exponent_p), (sign_q, q, exponent_q)) = (p.parts(), q.parts());
    if p.is_zero() {
        return Rounded::ZERO;
    }
    // Shift p so that the quotient has enough bits.
    let shift = shift_for(MIN_BITS, &p, &q);
    let (whole, rest) = (p << shift).div_rem(q);
    let exponent = exponent_p - exponent_q - shift as i64;
    LeadingBits::of(sign_p != sign_q, whole, exponent, rest.is_zero()).rounded()
}

/// The square root of p / q with the given sign, correctly rounded; p >= 0 and q > 0.
pub(crate) fn root(sign: Sign, p: &Dyadic, q: &Dyadic) -> Rounded {
    let ((_, p, exponent_p), (_, q, exponent_q)) = (p.parts(), q.parts());
    if p.is_zero() {
        return Rounded::ZERO;
    }
    let shift = shift_for(MIN_BITS_OF_SQUARE, &p, &q);
    // The exponent of the square must be even.
    let exponent = exponent_p - exponent_q - shift as i64;
    let odd = exponent.rem_euclid(2);
    let (square, rest) = (p << (shift + odd as usize)).div_rem(q);
    let (root, remainder) = square.sqrt_rem();
    let is_exact = rest.is_zero() && remainder.is_zero();
    LeadingBits::of(sign == Sign::Negative, root, (exponent - odd) / 2, is_exact).rounded()
}

#[cfg(test)]
#[path = "../../tests/unit/rounding.rs"]
mod tests;
