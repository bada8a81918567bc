//! The obstacle map: a radial grid over the elevation map, tested outwards along each sector. (Paper, §7)

use glam::DVec2;
use rayon::prelude::*;
use raypencil_scene::{Pose, SceneError, check_count, check_range};

use crate::elevation_map::ElevationMap;
use crate::gap::MapWithShadows;
use crate::traversability::{
    Missing, MissingReason, Traversability, TraversabilityRules, TraversabilityTest,
};
use crate::vehicle::Vehicle;

/// Radial grid around the vehicle. "Determination of the obstacle regions is based upon a radial grid that is overlain
/// over the LTM." (§7)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadialGrid {
    /// Number of sectors, evenly spaced in angle.
    pub sectors: u32,
    /// Angle from the heading to the outermost sector on either side, radians.
    pub half_angle: f64,
    /// First radius, from the vehicle's origin, metres.
    pub first: f64,
    /// Distance between radii, metres.
    pub step: f64,
    /// Maximum radius, metres.
    pub last: f64,
}

/// Maximum number of points of a radial grid. CHOICE: each may be tested in every obstacle map.
const MAX_GRID_POINTS: u32 = 10_000_000;

impl RadialGrid {
    /// Radial grid for a vehicle.
    ///
    /// CHOICE: 31 sectors, 2 degrees apart, over the 60 degrees of the beams' fan. The radii are one grid spacing of
    /// 0.1 m apart, so that no grid point is skipped. They begin one step in front of the front axle and end at 4.8 m:
    /// the rims of the front wheels, 0.35 m farther on, are then just inside the far stripe of the default rig on level
    /// ground (5.25 m), so that this stripe suffices to make a sector clear.
    pub fn for_vehicle(vehicle: &Vehicle) -> Self {
        let step = 0.1;
        let first = 0.5 * vehicle.wheelbase + step;
        Self { sectors: 31, half_angle: 30.0_f64.to_radians(), first, step, last: 4.8 }
    }

    /// Angle of a sector from the heading, to the left, radians. Sector 0 is the rightmost.
    pub fn angle(&self, sector: u32) -> f64 {
        if self.sectors < 2 {
            return 0.0;
        }
        self.half_angle * (2.0 * f64::from(sector) / f64::from(self.sectors - 1) - 1.0)
    }

    /// Number of radii.
    pub fn radii(&self) -> u32 {
        ((self.last - self.first) / self.step + 1e-9).floor() as u32 + 1
    }

    /// Radius with this index, metres.
    pub fn radius(&self, index: u32) -> f64 {
        self.first + self.step * f64::from(index)
    }

    /// Direction of a sector of a vehicle with the pose `global_from_vehicle`: the angle from the global x axis to the
    /// left, radians, and the unit vector.
    pub fn direction(&self, sector: u32, global_from_vehicle: &Pose) -> (f64, DVec2) {
        let forward = global_from_vehicle.rotate(glam::DVec3::X);
        let direction = libm::atan2(forward.y, forward.x) + self.angle(sector);
        let (sin, cos) = libm::sincos(direction);
        (direction, DVec2::new(cos, sin))
    }

    /// Radius (metres) and traversability of every point of a sector, outwards. The result of a point does not depend
    /// on the points before it. The iterator is lazy: it tests a point when it reaches it.
    pub fn classify_sector(
        &self,
        sector: u32,
        map: &MapWithShadows,
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

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_count(|| format!("{field}.sectors"), self.sectors.into(), 1, 100_000)?;
        check_range(|| format!("{field}.half_angle"), self.half_angle, 0.0, std::f64::consts::PI, "rad")?;
        if self.sectors > 1 && (self.half_angle == 0.0 || self.half_angle >= std::f64::consts::PI) {
            let expected =
                "more than 0 and less than pi rad with more than one sector: else two have one direction";
            return Err(SceneError::new(format!("{field}.half_angle"), self.half_angle, expected));
        }
        check_range(|| format!("{field}.first"), self.first, 0.0, 1e3, "m")?;
        check_range(|| format!("{field}.step"), self.step, 1e-3, 1e3, "m")?;
        check_range(|| format!("{field}.last"), self.last, self.first, 1e3, "m (from `first`)")?;
        // Each number may be in range while the grid has too many points.
        let radii = self.radii();
        let max_sectors = MAX_GRID_POINTS / radii;
        if self.sectors > max_sectors {
            let expected =
                format!("1 to {max_sectors} (at most {MAX_GRID_POINTS} grid points, {radii} per sector)");
            return Err(SceneError::new(format!("{field}.sectors"), self.sectors, expected));
        }
        Ok(())
    }
}

/// Label of a sector's end and of a vector. "Each sector has a label and point, the label being either obstacle,
/// unknown, or visibility." (§7)
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Label {
    /// The point is not traversable, or it is too near a limit to tell and the next point of its sector is not.
    Obstacle,
    /// The traversability of the point is unknown.
    Unknown,
    /// Visibility limit: all points of the sector are clear; this is the last one.
    Visibility,
}

/// End of a sector: the labelled point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectorEnd {
    /// Direction of the sector, from the global x axis to the left, radians.
    pub direction: f64,
    /// Distance of the point from the grid's centre, metres.
    pub radius: f64,
    /// The point, global x and y, metres.
    pub point: DVec2,
    /// Label of the point: the reason why testing stopped there.
    pub label: Label,
    /// Failed test of an obstacle point; otherwise `None`. At a point too near a limit to tell it is that of the next
    /// point of the sector.
    pub failed: Option<TraversabilityTest>,
    /// What is missing at an unknown point; otherwise `None`.
    pub missing: Option<Missing>,
}

/// Obstacle map: the labelled points of all sectors.
#[derive(Debug, Clone, PartialEq)]
pub struct ObstacleMap {
    /// Centre of the radial grid, global x and y, metres.
    pub centre: DVec2,
    /// End of each sector, from right to left.
    pub sectors: Vec<SectorEnd>,
}

/// Whether a frame makes an obstacle map: one frame in `every`, beginning with frame 0. "The obstacle regions are not
/// extracted from the LTM every camera frame but at after a fixed number of the frames." (§7)
pub fn obstacle_map_due(frame: u64, every: u64) -> bool {
    frame.is_multiple_of(every.max(1))
}

/// Default number of frames from one obstacle map to the next. CHOICE: 10, one second, in which the default route
/// advances by 0.3 m.
pub const FRAMES_PER_OBSTACLE_MAP: u64 = 10;

impl ObstacleMap {
    /// Extracts the obstacle map around a vehicle with the estimated pose `global_from_vehicle`. "Points on the radial
    /// grid are tested as to whether they belong to an obstacle region in order of increasing radii along each of the
    /// sectors." (§7)
    ///
    /// ```
    /// use glam::DVec2;
    /// use raypencil_rover::{
    ///     ElevationMap, Label, MapSize, ObstacleMap, RadialGrid, TraversabilityRules, Vehicle,
    /// };
    /// use raypencil_scene::Pose;
    ///
    /// // Level ground that is known up to x = 4 m. The vehicle is at the map's origin and looks along x. No point of
    /// // the imaginary vehicle lies before its front axle: 4.1 m is the first radius ahead with an unknown point.
    /// let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
    /// for point in map.points().filter(|point| point.i <= 40) {
    ///     map.set_proximity(point, 0.0);
    /// }
    /// let vehicle = Vehicle::default();
    /// let (rules, grid) = (TraversabilityRules::as_printed(&vehicle), RadialGrid::for_vehicle(&vehicle));
    /// let obstacles = ObstacleMap::extract(&map, &vehicle, &rules, &grid, &Pose::IDENTITY);
    /// let ahead = obstacles.sectors[15];
    /// assert_eq!(ahead.label, Label::Unknown);
    /// assert!((ahead.radius - 4.1).abs() < 1e-9);
    /// ```
    pub fn extract(
        map: &ElevationMap,
        vehicle: &Vehicle,
        rules: &TraversabilityRules,
        grid: &RadialGrid,
        global_from_vehicle: &Pose,
    ) -> Self {
        let centre = global_from_vehicle.position.truncate();
        let map = MapWithShadows::of(map);
        let sector = |index| {
            let (direction, unit) = grid.direction(index, global_from_vehicle);
            let end = |radius, label| {
                let point = centre + unit * radius;
                SectorEnd { direction, radius, point, label, failed: None, missing: None }
            };
            let mut points = grid.classify_sector(index, &map, vehicle, rules, global_from_vehicle);
            while let Some((radius, traversability)) = points.next() {
                match traversability {
                    // "... and testing for that sector stops." (§7)
                    Traversability::Obstacle(test) => {
                        return SectorEnd { failed: Some(test), ..end(radius, Label::Obstacle) };
                    }
                    Traversability::Unknown(missing) => {
                        // CHOICE: an obstacle rises over several radii, so the point before a certain one is often too
                        // near a limit to tell, by the errors of the points or by what may stand between them. Such an
                        // obstacle begins there. The clear way is the same either way.
                        if matches!(missing.reason, MissingReason::NearLimit | MissingReason::MayHide)
                            && let Some((_, Traversability::Obstacle(test))) = points.next()
                        {
                            return SectorEnd { failed: Some(test), ..end(radius, Label::Obstacle) };
                        }
                        return SectorEnd { missing: Some(missing), ..end(radius, Label::Unknown) };
                    }
                    // "... and testing for that sector continues unless that point is the last one of the sector, in
                    // which case, the point is labelled as a visibility limit." (§7)
                    Traversability::Clear => {}
                }
            }
            end(grid.radius(grid.radii() - 1), Label::Visibility)
        };
        Self { centre, sectors: (0..grid.sectors).into_par_iter().map(sector).collect() }
    }
}
