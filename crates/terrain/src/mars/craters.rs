//! Craters: bowls with a raised rim and a blanket of ejecta, from fresh to nearly gone.
//!
//! Of a fresh simple crater of diameter D (rim to rim) the depth from rim to floor is about 0.2 D and the rim stands about
//! 0.04 D above the ground around it (Pike 1977); ejecta thin out with the third power of the distance (McGetchin, Settle
//! and Head 1973). Wind fills old craters from the floor up and rounds their rims.

use glam::DVec2;

use crate::Posts;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Depth from rim to floor of a fresh crater and of the most degraded one, shares of its diameter.
const DEPTH_PER_DIAMETER: [f64; 2] = [0.2, 0.03];
/// Height of the rim above the ground around it, likewise.
const RIM_HEIGHT_PER_DIAMETER: [f64; 2] = [0.04, 0.004];
/// How much the rim of the most degraded crater is rounded, a share of the diameter. CHOICE.
const MAX_RIM_ROUNDING_PER_DIAMETER: f64 = 0.03;
/// The ejecta end here, in radii.
const EJECTA_END_RADII: f64 = 3.0;

/// How many craters there are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Craters {
    /// Craters of diameter D and more, per square metre, are `density` / D^2: the slope of surfaces on which new craters
    /// destroy as many old ones. Geometric saturation is 1.54, and surfaces in equilibrium have 1 to 10 % of it (Gault 1970).
    pub density: f64,
    /// The smallest diameter, metres.
    pub smallest: f64,
    /// The largest diameter, metres.
    pub largest: f64,
}

impl Craters {
    /// How many are to be expected on a square, those outside whose ejecta reach it included.
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

    /// The craters of a square of that side about `middle`, the largest first.
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
    /// Its middle, global x and y, metres.
    pub centre: DVec2,
    /// From rim to rim, metres.
    pub diameter: f64,
    /// 0 for a fresh one, 1 for one that is nearly gone.
    pub degradation: f64,
}

impl Crater {
    /// From the rim to the floor, metres.
    pub fn depth(&self) -> f64 {
        self.between(DEPTH_PER_DIAMETER)
    }

    /// Of the rim above the ground around it, metres.
    pub fn rim_height(&self) -> f64 {
        self.between(RIM_HEIGHT_PER_DIAMETER)
    }

    fn between(&self, [fresh, degraded]: [f64; 2]) -> f64 {
        self.diameter * (fresh + (degraded - fresh) * self.degradation)
    }

    /// What it adds to the height of the ground at that distance from its middle, metres.
    pub fn profile(&self, distance: f64) -> f64 {
        let r = 2.0 * distance / self.diameter;
        if r >= EJECTA_END_RADII {
            return 0.0;
        }
        let rounding = MAX_RIM_ROUNDING_PER_DIAMETER * self.degradation * self.diameter;
        // The smooth minimum below lowers the crest. Where straight lines of slopes a > 0 and -b < 0 meet, it does so by
        // width s (1 - s), s = b / (a + b); bowl and blanket are not straight, but nearly so near the rim.
        let [a, b] = [4.0 * DEPTH_PER_DIAMETER[0], 6.0 * self.rim_height() / self.diameter];
        let share = b / (a + b);
        let rim = self.rim_height() + rounding * share * (1.0 - share);
        let bowl = DEPTH_PER_DIAMETER[0] * self.diameter * (r * r - 1.0) + rim;
        // Inside, the blanket only shapes the crest; the bowl is far below it half way out.
        let far = r.max(0.5);
        let faded = 1.0 / (EJECTA_END_RADII * EJECTA_END_RADII * EJECTA_END_RADII);
        let ejecta = rim * (1.0 / (far * far * far) - faded) / (1.0 - faded);
        let sheet = smooth_minimum(bowl, ejecta, rounding);
        // Sand fills the bowl up to a level floor.
        sheet.max(self.rim_height() - self.depth())
    }

    /// Adds it to posts.
    pub(super) fn carve(&self, posts: &mut Posts) {
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

/// The smaller of two, the corner between them rounded where they differ by less than `width`.
fn smooth_minimum(a: f64, b: f64, width: f64) -> f64 {
    let near = (width - (a - b).abs()).max(0.0);
    // Without a width nothing is near.
    if near == 0.0 { a.min(b) } else { a.min(b) - near * near / (4.0 * width) }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/craters.rs"]
mod tests;
