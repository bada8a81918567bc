//! Rounding bounds of a stripe's point and of a face's plane: the one tolerance of occlusion.
//!
//! A face that contains the point does not hide it: a neighbour where the point is on their common edge, or a second
//! face in the same place, whatever its vertices. Yet as computed in `f64`, the plane of such a face passes the point
//! by a few units in the last place, on either side. So a face hides a point only if the point is behind its plane by
//! more than rounding can explain. For a rig some metres above the ground that is about 1e-13 m. Vertices of type `f32`
//! are 1e-7 m apart there, so no geometry is lost to this tolerance.

use glam::DVec3;

use crate::sensor_from_scene::SensorFromScene;

/// Bound on the relative error of a sum of products in this crate, relative to the products' absolute values: 64 u,
/// u = 2^-53. The longest chain has fewer than 60 roundings. It runs from the vertices over a pose's matrix (at most 12
/// roundings an entry), n and n.(a - o), 1/t and the point, into the camera's frame and onto its SPP.
pub(crate) const RELATIVE_ROUNDING: f64 = 64.0 * 0.5 * f64::EPSILON;

/// Bounds on the displacement of a point by rounding, in two parts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointError {
    /// Displacement along the pencil, in either sense, camera frame, metres. It is the larger part on a face that the
    /// pencil grazes. But it moves the point within that face, so it hardly counts against a plane nearly parallel to
    /// the face.
    pub(crate) along_pencil: DVec3,
    /// Displacement in any direction, metres.
    pub(crate) any_direction: f64,
}

impl PointError {
    /// Bound on the change of n.P, for a normal n in the camera's frame.
    pub(crate) fn bound_on_dot(&self, n: DVec3) -> f64 {
        n.dot(self.along_pencil).abs() + n.length() * self.any_direction
    }
}

/// |e| |e'| of the two longest edges, square metres. The error of n = e x e' is a multiple of u times this product. For
/// a sliver that is far more than u |n|.
#[inline]
pub(crate) fn longest_edges_product([a, b, c]: &[DVec3; 3]) -> f64 {
    let squared = [(*b - *a).length_squared(), (*c - *b).length_squared(), (*a - *c).length_squared()];
    let shortest = squared[0].min(squared[1]).min(squared[2]);
    // All of the three but the shortest.
    let product = if shortest == squared[0] {
        squared[1] * squared[2]
    } else if shortest == squared[1] {
        squared[0] * squared[2]
    } else {
        squared[0] * squared[1]
    };
    product.sqrt()
}

/// Distance from a sensor's position to the farthest vertex of a face, metres.
#[inline]
pub(crate) fn max_vertex_distance(vertices: &[DVec3; 3], sensor_from_scene: &SensorFromScene) -> f64 {
    vertices.iter().map(|a| sensor_from_scene.offset_of(*a).length_squared()).fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use raypencil_scene::Pose;

    #[test]
    fn the_bound_of_a_dot_product_adds_both_parts() {
        let error = PointError { along_pencil: DVec3::new(1.0, 2.0, 2.0), any_direction: 0.5 };
        // n.along_pencil = 2 - 2 + 4 = 4, |n| = 3.
        let n = DVec3::new(2.0, -1.0, 2.0);
        assert_eq!((error.bound_on_dot(n), error.bound_on_dot(-n)), (5.5, 5.5));
    }

    #[test]
    fn the_two_longest_edges_count_whichever_they_are() {
        // 3, 4 and 5 m.
        let [a, b, c] = [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
        for vertices in [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
            assert_eq!(longest_edges_product(&vertices), 20.0, "{vertices:?}");
        }
    }

    #[test]
    fn the_farthest_vertex_is_measured_from_the_sensor() {
        let sensor_from_scene = SensorFromScene::from_pose(&Pose::from_position(DVec3::new(1.0, 0.0, 0.0)));
        let vertices = [DVec3::new(1.0, 3.0, 4.0), DVec3::new(2.0, 0.0, 0.0), DVec3::new(5.5, 0.0, 0.0)];
        assert_eq!(max_vertex_distance(&vertices, &sensor_from_scene), 5.0);
    }
}
