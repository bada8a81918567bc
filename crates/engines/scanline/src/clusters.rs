//! The terrain's faces in clusters of neighbours, so that those far from a sensor's view are skipped together.
//!
//! A cluster is skipped where each of its faces would be, by the same rules 1a, 3a and 3b of `skip`: all of its vertices are
//! outside one and the same side. What is asked is its box. A map is the same with and without clusters.
//!
//! # Why a box decides for its vertices
//!
//! Each side is a linear function L of a point's place in the scene, with a gradient g that the sensor's axes and the side
//! give, and the point is outside where L < 0. As computed, with u = 2^-53 and o the point's offset from the sensor, L is
//! off by less than 16 u |o| |g|: one rounding of the offset, five of each coordinate, and two of each product and of their
//! difference. A box is widened by 2^-40 of the largest offset of its corners before it is asked: that raises its largest L
//! by 2^-40 |o| |g| at least, which is 2^8 times as much as the errors at a corner and at a vertex together. So where all
//! corners of the widened box are computed to be outside a side, all vertices within the box are.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{FaceId, Mesh};

use crate::spp::widen;

/// Maximum faces of a cluster. Tuned: 64 and 128 are alike.
const MAX_FACES: usize = 96;

/// Minimum faces of a cluster that is closed because the curve jumps. Tuned.
const MIN_FACES: usize = 24;

/// Maximum vertices of a cluster: their places in it are single bytes.
const MAX_VERTICES: usize = 256;

/// Clusters of a group, which are asked about together first.
const CLUSTERS_PER_GROUP: usize = 32;

/// By how much a box is widened, relative to the largest offset of its corners from the sensor: 2^-40.
const RELATIVE_WIDENING: f64 = 1.0 / (1u64 << 40) as f64;

/// A mesh in clusters.
#[derive(Debug)]
pub(crate) struct Clusters {
    mesh: Arc<Mesh>,
    clusters: Vec<Cluster>,
    /// The box of each run of [`CLUSTERS_PER_GROUP`] clusters.
    groups: Vec<Bounds>,
    /// The vertices of the clusters, one after the other, by their index in the mesh.
    vertices: Vec<u32>,
    faces: Vec<ClusterFace>,
}

/// Neighbouring faces: where their vertices and they themselves begin. They end where the next cluster begins.
#[derive(Debug, Clone, Copy)]
struct Cluster {
    bounds: Bounds,
    first_vertex: u32,
    first_face: u32,
}

/// A face of a cluster.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ClusterFace {
    pub(crate) id: FaceId,
    /// Places of its corners among the cluster's vertices.
    pub(crate) corners: [u8; 3],
}

/// A box around vertices, exactly.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    low: [f32; 3],
    high: [f32; 3],
}

impl Bounds {
    const NOTHING: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn union(self, other: Self) -> Self {
        let low = [0, 1, 2].map(|k| self.low[k].min(other.low[k]));
        let high = [0, 1, 2].map(|k| self.high[k].max(other.high[k]));
        Self { low, high }
    }

    fn with(self, vertex: [f32; 3]) -> Self {
        self.union(Self { low: vertex, high: vertex })
    }

    /// The corners of the box, as offsets from `position`, after it is widened as far as roundings may reach.
    fn corners(&self, position: DVec3) -> [DVec3; 8] {
        let (low, high) = (widen(self.low) - position, widen(self.high) - position);
        let widening = DVec3::splat(RELATIVE_WIDENING * low.abs().max(high.abs()).length());
        let (low, high) = (low - widening, high + widening);
        std::array::from_fn(|corner| {
            let at = |k: usize| if corner >> k & 1 == 0 { low[k] } else { high[k] };
            DVec3::new(at(0), at(1), at(2))
        })
    }
}

/// The faces and vertices of one cluster.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ClusterContent<'c> {
    /// Indices of the mesh's vertices.
    pub(crate) vertices: &'c [u32],
    pub(crate) faces: &'c [ClusterFace],
}

impl Clusters {
    /// Sorts the faces of a mesh along a space-filling curve (Z-order) and cuts it into clusters.
    pub(crate) fn new(mesh: &Arc<Mesh>) -> Self {
        let order = in_z_order(mesh);
        // Pieces of the curve on all threads. Their length does not depend on the number of threads.
        const FACES_PER_PIECE: usize = 64 * MAX_FACES;
        let pieces: Vec<Piece> =
            order.par_chunks(FACES_PER_PIECE).map(|faces| Piece::of(mesh, faces)).collect();
        let mut all = Piece::default();
        for piece in pieces {
            let (first_vertex, first_face) = (all.vertices.len() as u32, all.faces.len() as u32);
            all.vertices.extend(piece.vertices);
            all.faces.extend(piece.faces);
            all.clusters.extend(piece.clusters.into_iter().map(|cluster| Cluster {
                first_vertex: cluster.first_vertex + first_vertex,
                first_face: cluster.first_face + first_face,
                ..cluster
            }));
        }
        let Piece { clusters, vertices, faces } = all;
        let union = |group: &[Cluster]| {
            group.iter().fold(Bounds::NOTHING, |bounds, cluster| bounds.union(cluster.bounds))
        };
        let groups = clusters.chunks(CLUSTERS_PER_GROUP).map(union).collect();
        Self { mesh: Arc::clone(mesh), clusters, groups, vertices, faces }
    }

    /// Whether these are the clusters of `mesh`.
    pub(crate) fn fit(&self, mesh: &Arc<Mesh>) -> bool {
        Arc::ptr_eq(&self.mesh, mesh)
    }

    /// The clusters that cannot be skipped. `is_outside` tells whether all that is within a box is: of its corners it gets
    /// the offsets from `position` along the scene's axes.
    pub(crate) fn seen(&self, position: DVec3, is_outside: impl Fn(&[DVec3; 8]) -> bool + Sync) -> Vec<u32> {
        let groups = self.groups.par_iter().zip(self.clusters.par_chunks(CLUSTERS_PER_GROUP)).enumerate();
        let seen_of = |(group, (bounds, clusters)): (usize, (&Bounds, &[Cluster]))| -> Vec<u32> {
            if is_outside(&bounds.corners(position)) {
                return Vec::new();
            }
            let first = (group * CLUSTERS_PER_GROUP) as u32;
            let clusters = (first..).zip(clusters);
            let seen = clusters.filter(|(_, cluster)| !is_outside(&cluster.bounds.corners(position)));
            seen.map(|(index, _)| index).collect()
        };
        groups.with_min_len(16).flat_map_iter(seen_of).collect()
    }

    /// All clusters.
    pub(crate) fn all(&self) -> Vec<u32> {
        (0..self.clusters.len() as u32).collect()
    }

    pub(crate) fn content(&self, cluster: u32) -> ClusterContent<'_> {
        let here = self.clusters[cluster as usize];
        let (end_vertex, end_face) = match self.clusters.get(cluster as usize + 1) {
            Some(next) => (next.first_vertex as usize, next.first_face as usize),
            None => (self.vertices.len(), self.faces.len()),
        };
        ClusterContent {
            vertices: &self.vertices[here.first_vertex as usize..end_vertex],
            faces: &self.faces[here.first_face as usize..end_face],
        }
    }
}

/// The faces of a mesh along a space-filling curve through their middles; of faces with one middle, by their index.
fn in_z_order(mesh: &Mesh) -> Vec<(u64, u32)> {
    let vertices = mesh.vertices();
    let bounds = vertices.par_iter().copied().fold(|| Bounds::NOTHING, Bounds::with);
    let Bounds { low, high } = bounds.reduce(|| Bounds::NOTHING, Bounds::union);
    // One scale for all axes: cells of the curve are cubes. 2^21 of them along the longest axis.
    let extent = (0..3).map(|k| f64::from(high[k]) - f64::from(low[k])).fold(0.0, f64::max);
    let scale = if extent > 0.0 { f64::from((1 << 21) - 1) / extent } else { 0.0 };
    let place = |(index, face): (usize, &[u32; 3])| {
        let middle = face.map(|v| widen(vertices[v as usize])).iter().sum::<DVec3>() / 3.0;
        let cell = [0, 1, 2].map(|k| ((middle[k] - f64::from(low[k])) * scale) as u64);
        (spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2, index as u32)
    };
    let mut order: Vec<(u64, u32)> = mesh.faces().par_iter().enumerate().map(place).collect();
    order.par_sort_unstable();
    order
}

/// The lowest 21 bits of a number, two zeros between each of them.
fn spread(bits: u64) -> u64 {
    let bits = bits & 0x1f_ffff;
    let bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
    let bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
    let bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    let bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

/// Some clusters, with vertices and faces of their own.
#[derive(Debug, Default)]
struct Piece {
    clusters: Vec<Cluster>,
    vertices: Vec<u32>,
    faces: Vec<ClusterFace>,
}

impl Piece {
    fn of(mesh: &Mesh, order: &[(u64, u32)]) -> Self {
        let mut piece = Self::default();
        let mut places = PlacesOfVertices::new();
        // The places on the curve of the cluster's first face and of its last.
        let (mut first, mut last) = (0, 0);
        for &(place, index) in order {
            let face = mesh.faces()[index as usize];
            let is_full = match piece.clusters.last() {
                None => true,
                Some(cluster) => {
                    let faces = piece.faces.len() - cluster.first_face as usize;
                    let vertices = piece.vertices.len() - cluster.first_vertex as usize;
                    // Here the curve leaves a cube far larger than the one that the cluster is in.
                    let jumps = (last ^ place) >> 3 > first ^ last;
                    faces == MAX_FACES || vertices + 3 > MAX_VERTICES || jumps && faces >= MIN_FACES
                }
            };
            last = place;
            if is_full {
                first = place;
                places.clear();
                let (first_vertex, first_face) = (piece.vertices.len() as u32, piece.faces.len() as u32);
                piece.clusters.push(Cluster { bounds: Bounds::NOTHING, first_vertex, first_face });
            }
            let Self { clusters, vertices, faces } = &mut piece;
            let Some(cluster) = clusters.last_mut() else { continue };
            let corners = face.map(|vertex| {
                let next = (vertices.len() - cluster.first_vertex as usize) as u8;
                let place = places.of(vertex, next);
                if place == next {
                    vertices.push(vertex);
                    cluster.bounds = cluster.bounds.with(mesh.vertices()[vertex as usize]);
                }
                place
            });
            faces.push(ClusterFace { id: FaceId(index), corners });
        }
        piece
    }
}

/// The places of a cluster's vertices: a table twice as large as they are many.
struct PlacesOfVertices {
    slots: [(u32, u8); 2 * MAX_VERTICES],
}

impl PlacesOfVertices {
    const FREE: u32 = u32::MAX;

    fn new() -> Self {
        Self { slots: [(Self::FREE, 0); 2 * MAX_VERTICES] }
    }

    fn clear(&mut self) {
        self.slots.fill((Self::FREE, 0));
    }

    /// The place of a vertex; `next` if it has none yet, which it then has.
    fn of(&mut self, vertex: u32, next: u8) -> u8 {
        let mut slot = (vertex.wrapping_mul(0x9e37_79b1) >> 16) as usize % self.slots.len();
        loop {
            let (other, place) = self.slots[slot];
            if other == vertex {
                return place;
            }
            if other == Self::FREE {
                self.slots[slot] = (vertex, next);
                return next;
            }
            slot = (slot + 1) % self.slots.len();
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/clusters.rs"]
mod tests;
