//! One malformed input: its files, the command that reads them, and the words of the refusal.

use std::fs;
use std::io;
use std::path::Path;

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
    pub(super) fn new(name: impl Into<String>, what: &'static str, command: &str, words: &[&str]) -> Self {
        Self {
            name: name.into(),
            what,
            items: Vec::new(),
            command: command.split(' ').map(ToString::to_string).collect(),
            words: words.iter().map(ToString::to_string).collect(),
        }
    }

    /// Adds a file.
    pub(super) fn file(self, path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.item(path, Item::File(bytes.into()))
    }

    pub(super) fn item(mut self, path: &str, item: Item) -> Self {
        self.items.push((path.to_string(), item));
        self
    }

    /// One file, its name first among the words.
    pub(super) fn of_file(
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
    pub(super) fn says(mut self, words: &[&str]) -> Self {
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
