//! Crevasses: winding cracks with walls of their own, which may overhang.
//!
//! A height field has no walls: it can only be steep. So the grid itself gives way. Its rows near a crack are bent
//! along the crack's course, and at the crack one row becomes several: the near edge, down the near wall, across the floor,
//! up the far wall, the far edge. The surface stays one sheet without a gap.

use std::ops::Range;

use glam::DVec2;

use crate::random_stream::{RandomStream, StreamPurpose};

/// Which crevasses there are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crevasses {
    /// How many, side by side along x.
    pub count: u32,
    /// From edge to edge at the widest place, metres.
    pub width: f64,
    /// From the lower edge to the floor at the deepest place, metres.
    pub depth: f64,
    /// How far walls go back under their edge at most, metres; 0 for none.
    pub overhang: f64,
}

/// How far rows are bent at most, metres: crevasses wind by twice this.
const MAX_BEND_M: f64 = 2.5;

/// Rows are pressed together to no less than a third: the bend's steepest slope is 1.54 times its height over its width, and
/// this much more than that.
const BEND_SLACK: f64 = 1.5;

/// Steepest slope of (1 - t^2)^2, at t = 1/sqrt 3: 8 / (3 sqrt 3).
const MAX_BUMP_SLOPE: f64 = 1.539_600_717_839_002;

impl Crevasses {
    /// Extent along y of the band of rows that each crevasse bends, metres.
    fn band(&self, extent: f64) -> f64 {
        // An even number of bands, so that the middle of the ground lies between two of them.
        extent / f64::from(self.count.next_multiple_of(2).max(2))
    }

    /// The widest that they can be on a ground of that extent along y, metres: it leaves as much for them to wind.
    pub(super) fn max_width(&self, extent: f64) -> f64 {
        self.band(extent) / (2.0 * BEND_SLACK * MAX_BUMP_SLOPE)
    }

    /// The crevasses on a grid of that many cells along x and y, of that spacing, about the origin.
    pub(super) fn draw(&self, [cells, rows]: [u32; 2], spacing: DVec2, seed: u64) -> Vec<Crevasse> {
        let mut random = RandomStream::new(seed, StreamPurpose::Crevasses);
        let [extent, height] = [f64::from(cells) * spacing.x, f64::from(rows) * spacing.y];
        let band = self.band(height);
        let bend = MAX_BEND_M.min(0.5 * band / (BEND_SLACK * MAX_BUMP_SLOPE) - 0.5 * self.width).max(0.0);
        let course = |random: &mut RandomStream| {
            // Three waves, the shorter the lower, no higher than the bend together.
            [(0.55, 20.0), (0.3, 8.0), (0.15, 3.5)].map(|(share, length)| Wave {
                amplitude: bend * share,
                wave_number: std::f64::consts::TAU / (length * random.between(0.8, 1.25)),
                phase: random.between(0.0, std::f64::consts::TAU),
            })
        };
        let middle_row = |slot: u32| (((f64::from(slot) + 0.5) * band / spacing.y) as u32).clamp(1, rows - 1);
        let one = |slot: u32| {
            let course = course(&mut random);
            let margin = f64::from(cells);
            let first = (margin * random.between(0.03, 0.2)) as u32;
            let last = cells - (margin * random.between(0.03, 0.2)) as u32;
            let row = middle_row(slot);
            let level = f64::from(row) * spacing.y - 0.5 * height;
            let edge_shares =
                (0..=cells).map(|_| [random.between(0.75, 1.0), random.between(0.75, 1.0)]).collect();
            let start = f64::from(first) * spacing.x - 0.5 * extent;
            let end = f64::from(last) * spacing.x - 0.5 * extent;
            Crevasse {
                settings: *self,
                row,
                level,
                columns: first..last,
                span: [start, end],
                half_band: 0.5 * band,
                course,
                edge_shares,
            }
        };
        (0..self.count).map(one).collect()
    }
}

/// One crevasse on a grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Crevasse {
    settings: Crevasses,
    /// The grid's row that it opens.
    pub row: u32,
    /// y of that row before it is bent.
    level: f64,
    /// It begins after the first of these columns and ends before the last; at both it is closed.
    pub columns: Range<u32>,
    span: [f64; 2],
    half_band: f64,
    course: [Wave; 3],
    /// For each column, how much of its half width the near and the far edge take: edges are ragged.
    edge_shares: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Wave {
    amplitude: f64,
    wave_number: f64,
    phase: f64,
}

impl Crevasse {
    /// How far rows are bent at that x, metres.
    fn bend(&self, x: f64) -> f64 {
        self.course.iter().map(|wave| wave.amplitude * libm::sin(wave.wave_number * x + wave.phase)).sum()
    }

    /// 1 along most of it, 0 at its ends and beyond.
    fn taper(&self, x: f64) -> f64 {
        let [start, end] = self.span;
        let t = (2.0 * x - start - end) / (end - start);
        (1.0 - t * t * t * t).max(0.0)
    }

    /// How far the y of a grid point (x, y) moves. Points of the crevasse's own row do not open here.
    pub(super) fn shift(&self, x: f64, y: f64) -> f64 {
        let t = (y - self.level) / self.half_band;
        let share = 1.0 - t * t;
        if share <= 0.0 {
            return 0.0;
        }
        // Rows make way for the opening as well, to both sides.
        let opening = 0.5 * self.settings.width * self.taper(x);
        let aside = if t > 0.0 {
            opening
        } else if t < 0.0 {
            -opening
        } else {
            0.0
        };
        share * share * (self.bend(x) + aside)
    }

    /// y of its middle at that x.
    fn middle(&self, x: f64) -> f64 {
        self.level + self.bend(x)
    }

    /// y of a point of a wall or an edge: `side` -1 for near, 1 for far, and how far down it is, 0 at the edge to 1 at
    /// the floor.
    pub(super) fn wall_y(&self, column: u32, x: f64, side: f64, down: f64) -> f64 {
        let taper = self.taper(x);
        let [near, far] = self.edge_shares[column as usize];
        let edge = 0.5 * self.settings.width * taper * if side < 0.0 { near } else { far };
        // Walls come together by a quarter towards the floor, and go back in between where they overhang.
        let under = self.settings.overhang * taper * 4.0 * down * (1.0 - down);
        self.middle(x) + side * (edge * (1.0 - 0.25 * down * down) + under)
    }

    /// From the lower edge to the floor at that x, metres.
    pub(super) fn depth(&self, x: f64) -> f64 {
        // Shallower where it winds, so that the floor is not level.
        let uneven = 0.85 + 0.15 * libm::sin(2.3 * x + self.course[0].phase);
        self.settings.depth * self.taper(x) * uneven
    }

    /// Whether a body of that radius at (x, y) would reach over an edge or an overhang.
    pub(super) fn overlaps_disc(&self, place: DVec2, radius: f64) -> bool {
        let [start, end] = self.span;
        // The course is no steeper than its bend's slopes together: within a radius it does not move more than this.
        let slope: f64 = self.course.iter().map(|wave| wave.amplitude * wave.wave_number).sum();
        let reach = 0.5 * self.settings.width + self.settings.overhang + radius * (1.0 + slope);
        let beside = place.x < start - radius || place.x > end + radius;
        !beside && (place.y - self.middle(place.x)).abs() < reach
    }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/crevasses.rs"]
mod tests;
