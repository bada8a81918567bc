//! Which answers of a pack are compared with the referee's. Anyone can change an answer and write all digests anew.

use std::collections::BTreeSet;
use std::hash::{BuildHasher as _, Hasher as _, RandomState};

use raypencil_scene::{Place, Scene, SensorId};

use crate::split_mix::SplitMix64;

/// Which answers of a pack are compared with the referee's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verification {
    /// All.
    All,
    /// All of a pack of at most [`MAX_ALL`] answers. Of a larger one, [`DRAWN`] that are drawn by this seed, or by another one each
    /// time: who changes answers does not know which.
    Drawn {
        /// The seed; `None`: another one each time.
        seed: Option<u64>,
    },
}

impl Verification {
    /// Whether of so many answers only some are compared, which are drawn.
    pub(crate) fn draws_of(self, answers: u64) -> bool {
        matches!(self, Self::Drawn { .. }) && answers > MAX_ALL
    }
}

/// Most answers that are all compared unasked. Tuned: some 2 s on two cores.
pub const MAX_ALL: u64 = 50_000;

/// Answers that are drawn of a larger pack. Of a pack in which one answer in a thousand is changed, they miss all of these with
/// probability 0.999^6905, below 1/1000; without putting any back, with less.
pub const DRAWN: u64 = 6_905;

/// A seed that nobody knows before, which JSON holds without rounding.
pub(crate) fn seed_anew() -> u64 {
    RandomState::new().build_hasher().finish() >> 11
}

/// So many different numbers below `of`, each set of them with the same probability. (R. Floyd; J. Bentley, "Programming
/// Pearls: a sample of brilliance", 1987)
pub(crate) fn drawn(count: u64, of: u64, seed: u64) -> BTreeSet<u64> {
    let mut numbers = SplitMix64::new(seed);
    let mut chosen = BTreeSet::new();
    for last in of.saturating_sub(count)..of {
        let number = below(&mut numbers, last + 1);
        if !chosen.insert(number) {
            chosen.insert(last);
        }
    }
    chosen
}

/// A number below `of`; the high half of a product, whose bias is below 2^-40 for all packs that there can be.
fn below(numbers: &mut SplitMix64, of: u64) -> u64 {
    ((u128::from(numbers.next_u64()) * u128::from(of)) >> 64) as u64
}

/// The drawn places of a scene, by sensor.
pub(crate) fn drawn_places(scene: &Scene, count: u64, seed: u64) -> Vec<(SensorId, Vec<Place>)> {
    let sizes = scene.sensors().filter_map(|sensor| Some((sensor, scene.size(sensor)?)));
    let sizes: Vec<(SensorId, (u32, u32))> = sizes.collect();
    let of = sizes.iter().map(|(_, (width, height))| u64::from(*width) * u64::from(*height)).sum();
    let chosen = drawn(count, of, seed);
    let mut first = 0;
    let places = sizes.into_iter().map(|(sensor, (width, height))| {
        let (start, end) = (first, first + u64::from(width) * u64::from(height));
        first = end;
        let place = |number: &u64| {
            let cell = number - start;
            let (i, j) = ((cell % u64::from(width)) as u32, (cell / u64::from(width)) as u32);
            Place { sensor, i, j }
        };
        (sensor, chosen.range(start..end).map(place).collect())
    });
    places.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_are_drawn_as_find_one_forged_answer_in_a_thousand() {
        let missed = |count: u64| (0..count).fold(1.0, |product, _| product * 0.999);
        assert!(missed(DRAWN) < 1e-3 && missed(DRAWN - 2) > 1e-3);
    }

    #[test]
    fn answers_are_drawn_of_larger_packs_alone_and_where_not_all_are_asked_for() {
        let drawn = Verification::Drawn { seed: None };
        assert_eq!([MAX_ALL, MAX_ALL + 1].map(|answers| drawn.draws_of(answers)), [false, true]);
        assert!(!Verification::All.draws_of(MAX_ALL + 1));
    }

    #[test]
    fn each_number_is_drawn_as_often_as_any_other() {
        let mut counts = [0_u32; 10];
        for seed in 0..3000 {
            let chosen = drawn(3, 10, seed);
            assert_eq!(chosen.len(), 3);
            chosen.iter().for_each(|number| counts[*number as usize] += 1);
        }
        // 900 each; the standard deviation is 25.
        assert!(counts.iter().all(|count| (800..1000).contains(count)), "{counts:?}");
        assert_eq!(drawn(10, 3, 7), (0..3).collect());
        assert_eq!(drawn(5, 1 << 40, 1), drawn(5, 1 << 40, 1));
        assert_ne!(drawn(5, 1 << 40, 1), drawn(5, 1 << 40, 2));
        assert_ne!(seed_anew(), seed_anew());
    }

    #[test]
    fn places_are_those_of_all_sensors() {
        let scene = crate::blind_scene(7).expect("a scene");
        let of: u64 =
            scene.sensors().filter_map(|one| scene.size(one)).map(|(w, h)| u64::from(w) * u64::from(h)).sum();
        let all = drawn_places(&scene, of, 1);
        for (sensor, places) in &all {
            let (width, height) = scene.size(*sensor).expect("a sensor");
            let expected = (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
            assert!(places.iter().map(|place| (place.i, place.j)).eq(expected));
        }
        assert_eq!(all.len(), scene.sensors().count());
    }
}
