//! Malformed meshes: STL, OBJ and PLY, as terrain and for rays.

mod obj;
mod ply;
mod stl;

use super::case::Case;

/// What a coordinate may not be, in words and as the formats with decimals write it.
const WRONG_NUMBERS: [(&str, &str, &str); 11] = [
    ("nan", "a coordinate that is not a number", "NaN"),
    ("minus-nan", "a coordinate that is not a number, with a sign", "-nan"),
    ("inf", "an infinite coordinate", "inf"),
    ("minus-inf", "a coordinate of minus infinity", "-Infinity"),
    ("overflow", "a coordinate beyond double precision", "1e400"),
    ("far", "a coordinate of 1e31", "1e31"),
    ("hexadecimal", "a hexadecimal coordinate", "0x10"),
    ("comma", "a coordinate with a decimal comma", "1,5"),
    ("underscore", "a coordinate with an underscore", "1_000"),
    ("text", "a word in place of a coordinate", "north"),
    ("control", "a coordinate with the code that clears a terminal", "\u{1b}[2J"),
];

/// Every malformed mesh.
pub(super) fn cases() -> Vec<Case> {
    [stl::cases(), obj::cases(), ply::cases(), for_rays()].concat()
}

/// A malformed mesh as terrain.
fn terrain(ending: &str, name: &str, what: &'static str, place: &str, bytes: impl Into<Vec<u8>>) -> Case {
    let file = format!("ground.{ending}");
    let run = format!("validate {file} -o out");
    Case::of_file(&format!("{ending}-{name}"), what, &run, &file, bytes.into(), place)
}

/// Malformed meshes for rays that belong to no sensor.
fn for_rays() -> Vec<Case> {
    let case = |ending: &str, what, place: &str, bytes: &[u8]| {
        let file = format!("mesh.{ending}");
        let run = format!("cast {file} rays.csv -o out");
        Case::of_file(&format!("cast-{ending}"), what, &run, &file, bytes.to_vec(), place)
            .file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,1,0,0,-1\n")
    };
    vec![
        case("stl", "a binary STL that is cut off, for rays", "byte 80", &stl::good()[..100]),
        case(
            "obj",
            "an OBJ with a vertex too few, for rays",
            "line 4",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
        ),
        case(
            "ply",
            "a PLY with an endless element, for rays",
            "element `vertex`",
            &ply::with(&[("element vertex 3", "element vertex 18446744073709551615")]),
        ),
    ]
}
