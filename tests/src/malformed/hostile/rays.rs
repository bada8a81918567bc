//! Hostile rays: CSV, NPY, and sets of rays in TOML.

use super::Family;
use super::edits::{
    NUMBERS, cut_anywhere, half_of, hostile_toml, replaced, with_each_byte, with_each_word, word_of,
};
use crate::malformed::case::Case;
use crate::malformed::npy::array;

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const CSV: &str = "ox,oy,oz,dx,dy,dz,t_min,t_max\n0,0,1,0,0,-1,0,9\n1,0,1,0,0,-1,0,9\n";

/// Tables of a set of rays, each with values to replace.
const SETS: [&str; 5] = [
    "grid = { columns = @2, rows = @2, width_deg = @9, height_deg = @9, min_range_m = @0, max_range_m = @9 }
",
    "spinning = { elevations_deg = [@0, @1], steps = @4, rate_hz = @10, azimuth_start_deg = @0 }
start_s = @0
",
    "spinning = { preset = @\"vlp-16\", steps = @4 }
position_m = [@0, @0, @1]
yaw_left_deg = @0
sides = @\"fronts\"
",
    "cone = { of = { grid = { columns = 2, rows = 2, width_deg = 9, height_deg = 9 } }, divergence_mrad = @1, rings = @2, returns = { keep = @2, separation_m = @1 } }
",
    "spinning = { preset = \"vlp-16\", steps = 4 }
poses = [{ time_s = @0, yaw_left_deg = @0 }, { time_s = @5 }]
",
];

/// Numbers of eight bytes that no ray has.
const WRONG: [(&str, f64); 5] = [
    ("nan", f64::NAN),
    ("inf", f64::INFINITY),
    ("minus-inf", f64::NEG_INFINITY),
    ("far", f64::MAX),
    ("tiny", 5e-324),
];

/// Hostile rays.
pub fn rays() -> Family {
    let mut cases = Vec::new();
    let mut add = |name: String, file: &str, bytes: Vec<u8>| {
        // Without optimisation the pictures of a set take longer than the limit.
        let out = if file.ends_with("toml") { "" } else { " -o out" };
        let run = format!("cast mesh.obj {file}{out}");
        cases.push(Case::of_file(&name, "changed rays", &run, file, bytes, "").file("mesh.obj", MESH));
    };
    for (name, text) in with_each_word(CSV, ",\n", &[]) {
        add(format!("csv-{name}"), "rays.csv", text.into_bytes());
    }
    for (name, bytes) in cut_anywhere(CSV.as_bytes()) {
        add(format!("csv-{name}"), "rays.csv", bytes);
    }
    let row = [0.0_f64, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 9.0];
    let bytes = |row: &[f64; 8]| row.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    add("npy-unchanged".into(), "rays.npy", array("<f8", "(1, 8)", &bytes(&row)));
    for (name, bytes) in cut_anywhere(&array("<f8", "(1, 8)", &bytes(&row))) {
        add(format!("npy-{name}"), "rays.npy", bytes);
    }
    for (name, number) in WRONG {
        for at in 0..8 {
            let mut row = row;
            row[at] = number;
            add(format!("npy-number-{at}-{name}"), "rays.npy", array("<f8", "(1, 8)", &bytes(&row)));
        }
    }
    let shapes = [
        "(0, 8)",
        "(1, 7)",
        "(8,)",
        "()",
        "(1, 4611686018427387904)",
        "(18446744073709551615, 8)",
        "(4294967296, 4294967296, 8)",
        "(-1, 8)",
        "(1, 8",
        "(nan, 8)",
        "(1, 8, 1)",
        "((1, 8),)",
    ];
    for (at, shape) in shapes.into_iter().enumerate() {
        add(format!("npy-shape-{at}"), "rays.npy", array("<f8", shape, &bytes(&row)));
    }
    for (set, table) in SETS.iter().enumerate() {
        let text = format!("[[rays]]\nname = \"a\"\n{table}");
        for at in 0..text.matches('@').count() {
            // This value is replaced; the marks of all others go.
            let (mark, _) = text.match_indices('@').nth(at).expect("a mark");
            let end = mark + text[mark..].find([',', ']', ' ', '\n']).expect("an end");
            for (name, word) in half_of(&hostile_toml(), at) {
                let text = replaced(&text, mark..end, word).replace('@', "");
                add(format!("set-{set}-value-{at}-{name}"), "rays.toml", text.into_bytes());
            }
        }
        let plain = text.replace('@', "");
        add(format!("set-{set}-unchanged"), "rays.toml", plain.clone().into_bytes());
        for (name, bytes) in cut_anywhere(plain.as_bytes()).into_iter().step_by(4) {
            add(format!("set-{set}-{name}"), "rays.toml", bytes);
        }
        add(
            format!("set-{set}-twice"),
            "rays.toml",
            format!("{plain}{}", table.replace('@', "")).into_bytes(),
        );
    }
    Family { is_good, ..Family::of(cases) }
}

/// Each set with each byte changed. Which of them are good depends on the ranges of its numbers: a pattern of other numbers is one.
pub fn patterns() -> Family {
    let mut cases = Vec::new();
    for (set, table) in SETS.iter().enumerate() {
        let text = format!("[[rays]]\nname = \"a\"\n{table}").replace('@', "");
        for (name, bytes) in with_each_byte(text.as_bytes()) {
            let run = "cast mesh.obj rays.toml";
            let name = format!("pattern-{set}-{name}");
            let case = Case::of_file(&name, "a changed byte", run, "rays.toml", bytes, "");
            cases.push(case.file("mesh.obj", MESH));
        }
    }
    Family { is_good: |name| name.ends_with("unchanged"), open: &[0, 1], ..Family::of(cases) }
}

/// Sets whose other value is in its range, or which are whole where they are cut.
const GOOD_SETS: [&str; 25] = [
    "set-0-value-2-half",
    "set-0-value-3-tiny",
    "set-0-value-4-half",
    "set-0-value-5-tiny",
    "set-1-value-0-half",
    "set-1-value-1-minus-one",
    "set-1-value-1-none",
    "set-1-value-1-tiny",
    "set-1-value-4-half",
    "set-1-value-5-minus-one",
    "set-1-value-5-tiny",
    "set-2-cut-at-64",
    "set-2-cut-at-104",
    "set-2-cut-at-120",
    "set-2-value-2-half",
    "set-2-value-3-minus-one",
    "set-2-value-3-tiny",
    "set-2-value-4-half",
    "set-2-value-5-minus-one",
    "set-2-value-5-tiny",
    "set-3-value-0-half",
    "set-4-cut-at-64",
    "set-4-value-1-minus-one",
    "set-4-value-1-tiny",
    "set-4-value-2-half",
];

fn is_good(name: &str) -> bool {
    if let (true, Some((at, what))) = (name.starts_with("csv"), word_of(name)) {
        return match at.checked_sub(8).map(|at| at % 8) {
            // A heading has names that are known.
            None => false,
            Some(0..6) => NUMBERS.contains(&what),
            // From t_min = 0 on, up to t_max, which may be infinite.
            Some(6) => what == "half",
            Some(_) => ["half", "two-to-63", "two-to-64", "overflow", "long"].contains(&what),
        };
    }
    // A CSV of one row; a ray without a dimension; the smallest number of all is one, though no direction has that length.
    ["csv-cut-at-46", "npy-shape-2", "npy-number-7-inf"].contains(&name)
        || name.starts_with("npy-number") && name.ends_with("tiny") && name != "npy-number-5-tiny"
        || name.ends_with("unchanged")
        || GOOD_SETS.contains(&name)
}
