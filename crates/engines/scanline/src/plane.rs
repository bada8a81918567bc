//! The plane of a face as a sensor sees it. (§4, 1b; §5: "the special properties of triangles")

use glam::DVec3;

use crate::sensor_from_scene::SensorFromScene;

/// The plane n.p = d of a face, in a sensor's frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// n = (b - a) x (c - a), sensor frame, square metres; not a unit vector.
    pub(crate) normal: DVec3,
    /// d = n.(a - position of the sensor), cubic metres: |n| times the plane's distance. Negative if the sensor's
    /// position sees the front.
    pub(crate) offset: f64,
    /// n / d.
    pub(crate) normal_over_offset: DVec3,
}

impl Plane {
    /// Formed in the scene frame, where edge vectors are exact, and then rotated.
    #[inline]
    pub(crate) fn new(scene_vertices: &[DVec3; 3], sensor_from_scene: &SensorFromScene) -> Self {
        let (n, offset) = plane_in_scene(scene_vertices, sensor_from_scene);
        let normal = sensor_from_scene.in_sensor_axes(n);
        Self { normal, offset, normal_over_offset: normal / offset }
    }
}

/// n and d of a face, with n along the scene's axes.
///
/// The vertex cycle is started at the lexicographically lowest position. So faces with the same three vertices tie
/// exactly, wherever their cycles start in the file.
#[inline]
pub(crate) fn plane_in_scene(vertices: &[DVec3; 3], sensor_from_scene: &SensorFromScene) -> (DVec3, f64) {
    let lowest =
        (1..3).fold(0, |lowest, k| if is_lower(&vertices[k], &vertices[lowest]) { k } else { lowest });
    let [a, b, c] = [vertices[lowest], vertices[(lowest + 1) % 3], vertices[(lowest + 2) % 3]];
    let n = (b - a).cross(c - a);
    (n, n.dot(sensor_from_scene.offset_of(a)))
}

/// Lexicographic order of positions.
#[inline]
fn is_lower(p: &DVec3, q: &DVec3) -> bool {
    (p.x, p.y, p.z) < (q.x, q.y, q.z)
}

#[cfg(test)]
mod tests {
    use raypencil_scene::Pose;

    use super::*;

    #[test]
    fn a_face_has_the_same_plane_wherever_its_cycle_starts() {
        let sensor_from_scene = SensorFromScene::from_pose(&Pose::from_position(DVec3::new(0.7, -0.3, 0.9)));
        // Vertices whose products are rounded, and which differ in each coordinate.
        let [a, b, c] =
            [[2.41, -2.82, -2.85], [0.25, 2.63, -0.71], [-1.7, -0.47, -2.83]].map(DVec3::from_array);
        let of = |vertices: [DVec3; 3]| plane_in_scene(&vertices, &sensor_from_scene);
        assert_eq!(of([a, b, c]), of([b, c, a]));
        assert_eq!(of([a, b, c]), of([c, a, b]));
        // It starts at the lowest, c: from the other two the normal is rounded otherwise.
        let from = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - a);
        assert_eq!(of([a, b, c]).0, from(c, a, b));
        assert_ne!(from(c, a, b), from(a, b, c));
        assert_ne!(from(c, a, b), from(b, c, a));
        // Vertices that share the first coordinate, or the first two.
        let [a, b] = [DVec3::new(-1.7, 0.2, 1.1), DVec3::new(-1.7, -0.47, 0.7)];
        assert_eq!(of([a, b, c]), of([b, c, a]));
        assert_eq!(of([a, b, c]), of([c, a, b]));
    }
}
