//! Corners in f32 for which a quantity has a wanted value, far closer than the distance of two numbers of f32.
//!
//! The corners of a face lie on a lattice of some 1e-7 m. A quantity of the face, such as how far its plane is along a ray, is
//! nearly linear in the nine coordinates, and its slopes have no common measure: moving several coordinates by whole steps
//! gives values that lie as close to one another as one likes. So the wanted value is searched among many such moves.

use glam::DVec3;

use crate::bench::faces::Triangle;

/// Steps by which each of three coordinates moves to either side, for a wanted value down to so many times the change of a step.
/// Two corners have (2 k + 1)^6 moves in a range of some 6 k steps; tuned, so that thirty of them and more are near enough.
const REACHES: [(f64, i32); 3] = [(0.1, 2), (1e-3, 5), (0.0, 9)];

/// Of the second corner's moves those that are evaluated with each of the first's: so many to either side of the one that is best
/// by the slopes. Slopes change over a move, by a part in a thousand or so, so that the best pair is not the one which they tell.
const BESIDE: usize = 3;

/// Share of the wanted value by which the one that is found may differ. The decade counts, not the digit.
const MAX_MISS: f64 = 0.25;

/// A triangle whose corners are numbers of f32, near a given one, for which `quantity` is `wanted`. The corners `first` and `second`
/// move. `None`: no such triangle was found.
pub(super) fn tuned(
    triangle: Triangle,
    [first, second]: [usize; 2],
    wanted: f64,
    quantity: impl Fn(&Triangle) -> f64,
) -> Option<Triangle> {
    let mut at = triangle.map(|corner| corner.as_vec3().as_dvec3());
    let largest = at.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    // The distance of neighbours in f32 at the largest coordinate: whole steps of it stay numbers of f32.
    let step = f64::from((largest as f32).next_up()) - f64::from(largest as f32);
    let on_lattice = |x: f64| (x / step).round() * step;
    at = at.map(|corner| DVec3::new(on_lattice(corner.x), on_lattice(corner.y), on_lattice(corner.z)));
    let moved = |from: &Triangle, corner: usize, by: [i32; 3]| {
        let mut to = *from;
        to[corner] += DVec3::from_array(by.map(f64::from)) * step;
        to
    };
    // Newton's steps along the steepest coordinate, until less than a step is missing.
    for _ in 0..8 {
        let here = quantity(&at);
        let slopes = axes().map(|axis| (quantity(&moved(&at, first, axis)) - here, axis));
        let (slope, axis) = slopes.into_iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
        let steps = ((wanted - here) / slope).round();
        // Tuned: more than that is another place.
        if !(steps.abs() < 1e6) {
            return None;
        }
        at = moved(&at, first, axis.map(|part| part * steps as i32));
    }
    let here = quantity(&at);
    let slopes = axes().map(|axis| (quantity(&moved(&at, first, axis)) - here).abs());
    let slope = slopes.into_iter().fold(0.0, f64::max);
    let reach =
        REACHES.iter().find(|(least, _)| wanted.abs() >= *least * slope).map_or(0, |(_, reach)| *reach);
    let moves = |corner: usize| {
        let slopes = axes().map(|axis| quantity(&moved(&at, corner, axis)) - here);
        let range = -reach..=reach;
        let mut all = Vec::new();
        for x in range.clone() {
            for y in range.clone() {
                for z in range.clone() {
                    let by = [x, y, z];
                    let gain: f64 = (0..3).map(|k| f64::from(by[k]) * slopes[k]).sum();
                    all.push((gain, by));
                }
            }
        }
        all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        all
    };
    let (of_first, of_second) = (moves(first), moves(second));
    let miss = |triangle: &Triangle| (quantity(triangle) - wanted).abs();
    let mut best = (miss(&at), at);
    for (gain, by) in &of_first {
        let from = moved(&at, first, *by);
        let place = of_second.partition_point(|(other, _)| *other < wanted - here - gain);
        let near = place.saturating_sub(BESIDE)..(place + BESIDE).min(of_second.len());
        for (_, and) in &of_second[near] {
            let tried = moved(&from, second, *and);
            if miss(&tried) < best.0 {
                best = (miss(&tried), tried);
            }
        }
    }
    let best = best.1;
    (miss(&best) <= MAX_MISS * wanted.abs()).then_some(best)
}

fn axes() -> [[i32; 3]; 3] {
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
}
