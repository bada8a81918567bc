//! The report for people: at most 40 lines of 100 characters.

use std::fmt::Write as _;

use raypencil::io::{FileUnits, PolygonFacts};
use raypencil::report::{count, number};
use raypencil::terrain::{Inspection, MeshElement, Occurrence, Occurrences, Repairs};

use super::report::Report;

/// Maximum characters of a line.
const MAX_WIDTH: usize = 100;

/// Blanks before a list of examples.
const INDENT: usize = 15;

pub(super) fn screen(report: &Report) -> String {
    let found = &report.found;
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |words: &str| {
        let _ = writeln!(text, "{}", words.trim_end());
    };
    line(&format!("{}: {} faces, {} vertices", report.mesh, counted(found.faces), counted(found.vertices)));
    for words in extent(found) {
        line(&words);
    }
    for (name, words) in report.facts.units.iter().flat_map(FileUnits::lines) {
        line(&format!("  {name:<13} {words}"));
    }
    line("");
    for row in fault_rows(found, &report.facts.polygons) {
        line(&format!("{} {:>11}  {}", if row.count > 0 { '!' } else { ' ' }, counted(row.count), row.words));
        if !row.places.is_empty() {
            line(&format!("{:INDENT$}{}", "", row.places));
        }
    }
    line("");
    for words in facts(found, &report.facts.polygons) {
        line(&words);
    }
    line("");
    if let Some(repaired) = &report.repaired {
        let left = &repaired.left;
        line(&format!("Repaired: {}.", repairs_made(&repaired.repairs)));
        let (faces, vertices) = (counted(left.faces), counted(left.vertices));
        line(&format!("Written: {}: {faces} faces, {vertices} vertices", repaired.file.display()));
    }
    line(&verdict(report));
    text
}

/// A line of the list of faults.
struct FaultRow {
    count: usize,
    words: String,
    /// The first occurrences.
    places: String,
}

fn row(words: &str, found: &Occurrences) -> FaultRow {
    FaultRow { count: found.count, words: words.into(), places: listed(&found.examples) }
}

/// A row with more words if there are any occurrences.
fn row_with(words: &str, more: &str, found: &Occurrences) -> FaultRow {
    row(&format!("{words}{}", if found.count > 0 { more } else { "" }), found)
}

/// All kinds of faults, found or not.
fn fault_rows(found: &Inspection, polygons: &PolygonFacts) -> Vec<FaultRow> {
    let kinds = &found.zero_area_kinds;
    let of_kinds = format!(
        ": {} repeat a vertex, {} a place, {} are lines",
        counted(kinds.repeated_vertex),
        counted(kinds.coincident_vertices),
        counted(kinds.collinear)
    );
    let other = format!(", {} of another material", counted(found.duplicate_faces_of_other_material));
    let inside_out_components = match found.inside_out_components {
        0 => String::new(),
        some => format!(", closed components that are inside out: {}", counted(some)),
    };
    let holes = match found.open_edges.longest.get(1) {
        Some(piece) if found.excess_loops() > 0 => {
            format!("one of {} edges, {:.3} m: {}", counted(piece.edges), piece.length, at(&piece.example))
        }
        _ => String::new(),
    };
    let crossing = polygons.crossing.as_ref();
    let back = "ground that mostly shows its back to someone above";
    vec![
        row("vertices that no face uses", &found.unused_vertices),
        row_with("faces without area", &of_kinds, &found.zero_area),
        row_with("copies of other faces", &other, &found.duplicates),
        row("edges of more than two faces", &found.non_manifold_edges),
        row("edges whose two faces contradict each other in winding", &found.inconsistent_edges),
        row_with("faces the wrong way round", &inside_out_components, &found.inverted),
        row("patches that have only one side", &found.non_orientable_patches),
        FaultRow {
            count: found.excess_loops(),
            words: "loops of open edges beside a border".into(),
            places: holes,
        },
        FaultRow { count: usize::from(found.upside_down), words: back.into(), places: String::new() },
        FaultRow {
            count: crossing.map_or(0, |found| found.count as usize),
            words: "polygons of the file that cross themselves".into(),
            places: crossing.map_or(String::new(), |found| format!("the first: {}", found.first)),
        },
    ]
}

/// Position, size and components of the mesh.
fn extent(found: &Inspection) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some([low, high]) = found.bounds {
        lines.push(format!("  from {} to {} m", place(low.to_array()), place(high.to_array())));
    }
    let (down, downward_area) = (counted(found.down.count), found.downward_area);
    lines.push(format!("  area {:.3} m2; {down} faces look down, {downward_area:.3} m2", found.area));
    let closed = match found.closed_components {
        0 => "none of them closed".to_string(),
        some => format!("{} of them closed, which enclose {:.3} m3", counted(some), found.volume),
    };
    lines.push(format!("  components: {}, {closed}", counted(found.components)));
    lines
}

/// Facts about the mesh that are not faults.
fn facts(found: &Inspection, polygons: &PolygonFacts) -> Vec<String> {
    let open = &found.open_edges;
    let line = |count: usize, words: String| format!("  {:>11}  {words}", counted(count));
    let mut facts =
        vec![line(open.count, format!("open edges, {:.3} m; loops: {}", open.length, counted(open.loops)))];
    let more = [
        (&found.split_vertices, "vertices in the place of another".to_string()),
        (&found.double_sided_sheets, "pairs of faces back to back".to_string()),
        (&found.undecided_patches, "patches of which half contradicts the other half".to_string()),
        (
            &found.slender,
            format!("faces longer than 10,000 times their width, up to {:.3e} times", found.worst_aspect),
        ),
    ];
    for (found, words) in more {
        if found.count > 0 {
            facts.push(line(found.count, words));
        }
    }
    if polygons.count > 0 {
        let words = format!(
            "polygons of more than three corners; not convex, and cut truly: {}",
            count(polygons.cut)
        );
        facts.push(line(polygons.count as usize, words));
    }
    if let Some(bent) = &polygons.bent {
        let distance = number(bent.distance);
        let words =
            format!("of them not planar; {} leaves its plane by {distance} units of the file", bent.worst);
        facts.push(line(bent.count as usize, words));
    }
    facts
}

fn repairs_made(repairs: &Repairs) -> String {
    let Repairs { zero_area_faces, duplicate_faces, turned_faces, welded_vertices, unused_vertices, .. } =
        *repairs;
    let all = [
        (zero_area_faces, "faces without area dropped:"),
        (duplicate_faces, "copies dropped:"),
        (turned_faces, "faces turned:"),
        (welded_vertices, "vertices welded:"),
        (unused_vertices, "vertices dropped:"),
    ];
    let words: Vec<String> = all
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{what} {}", counted(*count)))
        .collect();
    if words.is_empty() { "nothing, as there was nothing to repair".into() } else { words.join(", ") }
}

/// The last line.
fn verdict(report: &Report) -> String {
    let last = report.last();
    let checks = fault_rows(last, &report.facts.polygons).len();
    let place = if report.repaired.is_some() { " in the repaired mesh" } else { "" };
    match report.fault_kinds() {
        0 => format!("PASS {checks} checks found nothing{place}."),
        some => {
            let would = match &report.repaired {
                None if is_repairable(last) => " `--repair -o OUT.glb` repairs faults with only one repair.",
                _ => "",
            };
            format!("FAIL {some} of {checks} checks found something{place}.{would}")
        }
    }
}

/// Whether a repair would remove any of the faults.
fn is_repairable(found: &Inspection) -> bool {
    [&found.unused_vertices, &found.zero_area, &found.duplicates, &found.inverted]
        .iter()
        .any(|found| found.count > 0)
}

/// As many examples as fit on a line.
fn listed(examples: &[Occurrence]) -> String {
    let mut line = String::new();
    for (index, example) in examples.iter().enumerate() {
        let words = format!("{}{}", if index == 0 { "" } else { "; " }, at(example));
        if index > 0 && line.chars().count() + words.chars().count() > MAX_WIDTH - INDENT {
            break;
        }
        line.push_str(&words);
    }
    line
}

/// An example with its position.
fn at(example: &Occurrence) -> String {
    let place = place(example.place.to_array());
    match example.item {
        MeshElement::Face(face) => format!("face {} {place}", face.0),
        MeshElement::Vertex(vertex) => format!("vertex {vertex} {place}"),
    }
}

/// A position in metres to a millimetre; -0.000 is written 0.000.
fn place(place: [f64; 3]) -> String {
    let [x, y, z] = place.map(|coordinate| match format!("{coordinate:.3}") {
        zero if zero == "-0.000" => "0.000".into(),
        other => other,
    });
    format!("({x}, {y}, {z})")
}

fn counted(number: usize) -> String {
    count(number as u64)
}
