//! The main loop of §4: faces are sorted into bands of rows, and the bands are scanned in parallel. Of equally near faces a
//! cell keeps the one with the lowest index, so neither the order of faces nor the number of threads matters.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{FaceId, Mesh, Quantities, SensorId, SensorMap, SensorRow};

use crate::clip::{AddedLines, ClippedTriangle, Edge, clip_at_spp};
use crate::clusters::Clusters;
use crate::options::ScanlineOptions;
use crate::plane::{Plane, plane_in_scene};
use crate::printed_skip::SensorScreen;
use crate::raster::{InverseTLimits, Raster};
use crate::scan::SplitTriangle;
use crate::skip::{ABOVE, BEHIND_SPP, BELOW, LEFT, RIGHT};
use crate::spp::ProjectedLine;
use crate::spp::widen;
use crate::transformation::Transformation;
use crate::vertices::{PlacedFace, SensorVertex, TransformedClusters};
use crate::{Fidelity, edges};

/// Number of clusters whose faces one task sorts into bands.
const CLUSTERS_PER_TASK: usize = 64;

/// Number of cells of a band: 1/t and face of that many fit a core's own cache.
const CELLS_PER_BAND: u32 = 32_768;

/// Rows of a band: all rows of a small raster, one row of a very wide one.
fn rows_per_band(width: u32, height: u32) -> u32 {
    (CELLS_PER_BAND / width).clamp(1, height)
}

/// The faces of some clusters, sorted into bands of rows.
struct SortedClusters {
    clusters: TransformedClusters,
    /// The faces that may touch each band.
    bands: Vec<Vec<PlacedFace>>,
}

/// The side of the faces that rays meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MetSide {
    Fronts,
    /// As if all faces were turned over. What follows from a hit's face is still that of the face itself.
    Backs,
}

/// Renders the maps of one sensor.
pub(crate) fn render<T: Transformation>(
    mesh: &Mesh,
    clusters: &Clusters,
    transformation: &T,
    sensor: SensorId,
    (quantities, side): (Quantities, MetSide),
    options: ScanlineOptions,
) -> SensorMap {
    let (width, height) = (transformation.columns().count(), transformation.rows().count());
    let mut map = SensorMap::unwritten(sensor, width, height, quantities);

    let as_printed = options.switches.skip_rules == Fidelity::Paper;
    let scanner = FaceScanner {
        transformation,
        skip_unseen: options.skip_unseen && !as_printed,
        screen: SensorScreen::new(transformation.columns(), transformation.rows()),
    };
    let printed_rules_3 = options.skip_unseen && as_printed;
    let sensor_from_scene = transformation.sensor_from_scene();

    // Steps 1 and 3 for whole clusters.
    let seen = if scanner.skip_unseen {
        clusters.seen(sensor_from_scene.position(), |corners| {
            let outside = |corner: &DVec3| transformation.outside(sensor_from_scene.in_sensor_axes(*corner));
            corners.iter().fold(u8::MAX, |all, corner| all & outside(corner)) != 0
        })
    } else {
        clusters.all()
    };

    // Step 2: the vertices of the others into the sensor's frame. Steps 1 and 3: drop the faces that cannot be seen, sort
    // the others into bands of rows.
    let rows_per_band = rows_per_band(width, height);
    let band_count = height.div_ceil(rows_per_band) as usize;
    let sorted: Vec<SortedClusters> = seen
        .par_chunks(CLUSTERS_PER_TASK)
        .map(|which| {
            let clusters =
                TransformedClusters::new(mesh, clusters, which, side == MetSide::Backs, |in_scene| {
                    let offset = sensor_from_scene.offset_of(widen(in_scene));
                    let position = sensor_from_scene.in_sensor_axes(offset);
                    let projection = transformation.project(position);
                    SensorVertex { in_scene, position, projection, outside: transformation.outside(position) }
                });
            let mut bands = vec![Vec::new(); band_count];
            for &face in &clusters.faces {
                if let Some(rows) = scanner.rows(&clusters, face) {
                    for band in rows.start / rows_per_band..=(rows.end - 1) / rows_per_band {
                        bands[band as usize].push(face);
                    }
                }
            }
            SortedClusters { clusters, bands }
        })
        .collect();

    // Step 4, band by band.
    let mut rows = map.rows_mut();
    rows.par_chunks_mut(rows_per_band as usize).enumerate().for_each(|(band, rows)| {
        let mut raster = Raster::new(rows[0].j, rows.len() as u32, width);
        for SortedClusters { clusters, bands } in &sorted {
            // Decided here, not for every face: that would cost the exact rules some 3 % of their time.
            if printed_rules_3 {
                scanner.scan::<true>(clusters, &bands[band], rows, &mut raster);
            } else {
                scanner.scan::<false>(clusters, &bands[band], rows, &mut raster);
            }
        }
        raster.resolve(mesh, transformation, quantities, rows);
    });
    drop(rows);
    map
}

/// A sensor, and the rules by which faces are skipped.
struct FaceScanner<'a, T> {
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
    fn rows(&self, clusters: &TransformedClusters, face: PlacedFace) -> Option<std::ops::Range<u32>> {
        let transformation = self.transformation;
        let [a, b, c] = clusters.vertices_of(face);
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
            let scene_vertices = [a, b, c].map(|vertex| widen(vertex.in_scene));
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
    fn scan<const PRINTED_RULES_3: bool>(
        &self,
        clusters: &TransformedClusters,
        faces: &[PlacedFace],
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        for &face in faces {
            self.scan_face::<PRINTED_RULES_3>(clusters, face, rows, raster);
        }
    }

    /// Step 4: scans a face into some rows.
    #[inline]
    fn scan_face<const PRINTED_RULES_3: bool>(
        &self,
        clusters: &TransformedClusters,
        face: PlacedFace,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let id = face.id;
        let in_sensor = clusters.vertices_of(face);
        let in_scene = in_sensor.map(|vertex| widen(vertex.in_scene));
        let plane = Plane::new(&in_scene, self.transformation.sensor_from_scene());
        if self.transformation.stripe_volume().is_some() {
            self.scan_within_stripe::<PRINTED_RULES_3>(id, in_sensor, &plane, rows, raster);
        } else if in_sensor.iter().all(|vertex| vertex.outside & BEHIND_SPP == 0) {
            let triangle = ClippedTriangle {
                points: in_sensor.map(|vertex| vertex.position),
                corners: in_sensor.map(|vertex| vertex.projection),
                lines: [
                    self.edge(&in_sensor, 0, 1).line,
                    self.edge(&in_sensor, 1, 2).line,
                    self.edge(&in_sensor, 2, 0).line,
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
            self.scan_beyond_spp::<PRINTED_RULES_3>(id, in_sensor, &plane, rows, raster);
        }
    }

    /// The edge of a face from vertex k to `next`.
    #[inline]
    fn edge(&self, vertices: &[&SensorVertex; 3], k: usize, next: usize) -> Edge<T::Line> {
        edges::edge(self.transformation, vertices, k, next)
    }

    /// The three edges of a face.
    fn edges(&self, vertices: [&SensorVertex; 3]) -> [Edge<T::Line>; 3] {
        edges::edges(self.transformation, &vertices)
    }

    /// Step 4 for a face that the SPP cuts. Few are: it is kept out of line of the others.
    #[inline(never)]
    fn scan_beyond_spp<const PRINTED_RULES_3: bool>(
        &self,
        id: FaceId,
        vertices: [&SensorVertex; 3],
        plane: &Plane,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let transformation = self.transformation;
        let points = vertices.map(|vertex| vertex.position);
        let corners = vertices.map(|vertex| vertex.projection);
        let added_lines = AddedLines {
            along_spp: |from, to| transformation.project_spp_cut(from, to, plane),
            diagonal: |from: DVec3, to: DVec3| transformation.project_edge(from, to, to - from),
        };
        let spp = transformation.spp_distance();
        clip_at_spp(spp, points, corners, &self.edges(vertices), added_lines, |triangle| {
            let limits = InverseTLimits::CLAMP_TO_SPP;
            self.scan_clipped::<_, PRINTED_RULES_3>(triangle, plane, limits, id, rows, raster);
        });
    }

    /// Step 4 with straight sides (`beam-edges = paper`), kept out of line of the exact ones.
    #[inline(never)]
    fn scan_within_stripe<const PRINTED_RULES_3: bool>(
        &self,
        id: FaceId,
        vertices: [&SensorVertex; 3],
        plane: &Plane,
        rows: &[SensorRow<'_>],
        raster: &mut Raster,
    ) {
        let points = vertices.map(|vertex| vertex.position);
        if let Some(volume) = self.transformation.stripe_volume() {
            volume.clip(points, &self.edges(vertices), |triangle| {
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
