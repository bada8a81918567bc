//! Heights of the soil at every place: posts of the whole ground, and closer posts near its middle.
//!
//! Level 0 has the posts of the ground. Level 1 halves their spacing within [`MIDDLE_RADII`] fine radii of the
//! middle, and level 2 halves it again within one fine radius. A level contains the posts of the level before,
//! at the same heights.

use glam::DVec2;

use super::craters::Crater;
use super::fractal::{self, Roughness};
use crate::HeightGrid;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Radius of level 1, in fine radii.
const MIDDLE_RADII: f64 = 2.5;

/// Factor on the displacement of the posts of levels 1 and 2. CHOICE: soil is smoother below the spacing of the
/// posts than the self-affine law has it, since its grains settle; the curve through the posts shapes it.
const FINE_GAIN: f64 = 0.25;

/// Posts that a fine level has beyond its radius on each side: the curve through four posts needs them.
const MARGIN_POSTS: f64 = 4.0;

/// Number of levels; the finest cells have 2^(LEVELS - 1) to a side of a cell of level 0.
pub(super) const LEVELS: usize = 3;

/// Radii of levels 1 and 2 about the middle of the ground, metres, for that fine radius.
pub(super) fn radii(fine_radius: f64) -> [f64; LEVELS - 1] {
    [MIDDLE_RADII * fine_radius, fine_radius]
}

/// Heights at every place of a ground.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Relief {
    /// Posts of the whole ground.
    pub posts: HeightGrid,
    /// Posts of levels 1 and 2; none if the fine radius is 0.
    fine: Vec<FineLevel>,
    /// Middle of the ground, global x and y, metres.
    pub middle: DVec2,
}

/// Posts of a part of the ground.
#[derive(Debug, Clone, PartialEq)]
struct FineLevel {
    posts: HeightGrid,
    /// Cells of level 0 within this distance of the middle have this level or a finer one, metres.
    radius: f64,
    /// Column and row of the first post, counted in posts of this level from the corner of the ground.
    first: [u32; 2],
}

impl Relief {
    /// Adds the fine levels to the posts of a ground, then carves the craters, the oldest first.
    pub(super) fn new(
        posts: HeightGrid,
        fine_radius: f64,
        roughness: &Roughness,
        octaves: u32,
        craters: &[Crater],
        seed: u64,
    ) -> Self {
        let middle = posts.corner + 0.5 * posts.extent();
        let mut relief = Self { posts, fine: Vec::new(), middle };
        let mut random = RandomStream::new(seed, StreamPurpose::FineOctaves);
        if fine_radius > 0.0 {
            for (level, radius) in radii(fine_radius).into_iter().enumerate() {
                let (before, first) = match relief.fine.last() {
                    None => (&relief.posts, [0; 2]),
                    Some(level) => (&level.posts, level.first),
                };
                let (part, skipped) = around(before, middle, radius);
                let octave = octaves as usize + level;
                let posts = fractal::refine_once(part, octave, FINE_GAIN, roughness, &mut random);
                let first = [0, 1].map(|axis| 2 * (first[axis] + skipped[axis]));
                relief.fine.push(FineLevel { posts, radius, first });
            }
        }
        let mut by_age: Vec<&Crater> = craters.iter().collect();
        // The most degraded is the oldest.
        by_age.sort_by(|a, b| b.degradation.total_cmp(&a.degradation));
        for crater in by_age {
            let plane = crater.plane(&relief.posts);
            crater.carve(&mut relief.posts, plane);
            for level in &mut relief.fine {
                crater.carve(&mut level.posts, plane);
            }
        }
        relief
    }

    /// Level of the cell of level 0 whose near left post is this one.
    pub(super) fn level(&self, [column, row]: [u32; 2]) -> usize {
        let centre = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
        let distance = (self.posts.corner + self.posts.spacing * centre).distance(self.middle);
        self.fine.iter().take_while(|level| distance < level.radius).count()
    }

    /// First post and number of posts along x and y of the part of the ground that has fine levels, counted in posts
    /// of the finest level from the corner of the ground.
    pub(super) fn fine_window(&self) -> [[u32; 2]; 2] {
        match self.fine.first() {
            None => [[0; 2]; 2],
            // Level 1 has twice its spacing.
            Some(FineLevel { posts, first, .. }) => {
                [first.map(|index| 2 * index), [2 * posts.columns - 1, 2 * posts.rows - 1]]
            }
        }
    }

    /// Position of a post of the finest level, counted from the corner of the ground. Its height is that of the
    /// coarsest level that has the post.
    ///
    /// # Panics
    /// If no level has the post.
    pub(super) fn at(&self, fine: [u32; 2]) -> glam::DVec3 {
        let step = 1_u32 << (LEVELS - 1);
        if fine.iter().all(|index| index.is_multiple_of(step)) {
            return self.posts.at(fine[0] / step, fine[1] / step);
        }
        let level = if fine.iter().all(|index| index.is_multiple_of(2)) { 0 } else { 1 };
        let FineLevel { posts, first, .. } = &self.fine[level];
        let step = if level == 0 { 2 } else { 1 };
        let [column, row] = [0, 1].map(|axis| fine[axis] / step - first[axis]);
        posts.at(column, row)
    }

    /// Height at a place, global x and y, metres: bilinear between the four posts around it, of the finest level
    /// there. Outside the ground it is the height at the nearest border.
    pub(super) fn height(&self, place: DVec2) -> f64 {
        let distance = place.distance(self.middle);
        let level = self.fine.iter().rev().find(|level| distance < level.radius);
        level.map_or(&self.posts, |level| &level.posts).bilinear(place)
    }
}

/// The posts of a grid within `radius` of a place, and [`MARGIN_POSTS`] more on each side; with the column and row of
/// the first of them.
fn around(posts: &HeightGrid, middle: DVec2, radius: f64) -> (HeightGrid, [u32; 2]) {
    let reach = DVec2::splat(radius) + MARGIN_POSTS * posts.spacing;
    let clamped = |place: DVec2, round: fn(f64) -> f64| {
        let index = (place - posts.corner) / posts.spacing;
        [(index.x, posts.columns), (index.y, posts.rows)]
            .map(|(index, count)| round(index).clamp(0.0, f64::from(count - 1)) as u32)
    };
    let [low, high] = [clamped(middle - reach, f64::floor), clamped(middle + reach, f64::ceil)];
    let heights = (low[1]..=high[1])
        .flat_map(|row| (low[0]..=high[0]).map(move |column| posts.height(column, row)))
        .collect();
    let first = DVec2::new(f64::from(low[0]), f64::from(low[1]));
    let part = HeightGrid {
        columns: high[0] - low[0] + 1,
        rows: high[1] - low[1] + 1,
        corner: posts.corner + posts.spacing * first,
        spacing: posts.spacing,
        heights,
    };
    (part, low)
}

#[cfg(test)]
#[path = "../../tests/unit/mars/relief.rs"]
mod tests;
