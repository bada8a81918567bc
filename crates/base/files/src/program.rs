//! Programs as bytes: that which is running, and those that a command line names. What a program answers is decided by its bytes.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::sha256::file_sha256_hex;

/// SHA-256 of the program that is running, in hexadecimal digits; empty where the system does not say which file it is. Read
/// once.
///
/// In Python that is the interpreter.
pub fn program_sha256() -> &'static str {
    static DIGEST: OnceLock<String> = OnceLock::new();
    DIGEST.get_or_init(|| {
        let file = std::env::current_exe().and_then(|path| file_sha256_hex(&path));
        file.map(|(_, sha256)| sha256).unwrap_or_default()
    })
}

/// The files that the words of a shell command name, each with its SHA-256 in hexadecimal digits: a word that is the path of a
/// file, also behind a `=`, and a word without a slash that is a program on the `PATH`.
///
/// What these files read in their turn is not seen.
///
/// ```
/// use raypencil_files::command_files;
///
/// let folder = tempfile::tempdir()?;
/// let script = folder.path().join("my tracer.py");
/// std::fs::write(&script, "print(1)")?;
/// let line = format!("python3 '{}' {{pack}} {{out}} 2>/dev/null", script.display());
/// let files = command_files(&line);
/// let (name, sha256) = files.last().expect("a file");
/// assert_eq!(*name, script.display().to_string());
/// // `printf 'print(1)' | sha256sum`
/// assert_eq!(sha256, "d287bb7f9d15abdc5b6e98536263815744b6ef21c8f3c839fc434ca70d8efe99");
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn command_files(line: &str) -> Vec<(String, String)> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut found: Vec<(String, String)> = Vec::new();
    for word in words(line) {
        let behind = word.split_once('=').map(|(_, value)| value);
        for name in std::iter::once(word.as_str()).chain(behind) {
            let Some(file) = file_of(name, &path) else { continue };
            // One that cannot be read is one without a digest: it is known again by that.
            let sha256 = file_sha256_hex(&file).map(|(_, sha256)| sha256).unwrap_or_default();
            if found.iter().all(|(own, _)| own != name) {
                found.push((name.to_string(), sha256));
            }
        }
    }
    found
}

/// The file that a word names: from the current folder, or on the path.
fn file_of(word: &str, path: &OsStr) -> Option<PathBuf> {
    if word.is_empty() {
        return None;
    }
    let here = Path::new(word);
    if here.is_file() {
        return Some(here.to_path_buf());
    }
    if word.contains(['/', '\\']) {
        return None;
    }
    let names = [word.to_string(), format!("{word}{}", std::env::consts::EXE_SUFFIX)];
    std::env::split_paths(path)
        .flat_map(|folder| names.each_ref().map(|name| folder.join(name)))
        .find(|it| it.is_file())
}

/// The words of a shell command without their quotes. Signs that separate commands, and those of redirections, separate words.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    let mut letters = line.chars();
    while let Some(letter) = letters.next() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (None, '\'' | '"') => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            // On Windows it is a part of paths.
            (None | Some('"'), '\\') if !cfg!(windows) => {
                word.get_or_insert_default().extend(letters.next());
            }
            (None, _) if letter.is_whitespace() || ";|&()<>`\n".contains(letter) => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_a_shell() {
        for (line, expected) in [
            ("a b  c", &["a", "b", "c"][..]),
            ("'a b' \"c 'd'\" e\\ f", &["a b", "c 'd'", "e f"]),
            ("cd x&&./p<in>out 2>&1; (q | r)", &["cd", "x", "./p", "in", "out", "2", "1", "q", "r"]),
            ("x'' '' a'b'c", &["x", "", "abc"]),
            ("'never closed", &["never closed"]),
            ("", &[]),
        ] {
            assert_eq!(words(line), expected, "{line}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn programs_are_found_where_a_shell_finds_them() {
        let names = |line: &str| command_files(line).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        assert_eq!(names("sh no-such-file {pack}"), ["sh"]);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("config");
        std::fs::write(&file, "a").unwrap();
        let file = file.display().to_string();
        let line = format!("no-such-program --config={file} {file} {}", folder.path().display());
        assert_eq!(names(&line), std::slice::from_ref(&file));
        // The digest is that of the bytes as they are now.
        let before = command_files(&line);
        std::fs::write(&file, "b").unwrap();
        assert_ne!(command_files(&line), before);
        assert_eq!(program_sha256().len(), 64);
    }
}
