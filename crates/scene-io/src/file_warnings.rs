//! Warnings about the files of a terrain.

use raypencil_mesh_io::PolygonFacts;
use raypencil_survey::{Warning, polygons_cross, polygons_not_planar};

/// Warnings about the polygons of a mesh file.
///
/// ```
/// use raypencil_mesh_io::read_triangles;
/// use raypencil_scene_io::polygon_warnings;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("hourglass.obj");
/// std::fs::write(&path, "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// let warnings = polygon_warnings(&read_triangles(&path)?.polygon_facts);
/// assert!(warnings[0].to_string().starts_with("1 polygon of the file crosses itself, the first is polygon 0 (line 5)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn polygon_warnings(facts: &PolygonFacts) -> Vec<Warning> {
    let crossing = facts.crossing.iter().map(|found| polygons_cross(found.count, &found.first.to_string()));
    let bent = facts
        .bent
        .iter()
        .map(|found| polygons_not_planar(found.count, &found.worst.to_string(), found.distance));
    crossing.chain(bent).collect()
}
