//! Output folders that hold results of something else are refused, unless `--force` says that these may go.

use std::cell::Cell;
use std::path::Path;

use raypencil::io::{FolderError, OutputFolder, bytes, harmless_line, subject_of};
use serde_json::Value;

thread_local! {
    /// Whether `--force` was given. Of this thread: it begins the command's folders, and each command has threads of its own, also
    /// where several are called as functions at once.
    static FORCE: Cell<bool> = const { Cell::new(false) };
}

/// Maximum size of a file that says what a folder holds, bytes.
const MAX_BYTES: u64 = 1 << 26;

pub(crate) fn begin(force: bool) {
    FORCE.set(force);
}

fn is_forced() -> bool {
    FORCE.get()
}

/// One name for a scene, a mesh or a pack, however its path is written: a built-in name stays.
pub(crate) fn subject(given: &str) -> String {
    std::fs::canonicalize(given).map_or(given.to_string(), |path| path.to_string_lossy().into_owned())
}

/// Begins the output folder of a run on a scene, a mesh or a pack.
pub(crate) fn output_folder(folder: &Path, of: &str) -> Result<OutputFolder, FolderError> {
    OutputFolder::begin_of(folder, &subject(of), is_forced())
}

/// Refuses a folder that holds results of a run on something else.
pub(crate) fn ask(folder: &Path, of: &str) -> Result<(), FolderError> {
    match subject_of(folder).filter(|held| *held != subject(of) && !is_forced()) {
        Some(of) => Err(FolderError::IsOfOther { path: folder.to_path_buf(), of }),
        None => Ok(()),
    }
}

/// The same for a sweep, whose plan says what it is of.
pub(crate) fn ask_sweep(folder: &Path, of: &str) -> Result<(), FolderError> {
    ask(folder, of)?;
    let held =
        document(&folder.join("sweep.json")).and_then(|plan| Some(plan["scene"].as_str()?.to_string()));
    match held.filter(|held| subject(held) != subject(of) && !is_forced()) {
        Some(held) => refused(folder, format!("a sweep of {}", harmless_line(&held))),
        None => Ok(()),
    }
}

/// What a pack is of.
pub(crate) enum PackOf<'a> {
    /// A scene, by its short name, with the pack's own version.
    Scene(&'a str, Option<&'a str>),
    /// Rays on a mesh.
    Mesh(&'a str),
    /// The input pack.
    Input,
}

/// Refuses a folder for a pack that holds another one, or results of a run. The same pack is written again.
pub(crate) fn ask_pack(folder: &Path, of: PackOf) -> Result<(), FolderError> {
    if is_forced() {
        return Ok(());
    }
    if let Some(held) = subject_of(folder) {
        return refused(folder, held);
    }
    if let Some(held) = document(&folder.join("manifest.json")) {
        let text = |value: &Value| value.as_str().map(harmless_line);
        // A manifest that is none is told of where packs are written.
        let Some(name) = text(&held["scene"]["name"]) else { return Ok(()) };
        let version = text(&held["version"]);
        let is_same = matches!(of, PackOf::Scene(own, of) if own == name && version.as_deref() == of);
        let version = version.map_or(String::new(), |version| format!(", version {version}"));
        return if is_same { Ok(()) } else { refused(folder, format!("a pack of {name}{version}")) };
    }
    if folder.join("raypack.json").exists() {
        let mesh = document(&folder.join("summary.json"));
        let mesh = mesh.and_then(|held| Some(held["mesh"]["file"].as_str()?.to_string()));
        let is_same = matches!((of, &mesh), (PackOf::Mesh(own), Some(held)) if subject(own) == subject(held));
        let mesh = mesh.map_or("a mesh".into(), |mesh| harmless_line(&mesh));
        return if is_same { Ok(()) } else { refused(folder, format!("a pack of rays on {mesh}")) };
    }
    if folder.join("input.json").exists() && !matches!(of, PackOf::Input) {
        return refused(folder, "the input pack".into());
    }
    Ok(())
}

fn refused(folder: &Path, of: String) -> Result<(), FolderError> {
    Err(FolderError::IsOfOther { path: folder.to_path_buf(), of })
}

fn document(file: &Path) -> Option<Value> {
    serde_json::from_slice(&bytes::read_file(file, MAX_BYTES).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_is_that_of_its_own_command() {
        begin(true);
        assert!(is_forced());
        // Another command, which is called meanwhile.
        std::thread::spawn(|| assert!(!is_forced())).join().unwrap();
        begin(false);
        assert!(!is_forced());
    }
}
