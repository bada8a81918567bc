//! The tree of a mesh: boxes, quads, and faces in their order.

use std::ops::Range;

use rayon::prelude::*;
use raypencil_scene::{FaceId, Triangles};

use super::frame::Frame;
use super::quad::{self, Quad};
use super::traced::CastFace;
use crate::grouped_build::Forest;
use crate::wide_tree::WideTree;

/// The faces of a mesh, and the way to them.
#[derive(Debug)]
pub(super) struct CastTree {
    pub(super) frame: Frame,
    pub(super) boxes: WideTree,
    /// The boxes' entries.
    pub(super) quads: Vec<Quad>,
    /// In the order of the quads.
    pub(super) faces: Vec<CastFace>,
}

impl CastTree {
    pub(super) fn new(mesh: &Triangles) -> Self {
        let frame = Frame::of(mesh);
        let face = |index| CastFace::of(mesh, FaceId(index), frame.scale);
        let box_of = |index| {
            let face = face(index);
            face.has_area().then(|| frame.padded_box(face.corners))
        };
        let forest = Forest::build(mesh.faces().len(), box_of).with_leaves_of(quad::WIDTH);
        let (order, first_faces) = forest.faces();
        let faces: Vec<CastFace> = order.into_par_iter().map(face).collect();
        let (quads, starts) = quad::of_forest(&forest, &first_faces, &faces, frame.middle);
        let boxes = WideTree::collapse_to(&forest, |group, leaf| {
            let first = starts[group][leaf.first_index as usize];
            [first, first + leaf.prim_count.div_ceil(quad::WIDTH as u32)]
        });
        Self { frame, boxes, quads, faces }
    }

    /// Places of the faces of these quads.
    #[inline(always)]
    pub(super) fn places(&self, quads: Range<usize>) -> Range<usize> {
        let (first, last) = (&self.quads[quads.start], &self.quads[quads.end - 1]);
        first.first as usize..(last.first + last.count) as usize
    }
}
