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

use std::collections::HashMap;

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use raypencil_scene::{Beam, FaceId, Mesh, Mounted, Scene};

use crate::grouped_build;
use crate::triangle::Triangle;

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
    tree: Bvh2,
    /// Faces in the order of the tree's leaves.
    triangles: Vec<Triangle>,
    /// `first_triangle[k]..first_triangle[k + 1]` are the faces of the k-th box in the tree's order.
    first_triangle: Vec<u32>,
    max_trace_distance: f64,
    stack_size: usize,
}

impl std::fmt::Debug for Hierarchy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { tree, triangles, max_trace_distance, stack_size, .. } = self;
        f.debug_struct("Hierarchy")
            .field("nodes", &tree.nodes.len())
            .field("triangles", &triangles.len())
            .field("max_trace_distance", max_trace_distance)
            .field("stack_size", stack_size)
            .finish()
    }
}

impl Hierarchy {
    /// Builds the tree for rays whose hits lie within `max_trace_distance` metres of their origin.
    pub(crate) fn build(mesh: &Mesh, max_trace_distance: f64) -> Self {
        // Faces without area are never hit and get no box. Faces with identical boxes share one leaf entry: many
        // identical boxes would make the build quadratic.
        let mut boxes: Vec<Aabb> = Vec::with_capacity(mesh.faces().len());
        let mut box_by_bounds: HashMap<[u32; 6], u32> = HashMap::with_capacity(mesh.faces().len());
        let mut triangles_with_box: Vec<(u32, Triangle)> = Vec::with_capacity(mesh.faces().len());
        for (index, face) in mesh.faces().iter().enumerate() {
            let vertices = face.map(|v| mesh.vertices()[v as usize]);
            let triangle = Triangle::new(vertices, FaceId(index as u32));
            if triangle.normal() == glam::DVec3::ZERO {
                continue;
            }
            let bounds = padded_box(&vertices, max_trace_distance);
            let bits = [bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z]
                .map(f32::to_bits);
            let box_index = *box_by_bounds.entry(bits).or_insert_with(|| {
                boxes.push(bounds);
                boxes.len() as u32 - 1
            });
            triangles_with_box.push((box_index, triangle));
        }
        drop(box_by_bounds);

        let tree = grouped_build::build(&boxes);
        // The fixed stacks of obvhs overflow silently, so the traversals bring one that fits the tree's depth.
        let stack_size = max_depth(&tree) + 1;

        // Lay the faces out in the order of the leaves.
        let mut rank_of_box = vec![0u32; boxes.len()];
        for (rank, &box_index) in tree.primitive_indices.iter().enumerate() {
            rank_of_box[box_index as usize] = rank as u32;
        }
        // The sort is stable: faces of one box stay in ascending order.
        triangles_with_box.sort_by_key(|&(box_index, _)| rank_of_box[box_index as usize]);
        let mut first_triangle = vec![0u32; boxes.len() + 1];
        for (box_index, _) in &triangles_with_box {
            first_triangle[rank_of_box[*box_index as usize] as usize + 1] += 1;
        }
        for rank in 0..boxes.len() {
            first_triangle[rank + 1] += first_triangle[rank];
        }
        let triangles = triangles_with_box.into_iter().map(|(_, triangle)| triangle).collect();
        Self { tree, triangles, first_triangle, max_trace_distance, stack_size }
    }

    /// The tree of boxes.
    pub(crate) fn tree(&self) -> &Bvh2 {
        &self.tree
    }

    /// The faces of `count` boxes in the tree's order, from box `first` on.
    #[inline]
    pub(crate) fn leaf_triangles(&self, first: u32, count: u32) -> &[Triangle] {
        let start = self.first_triangle[first as usize] as usize;
        let end = self.first_triangle[(first + count) as usize] as usize;
        &self.triangles[start..end]
    }

    /// The distance from a ray's origin up to which no hit is lost to the boxes, metres.
    pub(crate) fn max_trace_distance(&self) -> f64 {
        self.max_trace_distance
    }

    /// The number of entries that a traversal stack must hold.
    pub(crate) fn stack_size(&self) -> usize {
        self.stack_size
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
fn round_down(x: f64) -> f32 {
    (x as f32).next_down()
}

/// The largest number of inner nodes between the root and a leaf. As many entries can wait on the stack.
fn max_depth(tree: &Bvh2) -> usize {
    let mut max_depth = 0;
    let mut stack: Vec<(u32, usize)> = tree.nodes.first().map(|_| (0, 0)).into_iter().collect();
    while let Some((index, depth)) = stack.pop() {
        let node = &tree.nodes[index as usize];
        max_depth = max_depth.max(depth);
        if !node.is_leaf() {
            stack.push((node.first_index, depth + 1));
            stack.push((node.first_index + 1, depth + 1));
        }
    }
    max_depth
}

#[cfg(test)]
#[path = "../tests/unit/hierarchy.rs"]
mod tests;
