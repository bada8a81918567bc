//! `raypencil terrain import` of a mesh: glTF, STL, OBJ or PLY to a GLB terrain, with z up and in metres.

use std::io::Read as _;
use std::path::Path;

use raypencil::io::{
    FileFacts, FileFrame, FileUnits, MESH_ENDINGS, TerrainFile, file_warnings, read_terrain,
    write_terrain_glb,
};
use raypencil::{Mesh, Progress as _};
use serde_json::{Value, json};

use crate::args::TerrainImport;
use crate::console::{Spinner, say, warn};
use crate::file_frame::file_frame;
use crate::terrain::output::{create_folder, extend, refuse_same_file};
use crate::{Outcome, Trouble};

/// Whether a file is read as a mesh: by its name; where that tells nothing, whatever does not begin as a TIFF does.
pub(super) fn is_mesh(file: &Path) -> bool {
    let ends_in = |known: &[&str]| {
        file.extension().is_some_and(|end| known.iter().any(|known| end.eq_ignore_ascii_case(known)))
    };
    ends_in(&MESH_ENDINGS) || !(ends_in(&["tif", "tiff"]) || begins_as_tiff(file))
}

/// Whether the first bytes are those of a TIFF, of either byte order, or of a BigTIFF.
fn begins_as_tiff(file: &Path) -> bool {
    let mut first = [0; 4];
    let read = std::fs::File::open(file).and_then(|mut file| file.read_exact(&mut first));
    read.is_ok() && matches!(first, [b'I', b'I', 42 | 43, 0] | [b'M', b'M', 0, 42 | 43])
}

pub(super) fn import_mesh(command: &TerrainImport, json: bool) -> Result<Outcome, Trouble> {
    let given = [("--window", command.window.is_some()), ("--max-error", command.max_error.is_some())];
    if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
        let file = command.file.display();
        return Err(Trouble::Usage(format!(
            "{option}: {file} is a mesh; expected an elevation model (.tif)"
        )));
    }
    if let Some(option) = command.dem.given() {
        let (file, scale) = (command.file.display(), "a mesh has its unit by --scale");
        return Err(Trouble::Usage(format!(
            "{option}: {file} is a mesh; expected an elevation model (.tif); {scale}"
        )));
    }
    refuse_same_file(&command.output, &command.file)?;
    let frame = file_frame(command.up, command.scale)?;
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: reading", command.file.display()));
    let TerrainFile { mesh, facts, .. } = read_terrain(&command.file, command.reflectivity, &frame)?;
    spinner.stage(&format!("{}: writing", command.output.display()));
    create_folder(&command.output)?;
    write_terrain_glb(&command.output, &mesh, &source(command, &frame))?;
    drop(spinner);
    warn(&file_warnings(&facts));
    let report = report(command, &mesh, &facts);
    say(&if json { format!("{report:#}\n") } else { screen(&report, &facts) });
    Ok(Outcome::Fine)
}

/// The source of the terrain, for the extras of its file: the file's name without its folder.
fn source(command: &TerrainImport, frame: &FileFrame) -> Value {
    json!({
        "source": command.file.file_name().map(|name| name.to_string_lossy()),
        "up": frame.up.map(|up| up.word()),
        "scale": frame.scale,
    })
}

/// The report for programs, from which that for people is made.
fn report(command: &TerrainImport, mesh: &Mesh, facts: &FileFacts) -> Value {
    let bounds = mesh.bounds().map(|bounds| bounds.map(|corner| (corner + mesh.origin()).to_array()));
    let along = |axis: usize| bounds.map(|[low, high]| [low[axis], high[axis]]);
    let mut report = json!({
        "mesh": command.file.display().to_string(),
        "terrain": command.output.display().to_string(),
        "x_m": along(0),
        "y_m": along(1),
        "z_m": along(2),
        "reflectivity": command.reflectivity,
        "vertices": mesh.vertices().len(),
        "faces": mesh.faces().len(),
        "polygons": facts.polygons,
        "scene_origin_m": mesh.origin().to_array(),
    });
    if let Some(units) = &facts.units {
        extend(&mut report, units.to_json());
    }
    report
}

fn screen(report: &Value, facts: &FileFacts) -> String {
    let text = |value: &Value| value.as_str().map_or(value.to_string(), String::from);
    let at = |pointer: &str| report.pointer(pointer).map_or(String::new(), text);
    let extent = |axis: &str| {
        let end =
            |at: usize| report[format!("{axis}_m").as_str()][at].as_f64().map_or(f64::NAN, |number| number);
        format!("{axis} {:.3} to {:.3}", end(0), end(1))
    };
    let mut lines = vec![
        ("extent", format!("{}, {} m", extent("x"), extent("y"))),
        ("heights", format!("{} m", extent("z"))),
    ];
    lines.extend(facts.units.iter().flat_map(FileUnits::lines));
    lines.extend([
        ("vertices", at("/vertices")),
        ("faces", at("/faces")),
        (
            "polygons",
            format!("{}; not convex, and cut truly: {}", at("/polygons/count"), at("/polygons/cut")),
        ),
        (
            "scene origin",
            format!(
                "({}, {}, {}) m",
                at("/scene_origin_m/0"),
                at("/scene_origin_m/1"),
                at("/scene_origin_m/2")
            ),
        ),
    ]);
    let lines: String = lines.iter().map(|(name, value)| format!("  {name:<14} {value}\n")).collect();
    format!("{}\n{lines}{}\n", at("/mesh"), at("/terrain"))
}
