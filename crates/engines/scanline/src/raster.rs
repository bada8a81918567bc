//! Step 4b: the range raster map, stored as the largest 1/t per cell, and the quantities that follow from it.
//! (§4, 4b; §5 "without using square roots")

use raypencil_scene::{FaceId, Hit, Maybe, Mesh, Quantities, SensorRow};

use crate::plane::{Plane, plane_in_scene};
use crate::spp::widen;
use crate::transformation::{RowInverseT, Transformation};

/// Limits on the 1/t of a triangle's cells. t = 1 is the SPP; a larger 1/t is in front of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InverseTLimits {
    /// Cells with a larger 1/t are not hit.
    pub(crate) accept_up_to: f64,
    /// A larger 1/t is stored as this.
    pub(crate) clamp_to: f64,
}

impl InverseTLimits {
    /// For a triangle whose vertices are all at or beyond the SPP: no part of it is nearer than they are.
    pub(crate) const NONE: Self = Self { accept_up_to: f64::MAX, clamp_to: f64::MAX };
    /// For a triangle cut at the SPP. Its new side is the line 1/t = 1: a cell on that side is hit at t = 1, whichever
    /// way its 1/t was rounded. It must neither come out in front of the SPP nor be lost.
    pub(crate) const CLAMP_TO_SPP: Self = Self { accept_up_to: f64::MAX, clamp_to: 1.0 };
    /// For straight sides, which reach beyond a face. The face's plane may lie in front of the SPP there, and then
    /// nothing is hit.
    ///
    /// CHOICE: the paper does not say. A hit in front of the SPP, where the face has no point, would be useless.
    pub(crate) const REJECT_BEFORE_SPP: Self = Self { accept_up_to: 1.0, clamp_to: 1.0 };
}

/// Some rows of a sensor's raster while its faces are scanned.
pub(crate) struct Raster {
    first_row: u32,
    width: usize,
    /// 1/t of the nearest face so far; 0, which is infinitely far, where there is none.
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

    /// Scans the cells `columns` of row `j`; each keeps the nearer face, of equally near ones the lowest.
    #[inline]
    pub(crate) fn scan_row(
        &mut self,
        j: u32,
        columns: std::ops::Range<u32>,
        centres: &[f64],
        row_inverse_t: RowInverseT,
        limits: InverseTLimits,
        id: FaceId,
    ) {
        let row = (j - self.first_row) as usize * self.width;
        let range = columns.start as usize..columns.end as usize;
        let stored = &mut self.inverse_t[row..row + self.width][range.clone()];
        let faces = &mut self.face[row..row + self.width][range.clone()];
        for ((stored, face), x) in stored.iter_mut().zip(faces).zip(&centres[range]) {
            let candidate = row_inverse_t.slope * x + row_inverse_t.start;
            let clamped = candidate.min(limits.clamp_to);
            let is_nearer = clamped > *stored || clamped == *stored && id < *face;
            if is_nearer && candidate <= limits.accept_up_to {
                *stored = clamped;
                *face = id;
            }
        }
    }

    /// Writes the requested quantities of every hit cell, row by row.
    pub(crate) fn resolve<T: Transformation>(
        &self,
        mesh: &Mesh,
        transformation: &T,
        quantities: Quantities,
        rows: &mut [SensorRow<'_>],
    ) {
        let needs_hit = quantities.point || quantities.normal || quantities.cos_incidence;
        for row in rows {
            let cells = (row.j - self.first_row) as usize * self.width;
            let inverse_ts = &self.inverse_t[cells..cells + self.width];
            let faces = &self.face[cells..cells + self.width];
            let q_lengths = transformation.q_lengths(row.j);
            for (i, ((&inverse_t, &face), &q_length)) in
                inverse_ts.iter().zip(faces).zip(q_lengths).enumerate()
            {
                if inverse_t == 0.0 {
                    row.put_miss(i as u32);
                    continue;
                }
                // R = t |q|, from the table.
                let range = q_length / inverse_t;
                if !(range <= transformation.max_range()) {
                    row.put_miss(i as u32);
                    continue;
                }
                if needs_hit {
                    let hit = hit(mesh, transformation, (i as u32, row.j), face, inverse_t, q_length, range);
                    row.put(i as u32, &hit);
                    continue;
                }
                if let Some(cells) = &mut row.range {
                    cells[i] = Maybe::some(range);
                }
                if let Some(cells) = &mut row.face {
                    cells[i] = Maybe::some(face);
                }
                if let Some(cells) = &mut row.depth {
                    cells[i] = Maybe::some(transformation.spp_distance() / inverse_t);
                }
            }
        }
    }
}

/// The hit of one cell, with all its quantities.
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
    let (n, _) = plane_in_scene(&vertices, sensor_from_scene);
    let n_length = n.length();
    // n.q = d / t, so cos(psi) = -n.q / (|n| |q|) needs no direction.
    let offset = transformation.row_offset(&Plane::new(&vertices, sensor_from_scene), y);
    Hit {
        face,
        range,
        point: sensor_from_scene.scene_point(p),
        normal: n / n_length,
        depth: transformation.spp_distance() / inverse_t,
        cos_incidence: -offset * inverse_t / (n_length * q_length),
    }
}
