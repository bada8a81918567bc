//! Numbers: intervals, exact dyadic rationals, pairs of f64 with a proven error, and their correct rounding.

pub(crate) mod arithmetic;
pub(crate) mod double_double;
pub(crate) mod elementary;
pub(crate) mod enclosure;
pub(crate) mod kleene;
pub(crate) mod number;
pub(crate) mod rounding;
pub(crate) mod short_integer;
pub(crate) mod vector;
