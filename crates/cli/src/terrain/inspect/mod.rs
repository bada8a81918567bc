//! `raypencil terrain inspect`: what is wrong with a mesh, and a mended one.

mod json;
mod screen;

use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;

use raypencil::Mesh;
use raypencil::Progress as _;
use raypencil::io::{Overrides, SceneSource, load, load_mesh, write_terrain_glb};
use raypencil::terrain::{Inspection, Repairs, inspect as look, repair};

use super::create_folder;
use crate::args::TerrainInspect;
use crate::console::{Spinner, say};
use crate::{Outcome, Trouble};

/// What there is to tell.
struct Report<'a> {
    /// The mesh as it was asked for.
    mesh: &'a str,
    found: Inspection,
    repaired: Option<Repaired<'a>>,
}

/// What became of it.
struct Repaired<'a> {
    file: &'a Path,
    repairs: Repairs,
    left: Inspection,
}

impl Report<'_> {
    /// Whether nothing is wrong with what is left.
    fn passes(&self) -> bool {
        self.last().passes()
    }

    /// The repaired mesh's inspection if there is one, since that mesh is the one to work with.
    fn last(&self) -> &Inspection {
        self.repaired.as_ref().map_or(&self.found, |repaired| &repaired.left)
    }
}

pub(crate) fn inspect(command: &TerrainInspect, json: bool) -> Result<Outcome, Trouble> {
    let output = match (&command.output, command.repair) {
        (Some(output), true) => Some(output.as_path()),
        // The words for these are the parser's; nobody gets here with one of them alone.
        _ => None,
    };
    let source = SceneSource::parse(&command.mesh)?;
    if let Some(output) = output {
        check_output(output, &source)?;
    }
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: loading", command.mesh));
    let mesh: Arc<Mesh> = match &source {
        // A terrain needs no place for a vehicle here.
        SceneSource::Gltf(path) => Arc::new(load_mesh(path)?),
        SceneSource::Builtin(_) | SceneSource::Toml(_) | SceneSource::Dem(_) => {
            Arc::clone(load(&command.mesh, &Overrides::default())?.scene.mesh())
        }
    };
    spinner.stage(&format!("{}: looking at {} faces", command.mesh, mesh.faces().len()));
    let found = look(&mesh);
    let repaired = match output {
        None => None,
        Some(file) => {
            spinner.stage("repairing");
            let (mended, repairs) = repair(&mesh);
            drop(mesh);
            spinner.stage(&format!("{}: writing", file.display()));
            create_folder(file)?;
            write_terrain_glb(file, &mended, &of(&command.mesh))?;
            spinner.stage("looking at what is left");
            Some(Repaired { file, repairs, left: look(&mended) })
        }
    };
    drop(spinner);
    let report = Report { mesh: &command.mesh, found, repaired };
    say(&if json { json::json(&report) } else { screen::screen(&report) });
    Ok(if report.passes() { Outcome::Fine } else { Outcome::Differs })
}

/// What a repaired mesh was made from, for the file's own extras. No folder of this machine is part of it.
fn of(mesh: &str) -> serde_json::Value {
    serde_json::json!({ "repaired": Path::new(mesh).file_name().map(OsStr::to_string_lossy) })
}

/// Refuses to write over what is read.
fn check_output(output: &Path, source: &SceneSource) -> Result<(), Trouble> {
    let refuse = |problem: &str| Err(Trouble::Usage(format!("--output {}: {problem}", output.display())));
    if !output.extension().and_then(OsStr::to_str).is_some_and(|end| end.eq_ignore_ascii_case("glb")) {
        return refuse("is no GLB file; expected a name that ends in .glb");
    }
    match source {
        SceneSource::Gltf(input) => {
            let same = output.canonicalize().ok().is_some_and(|out| input.canonicalize().ok() == Some(out));
            if same {
                return refuse("is the mesh to repair; expected another file");
            }
        }
        // A scene names its terrain inside, and this might be it.
        SceneSource::Toml(_) if output.exists() => {
            return refuse("exists, and may be the scene's own terrain; expected a new file");
        }
        SceneSource::Toml(_) | SceneSource::Dem(_) | SceneSource::Builtin(_) => {}
    }
    Ok(())
}
