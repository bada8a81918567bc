//! A minimised scene as files: the scene, its ground, and the commands that show it again.

use std::path::{Path, PathBuf};

use raypencil_files::{FileError, write_atomically};
use raypencil_minimise::Minimised;
use raypencil_scene_io::{Subject, probe_command, quoted, scene_sha256, write_resolved};

/// What a reproducer is of, in words.
#[derive(Debug, Clone, Copy)]
pub struct Reproducer<'a> {
    /// The name of its files, without an ending: letters, digits, `.`, `_` and `-`.
    pub name: &'a str,
    /// What it shows, as a sentence.
    pub what: &'a str,
    /// The words that choose the renderers that show it, as [`crate::renderers::typed_contenders`] has them. Without any, the
    /// command line's own tell what is right.
    pub with: &'a str,
}

/// Writes `NAME.toml` and `NAME.glb`, the scene to the last bit, and last `NAME.md`, which says what it shows and how
/// to see it again. The three paths, in this order. The same scene gives the same bytes.
///
/// # Errors
/// A name that is none for a file of a scene; what the file system says.
pub fn write_reproducer(
    folder: &Path,
    minimised: &Minimised,
    reproducer: Reproducer<'_>,
) -> Result<[PathBuf; 3], FileError> {
    let path = |ending: &str| folder.join(format!("{}.{ending}", reproducer.name));
    std::fs::create_dir_all(folder).map_err(|source| FileError::Io {
        path: folder.to_path_buf(),
        action: "create",
        source,
    })?;
    let [scene, ground, words] = ["toml", "glb", "md"].map(path);
    write_resolved(&scene, &minimised.scene, &format!("{}.glb", reproducer.name))?;
    let text = words_of(minimised, reproducer);
    write_atomically(&words, |file| file.write_all(text.as_bytes()))?;
    Ok([scene, ground, words])
}

fn words_of(minimised: &Minimised, Reproducer { name, what, with }: Reproducer<'_>) -> String {
    let Minimised { scene, place, faces_before, faces_after, is_finished, .. } = minimised;
    let arguments = format!("{} {with}", quoted(&format!("{name}.toml")));
    let arguments = arguments.trim_end().to_string();
    let mut commands = vec![format!("raypencil validate {arguments}")];
    let subject = Subject { scene: scene.clone(), name: name.into(), arguments, sha256: scene_sha256(scene) };
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
