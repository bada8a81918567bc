//! Terrain from any mesh format: axes, unit and scene origin, by numbers that follow from the files.

use std::path::Path;

use glam::DVec3;
use raypencil_files::sha256;
use raypencil_mesh_io::{
    DEFAULT_REFLECTIVITY, FileFrame, FileUnits, UpAxis, glb_bytes, load_mesh, read_terrain, read_triangles,
    terrain_from_bytes, write_terrain_glb,
};
use raypencil_scene::{Material, Mesh};

/// Corners of two triangles in the numbers of a file: no two coordinates of one corner are alike.
const CORNERS: [[f32; 3]; 4] = [[1.0, 2.0, 0.5], [5.0, 3.0, 0.25], [4.0, 7.0, 0.75], [0.5, 6.0, 1.5]];

const FACES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn obj() -> Vec<u8> {
    let vertices: String = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    format!("{vertices}f 1 2 3\nf 1 3 4\n").into_bytes()
}

fn ply() -> Vec<u8> {
    let vertices: String = CORNERS.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let properties = "property double x\nproperty double y\nproperty double z\n";
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\n{properties}element face 2\nproperty list uchar int \
         vertex_indices\nend_header\n{vertices}3 0 1 2\n3 0 2 3\n"
    )
    .into_bytes()
}

fn stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(2_u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        let corners = face.map(|corner| CORNERS[corner as usize]);
        bytes.extend(corners.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// A GLB with these very numbers in its buffer.
fn glb() -> Vec<u8> {
    // The writer turns z up to y up: (x, -z, y) becomes (x, y, z).
    let turned = CORNERS.iter().map(|&[x, y, z]| [x, -z, y]).collect();
    let dust = Material { name: "no material".into(), reflectivity: 0.4 };
    glb_bytes(&Mesh::new(DVec3::ZERO, turned, FACES.to_vec(), vec![0; 2], vec![dust]).unwrap())
}

fn terrain(name: &str, bytes: &[u8], frame: FileFrame) -> Mesh {
    terrain_from_bytes(bytes, Path::new(name), 0.4, &frame).unwrap()
}

fn up(axis: UpAxis) -> FileFrame {
    FileFrame { up: Some(axis), ..FileFrame::default() }
}

#[test]
fn every_format_gives_the_same_terrain_in_stated_axes() {
    let files = [("a.obj", obj()), ("a.ply", ply()), ("a.stl", stl()), ("a.glb", glb())];
    for (name, bytes) in &files {
        let z_up = terrain(name, bytes, up(UpAxis::Z));
        assert_eq!(z_up.vertices(), CORNERS, "{name}");
        // (x, y, z) of the file is (x, -z, y) of the global frame.
        let y_up = terrain(name, bytes, up(UpAxis::Y));
        assert_eq!(y_up.vertices(), CORNERS.map(|[x, y, z]| [x, -z, y]), "{name}");
        for mesh in [&z_up, &y_up] {
            assert_eq!((mesh.faces(), mesh.origin()), (&FACES[..], DVec3::ZERO), "{name}");
            assert_eq!((mesh.materials()[0].reflectivity, mesh.materials().len()), (0.4, 1), "{name}");
        }
        // Without a word the axis is that of the format.
        let usual = terrain(name, bytes, FileFrame::default());
        assert_eq!(&usual, if *name == "a.glb" { &y_up } else { &z_up }, "{name}");
    }
}

#[test]
fn a_scale_multiplies_after_the_turn() {
    let frame = FileFrame { up: Some(UpAxis::Y), scale: 0.25 };
    for (name, bytes) in [("a.obj", obj()), ("a.stl", stl()), ("a.glb", glb())] {
        let scaled = terrain(name, &bytes, frame);
        // A quarter of a single-precision number is one too.
        assert_eq!(scaled.vertices(), CORNERS.map(|[x, y, z]| [0.25 * x, -0.25 * z, 0.25 * y]), "{name}");
    }
}

#[test]
fn decimals_at_map_coordinates_are_rounded_once() {
    // Millimetres: 4,500,000.3 m and 612,345.678 m. Single precision holds multiples of 256 mm there.
    let file = "v 4500000300 -612345678 1500\nv 4500001300 -612345678 1250.5\nv 4500000300 -612344678 1500\nf 1 2 3\n";
    let mesh = terrain("a.obj", file.as_bytes(), FileFrame { up: None, scale: 0.001 });
    assert_eq!(mesh.origin().to_array(), [4_500_001.0, -612_345.0, 1.0]);
    let global = [
        [4_500_000_300.0, -612_345_678.0, 1500.0],
        [4_500_001_300.0, -612_345_678.0, 1250.5],
        [4_500_000_300.0, -612_344_678.0, 1500.0],
    ]
    .map(|corner| corner.map(|number: f64| number * 0.001));
    for (vertex, global) in mesh.vertices().iter().zip(global) {
        let offset = DVec3::from(global) - mesh.origin();
        assert_eq!(DVec3::from(vertex.map(f64::from)), offset.as_vec3().as_dvec3());
    }
    // The file says 4,500,000.3 m, and this is it to a nanometre of the map and a tenth of a micrometre of the mesh.
    let x = mesh.origin().x + f64::from(mesh.vertices()[0][0]);
    assert!((x - 4_500_000.3).abs() < 1e-7, "{x}");
}

#[test]
fn the_stated_origin_of_a_written_file_goes_with_its_turn_and_scale() {
    let corners = [[2000.5, -3000.0, 1.0], [2001.5, -3000.0, 1.0], [2000.5, -2999.0, 1.25]].map(DVec3::from);
    let dust = Material { name: "dust".into(), reflectivity: 0.25 };
    let mesh = Mesh::from_global(&corners, vec![[0, 1, 2]], vec![0], vec![dust]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ground.glb");
    write_terrain_glb(&path, &mesh, &serde_json::json!({})).unwrap();
    // y up and metres are what the file is in: nothing changes, to the bit.
    for frame in [FileFrame::default(), up(UpAxis::Y)] {
        assert_eq!(read_terrain(&path, DEFAULT_REFLECTIVITY, &frame).unwrap().mesh, mesh);
    }
    assert_eq!(load_mesh(&path).unwrap(), mesh);
    let global = |mesh: &Mesh| {
        let place = |vertex: &[f32; 3]| (DVec3::from(vertex.map(f64::from)) + mesh.origin()).to_array();
        mesh.vertices().iter().map(place).collect::<Vec<_>>()
    };
    let doubled = read_terrain(&path, 0.25, &FileFrame { up: None, scale: 2.0 }).unwrap().mesh;
    assert_eq!(global(&doubled), corners.map(|corner| (2.0 * corner).to_array()));
    // As the file has them: (x, z, -y).
    let unturned = read_terrain(&path, 0.25, &up(UpAxis::Z)).unwrap().mesh;
    assert_eq!(global(&unturned), corners.map(|c| [c.x, c.z, -c.y]));
}

#[test]
fn faces_without_area_and_faces_twice_stay() {
    // As in glTF: they have numbers, and `terrain inspect` names them.
    let faces = "f 1 1 2\nf 1 2 3\nf 1 2 3\nf 3 2 1\n";
    let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\n{faces}");
    let mesh = terrain("a.obj", text.as_bytes(), FileFrame::default());
    assert_eq!(mesh.faces(), [[0, 0, 1], [0, 1, 2], [0, 1, 2], [2, 1, 0]]);
    // The vertex that no face uses stays as well.
    assert_eq!(mesh.vertices().len(), 4);
}

#[test]
fn digests_are_those_of_the_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    std::fs::write(&path, obj()).unwrap();
    let digests = read_terrain(&path, 0.25, &FileFrame::default()).unwrap().digests;
    assert_eq!(digests, [sha256(&obj())]);
}

#[test]
fn what_is_no_terrain_is_refused_with_the_name_of_the_file() {
    let refused = |name: &str, bytes: &[u8], frame: FileFrame, message: &str| {
        let error = terrain_from_bytes(bytes, Path::new(name), 0.25, &frame).unwrap_err().to_string();
        assert_eq!(error, message);
    };
    let plain = FileFrame::default();
    let none = "file: no triangles; expected at least one";
    refused("a.obj", b"v 0 0 0\n", plain, &format!("a.obj: {none}"));
    refused("a.stl", b"solid\nendsolid\n", plain, &format!("a.stl: {none}"));
    refused(
        "a.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
        plain,
        "a.obj: line 4: vertex 4; expected 1 to 3, the vertices of the file",
    );
    refused(
        "a.xyz",
        b"0 0 0\n",
        plain,
        "a.xyz: first bytes: [30, 20, 30, 20]; expected GLB, glTF, STL or PLY, or the ending .obj; an elevation model is a GeoTIFF",
    );
    // Within the limit of triangles, and beyond that of terrain only by its scale.
    let far = b"v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n";
    let error = terrain_from_bytes(far, Path::new("a.obj"), 0.25, &FileFrame { up: None, scale: 1e6 });
    let error = error.unwrap_err().to_string();
    assert!(error.starts_with("a.obj: "), "{error}");
}

#[test]
fn what_a_format_states_of_unit_and_axis_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, is_gltf) in [("a.glb", glb(), true), ("a.obj", obj(), false), ("a.ply", ply(), false)] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let frame = FileFrame { up: Some(UpAxis::Z), scale: 0.5 };
        assert_eq!(read_triangles(&path).unwrap().is_gltf, is_gltf, "{name}");
        let facts = read_terrain(&path, DEFAULT_REFLECTIVITY, &frame).unwrap().facts;
        assert_eq!(facts.units, Some(FileUnits::Mesh { is_gltf, frame }), "{name}");
        assert_eq!(facts.dem(), None);
    }
}
