//! Numbers of returns: the rules by which simulators count them, and points that have other numbers than their returns.

use raypencil_mesh_io::CloudColumn;

use super::assign::Assigned;
use super::beams::Beams;

/// A rule by which the returns of a beam are counted.
pub(super) struct NumberRule {
    /// What is wrong with it, in words.
    pub(super) words: &'static str,
    /// The number of one of the returns that are told: by the numbers of these, which one it is, and how many the beam has.
    number: fn(told: &[u32], at: usize, returns: u32) -> u32,
}

/// The rules that are tried. Where they give the same numbers, the first one is told.
pub(super) const NUMBER_RULES: [NumberRule; 4] = [
    NumberRule {
        words: "the numbers of returns count from the farthest: the nearest is 1",
        number: |told, at, returns| returns + 1 - told[at],
    },
    NumberRule {
        words: "the numbers of returns count from 0: the nearest is 1",
        number: |told, at, _| told[at] - 1,
    },
    NumberRule {
        words: "the numbers count the returns that are told: they count all of the footprint",
        number: |_, at, _| at as u32 + 1,
    },
    NumberRule {
        words: "the numbers of the told returns of a beam are exchanged: the nearest has the least",
        number: |told, at, _| told[told.len() - 1 - at],
    },
];

impl NumberRule {
    /// The numbers of all places by this rule; NaN for a place without a return.
    pub(super) fn numbers(&self, beams: &Beams) -> Vec<f64> {
        let places = beams.numbers().chunks(beams.places());
        let of_beam = |(beam, numbers): (usize, &[u32])| {
            let told: Vec<u32> = numbers.iter().copied().filter(|&number| number != 0).collect();
            let number = |at: usize| (self.number)(&told, at, beams.returns_of(beam));
            let at_place = |at: usize| if at < told.len() { f64::from(number(at)) } else { f64::NAN };
            (0..numbers.len()).map(at_place).collect::<Vec<_>>()
        };
        places.enumerate().flat_map(of_beam).collect()
    }
}

/// How many points have a number of a return that is known of their ray, the rays of which it is another, and what explains all of these.
pub(super) fn wrong_numbers(
    found: &Assigned,
    beams: &Beams,
    (column, is_point): (&CloudColumn, &[bool]),
) -> (usize, Vec<usize>, Option<String>) {
    // 0: a place of no return.
    let told = beams.numbers().iter().zip(&found.point_of).enumerate();
    let pairs = told.filter_map(|(ray, (&number, point))| {
        let point = point.filter(|&point| is_point[point] && number != 0)?;
        Some((ray, column.values[point], f64::from(number)))
    });
    let pairs: Vec<(usize, f64, f64)> = pairs.collect();
    let wrong: Vec<usize> =
        pairs.iter().filter(|(_, stated, right)| stated != right).map(|(ray, ..)| *ray).collect();
    let is_one = |first: f64| pairs.len() > 1 && pairs.iter().all(|(_, stated, _)| *stated == first);
    let explains = |rule: &&NumberRule| {
        let numbers = rule.numbers(beams);
        pairs.iter().all(|(ray, stated, _)| *stated == numbers[*ray])
    };
    let why = match pairs.first() {
        None => None,
        Some(_) if wrong.is_empty() => None,
        Some(&(_, first, _)) if is_one(first) => Some(format!(
            "all points have the number of return {first}: it counts the returns of a footprint, the nearest is 1"
        )),
        Some(_) => NUMBER_RULES.iter().find(explains).map(|rule| rule.words.to_string()),
    };
    (pairs.len(), wrong, why)
}
