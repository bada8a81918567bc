//! The triangles that the file of an input pack must become: for each part of the file by a closed form of its own, and
//! not by the code that loads files.

use crate::input::clause::LoadingClause;
use crate::input::gltf_document::{CORNERS, document};

/// A face that a loader must give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputFace {
    /// The clause that it tests.
    pub clause: LoadingClause,
    /// Its corners in the scene's axes (z up), metres, counter-clockwise as seen from outside. Any of them may be first.
    pub corners: [[f64; 3]; 3],
    /// Reflectivity of its material.
    pub reflectivity: f64,
}

/// Reflectivity of faces without a material.
const WITHOUT_MATERIAL: f64 = 0.25;

/// The faces of an input pack, in the order of their numbers.
///
/// ```
/// use raypencil_pack::input_faces;
///
/// // The first part has no transform: (x, y, z) of the file is (x, -z, y). Its first corner is (0.25, 0.5, -0.125).
/// assert_eq!(input_faces()[0].corners[0], [0.25, 0.125, 0.5]);
/// ```
pub fn input_faces() -> Vec<InputFace> {
    let mut faces = Vec::new();
    // Adds the triangle of three of the mesh's corners. `to_file` takes them to the axes of the file (y up).
    let mut add = |clause, corners: [usize; 3], reflectivity: f64, to_file: &dyn Fn([f64; 3]) -> [f64; 3]| {
        let corner = |corner: usize| {
            let [x, y, z] = to_file(CORNERS[corner].map(f64::from));
            [x, -z, y]
        };
        faces.push(InputFace { clause, corners: corners.map(corner), reflectivity });
    };
    // The indices of most meshes.
    let list = [0, 1, 3];
    let plain = WITHOUT_MATERIAL;
    let along_z = |by: f64| move |[x, y, z]: [f64; 3]| [x, y, z + by];

    add(LoadingClause::Axes, list, plain, &|p| p);
    add(LoadingClause::Translation, list, plain, &|[x, y, z]| [x + 2.0, y + 0.5, z - 3.0]);
    // A third of a turn about (1, -1, 1) takes the x axis to the z axis, y to -x, and z to -y.
    add(LoadingClause::Rotation, list, plain, &|[x, y, z]| [-y, -z, x]);
    add(LoadingClause::Scale, list, plain, &|[x, y, z]| [2.0 * x, 0.5 * y, 4.0 * z]);
    // Scaled: (2 x, y, z / 2). Turned by a third of a turn about (1, 1, 1): (z / 2, 2 x, y). Then moved.
    add(LoadingClause::PartsOfATransform, list, plain, &|[x, y, z]| [0.5 * z + 4.0, 2.0 * x, y]);
    // The child: (x, 2 y + 2, z). Its parent turns that to (z, x, 2 y + 2), then moves it.
    add(LoadingClause::Parents, list, plain, &|[x, y, z]| [z + 8.0, x, 2.0 * y + 2.0]);
    // The columns are (1, 0, 4), (2, 1, 0), (0, 1/2, 1) and (1, 0, -2).
    add(LoadingClause::Matrix, list, plain, &|[x, y, z]| [x + 2.0 * y + 1.0, y + 0.5 * z, 4.0 * x + z - 2.0]);
    // Seen in a mirror the corners run clockwise, so that two of them change places.
    add(LoadingClause::Mirroring, [0, 3, 1], plain, &|[x, y, z]| [-x, y, z - 12.0]);
    add(LoadingClause::MirroredTwice, list, plain, &|[x, y, z]| [-x, y, -z - 16.0]);
    add(LoadingClause::Instances, list, plain, &|[x, y, z]| [x, y + 4.0, z]);
    // A node, then its children in the order of its list.
    add(LoadingClause::OrderOfNodes, list, plain, &|[x, y, z]| [x + 20.0, y, z]);
    add(LoadingClause::OrderOfNodes, list, plain, &|[x, y, z]| [x + 20.0, y, z + 4.0]);
    add(LoadingClause::OrderOfNodes, list, plain, &|[x, y, z]| [x + 20.0, y, z + 2.0]);
    // glTF 2.0, 3.7.2.1: triangle i of a strip is (i, i + 1 + i % 2, i + 2 - i % 2), of a fan (i + 1, i + 2, 0).
    add(LoadingClause::Strip, [0, 1, 2], plain, &along_z(8.0));
    add(LoadingClause::Strip, [1, 3, 2], plain, &along_z(8.0));
    // The fan's indices are 0, 1, 3, 2.
    add(LoadingClause::Fan, [1, 3, 0], plain, &along_z(12.0));
    add(LoadingClause::Fan, [3, 2, 0], plain, &along_z(12.0));
    add(LoadingClause::WithoutIndices, [0, 1, 2], plain, &along_z(16.0));
    add(LoadingClause::ByteIndices, list, plain, &along_z(20.0));
    add(LoadingClause::IntIndices, list, plain, &along_z(24.0));
    add(LoadingClause::Interleaved, list, plain, &along_z(28.0));
    add(LoadingClause::Primitives, [0, 1, 2], plain, &along_z(32.0));
    add(LoadingClause::Primitives, list, plain, &along_z(32.0));
    add(LoadingClause::FacesWithoutArea, [0, 0, 1], plain, &along_z(36.0));
    add(LoadingClause::FacesWithoutArea, list, plain, &along_z(36.0));
    // Grey of 0.5 has the luminance 0.5; the other material states its reflectivity.
    add(LoadingClause::Reflectivity, list, 0.5, &along_z(40.0));
    add(LoadingClause::Reflectivity, [0, 1, 2], 0.125, &along_z(40.0));
    // 4,500,000.25 m there and 4,500,000 m back, in double precision.
    add(LoadingClause::Decimals, list, plain, &|[x, y, z]| [x + 0.25, y, z + 44.0]);
    faces
}

/// The file of an input pack, as GLB.
pub fn input_glb() -> Vec<u8> {
    let (json, mut binary) = document();
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((length as u32).to_le_bytes());
    for (kind, data) in [(b"JSON", json), (b"BIN\0", binary)] {
        file.extend((data.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(data);
    }
    file
}
