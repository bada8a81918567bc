//! A file of any format to terrain: in the global frame, with a scene origin.

use std::path::{Path, PathBuf};

use glam::DVec3;
use raypencil_files::{Fault, FileError, Sha256Digest, file_sha256, sha256};
use raypencil_scene::{Material, Mesh};

use crate::dem::{DemOptions, read_dem_with};
use crate::file_facts::{FileFacts, FileUnits};
use crate::file_frame::{FileFrame, UpAxis};
use crate::gltf::{self, MAX_FACES_OR_VERTICES, WITHOUT_MATERIAL};
use crate::triangles::{Format, PolygonFacts, TriangleFile, format, parse, read_bytes};

/// Loads a terrain: a GLB, glTF, STL, OBJ or PLY file. Beside the mesh are the digests of its files and what they say of
/// themselves.
///
/// glTF is read as [`crate::load_mesh`] reads it. The faces of the other formats are those of [`crate::load_triangles`]: all
/// of them, also without area or twice, in the order of the file; their material is one of the given reflectivity. Each
/// vertex is turned and scaled in double precision, and rounded once, to a single-precision offset from the scene origin.
///
/// Limits: 1 GiB of file, 2^25 vertices and 2^25 faces.
///
/// # Errors
/// As [`crate::load_mesh`] and [`crate::load_triangles`]; a file without faces; a mesh beyond a limit.
///
/// ```
/// use raypencil_mesh_io::{FileFrame, UpAxis, read_terrain};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("floor.obj");
/// // A floor of 1 m in millimetres, y up.
/// std::fs::write(&path, "v 0 0 0\nv 0 0 1000\nv 1000 0 0\nf 1 2 3\n")?;
/// let mesh = read_terrain(&path, 0.3, &FileFrame { up: Some(UpAxis::Y), scale: 0.001 })?.mesh;
/// assert_eq!(mesh.vertices(), [[0.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]);
/// assert_eq!(mesh.materials()[0].reflectivity, 0.3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_terrain(path: &Path, reflectivity: f64, frame: &FileFrame) -> Result<TerrainFile, FileError> {
    terrain_of_bytes(&read_bytes(path)?, path, reflectivity, frame)
}

/// Terrain of a file, and what ties it to the file.
#[derive(Debug, Clone)]
pub struct TerrainFile {
    /// The terrain.
    pub mesh: Mesh,
    /// Digests of the file and of the buffers beside it.
    pub digests: Vec<Sha256Digest>,
    /// What was found out about the file beside its faces.
    pub facts: FileFacts,
}

/// The files that [`read_terrain`] reads, each with its digest: the file itself, and the buffers in files that a glTF file
/// names. Its faces are not read. A buffer that cannot be read is left out: the terrain says why if it needs it.
///
/// # Errors
/// A file that cannot be read; a glTF file that is none.
pub fn terrain_files(path: &Path) -> Result<Vec<(PathBuf, Sha256Digest)>, FileError> {
    let bytes = read_bytes(path)?;
    let mut files = vec![(path.to_path_buf(), sha256(&bytes))];
    if format(&bytes, path).is_ok_and(|format| format == Format::Gltf) {
        files.extend(gltf::buffer_files(&bytes, path)?);
    }
    Ok(files)
}

/// Terrain of an elevation model, or of its part inside a window, with the digest of the whole file.
///
/// # Errors
/// As [`read_dem`](crate::read_dem) and [`Dem::mesh`](crate::Dem::mesh).
pub fn read_dem_terrain(
    path: &Path,
    options: &DemOptions,
    max_error: Option<f64>,
    reflectivity: f64,
) -> Result<TerrainFile, FileError> {
    let dem = read_dem_with(path, options)?;
    let mesh = dem.mesh(max_error, reflectivity)?;
    let (_, sha) = file_sha256(path).map_err(|error| FileError::io(path, "read", error))?;
    Ok(TerrainFile { mesh, digests: vec![sha], facts: dem.facts().into() })
}

/// Terrain from the bytes of a file, as [`read_terrain`] reads it; `file` is its name in messages, and its ending tells the
/// format where the bytes do not.
///
/// # Errors
/// As [`read_terrain`].
pub fn terrain_from_bytes(
    bytes: &[u8],
    file: &Path,
    reflectivity: f64,
    frame: &FileFrame,
) -> Result<Mesh, FileError> {
    Ok(terrain_of_bytes(bytes, file, reflectivity, frame)?.mesh)
}

fn terrain_of_bytes(
    bytes: &[u8],
    file: &Path,
    reflectivity: f64,
    frame: &FileFrame,
) -> Result<TerrainFile, FileError> {
    let in_file = |fault: Fault| FileError::Mesh(fault.in_file(file));
    let units = |is_gltf| Some(FileUnits::Mesh { is_gltf, frame: *frame });
    if format(bytes, file).map_err(in_file)? == Format::Gltf {
        let (mesh, digests) = gltf::terrain_from_bytes(bytes, file, reflectivity, frame)?;
        let facts = FileFacts { units: units(true), polygons: PolygonFacts::default() };
        return Ok(TerrainFile { mesh, digests, facts });
    }
    let TriangleFile { triangles, digests, polygon_facts, .. } = parse(bytes, file)?;
    let (vertices, faces) = (triangles.vertices(), triangles.faces());
    if faces.is_empty() {
        return Err(in_file(Fault::new("file", "no triangles", "at least one")));
    }
    for (kind, count) in [("vertices", vertices.len()), ("faces", faces.len())] {
        if count as u64 > MAX_FACES_OR_VERTICES {
            let expected = format!("at most {MAX_FACES_OR_VERTICES}");
            return Err(in_file(Fault::new("file", format!("{count} {kind}"), expected)));
        }
    }
    let vertices: Vec<DVec3> = vertices.iter().map(|&vertex| frame.global(vertex, UpAxis::Z)).collect();
    let material = Material { name: WITHOUT_MATERIAL.to_string(), reflectivity };
    let mesh = Mesh::from_global(&vertices, faces.to_vec(), vec![0; faces.len()], vec![material])
        .map_err(|source| FileError::Scene { origin: file.display().to_string(), source })?;
    Ok(TerrainFile { mesh, digests, facts: FileFacts { units: units(false), polygons: polygon_facts } })
}
