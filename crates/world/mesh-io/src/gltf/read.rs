//! glTF and GLB to a mesh, with its scene origin.

use std::path::{Path, PathBuf};

use glam::DVec3;
use raypencil_files::{Fault, FileError, Sha256Digest, bytes, sha256};
use raypencil_scene::Mesh;

use crate::file_frame::{FileFrame, UpAxis};
use crate::gltf::assemble::{Parts, assemble};
use crate::gltf::buffers::Buffers;
use crate::gltf::limits::MAX_FILE_BYTES;
use crate::gltf::{container, json, materials, nodes, stated_origin};

/// Reflectivity of materials that state none. CHOICE: bright Martian dust reflects about this much in the near
/// infrared.
pub const DEFAULT_REFLECTIVITY: f64 = 0.25;

/// Maximum coordinate of terrain, metres.
const MAX_COORDINATE: f64 = 1e12;

/// Loads a `.glb` or `.gltf` terrain. Materials that state no reflectivity get [`DEFAULT_REFLECTIVITY`].
///
/// The axes of glTF are y up: (x, y, z) of the file becomes (x, -z, y). The unit is the metre. Transforms of nodes are
/// read and composed in double precision.
///
/// Limits: 1 GiB for the file, [`MAX_BUFFER_FILES_BYTES`](crate::MAX_BUFFER_FILES_BYTES) for all files of buffers beside it,
/// each read once; 2^25 faces and vertices in all instances; 2^19 objects in the JSON.
///
/// # Errors
/// Names the file and the accessor, node, buffer or line of JSON that is wrong.
pub fn load_mesh(path: impl AsRef<Path>) -> Result<Mesh, FileError> {
    Ok(read_mesh(path.as_ref(), DEFAULT_REFLECTIVITY, Vertices::Global)?.0)
}

/// Mesh from the bytes of a `.glb` or `.gltf` file. `file` is its name in messages; buffers in files of their own are
/// looked up beside it. Materials that state no reflectivity get `reflectivity`.
///
/// # Errors
/// As [`load_mesh`].
///
/// ```
/// use glam::DVec3;
/// use raypencil_mesh_io::{glb_bytes, mesh_from_bytes};
/// use raypencil_scene::{Material, Mesh};
///
/// let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let dust = Material { name: "dust".into(), reflectivity: 0.3 };
/// let mesh = Mesh::new(DVec3::ZERO, vertices, vec![[0, 1, 2]], vec![0], vec![dust])?;
/// // The file states its reflectivity, so that the 0.9 given here is not used.
/// let read = mesh_from_bytes(&glb_bytes(&mesh), "here.glb".as_ref(), 0.9)?;
/// assert_eq!(read.materials()[0].reflectivity, 0.3);
///
/// let error = mesh_from_bytes(b"PK", "here.glb".as_ref(), 0.9).unwrap_err().to_string();
/// assert!(error.starts_with("here.glb: first bytes: [50, 4b]; expected the magic"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mesh_from_bytes(bytes: &[u8], file: &Path, reflectivity: f64) -> Result<Mesh, FileError> {
    Ok(parse(bytes, file, reflectivity, Vertices::Global, &FileFrame::default())?.0)
}

/// Mesh from the bytes of a file whose axes and unit may be others than those of glTF, and the digests of the file and of the
/// buffers beside it.
///
/// # Errors
/// As [`load_mesh`].
pub(crate) fn terrain_from_bytes(
    bytes: &[u8],
    file: &Path,
    reflectivity: f64,
    frame: &FileFrame,
) -> Result<(Mesh, Vec<Sha256Digest>), FileError> {
    let (mesh, external) = parse(bytes, file, reflectivity, Vertices::Global, frame)?;
    Ok((mesh, std::iter::once(sha256(bytes)).chain(external).collect()))
}

/// The buffers in files of their own that a file names, each once, with their digests.
///
/// # Errors
/// A file that is no glTF.
pub(crate) fn buffer_files(bytes: &[u8], file: &Path) -> Result<Vec<(PathBuf, Sha256Digest)>, FileError> {
    let in_file = |fault: Fault| FileError::Gltf(fault.in_file(file));
    let container = container::split(bytes).map_err(in_file)?;
    let root = json::root(container.json).map_err(in_file)?;
    let folder = file.parent().unwrap_or(Path::new(""));
    Ok(Buffers::new(&root, folder, container.bin).files())
}

/// Meaning of the vertices of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Vertices {
    /// Positions in the global frame; the scene origin follows from them.
    Global,
    /// Offsets from this scene origin, metres; they are not changed, so that [`crate::write_glb`] is inverted bit for bit,
    /// including the signs of zeros.
    OffsetsFrom(DVec3),
}

/// Mesh of a file, and the digests of the file and of the buffers beside it, in the order of the buffers.
///
/// # Errors
/// As [`load_mesh`].
pub fn read_mesh(
    path: &Path,
    reflectivity: f64,
    kind: Vertices,
) -> Result<(Mesh, Vec<Sha256Digest>), FileError> {
    let bytes = bytes::read_file(path, MAX_FILE_BYTES).map_err(|error| FileError::io(path, "read", error))?;
    let (mesh, external) = parse(&bytes, path, reflectivity, kind, &FileFrame::default())?;
    Ok((mesh, std::iter::once(sha256(&bytes)).chain(external).collect()))
}

/// Mesh of a file from its bytes, and the digests of the buffers beside it.
fn parse(
    bytes: &[u8],
    file: &Path,
    reflectivity: f64,
    kind: Vertices,
    frame: &FileFrame,
) -> Result<(Mesh, Vec<Sha256Digest>), FileError> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let in_file = |fault: Fault| FileError::Gltf(fault.in_file(file));
    let container = container::split(bytes).map_err(in_file)?;
    let root = json::root(container.json).map_err(in_file)?;
    let mut buffers = Buffers::new(&root, folder, container.bin);
    let nodes = nodes::placed_nodes(&root, container.json, &mut buffers).map_err(in_file)?;
    let materials = materials::read(&root, container.json, reflectivity).map_err(in_file)?;
    let stated = match kind {
        Vertices::Global if frame.is_of_gltf() => stated_origin::origin(&root, &nodes),
        // The origin of a file that is turned or scaled follows from its vertices.
        Vertices::Global | Vertices::OffsetsFrom(_) => None,
    };
    let max_coordinate = MAX_COORDINATE / frame.scale;
    let parts = Parts { materials, ..Parts::default() };
    let parts = assemble(&root, nodes, &mut buffers, parts, reflectivity, stated.is_some(), max_coordinate)
        .map_err(in_file)?;
    let Parts { mut vertices, faces, face_materials, materials } = parts;
    if faces.is_empty() {
        return Err(in_file(Fault::new("scene", "no triangles", "at least one")));
    }
    let mesh = match (kind, stated) {
        (Vertices::Global, Some(origin)) => {
            stated_origin::mesh(origin, vertices, faces, face_materials, materials)
        }
        (Vertices::Global, None) => {
            // As numbers of the file again, from which z = 0 becomes y = +0, not -0: the sign means nothing in ordinary files.
            let in_file = |turned: DVec3| [turned.x, turned.z, -turned.y];
            vertices.iter_mut().for_each(|vertex| *vertex = frame.global(in_file(*vertex), UpAxis::Y));
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
