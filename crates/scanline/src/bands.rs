//! The main loop of §4: faces are sorted into bands of rows, and bands are scanned in parallel.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{FaceId, Mesh, Quantities, SensorId, SensorMap, SensorRow};

use crate::clip::{Edge, NewLines, Piece, clip_at_plane};
use crate::printed::Screen;
use crate::raster::{Nearest, Plane, Raster, Transformation, scene_plane};
use crate::scan::{Line, SplitTriangle};
use crate::skip::{ABOVE, BEHIND_PLANE, BELOW, LEFT, RIGHT};
use crate::vertices::{self, Vertex, widen};
use crate::{Fidelity, Options, sides};

/// Faces that one task sorts into bands.
const FACES_PER_TASK: usize = 8192;

/// Cells of a band: 1/t and face of that many fit a core's own cache.
const CELLS_PER_BAND: u32 = 32_768;

/// Rows of a band: all of a small raster, one of a very wide one.
fn rows_per_band(width: u32, height: u32) -> u32 {
    (CELLS_PER_BAND / width).clamp(1, height)
}

/// Renders the maps of one sensor.
pub(crate) fn render<T: Transformation>(
    mesh: &Mesh,
    transformation: &T,
    sensor: SensorId,
    quantities: Quantities,
    options: Options,
) -> SensorMap {
    let (width, height) = (transformation.columns().count(), transformation.rows().count());
    let mut map = SensorMap::empty(sensor, width, height, quantities);

    // Step 2: all vertices into the sensor's frame.
    let vertices = vertices::transform(mesh, |scene_point| {
        let sensor_from_scene = transformation.sensor_from_scene();
        let position = sensor_from_scene.turn(sensor_from_scene.relative(scene_point));
        let corner = transformation.project(position);
        Vertex { position, corner, outside: transformation.outside(position) }
    });

    // Steps 1 and 3: drop the faces that cannot be seen, sort the others into bands of rows.
    let rows_per_band = rows_per_band(width, height);
    let band_count = height.div_ceil(rows_per_band) as usize;
    let as_printed = options.switches.skip_rules == Fidelity::Paper;
    let faces = Faces {
        mesh,
        vertices: &vertices,
        transformation,
        skip_unseen: options.skip_unseen && !as_printed,
        screen: Screen::new(transformation.columns(), transformation.rows()),
    };
    let by_printed_rules_3 = options.skip_unseen && as_printed;
    let sorted: Vec<Vec<Vec<FaceId>>> = (0..mesh.faces().len().div_ceil(FACES_PER_TASK))
        .into_par_iter()
        .map(|task| {
            let mut bands = vec![Vec::new(); band_count];
            let first = task * FACES_PER_TASK;
            let end = (first + FACES_PER_TASK).min(mesh.faces().len());
            for index in first..end {
                let id = FaceId(index as u32);
                if let Some(rows) = faces.rows(id) {
                    for band in rows.start / rows_per_band..=(rows.end - 1) / rows_per_band {
                        bands[band as usize].push(id);
                    }
                }
            }
            bands
        })
        .collect();

    // Step 4, band by band.
    let mut rows = map.rows_mut();
    rows.par_chunks_mut(rows_per_band as usize).enumerate().for_each(|(band, rows)| {
        let mut raster = Raster::new(rows[0].j, rows.len() as u32, width);
        for task in &sorted {
            // Asked here, not for every face: that would cost the exact rules some 3 % of their time.
            if by_printed_rules_3 {
                faces.scan::<true>(&task[band], rows, &mut raster);
            } else {
                faces.scan::<false>(&task[band], rows, &mut raster);
            }
        }
        raster.resolve(mesh, transformation, quantities, rows);
    });
    drop(rows);
    map
}

/// The terrain as one sensor sees it.
struct Faces<'a, T> {
    mesh: &'a Mesh,
    vertices: &'a [Vertex],
    transformation: &'a T,
    /// Whether to skip what the conservative forms of rules 1 and 3 find unseen.
    skip_unseen: bool,
    /// For rules 3 as printed.
    screen: Screen,
}

impl<T: Transformation> Faces<'_, T> {
    /// Steps 1 and 3: the rows that a face may touch, or `None` if it cannot be seen. (As printed, 1b is asked
    /// in `Transformation::inverse_t` and rules 3 in `scan_piece`: those see what clipping leaves.)
    #[inline]
    fn rows(&self, id: FaceId) -> Option<std::ops::Range<u32>> {
        let transformation = self.transformation;
        let face = self.mesh.faces()[id.0 as usize];
        let [a, b, c] = face.map(|v| &self.vertices[v as usize]);
        let (all, any) = (a.outside & b.outside & c.outside, a.outside | b.outside | c.outside);
        if self.skip_unseen && all != 0 {
            return None;
        }
        if any & BEHIND_PLANE != 0 {
            // What clipping will leave of it is not known yet.
            return if all & BEHIND_PLANE != 0 { None } else { Some(0..transformation.rows().count()) };
        }
        let corners = [a.corner, b.corner, c.corner];
        let top = corners.iter().fold(f64::INFINITY, |top, corner| top.min(corner.y));
        let bottom = corners.iter().fold(f64::NEG_INFINITY, |bottom, corner| bottom.max(corner.y));
        let first = transformation.rows().first_at_or_after(top);
        let end = transformation.rows().end_at_or_before(bottom);
        if first >= end {
            return None;
        }
        if self.skip_unseen {
            // A face between two columns covers no cell.
            let left = corners.iter().fold(f64::INFINITY, |left, corner| left.min(corner.x));
            let right = corners.iter().fold(f64::NEG_INFINITY, |right, corner| right.max(corner.x));
            let columns = transformation.columns();
            if columns.first_at_or_after(left) >= columns.end_at_or_before(right) {
                return None;
            }
            // 1b, where it holds for every row. (A beam's rows differ: those are asked one by one.)
            let scene_vertices = face.map(|v| widen(self.mesh.vertices()[v as usize]));
            let (n, distance) = scene_plane(&scene_vertices, transformation.sensor_from_scene());
            let plane = Plane {
                normal: transformation.sensor_from_scene().turn(n),
                distance,
                normal_over_distance: n,
            };
            let rows = transformation.rows();
            if transformation.row_distance(&plane, rows.centre(first)) >= 0.0
                && transformation.row_distance(&plane, rows.centre(end - 1)) >= 0.0
            {
                return None;
            }
            if any & (LEFT | RIGHT | ABOVE | BELOW) != 0
                && transformation.misses_screen(&[a.position, b.position, c.position])
            {
                return None;
            }
        }
        Some(first..end)
    }

    /// Step 4: scans faces into some rows; `BY_RULES_3`: those that rules 3 as printed leave.
    #[inline(never)]
    fn scan<const BY_RULES_3: bool>(&self, ids: &[FaceId], rows: &[SensorRow<'_>], raster: &mut Raster) {
        for &id in ids {
            self.scan_face::<BY_RULES_3>(id, rows, raster);
        }
    }

    /// Step 4: scans a face into some rows.
    #[inline]
    fn scan_face<const BY_RULES_3: bool>(&self, id: FaceId, rows: &[SensorRow<'_>], raster: &mut Raster) {
        let face = self.mesh.faces()[id.0 as usize];
        let stored = face.map(|v| self.mesh.vertices()[v as usize]);
        let plane = Plane::of(&stored.map(widen), self.transformation.sensor_from_scene());
        let seen = face.map(|v| &self.vertices[v as usize]);
        if self.transformation.stripe().is_some() {
            self.scan_within_stripe::<BY_RULES_3>(id, &plane, rows, raster);
        } else if seen.iter().all(|vertex| vertex.outside & BEHIND_PLANE == 0) {
            let piece = Piece {
                points: seen.map(|vertex| vertex.position),
                corners: seen.map(|vertex| vertex.corner),
                lines: [
                    self.edge(&stored, &seen, 0, 1).line,
                    self.edge(&stored, &seen, 1, 2).line,
                    self.edge(&stored, &seen, 2, 0).line,
                ],
            };
            // All of the face is at or beyond the SPP.
            self.scan_piece::<_, BY_RULES_3>(&piece, &plane, Nearest::ANY, id, rows, raster);
        } else {
            self.scan_beyond_spp::<BY_RULES_3>(id, &plane, rows, raster);
        }
    }

    /// The edge of a face from corner k to the next.
    #[inline]
    fn edge(&self, stored: &[[f32; 3]; 3], seen: &[&Vertex; 3], k: usize, next: usize) -> Edge<T::Line> {
        sides::edge(self.transformation, stored, seen, k, next)
    }

    fn edges(&self, id: FaceId) -> [Edge<T::Line>; 3] {
        let face = self.mesh.faces()[id.0 as usize];
        let stored = face.map(|v| self.mesh.vertices()[v as usize]);
        let seen = face.map(|v| &self.vertices[v as usize]);
        sides::edges(self.transformation, &stored, &seen)
    }

    /// Step 4 for a face that the SPP cuts. Few are: kept out of line of the others.
    #[inline(never)]
    fn scan_beyond_spp<const BY_RULES_3: bool>(
        &self,
        id: FaceId,
        plane: &Plane,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let transformation = self.transformation;
        let seen = self.mesh.faces()[id.0 as usize].map(|v| &self.vertices[v as usize]);
        let (points, corners) = (seen.map(|vertex| vertex.position), seen.map(|vertex| vertex.corner));
        let new_lines = NewLines {
            along_plane: |from, to| transformation.line_along_plane(from, to, plane),
            diagonal: |from: DVec3, to: DVec3| transformation.line(from, to, to - from),
        };
        let spp = transformation.plane_distance();
        clip_at_plane(spp, points, corners, &self.edges(id), new_lines, |piece| {
            self.scan_piece::<_, BY_RULES_3>(piece, plane, Nearest::HELD_AT_SPP, id, rows, raster);
        });
    }

    /// Step 4 with straight sides (`beam-edges = paper`), kept out of line of the exact ones.
    #[inline(never)]
    fn scan_within_stripe<const BY_RULES_3: bool>(
        &self,
        id: FaceId,
        plane: &Plane,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let points = self.mesh.faces()[id.0 as usize].map(|v| self.vertices[v as usize].position);
        if let Some(stripe) = self.transformation.stripe() {
            stripe.clip(points, &self.edges(id), |piece| {
                self.scan_piece::<_, BY_RULES_3>(piece, plane, Nearest::BEYOND_SPP, id, rows, raster);
            });
        }
    }

    /// Step 3 as printed, and step 4 for what it leaves.
    #[inline]
    fn scan_piece<L: Line, const BY_RULES_3: bool>(
        &self,
        piece: &Piece<L>,
        plane: &Plane,
        nearest: Nearest,
        id: FaceId,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        if BY_RULES_3 {
            let max_range = self.transformation.max_range();
            let too_far = |k: usize| self.transformation.range(piece.points[k]) > max_range;
            if self.screen.skips(&piece.corners, too_far) {
                return;
            }
        }
        let triangle = SplitTriangle::new(piece.corners, piece.lines);
        self.scan_triangle(&triangle, plane, nearest, id, rows, raster);
    }

    /// Step 4b: the rows of one projected triangle.
    #[inline(always)]
    fn scan_triangle<L: Line>(
        &self,
        triangle: &SplitTriangle<L>,
        plane: &Plane,
        nearest: Nearest,
        id: FaceId,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let (x, y) = (self.transformation.columns(), self.transformation.rows());
        let (band_first, band_end) = (rows[0].j, rows[0].j + rows.len() as u32);
        let first = y.first_at_or_after(triangle.top()).max(band_first);
        let end = y.end_at_or_before(triangle.bottom()).min(band_end);
        for j in first..end {
            let y = y.centre(j);
            let (left, right) = triangle.span(y);
            let columns = x.first_at_or_after(left)..x.end_at_or_before(right);
            if columns.is_empty() {
                continue;
            }
            if let Some(inverse_t) = self.transformation.inverse_t(plane, y) {
                raster.scan_row(j, columns, x.centres(), inverse_t, nearest, id);
            }
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/bands.rs"]
mod tests;
