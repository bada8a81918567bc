//! glTF and GLB to triangles in the frame of the file, in double precision.

use std::path::Path;

use raypencil_files::{Fault, FileError, Sha256Digest};

use crate::gltf::assemble::{Parts, assemble};
use crate::gltf::buffers::Buffers;
use crate::gltf::{container, json, nodes};
use crate::triangles::MAX_COORDINATE;

/// Triangles of a file, in its own axes.
pub(crate) struct ExactTriangles {
    pub(crate) vertices: Vec<[f64; 3]>,
    pub(crate) faces: Vec<[u32; 3]>,
    /// Digests of the buffers beside the file, in their order.
    pub(crate) buffers: Vec<Sha256Digest>,
}

/// Triangles of a `.glb` or `.gltf` file from its bytes. Transforms of nodes are composed and applied in double
/// precision, from the doubles nearest to the numbers of the JSON. Materials are not read.
pub(crate) fn exact_triangles(bytes: &[u8], file: &Path) -> Result<ExactTriangles, FileError> {
    let read = || -> Result<ExactTriangles, Fault> {
        let container = container::split(bytes)?;
        let root = json::root(container.json)?;
        let mut buffers = Buffers::new(&root, file.parent().unwrap_or(Path::new("")), container.bin);
        let nodes = nodes::placed_nodes(&root, container.json, &mut buffers)?;
        // Any reflectivity: nobody sees it.
        let parts = assemble(&root, nodes, &mut buffers, Parts::default(), 0.0, false, MAX_COORDINATE)?;
        // Terrain is turned to z up by exchanging coordinates; turned back, each is the number that it was.
        let vertices = parts.vertices.iter().map(|turned| [turned.x, turned.z, -turned.y]).collect();
        Ok(ExactTriangles { vertices, faces: parts.faces, buffers: buffers.digests().collect() })
    };
    read().map_err(|fault| FileError::Gltf(fault.in_file(file)))
}
