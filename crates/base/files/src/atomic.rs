//! Writing a file so that no reader ever sees a part of it.

use std::io::{BufWriter, Write};
use std::path::Path;

use crate::disk::in_place_of_a_file;
use crate::error::FileError;
use crate::placing::{persist, temporary_beside};

/// Writes a file beside `path` and renames it to `path` when it is complete, replacing what was there.
///
/// After an error the old file, if any, is untouched and the partial file is gone. The folder must exist.
/// There is no `fsync`: the promise holds for other readers and for failing writers, not for power cuts.
///
/// # Errors
/// The error of the file system or of `write`, with the path.
///
/// ```
/// use raypencil_files::write_atomically;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("notes.txt");
/// write_atomically(&path, |file| writeln!(file, "one line"))?;
/// // A writer that fails leaves the file as it was.
/// let failed = write_atomically(&path, |_| Err(std::io::Error::other("no more")));
/// assert!(failed.is_err());
/// assert_eq!(std::fs::read(&path)?, b"one line\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_atomically(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), FileError> {
    let path = path.as_ref();
    let attempt = || {
        let mut temporary = temporary_beside(path)?;
        let mut writer = BufWriter::new(&mut temporary);
        write(&mut writer)?;
        writer.flush()?;
        drop(writer);
        persist(temporary, path)
    };
    attempt().map_err(|error| FileError::io(path, "write", error))
}

/// Refuses a place that a file cannot be written to because a folder is there: before the work for the file is done.
///
/// # Errors
/// The folder, and that it is to be removed.
pub fn ask_place(path: &Path) -> Result<(), FileError> {
    in_place_of_a_file(path).map_err(|error| FileError::io(path, "write", error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_writer_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.txt");
        write_atomically(&path, |file| file.write_all(b"old")).unwrap();
        let error = write_atomically(&path, |file| {
            file.write_all(b"half of the n")?;
            Err(std::io::Error::other("the pen broke"))
        });
        let message = error.unwrap_err().to_string();
        assert!(message.contains("out.txt: cannot write: the pen broke"), "{message}");
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        write_atomically(&path, |file| file.write_all(b"new")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn a_missing_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let message =
            write_atomically(folder.path().join("no/such.txt"), |_| Ok(())).unwrap_err().to_string();
        assert!(message.contains("such.txt: cannot write"), "{message}");
    }

    #[cfg(unix)]
    #[test]
    fn the_file_is_as_readable_as_any_other() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_atomically(&ours, |file| file.write_all(b"1")).unwrap();
        std::fs::write(&plain, b"1").unwrap();
        let mode = |path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(ours), mode(plain));
    }
}
