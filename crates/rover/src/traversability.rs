//! Whether a vehicle may stand with its front axle on a point: the slope tests and the belly test. (Paper, §7)

use glam::DVec2;
use raypencil_scene::SceneError;

use crate::check::check_range;
use crate::elevation_map::ElevationMap;
use crate::gap::GapRule;
use crate::vehicle::Vehicle;

/// One of the tests of a point. The letters are the paper's: "The point pairs for slope testing are: a) two front
/// wheel centers b) two rear wheel centers c) the point midway between front wheel centers and the point midway
/// between the rear wheel centers." (§7)
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum TraversabilityTest {
    /// a) The two front wheel centres.
    Front,
    /// b) The two rear wheel centres.
    Rear,
    /// c) The points midway between the front and between the rear wheel centres.
    Length,
    /// In place of c): "If the rear wheels lie on points with unknown LTM elevation, instead of testing with the points
    /// in c) above we test with a pair of points closer to the center of the vehicle." (§7)
    Closer,
    /// "In addition we test whether the terrain hits the midpoint between the rear and front wheel centers." (§7)
    Belly,
}

/// What the tests say of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Traversability {
    /// "If any of the slope tests exceed the maximum slope for that point pair, point Q is labelled an obstacle
    /// point." (§7) The first test that failed.
    Obstacle(TraversabilityTest),
    /// "If all the slope tests are satisfied, but if one of the slope points has unknown LTM elevation, the point Q is
    /// labeled as unknown." (§7)
    Unknown,
    /// "Otherwise, if all tests are passed and all points have known elevation, the point is labeled as being
    /// clear." (§7)
    Clear,
}

/// The greatest slopes, rise over level distance, "for that point pair" (§7).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopeLimits {
    /// a) Across, at the front axle.
    pub front: f64,
    /// b) Across, at the rear axle.
    pub rear: f64,
    /// c) Along, from axle to axle.
    pub length: f64,
    /// Along, of the pair closer to the centre.
    pub closer: f64,
}

/// The thresholds of the tests. The paper prints none of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraversabilityRules {
    /// The greatest slopes.
    pub slopes: SlopeLimits,
    /// Where the pair closer to the centre lies: at this share of the half wheelbase before and behind the centre.
    pub closer_share: f64,
    /// Whether unknown rear wheels leave a point unknown, as the paper's words have it: they are slope points of b).
    /// If not, the pair closer to the centre stands for them, and they are excused.
    pub rear_needed: bool,
    /// The more general solution of the gap problem, "which we have not yet implemented" (§7).
    pub gaps: Option<GapRule>,
}

impl TraversabilityRules {
    /// The thresholds for a vehicle.
    ///
    /// CHOICE: a pair fails at the slope of a step of one wheel radius between its points: a rigid wheel that meets a
    /// step as high as its hub is pushed back by it, and not lifted. For the default vehicle these are 0.35 (19
    /// degrees) across and 0.29 (16 degrees) along. The closer pair is half way to the centre. Gaps: off, as in the
    /// paper.
    pub fn for_vehicle(vehicle: &Vehicle) -> Self {
        let step = vehicle.wheel_radius;
        let closer_share = 0.5;
        let across = step / vehicle.track;
        let slopes = SlopeLimits {
            front: across,
            rear: across,
            length: step / vehicle.wheelbase,
            closer: step / (closer_share * vehicle.wheelbase),
        };
        Self { slopes, closer_share, rear_needed: true, gaps: None }
    }

    /// The same with gaps crossed that are no wider than a wheel is thick.
    pub fn crossing_gaps(self, vehicle: &Vehicle) -> Self {
        Self { gaps: Some(GapRule { max_width: vehicle.wheel_width }), ..self }
    }

    /// Tests the global point `front`. "The point pairs are relative to an imaginary vehicle whose front axle midcenter
    /// is at the point Q being tested. The orientation of the vehicle is in the direction of the radial grid
    /// lines." (§7) `forward` is that direction, a unit.
    ///
    /// CHOICE: every point of the imaginary vehicle takes the elevation of the grid point nearest to it, and slopes
    /// are between these grid points: so a plane has exactly its own slope wherever the pair falls.
    pub fn classify(
        &self,
        map: &ElevationMap,
        vehicle: &Vehicle,
        front: DVec2,
        forward: DVec2,
    ) -> Traversability {
        let Vehicle { wheelbase, track, clearance, .. } = *vehicle;
        let left = forward.perp();
        let ground = |place: DVec2| {
            let point = map.nearest(place);
            let estimate = || self.gaps.and_then(|gaps| gaps.upper_estimate(map, point));
            map.elevation(point).or_else(estimate).map(|z| map.place(point).extend(z))
        };
        // Behind the front axle, and to the left of the middle.
        let at = |behind: f64, aside: f64| ground(front - forward * behind + left * aside);
        let axle = |behind: f64| [at(behind, 0.5 * track), at(behind, -0.5 * track)];
        let [front_wheels, rear_wheels] = [axle(0.0), axle(wheelbase)];
        let rear_known = rear_wheels.iter().all(Option::is_some);
        let (along, pair) = if rear_known {
            (TraversabilityTest::Length, [at(0.0, 0.0), at(wheelbase, 0.0)])
        } else {
            let from_centre = 0.5 * wheelbase * self.closer_share;
            let centre = 0.5 * wheelbase;
            (TraversabilityTest::Closer, [at(centre - from_centre, 0.0), at(centre + from_centre, 0.0)])
        };

        // "The slope tests are made on all point pairs whose LTM elevation is known." (§7)
        let limits = self.slopes;
        let along_limit = if rear_known { limits.length } else { limits.closer };
        for (test, pair, limit) in [
            (TraversabilityTest::Front, front_wheels, limits.front),
            (TraversabilityTest::Rear, rear_wheels, limits.rear),
            (along, pair, along_limit),
        ] {
            if let [Some(a), Some(b)] = pair {
                // rise > limit * distance, so that two points on one grid point need no quotient.
                let distance = (a - b).truncate().length();
                if (a.z - b.z).abs() > limit * distance + RISE_ROUNDING_M {
                    return Traversability::Obstacle(test);
                }
            }
        }

        // CHOICE: the midpoint is that of all four wheels, as high above their mean as the clearance; with the rear
        // wheels unknown it is that of the closer pair.
        let carriers = if rear_known { [front_wheels, rear_wheels].concat() } else { pair.to_vec() };
        let belly = at(0.5 * wheelbase, 0.0);
        if let (Some(belly), Some(carriers)) = (belly, carriers.iter().copied().collect::<Option<Vec<_>>>()) {
            let mean = carriers.iter().map(|point| point.z).sum::<f64>() / carriers.len() as f64;
            if belly.z >= mean + clearance {
                return Traversability::Obstacle(TraversabilityTest::Belly);
            }
        }

        let needed = front_wheels.iter().chain(&pair).chain([&belly]).all(Option::is_some);
        if needed && (rear_known || !self.rear_needed) {
            Traversability::Clear
        } else {
            Traversability::Unknown
        }
    }

    /// Refuses thresholds that are none, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let SlopeLimits { front, rear, length, closer } = self.slopes;
        for (name, slope) in [
            ("slopes.front", front),
            ("slopes.rear", rear),
            ("slopes.length", length),
            ("slopes.closer", closer),
        ] {
            check_range(field, name, slope, 0.0, 1e3, "(rise over distance)")?;
        }
        check_range(field, "closer_share", self.closer_share, 1e-3, 1.0, "of the half wheelbase")?;
        if let Some(gaps) = self.gaps {
            check_range(field, "gaps.max_width", gaps.max_width, 0.0, 1e2, "m")?;
        }
        Ok(())
    }
}

/// A slope exactly at its limit passes: elevations and places within 1e4 m are good to 2e-12 m each, a rise and
/// its distance to a few of these.
const RISE_ROUNDING_M: f64 = 1e-11;
