//! The bounding volume hierarchy: boxes around faces, padded for f32 traversal, in an obvhs `Bvh2`.
//!
//! # Padding
//!
//! The vertices of a face are f32 numbers, so its tight box B is exact. Let a ray from o along the unit vector d
//! meet the face at range s <= D, at the point P = o + s d inside B; D is the maximum trace distance. The
//! traversal computes with these errors, u = 2^-24:
//!
//! * o is rounded: u |o|;
//! * d is rounded: u |d_k| in axis k;
//! * components of d below 2^-23 are replaced by 2^-23: at most 2^-22 = 4 u;
//! * each slab distance takes three roundings: a relative error of 3 u, of a distance along axis k that is at most
//!   s |d_k| from the origin.
//!
//! So along each axis the slab may be missed by at most
//!
//! ```text
//! u |o| + 4 u s + 3 u s  <=  u (|P| + s) + 7 u s  <=  8 u (|P| + s)
//! ```
//!
//! Let a box be widened by [`RELATIVE_PADDING`] x (largest |coordinate| of the box + D) and rounded outward. The
//! traversal then enters it at a computed distance <= s and leaves it at one >= s, whatever the rounding.
//! [`RELATIVE_PADDING`] is 9 u, one u more than derived. The ninth covers products of two of these errors, of the
//! order of 2^-46, and the roundings of the f64 test, of the order of 2^-53, by which it may admit a face that the
//! exact ray misses.
//!
//! # Rays to a point
//!
//! The ray from the camera's centre c to a hit P has the f64 direction fl(P - c), and P is rounded too. That does
//! not count against the boxes: boxes and triangle test take one and the same ray (c, fl(P - c)), and the bound
//! above is about that ray. (It is a ray displaced by some 2^-52 of |P| + |c|. Its answer can differ from that of
//! the exact ray by rounding.) Its length does count: the boxes are wide enough if |P - c| <= D, and
//! [`max_trace_distance`] makes it so.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use rayon::prelude::*;
use raypencil_scene::{Beam, FaceId, Mesh, Mounted, Scene};

use crate::grouped_build::Forest;
use crate::triangle::Triangle;
use crate::wide_tree::WideTree;

/// Padding of a box, relative to (largest |coordinate| + maximum trace distance): 9 x 2^-24, derived above.
const RELATIVE_PADDING: f64 = 9.0 / (1u32 << 24) as f64;

/// The length of the longest ray that is traced in this scene, metres.
///
/// This is the largest of the sensors' maximum ranges and of the bounds for rays from the camera's centre to a hit
/// of a beam. By the triangle inequality such a ray is at most as long as the beam's maximum range, half its
/// thickness, and the distance between camera and beam together.
pub(crate) fn max_trace_distance(scene: &Scene) -> f64 {
    let camera = scene.camera();
    let from_camera = |beam: &Mounted<Beam>| {
        let baseline = (beam.scene_from_sensor.position - camera.scene_from_sensor.position).length();
        beam.sensor.max_range + 0.5 * beam.sensor.thickness + baseline
    };
    scene.beams().iter().map(from_camera).fold(camera.sensor.max_range, f64::max)
}

/// The terrain's faces in a tree of padded boxes.
pub(crate) struct Hierarchy {
    boxes: WideTree,
    /// In the order of the boxes' entries.
    faces: Vec<Triangle>,
    max_trace_distance: f64,
}

impl std::fmt::Debug for Hierarchy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { boxes, faces, max_trace_distance } = self;
        f.debug_struct("Hierarchy")
            .field("boxes", boxes)
            .field("faces", &faces.len())
            .field("max_trace_distance", max_trace_distance)
            .finish()
    }
}

impl Hierarchy {
    /// Builds the tree for rays whose hits lie within `max_trace_distance` metres of their origin.
    pub(crate) fn build(mesh: &Mesh, max_trace_distance: f64) -> Self {
        let vertices = |index: u32| mesh.faces()[index as usize].map(|v| mesh.vertices()[v as usize]);
        let triangle = |index| Triangle::new(vertices(index), FaceId(index));
        // Faces without area are never hit and get no box.
        let box_of = |index| {
            let has_area = triangle(index).normal() != glam::DVec3::ZERO;
            has_area.then(|| padded_box(&vertices(index), max_trace_distance))
        };
        let forest = Forest::build(mesh.faces().len(), box_of);
        let (order, first_faces) = forest.faces();
        let boxes = WideTree::collapse(&forest, &first_faces);
        Self { boxes, faces: order.into_par_iter().map(triangle).collect(), max_trace_distance }
    }

    pub(crate) fn boxes(&self) -> &WideTree {
        &self.boxes
    }

    /// The faces, in the order of the boxes' entries.
    pub(crate) fn faces(&self) -> &[Triangle] {
        &self.faces
    }

    /// The distance from a ray's origin up to which no hit is lost to the boxes, metres.
    pub(crate) fn max_trace_distance(&self) -> f64 {
        self.max_trace_distance
    }
}

/// The box around three vertices, widened by [`RELATIVE_PADDING`] and rounded outward.
fn padded_box(vertices: &[[f32; 3]; 3], max_trace_distance: f64) -> Aabb {
    let [a, b, c] = vertices.map(Vec3A::from_array);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let max_coordinate = low.abs().max(high.abs()).max_element();
    let padding = RELATIVE_PADDING * (f64::from(max_coordinate) + max_trace_distance);
    let down = |x: f32| round_down(f64::from(x) - padding);
    let up = |x: f32| round_up(f64::from(x) + padding);
    Aabb::new(
        Vec3A::new(down(low.x), down(low.y), down(low.z)),
        Vec3A::new(up(high.x), up(high.y), up(high.z)),
    )
}

/// An f32 above `x`, at most two steps away.
pub(crate) fn round_up(x: f64) -> f32 {
    (x as f32).next_up()
}

/// An f32 below `x`, at most two steps away.
pub(crate) fn round_down(x: f64) -> f32 {
    (x as f32).next_down()
}

#[cfg(test)]
#[path = "../tests/unit/hierarchy.rs"]
mod tests;
