//! `raypencil terrain`: grounds that are made, grounds from elsewhere.

mod generate;
mod import;
mod inspect;

use std::path::Path;

use crate::args::TerrainCommand;
use crate::{Outcome, Trouble};

pub(crate) fn terrain(command: &TerrainCommand, json: bool) -> Result<Outcome, Trouble> {
    match command {
        TerrainCommand::Generate(command) => generate::generate(command, json),
        TerrainCommand::Import(command) => import::import(command, json),
        TerrainCommand::Inspect(command) => inspect::inspect(command, json),
    }
}

/// Makes the folder of an output, when there is something to write.
fn create_folder(output: &Path) -> Result<(), Trouble> {
    match output.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => Ok(raypencil::io::create_folder(folder)?),
        _ => Ok(()),
    }
}

/// Refuses an output that is no GLB by its name: told before the work, not after it.
fn check_output(output: &Path) -> Result<(), Trouble> {
    if output.extension().is_some_and(|end| end.eq_ignore_ascii_case("glb")) {
        return Ok(());
    }
    Err(Trouble::Usage(format!("-o {}: expected a file that ends in .glb", output.display())))
}
