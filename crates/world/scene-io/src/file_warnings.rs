//! Warnings about the file of a terrain.

use raypencil_mesh_io::{FileFacts, PolygonFacts};
use raypencil_survey::{Warning, polygons_cross, polygons_not_planar, posts_stand_out, posts_too_dense};

/// Warnings about the file of a terrain.
///
/// ```
/// use raypencil_mesh_io::{FileFrame, read_terrain};
/// use raypencil_scene_io::file_warnings;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("hourglass.obj");
/// std::fs::write(&path, "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// let facts = read_terrain(&path, 0.25, &FileFrame::default())?.facts;
/// let warnings = file_warnings(&facts);
/// assert!(warnings[0].to_string().starts_with("1 polygon of the file crosses itself, the first is polygon 0 (line 5)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn file_warnings(facts: &FileFacts) -> Vec<Warning> {
    let spikes =
        facts.dem().and_then(|dem| dem.spikes.as_ref()).map(|spikes| posts_stand_out(&spikes.words()));
    let dense = facts.dem().and_then(|dem| dem.dense_words()).map(|words| posts_too_dense(&words));
    polygon_warnings(&facts.polygons).into_iter().chain(spikes).chain(dense).collect()
}

/// Warnings about the polygons of a mesh file.
fn polygon_warnings(facts: &PolygonFacts) -> Vec<Warning> {
    let crossing = facts.crossing.iter().map(|found| polygons_cross(found.count, &found.first.to_string()));
    let bent = facts
        .bent
        .iter()
        .map(|found| polygons_not_planar(found.count, &found.worst.to_string(), found.distance));
    crossing.chain(bent).collect()
}
