//! One list of vertices and faces from all nodes of a file.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};
use gltf::json::Root;
use raypencil_files::Fault;
use raypencil_scene::Material;

use crate::gltf::accessors;
use crate::gltf::buffers::{Buffers, missing_reference};
use crate::gltf::limits::{MAX_FACES_OR_VERTICES, MAX_PRIMITIVES};
use crate::gltf::nodes::{PlacedNode, node_place};
use crate::gltf::primitives::{check_skin, counts, primitives, triangle_primitive, triangles};

/// Name of the material of faces that have none.
pub(crate) const WITHOUT_MATERIAL: &str = "no material";

/// Parts of a mesh, in the global frame.
#[derive(Default)]
pub(super) struct Parts {
    pub(super) vertices: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) face_materials: Vec<u16>,
    pub(super) materials: Vec<Material>,
}

/// Adds the vertices and faces of all nodes to `parts`.
///
/// Faces are ordered by node, then by instance, then by primitive, then as in the primitive: this is their `FaceId`. With `as_is` the
/// transforms of nodes are not applied. Vertices beyond `max_coordinate`, metres, are refused.
pub(super) fn assemble(
    root: &Root,
    nodes: Vec<PlacedNode>,
    buffers: &mut Buffers<'_>,
    mut parts: Parts,
    reflectivity: f64,
    as_is: bool,
    max_coordinate: f64,
) -> Result<Parts, Fault> {
    // The totals are known before anything is read, so that a small file cannot ask for much memory. The counts of a
    // mesh are computed once, however often it is drawn.
    let mut known = BTreeMap::new();
    let mut totals = [0_u64; 3];
    for node in &nodes {
        let primitives = primitives(root, node.node)?;
        check_skin(root, buffers, node.node)?;
        let counts = match root.nodes[node.node].mesh.map(|mesh| mesh.value()) {
            None => continue,
            Some(mesh) => match known.get(&mesh) {
                Some(counts) => *counts,
                None => *known.entry(mesh).or_insert(counts(root, primitives)?),
            },
        };
        totals = std::array::from_fn(|kind| totals[kind].saturating_add(counts[kind]));
    }
    let limits = [
        ("vertices", MAX_FACES_OR_VERTICES),
        ("faces", MAX_FACES_OR_VERTICES),
        ("primitives", MAX_PRIMITIVES),
    ];
    for (total, (kind, limit)) in totals.into_iter().zip(limits) {
        if total > limit {
            let found = format!("{total} {kind} in all instances");
            return Err(Fault::new("nodes", found, format!("at most {limit}")));
        }
    }

    let mut default_material = None;
    for PlacedNode { node, file_from_node, is_instance } in nodes {
        if as_is && is_instance {
            let found = "instances, in a file that states its scene origin";
            return Err(Fault::new(node_place(root, node), found, "vertices that stand where they are"));
        }
        // Primitives of one mesh often share their vertices.
        let mut first_vertex = BTreeMap::new();
        let mirrored = file_from_node.matrix3.determinant() < 0.0;
        let untouched = as_is || file_from_node == DAffine3::IDENTITY;
        for primitive in primitives(root, node)? {
            let Some(triangle) = triangle_primitive(root, primitive)? else { continue };
            let accessor = triangle.positions.value();
            let (first, count) = match first_vertex.get(&accessor) {
                Some(known) => *known,
                None => {
                    let first = parts.vertices.len();
                    let positions = accessors::positions(root, buffers, triangle.positions)?;
                    for (number, &position) in positions.iter().enumerate() {
                        let local = DVec3::from_array(position);
                        let file = if untouched { local } else { file_from_node.transform_point3(local) };
                        if !(file.abs().max_element() <= max_coordinate) {
                            let found = format!("vertex {number} of accessor {accessor} lands at {file}");
                            let expected = format!("a place within {max_coordinate:e} m");
                            return Err(Fault::new(node_place(root, node), found, expected));
                        }
                        // y up becomes z up.
                        parts.vertices.push(DVec3::new(file.x, -file.z, file.y));
                    }
                    *first_vertex.entry(accessor).or_insert((first, positions.len()))
                }
            };
            let corners = match primitive.indices {
                Some(indices) => accessors::indices(root, buffers, indices, count)?,
                // All counts are at most 2^25.
                None => (0..count as u32).collect(),
            };
            let material = match primitive.material {
                Some(index) if index.value() < root.materials.len() => index.value(),
                Some(index) => {
                    let count = root.materials.len();
                    return Err(missing_reference(format!("material {}", index.value()), count));
                }
                // Primitives without a material share one additional material.
                None => *default_material.get_or_insert_with(|| {
                    parts.materials.push(Material { name: WITHOUT_MATERIAL.to_string(), reflectivity });
                    parts.materials.len() - 1
                }),
            };
            let before = parts.faces.len();
            for [a, b, c] in triangles(triangle.mode, &corners) {
                // A mirrored triangle shows its inside; swapping two corners turns the outside out again.
                let [b, c] = if mirrored { [c, b] } else { [b, c] };
                parts.faces.push([a, b, c].map(|corner| first as u32 + corner));
            }
            // There are at most 65534 materials and the additional one.
            parts.face_materials.extend(std::iter::repeat_n(material as u16, parts.faces.len() - before));
        }
    }
    Ok(parts)
}
