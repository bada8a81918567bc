//! A malformed input: its files, the command that reads them, and the words of the refusal.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// The content of a path.
#[derive(Debug, Clone)]
pub enum Item {
    /// A file of these bytes.
    File(Vec<u8>),
    /// A file of these bytes, and a hole behind them up to this length, which takes no space on the disk.
    Hole(Vec<u8>, u64),
    /// An empty folder.
    Folder,
    /// A named pipe without a writer.
    Pipe,
    /// A symbolic link to this path.
    Link(String),
    /// A copy of a whole committed pack, by name.
    Pack(&'static str),
    /// A folder with these files.
    Files(Arc<BTreeMap<String, Vec<u8>>>),
}

/// A malformed input.
#[derive(Debug, Clone)]
pub struct Case {
    /// A unique name of letters, digits and hyphens.
    pub name: String,
    /// The defect, in a few words.
    pub what: &'static str,
    /// The items to create, by path relative to the folder of the case; missing parent folders are created, and a later one takes the place of an
    /// earlier one. Links out
    /// of the folder lead to files beside it.
    pub items: Vec<(String, Item)>,
    /// The command to run in the folder, word by word. `PACK` stands for the path of a good pack.
    pub command: Vec<String>,
    /// Words that the message must contain: the file and the place in it.
    pub words: Vec<String>,
}

impl Case {
    /// A case without items. The words of `command` are separated by blanks.
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

    /// Adds an item at a path.
    pub(super) fn item(mut self, path: &str, item: Item) -> Self {
        self.items.push((path.to_string(), item));
        self
    }

    /// A case of one file, whose name is the first of the words.
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

    /// Replaces the words of the message.
    pub(super) fn says(mut self, words: &[&str]) -> Self {
        self.words = words.iter().map(ToString::to_string).collect();
        self
    }

    /// Creates all items in `folder`, which must be empty. `packs` is the folder of the committed packs.
    ///
    /// # Errors
    /// If an item cannot be created.
    pub fn make(&self, folder: &Path, packs: &Path) -> io::Result<()> {
        for (path, item) in &self.items {
            let path = folder.join(path);
            fs::create_dir_all(path.parent().unwrap_or(folder))?;
            match item {
                Item::File(bytes) => fs::write(path, bytes)?,
                Item::Hole(bytes, length) => {
                    fs::write(&path, bytes)?;
                    fs::File::options().write(true).open(path)?.set_len(*length)?;
                }
                Item::Folder => fs::create_dir(path)?,
                Item::Pipe => pipe(&path)?,
                #[cfg(unix)]
                Item::Link(to) => std::os::unix::fs::symlink(to, path)?,
                #[cfg(not(unix))]
                Item::Link(_) => return Err(io::ErrorKind::Unsupported.into()),
                Item::Pack(name) => copy(&packs.join(name), &path)?,
                Item::Files(files) => {
                    for (name, bytes) in files.iter() {
                        let file = path.join(name);
                        fs::create_dir_all(file.parent().unwrap_or(&path))?;
                        fs::write(file, bytes)?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Creates a named pipe.
fn pipe(path: &Path) -> io::Result<()> {
    // The standard library cannot create one.
    match std::process::Command::new("mkfifo").arg(path).status()?.success() {
        true => Ok(()),
        false => Err(io::Error::other("mkfifo failed")),
    }
}

/// Copies a folder. Files that exist already are not overwritten.
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
