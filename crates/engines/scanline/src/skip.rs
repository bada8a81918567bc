//! Skip rules 1a, 1b, 3a, 3b and 3c in forms that never change a map. (§4, 1 and 3) The rules as the paper prints them,
//! `skip-rules = paper`, are in `printed_skip`.
//!
//! | rule | as printed | here |
//! | --- | --- | --- |
//! | 1a | all vertices in front of the SPP | the same: the part beyond the plane is empty |
//! | 1b | the back faces the sensor | the sign of the plane's offset, per row for a beam. (This does more than skip: a back is never hit) |
//! | 3a | all vertices left, right, above or below the screen | the same, by planes through the origin, so that it applies to vertices behind the SPP too |
//! | 3b | all vertices' *range* exceeds the maximum | all vertices' *depth* does. DIFFERENCE: with ranges the rule is not conservative, because the interior of a face can be nearer than its vertices. The half-space beyond a depth is convex, and range is at least depth |
//! | 3c | no vertex, side or centre of the screen meets the triangle | all four corners of the screen lie outside one and the same side. For a beam, whose sides are curves, nothing is skipped here |
//!
//! The screen's borders lie half a cell beyond the outermost cell centres. Half a cell is far more than rounding, so a
//! face that is skipped by a border covers no centre.

use glam::DVec3;

// Bits of `SensorVertex::outside`. A face whose vertices share a bit is not seen.
pub(crate) const BEHIND_SPP: u8 = 1;
pub(crate) const LEFT: u8 = 2;
pub(crate) const RIGHT: u8 = 4;
pub(crate) const ABOVE: u8 = 8;
pub(crate) const BELOW: u8 = 16;
pub(crate) const TOO_DEEP: u8 = 32;

/// The bits of a point, by the conditions that it fulfils.
#[inline]
pub(crate) fn outside_bits(
    behind_spp: bool,
    left: bool,
    right: bool,
    above: bool,
    below: bool,
    too_deep: bool,
) -> u8 {
    let bit = |is: bool, bit: u8| if is { bit } else { 0 };
    bit(behind_spp, BEHIND_SPP)
        | bit(left, LEFT)
        | bit(right, RIGHT)
        | bit(above, ABOVE)
        | bit(below, BELOW)
        | bit(too_deep, TOO_DEEP)
}

/// Rule 3c for the camera: whether the rays through all four corners of the screen pass on the outer side of one edge.
///
/// For a face whose front is seen, the ray q passes on the inner side of the edge from p to p' where (p x p').q <= 0.
/// `normals` are those three cross products. The rays of the screen form a convex cone.
pub(crate) fn screen_is_beyond_one_edge(normals: [DVec3; 3], screen_corners: [DVec3; 4]) -> bool {
    normals.iter().any(|n| screen_corners.iter().all(|q| n.dot(*q) > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_through_a_corner_of_the_screen_does_not_leave_the_screen_beside_it() {
        // The screen is x/z and y/z from -1 to 1. The edge is the line x/z = -1 of its left side, or one beside it.
        let corners =
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 1.0));
        let inner = DVec3::new(-1.0, 0.0, -9.0);
        let is_beyond = |at: f64| {
            let n = DVec3::new(1.0, 0.0, -at);
            [[n, inner, inner], [inner, n, inner], [inner, inner, n]]
                .map(|normals| screen_is_beyond_one_edge(normals, corners))
        };
        assert_eq!(
            (is_beyond(-1.0), is_beyond(-1.001), is_beyond(-0.999)),
            ([false; 3], [true; 3], [false; 3])
        );
    }
}
