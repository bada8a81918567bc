//! Four faces at a time, asked in f32: it refuses what is certainly not met, and leaves the rest to [`CastFace::crossing`].
//!
//! # Why no face is lost
//!
//! The vertices are projected along the ray as in `triangle`, divided by the longest part of the direction: with v a
//! vertex from where the ray starts, and s the quotients of the shorter parts by the longest, |s| <= 1,
//! `p = (v_x - s_x v_z, v_y - s_y v_z)`. An edge function is `a_x b_y - a_y b_x`. All is in the frame of the boxes, where |vertex|
//! and |start| are at most 1.01; u = 2^-24. In each coordinate:
//!
//! ```text
//! vertex      1.1 u: moved to the middle, rounded                start       2.1 u: that of `frame`, rounded
//! v           1.1 u + 2.1 u, and its rounding 2.1 u              5.3 u
//! s v_z       5.3 u, 1.1 u of s times 2.1, its rounding 2.1 u    9.8 u
//! p           5.3 u + 9.8 u, and its rounding 4.2 u              19.3 u
//! ```
//!
//! The f64 test has projected vertices of its own, and never a wrong sign for them. They are off by less than u, as `frame` asks all faces
//! if the ray starts too far away for that. So both differ by less than 21 u. With P the largest coordinate of p, the products
//! differ by at most 4 * 21 u P + 2 (21 u)^2, and their roundings and that of the difference are 4 u P^2. The bound takes
//! P (96 u + 8 u P) + 1024 u^2, which has room for its own rounding and for products that are too small for f32.

use glam::{DVec3, Vec4};
use obvhs::ray::Ray as BoxRay;
use rayon::prelude::*;

use super::traced::CastFace;
use crate::grouped_build::{Forest, Group};
use crate::traced_ray::TracedRay;

/// Faces that are asked at once.
pub(super) const WIDTH: usize = 4;

/// u.
const U: f32 = 1.0 / (1 << 24) as f32;

/// Up to four faces of a leaf.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(super) struct Quad {
    /// Corners a, b, c, each by its coordinates, where the boxes are.
    corners: [[Vec4; 3]; 3],
    /// The first of the faces, which follow each other.
    pub(super) first: u32,
    /// How many there are.
    pub(super) count: u32,
}

/// A ray as it is asked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sheared {
    start: [f32; 3],
    axes: [usize; 3],
    slopes: [f32; 2],
}

impl Sheared {
    pub(super) const NONE: Self = Self { start: [0.0; 3], axes: [0, 1, 2], slopes: [0.0; 2] };

    #[inline]
    pub(super) fn new(ray: &TracedRay, box_ray: &BoxRay) -> Self {
        let [kx, ky, kz] = ray.axes;
        let slope = |k: usize| (ray.direction[k] / ray.direction[kz]) as f32;
        Self { start: box_ray.origin.to_array(), axes: ray.axes, slopes: [slope(kx), slope(ky)] }
    }
}

impl Quad {
    /// Of at most four faces, the first of which has this place; `middle` moves them to where the boxes are.
    pub(super) fn new(first: u32, faces: &[CastFace], middle: DVec3) -> Self {
        let mut corners = [[Vec4::ZERO; 3]; 3];
        for (lane, face) in faces.iter().enumerate() {
            for (corner, at) in corners.iter_mut().zip(face.corners) {
                let at = (at - middle).as_vec3();
                for axis in 0..3 {
                    corner[axis][lane] = at[axis];
                }
            }
        }
        Self { corners, first, count: faces.len() as u32 }
    }

    /// A bit for each face that the ray does not certainly pass beside.
    #[inline(always)]
    pub(super) fn may_meet(&self, ray: &Sheared) -> u32 {
        let [kx, ky, kz] = ray.axes;
        let [start_x, start_y, start_z] = ray.axes.map(|k| Vec4::splat(ray.start[k]));
        let [slope_x, slope_y] = ray.slopes.map(Vec4::splat);
        let project = |v: &[Vec4; 3]| {
            let z = v[kz] - start_z;
            [v[kx] - start_x - slope_x * z, v[ky] - start_y - slope_y * z]
        };
        let [a, b, c] = self.corners.each_ref().map(project);
        let edge = |a: &[Vec4; 2], b: &[Vec4; 2]| a[0] * b[1] - a[1] * b[0];
        let [ab, bc, ca] = [edge(&a, &b), edge(&b, &c), edge(&c, &a)];
        let of = |p: &[Vec4; 2]| p[0].abs().max(p[1].abs());
        let size = of(&a).max(of(&b)).max(of(&c));
        let bound = size * (size * (8.0 * U) + 96.0 * U) + 1024.0 * U * U;
        let [least, most] = [ab.min(bc).min(ca), ab.max(bc).max(ca)];
        let beside = most.cmpgt(bound) & least.cmplt(-bound);
        !beside.bitmask() & ((1 << self.count) - 1)
    }
}

/// The quads of all leaves of a forest, and for each group those at which its leaves begin, by the first face of a leaf.
pub(super) fn of_forest(
    forest: &Forest,
    first_faces: &[u32],
    faces: &[CastFace],
    middle: DVec3,
) -> (Vec<Quad>, Vec<Vec<u32>>) {
    let of_group = |(group, &first_face): (&Group, &u32)| {
        let mut quads = Vec::with_capacity(group.faces.len().div_ceil(2));
        let mut starts = vec![0; group.faces.len()];
        for leaf in group.leaves() {
            starts[leaf.start as usize] = quads.len() as u32;
            for first in leaf.clone().step_by(WIDTH) {
                let last = leaf.end.min(first + WIDTH as u32) + first_face;
                let first = first + first_face;
                quads.push(Quad::new(first, &faces[first as usize..last as usize], middle));
            }
        }
        (quads, starts)
    };
    let parts: Vec<_> = forest.groups.par_iter().zip(first_faces).map(of_group).collect();
    let (mut quads, mut starts) =
        (Vec::with_capacity(parts.iter().map(|part| part.0.len()).sum()), Vec::new());
    for (of_group, mut starts_of_group) in parts {
        let before = quads.len() as u32;
        starts_of_group.iter_mut().for_each(|start| *start += before);
        quads.extend(of_group);
        starts.push(starts_of_group);
    }
    (quads, starts)
}
