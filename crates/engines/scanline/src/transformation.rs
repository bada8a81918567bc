//! The interface of the two transformations: the camera's, perspective, and a beam's, cylindrical. (§4: "the
//! description will be somewhat generic")

use glam::DVec3;

use crate::plane::Plane;
use crate::sensor_from_scene::SensorFromScene;
use crate::spp::{ProjectedLine, SppPoint};
use crate::stripe::StripeVolume;
use crate::tables::Axis;

/// The operations in which the camera and a beam differ. Points and vectors are in the sensor's frame.
pub(crate) trait Transformation: Sync {
    /// The projection of an edge.
    type Line: ProjectedLine;

    fn sensor_from_scene(&self) -> &SensorFromScene;
    /// Distance of the SPP along the normal axis, metres: f_c or g.
    fn spp_distance(&self) -> f64;
    /// Maximum range along a ray, metres.
    fn max_range(&self) -> f64;
    /// The centres of the columns on the SPP.
    fn columns(&self) -> &Axis;
    /// The centres of the rows on the SPP.
    fn rows(&self) -> &Axis;
    /// The projection of a point at or beyond the SPP.
    fn project(&self, p: DVec3) -> SppPoint;
    /// The sides of the screen that a point is outside of: bits of `skip`.
    fn outside(&self, p: DVec3) -> u8;
    /// The projection of the edge between two points. `along` is second - first, more accurate than their difference.
    fn project_edge(&self, first: DVec3, second: DVec3, along: DVec3) -> Self::Line;
    /// The projection of the side that clipping cuts from a face along the SPP.
    fn project_spp_cut(&self, from: DVec3, to: DVec3, plane: &Plane) -> Self::Line;
    /// Rule 3c: whether a face whose front is seen cannot meet the screen.
    fn misses_screen(&self, front: &[DVec3; 3]) -> bool;
    /// The volume that faces are clipped to before their sides are drawn straight (`beam-edges = paper`).
    fn stripe_volume(&self) -> Option<&StripeVolume>;
    /// The range of a point at or beyond the SPP, along its ray, metres.
    fn range(&self, p: DVec3) -> f64;
    /// 1/t along the row at `y`, or `None` if the row does not see the face. (1b)
    fn row_inverse_t(&self, plane: &Plane, y: f64) -> Option<RowInverseT>;
    /// n.(a - o) for the origin o of the row at `y`; `Plane::offset` is that for the sensor's position.
    fn row_offset(&self, plane: &Plane, y: f64) -> f64;
    /// The point from which the rays of the row at `y` start.
    fn row_origin(&self, y: f64) -> DVec3;
    /// q: the ray's vector to the cell centred at (x, y) on the SPP.
    fn q(&self, x: f64, y: f64) -> DVec3;
    /// |q| of every cell of row `j`, metres.
    fn q_lengths(&self, j: u32) -> &[f64];
}

/// 1/t along one row: `slope x + start`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowInverseT {
    pub(crate) slope: f64,
    pub(crate) start: f64,
}
