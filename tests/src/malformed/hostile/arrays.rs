//! Arrays of rays whose header says something else than what follows, and headers of sparse files that claim more than there is
//! memory for.

use super::Family;
use crate::malformed::case::{Case, Item};
use crate::malformed::npy::array;

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Types of NumPy, in any byte order, and what is none.
const TYPES: [&str; 30] = [
    "<f8", ">f8", "=f8", "|f8", "f8", "<f4", ">f4", "<f2", "<f16", "<i8", "<i4", "<i2", "|i1", "<u8", "<u4",
    "|u1", "|b1", "<c16", "<c8", "|O", "|S8", "<U8", "<M8[ns]", "<m8[s]", "|V8", "", "<f", "<f99", "<f8<f8",
    "f8,f8",
];

/// Shapes, of which one fits a ray of doubles.
const SHAPES: [&str; 20] = [
    "(1, 8)",
    "(8, 1)",
    "(2, 4)",
    "(1, 9)",
    "(1, 6)",
    "(0, 8)",
    "(8, 0)",
    "(1, 1, 1, 8)",
    "(2, 8)",
    "(16, 8)",
    "(4294967297, 8)",
    "(2305843009213693953, 8)",
    "(18446744073709551616, 8)",
    "(1, -8)",
    "(1.0, 8)",
    "(1, 8,,)",
    "[1, 8]",
    "(True, 8)",
    "(0x1, 8)",
    "1, 8",
];

/// Headers with any type and shape before the bytes of one ray.
pub fn ray_arrays() -> Family {
    let row: Vec<u8> = [0.0_f64, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 9.0]
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let mut cases = Vec::new();
    let mut add = |name: String, run: &str, item: Item| {
        let case = Case::new(name, "an array of rays", run, &["rays.npy"]).file("mesh.obj", MESH);
        cases.push(case.item("rays.npy", item));
    };
    for (kind, descr) in TYPES.into_iter().enumerate() {
        for (at, shape) in SHAPES.into_iter().enumerate() {
            let name = format!("array-{kind}-{at}-{}", if is_row(descr, shape) { "good" } else { "other" });
            add(name, "cast mesh.obj rays.npy -o out", Item::File(array(descr, shape, &row)));
        }
    }
    // Files that are as long as they say, and take no place on the disk. Every ray is zero, which has no direction.
    for rays in [1_u64, 1000, 100_000, 400_000, 1_000_000, 10_000_000, 67_000_000, 70_000_000, 10_000_000_000]
    {
        for (descr, bytes) in [("<f8", 8), ("<f4", 4), (">f8", 8)] {
            for (columns, memory) in [(8, "256MB"), (6, "256MB"), (9, "64MB"), (8, "1TB")] {
                // Bounded by what the whole process may take, if a limit above that is asked for.
                let rays = if memory == "1TB" { rays.min(1000) } else { rays };
                let header = array(descr, &format!("({rays}, {columns})"), &[]);
                let length = header.len() as u64 + rays * columns * bytes;
                let name = format!("sparse-{descr}-{rays}-{columns}-{memory}");
                let name = name.replace('<', "little-").replace('>', "big-");
                let run = format!("cast mesh.obj rays.npy --max-memory {memory} -o out");
                add(name, &run, Item::Hole(header, length));
            }
        }
    }
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    cases.dedup_by(|a, b| a.name == b.name);
    Family { is_good: |name| name.ends_with("-good"), ..Family::of(cases) }
}

/// Whether the bytes of a ray are one by this header.
fn is_row(descr: &str, shape: &str) -> bool {
    match shape {
        "(1, 8)" | "(1, 1, 1, 8)" => descr == "<f8",
        // The bytes of one are those of two rays of single numbers, and of whole ones, which have a direction.
        "(2, 8)" => ["<f4", ">f4", "<i4", "<u4"].contains(&descr),
        _ => false,
    }
}
