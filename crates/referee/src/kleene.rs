//! Answers to yes-or-no questions about numbers that are known up to an interval.

use std::ops::{BitAnd, BitOr, Not};

use crate::number::Interval;

/// Yes, no, or either, as far as intervals tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Kleene {
    /// Whether it may be so.
    pub(crate) may_hold: bool,
    /// Whether it may be otherwise.
    pub(crate) may_fail: bool,
}

impl Kleene {
    pub(crate) const TRUE: Self = Self { may_hold: true, may_fail: false };
    pub(crate) const FALSE: Self = Self { may_hold: false, may_fail: true };

    /// x >= 0.
    pub(crate) fn not_negative(x: Interval) -> Self {
        // A bound that is not a number bounds nothing.
        Self { may_hold: !(x.high < 0.0), may_fail: !(x.low >= 0.0) }
    }

    /// x > 0.
    pub(crate) fn positive(x: Interval) -> Self {
        Self { may_hold: !(x.high <= 0.0), may_fail: !(x.low > 0.0) }
    }

    /// Whether all are true.
    pub(crate) fn all(truths: impl IntoIterator<Item = Self>) -> Self {
        truths.into_iter().fold(Self::TRUE, Self::bitand)
    }

    /// Whether any is true.
    pub(crate) fn any(truths: impl IntoIterator<Item = Self>) -> Self {
        truths.into_iter().fold(Self::FALSE, Self::bitor)
    }
}

impl BitAnd for Kleene {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self { may_hold: self.may_hold && other.may_hold, may_fail: self.may_fail || other.may_fail }
    }
}

impl BitOr for Kleene {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self { may_hold: self.may_hold || other.may_hold, may_fail: self.may_fail && other.may_fail }
    }
}

impl Not for Kleene {
    type Output = Self;
    fn not(self) -> Self {
        Self { may_hold: self.may_fail, may_fail: self.may_hold }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_stays_open() {
        let open = Kleene::positive(Interval { low: -1.0, high: 1.0 });
        assert_eq!(open, Kleene { may_hold: true, may_fail: true });
        assert_eq!(!open, open);
        assert_eq!(open & Kleene::FALSE, Kleene::FALSE);
        assert_eq!(open | Kleene::TRUE, Kleene::TRUE);
        assert_eq!(open & Kleene::TRUE, open);
        assert_eq!(Kleene::all([]), Kleene::TRUE);
        assert_eq!(Kleene::any([]), Kleene::FALSE);
    }

    #[test]
    fn zero_is_not_negative_and_not_positive() {
        let zero = Interval { low: 0.0, high: 0.0 };
        assert_eq!(Kleene::not_negative(zero), Kleene::TRUE);
        assert_eq!(Kleene::positive(zero), Kleene::FALSE);
        let nan = Interval { low: f64::NAN, high: f64::NAN };
        assert_eq!(Kleene::positive(nan), Kleene { may_hold: true, may_fail: true });
    }
}
