//! Output folders that hold results of another command, or of something else, are refused, unless `--force` says that these may
//! go. One rule for all commands: the same command on the same subject replaces what it has made there, and nothing else does.

use std::cell::Cell;
use std::fmt;
use std::path::Path;

use raypencil::io::{FolderError, OutputFolder, bytes, harmless_line, subject_of};
use serde_json::Value;

use crate::replaced::{self, Writes};

thread_local! {
    /// Whether `--force` was given. Of this thread: it begins the command's folders, and each command has threads of its own, also
    /// where several are called as functions at once.
    static FORCE: Cell<bool> = const { Cell::new(false) };
}

/// Maximum size of a file that says what a folder holds, bytes.
const MAX_BYTES: u64 = 1 << 26;

/// Begins a command on this thread: whether results of something else may be replaced.
pub fn begin(force: bool) {
    FORCE.set(force);
}

fn is_forced() -> bool {
    FORCE.get()
}

/// One name for a scene, a mesh or a pack, however its path is written: a built-in name stays.
pub(crate) fn subject(given: &str) -> String {
    std::fs::canonicalize(given).map_or(given.to_string(), |path| path.to_string_lossy().into_owned())
}

/// What a command's results are called in messages, and in the list of the folder.
fn results(command: &str, of: &str) -> String {
    format!("`{command}` on {}", subject(of))
}

/// Begins the output folder of a command's run on a scene, a mesh or a pack. `inputs` are the files and folders that the run reads: none of them
/// may be an earlier run's in this folder.
///
/// # Errors
/// A folder that cannot be written, in which another run works, or with results of something else; an input in it that an earlier run made.
pub fn output_folder(
    folder: &Path,
    command: &str,
    of: &str,
    inputs: &[&Path],
) -> Result<OutputFolder, FolderError> {
    if let Some(parts) = parts_in(folder).filter(|_| !is_forced()) {
        return Err(FolderError::IsOfOther { path: folder.to_path_buf(), of: parts.to_string() });
    }
    let output = OutputFolder::begin_of(folder, &results(command, of), is_forced())?;
    let inputs = [inputs, &[Path::new(of)]].concat();
    output.refuse_inputs(&inputs)?;
    if let Some(writes) = Writes::of_command(command, &inputs) {
        replaced::ask(folder, writes, &inputs)?;
    }
    Ok(output)
}

/// What several runs made together in their folder, which has no list of it.
enum Parts {
    /// Of a scene, by what is done with it.
    Sweep(String, String),
    Campaign,
}

impl fmt::Display for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sweep(scene, task) => {
                write!(f, "a sweep of {}, --do {}", harmless_line(scene), harmless_line(task))
            }
            Self::Campaign => f.write_str("a campaign"),
        }
    }
}

fn parts_in(folder: &Path) -> Option<Parts> {
    let plan = document(&folder.join("sweep.json"));
    let text = |value: &Value| value.as_str().map(str::to_string);
    if let Some((scene, task)) = plan.and_then(|plan| Some((text(&plan["scene"])?, text(&plan["task"])?))) {
        return Some(Parts::Sweep(scene, task));
    }
    let has_record = |folder: &Path, begin: &str| {
        let names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
        names.map(|name| name.to_string_lossy().into_owned()).any(|name| {
            name.strip_prefix(begin)
                .and_then(|rest| rest.strip_suffix(".json"))
                .is_some_and(|rest| !rest.is_empty())
        })
    };
    let is_campaign = has_record(&folder.join("terrains"), "terrain-") || has_record(folder, "shard-");
    is_campaign.then_some(Parts::Campaign)
}

/// Refuses a folder for a campaign that holds results of another command. Its records say of which campaign they are.
///
/// # Errors
/// [`FolderError::IsOfOther`].
pub fn ask_campaign(folder: &Path) -> Result<(), FolderError> {
    ask_parts(folder, |parts| matches!(parts, Parts::Campaign))
}

/// The same for a sweep, whose plan says what it is of and what it does.
///
/// # Errors
/// [`FolderError::IsOfOther`].
pub fn ask_sweep(folder: &Path, of: &str, task: &str) -> Result<(), FolderError> {
    let is_same = |held: &str, held_task: &str| subject(held) == subject(of) && held_task == task;
    ask_parts(folder, |parts| matches!(parts, Parts::Sweep(held, held_task) if is_same(held, held_task)))
}

/// The same for a replayed scene, which leaves no results: it is not written among those of any command, nor over a pack.
pub(crate) fn ask_replay(folder: &Path) -> Result<(), FolderError> {
    ask_pack(folder, PackOf::Nothing)
}

fn ask_parts(folder: &Path, is_same: impl Fn(&Parts) -> bool) -> Result<(), FolderError> {
    if is_forced() {
        return Ok(());
    }
    // Only runs that have the folder for themselves leave a list.
    if let Some(held) = subject_of(folder) {
        return refused(folder, held);
    }
    match parts_in(folder).filter(|parts| !is_same(parts)) {
        Some(parts) => refused(folder, parts.to_string()),
        None => Ok(()),
    }
}

/// Refuses to write a pack over what it is made of, such as the scene of a pack. `is_of_rays`: it is a pack of rays.
///
/// # Errors
/// [`FolderError::IsInput`] or [`FolderError::ReplacesInput`], with the first of them.
pub fn ask_pack_inputs(folder: &Path, is_of_rays: bool, inputs: &[&Path]) -> Result<(), FolderError> {
    let Ok(whole) = folder.canonicalize() else { return Ok(()) };
    let is_within = |input: &&&Path| input.canonicalize().is_ok_and(|path| path.starts_with(&whole));
    let is_pack =
        ["manifest.json", "raypack.json", "input.json"].iter().any(|name| folder.join(name).exists());
    match inputs.iter().find(is_within).filter(|_| is_pack) {
        Some(path) => Err(FolderError::IsInput { path: path.to_path_buf(), folder: folder.to_path_buf() }),
        None => {
            let writes = if is_of_rays { Writes::RayPack } else { Writes::ScenePack };
            replaced::ask(folder, writes, inputs)
        }
    }
}

/// What a pack is of.
#[derive(Debug, Clone, Copy)]
pub enum PackOf<'a> {
    /// A scene, by its short name, with the pack's own version.
    Scene(&'a str, Option<&'a str>),
    /// Rays on a mesh.
    Mesh(&'a str),
    /// The input pack.
    Input,
    /// What is written is no pack.
    Nothing,
}

/// Refuses a folder for a pack that holds another one, or results of a run. The same pack is written again.
///
/// # Errors
/// [`FolderError::IsOfOther`].
pub fn ask_pack(folder: &Path, of: PackOf<'_>) -> Result<(), FolderError> {
    if is_forced() {
        return Ok(());
    }
    if let Some(held) = subject_of(folder).or_else(|| parts_in(folder).map(|parts| parts.to_string())) {
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
