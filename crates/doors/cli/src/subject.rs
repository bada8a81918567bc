//! The scene and the renderers that the arguments name.

use std::path::PathBuf;

use raypencil::harness::{Candidate, Contender, RENDERER_NAMES};
use raypencil::io::{Subject, load};
use raypencil::{Progress, Scene};

use crate::args::{DeclaredArguments, SceneArguments, SwitchArguments};
use crate::{Registry, Trouble};

/// Loads the scene. `renderers` are the arguments that choose its renderers, from [`crate::args::typed_renderers`].
pub(crate) fn subject(
    arguments: &SceneArguments,
    renderers: &str,
    progress: &dyn Progress,
) -> Result<Subject, Trouble> {
    progress.stage(&format!("{}: loading", arguments.scene));
    let loaded = load(&arguments.scene, &arguments.overrides())?;
    Ok(loaded.into_subject(arguments.typed() + renderers))
}

/// The renderers with these names and with the switches set: at least `min_count`, no two of the same name.
pub(crate) fn contenders(
    names: &[String],
    switches: &SwitchArguments,
    min_count: usize,
    registry: &Registry,
) -> Result<Vec<Contender>, Trouble> {
    if names.len() < min_count {
        let given = names.join(",");
        return Err(Trouble::Usage(format!(
            "--with {given}: expected at least {min_count} renderers to compare"
        )));
    }
    let mut contenders = Vec::new();
    for name in names {
        let mut contender = registry(name).ok_or_else(|| {
            let known = RENDERER_NAMES.join(", ");
            Trouble::Usage(format!("--with {name}: there is no such renderer; expected one of {known}"))
        })?;
        for (switch, fidelity) in &switches.set {
            contender = contender
                .with_switch(switch, *fidelity)
                .map_err(|error| Trouble::Usage(format!("--switch {switch}={fidelity}: {error}")))?;
        }
        contenders.push(contender);
    }
    if let Some((switch, fidelity)) = switches.set.first()
        && contenders.iter().all(|contender| contender.switches.is_none())
    {
        return Err(Trouble::Usage(format!(
            "--switch {switch}={fidelity}: {} {} no switches; expected scanline or scanline-paper among the \
             renderers",
            names.join(", "),
            if names.len() == 1 { "has" } else { "have" }
        )));
    }
    for (k, contender) in contenders.iter().enumerate() {
        let name = contender.renderer.name();
        if contenders[..k].iter().any(|other| other.renderer.name() == name) {
            return Err(Trouble::Usage(format!(
                "--with {}: {name} is named twice; expected different renderers",
                names.join(",")
            )));
        }
    }
    Ok(contenders)
}

/// The candidates in these folders; what is declared concerns each of them.
pub(crate) fn candidates(
    folders: &[PathBuf],
    declared: &DeclaredArguments,
    scene: &Scene,
) -> Result<Vec<Candidate>, Trouble> {
    if folders.is_empty() && !declared.is_empty() {
        let text = "--channel, --scale: there is no candidate that they concern; expected --candidate DIR";
        return Err(Trouble::Usage(text.into()));
    }
    let declarations = declared.declarations();
    let read = |folder: &PathBuf| Candidate::read_as(folder, scene, &declarations).map_err(Trouble::from);
    folders.iter().map(read).collect()
}
