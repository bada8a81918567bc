//! A reduced scene as files: the scene, its terrain, and a text with the commands that show the difference again.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, write_atomically};
use raypencil_minimise::Minimised;
use raypencil_scene_io::{Subject, probe_command, quoted, scene_sha256, write_resolved};

/// Name and description of a reproducer.
#[derive(Debug, Clone, Copy)]
pub struct Reproducer<'a> {
    /// Name of its files without the extension: letters, digits, `.`, `_` and `-`.
    pub name: &'a str,
    /// The difference that it shows, as a sentence.
    pub what: &'a str,
    /// Command-line arguments that choose the two renderers, from [`crate::typed_contenders`]. If empty, the commands
    /// use the default renderers.
    pub with: &'a str,
}

/// Writes `NAME.toml` and `NAME.glb`, the scene to the last bit, then `NAME.md`, which describes the difference and the
/// commands that show it. Returns the three paths in this order. The same scene gives the same bytes.
///
/// # Errors
/// A name that is not fit for a scene's file, or an error of the file system.
pub fn write_reproducer(
    folder: &Path,
    minimised: &Minimised,
    reproducer: Reproducer<'_>,
) -> Result<[PathBuf; 3], FileError> {
    let path = |ending: &str| folder.join(format!("{}.{ending}", reproducer.name));
    raypencil_files::create_dir_all(folder).map_err(|source| FileError::Io {
        path: folder.to_path_buf(),
        action: "create",
        source,
    })?;
    let [scene, ground, description] = ["toml", "glb", "md"].map(path);
    write_resolved(&scene, &minimised.scene, &format!("{}.glb", reproducer.name))?;
    let text = description_of(minimised, reproducer);
    write_atomically(&description, |file| file.write_all(text.as_bytes()))?;
    Ok([scene, ground, description])
}

/// Contents of `NAME.md`.
fn description_of(minimised: &Minimised, Reproducer { name, what, with }: Reproducer<'_>) -> String {
    let Minimised { scene, place, faces_before, faces_after, is_finished, .. } = minimised;
    let arguments = format!("{} {with}", quoted(&format!("{name}.toml")));
    let arguments = arguments.trim_end().to_string();
    // Both renderers may be wrong in the same way: then only the referee differs.
    let mut commands = vec![format!("raypencil validate {arguments} --judge all")];
    let sha256 = scene_sha256(scene);
    let subject = Subject {
        scene: scene.clone(),
        name: name.into(),
        arguments,
        sha256,
        vehicle: None,
        file_facts: Default::default(),
    };
    commands.extend(place.map(|place| probe_command(&subject, place)));
    let commands = commands.join("\n");
    let left = match (*faces_after, is_finished) {
        (1, _) => format!("1 face of {faces_before} is left."),
        (some, true) => {
            format!("{some} faces of {faces_before} are left. If one is left out, it does not show any more.")
        }
        (some, false) => {
            format!(
                "{some} faces of {faces_before} are left. The search ran out of its budget: fewer may do."
            )
        }
    };
    let at = place.map_or(String::new(), |place| format!(" The ray: {place}."));
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "# {name}\n\n{what}{at}\n\n{left}\n\n```sh\n{commands}\n```\n\nMade by raypencil {version}; scene {}\n",
        subject.sha256
    )
}
