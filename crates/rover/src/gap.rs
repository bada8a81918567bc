//! The gap problem: what may be said of ground that nobody saw. (Paper, §7)

use crate::elevation_map::{ElevationMap, GridPoint};

/// The more general solution that the paper leaves open: "A more general solution, which we have not yet implemented,
/// is to allow the vehicle to go over the gaps that are less than one wheel thickness wide. To test if the gap
/// contains elevations that are too high for the vehicle, an upper estimate of the maximum elevation of the gap region
/// can be computed from the height of the occluding terrain feature or by using elevations from successive stripes
/// bracketing the gap region." (§7)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapRule {
    /// Gaps this wide and less may be crossed, metres: one wheel thickness.
    pub max_width: f64,
}

/// The four lines through a grid point: along the rows, the columns and both diagonals, and their steps in spacings.
const GAP_DIRECTIONS: [(i64, i64, f64); 4] =
    [(1, 0, 1.0), (0, 1, 1.0), (1, 1, std::f64::consts::SQRT_2), (1, -1, std::f64::consts::SQRT_2)];

impl GapRule {
    /// An upper estimate of the elevation at a grid point that is not known, if the gap there is narrow enough to be
    /// crossed.
    ///
    /// The gap's width is that of the shortest run of unknown grid points through it along a row, a column or a
    /// diagonal; a long crack is as wide as it is across. A wheel bridges it: how deep it is does not matter. How high
    /// it is does: of a run that is narrow enough, the estimate is the higher of the known points that bracket it, and
    /// of several runs the highest. That is both of the paper's estimates: what hides a gap from beam or camera is the
    /// bracket on their side of it, and ground in its shadow that stood above the line from its top to the first
    /// point seen beyond would itself hide that point.
    ///
    /// CHOICE: runs are measured as unknown points times their step. Brackets beyond the map are unknown.
    pub fn upper_estimate(&self, map: &ElevationMap, point: GridPoint) -> Option<f64> {
        let spacing = map.size().spacing;
        let mut highest: Option<f64> = None;
        for (i, j, step) in GAP_DIRECTIONS {
            let most = (self.max_width / (step * spacing) + 1e-9).floor() as i64;
            // The nearest known point that way, and how many unknown ones come before it.
            let bracket = |sign: i64| {
                (1..=most).find_map(|n| {
                    let at = GridPoint { i: point.i + sign * n * i, j: point.j + sign * n * j };
                    map.elevation(at).map(|z| (n - 1, z))
                })
            };
            let (Some((before, near)), Some((beyond, far))) = (bracket(-1), bracket(1)) else { continue };
            if before + 1 + beyond <= most {
                let higher = near.max(far);
                highest = Some(highest.map_or(higher, |top| top.max(higher)));
            }
        }
        highest
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::elevation_map::MapSize;

    /// A map of 21 points, known where `known` gives an elevation.
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
        // Columns 0 and 1 unknown all along: 0.2 m wide, bracketed by 0.1 at i = -1 and 0.3 at i = 2. The diagonals
        // are 2 steps of 0.141 m, more than 0.25 m.
        let two = map(|i, _| (!(0..=1).contains(&i)).then_some(if i < 0 { 0.1 } else { 0.3 }));
        assert_eq!(RULE.upper_estimate(&two, GridPoint { i: 0, j: 0 }), Some(0.3));
        assert_eq!(RULE.upper_estimate(&two, GridPoint { i: 1, j: 5 }), Some(0.3));
        let three = map(|i, _| (!(0..=2).contains(&i)).then_some(0.1));
        for i in 0..=2 {
            assert_eq!(RULE.upper_estimate(&three, GridPoint { i, j: 0 }), None);
        }
    }

    #[test]
    fn a_single_hidden_point_takes_the_highest_neighbour() {
        // One unknown point; a rock of 0.5 m on one diagonal neighbour, ground at 0 elsewhere.
        let one = map(|i, j| match (i, j) {
            (0, 0) => None,
            (1, -1) => Some(0.5),
            _ => Some(0.0),
        });
        assert_eq!(RULE.upper_estimate(&one, GridPoint { i: 0, j: 0 }), Some(0.5));
    }

    #[test]
    fn beyond_the_map_nothing_brackets() {
        let border = map(|i, _| (i < 10).then_some(0.0));
        assert_eq!(RULE.upper_estimate(&border, GridPoint { i: 10, j: 0 }), None);
    }
}
