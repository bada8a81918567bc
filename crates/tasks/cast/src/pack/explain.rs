//! Which mistake explains why a candidate is wrong: each is undone and judged again, one by one and two by two.

use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Precision, Sides, Triangles};

use super::mistakes::{
    ABOUT_SENSORS, Group, Mistake, Named, OF_ARGUMENTS, OF_ARRAYS, OF_MISSES, OF_NUMBERS, OF_RULES, OF_UNITS,
    OfArrays, OfCloud, PRECISION,
};
use super::trial::Trial;
use crate::comparison::Stated;

/// Rays on which mistakes are tried, at most.
const MAX_TRIED: usize = 2000;

/// What explains why a candidate is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// The mistake, or the two, in words.
    pub mistakes: Vec<String>,
    /// Rays that are not wrong once it is undone, of those that were tried.
    pub agree: usize,
    /// Rays that were tried.
    pub tried: usize,
}

impl Explanation {
    /// One sentence.
    pub fn sentence(&self) -> String {
        let share = 100.0 * self.agree as f64 / self.tried as f64;
        format!("{share:.4} % agree if {}", self.mistakes.join(", and "))
    }
}

/// Looks for the mistake, or the two, without which hardly any ray is wrong. `wrong` are the indices of wrong
/// rays.
pub(super) fn explain(
    exact: &ExactCast<'_>,
    mesh: &Triangles,
    (rays, sides): (&[CastRay], Sides),
    (stated, of_cloud): (&Stated, Option<&OfCloud<'_>>),
    OfArrays { numbers, orders, alone }: &OfArrays<'_>,
    precision: Precision,
    wrong: &[usize],
) -> Option<Explanation> {
    // Wrong rays, and as many others: what is undone must not make these wrong.
    let mut indices: Vec<usize> = sample(wrong.len()).map(|k| wrong[k]).chain(sample(rays.len())).collect();
    indices.sort_unstable();
    indices.dedup();
    // Wrong rays first: a mistake that does not explain them is given up after a few.
    indices.sort_by_key(|index| wrong.binary_search(index).is_err());
    let trial_of = |indices: Vec<usize>| Trial {
        rays: indices.iter().map(|&index| rays[index]).collect(),
        sides,
        stated: stated.some_of(&indices),
        precision,
        allowance: 0.0,
        cloud: of_cloud.map(|of_cloud| of_cloud.part.some_of(&indices)),
        indices,
    };
    let trial = trial_of(indices);
    // What explains the sample has to explain all: a few right rays may say otherwise.
    let explains_all = |mistakes: &[&Named<'_>]| {
        let all = || trial_of((0..rays.len()).collect());
        let without = |trial: Trial, mistake: &&Named<'_>| trial.without(mistake.undo);
        trial.indices.len() == rays.len()
            || mistakes
                .iter()
                .try_fold(all(), without)
                .is_some_and(|trial| trial.wrong(exact, mesh, wrong.len() / 100).is_some())
    };
    let before = trial.wrong(exact, mesh, usize::MAX)?;
    // An explanation leaves at most one in a hundred of them wrong.
    let most = before / 100;
    let tried = trial.indices.len();
    let explanation =
        |mistakes: Vec<String>, left: usize| Explanation { mistakes, agree: tried - left, tried };
    let about_sensors: &[Mistake] = if trial.is_about_sensors() { ABOUT_SENSORS } else { &[] };
    // The points of a cloud are no arrays: their conventions are its own.
    let lists: &[(&[Mistake], Group)] = match of_cloud {
        None => &[
            (OF_NUMBERS, Group::Numbers),
            (OF_UNITS, Group::Factors),
            (OF_ARRAYS, Group::Others),
            (OF_RULES, Group::Others),
            (OF_ARGUMENTS, Group::Others),
            (OF_MISSES, Group::Others),
        ],
        Some(of_cloud) if !of_cloud.has_ends => &[],
        Some(_) => &[(OF_RULES, Group::Others)],
    };
    let lists = lists.iter().copied().chain([(about_sensors, Group::Others)]);
    let extras = of_cloud.iter().flat_map(|of_cloud| &of_cloud.extras).map(Named::extra);
    let of_lists = lists.flat_map(|(list, group)| list.iter().map(move |mistake| Named::of(mistake, group)));
    let mistakes: Vec<Named<'_>> = extras.chain(of_lists).collect();
    let estimated_of = |trial: &Trial| match of_cloud {
        Some(of_cloud) => (of_cloud.estimated)(trial),
        None => numbers(trial),
    };
    let estimated = estimated_of(&trial);
    let precision = Named::of(&PRECISION, Group::Others);
    let left_without = |mistake: &Named<'_>| trial.without(mistake.undo)?.wrong(exact, mesh, most);
    let common = mistakes.iter().copied();
    let all: Vec<Named<'_>> =
        common.chain(estimated.iter().chain(*orders).chain(*alone).map(Named::extra)).collect();
    let single = all.iter().filter_map(|mistake| Some((left_without(mistake)?, *mistake)));
    let mut singles: Vec<(usize, Named<'_>)> = single.collect();
    // All rays are asked of the best one first: mostly it holds, and no other is asked.
    singles.sort_by_key(|(left, _)| *left);
    if let Some((left, mistake)) = singles.into_iter().find(|(_, mistake)| explains_all(&[mistake])) {
        return Some(explanation(vec![mistake.words.to_string()], left));
    }
    // Single precision excuses much: it comes after all others.
    let left_single = left_without(&precision);
    if let Some(left) = left_single
        && trial.looks_single(exact, before)
        && explains_all(&[&precision])
    {
        return Some(explanation(vec![precision.words.to_string()], left));
    }
    // Both of a pair change something: else the pair is a single mistake.
    let mut best: Option<(Vec<String>, usize)> = None;
    let firsts = mistakes.iter().enumerate().filter(|(_, first)| first.is_common);
    let firsts = firsts.map(|(k, first)| (k + 1, *first));
    for (beyond, first) in firsts.chain(orders.iter().map(|order| (0, Named::extra(order)))) {
        let Some(once) = trial.without(first.undo) else { continue };
        let estimated = estimated_of(&once);
        let others = mistakes.iter().skip(beyond).filter(|second| second.is_common);
        let others = others.copied().chain(estimated.iter().map(Named::extra));
        for second in others.filter(|second| first.pairs_with(second)) {
            let most = match best {
                Some((_, 0)) => return best.map(|(mistakes, left)| explanation(mistakes, left)),
                Some((_, kept)) => kept - 1,
                None => most,
            };
            if let Some(left) = once.without(second.undo).and_then(|twice| twice.wrong(exact, mesh, most))
                && explains_all(&[&first, &second])
            {
                best = Some((vec![first.words.to_string(), second.words.to_string()], left));
            }
        }
    }
    if let Some((mistakes, left)) = best {
        return Some(explanation(mistakes, left));
    }
    // What single precision excuses alone, without looking like it, is none of two.
    let mut firsts = all.iter().filter(|_| left_single.is_none());
    firsts.find_map(|first| {
        let once = trial.without(first.undo)?;
        let left = once.without(precision.undo)?.wrong(exact, mesh, most)?;
        let is_told = once.looks_single(exact, before) && explains_all(&[first, &precision]);
        is_told.then(|| explanation(vec![first.words.to_string(), precision.words.to_string()], left))
    })
}

/// Half of [`MAX_TRIED`] of so many, or all: one of each of as many equal parts. Which one is drawn, for parts of the length of a
/// firing sequence would have the same channel each.
fn sample(all: usize) -> impl Iterator<Item = usize> {
    let every = all.div_ceil(MAX_TRIED / 2).max(1);
    (0..all).step_by(every).map(move |start| {
        let drawn = split_mix(start as u64) % every as u64;
        (start + drawn as usize).min(all - 1)
    })
}

/// The first number of the generator with this seed. (S. Vigna, splitmix64.c)
fn split_mix(seed: u64) -> u64 {
    let mut mixed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}
