//! Scales of pictures: where a value lies between two ends, and round numbers to label them with.

/// An interval of values, and how evenly colours are spread over it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    pub low: f64,
    pub high: f64,
    pub spread: Spread,
}

/// What has even steps on a scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// The value.
    Linear,
    /// One over the value, for ranges that begin near and end far: along a column of a camera's image of
    /// flat ground 1/range is nearly even, so that every colour gets as much of the image.
    Reciprocal,
    /// The square root of the size, with the sign, for differences of any size about zero: a hundredth of
    /// the largest is a tenth of the scale and can still be seen.
    SignedRoot,
    /// The square root, for sizes of differences from 0 on.
    Root,
}

/// A labelled place on a scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    pub label: String,
    /// 0 at the low end, 1 at the high end.
    pub at: f64,
}

impl Scale {
    /// Even steps of the value.
    pub fn linear(low: f64, high: f64) -> Self {
        Self { low, high, spread: Spread::Linear }
    }

    /// From the least to the greatest of the finite values, if there are any.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        values.into_iter().filter(|value| value.is_finite()).fold(None, |scale, value| {
            Some(match scale {
                None => Self::linear(value, value),
                Some(Self { low, high, .. }) => Self::linear(low.min(value), high.max(value)),
            })
        })
    }

    /// As [`Scale::of`], for ranges.
    pub fn of_ranges(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::of(values).map(|scale| {
            let deep = scale.low > 0.0 && scale.high >= 3.0 * scale.low;
            Self { spread: if deep { Spread::Reciprocal } else { Spread::Linear }, ..scale }
        })
    }

    /// Zero in the middle, and both ends as far from it as the farthest finite value.
    pub fn symmetric(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::of(values).map(|Self { low, high, .. }| {
            let limit = high.abs().max(low.abs());
            Self { low: -limit, high: limit, spread: Spread::SignedRoot }
        })
    }

    /// From zero to the largest finite value, for sizes of differences.
    pub fn from_zero(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::of(values).map(|Self { high, .. }| Self { low: 0.0, high, spread: Spread::Root })
    }

    /// Where a value lies: 0 at the low end, 1 at the high end, and the nearer end outside of both. On a
    /// scale of one value that is the middle.
    pub fn fraction(&self, value: f64) -> f64 {
        let even = |value: f64| match self.spread {
            Spread::Linear => value,
            Spread::Reciprocal => -1.0 / value,
            Spread::SignedRoot | Spread::Root => value.abs().sqrt().copysign(value),
        };
        let span = even(self.high) - even(self.low);
        if span > 0.0 { ((even(value) - even(self.low)) / span).clamp(0.0, 1.0) } else { 0.5 }
    }

    /// Round values in ascending order, at most `most + 1` of them.
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

    /// Multiples of the smallest of 1, 2, 5 times a power of ten that needs no more than `most` steps.
    fn even_ticks(&self, most: u32) -> Vec<Tick> {
        let span = self.high - self.low;
        let exponent = exponent_of(span / f64::from(most));
        let (digit, exponent) = [(1, exponent), (2, exponent), (5, exponent), (1, exponent + 1)]
            .into_iter()
            // A span that is a rounding longer needs no coarser steps.
            .find(|&(digit, exponent)| span <= f64::from(most) * read(digit, exponent) * (1.0 + 1e-9))
            .unwrap_or((2, exponent + 1));
        let step = read(digit, exponent);
        let (first, last) = ((self.low / step).ceil(), (self.high / step).floor());
        if !(first.abs().max(last.abs()) < 1e15) {
            // The span is no more than a few roundings of its ends: no rounder number is in between.
            return [(self.low, 0.0), (self.high, 1.0)]
                .map(|(end, at)| Tick { label: label(end), at })
                .into();
        }
        // The quotients are rounded; which multiples lie within is seen on the multiples themselves.
        let steps = (first as i64 - 1..=last as i64 + 1)
            .filter(|k| (self.low..=self.high).contains(&read(k * digit, exponent)));
        let largest = step * first.abs().max(last.abs());
        steps
            .map(|k| {
                let value = read(k * digit, exponent);
                let label = if value != 0.0 && plain(largest) {
                    let decimals = usize::try_from(-exponent).unwrap_or(0);
                    format!("{value:.decimals$}").replace('-', MINUS)
                } else {
                    label(value)
                };
                Tick { label, at: self.fraction(value) }
            })
            .collect()
    }

    /// Those of `values` that keep their distance from the last one kept.
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

/// These digits times powers of ten between two positive ends, ascending.
fn round_numbers(digits: &[i64], low: f64, high: f64) -> impl DoubleEndedIterator<Item = f64> {
    (exponent_of(low)..=exponent_of(high))
        .flat_map(|exponent| digits.iter().map(move |&digit| read(digit, exponent)))
        .filter(move |value| (low..=high).contains(value))
}

/// The typographic minus sign, as wide as a digit.
const MINUS: &str = "\u{2212}";

/// Whether numbers up to this size are written without an exponent.
fn plain(size: f64) -> bool {
    (1e-3..1e6).contains(&size)
}

/// A value in as few digits as tell it from all others.
fn label(value: f64) -> String {
    let text = if value == 0.0 || plain(value.abs()) { format!("{value}") } else { format!("{value:e}") };
    text.replace('-', MINUS)
}

/// The decimal exponent of a positive number, from its own decimal digits: no logarithm to round.
fn exponent_of(value: f64) -> i32 {
    format!("{value:e}").split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// `digits` times ten to the `exponent`, correctly rounded.
fn read(digits: i64, exponent: i32) -> f64 {
    format!("{digits}e{exponent}").parse().expect("digits and an exponent are a number")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, most: u32) -> Vec<String> {
        Scale::linear(low, high).ticks(most).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(labels(2.1, 19.8, 5), ["5", "10", "15"]);
        assert_eq!(labels(0.0, 1024.0, 6), ["0", "200", "400", "600", "800", "1000"]);
        assert_eq!(labels(3.43, 3.47, 4), ["3.43", "3.44", "3.45", "3.46", "3.47"]);
        assert_eq!(labels(-6.4e-14, 6.4e-14, 4), ["−5e−14", "0", "5e−14"]);
        assert_eq!(labels(-1.0, 1.0, 4), ["−1.0", "−0.5", "0", "0.5", "1.0"]);
    }

    #[test]
    fn ticks_lie_where_their_values_do() {
        let ticks = Scale::linear(-2.0, 6.0).ticks(4);
        let at: Vec<f64> = ticks.iter().map(|tick| tick.at).collect();
        assert_eq!(at, [0.0, 0.25, 0.5, 0.75, 1.0]);
    }

    #[test]
    fn deep_ranges_are_even_in_their_reciprocals() {
        let scale = Scale::of_ranges([2.0, 20.0]).unwrap();
        // 1/2 - 1/4 of 1/2 - 1/20: five ninths.
        assert!((scale.fraction(4.0) - 5.0 / 9.0).abs() < 1e-15);
        let labels: Vec<String> = scale.ticks(6).into_iter().map(|tick| tick.label).collect();
        assert_eq!(labels, ["2", "3", "5", "10"]);
        assert_eq!(Scale::of_ranges([2.0, 4.0]), Some(Scale::linear(2.0, 4.0)));
    }

    #[test]
    fn differences_are_even_in_their_roots() {
        let scale = Scale::symmetric([6.4e-14]).unwrap();
        assert_eq!(scale.fraction(0.0), 0.5);
        assert!((scale.fraction(-1.6e-14) - 0.25).abs() < 1e-15);
        let ticks = scale.ticks(5);
        let labels: Vec<&str> = ticks.iter().map(|tick| tick.label.as_str()).collect();
        assert_eq!(labels, ["−5e−14", "−1e−14", "0", "1e−14", "5e−14"]);
        assert!(ticks.is_sorted_by(|a, b| a.at < b.at));
    }

    #[test]
    fn sizes_of_differences_begin_at_zero() {
        let scale = Scale::from_zero([1e-3, 4e-3, f64::INFINITY]).unwrap();
        assert_eq!((scale.low, scale.high), (0.0, 4e-3));
        // A quarter of the largest is half way.
        assert_eq!((scale.fraction(0.0), scale.fraction(1e-3), scale.fraction(4e-3)), (0.0, 0.5, 1.0));
        let ticks = scale.ticks(5);
        assert_eq!(ticks[0], Tick { label: "0".into(), at: 0.0 });
        assert!(ticks.len() >= 3 && ticks.is_sorted_by(|a, b| a.at < b.at), "{ticks:?}");
    }

    #[test]
    fn no_span_has_one_tick_in_the_middle() {
        assert_eq!(Scale::linear(3.0, 3.0).ticks(5), [Tick { label: "3".into(), at: 0.5 }]);
        assert_eq!(Scale::linear(3.0, 3.0).fraction(3.0), 0.5);
    }

    #[test]
    fn a_span_of_one_rounding_is_labelled_by_its_ends() {
        assert_eq!(labels(1.0, 1.0 + f64::EPSILON, 5), ["1", "1.0000000000000002"]);
    }

    #[test]
    fn ticks_stay_few_for_any_span() {
        for exponent in -300..300 {
            let unit = read(1, exponent);
            for digits in [1.0, 1.9, 2.0, 4.3, 9.99] {
                let ticks = Scale::linear(-unit * digits, unit * digits).ticks(6);
                assert!((3..=7).contains(&ticks.len()), "{ticks:?}");
                assert!(ticks.iter().any(|tick| tick.label == "0" && tick.at == 0.5));
            }
        }
    }

    #[test]
    fn what_is_not_finite_has_no_place() {
        assert_eq!(Scale::of([f64::NAN, f64::INFINITY]), None);
        assert_eq!(Scale::of([2.0, f64::INFINITY, 1.0]), Some(Scale::linear(1.0, 2.0)));
        let symmetric = Scale { low: -3.0, high: 3.0, spread: Spread::SignedRoot };
        assert_eq!(Scale::symmetric([1.0, -3.0]), Some(symmetric));
    }
}
