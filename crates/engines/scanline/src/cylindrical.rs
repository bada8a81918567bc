//! A beam's transformation: cylindrical. (§5, figure 7)
//!
//! A point (X, Y, Z) projects to (g X / Z, Y). Lines do not map to lines. But row y of the grid *is* the plane Y = y of
//! space, which cuts an edge from P to P' in one point:
//!
//! ```text
//! X* = X (Y' - y) + X' (y - Y),   Z* = Z (Y' - y) + Z' (y - Y),   x = g X* / Z*
//! ```
//!
//! DIFFERENCE: the paper joins the projected vertices by straight lines, since for a thin sheet "the non-linearity of
//! the triangle sides becomes insignificant". Here the projection is the curve itself. With `beam-edges = paper` the
//! lines are straight: see `stripe`.

use glam::DVec3;
use raypencil_scene::{Beam, Mounted};

use crate::plane::Plane;
use crate::sensor_from_scene::SensorFromScene;
use crate::skip;
use crate::spp::{ProjectedLine, SppPoint};
use crate::stripe::StripeVolume;
use crate::tables::Axis;
use crate::transformation::{RowInverseT, Transformation};
use crate::{Fidelity, Switches};

/// A beam with its pose and its tables.
#[derive(Debug)]
pub(crate) struct Cylindrical {
    sensor_from_scene: SensorFromScene,
    x: Axis,
    y: Axis,
    /// |q| of each column, metres. It is the same in every row.
    q_length: Vec<f64>,
    grid_distance: f64,
    max_range: f64,
    /// Depth beyond which no hit is in range, metres.
    max_depth: f64,
    /// The volume to clip to, with `beam-edges = paper`.
    stripe_volume: Option<StripeVolume>,
    skip_rules: Fidelity,
}

impl Cylindrical {
    pub(crate) fn new(mounted: &Mounted<Beam>, switches: Switches) -> Self {
        let beam = &mounted.sensor;
        let x = Axis::grid_columns(beam.columns, beam.half_width);
        let y = Axis::grid_rows(beam.rows, beam.thickness);
        let g = beam.grid_distance;
        let q_length = x.centres().iter().map(|x| (x * x + g * g).sqrt()).collect();
        let stripe_volume = (switches.beam_edges == Fidelity::Paper).then_some(StripeVolume {
            grid_distance: g,
            half_width: beam.half_width,
            half_thickness: 0.5 * beam.thickness,
        });
        Self {
            sensor_from_scene: SensorFromScene::from_pose(&mounted.scene_from_sensor),
            x,
            y,
            q_length,
            grid_distance: g,
            max_range: beam.max_range,
            // With straight sides no depth is too deep: between a straight side and the curve, the plane of a face may
            // be nearer than all of the face's points.
            max_depth: if stripe_volume.is_none() { beam.max_range } else { f64::INFINITY },
            stripe_volume,
            skip_rules: switches.skip_rules,
        }
    }
}

/// The projection of an edge: the curve of the points in which the rows' planes cut it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CylindricalCurve {
    first: DVec3,
    second: DVec3,
    grid_distance: f64,
}

impl ProjectedLine for CylindricalCurve {
    #[inline]
    fn x_at(&self, y: f64) -> f64 {
        let (from_first, to_second) = (y - self.first.y, self.second.y - y);
        let x = self.first.x * to_second + self.second.x * from_first;
        let z = self.first.z * to_second + self.second.z * from_first;
        self.grid_distance * x / z
    }
}

impl Transformation for Cylindrical {
    type Line = CylindricalCurve;

    fn sensor_from_scene(&self) -> &SensorFromScene {
        &self.sensor_from_scene
    }

    fn spp_distance(&self) -> f64 {
        self.grid_distance
    }

    fn max_range(&self) -> f64 {
        self.max_range
    }

    fn columns(&self) -> &Axis {
        &self.x
    }

    fn rows(&self) -> &Axis {
        &self.y
    }

    #[inline]
    fn project(&self, p: DVec3) -> SppPoint {
        SppPoint { x: self.grid_distance * p.x / p.z, y: p.y }
    }

    #[inline]
    fn outside(&self, p: DVec3) -> u8 {
        let ([left, right], [top, bottom]) = (self.x.borders(), self.y.borders());
        let x = self.grid_distance * p.x;
        skip::outside_bits(
            p.z < self.grid_distance,
            x < left * p.z,
            x > right * p.z,
            p.y < top,
            p.y > bottom,
            p.z > self.max_depth,
        )
    }

    #[inline]
    fn project_edge(&self, first: DVec3, second: DVec3, _along: DVec3) -> CylindricalCurve {
        CylindricalCurve { first, second, grid_distance: self.grid_distance }
    }

    fn project_spp_cut(&self, from: DVec3, to: DVec3, _plane: &Plane) -> CylindricalCurve {
        CylindricalCurve { first: from, second: to, grid_distance: self.grid_distance }
    }

    fn misses_screen(&self, _front: &[DVec3; 3]) -> bool {
        false
    }

    #[inline]
    fn stripe_volume(&self) -> Option<&StripeVolume> {
        self.stripe_volume.as_ref()
    }

    fn range(&self, p: DVec3) -> f64 {
        // The ray starts at (0, y, 0).
        (p.x * p.x + p.z * p.z).sqrt()
    }

    #[inline]
    fn row_inverse_t(&self, plane: &Plane, y: f64) -> Option<RowInverseT> {
        // For row y, 1/t = (n_x x + n_z g) / (d - n_y y).
        let offset = self.row_offset(plane, y);
        let is_seen = match self.skip_rules {
            // DIFFERENCE: rule 1b is applied row by row. The rows' origins differ, so they may see different sides of a
            // face.
            Fidelity::Exact => offset < 0.0,
            // 1b as printed, one decision for all rows: see `printed_skip`. CHOICE: a face seen edge-on, from the
            // origin or from a row, shows neither side.
            Fidelity::Paper => plane.offset < 0.0 && offset != 0.0,
        };
        if is_seen {
            let n = plane.normal;
            Some(RowInverseT { slope: n.x / offset, start: n.z * self.grid_distance / offset })
        } else {
            None
        }
    }

    #[inline]
    fn row_offset(&self, plane: &Plane, y: f64) -> f64 {
        plane.offset - plane.normal.y * y
    }

    #[inline]
    fn row_origin(&self, y: f64) -> DVec3 {
        DVec3::new(0.0, y, 0.0)
    }

    #[inline]
    fn q(&self, x: f64, _y: f64) -> DVec3 {
        DVec3::new(x, 0.0, self.grid_distance)
    }

    #[inline]
    fn q_lengths(&self, _j: u32) -> &[f64] {
        &self.q_length
    }
}

#[cfg(test)]
mod tests {
    use raypencil_scene::Pose;

    use super::*;
    use crate::fixtures::beam;
    use crate::skip::{ABOVE, BEHIND_SPP, BELOW, LEFT, RIGHT, TOO_DEEP};

    #[test]
    fn a_row_sees_the_front_of_a_plane_that_its_origin_is_in_front_of() {
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam() };
        let with = |switches| Cylindrical::new(&mounted, switches);
        // A floor at y = 1/4 that faces up, n = (0, -1, 0): d = -1/4. A row at y = -1/4 is above the floor and parallel
        // to it: 1/t = (0 x + 0 g) / (-1/4 - 1/4). A row at y = 1/4 lies in it, one at 1/2 is below.
        let corners = [[0.0, 0.25, 1.0], [1.0, 0.25, 1.0], [1.0, 0.25, 2.0]].map(DVec3::from_array);
        let (exact, paper) = (with(Switches::EXACT), with(Switches::PAPER));
        let plane = Plane::new(&corners, exact.sensor_from_scene());
        assert!(plane.normal.y < 0.0 && plane.offset == 0.25 * plane.normal.y);
        let seen = |beam: &Cylindrical, plane: &Plane| {
            [-0.25, 0.25, 0.5].map(|y| beam.row_inverse_t(plane, y).is_some())
        };
        assert_eq!(seen(&exact, &plane), [true, false, false]);
        // As printed, the middle of the sheet decides for all rows, except for the row that lies in the floor.
        assert_eq!(seen(&paper, &plane), [true, false, true]);
        let [a, b, c] = corners;
        let ceiling = Plane::new(&[a, c, b], exact.sensor_from_scene());
        assert_eq!(seen(&exact, &ceiling), [false, false, true]);
        assert_eq!(seen(&paper, &ceiling), [false; 3]);
        // A floor through the origin is seen edge-on from there: as printed, from no row.
        let level = Plane::new(&corners.map(|corner| corner.with_y(0.0)), exact.sensor_from_scene());
        assert_eq!((seen(&exact, &level), seen(&paper, &level)), ([true, false, false], [false; 3]));
    }

    #[test]
    fn a_point_is_outside_the_sides_that_it_is_beyond() {
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam() };
        let exact = Cylindrical::new(&mounted, Switches::EXACT);
        // A point on a border is not beyond it. The sheet's thickness is the same at every depth.
        for ([x, y, z], sides) in [
            ([0.0, 0.0, 2.0], 0),
            ([-2.0, -0.5, 2.0], 0),
            ([2.0, 0.5, 2.0], 0),
            ([-2.1, 0.0, 2.0], LEFT),
            ([2.1, 0.0, 2.0], RIGHT),
            ([0.0, -0.6, 2.0], ABOVE),
            ([0.0, 0.6, 2.0], BELOW),
            ([2.1, -0.6, 2.0], RIGHT | ABOVE),
            ([0.0, 0.0, 1.0], 0),
            ([0.0, 0.0, 0.9], BEHIND_SPP),
            ([0.0, 0.0, 100.0], 0),
            ([0.0, 0.0, 100.1], TOO_DEEP),
        ] {
            assert_eq!(exact.outside(DVec3::new(x, y, z)), sides, "{x} {y} {z}");
        }
        // With straight sides no depth is too deep.
        let straight = Cylindrical::new(&mounted, Switches::PAPER);
        assert_eq!(straight.outside(DVec3::new(0.0, 0.0, 100.1)), 0);
    }
}
