//! The gap problem: an estimate of the elevation of ground that was not seen. (Paper, §7)

use crate::bend::{bend_up, top_of};
use crate::elevation_map::{ElevationMap, ElevationSource, GridPoint, is_measured};

/// Rule for narrow gaps, the solution that the paper leaves open: "A more general solution, which we have not yet
/// implemented, is to allow the vehicle to go over the gaps that are less than one wheel thickness wide. To test if the
/// gap contains elevations that are too high for the vehicle, an upper estimate of the maximum elevation of the gap
/// region can be computed from the height of the occluding terrain feature or by using elevations from successive
/// stripes bracketing the gap region." (§7)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapRule {
    /// Maximum width of a gap that may be crossed, metres: one wheel thickness.
    pub max_width: f64,
}

/// Directions of the four lines through a grid point (row, column, both diagonals): i, j, length in grid spacings.
const GAP_DIRECTIONS: [(i64, i64, f64); 4] =
    [(1, 0, 1.0), (0, 1, 1.0), (1, 1, std::f64::consts::SQRT_2), (1, -1, std::f64::consts::SQRT_2)];

impl GapRule {
    /// Upper estimate of the elevation at a grid point that was not measured, metres. `None` if the gap there is too wide.
    ///
    /// The width of a gap is the shortest run of unmeasured grid points through it, along a row, a column or a diagonal.
    /// A long crack is therefore as wide as it is across. Extrapolated elevations are guesses: they bracket no gap, and
    /// they close none. The depth does not matter, since a wheel bridges the gap. The height matters: the estimate is the
    /// higher of the two measured points that bracket the run, the highest of all runs that are narrow enough; and what may
    /// hide in a shadow there, if that is more ([`MapWithShadows::ceiling`]).
    ///
    /// CHOICE: the width of a run is its number of unmeasured points times its step. Beyond the map nothing is known.
    pub fn upper_estimate(&self, shadows: &MapWithShadows, point: GridPoint) -> Option<f64> {
        let map = shadows.map();
        let spacing = map.size().spacing;
        let mut estimate: Option<f64> = None;
        for (i, j, step) in GAP_DIRECTIONS {
            let max_steps = (self.max_width / (step * spacing) + 1e-9).floor() as i64;
            // The nearest measured point in this direction: the number of others before it, and its elevation.
            let bracket = |sign: i64| {
                (1..=max_steps).find_map(|n| {
                    let at = GridPoint { i: point.i + sign * n * i, j: point.j + sign * n * j };
                    is_measured(map, at).then(|| top_of(map, at).map(|top| (n - 1, at, top.z))).flatten()
                })
            };
            let (Some((before, near_at, near)), Some((beyond, far_at, far))) = (bracket(-1), bracket(1))
            else {
                continue;
            };
            if before + 1 + beyond <= max_steps {
                let bend = bend_up(map, near_at, far_at, (i, j)).map(|bend| bend.z);
                let higher = near.max(far).max(bend.unwrap_or(f64::NEG_INFINITY));
                estimate = Some(estimate.map_or(higher, |top| top.max(higher)));
            }
        }
        estimate.map(|top| shadows.ceiling(point).map_or(top, |hidden| top.max(hidden)))
    }
}

/// Farthest that a shadow is followed, metres. CHOICE: behind a rock of half a metre, seen from 2 m up, it is shorter
/// within the reach of the stripes.
const MAX_SHADOW_M: f64 = 2.0;

/// A map, and how high unmeasured ground of it can be at most.
///
/// A point that was measured was lit by its beam and seen by the camera: nothing between it and them stands above the
/// flatter of the two lines of sight. So each measured point bounds the ground in the shadow before it.
#[derive(Debug, Clone)]
pub struct MapWithShadows<'a> {
    map: &'a ElevationMap,
    /// Greatest height of each cell's ground, metres; infinite where no line of sight passes.
    ceilings: Vec<f64>,
}

impl<'a> MapWithShadows<'a> {
    /// Follows the lines of sight of all measured points back through the unmeasured cells before them.
    pub fn of(map: &'a ElevationMap) -> Self {
        let mut ceilings = vec![f64::INFINITY; map.cells.len()];
        let spacing = map.size().spacing;
        // Half a cell a step meets every cell on the way.
        let step = 0.5 * spacing;
        let steps = (MAX_SHADOW_M / step) as u32;
        for point in map.points() {
            let cell = map.cell(point);
            let Some(sight) = cell.sight.filter(|_| cell.source == ElevationSource::Measured) else {
                continue;
            };
            for n in 1..=steps {
                let way = f64::from(n) * step;
                let at = map.nearest(cell.place + sight.towards * way);
                if at == point {
                    continue;
                }
                if !map.contains(at) || is_measured(map, at) {
                    break;
                }
                // The far side of the cell is where the line is highest over it.
                let height = cell.elevation + sight.slope.max(0.0) * (way + spacing);
                let ceiling = &mut ceilings[map.index(at)];
                *ceiling = ceiling.min(height);
            }
        }
        Self { map, ceilings }
    }

    /// The map.
    pub fn map(&self) -> &'a ElevationMap {
        self.map
    }

    /// Height that unmeasured ground at a grid point can have at most, metres. `None` if no line of sight passes it.
    pub fn ceiling(&self, point: GridPoint) -> Option<f64> {
        let ceiling = self.map.contains(point).then(|| self.ceilings[self.map.index(point)])?;
        ceiling.is_finite().then_some(ceiling)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::elevation_map::MapSize;

    /// A map of 21 by 21 points, known where `known` gives an elevation.
    fn map(known: impl Fn(i64, i64) -> Option<f64>) -> ElevationMap {
        let mut map = ElevationMap::new(MapSize { spacing: 0.1, points: 21 }, DVec2::ZERO);
        for point in map.points() {
            if let Some(z) = known(point.i, point.j) {
                map.set_proximity(point, z);
            }
        }
        map
    }

    const RULE: GapRule = GapRule { max_width: 0.25 };

    #[test]
    fn a_crack_two_points_wide_is_bridged_and_one_of_three_is_not() {
        // Columns 0 and 1 are unknown: a gap 0.2 m wide, between 0.1 m at i = -1 and 0.3 m at i = 2. Along a diagonal
        // it is 2 steps of 0.141 m, more than 0.25 m.
        let two = map(|i, _| (!(0..=1).contains(&i)).then_some(if i < 0 { 0.1 } else { 0.3 }));
        assert_eq!(RULE.upper_estimate(&MapWithShadows::of(&two), GridPoint { i: 0, j: 0 }), Some(0.3));
        assert_eq!(RULE.upper_estimate(&MapWithShadows::of(&two), GridPoint { i: 1, j: 5 }), Some(0.3));
        let three = map(|i, _| (!(0..=2).contains(&i)).then_some(0.1));
        for i in 0..=2 {
            assert_eq!(RULE.upper_estimate(&MapWithShadows::of(&three), GridPoint { i, j: 0 }), None);
        }
    }

    #[test]
    fn a_single_hidden_point_takes_the_highest_neighbour() {
        // One unknown point; one diagonal neighbour is at 0.5 m, all others are at 0.
        let one = map(|i, j| match (i, j) {
            (0, 0) => None,
            (1, -1) => Some(0.5),
            _ => Some(0.0),
        });
        assert_eq!(RULE.upper_estimate(&MapWithShadows::of(&one), GridPoint { i: 0, j: 0 }), Some(0.5));
    }

    #[test]
    fn points_beyond_the_map_bracket_no_gap() {
        let border = map(|i, _| (i < 10).then_some(0.0));
        assert_eq!(RULE.upper_estimate(&MapWithShadows::of(&border), GridPoint { i: 10, j: 0 }), None);
    }
}
