//! Putting complete files in their places, and into the journals of the runs that are open there.

use std::io;
use std::path::{Path, PathBuf};

use crate::disk::{self, Temporary};
use crate::error::FileError;
use crate::journal::{enter, enter_claim, is_noted, lines_ahead, open_folders};
use crate::running::has_run;
use crate::sha256::file_sha256_hex;

/// The folder of a file; a bare name has the empty path as its parent.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A new file beside the place that [`persist`] puts it in.
pub(crate) fn temporary_beside(path: &Path) -> io::Result<Temporary> {
    Temporary::create_in(folder_of(path))
}

/// Puts a complete temporary file in its place, and notes it where a run is open.
pub(crate) fn persist(temporary: Temporary, path: &Path) -> io::Result<()> {
    let noted = note(temporary.path(), path)?;
    temporary.persist(path)?;
    enter_noted(noted);
    Ok(())
}

/// Puts a complete file of this process in its place, on the same file system, and notes it where a run is open.
///
/// # Errors
/// The error of the file system, with the path of the place; another process's run that is writing there.
pub fn put_in_place(from: &Path, to: &Path) -> Result<(), FileError> {
    let attempt = || {
        let noted = note(from, to)?;
        disk::rename(from, to)?;
        enter_noted(noted);
        Ok(())
    };
    attempt().map_err(|error: io::Error| FileError::io(to, "write", error))
}

/// Says that a file, which is of this digest, is the open run's to remove: if that dies or fails, the next one does.
///
/// # Errors
/// That of the file system, with the path of the file.
pub fn claim(file: &Path, sha256: &str) -> Result<(), FileError> {
    let attempt = || match place_of(file)? {
        Some(place) => {
            write_ahead(&place, sha256)?;
            enter_claim(&place, sha256);
            Ok(())
        }
        None => Ok(()),
    };
    attempt().map_err(|error: io::Error| FileError::io(file, "claim", error))
}

/// The canonical path of a file, and its digest before anybody else can see it; `None` where no run is open for it.
fn note(file: &Path, path: &Path) -> io::Result<Option<(PathBuf, String)>> {
    let Some(place) = place_of(path)? else { return Ok(None) };
    let (_, sha256) = file_sha256_hex(file)?;
    write_ahead(&place, &sha256)?;
    Ok(Some((place, sha256)))
}

/// The canonical path of a file for which a run is open.
fn place_of(path: &Path) -> io::Result<Option<PathBuf>> {
    if open_folders().is_empty() {
        return Ok(None);
    }
    let Some(name) = path.file_name() else { return Ok(None) };
    let place = folder_of(path).canonicalize()?.join(name);
    Ok(is_noted(&place).then_some(place))
}

/// Writes a file into the locks of the runs that are open for it, before it is put in its place.
fn write_ahead(place: &Path, sha256: &str) -> io::Result<()> {
    let folders = open_folders();
    for folder in folders.iter().filter(|folder| place.starts_with(folder)) {
        // It may have begun there after this run, which looked below its folder when it began.
        let between = place.ancestors().skip(1).take_while(|above| above != folder);
        if let Some(other) = between.into_iter().find(|above| has_run(above)) {
            let what = format!("another run is writing into {}", other.display());
            return Err(io::Error::new(io::ErrorKind::ResourceBusy, what));
        }
    }
    for (ahead, path, line) in lines_ahead(place, sha256) {
        // The line before it may have been cut off.
        disk::write(&mut &*ahead, &path, format!("\n{line}").as_bytes())?;
    }
    Ok(())
}

fn enter_noted(noted: Option<(PathBuf, String)>) {
    if let Some((place, sha256)) = noted {
        enter(&place, &sha256);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_name_is_of_the_current_folder() {
        for (file, folder) in [("a", "."), ("x/a", "x"), ("/a", "/"), ("./a", ".")] {
            assert_eq!(folder_of(Path::new(file)), Path::new(folder), "{file}");
        }
    }
}
