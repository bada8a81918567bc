//! A mesh to GLB: one node, the mesh's own numbers, faces in the order of `FaceId`. (glTF 2.0)

use std::path::Path;

use raypencil_files::{Fault, FileError, write_atomically};
use raypencil_scene::{Material, Mesh};
use serde_json::{Value, json};

use crate::gltf::limits::{MAX_FACES_OR_VERTICES, MAX_MATERIALS};

/// Buffer view with vertex attributes. (glTF 2.0, §5.11.5)
const ARRAY_BUFFER: u32 = 34_962;

/// Buffer view with vertex indices. (§5.11.5)
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;

/// Component type of f32. (§5.1.3)
const FLOAT: u32 = 5_126;

/// Component type of u32. (§5.1.3)
const UNSIGNED_INT: u32 = 5_125;

/// Writes `mesh` as a GLB file with the contents of [`glb_bytes`].
///
/// # Errors
/// A mesh that the reader would refuse: without faces, with more than 2^25 faces or vertices, or with more than 65534
/// materials. An error of the file system, with the path.
///
/// ```
/// use glam::DVec3;
/// use raypencil_mesh_io::gltf::{DEFAULT_REFLECTIVITY, Vertices, read_mesh, write_glb};
/// use raypencil_scene::{Material, Mesh};
///
/// // Vertices as offsets from the scene origin; the file holds just these numbers.
/// let (origin, vertices) = (DVec3::new(7.0, -3.0, 0.0), vec![[0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [0.0, 1.0, -0.0]]);
/// let dust = Material { name: "dust".into(), reflectivity: 0.25 };
/// let mesh = Mesh::new(origin, vertices, vec![[0, 1, 2]], vec![0], vec![dust])?;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("offsets.glb");
/// write_glb(&path, &mesh)?;
/// assert_eq!(read_mesh(&path, DEFAULT_REFLECTIVITY, Vertices::OffsetsFrom(origin))?.0, mesh);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_glb(path: impl AsRef<Path>, mesh: &Mesh) -> Result<(), FileError> {
    let path = path.as_ref();
    check(mesh).map_err(|fault| FileError::Gltf(fault.in_file(path)))?;
    let bytes = glb_bytes(mesh);
    write_atomically(path, |file| file.write_all(&bytes))
}

/// Writes `mesh` as a GLB file for other programs, in which the ground is at its place in the global frame.
///
/// The file is that of [`write_glb`], but its node is translated to the scene origin. [`crate::load_mesh`] gives back
/// the same mesh bit for bit. `extras`, any JSON object, becomes the node's `extras`; `asset.extras.units` is `metre`.
///
/// # Errors
/// As [`write_glb`]; a scene origin that single precision, the precision of glTF, cannot hold. It holds all whole
/// metres below 2^24.
pub fn write_terrain_glb(path: impl AsRef<Path>, mesh: &Mesh, extras: &Value) -> Result<(), FileError> {
    let path = path.as_ref();
    let bytes = check(mesh)
        .and_then(|()| terrain_document(mesh, extras))
        .map(|document| file(mesh, &document))
        .map_err(|fault| FileError::Gltf(fault.in_file(path)))?;
    write_atomically(path, |file| file.write_all(&bytes))
}

/// JSON of a file whose node is translated to the scene origin.
fn terrain_document(mesh: &Mesh, extras: &Value) -> Result<Value, Fault> {
    let origin = mesh.origin();
    if let Some(value) = origin.to_array().into_iter().find(|value| f64::from(*value as f32) != *value) {
        let expected = "a number that single precision holds, such as whole metres below 16777216";
        return Err(Fault::new("mesh", format!("a scene origin of {origin}, with {value}"), expected));
    }
    let mut document = document(mesh);
    document["asset"]["extras"]["units"] = json!("metre");
    let node = &mut document["nodes"][0];
    node["extras"] = extras.clone();
    if origin != glam::DVec3::ZERO {
        // z up becomes y up; adding zero turns -0 into +0.
        node["translation"] = json!([origin.x, origin.z, -origin.y + 0.0]);
    }
    Ok(document)
}

/// Refuses a mesh that a GLB cannot hold, or that [`crate::load_mesh`] would not read back.
fn check(mesh: &Mesh) -> Result<(), Fault> {
    if mesh.faces().is_empty() {
        return Err(Fault::new("mesh", "no faces", "at least one: glTF has no empty meshes"));
    }
    for (name, count) in [("faces", mesh.faces().len()), ("vertices", mesh.vertices().len())] {
        if count as u64 > MAX_FACES_OR_VERTICES {
            return Err(Fault::new(
                "mesh",
                format!("{count} {name}"),
                format!("at most {MAX_FACES_OR_VERTICES}"),
            ));
        }
    }
    match mesh.materials().len() {
        count if count > MAX_MATERIALS => {
            Err(Fault::new("mesh", format!("{count} materials"), format!("at most {MAX_MATERIALS}")))
        }
        _ => Ok(()),
    }
}

/// Bytes of a GLB file with `mesh`, valid glTF 2.0. The same mesh gives the same bytes.
///
/// The vertices are the mesh's own `f32` offsets from its origin, metres, in the axes of glTF (y up): scene (x, y, z)
/// becomes (x, z, -y). No node has a transform. `asset.extras.originM` has the origin, metres in the global frame.
/// [`crate::gltf::read_mesh`] is given the origin and returns the same mesh bit for bit; [`crate::load_mesh`] takes the
/// vertices for global ones.
///
/// All faces refer to one list of vertices. Each run of faces of one material is a primitive, so that the faces have
/// the order of [`raypencil_scene::FaceId`]. `extras.reflectivity` of a material is its reflectivity.
///
/// # Panics
/// If the mesh has more faces or vertices than a GLB of 4 GiB can hold; [`write_glb`] refuses such a mesh.
pub fn glb_bytes(mesh: &Mesh) -> Vec<u8> {
    file(mesh, &document(mesh))
}

/// Bytes of the file of a mesh, with `document` as its JSON.
fn file(mesh: &Mesh, document: &Value) -> Vec<u8> {
    let positions = 12 * mesh.vertices().len();
    let indices = 12 * mesh.faces().len();
    let mut bin = Vec::with_capacity(positions + indices);
    for &[x, y, z] in mesh.vertices() {
        bin.extend([x, z, -y].iter().flat_map(|coordinate| coordinate.to_le_bytes()));
    }
    bin.extend(mesh.faces().as_flattened().iter().flat_map(|index| index.to_le_bytes()));
    container(&serde_json::to_vec(document).expect("JSON of numbers and texts"), &bin)
}

/// JSON of the file. The keys of objects are in alphabetical order, so that the same mesh gives the same text.
fn document(mesh: &Mesh) -> Value {
    let origin = mesh.origin().to_array();
    let mut document = json!({
        "asset": {
            "version": "2.0",
            "generator": concat!("raypencil ", env!("CARGO_PKG_VERSION")),
            "extras": {"originM": origin},
        },
        "scene": 0,
        "scenes": [{"nodes": []}],
    });
    // glTF has no empty lists: a mesh without materials or faces has no key for them.
    if !mesh.materials().is_empty() {
        let material = |Material { name, reflectivity }: &Material| json!({"name": name, "extras": {"reflectivity": reflectivity}});
        document["materials"] = mesh.materials().iter().map(material).collect();
    }
    if mesh.faces().is_empty() {
        return document;
    }
    let vertices = mesh.vertices().len();
    let [low, high] = bounds(mesh);
    let mut accessors = vec![json!({
        "bufferView": 0, "componentType": FLOAT, "type": "VEC3", "count": vertices, "min": low, "max": high,
    })];
    let mut primitives = Vec::new();
    let mut first = 0;
    for run in mesh.face_materials().chunk_by(|a, b| a == b) {
        primitives.push(json!({
            "attributes": {"POSITION": 0}, "indices": accessors.len(), "material": run[0], "mode": 4,
        }));
        accessors.push(json!({
            "bufferView": 1, "byteOffset": 12 * first, "componentType": UNSIGNED_INT, "type": "SCALAR",
            "count": 3 * run.len(),
        }));
        first += run.len();
    }
    let (positions, indices) = (12 * vertices, 12 * mesh.faces().len());
    document["nodes"] = json!([{"mesh": 0, "name": "terrain"}]);
    document["scenes"] = json!([{"nodes": [0]}]);
    document["meshes"] = json!([{"name": "terrain", "primitives": primitives}]);
    document["accessors"] = accessors.into();
    document["bufferViews"] = json!([
        {"buffer": 0, "byteOffset": 0, "byteLength": positions, "target": ARRAY_BUFFER},
        {"buffer": 0, "byteOffset": positions, "byteLength": indices, "target": ELEMENT_ARRAY_BUFFER},
    ]);
    document["buffers"] = json!([{"byteLength": positions + indices}]);
    document
}

/// Minimum and maximum coordinates, in the axes of the file.
fn bounds(mesh: &Mesh) -> [[f32; 3]; 2] {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for &[x, y, z] in mesh.vertices() {
        for (axis, coordinate) in [x, z, -y].into_iter().enumerate() {
            low[axis] = low[axis].min(coordinate);
            high[axis] = high[axis].max(coordinate);
        }
    }
    [low, high]
}

/// Bytes of a GLB with its two chunks, each padded to 4 bytes: JSON with spaces, binary data with zeros. (§4.4)
fn container(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let chunks = [(b"JSON", json, b' '), (b"BIN\0", bin, 0)];
    // A file without a buffer has no binary chunk.
    let chunks = &chunks[..if bin.is_empty() { 1 } else { 2 }];
    let total: usize =
        12 + chunks.iter().map(|(_, data, _)| 8 + data.len().next_multiple_of(4)).sum::<usize>();
    let word = |length: usize| u32::try_from(length).expect("a GLB of less than 4 GiB").to_le_bytes();
    let mut file = Vec::with_capacity(total);
    file.extend(b"glTF\x02\0\0\0");
    file.extend(word(total));
    for &(kind, data, padding) in chunks {
        let length = data.len().next_multiple_of(4);
        file.extend(word(length));
        file.extend(kind);
        file.extend(data);
        file.extend(std::iter::repeat_n(padding, length - data.len()));
    }
    file
}
