//! What rounding can do to a stripe's point and to a face's plane: the one tolerance of occlusion.
//!
//! A face that holds the point does not hide it (a neighbour where the point is on their common side, a second
//! face in the same place, whatever its corners), yet computed in `f64` its plane passes the point by a few units
//! of the last place on either side. So a face hides a point only if the point is behind its plane by more than
//! rounding can account for. For a rig some metres above the ground that is about 1e-13 m: far below what
//! vertices of type `f32` can express there (1e-7 m), so no geometry hides in it.

use glam::DVec3;

use crate::vertices::SensorFromScene;

/// Bound on the relative error of a sum of products of this crate, relative to the products' absolute values: 64
/// units u = 2^-53. The longest chain, from vertices over a pose's matrix (at most 12 roundings an entry), n and
/// n.(a - o), 1/t and the point, into the camera's frame and onto its SPP, has fewer than 60 roundings.
pub(crate) const ROUNDING: f64 = 64.0 * 0.5 * f64::EPSILON;

/// How far rounding may have moved a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointError {
    /// Either way along its pencil, camera frame, metres. On a face that the pencil grazes it is the larger part;
    /// but it moves the point within the face, and so hardly against a plane nearly parallel to that.
    pub(crate) along: DVec3,
    /// In any direction, metres.
    pub(crate) anywhere: f64,
}

impl PointError {
    /// How much it changes n.P, for a normal n in the camera's frame.
    pub(crate) fn across(&self, n: DVec3) -> f64 {
        n.dot(self.along).abs() + n.length() * self.anywhere
    }
}

/// |e| |e'| of the two longest sides: n = e x e' is off by at most a multiple of u of that, which for a sliver is
/// far more than |n|.
#[inline]
pub(crate) fn largest_product_of_sides([a, b, c]: &[DVec3; 3]) -> f64 {
    let squared = [(*b - *a).length_squared(), (*c - *b).length_squared(), (*a - *c).length_squared()];
    let shortest = squared[0].min(squared[1]).min(squared[2]);
    // Of the three, all but the shortest.
    let product = if shortest == squared[0] {
        squared[1] * squared[2]
    } else if shortest == squared[1] {
        squared[0] * squared[2]
    } else {
        squared[0] * squared[1]
    };
    product.sqrt()
}

/// Distance of a sensor's origin from the farthest corner of a face, metres.
#[inline]
pub(crate) fn farthest_corner(corners: &[DVec3; 3], sensor_from_scene: &SensorFromScene) -> f64 {
    corners.iter().map(|a| sensor_from_scene.relative(*a).length_squared()).fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use raypencil_scene::Pose;

    #[test]
    fn an_error_across_a_plane_is_that_along_the_pencil_and_that_anywhere() {
        let error = PointError { along: DVec3::new(1.0, 2.0, 2.0), anywhere: 0.5 };
        // n.along = 2 - 2 + 4 = 4, |n| = 3.
        let n = DVec3::new(2.0, -1.0, 2.0);
        assert_eq!((error.across(n), error.across(-n)), (5.5, 5.5));
    }

    #[test]
    fn the_two_longest_sides_count_whichever_they_are() {
        // 3, 4 and 5 m.
        let [a, b, c] = [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
        for corners in [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
            assert_eq!(largest_product_of_sides(&corners), 20.0, "{corners:?}");
        }
    }

    #[test]
    fn the_farthest_corner_is_seen_from_the_sensor() {
        let sensor_from_scene = SensorFromScene::of(&Pose::from_position(DVec3::new(1.0, 0.0, 0.0)));
        let corners = [DVec3::new(1.0, 3.0, 4.0), DVec3::new(2.0, 0.0, 0.0), DVec3::new(5.5, 0.0, 0.0)];
        assert_eq!(farthest_corner(&corners, &sensor_from_scene), 5.0);
    }
}
