//! The one build: a mutant that does not compile is left out, until the rest compiles.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::Result;
use crate::places::{Mutant, Source};
use crate::rewrite::{ALLOWED, NUMBER_OF_NOW, Written, write};

/// Rounds of errors after which something else must be wrong.
const MAX_ROUNDS: usize = 30;

/// An executable of tests.
#[derive(Clone, Debug)]
pub(crate) struct Executable {
    pub(crate) path: PathBuf,
    /// The folder that its tests begin in, from the root of the clone.
    pub(crate) folder: PathBuf,
    /// The package that it belongs to.
    pub(crate) package: String,
}

/// What the build gave.
pub(crate) struct Built {
    pub(crate) executables: Vec<Executable>,
    /// The numbers of the mutants that do not compile.
    pub(crate) unviable: BTreeSet<u32>,
}

/// Builds the tests of a package with all mutants, which are numbered from 1.
pub(crate) fn build(
    clone: &Path,
    package: &str,
    sources: &[Source],
    mutants: &[Mutant],
    targets: &[String],
) -> Result<Built> {
    let mut unviable = BTreeSet::new();
    for round in 1..=MAX_ROUNDS {
        let numbered = (1..).zip(mutants).filter(|(number, _)| !unviable.contains(number));
        let live: Vec<(u32, &Mutant)> = numbered.collect();
        let mut written = BTreeMap::new();
        for (number, source) in sources.iter().enumerate() {
            let mut file = write(number, source, &live);
            if number == 0 {
                file = with_number_of_now(file);
            }
            let path = clone.join(&source.name);
            // A file that stays is not compiled again.
            if fs::read_to_string(&path)? != file.text {
                fs::write(&path, &file.text)?;
            }
            written.insert(source.name.clone(), file);
        }
        println!("round {round}: {} mutants are compiled", live.len());
        let output = Command::new("cargo")
            .current_dir(clone)
            .args(["test", "--no-run", "--message-format=json", "--package", package])
            .args(targets)
            .stderr(Stdio::inherit())
            .output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let messages: Vec<Value> = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        if output.status.success() {
            let executables = executables(clone, &messages)?;
            return Ok(Built { executables, unviable });
        }
        let (found, other) = wrong(&messages, &written);
        if found.is_empty() {
            return Err(format!("the build fails, and no mutant is the reason:\n{}", other.join("\n")).into());
        }
        unviable.extend(found);
    }
    Err(format!("after {MAX_ROUNDS} rounds the build still fails").into())
}

/// The first file of the crate, with the function that all files call.
fn with_number_of_now(mut file: Written) -> Written {
    file.text.insert_str(0, ALLOWED);
    file.text.push_str(NUMBER_OF_NOW);
    let bytes = file.codes.iter_mut().map(|(_, bytes)| bytes);
    for bytes in bytes.chain(file.places.iter_mut().map(|(_, bytes)| bytes)) {
        *bytes = bytes.start + ALLOWED.len()..bytes.end + ALLOWED.len();
    }
    file
}

/// The mutants that the compiler's errors are about, and the errors that are about none.
fn wrong(messages: &[Value], written: &BTreeMap<String, Written>) -> (BTreeSet<u32>, Vec<String>) {
    let mut found = BTreeSet::new();
    let mut other = Vec::new();
    for message in messages {
        let message = &message["message"];
        if message["level"] != "error" {
            continue;
        }
        let mut places = Vec::new();
        for span in message["spans"].as_array().into_iter().flatten() {
            collect(span, &mut places);
        }
        let in_files =
            || places.iter().filter_map(|(name, byte)| written.get(name.as_str()).map(|file| (file, *byte)));
        // Code of a mutant that the error names, or else the places around.
        let codes: BTreeSet<u32> = in_files().filter_map(|(file, byte)| file.code_at(byte)).collect();
        let about = match codes.is_empty() {
            false => codes,
            true => in_files().flat_map(|(file, byte)| file.at(byte)).collect(),
        };
        if about.is_empty() {
            other.push(message["rendered"].as_str().unwrap_or_default().to_string());
        }
        found.extend(about);
    }
    (found, other)
}

/// The files and bytes of a span, and of the calls of macros that it comes from.
fn collect(span: &Value, places: &mut Vec<(String, usize)>) {
    let byte = span["byte_start"].as_u64().and_then(|byte| usize::try_from(byte).ok());
    if let (Some(name), Some(byte)) = (span["file_name"].as_str(), byte) {
        places.push((name.to_string(), byte));
    }
    if !span["expansion"].is_null() {
        collect(&span["expansion"]["span"], places);
    }
}

/// The executables of tests among what cargo made.
fn executables(clone: &Path, messages: &[Value]) -> Result<Vec<Executable>> {
    let mut found = Vec::new();
    for message in messages.iter().filter(|message| message["profile"]["test"] == true) {
        let (Some(path), Some(manifest)) =
            (message["executable"].as_str(), message["manifest_path"].as_str())
        else {
            continue;
        };
        let folder = Path::new(manifest).parent().ok_or("a manifest in no folder")?;
        let folder = folder.strip_prefix(clone).unwrap_or(folder).to_path_buf();
        let package = package_name(&fs::read_to_string(manifest)?).ok_or("a package without a name")?;
        found.push(Executable { path: path.into(), folder, package });
    }
    match found.is_empty() {
        true => Err("the package has no tests".into()),
        false => Ok(found),
    }
}

/// The name in a manifest.
pub(crate) fn package_name(manifest: &str) -> Option<String> {
    let line = manifest.lines().find_map(|line| line.strip_prefix("name = "))?;
    Some(line.trim().trim_matches('"').to_string())
}
