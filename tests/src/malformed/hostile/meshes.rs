//! Hostile STL, OBJ and PLY files, for rays.

use super::Family;
use super::edits::{NUMBERS, cut_anywhere, with_each_word, word_of};
use crate::malformed::case::Case;

/// A triangle in each format that is a text.
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
    endloop\nendfacet\nendsolid a\n";
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// Hostile meshes.
pub fn meshes() -> Family {
    let mut cases = Vec::new();
    let mut add = |format: &str, ending: &str, changed: Vec<(String, Vec<u8>)>| {
        for (name, bytes) in changed {
            let file = format!("mesh.{ending}");
            let run = format!("cast {file} rays.csv -o out");
            cases.push(
                Case::of_file(&format!("{format}-{name}"), "a changed mesh", &run, &file, bytes, "")
                    .file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,1,0,0,-1\n"),
            );
        }
    };
    for (ending, text) in [("stl", STL), ("obj", OBJ), ("ply", PLY)] {
        // There are three vertices, numbered from 0 or from 1.
        let words = with_each_word(text, " \n", &[("four", "4")])
            .into_iter()
            .map(|(name, text)| (name, text.into_bytes()));
        add(ending, ending, words.collect());
        add(ending, ending, cut_anywhere(text.as_bytes()));
    }
    add("binary-stl", "stl", vec![("unchanged".into(), binary_stl())]);
    add("binary-stl", "stl", cut_anywhere(&binary_stl()));
    for (name, is_big) in [("little-ply", false), ("big-ply", true)] {
        add(name, "ply", vec![("unchanged".into(), binary_ply(is_big))]);
        add(name, "ply", cut_anywhere(&binary_ply(is_big)));
    }
    Family { is_good, ..Family::of(cases) }
}

/// The triangle as a binary STL.
pub(crate) fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(1_u32.to_le_bytes());
    let numbers = [[0.0_f32, 0.0, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    bytes.extend(numbers.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
    bytes.extend([0; 2]);
    bytes
}

/// The triangle as a binary PLY.
pub(crate) fn binary_ply(is_big: bool) -> Vec<u8> {
    let format = if is_big { "binary_big_endian" } else { "binary_little_endian" };
    let header = &PLY[..PLY.find("end_header").expect("its end")];
    let mut bytes = format!("{}end_header\n", header.replace("ascii", format)).into_bytes();
    let numbers = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for number in numbers.as_flattened() {
        bytes.extend(if is_big { number.to_be_bytes() } else { number.to_le_bytes() });
    }
    bytes.push(3);
    for index in [0_i32, 1, 2] {
        bytes.extend(if is_big { index.to_be_bytes() } else { index.to_le_bytes() });
    }
    bytes
}

/// The good files of each format, as seeds of a fuzz target.
pub(crate) fn good() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("stl", STL.into()),
        ("obj", OBJ.into()),
        ("ply", PLY.into()),
        ("stl", binary_stl()),
        ("ply", binary_ply(false)),
        ("ply", binary_ply(true)),
    ]
}

/// Texts that are whole where they are cut. A part of an OBJ is a smaller mesh, and one without its face is none to cast rays on.
const WHOLE: [&str; 2] = ["stl-cut-at-102", "stl-cut-at-104"];

fn is_good(name: &str) -> bool {
    let Some((at, what)) = word_of(name) else {
        return name.ends_with("unchanged") || WHOLE.contains(&name);
    };
    match (&name[..3], at) {
        // The name of a solid is any text or none.
        ("stl", 1 | 24) => what != "byte-0",
        // Normals follow from the corners, and are not read.
        ("stl", 4..=6) => what != "byte-0" && what != "none",
        ("stl", 10..=12 | 14..=16 | 18..=20) => NUMBERS.contains(&what),
        ("obj", 1..=3 | 5..=7 | 9..=11) => NUMBERS.contains(&what),
        // The last vertex is number -1.
        ("obj", 13..=15) => what == "minus-one",
        // The property `x` stays one.
        ("ply", 9) => what == "word",
        ("ply", 25..=33) => NUMBERS.contains(&what),
        _ => false,
    }
}
