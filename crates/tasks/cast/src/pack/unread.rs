//! Files of a candidate's folder that no name of an array fits.

use std::path::Path;

/// Names of arrays that are read.
const KNOWN: [&str; 9] =
    ["face", "t", "range", "hit", "side", "point", "normal", "barycentric", "cos_incidence"];

/// Names that people give to them.
const OTHER_NAMES: [(&str, &[&str]); 8] = [
    (
        "face",
        &["faces", "face_id", "face_index", "primid", "prim_id", "primitive_ids", "tri", "triangle", "index"],
    ),
    ("t", &["t_hit", "thit", "tfar", "distance", "dist", "depth"]),
    ("range", &["ranges", "r"]),
    ("hit", &["is_hit", "hit_mask", "any", "any_hit", "occluded"]),
    ("point", &["hit_point", "position", "location", "locations", "xyz"]),
    ("normal", &["ng", "primitive_normals"]),
    ("barycentric", &["uv", "uvw", "bary", "weights", "primitive_uvs"]),
    ("cos_incidence", &["cos", "cosine", "cos_theta", "incidence"]),
];

/// Files that mark a folder whose other arrays are those of this program.
const OWN: [&str; 2] = [super::PACK_NAME, "summary.json"];

/// The arrays of a folder that are not read, in words, each with the name that it may be meant to have.
pub(super) fn unread(folder: &Path) -> Vec<String> {
    if OWN.iter().any(|name| folder.join(name).is_file()) {
        return Vec::new();
    }
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(|name| is_unread(name)).collect();
    names.sort();
    names
        .into_iter()
        .map(|name| meant(&name).map_or(name.clone(), |known| format!("{name} (meant as {known}.npy?)")))
        .collect()
}

fn is_unread(name: &str) -> bool {
    let lower = name.to_lowercase();
    let is_array = lower.ends_with(".npy") || lower.ends_with(".npz");
    is_array && !KNOWN.iter().any(|known| name.strip_suffix(".npy") == Some(known))
}

/// The name of an array that a file may be meant to have: that of the same letters, of the fewest other ones, or the one that people call so.
fn meant(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    let stem = lower.rsplit_once('.').map_or(lower.as_str(), |(stem, _)| stem);
    let other = OTHER_NAMES.iter().find(|(_, others)| others.contains(&stem)).map(|(known, _)| *known);
    let near = || {
        let all = KNOWN.into_iter().map(|known| (changes(stem, known), known));
        // One change in three letters.
        all.filter(|(changes, known)| changes * 3 <= known.len()).min().map(|(_, known)| known)
    };
    other.or_else(near)
}

/// How many letters are to be put in, left out or changed. (Levenshtein)
fn changes(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (i, a) in one.chars().enumerate() {
        let mut before = row[0];
        row[0] = i + 1;
        for (j, b) in other.iter().enumerate() {
            let changed = before + usize::from(a != *b);
            before = row[j + 1];
            row[j + 1] = changed.min(before + 1).min(row[j] + 1);
        }
    }
    row[other.len()]
}
