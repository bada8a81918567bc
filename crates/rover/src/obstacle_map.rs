//! The obstacle map: a radial grid over the local terrain map, tested outwards along each sector. (Paper, §7)

use glam::DVec2;
use raypencil_scene::{Pose, SceneError};

use crate::check::{check_count, check_range};
use crate::elevation_map::ElevationMap;
use crate::traversability::{Traversability, TraversabilityRules, TraversabilityTest};
use crate::vehicle::Vehicle;

/// The radial grid. "Determination of the obstacle regions is based upon a radial grid that is overlain over the
/// LTM." (§7)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadialGrid {
    /// How many sectors, spread evenly over the angle.
    pub sectors: u32,
    /// From the heading to the outermost sector on either side, radians.
    pub half_angle: f64,
    /// The first radius, metres from the vehicle's origin.
    pub first: f64,
    /// Between radii, metres.
    pub step: f64,
    /// Radii are tested up to here, metres.
    pub last: f64,
}

/// CHOICE: no grid has more points. Each may be judged anew in every obstacle map.
const MAX_GRID_POINTS: u32 = 10_000_000;

impl RadialGrid {
    /// CHOICE: 31 sectors over the 60 degrees of the beams' fan, 2 degrees apart, about the vehicle's origin; radii a
    /// grid spacing of 0.1 m apart, so that no grid point is stepped over; from one step before the front axle to
    /// 5 m, just inside the far stripe of the default rig on level ground (5.25 m), so that what it brings is enough
    /// to be clear.
    pub fn for_vehicle(vehicle: &Vehicle) -> Self {
        let step = 0.1;
        let first = 0.5 * vehicle.wheelbase + step;
        Self { sectors: 31, half_angle: 30.0_f64.to_radians(), first, step, last: 5.0 }
    }

    /// The angle of a sector from the heading, to the left, radians; sector 0 is the rightmost.
    pub fn angle(&self, sector: u32) -> f64 {
        if self.sectors < 2 {
            return 0.0;
        }
        self.half_angle * (2.0 * f64::from(sector) / f64::from(self.sectors - 1) - 1.0)
    }

    /// How many radii there are.
    pub fn radii(&self) -> u32 {
        ((self.last - self.first) / self.step + 1e-9).floor() as u32 + 1
    }

    /// Radius of that index, metres.
    pub fn radius(&self, index: u32) -> f64 {
        self.first + self.step * f64::from(index)
    }

    /// Which way a sector goes from a vehicle at `global_from_vehicle`: from the global x axis to the left, radians, and
    /// as a unit.
    pub fn direction(&self, sector: u32, global_from_vehicle: &Pose) -> (f64, DVec2) {
        let forward = global_from_vehicle.rotate(glam::DVec3::X);
        let direction = libm::atan2(forward.y, forward.x) + self.angle(sector);
        let (sin, cos) = libm::sincos(direction);
        (direction, DVec2::new(cos, sin))
    }

    /// What the tests say of every point of a sector, outwards: each by itself, whatever the ones before it are. Each
    /// is judged only when it is asked for.
    pub fn classify_sector(
        &self,
        sector: u32,
        map: &ElevationMap,
        vehicle: &Vehicle,
        rules: &TraversabilityRules,
        global_from_vehicle: &Pose,
    ) -> impl Iterator<Item = (f64, Traversability)> {
        let (_, unit) = self.direction(sector, global_from_vehicle);
        let centre = global_from_vehicle.position.truncate();
        (0..self.radii()).map(move |index| {
            let radius = self.radius(index);
            (radius, rules.classify(map, vehicle, centre + unit * radius, unit))
        })
    }

    /// Refuses a grid that is none, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_count(field, "sectors", self.sectors.into(), 1, 100_000)?;
        check_range(field, "half_angle", self.half_angle, 0.0, std::f64::consts::PI, "rad")?;
        check_range(field, "first", self.first, 0.0, 1e3, "m")?;
        check_range(field, "step", self.step, 1e-3, 1e3, "m")?;
        check_range(field, "last", self.last, self.first, 1e3, "m, at least the first")?;
        // Each number may be sound and all of them too much together.
        let radii = self.radii();
        let most = MAX_GRID_POINTS / radii;
        if self.sectors > most {
            let expected = format!("1 to {most}: {MAX_GRID_POINTS} points at most, {radii} radii each");
            return Err(SceneError::new(format!("{field}.sectors"), self.sectors, expected));
        }
        Ok(())
    }
}

/// "Each sector has a label and point, the label being either obstacle, unknown, or visibility." (§7)
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Label {
    /// The vehicle may not stand there.
    Obstacle,
    /// Nobody knows whether it may.
    Unknown,
    /// All was clear up to the last point of the sector.
    Visibility,
}

/// Where a sector ends and why.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectorEnd {
    /// Of the sector, from the global x axis to the left, radians.
    pub direction: f64,
    /// Of the point, metres from the grid's centre.
    pub radius: f64,
    /// The point, global, metres.
    pub point: DVec2,
    /// Why testing stopped there.
    pub label: Label,
    /// The test that an obstacle failed.
    pub failed: Option<TraversabilityTest>,
}

/// The labelled points of all sectors, the rightmost first.
#[derive(Debug, Clone, PartialEq)]
pub struct ObstacleMap {
    /// The grid's centre, global, metres.
    pub centre: DVec2,
    /// Where each sector ends.
    pub sectors: Vec<SectorEnd>,
}

/// Whether the obstacle map is made in a frame. "The obstacle regions are not extracted from the LTM every camera frame
/// but at after a fixed number of the frames." (§7) CHOICE: `every` = [`FRAMES_PER_OBSTACLE_MAP`].
pub fn obstacle_map_due(frame: u64, every: u64) -> bool {
    frame.is_multiple_of(every.max(1))
}

/// CHOICE: every 10 frames, once a second: the default route moves on by 0.3 m.
pub const FRAMES_PER_OBSTACLE_MAP: u64 = 10;

impl ObstacleMap {
    /// Tests the radial grid around a vehicle believed to be at `global_from_vehicle`. "Points on the radial grid are
    /// tested as to whether they belong to an obstacle region in order of increasing radii along each of the
    /// sectors." (§7)
    pub fn extract(
        map: &ElevationMap,
        vehicle: &Vehicle,
        rules: &TraversabilityRules,
        grid: &RadialGrid,
        global_from_vehicle: &Pose,
    ) -> Self {
        let centre = global_from_vehicle.position.truncate();
        let sector = |index| {
            let (direction, unit) = grid.direction(index, global_from_vehicle);
            let end = |radius, label, failed| {
                let point = centre + unit * radius;
                SectorEnd { direction, radius, point, label, failed }
            };
            for (radius, verdict) in grid.classify_sector(index, map, vehicle, rules, global_from_vehicle) {
                match verdict {
                    // "... and testing for that sector stops." (§7)
                    Traversability::Obstacle(test) => return end(radius, Label::Obstacle, Some(test)),
                    Traversability::Unknown => return end(radius, Label::Unknown, None),
                    // "... and testing for that sector continues unless that point is the last one of the sector, in
                    // which case, the point is labelled as a visibility limit." (§7)
                    Traversability::Clear => {}
                }
            }
            end(grid.radius(grid.radii() - 1), Label::Visibility, None)
        };
        Self { centre, sectors: (0..grid.sectors).map(sector).collect() }
    }
}
