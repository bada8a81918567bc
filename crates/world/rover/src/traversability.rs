//! Traversability of a point: the slope tests and the belly test of a vehicle with its front axle there. (Paper, §7)

use glam::{DVec2, DVec3};
use raypencil_scene::{SceneError, check_range};

use crate::gap::{GapRule, MapWithShadows};
use crate::rules::Rule;
use crate::vehicle::Vehicle;

/// Tolerance of a rise, metres: a slope exactly at its limit passes. Coordinates within 1e4 m have rounding errors of
/// 2e-12 m, and a rise and its distance have a few of these.
pub(crate) const RISE_ROUNDING_M: f64 = 1e-11;

/// A test of a point. The letters are the paper's: "The point pairs for slope testing are: a) two front
/// wheel centers b) two rear wheel centers c) the point midway between front wheel centers and the point midway
/// between the rear wheel centers." (§7)
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TraversabilityTest {
    /// a) Slope between the two front wheel centres.
    Front,
    /// b) Slope between the two rear wheel centres.
    Rear,
    /// c) Slope between the point midway between the front wheel centres and the one midway between the rear ones.
    Length,
    /// Slope between two points closer to the centre, instead of c). "If the rear wheels lie on points with unknown LTM
    /// elevation, instead of testing with the points in c) above we test with a pair of points closer to the center of
    /// the vehicle." (§7)
    Closer,
    /// Height of the ground under the belly. "In addition we test whether the terrain hits the midpoint between the
    /// rear and front wheel centers." (§7)
    Belly,
}

/// A part of the vehicle that stands over a point of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum VehiclePart {
    /// Left or right front wheel.
    FrontWheel,
    /// Left or right rear wheel.
    RearWheel,
    /// A point of the centre line.
    CentreLine,
    /// The belly.
    Belly,
}

/// Why nothing can be said of a point of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MissingReason {
    /// No stripe has measured it.
    NotMeasured,
    /// The map ends before it.
    BeyondMap,
    /// What may hide in the shadow before it is higher than the vehicle can pass.
    MayHide,
    /// A slope is so near its limit that the errors of the points decide on which side it is.
    NearLimit,
}

/// What is missing for a verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Missing {
    /// Part of the vehicle that stands over it.
    pub part: VehiclePart,
    /// Place, global x and y, metres.
    pub place: DVec2,
    /// Why nothing can be said of it.
    pub reason: MissingReason,
}

/// Result of the tests of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Traversability {
    /// A test failed; this is the first one. "If any of the slope tests exceed the maximum slope for that point pair,
    /// point Q is labelled an obstacle point." (§7)
    Obstacle(TraversabilityTest),
    /// No test failed, but an elevation is missing. "If all the slope tests are satisfied, but if one of the slope
    /// points has unknown LTM elevation, the point Q is labeled as unknown." (§7) This is the first one that is missing.
    Unknown(Missing),
    /// All tests passed. "Otherwise, if all tests are passed and all points have known elevation, the point is labeled
    /// as being clear." (§7)
    Clear,
}

/// Maximum slopes, rise over horizontal distance, "for that point pair" (§7).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopeLimits {
    /// a) Across the vehicle, at the front axle.
    pub front: f64,
    /// b) Across the vehicle, at the rear axle.
    pub rear: f64,
    /// c) Along the vehicle, from axle to axle.
    pub length: f64,
    /// Along the vehicle, between the two points closer to the centre.
    pub closer: f64,
}

/// Distances from a limit, in standard errors of the rise between two wheels, that the mended tests ask for.
///
/// CHOICE: a half and two. By a normal law, of 100 rises exactly at their limit 31 are then called an obstacle and 2
/// clear; before the others the vehicle stops as well, but says that it does not know. An obstacle that is called clear
/// costs the vehicle, a clear place that is called an obstacle costs a detour. The half is tuned: with none, more than 2 %
/// of the sectors of `facets` end at a false obstacle; with one, fewer true ones are named (`docs/evidence/results.md`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorMargins {
    /// A point is an obstacle if a slope is above its limit by more than this.
    pub obstacle: f64,
    /// A point is clear if all slopes are below their limits by at least this.
    pub clear: f64,
}

impl Default for ErrorMargins {
    fn default() -> Self {
        Self { obstacle: 0.5, clear: 2.0 }
    }
}

/// Settings of the tests. The paper prints none of these numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraversabilityRules {
    /// Maximum slopes.
    pub slopes: SlopeLimits,
    /// Distance of the two closer points from the vehicle's centre, as a share of half the wheelbase.
    pub closer_share: f64,
    /// Whether unknown rear wheels make a point unknown. They do in the paper, since they are slope points of b). If
    /// false, the two closer points suffice.
    pub rear_needed: bool,
    /// Rule for narrow gaps. `None`: no gap is crossed, as in the paper, whose solution is one "which we have not yet
    /// implemented" (§7).
    pub gaps: Option<GapRule>,
    /// What is tested. Paper: seven points of the map. Mended: all cells under wheels and belly, see `wheel_tests`.
    pub tests: Rule,
    /// How the mended tests treat a slope near its limit. The printed ones know no errors.
    pub margins: ErrorMargins,
}

impl TraversabilityRules {
    /// Mended settings for a vehicle: wheels and belly are tested, and gaps of up to one wheel width may be crossed.
    ///
    /// CHOICE: the maximum slope of a pair is that of a step of one wheel radius between its points: a rigid wheel
    /// cannot climb a step as high as its hub. For the default vehicle this is 0.35 (19 degrees) across and 0.29 (16
    /// degrees) along. The closer points are half way between centre and axles.
    pub fn for_vehicle(vehicle: &Vehicle) -> Self {
        Self { tests: Rule::Mended, ..Self::as_printed(vehicle) }.crossing_gaps(vehicle)
    }

    /// The paper's settings: seven points are tested, and no gap is crossed.
    pub fn as_printed(vehicle: &Vehicle) -> Self {
        let step = vehicle.wheel_radius;
        let closer_share = 0.5;
        let across = step / vehicle.track;
        let slopes = SlopeLimits {
            front: across,
            rear: across,
            length: step / vehicle.wheelbase,
            closer: step / (closer_share * vehicle.wheelbase),
        };
        Self {
            slopes,
            closer_share,
            rear_needed: true,
            gaps: None,
            tests: Rule::Paper,
            margins: ErrorMargins::default(),
        }
    }

    /// The same settings, but gaps up to one wheel width may be crossed.
    pub fn crossing_gaps(self, vehicle: &Vehicle) -> Self {
        Self { gaps: Some(GapRule { max_width: vehicle.wheel_width }), ..self }
    }

    /// Tests a point by the rules in force. What `front` and `forward` mean: [`TraversabilityRules::classify_points`].
    pub fn classify(
        &self,
        map: &MapWithShadows,
        vehicle: &Vehicle,
        front: DVec2,
        forward: DVec2,
    ) -> Traversability {
        match self.tests {
            Rule::Paper => self.classify_points(map, vehicle, front, forward),
            Rule::Mended => self.classify_wheels(map, vehicle, front, forward),
        }
    }

    /// Tests the global point `front`, the paper's Q. `forward` is the direction of the sector, a unit vector. "The
    /// point pairs are relative to an imaginary vehicle whose front axle midcenter is at the point Q being tested. The
    /// orientation of the vehicle is in the direction of the radial grid lines." (§7)
    ///
    /// CHOICE: every point of the imaginary vehicle is replaced by the nearest grid point, in position and elevation. A
    /// plane then has its own slope exactly, wherever the vehicle stands on it.
    ///
    /// ```
    /// use glam::DVec2;
    /// use raypencil_rover::{
    ///     ElevationMap, MapSize, MapWithShadows, Traversability, TraversabilityRules, TraversabilityTest, Vehicle,
    /// };
    ///
    /// // Level ground, but 0.36 m higher from x = 1 on. With the front axle at x = 1 the slope along the default
    /// // vehicle is 0.36 / 1.2 = 0.30; the maximum is 0.35 / 1.2 = 0.29.
    /// let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    /// for point in map.points() {
    ///     map.set_proximity(point, if point.i >= 10 { 0.36 } else { 0.0 });
    /// }
    /// let vehicle = Vehicle::default();
    /// let rules = TraversabilityRules::as_printed(&vehicle);
    /// let map = MapWithShadows::of(&map);
    /// let at = |x| rules.classify_points(&map, &vehicle, DVec2::new(x, 0.0), DVec2::X);
    /// assert_eq!(at(0.9), Traversability::Clear);
    /// assert_eq!(at(1.0), Traversability::Obstacle(TraversabilityTest::Length));
    /// ```
    pub fn classify_points(
        &self,
        shadows: &MapWithShadows,
        vehicle: &Vehicle,
        front: DVec2,
        forward: DVec2,
    ) -> Traversability {
        let Vehicle { wheelbase, track, clearance, .. } = *vehicle;
        let (left, map) = (forward.perp(), shadows.map());
        let ground = |place: DVec2| {
            let point = map.nearest(place);
            let estimate = || self.gaps.and_then(|gaps| gaps.upper_estimate(shadows, point));
            map.elevation(point).or_else(estimate).map(|z| map.place(point).extend(z))
        };
        // A point this far behind the front axle, and this far to the left of the centre line, metres.
        let at = |behind: f64, aside: f64| ground(front - forward * behind + left * aside);
        let axle = |behind: f64| [at(behind, 0.5 * track), at(behind, -0.5 * track)];
        let [front_wheels, rear_wheels] = [axle(0.0), axle(wheelbase)];
        let rear_known = rear_wheels.iter().all(Option::is_some);
        let (along, along_places) = if rear_known {
            (TraversabilityTest::Length, [0.0, wheelbase])
        } else {
            let from_centre = 0.5 * wheelbase * self.closer_share;
            let centre = 0.5 * wheelbase;
            (TraversabilityTest::Closer, [centre - from_centre, centre + from_centre])
        };
        let pair = along_places.map(|behind| at(behind, 0.0));

        // "The slope tests are made on all point pairs whose LTM elevation is known." (§7)
        let limits = self.slopes;
        let along_limit = if rear_known { limits.length } else { limits.closer };
        for (test, pair, limit) in [
            (TraversabilityTest::Front, front_wheels, limits.front),
            (TraversabilityTest::Rear, rear_wheels, limits.rear),
            (along, pair, along_limit),
        ] {
            if let [Some(a), Some(b)] = pair {
                // A product instead of a quotient: both points may have the same grid point.
                let distance = (a - b).truncate().length();
                if (a.z - b.z).abs() > limit * distance + RISE_ROUNDING_M {
                    return Traversability::Obstacle(test);
                }
            }
        }

        // CHOICE: the midpoint is that of the four wheels. The ground hits it at the mean of their elevations plus the
        // clearance. If the rear wheels are unknown, the mean is that of the two closer points.
        let support = if rear_known { [front_wheels, rear_wheels].concat() } else { pair.to_vec() };
        let belly = at(0.5 * wheelbase, 0.0);
        if let (Some(belly), Some(support)) = (belly, support.iter().copied().collect::<Option<Vec<_>>>()) {
            let mean = support.iter().map(|point| point.z).sum::<f64>() / support.len() as f64;
            if belly.z >= mean + clearance {
                return Traversability::Obstacle(TraversabilityTest::Belly);
            }
        }

        let missing = |part, behind: f64, aside: f64| {
            let point = map.nearest(front - forward * behind + left * aside);
            let reason =
                if map.contains(point) { MissingReason::NotMeasured } else { MissingReason::BeyondMap };
            Traversability::Unknown(Missing { part, place: map.place(point), reason })
        };
        // The half track to the left or to the right, wherever the wheel without an elevation is.
        let side = |wheels: &[Option<DVec3>; 2]| if wheels[0].is_none() { 0.5 * track } else { -0.5 * track };
        if front_wheels.iter().any(Option::is_none) {
            return missing(VehiclePart::FrontWheel, 0.0, side(&front_wheels));
        }
        if !rear_known && self.rear_needed {
            return missing(VehiclePart::RearWheel, wheelbase, side(&rear_wheels));
        }
        for (ground, behind) in pair.iter().zip(along_places) {
            if ground.is_none() {
                return missing(VehiclePart::CentreLine, behind, 0.0);
            }
        }
        if belly.is_none() {
            return missing(VehiclePart::Belly, 0.5 * wheelbase, 0.0);
        }
        Traversability::Clear
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let SlopeLimits { front, rear, length, closer } = self.slopes;
        for (name, slope) in [
            ("slopes.front", front),
            ("slopes.rear", rear),
            ("slopes.length", length),
            ("slopes.closer", closer),
        ] {
            check_range(|| format!("{field}.{name}"), slope, 0.0, 1e3, "(rise over distance)")?;
        }
        check_range(
            || format!("{field}.closer_share"),
            self.closer_share,
            1e-3,
            1.0,
            "of half the wheelbase",
        )?;
        for (name, errors) in [("obstacle", self.margins.obstacle), ("clear", self.margins.clear)] {
            check_range(|| format!("{field}.margins.{name}"), errors, 0.0, 1e2, "standard errors")?;
        }
        if let Some(gaps) = self.gaps {
            check_range(|| format!("{field}.gaps.max_width"), gaps.max_width, 0.0, 1e2, "m")?;
        }
        Ok(())
    }
}
