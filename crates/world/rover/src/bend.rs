//! Where the ground may bend between two measured points: ground that no stripe met, because it lies between two stripes.

use glam::DVec3;

use crate::elevation_map::{ElevationMap, GridPoint, is_measured};

/// Steepest rise that is continued beyond a measured point, rise over distance. CHOICE: 45 degrees. What is steeper is an
/// edge, and an edge does not go on.
const MAX_CONTINUED_SLOPE: f64 = 1.0;

/// Place at which the ground between two neighbouring measured grid points rises highest above the straight line between them,
/// global, metres; `None` if it does not. The points are the highest of their cells.
///
/// The foot of a stone, its top and the edge of a plateau lie between two stripes, as a rule. There the ground bends: on either
/// side it goes on as it came, up to one place. So the lines that lead up to both points are continued until they meet. The top
/// of a stone whose flanks were met is one such place, and the edge of a plateau is one. A plane bends nowhere, and the lines
/// before and behind a level step never meet: there the straight line is all. But where the two points differ by more than 45
/// degrees there is an edge between them. A cell keeps its highest point, so the edge is taken to lie in the upper point's cell: its
/// side goes on half way to the lower one.
pub(crate) fn bend_up(map: &ElevationMap, from: GridPoint, to: GridPoint, step: (i64, i64)) -> Option<DVec3> {
    // A diagonal through the corner of a level stone falls on both sides of two cells, too.
    if step.0 != 0 && step.1 != 0 {
        return None;
    }
    bend_between(map, from, to, step, top_of, |above| above > 0.0)
}

/// Place at which the ground between two neighbouring measured grid points lies lowest below the straight line between them,
/// likewise; `None` if it does not. The points are those that stand for their cells.
pub(crate) fn bend_down(
    map: &ElevationMap,
    from: GridPoint,
    to: GridPoint,
    step: (i64, i64),
) -> Option<DVec3> {
    bend_between(map, from, to, step, ElevationMap::sample, |above| above < 0.0)
}

/// Where the ground bends to the asked side of the straight line: `is_asked` of the height above it. `of_cell` is the point of a
/// cell.
fn bend_between(
    map: &ElevationMap,
    from: GridPoint,
    to: GridPoint,
    step: (i64, i64),
    of_cell: impl Fn(&ElevationMap, GridPoint) -> Option<DVec3>,
    is_asked: impl Fn(f64) -> bool,
) -> Option<DVec3> {
    let beside =
        |point: GridPoint, sign: i64| GridPoint { i: point.i + sign * step.0, j: point.j + sign * step.1 };
    let at = |point: GridPoint| is_measured(map, point).then(|| of_cell(map, point)).flatten();
    let [before, near, far, after] = [at(beside(from, -1))?, at(from)?, at(to)?, at(beside(to, 1))?];
    // Rises towards the middle, from either side.
    let rise = |foot: DVec3, end: DVec3| {
        let distance = (end - foot).truncate().length();
        let slope = if distance > 0.0 { (end.z - foot.z) / distance } else { 0.0 };
        slope.clamp(-MAX_CONTINUED_SLOPE, MAX_CONTINUED_SLOPE)
    };
    let (up, down) = (rise(before, near), rise(after, far));
    let length = (far - near).truncate().length();
    let chord = far.z - near.z;
    let middle = |share: f64| near.truncate() + (far - near).truncate() * share;
    // An edge: the asked side goes on half way, to the border between the cells. In the other cell it would have left its mark.
    if chord.abs() > MAX_CONTINUED_SLOPE * length {
        let heights = [near.z + 0.5 * up * length, far.z + 0.5 * down * length];
        let straight = 0.5 * (near.z + far.z);
        return heights.into_iter().find(|z| is_asked(z - straight)).map(|z| middle(0.5).extend(z));
    }
    // Parallel lines do not meet, and one and the same line bends nowhere.
    let way = (chord + down * length) / (up + down);
    if !(way > 0.0 && way < length) {
        return None;
    }
    let share = way / length;
    is_asked(up * way - chord * share).then(|| middle(share).extend(near.z + up * way))
}

/// Highest point that was measured in a cell; as printed, the only one.
pub(crate) fn top_of(map: &ElevationMap, point: GridPoint) -> Option<DVec3> {
    map.cell(point).top.map(|top| top.point).or_else(|| map.sample(point))
}
