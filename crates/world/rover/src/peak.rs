//! What may stand between two measured points: ground that no stripe met, because it lies between two stripes.

use glam::DVec3;

use crate::elevation_map::{ElevationMap, GridPoint, is_measured};

/// Steepest rise that is continued beyond a measured point, rise over distance. CHOICE: 45 degrees. What is steeper is an
/// edge, and an edge does not go on.
const MAX_CONTINUED_SLOPE: f64 = 1.0;

/// Highest place that the ground between two neighbouring measured grid points may have, global, metres: where the rises that
/// lead up to both meet if they go on. `None` if it does not rise to both, or if the points beyond are not measured.
///
/// A stone whose top lies between two stripes is met on its flanks alone, and both flanks rise towards what was not met. A step
/// is level on one side, and a plane rises on one side alone: there the straight line between the points is all.
pub(crate) fn peak_between(
    map: &ElevationMap,
    from: GridPoint,
    to: GridPoint,
    step: (i64, i64),
) -> Option<DVec3> {
    // A diagonal through the corner of a level stone falls on both sides of two cells, too.
    if step.0 != 0 && step.1 != 0 {
        return None;
    }
    let beside =
        |point: GridPoint, sign: i64| GridPoint { i: point.i + sign * step.0, j: point.j + sign * step.1 };
    let at = |point: GridPoint| is_measured(map, point).then(|| highest(map, point)).flatten();
    let [before, near, far, after] = [at(beside(from, -1))?, at(from)?, at(to)?, at(beside(to, 1))?];
    let rise = |foot: DVec3, top: DVec3| {
        let distance = (top - foot).truncate().length();
        if distance > 0.0 { ((top.z - foot.z) / distance).min(MAX_CONTINUED_SLOPE) } else { 0.0 }
    };
    let (up, down) = (rise(before, near), rise(after, far));
    if up <= 0.0 || down <= 0.0 {
        return None;
    }
    let length = (far - near).truncate().length();
    let way = (far.z - near.z + down * length) / (up + down);
    if !(0.0..=length).contains(&way) || length == 0.0 {
        return None;
    }
    let place = near.truncate() + (far - near).truncate() * (way / length);
    Some(place.extend(near.z + up * way))
}

/// Highest point that was measured in a cell; as printed, the only one.
pub(crate) fn highest(map: &ElevationMap, point: GridPoint) -> Option<DVec3> {
    map.cell(point).top.map(|top| top.point).or_else(|| map.sample(point))
}
