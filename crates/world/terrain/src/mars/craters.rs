//! Craters: bowls with a raised rim and an ejecta blanket, from fresh to nearly eroded.
//!
//! A fresh simple crater of diameter D (rim to rim) is about 0.2 D deep from rim to floor, and its rim stands
//! about 0.04 D above the surrounding ground (Pike 1977). Ejecta decrease with the third power of the distance
//! (McGetchin, Settle and Head 1973). Wind fills old craters from the floor up and rounds their rims.
//!
//! Craters come one after the other, the oldest first. Each takes the place of what was there: it is measured from
//! the plane through the ground at its rim, and the relief inside disappears but for a rest. So a young crater cuts
//! the rim of an old one.

use glam::DVec2;

use crate::HeightGrid;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Depth from rim to floor of a fresh crater and of the most degraded one, per diameter.
const DEPTH_PER_DIAMETER: [f64; 2] = [0.2, 0.03];
/// Height of the rim above the surrounding ground, likewise.
const RIM_HEIGHT_PER_DIAMETER: [f64; 2] = [0.04, 0.004];
/// Width of the rounding of the most degraded rim, per diameter. CHOICE.
const MAX_RIM_ROUNDING_PER_DIAMETER: f64 = 0.03;
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
        let mut rims = RandomStream::new(seed, StreamPurpose::Rims);
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
            let degradation = random.uniform();
            craters.push(Crater { centre, diameter, degradation, rim: Rim::draw(&mut rims) });
        }
    }
}

/// One crater.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crater {
    /// Centre, global x and y, metres.
    pub centre: DVec2,
    /// Mean diameter from rim to rim, metres.
    pub diameter: f64,
    /// Degradation: 0 for a fresh crater, 1 for one that is nearly eroded. The larger it is, the older the crater.
    pub degradation: f64,
    /// Shape of the rim.
    pub rim: Rim,
}

/// Deviation of a rim from a circle of one height: waves around the crater, `RIM_WAVES[k]` of them in wave k.
///
/// Each entry is the product of an amplitude and (cos, sin) of a phase.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rim {
    /// Relative deviations of the radius.
    pub radius: [DVec2; RIM_WAVES.len()],
    /// Relative deviations of the height of the crest.
    pub height: [DVec2; RIM_WAVES.len()],
}

/// Numbers of waves around a rim.
const RIM_WAVES: [i32; 5] = [2, 3, 4, 5, 6];

/// Largest relative deviation of a rim's radius and height by n waves, times n. CHOICE: small craters are circles within
/// some per cent, and their crests rise and fall by a fifth.
const MAX_RADIUS_WAVE: f64 = 0.05;
const MAX_HEIGHT_WAVE: f64 = 0.25;

impl Rim {
    fn draw(random: &mut RandomStream) -> Self {
        let mut waves = |largest: f64| {
            RIM_WAVES.map(|waves| {
                let amplitude = largest / f64::from(waves) * random.uniform();
                let (sin, cos) = libm::sincos(random.between(0.0, std::f64::consts::TAU));
                DVec2::new(cos, sin) * amplitude
            })
        };
        Self { radius: waves(MAX_RADIUS_WAVE), height: waves(MAX_HEIGHT_WAVE) }
    }

    /// Relative deviations of radius and height in a direction, a unit vector.
    fn deviations(&self, direction: DVec2) -> [f64; 2] {
        // The n-th power of the complex number is the direction at n times the angle.
        let mut at_angle = direction;
        let mut sums = [0.0; 2];
        for wave in 0..RIM_WAVES.len() {
            at_angle = direction.rotate(at_angle);
            sums[0] += self.radius[wave].dot(at_angle);
            sums[1] += self.height[wave].dot(at_angle);
        }
        sums
    }
}

/// Plane over x and y: the ground that a crater is measured from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plane {
    centre: DVec2,
    height: f64,
    gradient: DVec2,
}

impl Plane {
    fn at(&self, place: DVec2) -> f64 {
        self.height + self.gradient.dot(place - self.centre)
    }
}

/// Fraction of the old relief that stays inside a new crater, and what one adds that is nearly eroded: its floor has
/// become rough again. CHOICE.
const RELIEF_LEFT: [f64; 2] = [0.1, 0.3];

/// Radius, in radii of the crater, at which the old relief is whole again: the thick part of the ejecta buries it.
/// CHOICE.
const BURIED_RADII: f64 = 2.0;

/// Number of places on the rim from which a crater's plane is found.
const PLANE_PLACES: u32 = 16;

impl Crater {
    /// Depth from rim to floor, metres.
    pub fn depth(&self) -> f64 {
        self.between(DEPTH_PER_DIAMETER)
    }

    /// Mean height of the rim above the surrounding ground, metres.
    pub fn rim_height(&self) -> f64 {
        self.between(RIM_HEIGHT_PER_DIAMETER)
    }

    fn between(&self, [fresh, degraded]: [f64; 2]) -> f64 {
        self.diameter * (fresh + (degraded - fresh) * self.degradation)
    }

    /// Height that the crater adds to level ground at a distance from its centre, metres, where the rim is a circle of
    /// its mean height.
    pub fn profile(&self, distance: f64) -> f64 {
        self.profile_of(2.0 * distance / self.diameter, self.rim_height())
    }

    /// Height at `r` radii from the centre where the rim is `rim_height` metres high.
    fn profile_of(&self, r: f64, rim_height: f64) -> f64 {
        if r >= EJECTA_END_RADII {
            return 0.0;
        }
        let rounding = MAX_RIM_ROUNDING_PER_DIAMETER * self.degradation * self.diameter;
        // The smooth minimum below lowers the crest. Where straight lines of slopes a > 0 and -b < 0 meet, it
        // lowers by width s (1 - s), s = b / (a + b). Bowl and blanket are nearly straight near the rim.
        let [a, b] = [4.0 * DEPTH_PER_DIAMETER[0], 6.0 * rim_height / self.diameter];
        let share = b / (a + b);
        let rim = rim_height + rounding * share * (1.0 - share);
        let bowl = DEPTH_PER_DIAMETER[0] * self.diameter * (r * r - 1.0) + rim;
        // Inside, the blanket shapes the crest alone: the bowl is far below it half way out.
        let far = r.max(0.5);
        let faded = 1.0 / (EJECTA_END_RADII * EJECTA_END_RADII * EJECTA_END_RADII);
        let ejecta = rim * (1.0 / (far * far * far) - faded) / (1.0 - faded);
        let sheet = smooth_minimum(bowl, ejecta, rounding);
        // Sand fills the bowl up to a level floor.
        sheet.max(self.rim_height() - self.depth())
    }

    /// Plane through the ground at the rim, before the crater: the mean height, and the gradient by least squares.
    pub(super) fn plane(&self, posts: &HeightGrid) -> Plane {
        let radius = 0.5 * self.diameter;
        let (mut height, mut gradient) = (0.0, DVec2::ZERO);
        for place in 0..PLANE_PLACES {
            let angle = std::f64::consts::TAU * f64::from(place) / f64::from(PLANE_PLACES);
            let (sin, cos) = libm::sincos(angle);
            let direction = DVec2::new(cos, sin);
            let found = posts.bilinear(self.centre + direction * radius);
            height += found / f64::from(PLANE_PLACES);
            // Over the circle, sum cos^2 = sum sin^2 = PLANE_PLACES / 2, and the mixed sums are 0.
            gradient += direction * (found * 2.0 / (f64::from(PLANE_PLACES) * radius));
        }
        Plane { centre: self.centre, height, gradient }
    }

    /// Ground after the impact, where it had the height `before`, metres.
    fn height_after(&self, place: DVec2, before: f64, plane: &Plane) -> f64 {
        let offset = place - self.centre;
        let distance = offset.length();
        let [radius, height] = self.rim.deviations(offset.normalize_or(DVec2::X));
        let r = 2.0 * distance / (self.diameter * (1.0 + radius));
        // The height of the rim varies; that of the centre is one.
        let rim_height = self.rim_height() * (1.0 + height * (r * r).min(1.0));
        let inside = RELIEF_LEFT[0] + RELIEF_LEFT[1] * self.degradation;
        let t = ((r - 1.0) / (BURIED_RADII - 1.0)).clamp(0.0, 1.0);
        let left = inside + (1.0 - inside) * (t * t * (3.0 - 2.0 * t));
        let level = plane.at(place);
        // Where nothing is buried the ground keeps its height to the bit, and the crater is added to it.
        let ground = if left < 1.0 { level + (before - level) * left } else { before };
        ground + self.profile_of(r, rim_height)
    }

    /// Makes the crater in the posts. Inside it, and under its thick ejecta, what was there before disappears but for
    /// a rest.
    pub(super) fn carve(&self, posts: &mut HeightGrid, plane: Plane) {
        let reach = 0.5 * EJECTA_END_RADII * self.diameter * (1.0 + MAX_RADIUS_DEVIATION);
        let range = |centre: f64, corner: f64, spacing: f64, count: u32| {
            let post = |edge: f64| ((edge - corner) / spacing).clamp(0.0, f64::from(count)) as u32;
            post(centre - reach)..(post(centre + reach) + 1).min(count)
        };
        let columns = range(self.centre.x, posts.corner.x, posts.spacing.x, posts.columns);
        let rows = range(self.centre.y, posts.corner.y, posts.spacing.y, posts.rows);
        for row in rows {
            for column in columns.clone() {
                let post = posts.at(column, row);
                posts.heights[row as usize * posts.columns as usize + column as usize] =
                    self.height_after(post.truncate(), post.z, &plane);
            }
        }
    }
}

/// Bound on the relative deviation of a rim's radius: the sum of MAX_RADIUS_WAVE / n for n = 2 to 6, 0.0725.
const MAX_RADIUS_DEVIATION: f64 = 0.073;

/// Minimum of two values, with the corner rounded where they differ by less than `width`.
fn smooth_minimum(a: f64, b: f64, width: f64) -> f64 {
    let near = (width - (a - b).abs()).max(0.0);
    // A width of 0 never rounds.
    if near == 0.0 { a.min(b) } else { a.min(b) - near * near / (4.0 * width) }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/craters.rs"]
mod tests;
