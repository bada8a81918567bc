//! Files that a run reads and would replace by those that it writes, as `rays.npy` of a user in the folder of a pack. They are refused
//! before anything is computed, also with `--force`: that is for results.

use std::path::Path;

use raypencil::io::FolderError;

/// What a run writes into its folder, by the names of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Writes {
    /// Answers to rays; of a set with more files.
    Answers { of_set: bool },
    /// A pack of rays, which has the answers.
    RayPack,
    /// A pack of a scene.
    ScenePack,
    /// The maps of a drive.
    Drive,
}

/// Arrays of the answers to any rays, without their ending.
const ANSWERS: [&str; 10] =
    ["face", "side", "ties", "t", "range", "cos_incidence", "point", "normal", "barycentric", "any"];

/// Arrays that begin with these words: all hits, margins, a renderer beside the answers.
const ANSWERS_WITH: [&str; 4] = ["all.", "margin.", "across", "tracer."];

/// Files that the answers to a set have beside them.
const OF_SET: [&str; 10] = [
    "origin.npy",
    "direction.npy",
    "time.npy",
    "weight.npy",
    "cloud.ply",
    "cloud.pcd",
    "cloud-sensor.pcd",
    "cloud-start.pcd",
    "cloud-end.pcd",
    "range.png",
];

/// Questions of a pack of rays.
const QUESTIONS: [&str; 8] = [
    "vertices.npy",
    "faces.npy",
    "rays.npy",
    "pose.npy",
    "time.npy",
    "elevation.npy",
    "weight.npy",
    "raypack.json",
];

impl Writes {
    /// What a command writes that has the folder for itself and reads these. `None`: what it writes has other endings than what it reads.
    pub(crate) fn of_command(command: &str, inputs: &[&Path]) -> Option<Self> {
        let is_toml = |input: &&Path| input.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"));
        match command {
            "cast" => Some(Self::Answers { of_set: inputs.iter().any(is_toml) }),
            "drive" => Some(Self::Drive),
            _ => None,
        }
    }

    /// Whether the run may write a file of this name.
    fn has(self, name: &str) -> bool {
        let is_answer = |name: &str| {
            name.strip_suffix(".npy").is_some_and(|array| {
                ANSWERS.contains(&array) || ANSWERS_WITH.iter().any(|begin| array.starts_with(begin))
            })
        };
        let is_of_returns = |name: &str| name.starts_with("return.") && name.ends_with(".npy");
        match self {
            Self::Answers { of_set } => {
                let is_of_set = || OF_SET.contains(&name) || name == "top.png" || is_of_returns(name);
                is_answer(name) || (of_set && is_of_set()) || ["report.html", "summary.json"].contains(&name)
            }
            Self::RayPack => {
                is_answer(name) || QUESTIONS.contains(&name) || is_of_returns(name) || name == "summary.json"
            }
            Self::ScenePack => ["scene.toml", "terrain.glb", "manifest.json"].contains(&name),
            Self::Drive => ["local-map.tif", "edge-points.ply"].contains(&name),
        }
    }
}

/// Refuses an input in the folder that has the name of a file that is written. Of a folder as input, the two
/// arrays of a mesh are read.
///
/// # Errors
/// [`FolderError::ReplacesInput`], with the first of them.
pub(crate) fn ask(folder: &Path, writes: Writes, inputs: &[&Path]) -> Result<(), FolderError> {
    let Ok(whole) = folder.canonicalize() else { return Ok(()) };
    let is_replaced = |path: &Path| {
        let path = path.canonicalize().unwrap_or_default();
        path.is_file()
            && path.parent() == Some(&whole)
            && path.file_name().and_then(|name| name.to_str()).is_some_and(|name| writes.has(name))
    };
    for input in inputs {
        let mut read = vec![input.to_path_buf()];
        if input.is_dir() {
            read = ["vertices.npy", "faces.npy"].map(|name| input.join(name)).into();
        }
        if let Some(path) = read.into_iter().find(|path| is_replaced(path)) {
            return Err(FolderError::ReplacesInput { path });
        }
    }
    Ok(())
}
