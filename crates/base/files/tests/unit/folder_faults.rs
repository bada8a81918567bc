//! Each operation of a run fails once, or the process dies there. After that nothing of somebody else's is touched, the mark is
//! true, and the next run leaves what it would leave alone.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use tempfile::TempDir;

use crate::disk::LOCK_NAME;
use crate::made_list::MADE_NAME;
use crate::{
    FileError, FolderError, GrowingFile, Operation, OutputFolder, TemporaryFolder, begin_output_folder,
    create_folder, put_in_place, watch, write_atomically,
};

/// What happens to the operation of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    Fails(usize),
    Dies(usize),
}

/// Files by their paths in a folder.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Texts of somebody else's files, below the folder of the runs and beside it.
const FOREIGN: [(&str, &str); 4] = [
    ("out/notes.txt", "mine"),
    ("out/maps/theirs.exr", "mine"),
    ("out/recording/deep/a.npy", "mine"),
    ("beside.txt", "mine"),
];

/// What commands do in a folder, all of it in a small run: maps in a folder, a file that grows, files that are staged together, a
/// mark at the end.
fn run(folder: &Path, word: &str, beams: usize) -> Result<(), FolderError> {
    let output = OutputFolder::begin_of(folder, "pyramids", false)?;
    let mark = begin_output_folder(folder, "summary.json")?;
    let maps = folder.join("maps");
    create_folder(&maps)?;
    let mut log = GrowingFile::create(folder.join("log.csv"))?;
    for beam in 0..beams {
        log.add(word)?;
        write_atomically(maps.join(format!("beam-{beam}.exr")), |file| write!(file, "{word} {beam}"))?;
    }
    log.finish()?;
    let staged = TemporaryFolder::create_in(folder).map_err(|error| FileError::io(folder, "write", error))?;
    create_folder(&staged.path().join("rays"))?;
    create_folder(&folder.join("rays"))?;
    for ray in 0..beams {
        let name = format!("rays/{ray}.npy");
        write_atomically(staged.path().join(&name), |file| file.write_all(&vec![ray as u8; 9000]))?;
        put_in_place(&staged.path().join(&name), &folder.join(&name))?;
    }
    drop(staged);
    write_atomically(mark, |file| write!(file, "{word} {beams}"))?;
    output.finish()
}

/// All files below a folder, without the list's first line, which names the folder.
fn files(folder: &Path) -> Files {
    let mut found = Files::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(inner) = folders.pop() {
        for entry in std::fs::read_dir(inner).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let mut bytes = std::fs::read(&path).unwrap();
            if path.ends_with(MADE_NAME) {
                bytes.drain(..bytes.iter().position(|byte| *byte == b'\n').unwrap());
            }
            found.insert(path.strip_prefix(folder).unwrap().to_path_buf(), bytes);
        }
    }
    found
}

/// A folder with somebody else's files.
fn tree() -> TempDir {
    let tree = TempDir::new().unwrap();
    for (name, text) in FOREIGN {
        let path = tree.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    tree
}

/// A run under a fault: its result, and its operations so far.
fn run_under(
    fault: Fault,
    tree: &Path,
    word: &str,
    beams: usize,
) -> (Result<(), FolderError>, Vec<(Operation, PathBuf)>) {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let number = AtomicUsize::new(0);
    let into = seen.clone();
    let watcher = move |operation: Operation, path: &Path| {
        // What is looked at changes nothing.
        if operation == Operation::Look {
            return Ok(());
        }
        into.lock().unwrap().push((operation, path.to_path_buf()));
        let number = number.fetch_add(1, Ordering::Relaxed);
        let is_hit = match fault {
            Fault::None => false,
            Fault::Fails(at) => number == at,
            Fault::Dies(at) => number >= at,
        };
        if is_hit { Err(io::Error::from(io::ErrorKind::StorageFull)) } else { Ok(()) }
    };
    let watch = watch(tree, Arc::new(watcher));
    let result = run(&tree.join("out"), word, beams);
    drop(watch);
    let seen = std::mem::take(&mut *seen.lock().unwrap());
    (result, seen)
}

/// What the folder has if nothing ever fails: that of a run alone.
fn alone(word: &str, beams: usize) -> Files {
    static KNOWN: Mutex<BTreeMap<(String, usize), Files>> = Mutex::new(BTreeMap::new());
    let of_run = || {
        let tree = tree();
        run(&tree.path().join("out"), word, beams).unwrap();
        files(tree.path())
    };
    KNOWN.lock().unwrap().entry((word.to_string(), beams)).or_insert_with(of_run).clone()
}

fn is_hidden(name: &Path) -> bool {
    name.components().any(|part| part.as_os_str().to_string_lossy().starts_with(".raypencil-"))
}

/// Asserts what holds of a folder at any time.
fn assert_holds(tree: &Path, what: &str) {
    let found = files(tree);
    for (name, text) in FOREIGN {
        assert_eq!(found.get(Path::new(name)).map(Vec::as_slice), Some(text.as_bytes()), "{what}: {name}");
    }
    // A mark says that all of its run's files are there.
    let Some(mark) = found.get(Path::new("out/summary.json")) else { return };
    let mark = String::from_utf8(mark.clone()).unwrap();
    let (word, beams) = mark.split_once(' ').unwrap();
    let alone = alone(word, beams.parse().unwrap());
    for (name, bytes) in &alone {
        assert!(is_hidden(name) || found.get(name) == Some(bytes), "{what}: {mark}: {}", name.display());
    }
    // Without a lock, it says that nothing else is.
    for name in found.keys().filter(|_| !found.contains_key(&Path::new("out").join(LOCK_NAME))) {
        assert!(is_hidden(name) || alone.contains_key(name), "{what}: {mark} beside {}", name.display());
    }
}

/// Asserts that the next run has left what it leaves alone.
fn assert_same(tree: &Path, alone: &Files, what: &str) {
    let found = files(tree);
    let is_other = |name: &&PathBuf| found.get(*name) != alone.get(*name);
    let other: Vec<&PathBuf> = found.keys().chain(alone.keys()).filter(is_other).collect();
    assert!(other.is_empty(), "{what}: {other:?}");
}

/// The operations of a run over an earlier one.
fn operations(earlier: bool) -> Vec<(Operation, PathBuf)> {
    let tree = tree();
    if earlier {
        run(&tree.path().join("out"), "earlier", 3).unwrap();
    }
    let (result, operations) = run_under(Fault::None, tree.path(), "later", 2);
    result.unwrap();
    operations
}

#[test]
fn no_fault_of_the_disk_and_no_death_loses_anything_or_leaves_anything() {
    let last = alone("last", 1);
    let mut states = 0;
    for earlier in [false, true] {
        let operations = operations(earlier);
        for number in 0..operations.len() {
            for fault in [Fault::Fails(number), Fault::Dies(number)] {
                let tree = tree();
                let tree = tree.path();
                if earlier {
                    run(&tree.join("out"), "earlier", 3).unwrap();
                }
                let (result, seen) = run_under(fault, tree, "later", 2);
                let (operation, path) = &seen[number];
                let name = path.strip_prefix(tree).unwrap().display();
                let what = format!("over an earlier run: {earlier}, {fault:?}, {operation:?} of {name}");
                assert_holds(tree, &what);
                // Only what cannot be removed may be left, and only a removal may fail without a word.
                let is_removal = matches!(operation, Operation::RemoveFile | Operation::RemoveFolder);
                assert!(result.is_err() || is_removal, "{what}");
                let left: Vec<PathBuf> = files(tree).into_keys().filter(|name| is_hidden(name)).collect();
                if matches!(fault, Fault::Fails(_)) && !is_removal {
                    let is_list = |name: &PathBuf| name.ends_with(MADE_NAME);
                    let is_lock = |name: &PathBuf| name.ends_with(LOCK_NAME);
                    // What could not be listed stays in the lock.
                    let lists = path.ends_with(MADE_NAME);
                    assert!(
                        left.iter().all(|name| is_list(name) || lists && is_lock(name)),
                        "{what}: {left:?}"
                    );
                }
                run(&tree.join("out"), "last", 1).unwrap();
                assert_same(tree, &last, &what);
                states += 1;
            }
        }
    }
    // Each of the two faults at each operation.
    assert!(states > 140, "{states}");
    println!("{states} states");
}

#[test]
fn a_run_that_dies_over_one_that_died_loses_nothing() {
    let last = alone("last", 1);
    let count = operations(false).len();
    for first in (0..count).step_by(3) {
        for second in (first % 11..count).step_by(11) {
            let tree = tree();
            let tree = tree.path();
            let what = format!("died at {first}, then at {second}");
            let _ = run_under(Fault::Dies(first), tree, "first", 3);
            assert_holds(tree, &what);
            let _ = run_under(Fault::Dies(second), tree, "second", 2);
            assert_holds(tree, &what);
            run(&tree.join("out"), "last", 1).unwrap();
            assert_same(tree, &last, &what);
        }
    }
}
