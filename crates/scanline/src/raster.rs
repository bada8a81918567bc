//! Step 4b: the range raster map, kept as the largest 1/t per cell, and the quantities that follow from it.
//! (§4, 4b; §5 "without using square roots")

use glam::DVec3;
use raypencil_scene::{FaceId, Hit, Maybe, Mesh, Quantities, SensorRow};

use crate::scan::{Corner, Line};
use crate::stripe::Stripe;
use crate::tables::Axis;
use crate::vertices::{SensorFromScene, widen};

/// What the camera and a beam do differently.
pub(crate) trait Transformation: Sync {
    /// The image of an edge.
    type Line: Line;

    fn sensor_from_scene(&self) -> &SensorFromScene;
    /// Distance of the SPP along the normal axis, metres.
    fn plane_distance(&self) -> f64;
    fn max_range(&self) -> f64;
    fn columns(&self) -> &Axis;
    fn rows(&self) -> &Axis;
    /// The image of a point at or beyond the SPP.
    fn project(&self, p: DVec3) -> Corner;
    /// On which sides of the screen a point lies outside: bits of `skip`.
    fn outside(&self, p: DVec3) -> u8;
    /// The image of the edge between two points; `along` = second - first, more exactly than they say.
    fn line(&self, first: DVec3, second: DVec3, along: DVec3) -> Self::Line;
    /// The image of the side that clipping cuts along the SPP from a face.
    fn line_along_plane(&self, from: DVec3, to: DVec3, face: &Plane) -> Self::Line;
    /// Rule 3c: whether a face whose front is seen cannot meet the screen.
    fn misses_screen(&self, front: &[DVec3; 3]) -> bool;
    /// What faces are clipped to if their sides are to be drawn straight (`beam-edges = paper`).
    fn stripe(&self) -> Option<&Stripe>;
    /// The range of a point at or beyond the SPP, along its ray, metres.
    fn range(&self, p: DVec3) -> f64;
    /// 1/t along the row at `y`, or `None` where the row does not see the face. (1b)
    fn inverse_t(&self, face: &Plane, y: f64) -> Option<Affine>;
    /// n.(a - o) for the origin o of the row at `y`.
    fn row_distance(&self, face: &Plane, y: f64) -> f64;
    /// Where the rays of the row at `y` start, sensor frame.
    fn row_origin(&self, y: f64) -> DVec3;
    /// The ray direction of the cell centred at (x, y), sensor frame.
    fn q(&self, x: f64, y: f64) -> DVec3;
    /// |q| of every cell of row `j`.
    fn q_lengths(&self, j: u32) -> &[f64];
}

/// The plane of a face as a sensor sees it: n.p = d.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// n = (b - a) x (c - a), sensor frame, not a unit.
    pub(crate) normal: DVec3,
    /// d = n.(a - position of the sensor); negative where the front is seen.
    pub(crate) distance: f64,
    /// n / d.
    pub(crate) normal_over_distance: DVec3,
}

impl Plane {
    /// Formed in the scene frame, whose edge vectors are exact, and only then turned.
    #[inline]
    pub(crate) fn of(scene_vertices: &[DVec3; 3], sensor_from_scene: &SensorFromScene) -> Self {
        let (n, distance) = scene_plane(scene_vertices, sensor_from_scene);
        let normal = sensor_from_scene.turn(n);
        Self { normal, distance, normal_over_distance: normal / distance }
    }
}

/// n and d of a face, n along the scene's axes.
///
/// Reckoned from the corner of the lowest position, so that faces of the same three corners tie exactly,
/// whichever corner their lists begin with.
#[inline]
pub(crate) fn scene_plane(corners: &[DVec3; 3], sensor_from_scene: &SensorFromScene) -> (DVec3, f64) {
    let lowest = (1..3).fold(0, |lowest, k| if is_lower(&corners[k], &corners[lowest]) { k } else { lowest });
    let [a, b, c] = [corners[lowest], corners[(lowest + 1) % 3], corners[(lowest + 2) % 3]];
    let n = (b - a).cross(c - a);
    (n, n.dot(sensor_from_scene.relative(a)))
}

/// Lexicographic order of positions.
#[inline]
fn is_lower(p: &DVec3, q: &DVec3) -> bool {
    (p.x, p.y, p.z) < (q.x, q.y, q.z)
}

/// `slope x + start`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Affine {
    pub(crate) slope: f64,
    pub(crate) start: f64,
}

/// How near a piece may come: 1/t is kept at most `kept`, and does not count at all beyond `accepted`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    pub(crate) accepted: f64,
    pub(crate) kept: f64,
}

impl Nearest {
    /// For a piece whose corners are all at or beyond the SPP: it is nowhere nearer than they are.
    pub(crate) const ANY: Self = Self { accepted: f64::MAX, kept: f64::MAX };
    /// For what a cut along the SPP leaves, whose new side is the line 1/t = 1: a cell on that side is met at
    /// t = 1, whichever way its 1/t was rounded. It must neither come out in front of the SPP nor be lost.
    pub(crate) const HELD_AT_SPP: Self = Self { accepted: f64::MAX, kept: 1.0 };
    /// For straight sides, which reach beyond a face: its plane may lie in front of the SPP there. What does is
    /// not seen.
    ///
    /// CHOICE: the paper does not say; a hit on no face at no distance would serve nobody.
    pub(crate) const BEYOND_SPP: Self = Self { accepted: 1.0, kept: 1.0 };
}

/// Some rows of a sensor's raster while its faces are scanned.
pub(crate) struct Raster {
    first_row: u32,
    width: usize,
    /// 1/t of the nearest face so far; 0 where there is none, which is infinitely far.
    inverse_t: Vec<f64>,
    face: Vec<FaceId>,
}

impl Raster {
    pub(crate) fn new(first_row: u32, rows: u32, width: u32) -> Self {
        let cells = rows as usize * width as usize;
        Self {
            first_row,
            width: width as usize,
            inverse_t: vec![0.0; cells],
            face: vec![FaceId(u32::MAX); cells],
        }
    }

    /// Scans the cells `columns` of row `j`: the nearer face stays. Faces come in ascending order, so of
    /// equally near ones the lowest stays.
    #[inline]
    pub(crate) fn scan_row(
        &mut self,
        j: u32,
        columns: std::ops::Range<u32>,
        centres: &[f64],
        inverse_t: Affine,
        nearest: Nearest,
        id: FaceId,
    ) {
        let row = (j - self.first_row) as usize * self.width;
        let range = columns.start as usize..columns.end as usize;
        let kept = &mut self.inverse_t[row..row + self.width][range.clone()];
        let faces = &mut self.face[row..row + self.width][range.clone()];
        for ((kept, face), x) in kept.iter_mut().zip(faces).zip(&centres[range]) {
            let candidate = inverse_t.slope * x + inverse_t.start;
            let held = candidate.min(nearest.kept);
            if held > *kept && candidate <= nearest.accepted {
                *kept = held;
                *face = id;
            }
        }
    }

    /// Turns 1/t into the quantities asked for, row by row.
    pub(crate) fn resolve<T: Transformation>(
        &self,
        mesh: &Mesh,
        transformation: &T,
        quantities: Quantities,
        rows: &mut [SensorRow<'_>],
    ) {
        let geometry = quantities.point || quantities.normal || quantities.cos_incidence;
        for row in rows {
            let cells = (row.j - self.first_row) as usize * self.width;
            let kept = &self.inverse_t[cells..cells + self.width];
            let faces = &self.face[cells..cells + self.width];
            let q_lengths = transformation.q_lengths(row.j);
            for (i, ((&inverse_t, &face), &q_length)) in kept.iter().zip(faces).zip(q_lengths).enumerate() {
                if inverse_t == 0.0 {
                    continue;
                }
                // R = t |q|, from the table.
                let range = q_length / inverse_t;
                if !(range <= transformation.max_range()) {
                    continue;
                }
                if geometry {
                    row.put(
                        i as u32,
                        &hit(mesh, transformation, (i as u32, row.j), face, inverse_t, q_length, range),
                    );
                    continue;
                }
                if let Some(cells) = &mut row.range {
                    cells[i] = Maybe::some(range);
                }
                if let Some(cells) = &mut row.face {
                    cells[i] = Maybe::some(face);
                }
                if let Some(cells) = &mut row.depth {
                    cells[i] = Maybe::some(transformation.plane_distance() / inverse_t);
                }
            }
        }
    }
}

/// The whole hit of one cell.
fn hit<T: Transformation>(
    mesh: &Mesh,
    transformation: &T,
    (i, j): (u32, u32),
    face: FaceId,
    inverse_t: f64,
    q_length: f64,
    range: f64,
) -> Hit {
    let sensor_from_scene = transformation.sensor_from_scene();
    let (x, y) = (transformation.columns().centre(i), transformation.rows().centre(j));
    let p = transformation.row_origin(y) + transformation.q(x, y) / inverse_t;
    let vertices = mesh.faces()[face.0 as usize].map(|v| widen(mesh.vertices()[v as usize]));
    let (n, _) = scene_plane(&vertices, sensor_from_scene);
    let n_length = n.length();
    // n.q = d / t, so cos(psi) = -n.q / (|n| |q|) needs no direction.
    let distance = transformation.row_distance(&Plane::of(&vertices, sensor_from_scene), y);
    Hit {
        face,
        range,
        point: sensor_from_scene.back(p),
        normal: n / n_length,
        depth: transformation.plane_distance() / inverse_t,
        cos_incidence: -distance * inverse_t / (n_length * q_length),
    }
}
