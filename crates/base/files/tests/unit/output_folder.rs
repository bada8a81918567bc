//! Output folders of runs that meet, that are killed, and that find what others have put there.

use super::*;
use tempfile::TempDir;

fn names(folder: &Path) -> Vec<String> {
    let files = files_below(folder, &mut |_| {});
    let names = files.keys().filter(|name| !name.ends_with(MADE_NAME));
    let mut names: Vec<String> = names.map(|name| name.display().to_string()).collect();
    names.sort();
    names
}

/// A run that writes these files.
fn run(folder: &Path, files: &[&str]) {
    let output = OutputFolder::begin(folder).unwrap();
    for name in files {
        let path = folder.join(name);
        create_folder(path.parent().unwrap()).unwrap();
        write_atomically(path, |file| file.write_all(name.as_bytes())).unwrap();
    }
    output.finish().unwrap();
}

#[test]
fn only_what_a_run_has_made_is_removed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("mine.txt"), "mine").unwrap();
    run(folder, &["a", "b", "maps/c", "maps/d"]);
    // One file was changed by hand, and one was put beside them.
    std::fs::write(folder.join("b"), "changed").unwrap();
    std::fs::write(folder.join("maps/e"), "e").unwrap();
    run(folder, &["a", "maps/c"]);
    assert_eq!(names(folder), ["a", "b", "maps/c", "maps/e", "mine.txt"]);
    // An empty folder of its own goes too, and a third run knows what the second made.
    std::fs::remove_file(folder.join("maps/e")).unwrap();
    run(folder, &["z"]);
    assert_eq!(names(folder), ["b", "mine.txt", "z"]);
    assert!(!folder.join("maps").exists());
    // Nothing but the list is left of the runs themselves.
    assert!(!folder.join(LOCK_NAME).exists());
}

#[test]
fn a_file_that_a_run_has_removed_again_is_not_its_own() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let output = OutputFolder::begin(folder).unwrap();
    for name in ["a", "b"] {
        write_atomically(folder.join(name), |file| file.write_all(name.as_bytes())).unwrap();
    }
    disk::remove_file(&folder.join("a")).unwrap();
    output.finish().unwrap();
    // Somebody puts the same there.
    std::fs::write(folder.join("a"), "a").unwrap();
    run(folder, &["b"]);
    assert_eq!(names(folder), ["a", "b"]);
}

#[test]
fn a_file_that_is_made_again_with_the_same_content_stays() {
    let folder = TempDir::new().unwrap();
    run(folder.path(), &["a"]);
    run(folder.path(), &["a"]);
    run(folder.path(), &["a"]);
    assert_eq!(names(folder.path()), ["a"]);
}

#[test]
fn a_run_that_fails_leaves_the_earlier_files() {
    let folder = TempDir::new().unwrap();
    run(folder.path(), &["a", "b"]);
    drop(OutputFolder::begin(folder.path()).unwrap());
    assert_eq!(names(folder.path()), ["a", "b"]);
    run(folder.path(), &["a"]);
    assert_eq!(names(folder.path()), ["a"]);
}

#[test]
fn two_runs_do_not_write_into_one_folder() {
    let folder = TempDir::new().unwrap();
    let first = OutputFolder::begin(folder.path()).unwrap();
    let error = OutputFolder::begin(folder.path()).unwrap_err().to_string();
    assert!(error.contains("another run is writing into it"), "{error}");
    first.finish().unwrap();
    drop(OutputFolder::begin(folder.path()).unwrap());
    // The lock of a run that was killed is none.
    std::fs::write(folder.path().join(LOCK_NAME), "").unwrap();
    drop(OutputFolder::begin(folder.path()).unwrap());
}

#[test]
fn what_a_killed_run_has_left_half_written_is_removed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    std::fs::create_dir_all(folder.join("maps/.raypencil-xyz.part")).unwrap();
    for name in [".raypencil-abc.part", "maps/.raypencil-def.part", "maps/.raypencil-xyz.part/a", "my.part"] {
        std::fs::write(folder.join(name), "half").unwrap();
    }
    run(folder, &["a"]);
    assert_eq!(names(folder), ["a", "my.part"]);
    assert!(
        !folder.join(".raypencil-abc.part").exists() && !folder.join("maps/.raypencil-def.part").exists()
    );
    assert!(!folder.join("maps/.raypencil-xyz.part").exists());
}

#[test]
fn a_pack_is_no_output_folder() {
    for name in PACK_NAMES {
        let folder = TempDir::new().unwrap();
        std::fs::write(folder.path().join(name), "{}").unwrap();
        let error = OutputFolder::begin(folder.path()).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("another folder"), "{error}");
        drop(OutputFolder::begin_any(folder.path()).unwrap());
    }
}

#[test]
fn a_planted_list_removes_nothing_that_is_not_as_it_says() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("out");
    create_folder(&folder).unwrap();
    std::fs::write(parent.path().join("outside"), "x").unwrap();
    std::fs::write(folder.join("inside"), "x").unwrap();
    let x = file_sha256_hex(&folder.join("inside")).unwrap().1;
    let other = "0".repeat(64);
    let outside = parent.path().join("outside").display().to_string();
    let list = format!(
        "{}\n{x}  ../outside\n{x}  {outside}\n{other}  inside\nrubbish\n\u{fffd}\n",
        heading(&folder)
    );
    std::fs::write(folder.join(MADE_NAME), list).unwrap();
    run(&folder, &["a"]);
    assert_eq!(names(&folder), ["a", "inside"]);
    assert!(parent.path().join("outside").exists());
}

#[cfg(unix)]
#[test]
fn pipes_and_links_are_neither_waited_for_nor_followed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let pipe = |name: &str| {
        assert!(std::process::Command::new("mkfifo").arg(folder.join(name)).status().unwrap().success());
    };
    pipe(MADE_NAME);
    std::os::unix::fs::symlink("/", folder.join("root")).unwrap();
    run(folder, &["a"]);
    assert_eq!(names(folder), ["a"]);
    let refused = || {
        let error = OutputFolder::begin(folder).unwrap_err().to_string();
        assert!(error.contains(LOCK_NAME) && error.contains("remove it"), "{error}");
        std::fs::remove_file(folder.join(LOCK_NAME)).unwrap();
    };
    pipe(LOCK_NAME);
    refused();
    std::os::unix::fs::symlink("nowhere", folder.join(LOCK_NAME)).unwrap();
    refused();
    run(folder, &["a"]);
}

#[test]
fn a_run_that_writes_nothing_leaves_no_folder() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("a/b");
    drop(OutputFolder::begin(&folder).unwrap());
    assert!(!parent.path().join("a").exists());
    let output = OutputFolder::begin(&folder).unwrap();
    std::fs::write(folder.join("c"), "c").unwrap();
    drop(output);
    assert_eq!(names(parent.path()), ["a/b/c"]);
    // One that was there stays, though it is empty.
    std::fs::remove_file(folder.join("c")).unwrap();
    drop(OutputFolder::begin(&folder).unwrap());
    assert!(folder.exists());
}

#[test]
fn only_what_nobody_writes_any_more_is_abandoned() {
    let folder = TempDir::new().unwrap();
    let part = folder.path().join(".raypencil-abc.part");
    std::fs::write(&part, "half").unwrap();
    std::fs::write(folder.path().join("whole"), "whole").unwrap();
    let writes = File::open(&part).unwrap();
    writes.lock().unwrap();
    remove_abandoned(folder.path(), Duration::from_secs(600));
    assert!(part.exists());
    drop(writes);
    remove_abandoned(folder.path(), if cfg!(unix) { Duration::from_secs(600) } else { Duration::ZERO });
    assert!(!part.exists());
    assert_eq!(names(folder.path()), ["whole"]);
    remove_abandoned(&folder.path().join("nowhere"), Duration::ZERO);
}

#[cfg(unix)]
#[test]
fn what_a_killed_run_left_beside_single_files_is_removed_there_alone() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path().join("made");
    begin_files(&folder).unwrap();
    for name in [".raypencil-a.part", ".raypencil-b.part", "mine", "sub/.raypencil-c.part"] {
        create_folder(folder.join(name).parent().unwrap()).unwrap();
        std::fs::write(folder.join(name), "half").unwrap();
    }
    let writes = File::open(folder.join(".raypencil-b.part")).unwrap();
    writes.lock().unwrap();
    begin_files(&folder).unwrap();
    let is_there = |name: &&str| folder.join(name).exists();
    let all = [".raypencil-a.part", ".raypencil-b.part", "mine", "sub/.raypencil-c.part"];
    assert_eq!(
        all.iter().filter(|name| is_there(name)).collect::<Vec<_>>(),
        all[1..].iter().collect::<Vec<_>>()
    );
    assert!(begin_files(&folder.join("mine")).is_err());
}

#[test]
fn what_somebody_else_writes_meanwhile_is_not_the_run_s() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let output = OutputFolder::begin(folder).unwrap();
    write_atomically(folder.join("ours"), |file| file.write_all(b"ours")).unwrap();
    std::fs::create_dir(folder.join("mine")).unwrap();
    std::fs::write(folder.join("mine/x.npy"), "precious").unwrap();
    // Also in place of a file that the run has written.
    write_atomically(folder.join("both"), |file| file.write_all(b"ours")).unwrap();
    std::fs::write(folder.join("both"), "precious").unwrap();
    output.finish().unwrap();
    run(folder, &["a"]);
    assert_eq!(names(folder), ["a", "both", "mine/x.npy"]);
}

#[test]
fn the_list_of_a_folder_that_came_from_elsewhere_removes_nothing() {
    let parent = TempDir::new().unwrap();
    let (theirs, mine) = (parent.path().join("theirs"), parent.path().join("mine"));
    run(&theirs, &["a", "b"]);
    create_folder(&mine).unwrap();
    for name in ["a", "b", MADE_NAME] {
        std::fs::copy(theirs.join(name), mine.join(name)).unwrap();
    }
    run(&mine, &["c"]);
    let left = if cfg!(unix) { vec!["a", "b", "c"] } else { vec!["c"] };
    assert_eq!(names(&mine), left);
    // Moved with its folder, it is the same list.
    let moved = parent.path().join("moved");
    std::fs::rename(&theirs, &moved).unwrap();
    run(&moved, &["c"]);
    assert_eq!(names(&moved), ["c"]);
}

#[test]
fn a_run_below_is_left_alone_and_one_above_is_not_disturbed() {
    let folder = TempDir::new().unwrap();
    let (above, below) = (folder.path(), folder.path().join("sub"));
    let inner = OutputFolder::begin(&below).unwrap();
    let mut growing = crate::GrowingFile::create(below.join("log.csv")).unwrap();
    growing.add("a").unwrap();
    // Its temporary file is its own, and its files are.
    run(above, &["a"]);
    growing.add("b").unwrap();
    growing.finish().unwrap();
    inner.finish().unwrap();
    run(above, &["b"]);
    assert_eq!(names(above), ["b", "sub/log.csv"]);
    // Parts of one run may have folders of their own.
    let outer = OutputFolder::begin(above).unwrap();
    run(&below, &["c"]);
    outer.finish().unwrap();
    assert_eq!(names(above), ["sub/c"]);
    // A lock that another process holds above.
    let lock = File::options().create(true).truncate(false).write(true).open(above.join(LOCK_NAME)).unwrap();
    lock.lock().unwrap();
    let error = OutputFolder::begin(&below).unwrap_err().to_string();
    assert!(error.contains("another run is writing into it"), "{error}");
    assert!(OutputFolder::begin(&below.join("deeper/still")).is_err());
    assert!(!below.join("deeper").exists());
    drop(lock);
    drop(OutputFolder::begin(&below).unwrap());
}

#[test]
fn results_of_something_else_are_not_replaced_unasked() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let run_of = |subject: &str, replaced: bool, name: &str| {
        let output = OutputFolder::begin_of(folder, subject, replaced)?;
        write_atomically(folder.join(name), |file| file.write_all(name.as_bytes())).unwrap();
        output.finish()
    };
    run_of("/a  b/pyramids\n.toml", false, "a").unwrap();
    assert_eq!(subject_of(folder).as_deref(), Some("/a  b/pyramids .toml"));
    // The same again, and a run that does not say what it is of, as before.
    run_of("/a  b/pyramids\n.toml", false, "b").unwrap();
    assert_eq!(names(folder), ["b"]);
    let error = run_of("facets", false, "c").unwrap_err().to_string();
    assert!(
        error.contains("has results of /a  b/pyramids .toml; expected another folder, or --force"),
        "{error}"
    );
    assert_eq!(names(folder), ["b"]);
    run_of("facets", true, "c").unwrap();
    assert_eq!(names(folder), ["c"]);
    // A subject has one line in the list, whatever letters it has.
    run_of("fac\u{1b}ets\r", true, "c").unwrap();
    assert_eq!(subject_of(folder).as_deref(), Some("fac ets "));
    run_of("fac\u{1b}ets\r", false, "c").unwrap();
    // Results that are gone, or that were changed, are nobody's.
    std::fs::write(folder.join("c"), "mine").unwrap();
    run_of("pyramids", false, "d").unwrap();
    assert_eq!(names(folder), ["c", "d"]);
    run(folder, &["e"]);
    assert_eq!((names(folder), subject_of(folder)), (vec!["c".to_string(), "e".to_string()], None));
    // A list may name anything; files beside the folder are no results in it.
    let inner = folder.join("inner");
    std::fs::create_dir(&inner).unwrap();
    let (_, digest) = file_sha256_hex(&folder.join("c")).unwrap();
    for (name, is_result) in [("../c", false), ("c", true)] {
        let list = format!("{}\n# results of facets\n{digest}  {name}\n", heading(&inner));
        std::fs::write(inner.join(MADE_NAME), list).unwrap();
        std::fs::write(inner.join("c"), "mine").unwrap();
        assert_eq!(subject_of(&inner).is_some(), is_result, "{name}");
    }
}

#[test]
fn inputs_that_an_earlier_run_has_made_are_refused_and_no_others() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    run(folder, &["maps/a", "b", "gone"]);
    std::fs::create_dir(folder.join("other")).unwrap();
    for name in ["mine", "maps/mine", "other/mine"] {
        std::fs::write(folder.join(name), "mine").unwrap();
    }
    std::fs::remove_file(folder.join("gone")).unwrap();
    let output = OutputFolder::begin(folder).unwrap();
    // A folder is an input with all that is in it.
    let made = ["maps/a", "b", "maps", ".", "maps/../b"];
    let others = ["mine", "maps/mine", "other/mine", "other", "gone", "nowhere", ".."];
    for (name, is_made) in made.map(|name| (name, true)).into_iter().chain(others.map(|name| (name, false))) {
        let found = output.refuse_inputs(&[&folder.join(name)]);
        let is_refused = matches!(found, Err(FolderError::IsInput { .. }));
        assert_eq!(is_refused, is_made, "{name}: {found:?}");
    }
    // Any one of several.
    assert!(output.refuse_inputs(&[&folder.join("mine"), &folder.join("b")]).is_err());
}

#[test]
fn what_a_run_within_a_run_has_made_goes_with_its_list() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let outer = OutputFolder::begin(folder).unwrap();
    run(&folder.join("inner"), &["a"]);
    assert!(folder.join("inner").join(MADE_NAME).exists());
    outer.finish().unwrap();
    run(folder, &["z"]);
    assert_eq!(names(folder), ["z"]);
    assert!(!folder.join("inner").exists());
}

#[test]
fn a_file_that_is_put_in_its_place_is_the_run_s_too() {
    let folder = TempDir::new().unwrap();
    let (folder, staged) = (folder.path(), folder.path().join(".raypencil-staged.part"));
    let output = OutputFolder::begin(folder).unwrap();
    std::fs::write(&staged, "staged").unwrap();
    crate::put_in_place(&staged, &folder.join("a")).unwrap();
    output.finish().unwrap();
    assert_eq!(names(folder), ["a"]);
    run(folder, &["b"]);
    assert_eq!(names(folder), ["b"]);
}

#[test]
fn what_a_run_that_died_had_put_in_place_goes_with_the_next() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("mine"), "mine").unwrap();
    run(folder, &["a", "b"]);
    // It has written half of its files, and changed one of the earlier run.
    let died = OutputFolder::begin(folder).unwrap();
    for (name, text) in [("a", "another"), ("maps", "c"), ("d", "d")] {
        write_atomically(folder.join(name), |file| file.write_all(text.as_bytes())).unwrap();
    }
    let lock = std::fs::read(folder.join(LOCK_NAME)).unwrap();
    let list = std::fs::read(folder.join(MADE_NAME)).unwrap();
    drop(died);
    std::fs::write(folder.join(MADE_NAME), list).unwrap();
    // The last line was cut off: what is left of it may be the name and the digest of somebody else's file.
    let cut = format!("\n{}  mine", crate::hex_digits(&crate::sha256(b"mine")));
    std::fs::write(folder.join(LOCK_NAME), [lock, cut.into_bytes()].concat()).unwrap();
    std::fs::write(folder.join("d"), "changed").unwrap();
    // A run that dies at once keeps the knowledge.
    drop(OutputFolder::begin(folder).unwrap());
    run(folder, &["z"]);
    assert_eq!(names(folder), ["d", "mine", "z"]);
    assert!(!folder.join(LOCK_NAME).exists());
}

/// A list has a line for each file: a name of two lines would be that of another file.
#[cfg(unix)]
#[test]
fn a_name_of_two_lines_is_not_taken_for_its_first() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let output = OutputFolder::begin(folder).unwrap();
    write_atomically(folder.join("a\nb"), |file| file.write_all(b"same")).unwrap();
    output.finish().unwrap();
    std::fs::write(folder.join("a"), "same").unwrap();
    run(folder, &["z"]);
    assert_eq!(names(folder), ["a", "a\nb", "z"]);
}

#[test]
fn what_a_run_that_failed_has_written_goes_with_the_next() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    run(folder, &["a", "b"]);
    let failed = OutputFolder::begin(folder).unwrap();
    for name in ["b", "c"] {
        write_atomically(folder.join(name), |file| file.write_all(b"failed")).unwrap();
    }
    drop(failed);
    assert_eq!(names(folder), ["a", "b", "c"]);
    run(folder, &["a"]);
    assert_eq!(names(folder), ["a"]);
}

#[cfg(unix)]
#[test]
fn a_file_that_somebody_is_writing_is_nobody_s_to_remove() {
    let folder = TempDir::new().unwrap();
    let (above, below) = (folder.path(), folder.path().join("sub"));
    create_folder(&below).unwrap();
    // By a run that shares its folder with others, and locks none.
    let mut growing = crate::GrowingFile::create(below.join("log.csv")).unwrap();
    let staged = crate::TemporaryFolder::create_in(&below).unwrap();
    growing.add("a").unwrap();
    run(above, &["a"]);
    remove_abandoned(above, Duration::ZERO);
    assert!(staged.path().exists());
    growing.finish().unwrap();
    drop(staged);
    assert_eq!(names(above), ["a", "sub/log.csv"]);
}

#[test]
fn what_a_later_run_has_made_in_a_folder_below_is_that_run_s() {
    let folder = TempDir::new().unwrap();
    let (above, below) = (folder.path(), folder.path().join("sub"));
    run(above, &["a", "sub/b", "sub/c"]);
    // The same file, made by a run into the folder below.
    std::fs::write(below.join("b"), "sub/b").unwrap();
    let output = OutputFolder::begin(&below).unwrap();
    write_atomically(below.join("b"), |file| file.write_all(b"sub/b")).unwrap();
    output.finish().unwrap();
    run(above, &["a"]);
    assert_eq!(names(above), ["a", "sub/b"]);
}

#[test]
fn a_run_writes_nothing_into_a_folder_below_into_which_another_one_writes() {
    let folder = TempDir::new().unwrap();
    let (above, below) = (folder.path(), folder.path().join("sub"));
    let lock = |folder: &Path| {
        let lock =
            File::options().create(true).truncate(false).write(true).open(folder.join(LOCK_NAME)).unwrap();
        lock.lock().unwrap();
        lock
    };
    create_folder(&below).unwrap();
    let theirs = lock(&below);
    let output = OutputFolder::begin(above).unwrap();
    let write = |name: &str| write_atomically(above.join(name), |file| file.write_all(b"a"));
    write("a").unwrap();
    let error = write("sub/a").unwrap_err().to_string();
    assert!(error.contains("another run is writing into") && error.contains("sub"), "{error}");
    drop(theirs);
    write("sub/a").unwrap();
    output.finish().unwrap();
    assert_eq!(names(above), ["a", "sub/a"]);
}

#[test]
fn a_pack_leaves_no_list_and_nothing_of_an_earlier_one() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let pack = |names: &[&str]| {
        let output = OutputFolder::begin_any(folder).unwrap();
        for name in names {
            write_atomically(folder.join(name), |file| file.write_all(name.as_bytes())).unwrap();
        }
        output
    };
    run(folder, &["report"]);
    // One that fails, and one that does not.
    drop(pack(&["a", "b"]));
    pack(&["a"]).finish_unlisted().unwrap();
    assert_eq!(names(folder), ["a"]);
    assert!(!folder.join(MADE_NAME).exists() && !folder.join(LOCK_NAME).exists());
    // An earlier pack's files, which its manifest named, are claimed before the manifest goes.
    let died = pack(&[]);
    crate::claim(&folder.join("a"), &file_sha256_hex(&folder.join("a")).unwrap().1).unwrap();
    let lock = std::fs::read(folder.join(LOCK_NAME)).unwrap();
    drop(died);
    std::fs::write(folder.join(LOCK_NAME), lock).unwrap();
    pack(&["b"]).finish_unlisted().unwrap();
    assert_eq!(names(folder), ["b"]);
    // One that fails between the claim and the removal leaves them to the next one, too.
    let failed = pack(&[]);
    crate::claim(&folder.join("b"), &file_sha256_hex(&folder.join("b")).unwrap().1).unwrap();
    drop(failed);
    assert!(!folder.join(LOCK_NAME).exists());
    pack(&["c"]).finish_unlisted().unwrap();
    assert_eq!(names(folder), ["c"]);
}
