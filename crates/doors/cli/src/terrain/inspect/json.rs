//! The report for programs.

use raypencil::io::FileUnits;
use raypencil::terrain::{Inspection, MeshElement, Occurrence, Occurrences, OpenEdgePiece};
use serde_json::{Value, json};

use super::report::Report;

pub(super) fn report_json(report: &Report) -> String {
    let mut printed = inspection(&report.found);
    printed["mesh"] = report.mesh.into();
    printed["passes"] = report.passes().into();
    printed["kinds_wrong"] = report.fault_kinds().into();
    printed["polygons"] = json!(report.facts.polygons);
    printed["file"] = json!(report.facts.units.as_ref().map(FileUnits::to_json));
    if let Some(repaired) = &report.repaired {
        let repairs = &repaired.repairs;
        printed["repaired"] = json!({
            "file": repaired.file.display().to_string(),
            "zero_area_faces": repairs.zero_area_faces,
            "duplicate_faces": repairs.duplicate_faces,
            "duplicates_of_other_material": repairs.duplicate_faces_of_other_material,
            "turned_faces": repairs.turned_faces,
            "welded_vertices": repairs.welded_vertices,
            "unused_vertices": repairs.unused_vertices,
            "left": inspection(&repaired.left),
        });
    }
    format!("{printed:#}\n")
}

fn inspection(found: &Inspection) -> Value {
    let kinds = &found.zero_area_kinds;
    let open = &found.open_edges;
    json!({
        "passes": found.passes(),
        "kinds_wrong": found.fault_kinds(),
        "faces": found.faces,
        "vertices": found.vertices,
        "bounds_m": found.bounds.map(|corners| corners.map(|corner| corner.to_array())),
        "area_m2": found.area,
        "volume_m3": found.volume,
        "components": found.components,
        "closed_components": found.closed_components,
        "unused_vertices": occurrences(&found.unused_vertices),
        "split_vertices": occurrences(&found.split_vertices),
        "zero_area": occurrences(&found.zero_area),
        "zero_area_kinds": {
            "repeated_vertex": kinds.repeated_vertex,
            "coincident_vertices": kinds.coincident_vertices,
            "collinear": kinds.collinear,
        },
        "duplicates": occurrences(&found.duplicates),
        "duplicates_of_other_material": found.duplicate_faces_of_other_material,
        "double_sided": occurrences(&found.double_sided_sheets),
        "slender": occurrences(&found.slender),
        "worst_aspect": found.worst_aspect,
        "down": occurrences(&found.down),
        "down_area_m2": found.downward_area,
        "upside_down": found.upside_down,
        "open_edges": {
            "count": open.count,
            "length_m": open.length,
            "loops": open.loops,
            "excess_loops": found.excess_loops(),
            "pieces": open.pieces,
            "longest": open.longest.iter().map(piece).collect::<Vec<Value>>(),
        },
        "crowded_edges": occurrences(&found.non_manifold_edges),
        "mismatched_edges": occurrences(&found.inconsistent_edges),
        "inverted": occurrences(&found.inverted),
        "inside_out_components": found.inside_out_components,
        "undecided_patches": occurrences(&found.undecided_patches),
        "one_sided_patches": occurrences(&found.non_orientable_patches),
    })
}

/// The number of occurrences and the first of them.
fn occurrences(found: &Occurrences) -> Value {
    json!({ "count": found.count, "examples": found.examples.iter().map(example).collect::<Vec<Value>>() })
}

/// A connected piece of open edges.
fn piece(piece: &OpenEdgePiece) -> Value {
    json!({ "edges": piece.edges, "length_m": piece.length, "example": example(&piece.example) })
}

fn example(example: &Occurrence) -> Value {
    let place = example.place.to_array();
    match example.item {
        MeshElement::Face(face) => json!({ "face": face.0, "place_m": place }),
        MeshElement::Vertex(vertex) => json!({ "vertex": vertex, "place_m": place }),
    }
}
