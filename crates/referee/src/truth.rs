//! Answers to yes-or-no questions about numbers that are known up to an interval.

use std::ops::{BitAnd, BitOr, Not};

use crate::number::Interval;

/// Yes, no, or either, as far as intervals tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Truth {
    /// Whether it may be so.
    pub(crate) may_be: bool,
    /// Whether it may be otherwise.
    pub(crate) may_not: bool,
}

impl Truth {
    pub(crate) const YES: Self = Self { may_be: true, may_not: false };
    pub(crate) const NO: Self = Self { may_be: false, may_not: true };

    /// x >= 0.
    pub(crate) fn not_negative(x: Interval) -> Self {
        // A bound that is not a number bounds nothing.
        Self { may_be: !(x.high < 0.0), may_not: !(x.low >= 0.0) }
    }

    /// x > 0.
    pub(crate) fn positive(x: Interval) -> Self {
        Self { may_be: !(x.high <= 0.0), may_not: !(x.low > 0.0) }
    }

    /// Whether all are true.
    pub(crate) fn all(truths: impl IntoIterator<Item = Self>) -> Self {
        truths.into_iter().fold(Self::YES, Self::bitand)
    }

    /// Whether any is true.
    pub(crate) fn any(truths: impl IntoIterator<Item = Self>) -> Self {
        truths.into_iter().fold(Self::NO, Self::bitor)
    }
}

impl BitAnd for Truth {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self { may_be: self.may_be && other.may_be, may_not: self.may_not || other.may_not }
    }
}

impl BitOr for Truth {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self { may_be: self.may_be || other.may_be, may_not: self.may_not && other.may_not }
    }
}

impl Not for Truth {
    type Output = Self;
    fn not(self) -> Self {
        Self { may_be: self.may_not, may_not: self.may_be }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_stays_open() {
        let open = Truth::positive(Interval { low: -1.0, high: 1.0 });
        assert_eq!(open, Truth { may_be: true, may_not: true });
        assert_eq!(!open, open);
        assert_eq!(open & Truth::NO, Truth::NO);
        assert_eq!(open | Truth::YES, Truth::YES);
        assert_eq!(open & Truth::YES, open);
        assert_eq!(Truth::all([]), Truth::YES);
        assert_eq!(Truth::any([]), Truth::NO);
    }

    #[test]
    fn zero_is_not_negative_and_not_positive() {
        let zero = Interval { low: 0.0, high: 0.0 };
        assert_eq!(Truth::not_negative(zero), Truth::YES);
        assert_eq!(Truth::positive(zero), Truth::NO);
        let nan = Interval { low: f64::NAN, high: f64::NAN };
        assert_eq!(Truth::positive(nan), Truth { may_be: true, may_not: true });
    }
}
