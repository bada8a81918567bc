//! The obstacle map: a radial grid over the local terrain map, tested outwards along each sector. (Paper, §7)

use glam::DVec2;
use raypencil_scene::{Pose, SceneError};

use crate::check::{check_count, check_range};
use crate::local_map::LocalMap;
use crate::passable::{PassableRules, Test, Verdict};
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
const MOST_POINTS: u32 = 10_000_000;

impl RadialGrid {
    /// CHOICE: 31 sectors over the 60 degrees of the beams' fan, 2 degrees apart, about the vehicle's origin; radii a
    /// grid spacing of 0.1 m apart, so that no grid point is stepped over; from one step before the front axle to
    /// 5 m, just inside the far stripe of the default rig on level ground (5.25 m), so that what it brings is enough
    /// to be clear.
    pub fn of(vehicle: &Vehicle) -> Self {
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
    pub fn verdicts(
        &self,
        sector: u32,
        map: &LocalMap,
        vehicle: &Vehicle,
        rules: &PassableRules,
        global_from_vehicle: &Pose,
    ) -> impl Iterator<Item = (f64, Verdict)> {
        let (_, unit) = self.direction(sector, global_from_vehicle);
        let centre = global_from_vehicle.position.truncate();
        (0..self.radii()).map(move |index| {
            let radius = self.radius(index);
            (radius, rules.judge(map, vehicle, centre + unit * radius, unit))
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
        let most = MOST_POINTS / radii;
        if self.sectors > most {
            let expected = format!("1 to {most}: {MOST_POINTS} points at most, {radii} radii each");
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
    pub failed: Option<Test>,
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
/// but at after a fixed number of the frames." (§7) CHOICE: `every` = [`OBSTACLE_FRAMES`].
pub fn obstacle_map_due(frame: u64, every: u64) -> bool {
    frame.is_multiple_of(every.max(1))
}

/// CHOICE: every 10 frames, once a second: the default route moves on by 0.3 m.
pub const OBSTACLE_FRAMES: u64 = 10;

impl ObstacleMap {
    /// Tests the radial grid around a vehicle believed to be at `global_from_vehicle`. "Points on the radial grid are
    /// tested as to whether they belong to an obstacle region in order of increasing radii along each of the
    /// sectors." (§7)
    pub fn of(
        map: &LocalMap,
        vehicle: &Vehicle,
        rules: &PassableRules,
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
            for (radius, verdict) in grid.verdicts(index, map, vehicle, rules, global_from_vehicle) {
                match verdict {
                    // "... and testing for that sector stops." (§7)
                    Verdict::Obstacle(test) => return end(radius, Label::Obstacle, Some(test)),
                    Verdict::Unknown => return end(radius, Label::Unknown, None),
                    // "... and testing for that sector continues unless that point is the last one of the sector, in
                    // which case, the point is labelled as a visibility limit." (§7)
                    Verdict::Clear => {}
                }
            }
            end(grid.radius(grid.radii() - 1), Label::Visibility, None)
        };
        Self { centre, sectors: (0..grid.sectors).map(sector).collect() }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::local_map::MapSize;

    fn map(elevation: impl Fn(f64, f64) -> Option<f64>) -> LocalMap {
        let mut map = LocalMap::new(MapSize::default(), DVec2::ZERO);
        for point in map.points() {
            let place = map.place(point);
            if let Some(z) = elevation(place.x, place.y) {
                map.give(point, z);
            }
        }
        map
    }

    fn obstacles(map: &LocalMap, heading: f64) -> ObstacleMap {
        let vehicle = Vehicle::default();
        let (rules, grid) = (PassableRules::of(&vehicle), RadialGrid::of(&vehicle));
        let pose = Pose::from_axis_angle(DVec3::Z, heading);
        ObstacleMap::of(map, &vehicle, &rules, &grid, &pose)
    }

    #[test]
    fn on_level_ground_every_sector_ends_at_the_visibility_limit() {
        let all = obstacles(&map(|_, _| Some(0.0)), 0.0);
        assert_eq!(all.sectors.len(), 31);
        for sector in &all.sectors {
            assert_eq!((sector.label, sector.failed), (Label::Visibility, None));
            assert!((sector.radius - 5.0).abs() < 1e-12);
        }
        // From right to left, 2 degrees apart, the middle one straight ahead.
        assert!((all.sectors[0].direction + 30.0_f64.to_radians()).abs() < 1e-12);
        assert!(all.sectors[15].direction.abs() < 1e-12);
        assert!((all.sectors[30].point - DVec2::new(5.0 * 0.75_f64.sqrt(), 2.5)).length() < 1e-12);
    }

    #[test]
    fn a_step_of_0_4_m_is_an_obstacle_and_one_of_0_1_m_is_not() {
        // From x = 3 on. Straight ahead: c) from axle to axle fails when the front axle's grid point is at 3 or beyond
        // and the rear one's is not, 0.4 over 1.2 m against 0.35 over 1.2 m. Radius 3.0 is 0.7 + 23 * 0.1.
        let high = map(|x, _| Some(if x > 2.95 { 0.4 } else { 0.0 }));
        let ahead = obstacles(&high, 0.0).sectors[15];
        assert_eq!((ahead.label, ahead.failed), (Label::Obstacle, Some(Test::Length)));
        assert!((ahead.radius - 3.0).abs() < 1e-9);
        // Aslant, one front wheel meets it first: a), 0.4 over 1.0 m. At 30 degrees to the left that is the right one,
        // 3 = r cos 30 + 0.5 sin 30.
        let aside = obstacles(&high, 0.0).sectors[30];
        assert_eq!((aside.label, aside.failed), (Label::Obstacle, Some(Test::Front)));
        let r = 2.75 / 0.75_f64.sqrt();
        assert!((aside.radius - r).abs() <= 0.16, "{} for {r}", aside.radius);
        let low = map(|x, _| Some(if x > 2.95 { 0.1 } else { 0.0 }));
        assert!(obstacles(&low, 0.0).sectors.iter().all(|sector| sector.label == Label::Visibility));
    }

    #[test]
    fn testing_stops_at_the_first_point_that_is_not_clear() {
        // Unknown from x = 2 on, a wall from x = 3 on: the wall is never reached.
        let hidden = map(|x, _| (x < 1.95).then_some(0.0).or((x > 2.95).then_some(2.0)));
        let ahead = obstacles(&hidden, 0.0).sectors[15];
        assert_eq!((ahead.label, ahead.failed), (Label::Unknown, None));
        assert!((ahead.radius - 2.0).abs() < 1e-9);
    }

    #[test]
    fn the_grid_turns_with_the_vehicle_and_the_map_does_not() {
        // A wall in the north, beyond y = 3: seen when heading along +y.
        let wall = map(|_, y| Some(if y > 2.95 { 1.0 } else { 0.0 }));
        let north = obstacles(&wall, std::f64::consts::FRAC_PI_2);
        assert_eq!(north.sectors[15].label, Label::Obstacle);
        assert!((north.sectors[15].point - DVec2::new(0.0, 3.0)).length() < 1e-9);
        assert_eq!(obstacles(&wall, 0.0).sectors[15].label, Label::Visibility);
    }

    #[test]
    fn every_tenth_frame() {
        let due: Vec<u64> = (0..35).filter(|&frame| obstacle_map_due(frame, OBSTACLE_FRAMES)).collect();
        assert_eq!(due, [0, 10, 20, 30]);
    }

    #[test]
    fn a_grid_that_is_none_is_named() {
        let grid = RadialGrid::of(&Vehicle::default());
        assert!(grid.validate("grid").is_ok());
        let short = RadialGrid { last: 0.1, ..grid };
        assert!(short.validate("grid").unwrap_err().to_string().starts_with("grid.last is 0.1"));
    }

    #[test]
    fn a_grid_of_too_many_points_is_refused() {
        // From 1 to 100.75 by 1/4: 400 radii, first and last among them. 25,000 sectors make ten million points.
        let grid = RadialGrid { sectors: 25_000, half_angle: 1.0, first: 1.0, step: 0.25, last: 100.75 };
        assert_eq!(grid.radii(), 400);
        assert!(grid.validate("grid").is_ok());
        let error = RadialGrid { sectors: 25_001, ..grid }.validate("grid").unwrap_err().to_string();
        assert_eq!(
            error,
            "grid.sectors is 25001: expected 1 to 25000: 10000000 points at most, 400 radii each"
        );
        // The most radii, 1,000,001, leave 9 sectors.
        let long = RadialGrid { sectors: 10, first: 0.0, step: 1e-3, last: 1e3, ..grid };
        assert!(long.validate("grid").unwrap_err().to_string().contains("expected 1 to 9: "));
        assert!(RadialGrid { sectors: 9, ..long }.validate("grid").is_ok());
    }
}
