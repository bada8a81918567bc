//! The main loop of §4: faces are sorted into bands of rows, and the bands are scanned in parallel.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{FaceId, Mesh, Quantities, SensorId, SensorMap, SensorRow};

use crate::clip::{AddedLines, ClippedTriangle, Edge, clip_at_spp};
use crate::options::ScanlineOptions;
use crate::plane::{Plane, plane_in_scene};
use crate::printed_skip::SensorScreen;
use crate::raster::{InverseTLimits, Raster};
use crate::scan::SplitTriangle;
use crate::skip::{ABOVE, BEHIND_SPP, BELOW, LEFT, RIGHT};
use crate::spp::ProjectedLine;
use crate::transformation::Transformation;
use crate::vertices::{self, SensorVertex, widen};
use crate::{Fidelity, edges};

/// Number of faces that one task sorts into bands.
const FACES_PER_TASK: usize = 8192;

/// Number of cells of a band: 1/t and face of that many fit a core's own cache.
const CELLS_PER_BAND: u32 = 32_768;

/// Rows of a band: all rows of a small raster, one row of a very wide one.
fn rows_per_band(width: u32, height: u32) -> u32 {
    (CELLS_PER_BAND / width).clamp(1, height)
}

/// Renders the maps of one sensor.
pub(crate) fn render<T: Transformation>(
    mesh: &Mesh,
    transformation: &T,
    sensor: SensorId,
    quantities: Quantities,
    options: ScanlineOptions,
) -> SensorMap {
    let (width, height) = (transformation.columns().count(), transformation.rows().count());
    let mut map = SensorMap::empty(sensor, width, height, quantities);

    // Step 2: all vertices into the sensor's frame.
    let vertices = vertices::transform(mesh, |scene_point| {
        let sensor_from_scene = transformation.sensor_from_scene();
        let position = sensor_from_scene.in_sensor_axes(sensor_from_scene.offset_of(scene_point));
        let projection = transformation.project(position);
        SensorVertex { position, projection, outside: transformation.outside(position) }
    });

    // Steps 1 and 3: drop the faces that cannot be seen, sort the others into bands of rows.
    let rows_per_band = rows_per_band(width, height);
    let band_count = height.div_ceil(rows_per_band) as usize;
    let as_printed = options.switches.skip_rules == Fidelity::Paper;
    let scanner = FaceScanner {
        mesh,
        vertices: &vertices,
        transformation,
        skip_unseen: options.skip_unseen && !as_printed,
        screen: SensorScreen::new(transformation.columns(), transformation.rows()),
    };
    let printed_rules_3 = options.skip_unseen && as_printed;
    let faces_by_task: Vec<Vec<Vec<FaceId>>> = (0..mesh.faces().len().div_ceil(FACES_PER_TASK))
        .into_par_iter()
        .map(|task| {
            let mut bands = vec![Vec::new(); band_count];
            let first = task * FACES_PER_TASK;
            let end = (first + FACES_PER_TASK).min(mesh.faces().len());
            for index in first..end {
                let id = FaceId(index as u32);
                if let Some(rows) = scanner.rows(id) {
                    for band in rows.start / rows_per_band..=(rows.end - 1) / rows_per_band {
                        bands[band as usize].push(id);
                    }
                }
            }
            bands
        })
        .collect();

    // Step 4, band by band. A band scans its faces in ascending order for any number of threads.
    let mut rows = map.rows_mut();
    rows.par_chunks_mut(rows_per_band as usize).enumerate().for_each(|(band, rows)| {
        let mut raster = Raster::new(rows[0].j, rows.len() as u32, width);
        for bands in &faces_by_task {
            // Decided here, not for every face: that would cost the exact rules some 3 % of their time.
            if printed_rules_3 {
                scanner.scan::<true>(&bands[band], rows, &mut raster);
            } else {
                scanner.scan::<false>(&bands[band], rows, &mut raster);
            }
        }
        raster.resolve(mesh, transformation, quantities, rows);
    });
    drop(rows);
    map
}

/// The terrain's faces in the frame of one sensor, and the rules by which they are skipped.
struct FaceScanner<'a, T> {
    mesh: &'a Mesh,
    vertices: &'a [SensorVertex],
    transformation: &'a T,
    /// Whether faces are skipped by the conservative forms of rules 1 and 3.
    skip_unseen: bool,
    /// The screen of rules 3 as printed.
    screen: SensorScreen,
}

impl<T: Transformation> FaceScanner<'_, T> {
    /// Steps 1 and 3: the rows that a face may touch, or `None` if it cannot be seen.
    ///
    /// The printed rules are applied later, since they concern what clipping leaves: 1b in
    /// `Transformation::row_inverse_t`, rules 3 in `scan_clipped`.
    #[inline]
    fn rows(&self, id: FaceId) -> Option<std::ops::Range<u32>> {
        let transformation = self.transformation;
        let face = self.mesh.faces()[id.0 as usize];
        let [a, b, c] = face.map(|v| &self.vertices[v as usize]);
        let (all, any) = (a.outside & b.outside & c.outside, a.outside | b.outside | c.outside);
        // 1a, 3a, 3b.
        if self.skip_unseen && all != 0 {
            return None;
        }
        if any & BEHIND_SPP != 0 {
            // The rows of what clipping will leave are not known yet.
            return if all & BEHIND_SPP != 0 { None } else { Some(0..transformation.rows().count()) };
        }
        let corners = [a.projection, b.projection, c.projection];
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
            // 1b, if no row sees the front. (The rows of a beam differ. Between the first and the last the offset is
            // affine in y.)
            let scene_vertices = face.map(|v| widen(self.mesh.vertices()[v as usize]));
            let (n, offset) = plane_in_scene(&scene_vertices, transformation.sensor_from_scene());
            let plane = Plane {
                normal: transformation.sensor_from_scene().in_sensor_axes(n),
                offset,
                // Not used by `row_offset`; a division less.
                normal_over_offset: n,
            };
            let rows = transformation.rows();
            if transformation.row_offset(&plane, rows.centre(first)) >= 0.0
                && transformation.row_offset(&plane, rows.centre(end - 1)) >= 0.0
            {
                return None;
            }
            // 3c.
            if any & (LEFT | RIGHT | ABOVE | BELOW) != 0
                && transformation.misses_screen(&[a.position, b.position, c.position])
            {
                return None;
            }
        }
        Some(first..end)
    }

    /// Step 4: scans faces into some rows. With `PRINTED_RULES_3` it first applies rules 3 as printed.
    #[inline(never)]
    fn scan<const PRINTED_RULES_3: bool>(&self, ids: &[FaceId], rows: &[SensorRow<'_>], raster: &mut Raster) {
        for &id in ids {
            self.scan_face::<PRINTED_RULES_3>(id, rows, raster);
        }
    }

    /// Step 4: scans a face into some rows.
    #[inline]
    fn scan_face<const PRINTED_RULES_3: bool>(
        &self,
        id: FaceId,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let face = self.mesh.faces()[id.0 as usize];
        let in_scene = face.map(|v| self.mesh.vertices()[v as usize]);
        let plane = Plane::new(&in_scene.map(widen), self.transformation.sensor_from_scene());
        let in_sensor = face.map(|v| &self.vertices[v as usize]);
        if self.transformation.stripe_volume().is_some() {
            self.scan_within_stripe::<PRINTED_RULES_3>(id, &plane, rows, raster);
        } else if in_sensor.iter().all(|vertex| vertex.outside & BEHIND_SPP == 0) {
            let triangle = ClippedTriangle {
                points: in_sensor.map(|vertex| vertex.position),
                corners: in_sensor.map(|vertex| vertex.projection),
                lines: [
                    self.edge(&in_scene, &in_sensor, 0, 1).line,
                    self.edge(&in_scene, &in_sensor, 1, 2).line,
                    self.edge(&in_scene, &in_sensor, 2, 0).line,
                ],
            };
            // The whole face is at or beyond the SPP.
            self.scan_clipped::<_, PRINTED_RULES_3>(
                &triangle,
                &plane,
                InverseTLimits::NONE,
                id,
                rows,
                raster,
            );
        } else {
            self.scan_beyond_spp::<PRINTED_RULES_3>(id, &plane, rows, raster);
        }
    }

    /// The edge of a face from vertex k to `next`.
    #[inline]
    fn edge(
        &self,
        in_scene: &[[f32; 3]; 3],
        in_sensor: &[&SensorVertex; 3],
        k: usize,
        next: usize,
    ) -> Edge<T::Line> {
        edges::edge(self.transformation, in_scene, in_sensor, k, next)
    }

    /// The three edges of a face.
    fn edges(&self, id: FaceId) -> [Edge<T::Line>; 3] {
        let face = self.mesh.faces()[id.0 as usize];
        let in_scene = face.map(|v| self.mesh.vertices()[v as usize]);
        let in_sensor = face.map(|v| &self.vertices[v as usize]);
        edges::edges(self.transformation, &in_scene, &in_sensor)
    }

    /// Step 4 for a face that the SPP cuts. Few are: it is kept out of line of the others.
    #[inline(never)]
    fn scan_beyond_spp<const PRINTED_RULES_3: bool>(
        &self,
        id: FaceId,
        plane: &Plane,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let transformation = self.transformation;
        let vertices = self.mesh.faces()[id.0 as usize].map(|v| &self.vertices[v as usize]);
        let points = vertices.map(|vertex| vertex.position);
        let corners = vertices.map(|vertex| vertex.projection);
        let added_lines = AddedLines {
            along_spp: |from, to| transformation.project_spp_cut(from, to, plane),
            diagonal: |from: DVec3, to: DVec3| transformation.project_edge(from, to, to - from),
        };
        let spp = transformation.spp_distance();
        clip_at_spp(spp, points, corners, &self.edges(id), added_lines, |triangle| {
            let limits = InverseTLimits::CLAMP_TO_SPP;
            self.scan_clipped::<_, PRINTED_RULES_3>(triangle, plane, limits, id, rows, raster);
        });
    }

    /// Step 4 with straight sides (`beam-edges = paper`), kept out of line of the exact ones.
    #[inline(never)]
    fn scan_within_stripe<const PRINTED_RULES_3: bool>(
        &self,
        id: FaceId,
        plane: &Plane,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let points = self.mesh.faces()[id.0 as usize].map(|v| self.vertices[v as usize].position);
        if let Some(volume) = self.transformation.stripe_volume() {
            volume.clip(points, &self.edges(id), |triangle| {
                let limits = InverseTLimits::REJECT_BEFORE_SPP;
                self.scan_clipped::<_, PRINTED_RULES_3>(triangle, plane, limits, id, rows, raster);
            });
        }
    }

    /// Step 3 as printed, and step 4 for the triangles that it leaves.
    #[inline]
    fn scan_clipped<L: ProjectedLine, const PRINTED_RULES_3: bool>(
        &self,
        triangle: &ClippedTriangle<L>,
        plane: &Plane,
        limits: InverseTLimits,
        id: FaceId,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        if PRINTED_RULES_3 {
            let max_range = self.transformation.max_range();
            let too_far = |k: usize| self.transformation.range(triangle.points[k]) > max_range;
            if self.screen.skips(&triangle.corners, too_far) {
                return;
            }
        }
        let split = SplitTriangle::new(triangle.corners, triangle.lines);
        self.scan_split(&split, plane, limits, id, rows, raster);
    }

    /// Step 4b: the rows of one projected triangle.
    #[inline(always)]
    fn scan_split<L: ProjectedLine>(
        &self,
        triangle: &SplitTriangle<L>,
        plane: &Plane,
        limits: InverseTLimits,
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
            if let Some(row_inverse_t) = self.transformation.row_inverse_t(plane, y) {
                raster.scan_row(j, columns, x.centres(), row_inverse_t, limits, id);
            }
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/bands.rs"]
mod tests;
