//! Files of any mesh format to triangles: which format it is, and one door to all readers.

use std::path::Path;

use raypencil_files::{Fault, FileError, Sha256Digest, bytes, sha256};
use raypencil_scene::Triangles;

use crate::gltf::exact_triangles;
use crate::triangles::parts::Parts;
use crate::triangles::polygon_facts::PolygonFacts;
use crate::triangles::{npy_pair, obj, ply, stl};

/// Maximum size of a file: 1 GiB, as of a glTF file.
const MAX_FILE_BYTES: u64 = 1 << 30;

/// Triangles of a file, and what ties them to it.
#[derive(Debug, Clone, PartialEq)]
pub struct TriangleFile {
    /// The triangles.
    pub triangles: Triangles,
    /// For each face the polygon of the file that it is a part of, from 0; `None` if each polygon is one triangle, so
    /// that face i is polygon i.
    pub polygons: Option<Vec<u32>>,
    /// What was found out about the polygons that are no triangles.
    pub polygon_facts: PolygonFacts,
    /// Whether the file is glTF, which is in metres with y up. The other formats state neither.
    pub is_gltf: bool,
    /// Digests of the files that were read: the file itself, then the buffers beside it; of a pair of NPY files the
    /// vertices, then the faces.
    pub digests: Vec<Sha256Digest>,
    /// What a file without faces holds, in words; `None`: it has faces.
    pub without_faces: Option<String>,
}

impl TriangleFile {
    /// Refuses a file without any face, where rays are to meet something; `file` is its name in messages.
    ///
    /// ```
    /// use raypencil_mesh_io::read_triangles;
    ///
    /// let folder = tempfile::tempdir()?;
    /// let path = folder.path().join("words.obj");
    /// std::fs::write(&path, "garbage in\n")?;
    /// let error = read_triangles(&path)?.require_faces(&path).unwrap_err().to_string();
    /// assert!(error.ends_with("no vertex and no face; its lines begin with \"garbage\"; expected at least one face"), "{error}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Says what the file holds.
    pub fn require_faces(&self, file: &Path) -> Result<(), FileError> {
        match &self.without_faces {
            None => Ok(()),
            Some(found) => Err(FileError::Mesh(Fault::new("file", found, "at least one face").in_file(file))),
        }
    }
}

/// Loads the triangles of a file: GLB, glTF, STL, OBJ, PLY, or a pair of NPY files.
///
/// Vertices are in the frame and the unit of the file. No axis is turned: the y axis of a glTF file stays y, unlike in
/// [`crate::load_mesh`]. Each number is taken as it is: of a decimal the nearest `f64`; single precision is widened.
/// Only the nodes of a glTF file move vertices, in double precision.
///
/// Faces count from 0 in the order of the file. A polygon of n corners becomes n - 2 faces: a fan around its first corner if it
/// is convex, else triangles that cover it, the same ones whichever corner it begins with. [`read_triangles`] tells which
/// polygon a face belongs to, and names the polygons that cross themselves (of these the fan is taken) or are not planar. The corners of STL become one vertex if they have
/// the same three numbers. A file may have no faces.
///
/// Limits: 1 GiB for each file; 10,000 corners of a polygon that is not convex; of PLY 256 elements, each of at most 1024 properties.
///
/// `path` is a file; or a folder with `vertices.npy` and `faces.npy`; or one of two files whose names end with these;
/// or `rock` for `rock.vertices.npy` and `rock.faces.npy`, also with `_` or `-` for the dot.
///
/// # Errors
/// Names the file and the place in it (the line of a text, the byte of a binary file), what was found there and what
/// was expected. Sizes are compared with the length of the file before memory is allocated.
///
/// ```
/// use raypencil_mesh_io::load_triangles;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("square.obj");
/// std::fs::write(&path, "v 0.1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// let mesh = load_triangles(&path)?;
/// // 0.1 is the double, not the single nearest to it; the square became a fan of two triangles.
/// assert_eq!(mesh.vertices()[0], [0.1, 0.0, 0.0]);
/// assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3]]);
///
/// std::fs::write(&path, "v 0 0 0\nf 1 1 5\n")?;
/// let error = load_triangles(&path).unwrap_err().to_string();
/// assert!(error.ends_with("square.obj: line 2: vertex 5; expected 1 to 1, the vertices of the file"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn load_triangles(path: &Path) -> Result<Triangles, FileError> {
    Ok(read_triangles(path)?.triangles)
}

/// Loads triangles as [`load_triangles`] does, with the polygon of each face and the digests of the files.
///
/// # Errors
/// As [`load_triangles`].
///
/// ```
/// use raypencil_mesh_io::read_triangles;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("house.obj");
/// std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n")?;
/// let file = read_triangles(&path)?;
/// // Faces 0 and 1 are the square, polygon 0; face 2 is polygon 1.
/// assert_eq!(file.polygons, Some(vec![0, 0, 1]));
/// assert_eq!(file.digests.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_triangles(path: &Path) -> Result<TriangleFile, FileError> {
    if let Some(files) = npy_pair::files(path) {
        let (vertices, faces) = (read_bytes(&files[0])?, read_bytes(&files[1])?);
        let parts = npy_pair::read(&files, [&vertices, &faces])?;
        let digests = vec![sha256(&vertices), sha256(&faces)];
        return finished(parts, PolygonFacts::default(), path, digests, false);
    }
    parse(&read_bytes(path)?, path)
}

pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    bytes::read_file(path, MAX_FILE_BYTES).map_err(|error| FileError::io(path, "read", error))
}

/// Triangles from the bytes of a GLB, glTF, STL, OBJ or PLY file. `file` is its name in messages, and its ending tells
/// the format where the bytes do not; buffers in files of their own are looked up beside it.
///
/// # Errors
/// As [`load_triangles`].
///
/// ```
/// use raypencil_mesh_io::triangles_from_bytes;
///
/// let file = b"solid a facet\nendsolid";
/// assert_eq!(triangles_from_bytes(file, "empty.stl".as_ref())?.faces().len(), 0);
/// # Ok::<(), raypencil_files::FileError>(())
/// ```
pub fn triangles_from_bytes(bytes: &[u8], file: &Path) -> Result<Triangles, FileError> {
    Ok(parse(bytes, file)?.triangles)
}

/// Endings of meshes in formats that are not read. They are told by their names, not by their first bytes.
const OTHER_MESH_ENDINGS: [&str; 20] = [
    "3ds", "3mf", "amf", "blend", "ctm", "dae", "fbx", "iges", "igs", "lwo", "msh", "off", "step", "stp",
    "usd", "usda", "usdc", "usdz", "wrl", "x3d",
];

/// Mesh format of a single file.
#[derive(PartialEq)]
pub(crate) enum Format {
    Gltf,
    Stl,
    Obj,
    Ply,
}

/// Triangles of a single file from its bytes, with what ties them to it.
pub(crate) fn parse(bytes: &[u8], file: &Path) -> Result<TriangleFile, FileError> {
    let in_file = |fault: Fault| FileError::Mesh(fault.in_file(file));
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let found = format!("{} bytes", bytes.len());
        return Err(in_file(Fault::new("length", found, format!("at most {MAX_FILE_BYTES} bytes"))));
    }
    let mut digests = vec![sha256(bytes)];
    let format = format(bytes, file).map_err(in_file)?;
    let mut parts = match format {
        Format::Gltf => {
            let read = exact_triangles(bytes, file)?;
            digests.extend(read.buffers);
            Parts::of_triangles(read.vertices, read.faces)
        }
        Format::Stl => stl::read(bytes).map_err(in_file)?,
        Format::Obj => obj::read(bytes).map_err(in_file)?,
        Format::Ply => ply::read(bytes).map_err(in_file)?,
    };
    let mut facts = parts.cut_concave_polygons().map_err(in_file)?;
    if format == Format::Obj {
        facts = facts.with_lines(|polygon| obj::line_of_polygon(bytes, polygon));
    }
    finished(parts, facts, file, digests, format == Format::Gltf)
}

/// Format of a file: by its first bytes, then by its ending, then by the rest of its bytes. OBJ has no mark of its own.
pub(crate) fn format(bytes: &[u8], file: &Path) -> Result<Format, Fault> {
    let ending = file.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    match (bytes, ending.as_deref()) {
        ([b'g', b'l', b'T', b'F', ..], _) => Ok(Format::Gltf),
        ([b'p', b'l', b'y', b'\n' | b'\r', ..], _) => Ok(Format::Ply),
        (_, Some(ending @ ("glb" | "gltf" | "stl" | "ply")))
            if !begins_as(ending, bytes) && obj::is_like(bytes) =>
        {
            let found = format!("lines of an OBJ file in one that ends in .{ending}");
            Err(Fault::new("format", found, "its own format, or the ending .obj"))
        }
        (_, Some("glb" | "gltf")) => Ok(Format::Gltf),
        (_, Some("stl")) => Ok(Format::Stl),
        (_, Some("obj")) => Ok(Format::Obj),
        (_, Some("ply")) => Ok(Format::Ply),
        _ if stl::is_binary(bytes) || bytes.starts_with(b"solid") => Ok(Format::Stl),
        _ if bytes.trim_ascii_start().starts_with(b"{") => Ok(Format::Gltf),
        ([0x93, b'N', b'U', b'M', b'P', b'Y', ..], _) => {
            let expected = "two files whose names end with vertices.npy and faces.npy";
            Err(Fault::new("first bytes", "a single NPY file", expected))
        }
        // Solids with curved faces, which programs for meshes do not read.
        (_, Some(ending @ ("step" | "stp" | "iges" | "igs"))) => {
            let expected =
                "GLB, glTF, STL, OBJ or PLY, to which a CAD program such as FreeCAD exports it (STL)";
            Err(Fault::new("format", format!("a solid as .{ending}"), expected))
        }
        (_, Some(ending)) if OTHER_MESH_ENDINGS.contains(&ending) => {
            let expected = "GLB, glTF, STL, OBJ or PLY, to which `assimp export` or Blender converts it";
            Err(Fault::new("format", format!("a mesh as .{ending}"), expected))
        }
        ([b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..], _) => {
            let expected = "a mesh, which `raypencil terrain import` makes of an elevation model";
            Err(Fault::new("first bytes", "a TIFF", expected))
        }
        _ => {
            let found = format!("{:02x?}", &bytes[..bytes.len().min(4)]);
            let expected = "GLB, glTF, STL or PLY, or the ending .obj; an elevation model is a GeoTIFF";
            Err(Fault::new("first bytes", found, expected))
        }
    }
}

/// Whether a file begins as one with this ending, where no mark of its format has told it.
fn begins_as(ending: &str, bytes: &[u8]) -> bool {
    match ending {
        "stl" => stl::is_binary(bytes) || stl::begins_as_text(bytes),
        "glb" | "gltf" => bytes.trim_ascii_start().starts_with(b"{"),
        _ => false,
    }
}

fn finished(
    parts: Parts,
    polygon_facts: PolygonFacts,
    file: &Path,
    digests: Vec<Sha256Digest>,
    is_gltf: bool,
) -> Result<TriangleFile, FileError> {
    let Parts { vertices, faces, polygons, others, .. } = parts;
    let without_faces = faces.is_empty().then(|| {
        let vertices = match vertices.len() {
            0 => "no vertex".to_string(),
            1 => "1 vertex".to_string(),
            count => format!("{count} vertices"),
        };
        let others = if others.is_empty() { others } else { format!("; {others}") };
        format!("{vertices} and no face{others}")
    });
    let triangles = Triangles::new(vertices, faces)
        .map_err(|source| FileError::Scene { origin: file.display().to_string(), source })?;
    Ok(TriangleFile { triangles, polygons, polygon_facts, is_gltf, digests, without_faces })
}
