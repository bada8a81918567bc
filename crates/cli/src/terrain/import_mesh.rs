//! `raypencil terrain import` of a mesh: glTF, STL, OBJ or PLY to a GLB terrain, with z up and in metres.

use std::path::Path;

use raypencil::io::{FileFrame, MESH_ENDINGS, SCALE_RANGE, load_terrain, write_terrain_glb};
use raypencil::{Mesh, Progress as _};
use serde_json::{Value, json};

use crate::args::TerrainImport;
use crate::console::{Spinner, say};
use crate::terrain::output::{create_folder, refuse_same_file};
use crate::{Outcome, Trouble};

/// Whether a file's name is that of a mesh.
pub(super) fn is_mesh(file: &Path) -> bool {
    file.extension().is_some_and(|end| MESH_ENDINGS.iter().any(|known| end.eq_ignore_ascii_case(known)))
}

pub(super) fn import_mesh(command: &TerrainImport, json: bool) -> Result<Outcome, Trouble> {
    let given = [("--window", command.window.is_some()), ("--max-error", command.max_error.is_some())];
    if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
        let file = command.file.display();
        return Err(Trouble::Usage(format!(
            "{option}: {file} is a mesh; expected an elevation model (.tif)"
        )));
    }
    refuse_same_file(&command.output, &command.file)?;
    let frame = frame(command)?;
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: reading", command.file.display()));
    let mesh = load_terrain(&command.file, command.reflectivity, &frame)?;
    spinner.stage(&format!("{}: writing", command.output.display()));
    create_folder(&command.output)?;
    write_terrain_glb(&command.output, &mesh, &source(command, &frame))?;
    drop(spinner);
    let report = report(command, &frame, &mesh);
    say(&if json { format!("{report:#}\n") } else { screen(&report) });
    Ok(Outcome::Fine)
}

/// Axes and unit that the options give.
fn frame(command: &TerrainImport) -> Result<FileFrame, Trouble> {
    let scale = command.scale.unwrap_or(1.0);
    if !SCALE_RANGE.contains(&scale) {
        return Err(Trouble::Usage(format!(
            "--scale {scale}: expected {:e} to {:e} metres for each unit of the file",
            SCALE_RANGE.start(),
            SCALE_RANGE.end()
        )));
    }
    Ok(FileFrame { up: command.up, scale })
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
fn report(command: &TerrainImport, frame: &FileFrame, mesh: &Mesh) -> Value {
    let bounds = mesh.bounds().map(|bounds| bounds.map(|corner| (corner + mesh.origin()).to_array()));
    let along = |axis: usize| bounds.map(|[low, high]| [low[axis], high[axis]]);
    json!({
        "mesh": command.file.display().to_string(),
        "terrain": command.output.display().to_string(),
        "up": frame.up.map(|up| up.word()),
        "scale": frame.scale,
        "x_m": along(0),
        "y_m": along(1),
        "z_m": along(2),
        "reflectivity": command.reflectivity,
        "vertices": mesh.vertices().len(),
        "faces": mesh.faces().len(),
        "scene_origin_m": mesh.origin().to_array(),
    })
}

/// The report for people.
fn screen(report: &Value) -> String {
    let text = |value: &Value| value.as_str().map_or(value.to_string(), String::from);
    let at = |pointer: &str| report.pointer(pointer).map_or(String::new(), text);
    let extent = |axis: &str| {
        let end =
            |at: usize| report[format!("{axis}_m").as_str()][at].as_f64().map_or(f64::NAN, |number| number);
        format!("{axis} {:.3} to {:.3}", end(0), end(1))
    };
    let up = match &report["up"] {
        Value::Null => "that of the format: y in glTF, z in STL, OBJ and PLY".to_string(),
        axis => text(axis),
    };
    let lines = [
        ("extent", format!("{}, {} m", extent("x"), extent("y"))),
        ("heights", format!("{} m", extent("z"))),
        ("up axis", up),
        ("scale", format!("{} m for each unit of the file", at("/scale"))),
        ("vertices", at("/vertices")),
        ("faces", at("/faces")),
        (
            "scene origin",
            format!(
                "({}, {}, {}) m",
                at("/scene_origin_m/0"),
                at("/scene_origin_m/1"),
                at("/scene_origin_m/2")
            ),
        ),
    ];
    let lines = lines.map(|(name, value)| format!("  {name:<14} {value}\n"));
    format!("{}\n{}{}\n", at("/mesh"), lines.concat(), at("/terrain"))
}
