//! Files that somebody made to hurt: each with the command that meets it and the words of the refusal. `docs/evidence/malformed-inputs.md`
//! lists them.
//!
//! They are made here, byte by byte, and none is committed. What is true of every refusal (exit code 2, one short message
//! that names the file, nothing else printed, no file written, little memory and time) is asserted in
//! `crates/cli/tests/hostile.rs`, where the binary's path is known.

pub mod bytes;
mod candidate;
mod drive;
mod exr;
mod glb;
mod gltf;
mod manifest;
mod npy;
mod pfm;
mod scene;
mod tiff;

use std::fs;
use std::io;
use std::path::Path;

pub use tiff::tiffs;

/// What is found at a place.
#[derive(Debug, Clone)]
pub enum Item {
    /// A file of these bytes.
    File(Vec<u8>),
    /// An empty folder.
    Folder,
    /// A named pipe, into which nobody writes.
    Pipe,
    /// A symbolic link to this path.
    Link(String),
    /// A copy of a committed pack, all of it.
    Pack(&'static str),
}

/// A hostile input.
#[derive(Debug, Clone)]
pub struct Case {
    /// Its own name: letters, digits and hyphens.
    pub name: String,
    /// What is wrong with it, in a few words.
    pub what: &'static str,
    /// What to make, by path from a folder of its own; parents are made too. Links that lead out lead to files beside
    /// the folder `case`, in which the command is run.
    pub items: Vec<(String, Item)>,
    /// What to run in the folder. `PACK` stands for the path of a good pack.
    pub command: Vec<String>,
    /// Words that the message must have: the file and the place.
    pub words: Vec<String>,
}

impl Case {
    /// A case whose command is `command`, split at blanks.
    fn new(name: impl Into<String>, what: &'static str, command: &str, words: &[&str]) -> Self {
        Self {
            name: name.into(),
            what,
            items: Vec::new(),
            command: command.split(' ').map(ToString::to_string).collect(),
            words: words.iter().map(ToString::to_string).collect(),
        }
    }

    /// Adds a file.
    fn file(self, path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.item(path, Item::File(bytes.into()))
    }

    fn item(mut self, path: &str, item: Item) -> Self {
        self.items.push((path.to_string(), item));
        self
    }

    /// One file, its name first among the words.
    fn of_file(
        name: &str,
        what: &'static str,
        command: &str,
        file: &str,
        bytes: Vec<u8>,
        place: &str,
    ) -> Self {
        Self::new(name, what, command, &[file, place]).file(file, bytes)
    }

    /// With other words instead of the file's name and the place.
    fn says(mut self, words: &[&str]) -> Self {
        self.words = words.iter().map(ToString::to_string).collect();
        self
    }

    /// Makes everything in `folder`, which is empty. `packs` holds the committed packs.
    ///
    /// # Errors
    /// What the file system says.
    pub fn make(&self, folder: &Path, packs: &Path) -> io::Result<()> {
        for (path, item) in &self.items {
            let path = folder.join(path);
            fs::create_dir_all(path.parent().unwrap_or(folder))?;
            match item {
                Item::File(bytes) => fs::write(path, bytes)?,
                Item::Folder => fs::create_dir(path)?,
                Item::Pipe => pipe(&path)?,
                #[cfg(unix)]
                Item::Link(to) => std::os::unix::fs::symlink(to, path)?,
                #[cfg(not(unix))]
                Item::Link(_) => return Err(io::ErrorKind::Unsupported.into()),
                Item::Pack(name) => copy(&packs.join(name), &path)?,
            }
        }
        Ok(())
    }
}

fn pipe(path: &Path) -> io::Result<()> {
    // The standard library makes none.
    match std::process::Command::new("mkfifo").arg(path).status()?.success() {
        true => Ok(()),
        false => Err(io::Error::other("mkfifo failed")),
    }
}

/// A copy of a folder; a file that is there already stays.
fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let to = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &to)?;
        } else if !to.exists() {
            fs::copy(entry.path(), to)?;
        }
    }
    Ok(())
}

/// Every case but the TIFFs.
pub fn all() -> Vec<Case> {
    [
        gltf::cases(),
        glb::cases(),
        exr::cases(),
        npy::cases(),
        pfm::cases(),
        scene::cases(),
        drive::cases(),
        manifest::cases(),
        candidate::cases(),
    ]
    .concat()
}

/// Good files, under the names of the hostile ones: what is refused is refused for what is wrong with it, and the limits
/// are no narrower than good files need. The command may find differences, but no trouble.
pub fn good() -> Vec<Case> {
    let scene = "version = 1\n[camera]\nwidth_px = 16\nheight_px = 16\n[[beam]]\ncolumns = 16\nrows = 2\n\
                 [vehicle]\nposition_m = [-0.5, 0.5, 0]\n[terrain]\nfile = \"ground.glb\"\n";
    let diff = |name: &str, bytes: Vec<u8>| {
        let command = format!("diff map.{name} map.{name} -o out");
        Case::new(format!("good-{name}"), "a good file", &command, &[]).file(&format!("map.{name}"), bytes)
    };
    let ground = glb::good();
    vec![
        Case::new("good-glb", "a good file", "validate scene.toml -o out", &[])
            .file("scene.toml", scene)
            .file("ground.glb", ground),
        diff("exr", exr::good()),
        diff("npy", npy::good()),
        diff("pfm", pfm::good()),
        Case::new("good-pack", "a good pack, judged by itself", "check PACK PACK -o out", &[]),
        Case::new("good-note", "a good note", "check PACK mine -o out", &[])
            .item("mine", Item::Pack("facets"))
            .file("mine/candidate.json", candidate::good()),
    ]
}

/// The cases as the table of `docs/evidence/malformed-inputs.md`.
pub fn table() -> String {
    let mut text = String::from(
        "# Hostile files\n\nMade by `tests/src/hostile`, run by `crates/cli/tests/hostile.rs`: each in a process of its own \
         under a limit of 512 MB of\nmemory and 2 s of processor time. Asserted of each: exit code 2, one short message with \
         these words, nothing on standard\noutput, no file written. `just hostile` writes this page.\n\n| case | what it is | words of the message |\n| --- | --- | --- |\n",
    );
    for case in all().iter().chain(&tiffs()) {
        let words =
            case.words.iter().map(|word| format!("`{}`", word.replace('|', "\\|"))).collect::<Vec<_>>();
        text += &format!("| {} | {} | {} |\n", case.name, case.what, words.join(", "));
    }
    text
}
