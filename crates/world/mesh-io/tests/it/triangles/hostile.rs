//! Malformed files, each with its message.

use std::fs;

use raypencil_mesh_io::load_triangles;

use super::samples::{self, npy, npy_faces, npy_vertices, ply_header};
use super::*;

#[test]
fn stl_that_claims_too_much_or_is_cut() {
    let mut file = vec![b'x'; 100];
    file[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    refused(
        "a.stl",
        &file,
        "byte 80: 4294967295 faces in a file of 100 bytes; expected a file of 214748364834 bytes (is it cut off?)",
    );
    let whole = samples::binary_stl();
    // The header starts with `solid`, but the zeros are binary.
    refused(
        "a.stl",
        &whole[..200],
        "byte 80: 3 faces in a file of 200 bytes; expected a file of 234 bytes (is it cut off?)",
    );
    // Of a binary file without faces all bytes behind the header's text are 0.
    let mut empty = b"solid looks like text".to_vec();
    empty.resize(80, b' ');
    empty.resize(84, 0);
    assert_eq!(parse("a.stl", &empty).unwrap().faces().len(), 0);
    refused(
        "a.stl",
        b"PK",
        "header: 2 bytes; expected a text that starts with `solid`, or the 84 bytes of a binary header",
    );
    let mut infinite = whole;
    infinite[84 + 50 + 12 + 8..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    refused("a.stl", &infinite, "byte 154, face 1: inf; expected a finite number within 1e30");
}

#[test]
fn wrong_words_of_stl() {
    let facet = |change: (&str, &str)| {
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid"
            .replacen(change.0, change.1, 1)
    };
    assert_eq!(parse("a.stl", facet(("", "")).as_bytes()).unwrap().faces().len(), 1);
    for (change, message) in [
        (("endloop", "vertex 5 5 5"), "line 7: \"vertex\"; expected `endloop`"),
        (("1 0 0", "1 zero 0"), "line 5, face 0: \"zero\"; expected a decimal number"),
        (("1 0 0", "1 nan 0"), "line 5, face 0: NaN; expected a finite number within 1e30"),
        (("1 0 0", "1e31 0 0"), "line 5, face 0: 1e31; expected a finite number within 1e30"),
        (("1 0 0", "1 0"), "line 6, face 0: \"vertex\"; expected a decimal number"),
        (("\nendsolid", ""), "line 8: the end of the file; expected `facet` or `endsolid`"),
        (("facet", "face"), "line 2: \"face\"; expected `facet` or `endsolid`"),
    ] {
        refused("a.stl", facet(change), message);
    }
    refused("a.stl", "solid\nendsolid\nsolids", "line 3: \"solids\"; expected `solid`");
}

#[test]
fn wrong_statements_of_obj() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (statement, message) in [
        ("f 1 2 4", "line 4: vertex 4; expected 1 to 3, the vertices of the file"),
        ("f 1 2 4294967297", "line 4: vertex 4294967297; expected vertices count from 1, backwards from -1"),
        ("f 1 2 0", "line 4: vertex 0; expected vertices count from 1, backwards from -1"),
        ("f 1 2 -4", "line 4: vertex -4; expected -3 to -1, the vertices so far"),
        (
            "f 1 2 -9223372036854775808",
            "line 4: vertex -9223372036854775808; expected -3 to -1, the vertices so far",
        ),
        ("f 1 2", "line 4, polygon 0: 2 corners; expected 3 or more"),
        ("f 1 2 3/x", "line 4: \"3/x\"; expected a corner: v, v/vt, v//vn or v/vt/vn"),
        ("f 1 2 3/1/1/1", "line 4: \"3/1/1/1\"; expected a corner: v, v/vt, v//vn or v/vt/vn"),
        ("v 1 2", "line 4, z of vertex 4: nothing; expected a decimal number"),
        ("v 1 0x2 3", "line 4, y of vertex 4: \"0x2\"; expected a decimal number"),
        ("v 1 2 inf", "line 4, z of vertex 4: inf; expected a finite number within 1e30"),
        ("<html>", "line 4: \"<html>\"; expected a statement that starts with a letter, like `v 0 0 0`"),
        ("o a\0b", "byte 27: a byte 0; expected a text"),
    ] {
        refused("a.obj", format!("{vertices}{statement}\n"), message);
    }
    let long = format!("v {} 0 0", "9".repeat(100_000));
    assert!(parse("a.obj", long.as_bytes()).unwrap_err().len() < 1000);
}

#[test]
fn headers_of_ply() {
    let header = ply_header("ascii", "float", "uchar", "int");
    for (change, message) in [
        (("ply\n", "ply 2\n"), "line 1: \"ply 2\"; expected `ply`"),
        (
            ("ascii 1.0", "ascii 2.0"),
            "line 2: \"format ascii 2.0\"; expected once `format` with ascii, binary_little_endian or \
             binary_big_endian, and 1.0",
        ),
        (("format ascii 1.0\n", ""), "header: no `format`; expected a line with the format"),
        (("element face", "element vertex"), "line 9: \"element vertex 2\"; expected each element once"),
        (
            ("element face 2", "element face -2"),
            "line 9: \"element face -2\"; expected `element`, a name and a number of rows",
        ),
        (
            ("property float z", "property half z"),
            "line 8: \"property half z\"; expected `property`, a type and a name, or `property list`, two types and a \
             name",
        ),
        (
            ("list uchar int", "list float int"),
            "line 10: \"property list float int vertex_indices\"; expected `property`, a type and a name, or \
             `property list`, two types and a name",
        ),
        (("float z", "float x"), "line 8: \"property float x\"; expected each property of an element once"),
        (
            ("element vertex 5\n", ""),
            "line 4: \"property float x\"; expected an `element` before its properties",
        ),
        (
            ("comment", "remark"),
            "line 3: \"remark of any kind\"; expected format, comment, obj_info, element, property or end_header",
        ),
    ] {
        refused("a.ply", header.replacen(change.0, change.1, 1), message);
    }
    let end = header.find("end_header").unwrap();
    refused(
        "a.ply",
        &header[..end + 4],
        "line 14: 4 bytes without the end of a line; expected `end_header` (is the file cut off?)",
    );
}

#[test]
fn headers_of_ply_have_limits() {
    // Each name is compared with all before it: a hundred thousand of them would take minutes.
    let header = ply_header("ascii", "float", "uchar", "int");
    let elements = |count: usize| (0..count).map(|k| format!("element e{k} 0\n")).collect::<String>();
    let with = |elements: &str| header.replacen("element vertex", &format!("{elements}element vertex"), 1);
    refused("a.ply", with(&elements(100_000)), "line 260: more than 256 elements; expected at most 256");
    let properties: String = (0..100_000).map(|k| format!("property float p{k}\n")).collect();
    let many = header.replacen("property float x", &format!("{properties}property float x"), 1);
    refused("a.ply", many, "line 1029: more than 1024 properties; expected at most 1024");
    // The limits themselves are read: here three elements are in the file already.
    let rows = String::from_utf8(samples::text_ply()).unwrap();
    let most = rows.replacen("element vertex", &format!("{}element vertex", elements(253)), 1);
    assert_eq!(parse("a.ply", most.as_bytes()).unwrap().vertices().len(), 5);
}

#[test]
fn a_statement_of_obj_may_go_on_over_any_number_of_lines() {
    // Time grows with the length: for its square, this file would take an hour.
    let joins = "\\\n".repeat(1 << 20);
    let mesh = parse("a.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {joins} 3\n").as_bytes()).unwrap();
    assert_eq!(mesh.faces(), [[0, 1, 2]]);
}

#[test]
fn counts_of_ply_are_held_against_the_length() {
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for (from, count) in [("vertex 5", u64::MAX), ("face 2", 1 << 32), ("edge 1", 1 << 40)] {
            let name = from.split(' ').next().unwrap();
            let header =
                ply_header(format, "float", "uchar", "int").replace(from, &format!("{name} {count}"));
            let message = parse("a.ply", header.as_bytes()).unwrap_err();
            assert!(message.starts_with("element `vertex`: ") || name != "vertex", "{message}");
            assert!(message.ends_with("expected as many rows as the file has (is it cut off?)"), "{message}");
        }
        // Rows of nothing would take any time.
        let nothing = format!("ply\nformat {format} 1.0\nelement a 18446744073709551615\nend_header\n");
        refused(
            "a.ply",
            nothing,
            "element `a`: 18446744073709551615 rows without properties; expected a property",
        );
    }
}

#[test]
fn wrong_rows_of_ply() {
    let text = String::from_utf8(samples::text_ply()).unwrap();
    for (change, message) in [
        (("3 3 2 4", "3 3 2 5"), "line 21, polygon 1: vertex 5; expected an index below 5"),
        (("3 3 2 4", "3 3 -1 4"), "line 21, polygon 1: vertex -1; expected an index below 5"),
        (("3 3 2 4 2", "2 3 2 2"), "line 21, polygon 1: 2 corners; expected 3 or more"),
        (("3 3 2 4", "255 3 2 4"), "line 21: \"0.5\"; expected a whole number"),
        (
            ("3 3 2 4", "4294967295 3 2 4"),
            "line 21: \"4294967295\"; expected a whole number that its type holds (uchar)",
        ),
        (("0.5 0.5", "0.5"), "line 21: 1 numbers to the end of the line; expected 2 numbers"),
        (("4 2 0.5", "4 -2 0.5"), "line 21: \"-2\"; expected a whole number that its type holds (uchar)"),
        (("17", "17 18"), "line 22: \"18\"; expected the end of the line"),
        (("17\n", "17\n18\n"), "line 23: a line after the last row; expected the end of the file"),
        (("17", ""), "line 22: the end of the file; expected more lines of numbers"),
        (("5e-1 255", "inf 255"), "line 15, vertex 0: inf; expected a finite number within 1e30"),
        (
            ("property float z", "property float w"),
            "element `vertex`: no x, y or z; expected x, y and z, each a single number",
        ),
        (
            ("vertex_indices", "corners"),
            "element `face`: 0 lists of vertices; expected one list of integers `vertex_indices` or `vertex_index`",
        ),
        (
            ("int vertex_indices", "float vertex_indices"),
            "element `face`: 0 lists of vertices; expected one list of integers `vertex_indices` or `vertex_index`",
        ),
        (
            ("element vertex", "element point"),
            "header: no element `vertex`; expected an element `vertex` with x, y and z",
        ),
        (
            ("element face", "element tristrips"),
            "header: element `tristrips`; expected an element `face`: strips are not supported",
        ),
    ] {
        assert!(text.contains(change.0), "{change:?}");
        refused("a.ply", text.replacen(change.0, change.1, 1), message);
    }
    // A length of a type with a sign.
    let signed = text.replacen("list uchar float", "list char float", 1);
    refused(
        "a.ply",
        signed.replacen("4 2 0.5", "4 -2 0.5", 1),
        "line 21: a list of -2 numbers; expected 0 numbers or more",
    );
    // Beside faces strips would be a part of the mesh that nobody sees; without rows they are nothing.
    let strips = |count: u32| {
        let element = format!("element tristrips {count}\nproperty list int int vertex_indices\nend_header");
        text.replacen("end_header", &element, 1) + ["", "3 0 1 2\n"][count as usize]
    };
    refused(
        "a.ply",
        strips(1),
        "header: element `tristrips`; expected an element `face`: strips are not supported",
    );
    assert_eq!(parse("a.ply", strips(0).as_bytes()).unwrap(), parse("a.ply", text.as_bytes()).unwrap());
    let binary = samples::binary_ply(false, false);
    let start = ply_header("binary_little_endian", "float32", "uint16", "uint").len();
    // Five vertices of 13 bytes, then the length of the first polygon and its corners.
    let corner = start + 65 + 2 + 4;
    let mut wrong = binary.clone();
    wrong[corner] = 9;
    refused("a.ply", &wrong, &format!("byte {corner}, polygon 0: vertex 9; expected an index below 5"));
    let mut long = binary.clone();
    long[start + 65..][..2].copy_from_slice(&[255, 255]);
    let message = parse("a.ply", &long).unwrap_err();
    assert!(message.contains("polygon 0: vertex"), "{message}");
    let surplus = [&binary[..], b"\n"].concat();
    let end = binary.len();
    refused(
        "a.ply",
        &surplus,
        &format!("byte {end}: 1 bytes after the last row; expected the end of the file"),
    );
    refused(
        "a.ply",
        &binary[..end - 1],
        &format!("byte {}: 3 bytes left; expected a number of 4 bytes", end - 4)
            .replace("a number of 4 bytes", "1 numbers of 4 bytes"),
    );
}

#[test]
fn pairs_of_arrays() {
    let folder = tempfile::tempdir().unwrap();
    let [vertices, faces] = ["vertices.npy", "faces.npy"].map(|name| folder.path().join(name));
    let refused = |wrong: [&[u8]; 2], message: &str| {
        fs::write(&vertices, wrong[0]).unwrap();
        fs::write(&faces, wrong[1]).unwrap();
        let error = load_triangles(folder.path()).unwrap_err().to_string();
        assert_eq!(error, folder.path().join(message).display().to_string());
    };
    let (v, f) = (npy_vertices(), npy_faces());
    refused(
        [&npy("<f8", 1 << 62, &[0; 24]), &f],
        "vertices.npy: numbers: 24 bytes; expected more bytes than any file has, of shape [4611686018427387904, \
         3]",
    );
    refused(
        [&v[..v.len() - 1], &f],
        "vertices.npy: numbers: 119 bytes; expected the 120 bytes of shape [5, 3] (is the file cut off?)",
    );
    refused([&f, &f], "vertices.npy: descr: integers; expected vertices of type f2, f4 or f8");
    refused([&v, &v], "faces.npy: descr: real numbers; expected faces of an integer type");
    refused(
        [&v, &npy("|i1", 1, &[0, 1, 255])],
        "faces.npy: row 0, column 2: vertex -1; expected an index below 5",
    );
    refused(
        [&v, &npy("|u1", 1, &[0, 5, 1])],
        "faces.npy: row 0, column 1: vertex 5; expected an index below 5",
    );
    refused(
        [&v, &npy("<u8", 1, &[255; 24])],
        "faces.npy: number 0: 18446744073709551615; expected a whole number up to 2^53",
    );
    let flat = [&npy("<f4", 3, &[])[..]].concat();
    let flat = String::from_utf8_lossy(&flat[10..]).replace("(3, 3)", "(9, 1)");
    let mut wide = b"\x93NUMPY\x01\x00".to_vec();
    wide.extend((flat.len() as u16).to_le_bytes());
    wide.extend(flat.bytes().chain([0; 36]));
    refused([&wide, &f], "vertices.npy: shape: [9, 1]; expected (rows, 3)");
    let mut infinite = v.clone();
    let last = infinite.len() - 8;
    infinite[last..].copy_from_slice(&f64::NEG_INFINITY.to_le_bytes());
    refused([&infinite, &f], "vertices.npy: row 4, column 2: -inf; expected a finite number within 1e30");

    fs::remove_file(&faces).unwrap();
    let error = load_triangles(&vertices).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}: cannot read: ", faces.display())), "{error}");
    let error = load_triangles(&folder.path().join("nothing")).unwrap_err().to_string();
    assert!(
        error.starts_with(&format!("{}: cannot read: ", folder.path().join("nothing").display())),
        "{error}"
    );
    let single = folder.path().join("array.npy");
    fs::write(&single, &v).unwrap();
    let error = load_triangles(&single).unwrap_err().to_string();
    assert!(error.ends_with(
        "first bytes: a single NPY file; expected two files whose names end with vertices.npy and faces.npy"
    ));
}

#[test]
fn a_file_without_faces_says_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let holds = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let error = raypencil_mesh_io::read_triangles(&path).unwrap().require_faces(&path).unwrap_err();
        error.to_string().split(": ").skip(1).collect::<Vec<_>>().join(": ")
    };
    let expected = "; expected at least one face";
    assert_eq!(
        holds("words.obj", "garbage in\ngarbage out\nmore\n"),
        format!("file: no vertex and no face; its lines begin with \"garbage\", \"more\"{expected}")
    );
    assert_eq!(holds("points.obj", "v 0 0 0\nv 1 0 0\n"), format!("file: 2 vertices and no face{expected}"));
    assert_eq!(holds("none.stl", "solid\nendsolid\n"), format!("file: no vertex and no face{expected}"));
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement edge 0\n\
               property int a\nend_header\n0 0 0\n";
    assert_eq!(
        holds("edges.ply", ply),
        format!("file: 1 vertex and no face; it has 1 of element `vertex`, 0 of element `edge`{expected}")
    );
    // An element without a row needs no property.
    let none = ply.replace("element edge 0\nproperty int a", "element face 0");
    assert!(
        holds("none.ply", &none).starts_with("file: 1 vertex and no face; "),
        "{}",
        holds("none.ply", &none)
    );
}

#[test]
fn rows_of_text_have_a_digit_and_a_blank_for_each_number() {
    let ply = |rows: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\nelement face 1\n\
                 property list int int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n{rows}"
        )
    };
    assert_eq!(parse("a.ply", ply("3 0 1 2").as_bytes()).unwrap().faces(), [[0, 1, 2]]);
    let short = ply("").replace("1 0 0\n0 1 0\n", "");
    refused(
        "a.ply",
        short,
        "element `vertex`: 3 rows of 6 bytes or more, with 7 bytes left; expected as many rows as the file has (is it cut off?)",
    );
}
