//! Scales: the place of a value between two ends, and round values as ticks.

/// An interval of values, and the function of the value that has even steps on it.
///
/// ```
/// use raypencil_report::Scale;
///
/// let scale = Scale::of([2.0, 4.0, f64::INFINITY]).expect("two finite values");
/// assert_eq!((scale.fraction(3.5), scale.fraction(9.0)), (0.75, 1.0));
/// // A span of 2 in at most 5 steps: steps of 0.5.
/// let labels: Vec<String> = scale.ticks(5).into_iter().map(|tick| tick.label).collect();
/// assert_eq!(labels, ["2.0", "2.5", "3.0", "3.5", "4.0"]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Value at the low end.
    pub low: f64,
    /// Value at the high end.
    pub high: f64,
    /// Function of the value that has even steps.
    pub spread: Spread,
}

/// Function of the value that has even steps on a scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// The value itself.
    Linear,
    /// One over the value, for ranges whose ends differ by a large factor. Along a column of a camera's image of flat
    /// ground 1/range has nearly even steps, so that every colour gets about as much of the image.
    Reciprocal,
    /// The square root of the absolute value, with its sign, for differences about zero. A hundredth of the largest
    /// difference is a tenth of the scale, so that it can still be seen.
    SignedRoot,
    /// The square root, for absolute differences.
    Root,
}

/// A labelled place on a scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// The value as text.
    pub label: String,
    /// Place on the scale: 0 at the low end, 1 at the high end.
    pub at: f64,
}

impl Scale {
    /// A scale with even steps of the value.
    pub fn linear(low: f64, high: f64) -> Self {
        Self { low, high, spread: Spread::Linear }
    }

    /// A linear scale from the smallest to the largest finite value; `None` without a finite value.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        values.into_iter().filter(|value| value.is_finite()).fold(None, |scale, value| {
            Some(match scale {
                None => Self::linear(value, value),
                Some(Self { low, high, .. }) => Self::linear(low.min(value), high.max(value)),
            })
        })
    }

    /// A scale of ranges, from the smallest to the largest. It has even steps of one over the range if the largest is
    /// at least three times the smallest; `None` without a finite value.
    pub fn of_ranges(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::of(values).map(|scale| {
            let deep = scale.low > 0.0 && scale.high >= 3.0 * scale.low;
            Self { spread: if deep { Spread::Reciprocal } else { Spread::Linear }, ..scale }
        })
    }

    /// A scale of signed differences: zero in the middle, both ends as far from it as the farthest finite value. `None`
    /// without a finite value.
    pub fn symmetric(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::of(values).map(|Self { low, high, .. }| {
            let limit = high.abs().max(low.abs());
            Self { low: -limit, high: limit, spread: Spread::SignedRoot }
        })
    }

    /// A scale of absolute differences, from zero to the largest finite value; `None` without a finite value.
    pub fn from_zero(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::of(values).map(|Self { high, .. }| Self { low: 0.0, high, spread: Spread::Root })
    }

    /// Place of a value: 0 at the low end, 1 at the high end. A value outside is at the nearer end. On a scale of a
    /// single value every value is in the middle, 0.5.
    pub fn fraction(&self, value: f64) -> f64 {
        let even = |value: f64| match self.spread {
            Spread::Linear => value,
            Spread::Reciprocal => -1.0 / value,
            Spread::SignedRoot | Spread::Root => value.abs().sqrt().copysign(value),
        };
        let span = even(self.high) - even(self.low);
        if span > 0.0 { ((even(value) - even(self.low)) / span).clamp(0.0, 1.0) } else { 0.5 }
    }

    /// Ticks at round values in ascending order, at most `most + 1` of them.
    pub fn ticks(&self, most: u32) -> Vec<Tick> {
        let span = self.high - self.low;
        if !(span > 0.0 && span.is_finite()) {
            return vec![Tick { label: label(self.low), at: 0.5 }];
        }
        match self.spread {
            Spread::Linear => self.even_ticks(most),
            Spread::Reciprocal => self.apart(most, round_numbers(&[1, 2, 3, 5], self.low, self.high)),
            Spread::Root => {
                let upper = round_numbers(&[1, 2, 5], self.high * 1e-4, self.high).rev();
                let mut ticks = self.apart(most, upper);
                ticks.retain(|tick| tick.at >= 1.0 / f64::from(most));
                ticks.push(Tick { label: "0".into(), at: 0.0 });
                ticks.reverse();
                ticks
            }
            Spread::SignedRoot => {
                let limit = self.high;
                let apart = self.apart(most, round_numbers(&[1, 2, 5], limit * 1e-4, limit).rev());
                let upper = apart.into_iter().rev().filter(|tick| tick.at - 0.5 >= 1.0 / f64::from(most + 2));
                let mut ticks = vec![Tick { label: "0".into(), at: 0.5 }];
                for Tick { label, at } in upper {
                    ticks.insert(0, Tick { label: format!("{MINUS}{label}"), at: 1.0 - at });
                    ticks.push(Tick { label, at });
                }
                ticks
            }
        }
    }

    /// Ticks at multiples of a step: the smallest of 1, 2 or 5 times a power of ten that needs at most `most` steps.
    fn even_ticks(&self, most: u32) -> Vec<Tick> {
        let span = self.high - self.low;
        let exponent = exponent_of(span / f64::from(most));
        let (digit, exponent) = [(1, exponent), (2, exponent), (5, exponent), (1, exponent + 1)]
            .into_iter()
            // A span that is longer by a rounding error needs no coarser step.
            .find(|&(digit, exponent)| span <= f64::from(most) * read(digit, exponent) * (1.0 + 1e-9))
            .unwrap_or((2, exponent + 1));
        let step = read(digit, exponent);
        let (first, last) = ((self.low / step).ceil(), (self.high / step).floor());
        if !(first.abs().max(last.abs()) < 1e15) {
            // The span is only a few rounding errors of its ends: no rounder number lies between them.
            return [(self.low, 0.0), (self.high, 1.0)]
                .map(|(end, at)| Tick { label: label(end), at })
                .into();
        }
        // The quotients are rounded, so the multiples themselves are compared with the ends.
        let steps = (first as i64 - 1..=last as i64 + 1)
            .filter(|k| (self.low..=self.high).contains(&read(k * digit, exponent)));
        let largest = step * first.abs().max(last.abs());
        steps
            .map(|k| {
                let value = read(k * digit, exponent);
                let label = if value != 0.0 && is_plain(largest) {
                    let decimals = usize::try_from(-exponent).unwrap_or(0);
                    format!("{value:.decimals$}").replace('-', MINUS)
                } else {
                    label(value)
                };
                Tick { label, at: self.fraction(value) }
            })
            .collect()
    }

    /// Ticks at those of `values` that lie at least a `most`th of the scale from the last tick.
    fn apart(&self, most: u32, values: impl Iterator<Item = f64>) -> Vec<Tick> {
        let mut ticks: Vec<Tick> = Vec::new();
        for value in values {
            let at = self.fraction(value);
            if ticks.last().is_none_or(|last| (at - last.at).abs() >= 1.0 / f64::from(most)) {
                ticks.push(Tick { label: label(value), at });
            }
        }
        ticks
    }
}

/// Multiples of powers of ten by `digits` between two positive ends, ascending.
fn round_numbers(digits: &[i64], low: f64, high: f64) -> impl DoubleEndedIterator<Item = f64> {
    (exponent_of(low)..=exponent_of(high))
        .flat_map(|exponent| digits.iter().map(move |&digit| read(digit, exponent)))
        .filter(move |value| (low..=high).contains(value))
}

/// The typographic minus sign, as wide as a digit.
const MINUS: &str = "\u{2212}";

/// Whether a number of this absolute value is written without an exponent.
fn is_plain(size: f64) -> bool {
    (1e-3..1e6).contains(&size)
}

/// The shortest text that reads back as the same value.
fn label(value: f64) -> String {
    let text = if value == 0.0 || is_plain(value.abs()) { format!("{value}") } else { format!("{value:e}") };
    text.replace('-', MINUS)
}

/// Decimal exponent of a positive number, from its decimal digits: a logarithm would be rounded.
fn exponent_of(value: f64) -> i32 {
    format!("{value:e}").split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// `digits` times ten to the `exponent`, correctly rounded.
fn read(digits: i64, exponent: i32) -> f64 {
    format!("{digits}e{exponent}").parse().expect("digits and an exponent are a number")
}
