//! Three-valued logic (Kleene's): answers to yes-or-no questions about numbers that are known up to an interval.

use std::ops::{BitAnd, BitOr, Not};

use crate::numbers::number::Interval;

/// A truth value: true, false, or unknown. Unknown is `may_hold` and `may_fail` together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Kleene {
    /// Whether the statement may be true.
    pub(crate) may_hold: bool,
    /// Whether the statement may be false.
    pub(crate) may_fail: bool,
}

impl Kleene {
    pub(crate) const TRUE: Self = Self { may_hold: true, may_fail: false };
    pub(crate) const FALSE: Self = Self { may_hold: false, may_fail: true };

    /// Whether x >= 0.
    pub(crate) fn not_negative(x: Interval) -> Self {
        // A bound that is NaN decides nothing.
        Self { may_hold: !(x.high < 0.0), may_fail: !(x.low >= 0.0) }
    }

    /// Whether x > 0.
    pub(crate) fn positive(x: Interval) -> Self {
        Self { may_hold: !(x.high <= 0.0), may_fail: !(x.low > 0.0) }
    }

    /// The conjunction of some values; true for none.
    pub(crate) fn all(truths: impl IntoIterator<Item = Self>) -> Self {
        truths.into_iter().fold(Self::TRUE, Self::bitand)
    }

    /// The disjunction of some values; false for none.
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
