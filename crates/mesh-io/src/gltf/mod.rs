//! Terrain from glTF 2.0 and GLB, and to GLB: every reference, length and number is checked before it is used.
//!
//! The `gltf` crate gives the JSON its types. Its own validation is not used: it stops at the first
//! unknown texture, and does not look at the numbers in the buffers.

pub(crate) mod accessors;
pub(crate) mod buffers;
pub(crate) mod container;
pub(crate) mod json;
pub(crate) mod materials;
pub(crate) mod nodes;
pub(crate) mod stated;
pub(crate) mod write;

use glam::DVec3;
use gltf::json::Root;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::gltf::buffers::Buffers;
use raypencil_files::bytes;
use raypencil_files::{Fault, FileError, Sha256Digest, sha256};
use raypencil_scene::{Material, Mesh};

/// Reflectivity of ground that brings none of its own. CHOICE: bright Martian dust reflects about this much
/// in the near infrared.
pub const DEFAULT_REFLECTIVITY: f64 = 0.25;

/// The largest file, and the largest sum of buffers beside it, that is read: 1 GiB.
pub(crate) const LARGEST_FILE: u64 = 1 << 30;

/// The most faces, and the most vertices, of all instances together. A small file can ask for any number of
/// instances of one mesh; 2^25 of each take about 1.5 GB.
pub(crate) const MOST: u64 = 1 << 25;

/// The most primitives of all instances together, points and lines too: each takes time, whatever it draws. CHOICE: a
/// mesh of rocks has a primitive for each rock, so four million.
const MOST_PRIMITIVES: u64 = 1 << 22;

/// Loads a `.glb` or `.gltf` terrain; materials that bring no reflectivity get [`DEFAULT_REFLECTIVITY`].
///
/// # Errors
/// Names the file and the accessor, node, buffer or line of JSON that is wrong.
pub fn load_mesh(path: impl AsRef<Path>) -> Result<Mesh, FileError> {
    Ok(read(path.as_ref(), DEFAULT_REFLECTIVITY, Vertices::Global)?.0)
}

/// A mesh from the bytes of a `.glb` or `.gltf` file; `file` is for messages, and buffers in files of their
/// own are looked up beside it.
///
/// # Errors
/// As [`load_mesh`].
pub fn mesh_from_bytes(bytes: &[u8], file: &Path, reflectivity: f64) -> Result<Mesh, FileError> {
    Ok(parse(bytes, file, reflectivity, Vertices::Global)?.0)
}

/// Loads a `.glb` or `.gltf` file whose vertices are offsets, metres, from `origin` in the global frame: the
/// inverse of [`write_glb`] bit for bit, the signs of zeros included.
///
/// # Errors
/// As [`load_mesh`].
pub fn mesh_of_offsets(path: impl AsRef<Path>, origin: DVec3) -> Result<Mesh, FileError> {
    Ok(read(path.as_ref(), DEFAULT_REFLECTIVITY, Vertices::OffsetsFrom(origin))?.0)
}

/// What the vertices of a file are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Vertices {
    /// Places in the global frame; the scene origin follows from them.
    Global,
    /// Offsets from this scene origin, taken as they are.
    OffsetsFrom(DVec3),
}

/// The mesh of a file, and the digests of the file and of the buffers beside it.
pub fn read(path: &Path, reflectivity: f64, kind: Vertices) -> Result<(Mesh, Vec<Sha256Digest>), FileError> {
    let bytes = bytes::read_file(path, LARGEST_FILE).map_err(|error| FileError::io(path, "read", error))?;
    let (mesh, external) = parse(&bytes, path, reflectivity, kind)?;
    Ok((mesh, std::iter::once(sha256(&bytes)).chain(external).collect()))
}

fn parse(
    bytes: &[u8],
    file: &Path,
    reflectivity: f64,
    kind: Vertices,
) -> Result<(Mesh, Vec<Sha256Digest>), FileError> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let unfit = |fault: Fault| FileError::Gltf(fault.in_file(file));
    let container = container::split(bytes).map_err(unfit)?;
    let root = json::root(container.json).map_err(unfit)?;
    let mut buffers = Buffers::new(&root, folder, container.bin);
    let placed = nodes::placed(&root).map_err(unfit)?;
    let materials = materials::read(&root, container.json, reflectivity).map_err(unfit)?;
    let stated = match kind {
        Vertices::Global => stated::origin(&root, &placed),
        Vertices::OffsetsFrom(_) => None,
    };
    let parts = Parts { materials, ..Parts::default() };
    let parts =
        assemble(&root, placed, &mut buffers, parts, reflectivity, stated.is_some()).map_err(unfit)?;
    let Parts { mut vertices, faces, face_materials, materials } = parts;
    let mesh = match (kind, stated) {
        (Vertices::Global, Some(origin)) => stated::mesh(origin, vertices, faces, face_materials, materials),
        (Vertices::Global, None) => {
            // A ground at z = 0 of the file is at y = +0, not -0: ordinary files mean nothing by that sign.
            vertices.iter_mut().for_each(|vertex| vertex.y += 0.0);
            Mesh::from_global(&vertices, faces, face_materials, materials)
        }
        (Vertices::OffsetsFrom(origin), _) => {
            let offsets = vertices.iter().map(|vertex| vertex.as_vec3().to_array()).collect();
            Mesh::new(origin, offsets, faces, face_materials, materials)
        }
    };
    let mesh = mesh.map_err(|source| FileError::Scene { origin: file.display().to_string(), source })?;
    Ok((mesh, buffers.digests().collect()))
}

/// What becomes a mesh, in the global frame.
#[derive(Default)]
struct Parts {
    vertices: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    face_materials: Vec<u16>,
    materials: Vec<Material>,
}

/// Faces in the order of nodes, then primitives, then the primitive's own order: this is `FaceId`. With `as_is`
/// vertices are left where their node's own axes have them.
fn assemble(
    root: &Root,
    placed: Vec<nodes::Placed>,
    buffers: &mut Buffers<'_>,
    mut parts: Parts,
    reflectivity: f64,
    as_is: bool,
) -> Result<Parts, Fault> {
    // How much it will be is known before anything is read: no small file can ask for much memory. A mesh is counted
    // once, however often it is drawn.
    let mut known = BTreeMap::new();
    let mut totals = [0_u64; 3];
    for node in &placed {
        let primitives = primitives(root, node.node)?;
        let counts = match root.nodes[node.node].mesh.map(|mesh| mesh.value()) {
            None => continue,
            Some(mesh) => match known.get(&mesh) {
                Some(counts) => *counts,
                None => *known.entry(mesh).or_insert(counts(root, primitives)?),
            },
        };
        totals = std::array::from_fn(|kind| totals[kind].saturating_add(counts[kind]));
    }
    let kinds = [("vertices", MOST), ("faces", MOST), ("primitives", MOST_PRIMITIVES)];
    for (total, (kind, most)) in totals.into_iter().zip(kinds) {
        if total > most {
            let found = format!("{total} {kind} in all instances");
            return Err(Fault::new("nodes", found, format!("at most {most}")));
        }
    }

    let mut bare = None;
    for nodes::Placed { node, file_from_node } in placed {
        // Primitives of one mesh often share their vertices.
        let mut first_vertex = BTreeMap::new();
        let mirrored = file_from_node.matrix3.determinant() < 0.0;
        let untouched = as_is || file_from_node == glam::DAffine3::IDENTITY;
        for primitive in primitives(root, node)? {
            let Some(drawn) = drawn(root, primitive)? else { continue };
            let accessor = drawn.positions.value();
            let (first, count) = match first_vertex.get(&accessor) {
                Some(known) => *known,
                None => {
                    let first = parts.vertices.len();
                    let positions = accessors::positions(root, buffers, drawn.positions)?;
                    for (number, &[x, y, z]) in positions.iter().enumerate() {
                        let local = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                        let file = if untouched { local } else { file_from_node.transform_point3(local) };
                        if !(file.abs().max_element() <= 1e12) {
                            let found = format!("vertex {number} of accessor {accessor} lands at {file}");
                            return Err(Fault::new(nodes::place(root, node), found, "a place within 1e12 m"));
                        }
                        // y up becomes z up.
                        parts.vertices.push(DVec3::new(file.x, -file.z, file.y));
                    }
                    *first_vertex.entry(accessor).or_insert((first, positions.len()))
                }
            };
            let corners = match primitive.indices {
                Some(indices) => accessors::indices(root, buffers, indices, count)?,
                // Below 2^25, as all counts are.
                None => (0..count as u32).collect(),
            };
            let material = match primitive.material {
                Some(index) if index.value() < root.materials.len() => index.value(),
                Some(index) => {
                    let count = root.materials.len();
                    return Err(buffers::missing(format!("material {}", index.value()), count));
                }
                // Primitives without a material share one more.
                None => *bare.get_or_insert_with(|| {
                    parts.materials.push(Material { name: "no material".to_string(), reflectivity });
                    parts.materials.len() - 1
                }),
            };
            let before = parts.faces.len();
            for [a, b, c] in triangles(drawn.mode, &corners) {
                // A mirror turns the outside in: the other way round it is the outside again.
                let [b, c] = if mirrored { [c, b] } else { [b, c] };
                parts.faces.push([a, b, c].map(|corner| first as u32 + corner));
            }
            // There are at most 65534 materials and the bare one.
            parts.face_materials.extend(std::iter::repeat_n(material as u16, parts.faces.len() - before));
        }
    }
    if parts.faces.is_empty() {
        return Err(Fault::new("scene", "no triangles", "at least one"));
    }
    Ok(parts)
}

/// The vertices, faces and primitives of a mesh, by what its accessors claim.
fn counts(root: &Root, primitives: &[Primitive]) -> Result<[u64; 3], Fault> {
    let mut shared = BTreeSet::new();
    let [mut vertices, mut faces] = [0_u64; 2];
    for primitive in primitives {
        let Some(Drawn { mode, positions, corners }) = drawn(root, primitive)? else { continue };
        if shared.insert(positions.value()) {
            vertices = vertices.saturating_add(accessors::get(root, positions)?.count.0);
        }
        faces = faces.saturating_add(if mode == Mode::Triangles { corners / 3 } else { corners });
    }
    Ok([vertices, faces, primitives.len() as u64])
}

/// The primitives of a node's mesh.
fn primitives(root: &Root, index: usize) -> Result<&[Primitive], Fault> {
    let node = &root.nodes[index];
    let Some(mesh_index) = node.mesh else { return Ok(&[]) };
    let mesh_index = mesh_index.value();
    let Some(mesh) = root.meshes.get(mesh_index) else {
        return Err(buffers::missing(
            format!("{}: mesh {mesh_index}", nodes::place(root, index)),
            root.meshes.len(),
        ));
    };
    // Bones and blend shapes move vertices; without them the ground would be in the wrong place.
    if node.skin.is_some() {
        return Err(Fault::new(nodes::place(root, index), "a skin", "a rigid mesh: skins are not supported"));
    }
    let weights = node.weights.as_ref().or(mesh.weights.as_ref());
    if weights.is_some_and(|weights| weights.iter().any(|&weight| weight != 0.0)) {
        let expected = "a rigid mesh: morph targets are not supported";
        return Err(Fault::new(nodes::place(root, index), "morph weights", expected));
    }
    Ok(&mesh.primitives)
}

/// A primitive whose references are known to exist.
struct Drawn {
    mode: Mode,
    positions: gltf::json::Index<gltf::json::Accessor>,
    /// How many indices, or vertices without any.
    corners: u64,
}

/// The references of a primitive, or `None` if it has no triangles.
///
/// CHOICE: points and lines are no ground and are skipped; a survey's marks do not make its mesh unusable.
fn drawn(root: &Root, primitive: &Primitive) -> Result<Option<Drawn>, Fault> {
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
        Some(indices) => (accessors::get(root, indices)?.count.0, indices.value()),
        None => (accessors::get(root, positions)?.count.0, positions.value()),
    };
    let place = || format!("accessor {place}");
    match mode {
        Mode::Triangles if !count.is_multiple_of(3) => {
            Err(Fault::new(place(), format!("{count} corners of triangles"), "a multiple of 3"))
        }
        Mode::TriangleStrip | Mode::TriangleFan if count < 3 => {
            Err(Fault::new(place(), format!("{count} corners of a strip or fan"), "3 or more"))
        }
        _ => Ok(Some(Drawn { mode, positions, corners: count })),
    }
}

/// The triangles of a primitive, by the formulas of the specification. (glTF 2.0, §3.7.2.1)
fn triangles(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    let c = corners;
    match mode {
        Mode::Triangles => c.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]).collect(),
        // Every second triangle of a strip is listed the other way round.
        Mode::TriangleStrip => {
            (0..c.len().saturating_sub(2)).map(|i| [c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]]).collect()
        }
        Mode::TriangleFan => (0..c.len().saturating_sub(2)).map(|i| [c[i + 1], c[i + 2], c[0]]).collect(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}
