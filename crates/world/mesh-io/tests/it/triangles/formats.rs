//! The same mesh in every format, and numbers as files give them.

use std::fs;

use raypencil_files::{Limits, npy_from_bytes, npy_numbers_from_bytes};
use raypencil_mesh_io::{load_triangles, read_triangles};

use super::samples::{self, FACES, VERTICES, all, npy, npy_faces, npy_vertices};
use super::*;

#[test]
fn every_format_gives_the_same_triangles() {
    let expected = Triangles::new(VERTICES.to_vec(), FACES.to_vec()).unwrap();
    for (name, bytes) in all() {
        let mesh = parse(name, &bytes).unwrap();
        assert_eq!(mesh, expected, "{name}");
        assert_eq!(bits(&mesh), bits(&expected), "{name}");
    }
}

#[test]
fn a_pair_of_arrays_gives_them_too() {
    let folder = tempfile::tempdir().unwrap();
    let expected = Triangles::new(VERTICES.to_vec(), FACES.to_vec()).unwrap();
    for prefix in ["", "rock.", "rock_", "rock-", "any"] {
        fs::write(folder.path().join(format!("{prefix}vertices.npy")), npy_vertices()).unwrap();
        fs::write(folder.path().join(format!("{prefix}faces.npy")), npy_faces()).unwrap();
    }
    for (path, sign) in [("dot", "."), ("low", "_"), ("dash", "-")] {
        let file = |end: &str| folder.path().join(format!("{path}{sign}{end}.npy"));
        fs::write(file("vertices"), npy_vertices()).unwrap();
        fs::write(file("faces"), npy_faces()).unwrap();
    }
    // Each file has its own digest, that of the vertices first.
    let own = [npy_vertices(), npy_faces()].map(|bytes| raypencil_files::sha256(&bytes));
    assert_eq!(read_triangles(&folder.path().join("dash")).unwrap().digests, own);
    for path in ["", "rock", "rock_vertices.npy", "anyfaces.npy", "vertices.npy", "dot", "low", "dash"] {
        let file = read_triangles(&folder.path().join(path)).unwrap();
        assert_eq!(bits(&file.triangles), bits(&expected), "{path}");
        assert_eq!((file.triangles, file.polygons, file.digests.len()), (expected.clone(), None, 2));
    }
    // Single precision is widened; faces may be bytes.
    let numbers: Vec<u8> = [0.1_f32; 9].iter().flat_map(|number| number.to_be_bytes()).collect();
    fs::write(folder.path().join("vertices.npy"), npy(">f4", 3, &numbers)).unwrap();
    fs::write(folder.path().join("faces.npy"), npy("|u1", 1, &[2, 1, 0])).unwrap();
    let mesh = load_triangles(folder.path()).unwrap();
    assert_eq!((mesh.vertices()[0], mesh.faces()), ([f64::from(0.1_f32); 3], &[[2, 1, 0]][..]));
}

#[test]
fn decimals_become_the_nearest_double() {
    let numbers = ["0.1", "1e-300", "-123456789.123456789", "+5.", ".5", "9007199254740993"];
    for text in numbers {
        let expected: f64 = text.parse().unwrap();
        let stl = format!(
            "solid\nfacet normal nan nan nan\nouter loop\nvertex {text} 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
             endfacet\nendsolid"
        );
        let obj = format!("v {text} 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        let ply = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list uchar int vertex_index\nend_header\n{text} 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        );
        for (name, file) in [("a.stl", stl), ("a.obj", obj), ("a.ply", ply)] {
            assert_eq!(parse(name, file.as_bytes()).unwrap().vertices()[0][0].to_bits(), expected.to_bits());
        }
    }
    // 0.1 = 0x3fb999999999999a as a double.
    let mesh = parse("a.obj", b"v 0.1 0.1 0.1\n").unwrap();
    assert_eq!(mesh.vertices()[0][0].to_bits(), 0x3fb9_9999_9999_999a);
}

#[test]
fn all_types_of_ply_are_widened_exactly() {
    let types: [(&str, &[u8], f64); 8] = [
        ("char", &[0x80], -128.0),
        ("uint8", &[0xff], 255.0),
        ("short", &[0x00, 0x80], -32768.0),
        ("uint16", &[0xfe, 0xff], 65534.0),
        ("int32", &[0, 0, 0, 0x80], -2147483648.0),
        ("uint", &[0xff; 4], 4294967295.0),
        ("float", &0.1_f32.to_le_bytes(), 0.1_f32 as f64),
        ("float64", &0.1_f64.to_le_bytes(), 0.1),
    ];
    for (name, bytes, number) in types {
        let mut file = format!(
            "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nproperty {name} z\r\nproperty {name} x\r\n\
             property {name} y\r\nend_header\r\n"
        )
        .into_bytes();
        file.extend(bytes.repeat(3));
        assert_eq!(parse("a.ply", &file).unwrap().vertices(), [[number; 3]], "{name}");
    }
}

#[test]
fn the_ending_of_header_lines_is_that_of_the_first() {
    // The first byte after a header with "\r" is "\n", 10.
    let header = "ply\rformat binary_big_endian 1.0\relement vertex 1\rproperty uchar x\rproperty uchar y\r\
                  property uchar z\rend_header\r";
    let file = [header.as_bytes(), &[10, 13, 10]].concat();
    assert_eq!(parse("a.ply", &file).unwrap().vertices(), [[10.0, 13.0, 10.0]]);
}

#[test]
fn stl_corners_of_the_same_numbers_are_one_vertex() {
    let facet = |x: &str, y: &str| {
        format!(
            "FACET normal 0 0 0 outer loop vertex {x} 0 0\rvertex 1 {y} 0\nvertex 0 1 0 endloop endfacet\r\n"
        )
    };
    // Two solids; +0 and -0 are the same number, and the first of them stays.
    let file =
        format!("solid a\n{}endsolid a\nSOLID\n{}endsolid", facet("-0", "2"), facet("0", "2.0000000001"));
    let mesh = parse("a.stl", file.as_bytes()).unwrap();
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 3, 2]]);
    assert_eq!(mesh.vertices()[0][0].to_bits(), (-0.0_f64).to_bits());
}

/// A binary STL of one face, whose attributes are as long as said.
fn binary_face(attributes: u16) -> Vec<u8> {
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let numbers = corners.as_flattened().iter().flat_map(|number| number.to_le_bytes());
    [0; 12].into_iter().chain(numbers).chain(attributes.to_le_bytes()).collect()
}

#[test]
fn stl_with_attributes_or_filled_up_is_read() {
    let file = |faces: u32, bytes: &[&[u8]]| {
        let header = [&[b' '; 80][..], &faces.to_le_bytes()].concat();
        [&header, bytes.concat().as_slice()].concat()
    };
    let faces = |bytes: &[u8]| parse("a.stl", bytes).map(|mesh| mesh.faces().len());
    // A colour in the place of the count, as most programs write it; attributes between the faces.
    assert_eq!(faces(&file(2, &[&binary_face(0x7fff), &binary_face(0x7fff)])), Ok(2));
    assert_eq!(faces(&file(2, &[&binary_face(4), b"abcd", &binary_face(3), b"efg"])), Ok(2));
    // Their count has two bytes: here it is more than the first of them holds.
    assert_eq!(faces(&file(2, &[&binary_face(300), &[b'a'; 300], &binary_face(0)])), Ok(2));
    // Less than a face behind the last one, and bytes 0 up to the end of a block.
    assert_eq!(faces(&file(1, &[&binary_face(0), b"\r\n"])), Ok(1));
    assert_eq!(faces(&file(1, &[&binary_face(0), &[0; 378]])), Ok(1));
    // A file of nothing but zeros behind its head is no empty mesh: its number of faces may be what is missing.
    assert!(
        faces(&file(0, &[&[0; 378]])).unwrap_err().contains("byte 80: 0 faces, and 378 bytes behind them")
    );
    // The bytes of a second face: which of both numbers is right?
    assert_eq!(
        faces(&file(1, &[&binary_face(0), &binary_face(0)])).unwrap_err(),
        "byte 80: 1 faces, and 50 bytes behind them; expected 2 faces, if all bytes are faces (is the number of faces right?)"
    );
    // Attributes that end elsewhere than the file.
    assert!(faces(&file(2, &[&binary_face(4), b"abcd", &binary_face(3), &[7; 90]])).is_err());
}

#[test]
fn texts_may_have_a_mark_of_utf8_zeros_at_the_end_and_an_end_in_two_words() {
    let facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    for (before, after) in [
        ("", "endsolid"),
        ("\u{feff}", "endsolid a"),
        ("", "end solid a\n"),
        ("  \n", "END SOLID\nsolid b\nend solid b"),
        ("", "endsolid a\n\0"),
        ("", "endsolid\0\0\0\0"),
    ] {
        let file = format!("{before}solid a\n{facet}{after}");
        assert_eq!(parse("a.stl", file.as_bytes()).map(|mesh| mesh.faces().len()), Ok(1), "{after:?}");
    }
    let marked = "\u{feff}v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n";
    assert_eq!(parse("a.obj", marked.as_bytes()).unwrap().faces(), [[0, 1, 2]]);
}

#[test]
fn a_concave_polygon_is_covered_and_not_fanned() {
    // A U: two legs and a courtyard between them, seen from above. Its area is 28; a fan has 44.
    let u = "v 0 0 0\nv 8 0 0\nv 8 5 0\nv 6 5 0\nv 6 2 0\nv 2 2 0\nv 2 5 0\nv 0 5 0\n";
    for face in ["f 1 2 3 4 5 6 7 8", "f 4 5 6 7 8 1 2 3", "f 8 7 6 5 4 3 2 1"] {
        let mesh = parse("u.obj", format!("{u}{face}\n").as_bytes()).unwrap();
        let at = |k: u32| mesh.vertices()[k as usize];
        let area = |[a, b, c]: [u32; 3]| {
            let ([ax, ay, _], [bx, by, _], [cx, cy, _]) = (at(a), at(b), at(c));
            ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2.0
        };
        let areas: Vec<f64> = mesh.faces().iter().map(|&face| area(face)).collect();
        // In the direction of the polygon, all of them.
        let direction = if face.starts_with("f 8 7") { -1.0 } else { 1.0 };
        assert!(areas.iter().all(|area| area * direction > 0.0), "{face}: {areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 28.0 * direction, "{face}");
    }
}

#[test]
fn polygons_are_told_that_cross_themselves_or_are_not_planar() {
    let folder = tempfile::tempdir().unwrap();
    let facts = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        read_triangles(&path).unwrap().polygon_facts
    };
    // A triangle, a square, a dart, an hourglass, a bent square twice: polygons 0 to 5. The last one is bent more.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.2 0\nv 1 1 0.1\nv 1 1 0.2\n\
                f 1 2 3\n# a comment\nf 1 2 3 4\nf 1 5 2 3\nf 1 3 2 4\nf 1 2 6 4\nf 1 2 \\\n 7 4\n";
    let found = facts("a.obj", text);
    assert_eq!((found.count, found.cut), (5, 1));
    let crossing = found.crossing.as_ref().unwrap();
    assert_eq!((crossing.count, crossing.first.to_string()), (1, "polygon 3 (line 12)".into()));
    let bent = found.bent.as_ref().unwrap();
    assert_eq!((bent.count, bent.worst.to_string()), (2, "polygon 5 (line 14)".into()));
    // The corners of a square, one of them 0.2 up, are 0.05 off the plane between them, whose normal is tilted by 0.14.
    assert!((0.049..0.05).contains(&bent.distance), "{}", bent.distance);
    assert_eq!(found.words(), "5 polygons of more than three corners, 1 of them not convex and cut truly");
    // Of equals the first is told, of those that cross themselves, too.
    let twice = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 1 0.1\nf 1 2 5 4\nf 1 3 2 4\nf 1 2 5 4\nf 1 3 2 4\n";
    let found = facts("twice.obj", twice);
    let (crossing, bent) = (found.crossing.unwrap(), found.bent.unwrap());
    assert_eq!((crossing.count, crossing.first.to_string()), (2, "polygon 1 (line 7)".into()));
    assert_eq!((bent.count, bent.worst.to_string()), (2, "polygon 0 (line 6)".into()));
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    // Lines without a number are no rows.
    let rows = "0 0 0\n\n1 1 0\n \t\n1 0 0\n0 1 0\n4 0 2 1 3\n4 0 1 2 3\n";
    let found = facts("a.ply", &format!("{header}{rows}"));
    assert_eq!(found.crossing.unwrap().first.to_string(), "polygon 1");
    assert_eq!((found.count, found.cut, found.bent), (2, 0, None));
    assert_eq!(facts("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"), Default::default());
}

#[test]
fn obj_statements_may_go_on_over_lines_and_stand_in_any_order() {
    let file = "f 1 2 \\\n 3 # a square\\\nv 0 0 0 1.0\rv 1 0 0 0.5 0.5 0.5\r\n\tv 1 1 0\n# C:\\rocks\\\nfo -1 -3 -2\n";
    let mesh = parse("a.obj", file.as_bytes()).unwrap();
    assert_eq!(mesh.faces(), [[0, 1, 2], [2, 0, 1]]);
    assert_eq!(mesh.vertices().len(), 3);
}

#[test]
fn rows_of_arrays_are_those_of_their_planes() {
    // Every type and byte order, in C and in Fortran order; two rows of bytes that differ.
    for kind in ["f2", "f4", "f8", "u1", "u2", "u4", "i1", "i2", "i4", "i8"] {
        let size: usize = kind[1..].parse().unwrap();
        for (order, fortran) in [("<", false), (">", false), ("<", true), (">", true)] {
            if size == 1 && order == ">" {
                continue;
            }
            // Small numbers: those of 8 bytes have to fit into planes of 4.
            let number = |index: usize| {
                let mut bytes = vec![0; size];
                (bytes[0], bytes[size.min(2) - 1]) = (17 * index as u8, 3 + 17 * index as u8);
                if order == ">" {
                    bytes.reverse();
                }
                bytes
            };
            let numbers: Vec<u8> = (0..6).flat_map(number).collect();
            let descr = format!("{}{kind}", if size == 1 { "|" } else { order });
            let mut file = String::from_utf8_lossy(&npy(&descr, 2, &[])[10..]).into_owned();
            if fortran {
                file = file.replace("False", "True");
            }
            let length = (file.len() as u16).to_le_bytes();
            let bytes = [b"\x93NUMPY\x01\x00", &length[..], file.as_bytes(), &numbers].concat();
            let array = npy_from_bytes(&bytes, Path::new("a"), &Limits::default()).unwrap();
            let cells: Vec<f64> = (0..6).map(|cell| array.planes[0].real(cell)).collect();
            let rows = npy_numbers_from_bytes(&bytes, Path::new("a")).unwrap().values;
            assert_eq!(rows, cells, "{descr}, {fortran}");
        }
    }
    // Big-endian 0x0102 is 258, and the second number of a column in Fortran order is that of the second row.
    let file = npy(">i2", 2, &[1, 2, 0xff, 0xfe, 0, 3, 0, 4, 0, 5, 0, 6]);
    let rows = |file: &[u8]| npy_numbers_from_bytes(file, Path::new("a")).unwrap().values;
    assert_eq!(rows(&file), [258.0, -2.0, 3.0, 4.0, 5.0, 6.0]);
    let at = file.windows(5).position(|word| word == b"False").unwrap();
    let columns = [&file[..at], b"True ", &file[at + 5..]].concat();
    assert_eq!(rows(&columns), [258.0, 3.0, 5.0, -2.0, 4.0, 6.0]);
}

#[test]
fn polygons_are_counted_as_the_file_has_them() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in [("a.obj", samples::obj()), ("a.ply", samples::text_ply())] {
        let path = folder.path().join(name);
        fs::write(&path, &bytes).unwrap();
        let file = read_triangles(&path).unwrap();
        assert_eq!(file.polygons, Some(vec![0, 0, 1]), "{name}");
        assert_eq!(file.digests, [raypencil_files::sha256(&bytes)]);
    }
}

#[test]
fn a_mesh_may_have_no_faces() {
    let mut stl = vec![0; 84];
    stl[0] = b'x';
    let ply = "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty int z\n\
               element face 0\nproperty list uchar int vertex_index\nend_header\n";
    let gltf = br#"{"asset": {"version": "2.0"}}"#;
    let files: [(&str, &[u8]); 5] = [
        ("a.stl", &stl),
        ("b.stl", b"solid\nendsolid\n"),
        ("a.obj", b""),
        ("a.ply", ply.as_bytes()),
        ("a.gltf", gltf),
    ];
    for (name, bytes) in files {
        let mesh = parse(name, bytes).unwrap();
        assert_eq!((mesh.faces().len(), mesh.vertices().len()), (0, 0), "{name}");
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("vertices.npy"), npy("<f4", 0, &[])).unwrap();
    fs::write(folder.path().join("faces.npy"), npy("<u2", 0, &[])).unwrap();
    assert_eq!(load_triangles(folder.path()).unwrap().faces().len(), 0);
}

#[test]
fn contents_decide_before_the_ending() {
    for name in ["a", "a.bin", "a.obj", "a.stl"] {
        assert_eq!(parse(name, &samples::binary_gltf()).unwrap().faces(), FACES, "{name}");
        assert_eq!(parse(name, &samples::binary_ply(true, false)).unwrap().faces(), FACES, "{name}");
    }
    for bytes in [samples::binary_stl(), samples::text_stl()] {
        assert_eq!(parse("a.3d", &bytes).unwrap().faces(), FACES);
    }
    assert_eq!(parse("a.OBJ", &samples::obj()).unwrap().faces(), FACES);
    for ending in ["stl", "ply", "glb", "gltf"] {
        let expected = "its own format, or the ending .obj";
        let message =
            format!("format: lines of an OBJ file in one that ends in .{ending}; expected {expected}");
        refused(&format!("a.{ending}"), samples::obj(), &message);
    }
    refused(
        "a.stl",
        b"v 0 0 0\n",
        "header: 8 bytes; expected a text that starts with `solid`, or the 84 bytes of a binary header",
    );
    let expected = "GLB, glTF, STL or PLY, or the ending .obj; an elevation model is a GeoTIFF";
    refused("a.3d", b"v 0", &format!("first bytes: [76, 20, 30]; expected {expected}"));
    let expected = "GLB, glTF, STL, OBJ or PLY, to which `assimp export` or Blender converts it";
    refused("a.off", b"OFF\n3 1 0\n", &format!("format: a mesh as .off; expected {expected}"));
    let by_cad = "GLB, glTF, STL, OBJ or PLY, to which a CAD program such as FreeCAD exports it (STL)";
    for ending in ["step", "stp", "iges", "igs"] {
        let message = format!("format: a solid as .{ending}; expected {by_cad}");
        refused(&format!("a.{ending}"), b"ISO-10303-21;\n", &message);
    }
    refused("a.FBX", b"Kaydara FBX Binary", &format!("format: a mesh as .fbx; expected {expected}"));
    let expected = "a mesh, which `raypencil terrain import` makes of an elevation model";
    refused("a.tif", b"II*\0....", &format!("first bytes: a TIFF; expected {expected}"))
}
