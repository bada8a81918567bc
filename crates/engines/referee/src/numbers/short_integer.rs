//! Integers of at most [`LIMBS`] * 64 bits that need no memory of their own: most mantissas are that short.

use std::cmp::Ordering;

use dashu_int::{IBig, Sign, UBig};

/// Numbers of 64 bits in one integer. Vertices and rays of `f64` numbers of one size have margins of 14. A dyadic number of such a
/// mantissa takes 128 bytes, the most that compilers copy without calling a function.
const LIMBS: usize = 14;

/// An integer by its sign and its absolute value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShortInteger {
    /// The lowest first; 0 from `length` on.
    limbs: [u64; LIMBS],
    /// How many of them there are: the last one is not 0.
    length: u8,
    /// Never of 0.
    is_negative: bool,
}

impl ShortInteger {
    pub(crate) const ZERO: Self = Self { limbs: [0; LIMBS], length: 0, is_negative: false };

    pub(crate) fn of(magnitude: u64, is_negative: bool) -> Self {
        let mut limbs = [0; LIMBS];
        limbs[0] = magnitude;
        Self::trimmed(limbs, 1, is_negative)
    }

    fn trimmed(limbs: [u64; LIMBS], mut length: usize, is_negative: bool) -> Self {
        while length > 0 && limbs[length - 1] == 0 {
            length -= 1;
        }
        Self { limbs, length: length as u8, is_negative: is_negative && length > 0 }
    }

    #[inline]
    fn length(&self) -> usize {
        usize::from(self.length)
    }

    #[inline]
    pub(crate) fn is_zero(&self) -> bool {
        self.length == 0
    }

    #[inline]
    pub(crate) fn sign(&self) -> Ordering {
        match (self.length, self.is_negative) {
            (0, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            _ => Ordering::Greater,
        }
    }

    #[inline]
    pub(crate) fn negated(self) -> Self {
        Self { is_negative: !self.is_negative && self.length > 0, ..self }
    }

    /// The sign and the absolute value.
    pub(crate) fn parts(&self) -> (Sign, UBig) {
        let mut bytes = [0; 8 * LIMBS];
        for (to, limb) in bytes.chunks_exact_mut(8).zip(self.limbs) {
            to.copy_from_slice(&limb.to_le_bytes());
        }
        let sign = if self.is_negative { Sign::Negative } else { Sign::Positive };
        (sign, UBig::from_le_bytes(&bytes[..8 * self.length()]))
    }

    pub(crate) fn to_long(self) -> IBig {
        let (sign, magnitude) = self.parts();
        IBig::from_parts(sign, magnitude)
    }

    /// Times 2^bits; `None` if that is too long.
    #[inline]
    pub(crate) fn shifted(&self, bits: usize) -> Option<Self> {
        if bits == 0 || self.is_zero() {
            return Some(*self);
        }
        let (by, rest) = (bits / 64, bits % 64);
        if by >= LIMBS || self.length() + by > LIMBS {
            return None;
        }
        let mut limbs = [0; LIMBS];
        let mut carry = 0;
        for k in 0..self.length() {
            let limb = self.limbs[k];
            limbs[k + by] = (limb << rest) + carry;
            carry = if rest == 0 { 0 } else { limb >> (64 - rest) };
        }
        let mut length = self.length() + by;
        if carry != 0 {
            *limbs.get_mut(length)? = carry;
            length += 1;
        }
        Some(Self { limbs, length: length as u8, is_negative: self.is_negative })
    }

    /// The sum, or the difference; `None` if that is too long.
    #[inline]
    pub(crate) fn sum(&self, other: &Self, is_difference: bool) -> Option<Self> {
        // A 0 may have either sign here: nothing is added, or taken away.
        let other_is_negative = other.is_negative != is_difference;
        if self.is_negative != other_is_negative {
            return Some(match self.compare_magnitude(other) {
                Ordering::Less => other.less_magnitude(self, other_is_negative),
                _ => self.less_magnitude(other, self.is_negative),
            });
        }
        let mut limbs = [0; LIMBS];
        let mut length = self.length().max(other.length());
        let mut carry = false;
        for k in 0..length {
            let (sum, one) = self.limbs[k].overflowing_add(other.limbs[k]);
            let (sum, two) = sum.overflowing_add(u64::from(carry));
            limbs[k] = sum;
            carry = one || two;
        }
        if carry {
            *limbs.get_mut(length)? = 1;
            length += 1;
        }
        Some(Self { limbs, length: length as u8, is_negative: self.is_negative })
    }

    /// The product; `None` if that may be too long.
    #[inline]
    pub(crate) fn times(&self, other: &Self) -> Option<Self> {
        let length = self.length() + other.length();
        if self.is_zero() || other.is_zero() {
            return Some(Self::ZERO);
        }
        if length > LIMBS {
            return None;
        }
        let mut limbs = [0; LIMBS];
        for k in 0..self.length() {
            let (factor, mut carry) = (u128::from(self.limbs[k]), 0);
            let to = &mut limbs[k..=k + other.length()];
            for (limb, &of_other) in to.iter_mut().zip(&other.limbs[..other.length()]) {
                // At most (2^64 - 1)^2 + 2 (2^64 - 1) = 2^128 - 1.
                let sum = factor * u128::from(of_other) + u128::from(*limb) + carry;
                *limb = sum as u64;
                carry = sum >> 64;
            }
            to[other.length()] = carry as u64;
        }
        Some(Self::trimmed(limbs, length, self.is_negative != other.is_negative))
    }

    fn compare_magnitude(&self, other: &Self) -> Ordering {
        let by_limbs = || {
            let pairs = self.limbs[..self.length()].iter().zip(&other.limbs).rev();
            pairs.map(|(a, b)| a.cmp(b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
        };
        self.length.cmp(&other.length).then_with(by_limbs)
    }

    /// |self| - |other| with this sign; |other| is not larger.
    fn less_magnitude(&self, other: &Self, is_negative: bool) -> Self {
        let mut limbs = [0; LIMBS];
        let mut borrow = false;
        for k in 0..self.length() {
            let (difference, one) = self.limbs[k].overflowing_sub(other.limbs[k]);
            let (difference, two) = difference.overflowing_sub(u64::from(borrow));
            limbs[k] = difference;
            borrow = one || two;
        }
        Self::trimmed(limbs, self.length(), is_negative)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/short_integer.rs"]
mod tests;
