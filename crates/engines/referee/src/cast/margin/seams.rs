//! Which edges two faces continue, and in which parts of the mesh there are only such.
//!
//! The nearest t of displaced rays can jump where the ray passes over a border of a face. An edge is no such border if
//! exactly two faces share it, run along it in opposite directions, and show the same side to the ray: their pictures
//! lie on both sides of it, with the same t along it. Vertices are compared by their coordinates, since files without
//! indices repeat them.
//!
//! For a box of faces a cone around their normals, and those of the faces behind their edges, tells at once whether all
//! show the same side.

use std::collections::HashMap;

use glam::DVec3;
use raypencil_scene::{FaceId, Side, Triangles};

use super::super::triangle::Triangle;
use super::copies::copies;
use crate::trees::bvh::Bvh;

/// No face continues an edge, or it cannot be told which.
const OPEN: u32 = u32::MAX;

/// The edges of a mesh, and the cones of its boxes.
#[derive(Debug)]
pub(in crate::cast) struct Seams {
    faces: Vec<FaceSeams>,
    /// For each node of the hierarchy.
    cones: Vec<Cone>,
    /// Whether each face is a copy of an earlier one; empty if none is.
    copies: Vec<bool>,
    /// The hierarchy of the others, if some are.
    without_copies: Option<Bvh<Triangle>>,
}

/// A face among the others.
#[derive(Debug, Clone, Copy)]
struct FaceSeams {
    /// The faces behind its edges from corner 0, 1 and 2.
    mates: [u32; 3],
    /// The unit normal, to [`NORMAL_SLACK`] and the rounding to `f32`; NaN where f64 does not give it.
    normal: [f32; 3],
}

/// The normals of some faces are within an angle of an axis.
#[derive(Debug, Clone, Copy)]
struct Cone {
    axis: DVec3,
    /// Sine of the angle, with slack; 2 if the faces have no such cone, or an open edge.
    sine: f64,
}

/// Greatest angle, in radians, by which a normal in f64 may be wrong, and the slack of cones.
const NORMAL_SLACK: f64 = 1.0 / (1u64 << 24) as f64;

/// More than a normal's [`NORMAL_SLACK`], its rounding to f32, which is at most 2^-24 of its length, and roundings of f64.
const SIDE_SLACK: f64 = 4.0 * NORMAL_SLACK;

/// Least area of a face, as a part of the product of two of its edges, whose f64 normal is that good: its error is
/// below 8 * 2^-53 of this product.
const LEAST_WIDTH: f64 = 1.0 / (1u64 << 24) as f64;

impl Seams {
    pub(in crate::cast) fn of(mesh: &Triangles, bvh: &Bvh<Triangle>) -> Self {
        let vertices = merged_vertices(mesh);
        let copies = copies(mesh.faces(), &vertices);
        let is_copy = |face: FaceId| copies.get(face.0 as usize) == Some(&true);
        let mates = mates(mesh, &vertices, is_copy);
        let without_copies = (!copies.is_empty() && !bvh.is_empty()).then(|| {
            Bvh::build(bvh.faces_below(0).iter().filter(|face| !is_copy(face.id)).copied().collect())
        });
        let bvh = without_copies.as_ref().unwrap_or(bvh);
        let normals: Vec<Option<DVec3>> =
            (0..mesh.faces().len() as u32).map(|face| unit_normal(mesh.corners(FaceId(face)))).collect();
        let cone = |node: u32| {
            let faces = bvh.faces_below(node);
            let all = faces.iter().flat_map(|face| {
                let index = face.id.0;
                let behind = mates[index as usize]
                    .into_iter()
                    .map(|mate| if mate == OPEN { None } else { normals[mate as usize] });
                std::iter::once(normals[index as usize]).chain(behind)
            });
            let axis = all.clone().flatten().sum::<DVec3>().normalize_or_zero();
            // NaN never occurs: normals are finite. A face without a normal, or an open edge, opens the cone.
            let least =
                all.fold(1.0_f64, |least, normal| least.min(normal.map_or(-1.0, |normal| normal.dot(axis))));
            let sine =
                if least > 0.0 { (1.0 - least * least).max(0.0).sqrt() + 4.0 * NORMAL_SLACK } else { 2.0 };
            Cone { axis, sine }
        };
        let cones = (0..bvh.node_count() as u32).map(cone).collect();
        let faces = mates.into_iter().zip(&normals).map(|(mates, normal)| {
            let normal = normal.map_or([f32::NAN; 3], |normal| normal.to_array().map(|part| part as f32));
            FaceSeams { mates, normal }
        });
        let faces = faces.collect();
        Self { faces, cones, copies, without_copies }
    }

    /// Whether a face lies in the place of an earlier one.
    pub(super) fn is_copy(&self, face: FaceId) -> bool {
        self.copies.get(face.0 as usize) == Some(&true)
    }

    /// The hierarchy of the faces that are no copies, if some are.
    pub(in crate::cast) fn without_copies(&self) -> Option<&Bvh<Triangle>> {
        self.without_copies.as_ref()
    }

    /// The only other face at the edge from corner k of a face, if there is just one and it runs the other way.
    pub(super) fn mate(&self, face: FaceId, k: usize) -> Option<FaceId> {
        let mate = self.faces[face.0 as usize].mates[k];
        (mate != OPEN).then_some(FaceId(mate))
    }

    /// The side that a face shows to a direction; `None` if the normal does not tell it.
    #[inline]
    pub(super) fn certain_side(&self, face: FaceId, unit_direction: DVec3) -> Option<Side> {
        let normal = self.faces[face.0 as usize].normal.map(f64::from);
        let along = DVec3::from_array(normal).dot(unit_direction);
        // NaN is neither.
        if along < -SIDE_SLACK {
            Some(Side::Front)
        } else if along > SIDE_SLACK {
            Some(Side::Back)
        } else {
            None
        }
    }

    /// Whether all faces of a node, and those behind their edges, certainly show the same side to a direction: -1
    /// fronts, 1 backs, 0 if that is not certain.
    pub(super) fn side_shown(&self, node: u32, unit_direction: DVec3) -> i32 {
        let Cone { axis, sine } = self.cones[node as usize];
        let along = axis.dot(unit_direction);
        if along > sine {
            1
        } else if along < -sine {
            -1
        } else {
            0
        }
    }
}

/// For each vertex the first with the same coordinates.
fn merged_vertices(mesh: &Triangles) -> Vec<u32> {
    // -0.0 + 0.0 is 0.0.
    let key = |index: u32| mesh.vertices()[index as usize].map(|coordinate| (coordinate + 0.0).to_bits());
    let mut first: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.vertices().len());
    (0..mesh.vertices().len() as u32).map(|index| *first.entry(key(index)).or_insert(index)).collect()
}

/// The faces behind the edges of each. Those that are left out have none, and are behind none.
fn mates(mesh: &Triangles, vertices: &[u32], is_left_out: impl Fn(FaceId) -> bool) -> Vec<[u32; 3]> {
    // Each edge by its two ends, the smaller first; then whether it runs from there; then face and corner.
    let mut edges: Vec<([u32; 2], bool, u32, u32)> = Vec::with_capacity(3 * mesh.faces().len());
    for (index, face) in
        mesh.faces().iter().enumerate().filter(|(index, _)| !is_left_out(FaceId(*index as u32)))
    {
        for k in 0..3 {
            let [from, to] = [face[k], face[(k + 1) % 3]].map(|vertex| vertices[vertex as usize]);
            edges.push(([from.min(to), from.max(to)], from < to, index as u32, k as u32));
        }
    }
    edges.sort_unstable();
    let mut mates = vec![[OPEN; 3]; mesh.faces().len()];
    for pair in edges.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, false, one, k), (_, true, other, l)] = *pair {
            mates[one as usize][k as usize] = other;
            mates[other as usize][l as usize] = one;
        }
    }
    mates
}

/// The unit normal, if f64 gives it to [`NORMAL_SLACK`].
fn unit_normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let (e, f) = (b - a, c - a);
    // The edges are made about 1 long, so that no product overflows or vanishes.
    let size = e.abs().max(f.abs()).max_element();
    if !(size > 1e-290) {
        return None;
    }
    let (e, f) = (e / size, f / size);
    let normal = e.cross(f);
    (normal.length() > LEAST_WIDTH * e.length() * f.length() && e.length() * f.length() > 1e-200)
        .then(|| normal.normalize())
}
