//! The camera's transformation: perspective. (§4)
//!
//! A point (X, Y, Z) projects to (f X / Z, f Y / Z). Lines map to lines: the edge from P to P' and the projection
//! centre span a plane of normal N = P x (P' - P), and the edge's projection is N.(x, y, f) = 0.

use glam::DVec3;
use raypencil_scene::{Camera, Mounted};

use crate::plane::Plane;
use crate::sensor_from_scene::SensorFromScene;
use crate::skip;
use crate::spp::{ProjectedLine, SppPoint};
use crate::stripe::StripeVolume;
use crate::tables::{Axis, CameraTables};
use crate::transformation::{RowInverseT, Transformation};

/// A camera with its pose and its tables.
#[derive(Debug)]
pub(crate) struct Perspective<'a> {
    sensor_from_scene: SensorFromScene,
    tables: &'a CameraTables,
    focal_length: f64,
    max_range: f64,
    /// The rays' vectors through the corners of the screen.
    screen_corners: [DVec3; 4],
}

impl<'a> Perspective<'a> {
    pub(crate) fn new(mounted: &Mounted<Camera>, tables: &'a CameraTables) -> Self {
        let camera = &mounted.sensor;
        let [left, right] = tables.x.borders();
        let [top, bottom] = tables.y.borders();
        let corner = |x, y| DVec3::new(x, y, camera.focal_length);
        Self {
            sensor_from_scene: SensorFromScene::from_pose(&mounted.scene_from_sensor),
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

/// The projection of an edge: N.(x, y, f) = 0, or N.x x + (N.y y + constant) = 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StraightLine {
    normal: DVec3,
    /// N.z f, the same for every row.
    constant: f64,
}

impl ProjectedLine for StraightLine {
    #[inline]
    fn x_at(&self, y: f64) -> f64 {
        -(self.normal.y * y + self.constant) / self.normal.x
    }
}

impl Transformation for Perspective<'_> {
    type Line = StraightLine;

    fn sensor_from_scene(&self) -> &SensorFromScene {
        &self.sensor_from_scene
    }

    fn spp_distance(&self) -> f64 {
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
    fn project(&self, p: DVec3) -> SppPoint {
        SppPoint { x: self.focal_length * p.x / p.z, y: self.focal_length * p.y / p.z }
    }

    #[inline]
    fn outside(&self, p: DVec3) -> u8 {
        let ([left, right], [top, bottom]) = (self.tables.x.borders(), self.tables.y.borders());
        let (x, y) = (self.focal_length * p.x, self.focal_length * p.y);
        skip::outside_bits(
            p.z < self.focal_length,
            x < left * p.z,
            x > right * p.z,
            y < top * p.z,
            y > bottom * p.z,
            p.z > self.max_range,
        )
    }

    #[inline]
    fn project_edge(&self, first: DVec3, _second: DVec3, along: DVec3) -> StraightLine {
        let normal = first.cross(along);
        StraightLine { normal, constant: normal.z * self.focal_length }
    }

    fn project_spp_cut(&self, _from: DVec3, _to: DVec3, plane: &Plane) -> StraightLine {
        // On the SPP t = 1: n.(x, y, f) - d = 0.
        let constant = plane.normal.z * self.focal_length - plane.offset;
        StraightLine { normal: plane.normal, constant }
    }

    #[inline]
    fn misses_screen(&self, front: &[DVec3; 3]) -> bool {
        let [a, b, c] = *front;
        skip::screen_is_beyond_one_edge([a.cross(b), b.cross(c), c.cross(a)], self.screen_corners)
    }

    #[inline]
    fn stripe_volume(&self) -> Option<&StripeVolume> {
        // Lines map to lines: the paper's straight sides are exact.
        None
    }

    fn range(&self, p: DVec3) -> f64 {
        p.length()
    }

    #[inline]
    fn row_inverse_t(&self, plane: &Plane, y: f64) -> Option<RowInverseT> {
        // Rule 1b: all rays start in one point, which sees the front if d < 0.
        if !(plane.offset < 0.0) {
            return None;
        }
        // 1/t = n.q / d with q = (x, y, f).
        let m = plane.normal_over_offset;
        Some(RowInverseT { slope: m.x, start: m.y * y + m.z * self.focal_length })
    }

    #[inline]
    fn row_offset(&self, plane: &Plane, _y: f64) -> f64 {
        plane.offset
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
    use crate::skip::{ABOVE, BEHIND_SPP, BELOW, LEFT, RIGHT, TOO_DEEP};

    #[test]
    fn a_point_is_outside_the_sides_that_it_is_beyond() {
        let tables = CameraTables::new(&camera());
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
        let camera = Perspective::new(&mounted, &tables);
        // A point on a border is not beyond it.
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
            ([0.0, 0.0, 0.9], BEHIND_SPP),
            ([0.0, 0.0, 100.0], 0),
            ([0.0, 0.0, 100.1], TOO_DEEP),
        ] {
            assert_eq!(camera.outside(DVec3::new(x, y, z)), sides, "{x} {y} {z}");
        }
    }
}
