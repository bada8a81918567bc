//! A beam's transformation: cylindrical. (§5, figure 7)
//!
//! A point (X, Y, Z) projects to (g X / Z, Y). Lines do not map to lines; but row y of the grid *is* the
//! plane Y = y of space, which cuts an edge from P to P' in one point:
//!
//! ```text
//! X* = X (Y' - y) + X' (y - Y),   Z* = Z (Y' - y) + Z' (y - Y),   x = g X* / Z*
//! ```
//!
//! DIFFERENCE: the paper joins the projected vertices by straight lines, whose "non-linearity [...] becomes
//! insignificant" for a thin sheet; this is the curve itself. With `beam-edges = paper` the lines are straight:
//! see `stripe`.

use glam::DVec3;
use raypencil_scene::{Beam, Mounted};

use crate::raster::{Affine, Plane, Transformation};
use crate::scan::{Corner, Line};
use crate::skip;
use crate::stripe::Stripe;
use crate::tables::Axis;
use crate::vertices::SensorFromScene;
use crate::{Fidelity, Switches};

/// A posed beam with its tables.
#[derive(Debug)]
pub(crate) struct Cylindrical {
    sensor_from_scene: SensorFromScene,
    x: Axis,
    y: Axis,
    /// |q| of each column, metres; the same in every row.
    q_length: Vec<f64>,
    grid_distance: f64,
    max_range: f64,
    /// Depth beyond which nothing is in range.
    too_deep: f64,
    /// The stripe, with `beam-edges = paper`.
    stripe: Option<Stripe>,
    skip_rules: Fidelity,
}

impl Cylindrical {
    pub(crate) fn new(mounted: &Mounted<Beam>, switches: Switches) -> Self {
        let beam = &mounted.sensor;
        let x = Axis::of_grid(beam.columns, beam.half_width);
        let y = Axis::of_rows(beam.rows, beam.thickness);
        let g = beam.grid_distance;
        let q_length = x.centres().iter().map(|x| (x * x + g * g).sqrt()).collect();
        let stripe = (switches.beam_edges == Fidelity::Paper).then_some(Stripe {
            grid_distance: g,
            half_width: beam.half_width,
            half_thickness: 0.5 * beam.thickness,
        });
        Self {
            sensor_from_scene: SensorFromScene::of(&mounted.scene_from_sensor),
            x,
            y,
            q_length,
            grid_distance: g,
            max_range: beam.max_range,
            // Between a straight side and the curve a face's plane may be nearer than any of its points.
            too_deep: if stripe.is_none() { beam.max_range } else { f64::INFINITY },
            stripe,
            skip_rules: switches.skip_rules,
        }
    }
}

/// The image of an edge: the curve of the points in which the rows' planes cut it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CutLine {
    first: DVec3,
    second: DVec3,
    grid_distance: f64,
}

impl Line for CutLine {
    #[inline]
    fn x_at(&self, y: f64) -> f64 {
        let (from_first, to_second) = (y - self.first.y, self.second.y - y);
        let x = self.first.x * to_second + self.second.x * from_first;
        let z = self.first.z * to_second + self.second.z * from_first;
        self.grid_distance * x / z
    }
}

impl Transformation for Cylindrical {
    type Line = CutLine;

    fn sensor_from_scene(&self) -> &SensorFromScene {
        &self.sensor_from_scene
    }

    fn plane_distance(&self) -> f64 {
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
    fn project(&self, p: DVec3) -> Corner {
        Corner { x: self.grid_distance * p.x / p.z, y: p.y }
    }

    #[inline]
    fn outside(&self, p: DVec3) -> u8 {
        let ([left, right], [top, bottom]) = (self.x.borders(), self.y.borders());
        let x = self.grid_distance * p.x;
        skip::bits(
            p.z < self.grid_distance,
            x < left * p.z,
            x > right * p.z,
            p.y < top,
            p.y > bottom,
            p.z > self.too_deep,
        )
    }

    #[inline]
    fn line(&self, first: DVec3, second: DVec3, _along: DVec3) -> CutLine {
        CutLine { first, second, grid_distance: self.grid_distance }
    }

    fn line_along_plane(&self, from: DVec3, to: DVec3, _face: &Plane) -> CutLine {
        CutLine { first: from, second: to, grid_distance: self.grid_distance }
    }

    fn misses_screen(&self, _front: &[DVec3; 3]) -> bool {
        false
    }

    #[inline]
    fn stripe(&self) -> Option<&Stripe> {
        self.stripe.as_ref()
    }

    fn range(&self, p: DVec3) -> f64 {
        // From (0, y, 0), where the ray starts.
        (p.x * p.x + p.z * p.z).sqrt()
    }

    #[inline]
    fn inverse_t(&self, face: &Plane, y: f64) -> Option<Affine> {
        // For row y, 1/t = (n_x x + n_z g) / (d - n_y y).
        let distance = self.row_distance(face, y);
        let is_seen = match self.skip_rules {
            // DIFFERENCE: rule 1b, row by row: the rows' origins differ, so they may see different sides of
            // a face.
            Fidelity::Exact => distance < 0.0,
            // 1b as printed, one decision for all rows: see `printed`. CHOICE: edge on, from the origin or
            // from a row, neither side is seen.
            Fidelity::Paper => face.distance < 0.0 && distance != 0.0,
        };
        if is_seen {
            let n = face.normal;
            Some(Affine { slope: n.x / distance, start: n.z * self.grid_distance / distance })
        } else {
            None
        }
    }

    #[inline]
    fn row_distance(&self, face: &Plane, y: f64) -> f64 {
        face.distance - face.normal.y * y
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
    use crate::skip::{ABOVE, BEHIND_PLANE, BELOW, LEFT, RIGHT, TOO_DEEP};

    #[test]
    fn a_row_sees_the_fronts_of_planes_that_its_origin_is_before() {
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam() };
        let of = |switches| Cylindrical::new(&mounted, switches);
        // A floor at y = 1/4 that faces up, n = (0, -1, 0): d = -1/4. Row 0, at y = -1/4, is above it and parallel to it:
        // 1/t = (0 x + 0 g) / (-1/4 - 1/4); at y = 1/4 a row lies in it, at 1/2 it is below.
        let corners = [[0.0, 0.25, 1.0], [1.0, 0.25, 1.0], [1.0, 0.25, 2.0]].map(DVec3::from_array);
        let (exact, paper) = (of(Switches::EXACT), of(Switches::PAPER));
        let plane = Plane::of(&corners, exact.sensor_from_scene());
        assert!(plane.normal.y < 0.0 && plane.distance == 0.25 * plane.normal.y);
        let seen = |beam: &Cylindrical, plane: &Plane| {
            [-0.25, 0.25, 0.5].map(|y| beam.inverse_t(plane, y).is_some())
        };
        assert_eq!(seen(&exact, &plane), [true, false, false]);
        // As printed the middle of the sheet sees it for all rows, but for the one that lies in it.
        assert_eq!(seen(&paper, &plane), [true, false, true]);
        let [a, b, c] = corners;
        let ceiling = Plane::of(&[a, c, b], exact.sensor_from_scene());
        assert_eq!(seen(&exact, &ceiling), [false, false, true]);
        assert_eq!(seen(&paper, &ceiling), [false; 3]);
    }

    #[test]
    fn a_point_is_outside_of_the_sides_it_is_beyond() {
        let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam() };
        let exact = Cylindrical::new(&mounted, Switches::EXACT);
        // On the borders themselves it is not beyond them. The sheet keeps its height.
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
            ([0.0, 0.0, 0.9], BEHIND_PLANE),
            ([0.0, 0.0, 100.0], 0),
            ([0.0, 0.0, 100.1], TOO_DEEP),
        ] {
            assert_eq!(exact.outside(DVec3::new(x, y, z)), sides, "{x} {y} {z}");
        }
        // With straight sides nothing is known to be too deep.
        let straight = Cylindrical::new(&mounted, Switches::PAPER);
        assert_eq!(straight.outside(DVec3::new(0.0, 0.0, 100.1)), 0);
    }
}
