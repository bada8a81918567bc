//! Craters: bowls with a raised rim and an ejecta blanket, from fresh to nearly eroded.
//!
//! A fresh simple crater of diameter D (rim to rim) is about 0.2 D deep from rim to floor, and its rim stands
//! about 0.04 D above the surrounding ground (Pike 1977). Ejecta decrease with the third power of the distance
//! (McGetchin, Settle and Head 1973). Wind fills old craters from the floor up and rounds their rims.

use glam::DVec2;

use crate::HeightGrid;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Depth from rim to floor of a fresh crater and of the most degraded one, per diameter.
const DEPTH_PER_DIAMETER: [f64; 2] = [0.2, 0.03];
/// Height of the rim above the surrounding ground, likewise.
const RIM_HEIGHT_PER_DIAMETER: [f64; 2] = [0.04, 0.004];
/// Width of the rounding of the most degraded rim, per diameter. CHOICE.
const MAX_RIM_ROUNDING_PER_DIAMETER: f64 = 0.03;
/// Outer end of the ejecta, radii.
const EJECTA_END_RADII: f64 = 3.0;

/// Size distribution of the craters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Craters {
    /// Number of craters of diameter D and more per square metre, times D^2. (The power -2 holds where new
    /// craters destroy as many old ones) Geometric saturation is 1.54; surfaces in equilibrium have 1 to 10 % of
    /// it (Gault 1970).
    pub density: f64,
    /// Smallest diameter, metres.
    pub smallest: f64,
    /// Largest diameter, metres.
    pub largest: f64,
}

impl Craters {
    /// Expected number of craters on a square, including those outside whose ejecta reach it.
    pub(super) fn expected(&self, extent: f64) -> f64 {
        self.density
            * self.area(extent)
            * (1.0 / (self.smallest * self.smallest) - 1.0 / (self.largest * self.largest))
    }

    fn area(&self, extent: f64) -> f64 {
        let side = self.side(extent);
        side * side
    }

    fn side(&self, extent: f64) -> f64 {
        extent + self.largest * EJECTA_END_RADII
    }

    /// Craters of a square of side `extent` about `middle`, the largest first.
    pub(super) fn draw(&self, middle: DVec2, extent: f64, seed: u64) -> Vec<Crater> {
        let mut random = RandomStream::new(seed, StreamPurpose::Craters);
        let scale = self.density * self.area(extent);
        // The number of craters above D is a Poisson process in scale / D^2.
        let mut events = scale / (self.largest * self.largest);
        let mut craters = Vec::new();
        loop {
            events += random.exponential();
            let diameter = (scale / events).sqrt();
            if !(diameter >= self.smallest) {
                return craters;
            }
            let half = 0.5 * self.side(extent);
            let centre = middle + DVec2::new(random.between(-half, half), random.between(-half, half));
            craters.push(Crater { centre, diameter, degradation: random.uniform() });
        }
    }
}

/// One crater.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crater {
    /// Centre, global x and y, metres.
    pub centre: DVec2,
    /// Diameter from rim to rim, metres.
    pub diameter: f64,
    /// Degradation: 0 for a fresh crater, 1 for one that is nearly eroded.
    pub degradation: f64,
}

impl Crater {
    /// Depth from rim to floor, metres.
    pub fn depth(&self) -> f64 {
        self.between(DEPTH_PER_DIAMETER)
    }

    /// Height of the rim above the surrounding ground, metres.
    pub fn rim_height(&self) -> f64 {
        self.between(RIM_HEIGHT_PER_DIAMETER)
    }

    fn between(&self, [fresh, degraded]: [f64; 2]) -> f64 {
        self.diameter * (fresh + (degraded - fresh) * self.degradation)
    }

    /// Height that the crater adds to the ground at a distance from its centre, metres.
    pub fn profile(&self, distance: f64) -> f64 {
        let r = 2.0 * distance / self.diameter;
        if r >= EJECTA_END_RADII {
            return 0.0;
        }
        let rounding = MAX_RIM_ROUNDING_PER_DIAMETER * self.degradation * self.diameter;
        // The smooth minimum below lowers the crest. Where straight lines of slopes a > 0 and -b < 0 meet, it
        // lowers by width s (1 - s), s = b / (a + b). Bowl and blanket are nearly straight near the rim.
        let [a, b] = [4.0 * DEPTH_PER_DIAMETER[0], 6.0 * self.rim_height() / self.diameter];
        let share = b / (a + b);
        let rim = self.rim_height() + rounding * share * (1.0 - share);
        let bowl = DEPTH_PER_DIAMETER[0] * self.diameter * (r * r - 1.0) + rim;
        // Inside, the blanket shapes the crest alone: the bowl is far below it half way out.
        let far = r.max(0.5);
        let faded = 1.0 / (EJECTA_END_RADII * EJECTA_END_RADII * EJECTA_END_RADII);
        let ejecta = rim * (1.0 / (far * far * far) - faded) / (1.0 - faded);
        let sheet = smooth_minimum(bowl, ejecta, rounding);
        // Sand fills the bowl up to a level floor.
        sheet.max(self.rim_height() - self.depth())
    }

    /// Adds the crater to the heights of the posts.
    pub(super) fn carve(&self, posts: &mut HeightGrid) {
        let reach = 0.5 * EJECTA_END_RADII * self.diameter;
        let range = |centre: f64, corner: f64, spacing: f64, count: u32| {
            let post = |edge: f64| ((edge - corner) / spacing).clamp(0.0, f64::from(count)) as u32;
            post(centre - reach)..(post(centre + reach) + 1).min(count)
        };
        let columns = range(self.centre.x, posts.corner.x, posts.spacing.x, posts.columns);
        let rows = range(self.centre.y, posts.corner.y, posts.spacing.y, posts.rows);
        for row in rows {
            for column in columns.clone() {
                let offset = posts.at(column, row).truncate() - self.centre;
                posts.heights[row as usize * posts.columns as usize + column as usize] +=
                    self.profile(offset.length());
            }
        }
    }
}

/// Minimum of two values, with the corner rounded where they differ by less than `width`.
fn smooth_minimum(a: f64, b: f64, width: f64) -> f64 {
    let near = (width - (a - b).abs()).max(0.0);
    // A width of 0 never rounds.
    if near == 0.0 { a.min(b) } else { a.min(b) - near * near / (4.0 * width) }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/craters.rs"]
mod tests;
