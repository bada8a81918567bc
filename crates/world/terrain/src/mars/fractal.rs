//! Fractal relief by stochastic interpolation: from posts far apart to posts close together, rough at every
//! scale.
//!
//! Fournier, Fussell and Carpenter (1982) halve the spacing repeatedly and displace each new post by a Gaussian.
//! Let a self-affine surface of Hurst exponent H have a height difference of `roughness` (rms, metres) at points
//! 1 m apart. Then the difference at points s apart is roughness s^H. Given both neighbours at distance s, the
//! middle post has the standard deviation roughness s^H sqrt(1 - 2^(2H - 2)).
//!
//! Old posts never move, so the surface meets every coarse post exactly. New posts start from the smooth curve
//! through the four nearest, with weights -1, 9, 9, -1 over 16 (Dyn, Levin and Gregory, 1987). The straight line
//! between two posts would leave the creases that plain midpoint displacement is known for.

use glam::DVec2;

use crate::HeightGrid;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Roughness of a self-affine surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Roughness {
    /// Hurst exponent H, above 0 and below 1. The nearer to 1, the smoother small scales are relative to large
    /// ones.
    pub hurst: f64,
    /// Root mean square difference of height between points 1 m apart, metres.
    pub rms_at_1_m: f64,
    /// Factor on the displacements of each halving of the spacing, the coarsest first; 1 for those not given.
    pub octave_gains: Vec<f64>,
}

impl Roughness {
    /// Standard deviation of the displacement of new posts `spacing` metres from their old neighbours, metres.
    fn displacement(&self, octave: usize, spacing: f64) -> f64 {
        let gain = self.octave_gains.get(octave).copied().unwrap_or(1.0);
        let left = 1.0 - libm::pow(2.0, 2.0 * self.hurst - 2.0);
        gain * self.rms_at_1_m * libm::pow(spacing, self.hurst) * left.sqrt()
    }
}

/// Four posts at the corners of a square, with heights by the same law: neighbours differ by roughness side^H
/// (rms).
pub(crate) fn corner_posts(side: f64, roughness: &Roughness, seed: u64) -> HeightGrid {
    let mut random = RandomStream::new(seed, StreamPurpose::Corners);
    let deviation = roughness.rms_at_1_m * libm::pow(side, roughness.hurst) * std::f64::consts::FRAC_1_SQRT_2;
    let heights = (0..4).map(|_| deviation * random.normal()).collect();
    HeightGrid { columns: 2, rows: 2, corner: DVec2::ZERO, spacing: DVec2::splat(side), heights }
}

/// Halves the spacing of `posts` `octaves` times. The old posts stay among the new ones, unchanged to the bit.
pub(crate) fn refine(posts: HeightGrid, octaves: u32, roughness: &Roughness, seed: u64) -> HeightGrid {
    let mut random = RandomStream::new(seed, StreamPurpose::Octaves);
    (0..octaves as usize).fold(posts, |posts, octave| refine_once(posts, octave, 1.0, roughness, &mut random))
}

/// Halves the spacing of `posts` once, as octave number `octave`, with displacements `gain` times as large.
pub(crate) fn refine_once(
    posts: HeightGrid,
    octave: usize,
    gain: f64,
    roughness: &Roughness,
    random: &mut RandomStream,
) -> HeightGrid {
    let mut posts = halve_spacing(posts);
    // CHOICE: a new post in the middle of a cell is sqrt(2) farther from its neighbours than one on a side. Both are
    // displaced alike, as in the paper of 1982.
    let spacing = (posts.spacing.x * posts.spacing.y).sqrt();
    let displacement = gain * roughness.displacement(octave, spacing);
    let columns = posts.columns as usize;
    for (row, heights) in posts.heights.chunks_exact_mut(columns).enumerate() {
        // In even rows every second post is an old one.
        let (first, step) = if row % 2 == 0 { (1, 2) } else { (0, 1) };
        for height in heights.iter_mut().skip(first).step_by(step) {
            *height += displacement * random.normal();
        }
    }
    posts
}

/// Grid with twice as many cells in each direction; new posts lie on the smooth curves through the old ones.
fn halve_spacing(posts: HeightGrid) -> HeightGrid {
    let (old_columns, old_rows) = (posts.columns as usize, posts.rows as usize);
    let (columns, rows) = (2 * old_columns - 1, 2 * old_rows - 1);
    let mut heights = vec![0.0; columns * rows];
    for (old, new) in posts.heights.chunks_exact(old_columns).zip(heights.chunks_exact_mut(2 * columns)) {
        interpolate_line(old_columns, |i| old[i], |i, height| new[i] = height);
    }
    // The last row is not followed by a row of new posts, so it is no whole chunk of two rows.
    let last = (old_rows - 1) * old_columns;
    let (old, new) = (&posts.heights[last..], &mut heights[(rows - 1) * columns..]);
    interpolate_line(old_columns, |i| old[i], |i, height| new[i] = height);
    for column in 0..columns {
        let old: Vec<f64> = (0..old_rows).map(|row| heights[2 * row * columns + column]).collect();
        interpolate_line(old_rows, |i| old[i], |i, height| heights[i * columns + column] = height);
    }
    HeightGrid {
        columns: columns as u32,
        rows: rows as u32,
        corner: posts.corner,
        spacing: posts.spacing * DVec2::splat(0.5),
        heights,
    }
}

/// Passes the `count` old posts of a line and the new posts between them to `new`.
fn interpolate_line(count: usize, old: impl Fn(usize) -> f64, mut new: impl FnMut(usize, f64)) {
    for i in 0..count {
        new(2 * i, old(i));
        if i + 1 == count {
            break;
        }
        let (b, c) = (old(i), old(i + 1));
        // Beyond the ends the line continues straight.
        let a = if i > 0 { old(i - 1) } else { 2.0 * b - c };
        let d = if i + 2 < count { old(i + 2) } else { 2.0 * c - b };
        new(2 * i + 1, 0.5625 * (b + c) - 0.0625 * (a + d));
    }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/fractal.rs"]
mod tests;
