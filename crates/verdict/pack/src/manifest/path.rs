//! Paths of a pack's files, which must stay inside the pack's folder.

use std::path::{Path, PathBuf};

use raypencil_files::Fault;

/// Characters of a path that messages show.
const MAX_SHOWN_CHARS: usize = 80;

/// What messages expect of a path.
pub(crate) const PATH_RULE: &str = "a path within the pack's folder, with / between its parts";

/// Refuses a path that may lead out of its folder, on this system or on another one.
pub(crate) fn check_relative(path: &str) -> Result<(), &'static str> {
    if path.contains(['\\', ':', '\0']) {
        return Err("has a backslash, a drive or a scheme");
    }
    match path.split('/').all(|part| !part.is_empty() && part != "." && part != "..") {
        true => Ok(()),
        false => Err("is absolute, leads out of the folder or names no file"),
    }
}

/// The path of a listed file. The file must exist inside the folder, also after links are followed.
pub(crate) fn resolve_inside(folder: &Path, path: &str) -> Result<PathBuf, Fault> {
    let place = || format!("file {:?}", path.chars().take(MAX_SHOWN_CHARS).collect::<String>());
    check_relative(path).map_err(|why| Fault::new(place(), why, PATH_RULE))?;
    let file = folder.join(path);
    let missing = |_| Fault::new(place(), "missing", "the file that was packed");
    let real = file.canonicalize().map_err(missing)?;
    match real.starts_with(folder.canonicalize().map_err(missing)?) {
        true => Ok(file),
        false => Err(Fault::new(place(), "leads out of the folder by a link", PATH_RULE)),
    }
}
