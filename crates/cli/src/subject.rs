//! From words to a scene and renderers.

use raypencil_harness::{Progress, RENDERER_NAMES, Subject};
use raypencil_scene::Renderer;
use raypencil_scene_io::load;

use crate::args::SceneArguments;
use crate::{Registry, Trouble};

/// Loads the scene that was asked for.
pub(crate) fn subject(arguments: &SceneArguments, progress: &dyn Progress) -> Result<Subject, Trouble> {
    progress.stage(&format!("{}: loading", arguments.scene));
    let loaded = load(&arguments.scene, &arguments.overrides())?;
    Ok(Subject {
        scene: loaded.scene,
        name: loaded.name,
        arguments: arguments.typed(),
        sha256: loaded.source_sha256,
    })
}

/// Finds the renderers that were asked for, at least `least` of them, none twice.
pub(crate) fn renderers(
    names: &[String],
    least: usize,
    registry: &Registry,
) -> Result<Vec<Box<dyn Renderer>>, Trouble> {
    if let Some(twice) = names.iter().enumerate().find(|(k, name)| names[..*k].contains(name)) {
        return Err(Trouble::Usage(format!("--with names {} twice: expected different renderers", twice.1)));
    }
    if names.len() < least {
        let given = names.join(",");
        return Err(Trouble::Usage(format!(
            "--with {given}: expected at least {least} renderers to compare"
        )));
    }
    names
        .iter()
        .map(|name| {
            registry(name).ok_or_else(|| {
                let known = RENDERER_NAMES.join(", ");
                Trouble::Usage(format!("--with {name}: there is no such renderer; expected some of {known}"))
            })
        })
        .collect()
}
