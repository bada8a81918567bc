//! The camera's transformation: perspective. (§4)
//!
//! A point (X, Y, Z) projects to (f X / Z, f Y / Z). Lines map to lines: the edge from P to P' lies with
//! the projection centre in a plane of normal N = P x (P' - P), and its image is N.(x, y, f) = 0.

use glam::DVec3;
use raypencil_scene::{Camera, Mounted};

use crate::raster::{Affine, Plane, Transformation};
use crate::scan::{Corner, Line};
use crate::skip;
use crate::stripe::Stripe;
use crate::tables::{Axis, CameraTables};
use crate::vertices::SensorFromScene;

/// A posed camera with its tables.
#[derive(Debug)]
pub(crate) struct Perspective<'a> {
    sensor_from_scene: SensorFromScene,
    tables: &'a CameraTables,
    focal_length: f64,
    max_range: f64,
    screen_corners: [DVec3; 4],
}

impl<'a> Perspective<'a> {
    pub(crate) fn new(mounted: &Mounted<Camera>, tables: &'a CameraTables) -> Self {
        let camera = &mounted.sensor;
        let [left, right] = tables.x.borders();
        let [top, bottom] = tables.y.borders();
        let corner = |x, y| DVec3::new(x, y, camera.focal_length);
        Self {
            sensor_from_scene: SensorFromScene::of(&mounted.scene_from_sensor),
            tables,
            focal_length: camera.focal_length,
            max_range: camera.max_range,
            screen_corners: [
                corner(left, top),
                corner(right, top),
                corner(right, bottom),
                corner(left, bottom),
            ],
        }
    }
}

/// The image of an edge: N.(x, y, f) = 0, or N.x x + (N.y y + along) = 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StraightLine {
    normal: DVec3,
    /// N.z f, the same for every row.
    along: f64,
}

impl Line for StraightLine {
    #[inline]
    fn x_at(&self, y: f64) -> f64 {
        -(self.normal.y * y + self.along) / self.normal.x
    }
}

impl Transformation for Perspective<'_> {
    type Line = StraightLine;

    fn sensor_from_scene(&self) -> &SensorFromScene {
        &self.sensor_from_scene
    }

    fn plane_distance(&self) -> f64 {
        self.focal_length
    }

    fn max_range(&self) -> f64 {
        self.max_range
    }

    fn columns(&self) -> &Axis {
        &self.tables.x
    }

    fn rows(&self) -> &Axis {
        &self.tables.y
    }

    #[inline]
    fn project(&self, p: DVec3) -> Corner {
        Corner { x: self.focal_length * p.x / p.z, y: self.focal_length * p.y / p.z }
    }

    #[inline]
    fn outside(&self, p: DVec3) -> u8 {
        let ([left, right], [top, bottom]) = (self.tables.x.borders(), self.tables.y.borders());
        let (x, y) = (self.focal_length * p.x, self.focal_length * p.y);
        skip::bits(
            p.z < self.focal_length,
            x < left * p.z,
            x > right * p.z,
            y < top * p.z,
            y > bottom * p.z,
            p.z > self.max_range,
        )
    }

    #[inline]
    fn line(&self, first: DVec3, _second: DVec3, along: DVec3) -> StraightLine {
        let normal = first.cross(along);
        StraightLine { normal, along: normal.z * self.focal_length }
    }

    fn line_along_plane(&self, _from: DVec3, _to: DVec3, face: &Plane) -> StraightLine {
        // On the SPP t = 1: n.(x, y, f) - d = 0.
        let along = face.normal.z * self.focal_length - face.distance;
        StraightLine { normal: face.normal, along }
    }

    #[inline]
    fn misses_screen(&self, front: &[DVec3; 3]) -> bool {
        let [a, b, c] = *front;
        skip::screen_is_beyond_one_edge([a.cross(b), b.cross(c), c.cross(a)], self.screen_corners)
    }

    #[inline]
    fn stripe(&self) -> Option<&Stripe> {
        // Lines map to lines: the paper's sides are the true ones.
        None
    }

    fn range(&self, p: DVec3) -> f64 {
        p.length()
    }

    #[inline]
    fn inverse_t(&self, face: &Plane, y: f64) -> Option<Affine> {
        // Rule 1b: all rays start in one point, which sees the front where d < 0.
        if !(face.distance < 0.0) {
            return None;
        }
        // 1/t = n.q / d with q = (x, y, f).
        let m = face.normal_over_distance;
        Some(Affine { slope: m.x, start: m.y * y + m.z * self.focal_length })
    }

    #[inline]
    fn row_distance(&self, face: &Plane, _y: f64) -> f64 {
        face.distance
    }

    #[inline]
    fn row_origin(&self, _y: f64) -> DVec3 {
        DVec3::ZERO
    }

    #[inline]
    fn q(&self, x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, self.focal_length)
    }

    #[inline]
    fn q_lengths(&self, j: u32) -> &[f64] {
        let width = self.tables.x.count() as usize;
        &self.tables.q_length[j as usize * width..][..width]
    }
}

#[cfg(test)]
mod tests {
    use raypencil_scene::Pose;

    use super::*;
    use crate::fixtures::camera;
    use crate::skip::{ABOVE, BEHIND_PLANE, BELOW, LEFT, RIGHT, TOO_DEEP};

    #[test]
    fn a_point_is_outside_of_the_sides_it_is_beyond() {
        let tables = CameraTables::of(&camera());
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
        let camera = Perspective::new(&mounted, &tables);
        // On the borders themselves it is not beyond them.
        for ([x, y, z], sides) in [
            ([0.0, 0.0, 2.0], 0),
            ([-2.0, -2.0, 2.0], 0),
            ([2.0, 2.0, 2.0], 0),
            ([-2.1, 0.0, 2.0], LEFT),
            ([2.1, 0.0, 2.0], RIGHT),
            ([0.0, -2.1, 2.0], ABOVE),
            ([0.0, 2.1, 2.0], BELOW),
            ([-2.1, 2.1, 2.0], LEFT | BELOW),
            ([0.0, 0.0, 1.0], 0),
            ([0.0, 0.0, 0.9], BEHIND_PLANE),
            ([0.0, 0.0, 100.0], 0),
            ([0.0, 0.0, 100.1], TOO_DEEP),
        ] {
            assert_eq!(camera.outside(DVec3::new(x, y, z)), sides, "{x} {y} {z}");
        }
    }
}
