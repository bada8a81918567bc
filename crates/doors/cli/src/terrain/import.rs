//! `raypencil terrain import`: converts an elevation model to a GLB terrain; `import_mesh` converts a mesh.

use raypencil::io::{Dem, DemFacts, MESH_ENDINGS, read_dem_with, write_terrain_glb};
use raypencil::{Mesh, Progress as _};
use serde_json::{Value, json};

use crate::args::TerrainImport;
use crate::console::{Spinner, say};
use crate::terrain::import_mesh::{import_mesh, is_mesh};
use crate::terrain::output::{check_output, create_folder, extend};
use crate::{Outcome, Trouble};

pub(crate) fn import(command: &TerrainImport, json: bool) -> Result<Outcome, Trouble> {
    check_output(&command.output)?;
    if is_mesh(&command.file) {
        return import_mesh(command, json);
    }
    let given = [("--up", command.up.is_some()), ("--scale", command.scale.is_some())];
    if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
        let (file, endings) = (command.file.display(), MESH_ENDINGS.join(", ."));
        return Err(Trouble::Usage(format!(
            "{option}: {file} is no mesh; expected a file that ends in .{endings}"
        )));
    }
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: reading", command.file.display()));
    let dem = read_dem_with(&command.file, &command.dem.options(command.window))?;
    spinner.stage("making faces");
    let mesh = dem.mesh(command.max_error, command.reflectivity)?;
    spinner.stage(&format!("{}: writing", command.output.display()));
    create_folder(&command.output)?;
    write_terrain_glb(&command.output, &mesh, &source(command, &dem))?;
    drop(spinner);
    let report = report(command, &dem, &mesh);
    say(&if json { format!("{report:#}\n") } else { screen(&report, &dem.facts()) });
    Ok(Outcome::Fine)
}

/// The source of the terrain, for the extras of its file: the file's name without its folder.
fn source(command: &TerrainImport, dem: &Dem) -> Value {
    json!({
        "source": command.file.file_name().map(|name| name.to_string_lossy()),
        "windowM": command.window,
        "maxErrorM": command.max_error,
        "spacingM": dem.posts.spacing.to_array(),
        "registration": dem.registration.word(),
        "unit": dem.map.unit.unit.name,
        "zUnit": dem.heights.unit.unit.name,
    })
}

/// The report for programs, from which that for people is made.
fn report(command: &TerrainImport, dem: &Dem, mesh: &Mesh) -> Value {
    let posts = &dem.posts;
    let last = posts.at(posts.columns - 1, posts.rows - 1);
    let known = || posts.heights.iter().copied().filter(|height| !height.is_nan());
    let mut report = json!({
        "dem": command.file.display().to_string(),
        "terrain": command.output.display().to_string(),
        "extent_m": { "x": [posts.corner.x, last.x], "y": [posts.corner.y, last.y] },
        "spacing_m": posts.spacing.to_array(),
        "posts": [posts.columns, posts.rows],
        "registration": dem.registration.word(),
        "registration_is_stated": dem.registration.is_stated(),
        "height_m": [known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max)],
        "max_error_m": command.max_error,
        "reflectivity": command.reflectivity,
        "vertices": mesh.vertices().len(),
        "faces": mesh.faces().len(),
        "scene_origin_m": mesh.origin().to_array(),
    });
    extend(&mut report, dem.facts().to_json());
    report
}

fn screen(report: &Value, facts: &DemFacts) -> String {
    let text = |value: &Value| value.as_str().map_or(value.to_string(), String::from);
    let at = |pointer: &str| report.pointer(pointer).map_or(String::new(), text);
    let stated = match report["registration_is_stated"] == true {
        true => "as the file says",
        false => "by default: the file does not say",
    };
    let fitted = match &report["max_error_m"] {
        Value::Null => "through all posts".to_string(),
        bound => format!("within {bound} m of every post"),
    };
    let mut lines = vec![
        (
            "extent",
            format!(
                "x {} to {}, y {} to {} m",
                at("/extent_m/x/0"),
                at("/extent_m/x/1"),
                at("/extent_m/y/0"),
                at("/extent_m/y/1")
            ),
        ),
        (
            "posts",
            format!(
                "{} x {}, {} x {} m apart",
                at("/posts/0"),
                at("/posts/1"),
                at("/spacing_m/0"),
                at("/spacing_m/1")
            ),
        ),
        (
            "registration",
            format!(
                "a pixel is {}, {stated}",
                if report["registration"] == "area" { "an area" } else { "a point" }
            ),
        ),
        ("heights", format!("{} to {} m", at("/height_m/0"), at("/height_m/1"))),
    ];
    lines.extend(facts.lines());
    lines.extend([
        ("faces", format!("{}, {fitted}", at("/faces"))),
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
    format!("{}\n{lines}{}\n", at("/dem"), at("/terrain"))
}
