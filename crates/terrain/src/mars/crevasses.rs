//! Crevasses: winding cracks with walls of their own, which may overhang.
//!
//! A height field has no walls: it can only be steep. Here the grid itself opens. Its rows near a crack bend
//! along the crack's course. At the crack one row becomes several: the near edge, down the near wall, across the
//! floor, up the far wall, the far edge. The surface stays one sheet without a gap.

use std::ops::Range;

use glam::DVec2;

use crate::random_stream::{RandomStream, StreamPurpose};

/// Number and size of the crevasses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crevasses {
    /// Number of crevasses; each runs along x.
    pub count: u32,
    /// Width from edge to edge at the widest place, metres.
    pub width: f64,
    /// Depth from the lower edge to the floor at the deepest place, metres.
    pub depth: f64,
    /// Largest distance that a wall recedes under its edge, metres; 0 for no overhang.
    pub overhang: f64,
}

/// Largest displacement of a bent row, metres: crevasses wind by twice this.
const MAX_BEND_M: f64 = 2.5;

/// Width of a band, relative to the narrowest band whose rows keep their order. Bent rows then keep at least 1 -
/// 1/1.5, a third, of their distance.
const BEND_SLACK: f64 = 1.5;

/// Steepest slope of (1 - t^2)^2, at t = 1/sqrt 3: 8 / (3 sqrt 3).
const MAX_BUMP_SLOPE: f64 = 1.539_600_717_839_002;

impl Crevasses {
    /// Extent along y of the band of rows that one crevasse bends, metres.
    fn band(&self, extent: f64) -> f64 {
        // The number of bands is even, so that the middle of the ground lies between two of them.
        extent / f64::from(self.count.next_multiple_of(2).max(2))
    }

    /// Maximum width on a ground of this extent along y, metres: it leaves the same amount for the bend.
    pub(super) fn max_width(&self, extent: f64) -> f64 {
        self.band(extent) / (2.0 * BEND_SLACK * MAX_BUMP_SLOPE)
    }

    /// Crevasses on a grid of that many cells along x and y, of that spacing, about the origin.
    pub(super) fn draw(&self, [cells, rows]: [u32; 2], spacing: DVec2, seed: u64) -> Vec<Crevasse> {
        let mut random = RandomStream::new(seed, StreamPurpose::Crevasses);
        let [extent, height] = [f64::from(cells) * spacing.x, f64::from(rows) * spacing.y];
        let band = self.band(height);
        let bend = MAX_BEND_M.min(0.5 * band / (BEND_SLACK * MAX_BUMP_SLOPE) - 0.5 * self.width).max(0.0);
        let course = |random: &mut RandomStream| {
            // Three waves, the shorter the lower. Their sum stays within the bend.
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
    /// Grid row that the crevasse opens.
    pub row: u32,
    /// y of that row before it is bent, metres.
    level: f64,
    /// Columns of the two ends, where the crevasse is closed: it is open between them.
    pub columns: Range<u32>,
    span: [f64; 2],
    half_band: f64,
    course: [Wave; 3],
    /// Fraction of the half width that the near and the far edge take in each column: edges are ragged.
    edge_shares: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Wave {
    amplitude: f64,
    wave_number: f64,
    phase: f64,
}

impl Crevasse {
    /// Displacement of the rows at that x, metres.
    fn bend(&self, x: f64) -> f64 {
        self.course.iter().map(|wave| wave.amplitude * libm::sin(wave.wave_number * x + wave.phase)).sum()
    }

    /// Factor on the opening: 1 along most of the crevasse, 0 at its ends and beyond.
    fn taper(&self, x: f64) -> f64 {
        let [start, end] = self.span;
        let t = (2.0 * x - start - end) / (end - start);
        (1.0 - t * t * t * t).max(0.0)
    }

    /// Displacement along y of a grid point (x, y), metres. Points of the crevasse's own row do not open here.
    pub(super) fn shift(&self, x: f64, y: f64) -> f64 {
        let t = (y - self.level) / self.half_band;
        let share = 1.0 - t * t;
        if share <= 0.0 {
            return 0.0;
        }
        // Rows also move aside for the opening, on both sides.
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

    /// y of the centre line at that x, metres.
    fn middle(&self, x: f64) -> f64 {
        self.level + self.bend(x)
    }

    /// y of a point on a wall or an edge, metres. `side` is -1 for near and 1 for far; `down` runs from 0 at the
    /// edge to 1 at the floor.
    pub(super) fn wall_y(&self, column: u32, x: f64, side: f64, down: f64) -> f64 {
        let taper = self.taper(x);
        let [near, far] = self.edge_shares[column as usize];
        let edge = 0.5 * self.settings.width * taper * if side < 0.0 { near } else { far };
        // Walls approach by a quarter towards the floor; between edge and floor they recede where they overhang.
        let under = self.settings.overhang * taper * 4.0 * down * (1.0 - down);
        self.middle(x) + side * (edge * (1.0 - 0.25 * down * down) + under)
    }

    /// Depth from the lower edge to the floor at that x, metres.
    pub(super) fn depth(&self, x: f64) -> f64 {
        // The depth varies along the crevasse, so that the floor is not level.
        let uneven = 0.85 + 0.15 * libm::sin(2.3 * x + self.course[0].phase);
        self.settings.depth * self.taper(x) * uneven
    }

    /// Whether a disc of that radius about (x, y) would reach an edge or an overhang.
    pub(super) fn overlaps_disc(&self, place: DVec2, radius: f64) -> bool {
        let [start, end] = self.span;
        // The slope of the course is at most the sum of its waves' slopes: this bounds its displacement within a
        // radius.
        let slope: f64 = self.course.iter().map(|wave| wave.amplitude * wave.wave_number).sum();
        let reach = 0.5 * self.settings.width + self.settings.overhang + radius * (1.0 + slope);
        let beside = place.x < start - radius || place.x > end + radius;
        !beside && (place.y - self.middle(place.x)).abs() < reach
    }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/crevasses.rs"]
mod tests;
