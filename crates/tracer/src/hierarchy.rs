//! Boxes around faces, widened for f32 traversal, in an obvhs `Bvh2`.
//!
//! # How much wider
//!
//! A face's box B has f32 corners exactly. Let a ray from o along the unit vector d meet the face at range
//! s <= reach, at the point P = o + s d inside B. Traversal sees o rounded (error u |o|, u = 2^-24), d
//! rounded (error u |d_k| in axis k), components of d below 2^-23 replaced by 2^-23 (error at most 2^-22 =
//! 4 u), and forms each slab distance with three roundings (relative error 3 u, of a distance that is at
//! most s |d_k| from the origin). So along each axis the slab may be missed by at most
//!
//! ```text
//! u |o| + 4 u s + 3 u s  <=  u (|P| + s) + 7 u s  <=  8 u (|P| + s)
//! ```
//!
//! A box widened by [`PADDING`] x (largest |coordinate| of the box + reach), u = 2^-24, rounded outward, is
//! entered at a computed distance <= s and left at one >= s, whatever the rounding. [`PADDING`] is one u more
//! than the 8 u: it is for the products of two of these errors, of the order of 2^-46, and for the roundings of
//! the f64 test, of the order of 2^-53, by which it may admit a face that the ray misses by as much.
//!
//! # Rays to a point
//!
//! The ray from the camera's centre c to a hit P has the f64 direction fl(P - c), and P is rounded too. That
//! does not count against the boxes: boxes and triangle test are asked about one and the same ray (c, fl(P - c)),
//! which is all that the bound is about. (It is a ray displaced by some 2^-52 of |P| + |c|: the answer for it
//! can differ from that for the exact ray by rounding.) What does count is its length: the boxes are wide
//! enough if |P - c| <= reach, and [`reach_of`] makes it so.

use std::collections::HashMap;

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use raypencil_scene::{Beam, FaceId, Mesh, Mounted, Scene};

use crate::grouped;
use crate::triangle::Triangle;

/// Widening of a box in units of (largest |coordinate| + reach): 9 x 2^-24, derived above.
const PADDING: f64 = 9.0 / (1u32 << 24) as f64;

/// The longest way that any ray of this scene is traced, metres: every sensor's own range, and for the ray from
/// the camera's centre to a hit of a beam, by the triangle inequality, the beam's range, half its thickness, and
/// the distance between the two.
pub(crate) fn reach_of(scene: &Scene) -> f64 {
    let camera = scene.camera();
    let from_camera = |beam: &Mounted<Beam>| {
        let apart = (beam.scene_from_sensor.position - camera.scene_from_sensor.position).length();
        beam.sensor.max_range + 0.5 * beam.sensor.thickness + apart
    };
    scene.beams().iter().map(from_camera).fold(camera.sensor.max_range, f64::max)
}

/// The terrain, ready to be traced.
pub(crate) struct Hierarchy {
    tree: Bvh2,
    /// Faces in the order of the tree's leaves.
    triangles: Vec<Triangle>,
    /// `first_triangle[p]..first_triangle[p + 1]` are the faces of the p-th box in the tree's order.
    first_triangle: Vec<u32>,
    reach: f64,
    stack_size: usize,
}

impl std::fmt::Debug for Hierarchy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { tree, triangles, reach, stack_size, .. } = self;
        f.debug_struct("Hierarchy")
            .field("nodes", &tree.nodes.len())
            .field("triangles", &triangles.len())
            .field("reach", reach)
            .field("stack_size", stack_size)
            .finish()
    }
}

impl Hierarchy {
    /// Builds the tree for rays whose hits lie within `reach` metres of their origin.
    pub(crate) fn build(mesh: &Mesh, reach: f64) -> Self {
        // A face of no area is never hit, and faces of one and the same box share a leaf entry: many
        // identical boxes would make the build quadratic.
        let mut boxes: Vec<Aabb> = Vec::with_capacity(mesh.faces().len());
        let mut box_of_corners: HashMap<[u32; 6], u32> = HashMap::with_capacity(mesh.faces().len());
        let mut boxed: Vec<(u32, Triangle)> = Vec::with_capacity(mesh.faces().len());
        for (index, face) in mesh.faces().iter().enumerate() {
            let vertices = face.map(|v| mesh.vertices()[v as usize]);
            let triangle = Triangle::new(vertices, FaceId(index as u32));
            if triangle.normal() == glam::DVec3::ZERO {
                continue;
            }
            let corners = padded_box(&vertices, reach);
            let bits =
                [corners.min.x, corners.min.y, corners.min.z, corners.max.x, corners.max.y, corners.max.z]
                    .map(f32::to_bits);
            let number = *box_of_corners.entry(bits).or_insert_with(|| {
                boxes.push(corners);
                boxes.len() as u32 - 1
            });
            boxed.push((number, triangle));
        }
        drop(box_of_corners);

        let tree = grouped::build(&boxes);
        // obvhs' fixed stacks overflow silently, so the search brings one that fits the real depth.
        let stack_size = deepest(&tree) + 1;

        // Lay the faces out in the order of the leaves.
        let mut place_of_box = vec![0u32; boxes.len()];
        for (place, &number) in tree.primitive_indices.iter().enumerate() {
            place_of_box[number as usize] = place as u32;
        }
        // A stable sort: faces of one box stay in ascending order.
        boxed.sort_by_key(|&(number, _)| place_of_box[number as usize]);
        let mut first_triangle = vec![0u32; boxes.len() + 1];
        for (number, _) in &boxed {
            first_triangle[place_of_box[*number as usize] as usize + 1] += 1;
        }
        for place in 0..boxes.len() {
            first_triangle[place + 1] += first_triangle[place];
        }
        let triangles = boxed.into_iter().map(|(_, triangle)| triangle).collect();
        Self { tree, triangles, first_triangle, reach, stack_size }
    }

    /// The tree of boxes.
    pub(crate) fn tree(&self) -> &Bvh2 {
        &self.tree
    }

    /// The faces behind `count` boxes of the tree from `first` on.
    #[inline]
    pub(crate) fn triangles_of(&self, first: u32, count: u32) -> &[Triangle] {
        let start = self.first_triangle[first as usize] as usize;
        let end = self.first_triangle[(first + count) as usize] as usize;
        &self.triangles[start..end]
    }

    /// The farthest hit that the boxes are wide enough for, metres.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Entries a traversal stack must hold.
    pub(crate) fn stack_size(&self) -> usize {
        self.stack_size
    }
}

/// A box around three vertices, widened by [`PADDING`] and rounded outward.
fn padded_box(vertices: &[[f32; 3]; 3], reach: f64) -> Aabb {
    let [a, b, c] = vertices.map(Vec3A::from_array);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let farthest = low.abs().max(high.abs()).max_element();
    let padding = PADDING * (f64::from(farthest) + reach);
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

/// Inner nodes on the longest way from the root to a leaf: as many entries can wait on the stack.
fn deepest(tree: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut waiting: Vec<(u32, usize)> = tree.nodes.first().map(|_| (0, 0)).into_iter().collect();
    while let Some((index, depth)) = waiting.pop() {
        let node = &tree.nodes[index as usize];
        deepest = deepest.max(depth);
        if !node.is_leaf() {
            waiting.push((node.first_index, depth + 1));
            waiting.push((node.first_index + 1, depth + 1));
        }
    }
    deepest
}

#[cfg(test)]
#[path = "../tests/unit/hierarchy.rs"]
mod tests;
