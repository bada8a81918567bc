//! Obstacle map as an occupancy grid: radial sectors become square cells.

use glam::{DVec2, DVec3};
use raypencil_rover::{ElevationMap, Label, ObstacleMap, RadialGrid, Vehicle};
use raypencil_scene::Pose;

use crate::maps::occupancy::{Occupancy, OccupancyGrid};

/// Occupancy of the elevation map's cells, each around its grid point, by the middle of the vehicle's front axle.
/// `global_from_vehicle` is the pose from which `obstacles` were extracted.
///
/// A cell belongs to the nearest sector. It is free if its nearest tested radius lies before the sector's end, occupied at an end
/// that is an obstacle, and unknown elsewhere. Nearer than half a step before the first radius, and outside the fan, cells under the
/// vehicle are free. A cell that is too far from all tested places is unknown (`tested_within`).
///
/// ```
/// use glam::DVec2;
/// use raypencil_drive::{Occupancy, occupancy_grid};
/// use raypencil_rover::{ElevationMap, MapSize, ObstacleMap, RadialGrid, TraversabilityRules, Vehicle};
/// use raypencil_scene::Pose;
///
/// // Level ground with a step of 1 m at x = 3 m, 201 cells of 0.1 m around the vehicle.
/// let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
/// for point in map.points() {
///     map.set_proximity(point, if map.place(point).x > 2.95 { 1.0 } else { 0.0 });
/// }
/// let vehicle = Vehicle::default();
/// let (rules, grid) = (TraversabilityRules::as_printed(&vehicle), RadialGrid::for_vehicle(&vehicle));
/// let obstacles = ObstacleMap::extract(&map, &vehicle, &rules, &grid, &Pose::IDENTITY);
/// let cells = occupancy_grid(&map, &obstacles, &grid, &vehicle, &Pose::IDENTITY).cells;
/// // Row 100 lies straight ahead, and column 100 + 10 x is at x metres: before, at and behind the step.
/// let ahead = |x: usize| cells[100 * 201 + 100 + 10 * x];
/// assert_eq!([2, 3, 4].map(ahead), [Occupancy::Free, Occupancy::Occupied, Occupancy::Unknown]);
/// ```
pub fn occupancy_grid(
    map: &ElevationMap,
    obstacles: &ObstacleMap,
    grid: &RadialGrid,
    vehicle: &Vehicle,
    global_from_vehicle: &Pose,
) -> OccupancyGrid {
    let spacing = map.size().spacing;
    let first = map.points().next().map_or(DVec2::ZERO, |point| map.place(point));
    let vehicle_from_global = global_from_vehicle.inverse();
    let forward = global_from_vehicle.rotate(DVec3::X);
    let heading = libm::atan2(forward.y, forward.x);
    // CHOICE: three quarters of a step to either side of a sector's end, so that the occupied cells touch one another.
    let reach = 0.75 * grid.step.max(spacing);
    let [ahead, aside] = tested_within(vehicle);
    let cell = |place: DVec2| {
        let offset = place - obstacles.centre;
        let radius = offset.length();
        let sector = nearest_sector(grid, libm::atan2(offset.y, offset.x) - heading);
        // From the first radius on, a sector knows more of the front axle than the rectangle of the wheels, which reaches farther ahead.
        let Some(sector) = sector.filter(|_| radius >= grid.first - 0.5 * grid.step) else {
            let stands = vehicle.covers(vehicle_from_global.rotate(offset.extend(0.0)).truncate());
            return if stands { Occupancy::Free } else { Occupancy::Unknown };
        };
        let end = &obstacles.sectors[sector];
        let (sin, cos) = libm::sincos(end.direction);
        let steps = ((radius - grid.first) / grid.step).round().clamp(0.0, f64::from(grid.radii() - 1));
        let from_tested = (radius - grid.radius(steps as u32)).abs();
        match end.label {
            // Nothing was tested between two sectors that are far apart, nor between two radii.
            _ if DVec2::new(cos, sin).perp_dot(offset).abs() > aside => Occupancy::Unknown,
            Label::Obstacle if (radius - end.radius).abs() <= reach => Occupancy::Occupied,
            _ if from_tested > ahead => Occupancy::Unknown,
            Label::Visibility if radius <= end.radius + 0.5 * grid.step => Occupancy::Free,
            _ if radius < end.radius - 0.5 * grid.step => Occupancy::Free,
            _ => Occupancy::Unknown,
        }
    };
    OccupancyGrid {
        columns: map.size().points,
        rows: map.size().points,
        resolution: spacing,
        origin: (first - DVec2::splat(0.5 * spacing)).to_array(),
        cells: map.points().map(|point| cell(map.place(point))).collect(),
    }
}

/// How far from a tested place a cell may be, ahead and aside, metres: half of a wheel's length and of its width.
///
/// CHOICE: a place speaks for the ground that its wheels stood on. Between two tested places that are farther apart than a
/// wheel is long or wide, a strip of ground is left that no wheel was tested on: a post there meets none of them.
pub(crate) fn tested_within(vehicle: &Vehicle) -> [f64; 2] {
    [vehicle.wheel_radius, 0.5 * vehicle.wheel_width]
}

/// Index of the sector nearest to an angle from the heading, radians. `None` if the angle is outside the fan.
fn nearest_sector(grid: &RadialGrid, angle: f64) -> Option<usize> {
    use std::f64::consts::TAU;
    let angle = angle - TAU * (angle / TAU).round();
    let between = if grid.sectors < 2 { 0.1 } else { 2.0 * grid.half_angle / f64::from(grid.sectors - 1) };
    let sector = if grid.sectors < 2 { angle / between } else { (angle + grid.half_angle) / between };
    let sector = sector.round();
    (sector >= 0.0 && sector < f64::from(grid.sectors)).then_some(sector as usize)
}

#[cfg(test)]
mod tests {
    use raypencil_rover::{MapSize, TraversabilityRules};

    use super::*;

    #[test]
    fn cells_are_free_before_a_wall_occupied_at_it_and_unknown_behind_it() {
        let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
        for point in map.points() {
            let z = if map.place(point).x > 2.95 { 1.0 } else { 0.0 };
            map.set_proximity(point, z);
        }
        let vehicle = Vehicle::default();
        let (rules, grid) = (TraversabilityRules::as_printed(&vehicle), RadialGrid::for_vehicle(&vehicle));
        let obstacles = ObstacleMap::extract(&map, &vehicle, &rules, &grid, &Pose::IDENTITY);
        let cells = occupancy_grid(&map, &obstacles, &grid, &vehicle, &Pose::IDENTITY);
        // 201 x 201 cells of 0.1 m around the origin.
        assert_eq!((cells.columns, cells.resolution), (201, 0.1));
        assert!((cells.origin[0] + 10.05).abs() < 1e-12 && (cells.origin[1] + 10.05).abs() < 1e-12);
        let at =
            |x: f64, y: f64| cells.cells[(((y + 10.05) / 0.1) as usize) * 201 + ((x + 10.05) / 0.1) as usize];
        assert_eq!(at(0.0, 0.0), Occupancy::Free);
        assert_eq!(at(2.0, 0.0), Occupancy::Free);
        assert_eq!(at(3.0, 0.0), Occupancy::Occupied);
        assert_eq!(at(4.0, 0.0), Occupancy::Unknown);
        // Outside the fan of 30 degrees to either side, and behind the vehicle.
        assert_eq!((at(2.0, 2.0), at(-3.0, 0.0)), (Occupancy::Unknown, Occupancy::Unknown));
        // With a grid that begins at 2 m, nothing nearer was tested.
        let far = RadialGrid { first: 2.0, ..grid };
        let obstacles = ObstacleMap::extract(&map, &vehicle, &rules, &far, &Pose::IDENTITY);
        let cells = occupancy_grid(&map, &obstacles, &far, &vehicle, &Pose::IDENTITY);
        let at =
            |x: f64, y: f64| cells.cells[(((y + 10.05) / 0.1) as usize) * 201 + ((x + 10.05) / 0.1) as usize];
        assert_eq!((at(0.0, 0.0), at(1.5, 0.0)), (Occupancy::Free, Occupancy::Unknown));
        assert_eq!((at(2.5, 0.0), at(3.0, 0.0)), (Occupancy::Free, Occupancy::Occupied));
    }

    /// Cells of level ground with a wall at x = `wall`, metres, for a changed grid: the one at a place.
    fn before_a_wall(wall: f64, change: impl Fn(RadialGrid) -> RadialGrid) -> impl Fn(f64, f64) -> Occupancy {
        let mut map = ElevationMap::new(MapSize::default(), DVec2::ZERO);
        for point in map.points() {
            map.set_proximity(point, if map.place(point).x > wall { 1.0 } else { 0.0 });
        }
        let vehicle = Vehicle::default();
        let rules = TraversabilityRules::as_printed(&vehicle);
        let grid = change(RadialGrid::for_vehicle(&vehicle));
        let obstacles = ObstacleMap::extract(&map, &vehicle, &rules, &grid, &Pose::IDENTITY);
        let cells = occupancy_grid(&map, &obstacles, &grid, &vehicle, &Pose::IDENTITY).cells;
        move |x, y| cells[(((y + 10.05) / 0.1) as usize) * 201 + ((x + 10.05) / 0.1) as usize]
    }

    #[test]
    fn an_obstacle_within_the_rectangle_of_the_wheels_is_occupied() {
        use Occupancy::{Free, Occupied, Unknown};
        // The wheels reach 0.95 m ahead of the origin, the front axle is tested from 0.7 m on, and by the printed rules it may come up to
        // the wall, 0.9 m ahead.
        let at = before_a_wall(0.85, |grid| grid);
        let ahead = [0.0, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0].map(|x| at(x, 0.0));
        assert_eq!(ahead, [Free, Free, Free, Free, Free, Occupied, Unknown]);
        // Outside the fan the vehicle stands, and nothing else is known.
        assert_eq!([0.5, 0.6, 0.7].map(|y| at(0.5, y)), [Free, Free, Unknown]);
    }

    #[test]
    fn cells_between_sectors_that_are_far_apart_are_unknown() {
        use Occupancy::{Free, Occupied, Unknown};
        // Sectors at -30, 0 and 30 degrees. A wheel is 0.25 m wide: cells within 0.125 m of a sector's line were tested.
        let at = before_a_wall(2.95, |grid| RadialGrid { sectors: 3, ..grid });
        assert_eq!([0.0, 0.1, 0.2, 0.5, -0.2].map(|y| at(2.0, y)), [Free, Free, Unknown, Unknown, Unknown]);
        // The left sector's line is at y = 1.155 m there. 0.1 m along y are 0.087 m to its side.
        assert_eq!([1.0, 1.1, 1.2, 1.3, 1.4].map(|y| at(2.0, y)), [Unknown, Free, Free, Unknown, Unknown]);
        // Nor does anybody know where between two sectors an obstacle goes on.
        assert_eq!([0.0, 0.1, 0.2, 0.5].map(|y| at(3.0, y)), [Occupied, Occupied, Unknown, Unknown]);
        // A sector alone has 0.05 rad to either side: 0.2 m at 4 m.
        let one = before_a_wall(20.0, |grid| RadialGrid { sectors: 1, ..grid });
        assert_eq!([0.0, 0.1, 0.2].map(|y| one(4.0, y)), [Free, Free, Unknown]);
        // Sectors 2 degrees apart leave no strip: a cell is at most 4.8 m * sin 1 degree = 0.084 m beside one.
        let all = before_a_wall(20.0, |grid| grid);
        for (n, m) in (11..=48).flat_map(|n| (0..=n / 2).map(move |m| (n, m))) {
            let (x, y) = (0.1 * f64::from(n), 0.1 * f64::from(m));
            assert!(libm::hypot(x, y) > 4.8 || all(x, y) == Free, "{x} {y}");
        }
    }

    #[test]
    fn cells_between_radii_that_are_far_apart_are_unknown() {
        use Occupancy::{Free, Occupied, Unknown};
        // Radii of 0.7, 1.7, 2.7 and 3.7 m, where the front axle is on the wall. A wheel reaches 0.35 m ahead and behind.
        let at = before_a_wall(2.95, |grid| RadialGrid { step: 1.0, ..grid });
        let ahead = [1.7, 2.0, 2.1, 2.2, 2.3, 2.4, 2.7, 3.0].map(|x| at(x, 0.0));
        assert_eq!(ahead, [Free, Free, Unknown, Unknown, Unknown, Free, Free, Occupied]);
        // Half a step beyond the last radius is more than a wheel reaches: 4.7 m.
        let clear = before_a_wall(20.0, |grid| RadialGrid { step: 1.0, ..grid });
        assert_eq!([4.7, 5.0, 5.1].map(|x| clear(x, 0.0)), [Free, Free, Unknown]);
    }
}
