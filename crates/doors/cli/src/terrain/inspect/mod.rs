//! `raypencil terrain inspect`: reports the faults of a mesh and writes a repaired one.

mod json;
mod report;
mod screen;

use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;

use raypencil::io::{
    DEFAULT_REFLECTIVITY, FileFacts, FileFrame, Overrides, SceneSource, load, read_dem_with, read_terrain,
    write_terrain_glb,
};
use raypencil::terrain::{inspect as inspect_mesh, repair};
use raypencil::{Mesh, Progress as _};
use serde_json::{Value, json};

use crate::args::TerrainInspect;
use crate::console::{Spinner, say};
use crate::terrain::output::{create_folder, is_glb};
use crate::{Outcome, Trouble};

use self::report::{Repaired, Report};

pub(crate) fn inspect(command: &TerrainInspect, json: bool) -> Result<Outcome, Trouble> {
    let output = match (&command.output, command.repair) {
        (Some(output), true) => Some(output.as_path()),
        // The parser refuses one of them without the other.
        _ => None,
    };
    let source = SceneSource::parse(&command.mesh)?;
    if let Some(output) = output {
        check_output(output, &source)?;
    }
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: loading", command.mesh));
    if let Some(option) = command.dem.given().filter(|_| !is_model_alone(command, &source)) {
        return Err(Trouble::Usage(format!(
            "{option}: {} is no elevation model by itself; expected a .tif, without --set",
            command.mesh
        )));
    }
    let (mesh, facts): (Arc<Mesh>, FileFacts) = match &source {
        // The mesh alone: a scene would need a place for the vehicle.
        SceneSource::Mesh(path) if command.set.is_empty() => {
            let read = read_terrain(path, DEFAULT_REFLECTIVITY, &FileFrame::default())?;
            (Arc::new(read.mesh), read.facts)
        }
        SceneSource::Dem(path) if command.set.is_empty() => {
            let dem = read_dem_with(path, &command.dem.options(None))?;
            (Arc::new(dem.mesh(None, DEFAULT_REFLECTIVITY)?), dem.facts().into())
        }
        _ => {
            let settings = command.set.clone();
            let loaded = load(&command.mesh, &Overrides { settings, ..Overrides::default() })?;
            (Arc::clone(loaded.scene.mesh()), loaded.file_facts)
        }
    };
    spinner.stage(&format!("{}: inspecting {} faces", command.mesh, mesh.faces().len()));
    let found = inspect_mesh(&mesh);
    let repaired = match output {
        None => None,
        Some(file) => {
            spinner.stage("repairing");
            let (repaired, repairs) = repair(&mesh);
            drop(mesh);
            spinner.stage(&format!("{}: writing", file.display()));
            create_folder(file)?;
            write_terrain_glb(file, &repaired, &extras(&command.mesh))?;
            spinner.stage("inspecting the repaired mesh");
            Some(Repaired { file, repairs, left: inspect_mesh(&repaired) })
        }
    };
    drop(spinner);
    let report = Report { mesh: &command.mesh, facts, found, repaired };
    say(&if json { json::report_json(&report) } else { screen::screen(&report) });
    Ok(if report.passes() { Outcome::Fine } else { Outcome::Differs })
}

/// Whether an elevation model is inspected, and not the scene on it.
fn is_model_alone(command: &TerrainInspect, source: &SceneSource) -> bool {
    matches!(source, SceneSource::Dem(_)) && command.set.is_empty()
}

/// The source of a repaired mesh, for the extras of its file: the file's name without its folder.
fn extras(mesh: &str) -> Value {
    json!({ "repaired": Path::new(mesh).file_name().map(OsStr::to_string_lossy) })
}

/// Refuses to overwrite the mesh that is read.
fn check_output(output: &Path, source: &SceneSource) -> Result<(), Trouble> {
    let refuse = |problem: &str| Err(Trouble::Usage(format!("--output {}: {problem}", output.display())));
    if !is_glb(output) {
        return refuse("is not a GLB file; expected a name that ends in .glb");
    }
    match source {
        SceneSource::Mesh(input) => {
            let same = output.canonicalize().ok().is_some_and(|out| input.canonicalize().ok() == Some(out));
            if same {
                return refuse("is the mesh to repair; expected another file");
            }
        }
        // The scene's terrain is named inside the scene and may be this file.
        SceneSource::Toml(_) if output.exists() => {
            return refuse("exists and may be the terrain of the scene; expected a new file");
        }
        SceneSource::Toml(_) | SceneSource::Dem(_) | SceneSource::Builtin(_) => {}
    }
    Ok(())
}
