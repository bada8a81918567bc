//! Primitives of meshes: their references, counts and triangles. (glTF 2.0, §3.7.2)

use std::collections::BTreeSet;

use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, Root};
use raypencil_files::Fault;

use crate::gltf::accessors::{accessor, weights};
use crate::gltf::buffers::{Buffers, missing_reference};
use crate::gltf::nodes::node_place;

/// Number of vertices, faces and primitives of a mesh, as its accessors claim.
pub(super) fn counts(root: &Root, primitives: &[Primitive]) -> Result<[u64; 3], Fault> {
    let mut shared = BTreeSet::new();
    let [mut vertices, mut faces] = [0_u64; 2];
    for primitive in primitives {
        let Some(TrianglePrimitive { mode, positions, corners }) = triangle_primitive(root, primitive)?
        else {
            continue;
        };
        if shared.insert(positions.value()) {
            vertices = vertices.saturating_add(accessor(root, positions)?.count.0);
        }
        faces = faces.saturating_add(if mode == Mode::Triangles { corners / 3 } else { corners });
    }
    Ok([vertices, faces, primitives.len() as u64])
}

/// Primitives of a node's mesh.
pub(super) fn primitives(root: &Root, index: usize) -> Result<&[Primitive], Fault> {
    let node = &root.nodes[index];
    let Some(mesh_index) = node.mesh else { return Ok(&[]) };
    let mesh_index = mesh_index.value();
    let Some(mesh) = root.meshes.get(mesh_index) else {
        return Err(missing_reference(
            format!("{}: mesh {mesh_index}", node_place(root, index)),
            root.meshes.len(),
        ));
    };
    // Morph targets move vertices; without them the ground would be in the wrong place.
    let weights = node.weights.as_ref().or(mesh.weights.as_ref());
    if weights.is_some_and(|weights| weights.iter().any(|&weight| weight != 0.0)) {
        let expected = "weights of 0: bake the shape into the mesh (in Blender: Apply All Shape Keys)";
        return Err(Fault::new(node_place(root, index), "morph weights", expected));
    }
    Ok(&mesh.primitives)
}

/// Refuses a skin that moves vertices: without it the ground would be in the wrong place. One whose weights are all 0, or that has
/// none, moves nothing.
pub(super) fn check_skin(root: &Root, buffers: &mut Buffers<'_>, index: usize) -> Result<(), Fault> {
    if root.nodes[index].skin.is_none() {
        return Ok(());
    }
    for primitive in primitives(root, index)? {
        for (semantic, &accessor) in &primitive.attributes {
            let Checked::Valid(Semantic::Weights(_)) = semantic else { continue };
            if weights(root, buffers, accessor)?.as_flattened().iter().any(|&weight| weight != 0.0) {
                let expected =
                    "a rigid mesh: bake the pose into it (in Blender: apply the armature, then export)";
                return Err(Fault::new(node_place(root, index), "a skin that moves vertices", expected));
            }
        }
    }
    Ok(())
}

/// A primitive with triangles, whose references have been checked to exist.
pub(super) struct TrianglePrimitive {
    pub(super) mode: Mode,
    pub(super) positions: Index<Accessor>,
    /// Number of indices, or of vertices if there are no indices.
    corners: u64,
}

/// Checks the references of a primitive; `None` if it has no triangles.
///
/// CHOICE: points and lines are skipped, since they are no ground. The marks of a survey then do no harm.
pub(super) fn triangle_primitive(
    root: &Root,
    primitive: &Primitive,
) -> Result<Option<TrianglePrimitive>, Fault> {
    let Checked::Valid(mode) = primitive.mode else {
        return Err(Fault::new("primitive", "an unknown mode", "0 to 6"));
    };
    if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
        return Ok(None);
    }
    let Some(&positions) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
        return Err(Fault::new("primitive", "no POSITION", "a POSITION accessor"));
    };
    let (count, place) = match primitive.indices {
        Some(indices) => (accessor(root, indices)?.count.0, indices.value()),
        None => (accessor(root, positions)?.count.0, positions.value()),
    };
    let place = || format!("accessor {place}");
    match mode {
        Mode::Triangles if !count.is_multiple_of(3) => {
            Err(Fault::new(place(), format!("{count} corners of triangles"), "a multiple of 3"))
        }
        Mode::TriangleStrip | Mode::TriangleFan if count < 3 => {
            Err(Fault::new(place(), format!("{count} corners of a strip or fan"), "3 or more"))
        }
        _ => Ok(Some(TrianglePrimitive { mode, positions, corners: count })),
    }
}

/// Triangles of a primitive, by the formulas of the specification. (glTF 2.0, §3.7.2.1)
pub(super) fn triangles(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    let c = corners;
    match mode {
        Mode::Triangles => c.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect(),
        // Every second triangle of a strip has its last two corners swapped.
        Mode::TriangleStrip => {
            (0..c.len().saturating_sub(2)).map(|i| [c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]]).collect()
        }
        Mode::TriangleFan => (0..c.len().saturating_sub(2)).map(|i| [c[i + 1], c[i + 2], c[0]]).collect(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}
