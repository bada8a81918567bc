//! Exact quotients and square roots, correctly rounded to f64 and to f32. Nothing here is approximate.
//!
//! p / q is cut off after at least 70 bits, and whether anything was cut off is known from the remainder; the root
//! likewise: R = floor(sqrt(p / q)) in units of its last place, and it is exact if R^2 = p / q. With 70 bits and
//! that one more piece of knowledge every rounding to 53 or fewer bits is decided, a number exactly between two
//! neighbours included.

use std::cmp::Ordering;

use dashu_int::ops::{BitTest, DivRem, SquareRootRem};
use dashu_int::{Sign, UBig};

use crate::number::Dyadic;

/// The f64 nearest to a real number, and the f32 nearest to that same number (not to the f64); ties go to the
/// even one, as IEEE 754 has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounded {
    /// Nearest f64.
    pub double: f64,
    /// Nearest f32.
    pub single: f32,
}

/// One of the two formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// IEEE 754 binary64.
    Double,
    /// IEEE 754 binary32.
    Single,
}

impl Rounded {
    /// Exactly 0.
    pub const ZERO: Self = Self { double: 0.0, single: 0.0 };

    /// The nearest number of a format, which is an f64 either way.
    pub fn in_format(&self, format: Format) -> f64 {
        match format {
            Format::Double => self.double,
            Format::Single => f64::from(self.single),
        }
    }

    /// The f64 nearest to a number and on which side of it the number lies, which settles the f32: the midpoints
    /// between f32 numbers are f64 numbers, so only where the f64 is one of them the side matters.
    pub(crate) fn beside(double: f64, side: Ordering) -> Self {
        let single = double as f32;
        let away = double - f64::from(single);
        // The neighbour that is as near, if there is one.
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

/// The leading bits of a real number, and whether they are all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LeadingBits {
    is_negative: bool,
    /// At least [`MIN_BITS`] of them if the number is not exact.
    bits: u128,
    /// Of the last bit.
    exponent: i64,
    is_exact: bool,
}

/// Bits that decide any rounding to 53, with room to spare.
const MIN_BITS: usize = 70;

impl LeadingBits {
    /// (magnitude + some part of 1 unless it is exact) 2^exponent. What is not exact has [`MIN_BITS`] bits or more.
    pub(crate) fn of(is_negative: bool, magnitude: UBig, exponent: i64, is_exact: bool) -> Self {
        debug_assert!(is_exact || magnitude.bit_len() >= MIN_BITS, "bits of a number that was cut off");
        let dropped = magnitude.bit_len().saturating_sub(128);
        let is_exact = is_exact && magnitude.trailing_zeros().is_none_or(|zeros| zeros >= dropped);
        let bits = u128::try_from(magnitude >> dropped).unwrap_or(u128::MAX);
        Self { is_negative, bits, exponent: exponent + dropped as i64, is_exact }
    }

    /// Rounded to both formats.
    pub(crate) fn rounded(&self) -> Rounded {
        // Exact: an f32 is an f64.
        Rounded { double: self.nearest(53, -1022, 1023), single: self.nearest(24, -126, 127) as f32 }
    }

    /// To the nearest number of so many bits with exponents from `least` to `most`, subnormal below, ties to even.
    fn nearest(&self, digits: i64, least: i64, most: i64) -> f64 {
        let signed = |x: f64| if self.is_negative { -x } else { x };
        if self.bits == 0 {
            // Only 0 itself has no leading bit.
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
            // Short, so exact, and it fits.
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
        // One more may have carried it beyond the largest.
        let too_large = libm::scalbn(1.0, most as i32) * 2.0;
        signed(if value >= too_large { f64::INFINITY } else { value })
    }
}

/// p / q, correctly rounded; q is not 0.
pub(crate) fn quotient(p: &Dyadic, q: &Dyadic) -> Rounded {
    let ((sign_p, p, exponent_p), (sign_q, q, exponent_q)) = (p.parts(), q.parts());
    if p.is_zero() {
        return Rounded::ZERO;
    }
    // As many bits more than q as it takes.
    let shift = (q.bit_len() + MIN_BITS).saturating_sub(p.bit_len());
    let (whole, rest) = (p << shift).div_rem(q);
    let exponent = exponent_p - exponent_q - shift as i64;
    LeadingBits::of(sign_p != sign_q, whole, exponent, rest.is_zero()).rounded()
}

/// The square root of p / q, neither of them negative and q not 0, with this sign; correctly rounded.
pub(crate) fn root(sign: Sign, p: &Dyadic, q: &Dyadic) -> Rounded {
    let ((_, p, exponent_p), (_, q, exponent_q)) = (p.parts(), q.parts());
    if p.is_zero() {
        return Rounded::ZERO;
    }
    let shift = (q.bit_len() + 2 * MIN_BITS + 1).saturating_sub(p.bit_len());
    // The exponent of the square must be even.
    let exponent = exponent_p - exponent_q - shift as i64;
    let odd = exponent.rem_euclid(2);
    let (square, rest) = (p << (shift + odd as usize)).div_rem(q);
    let (root, remainder) = square.sqrt_rem();
    let is_exact = rest.is_zero() && remainder.is_zero();
    LeadingBits::of(sign == Sign::Negative, root, (exponent - odd) / 2, is_exact).rounded()
}

#[cfg(test)]
#[path = "../tests/unit/rounding.rs"]
mod tests;
