//! Packs that many tests need. To write one takes longer than to judge a candidate by it: each is written once, and put from
//! memory into the folders of the other tests.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, OnceLock};

/// The files of a pack, by their paths in it.
type Files = Vec<(PathBuf, Vec<u8>)>;

static KEPT: LazyLock<Mutex<HashMap<String, Arc<OnceLock<Files>>>>> = LazyLock::new(Mutex::default);

/// Puts a pack into a folder that is not there yet, or empty. `made_of` is all that decides what `write` writes.
pub(super) fn put_pack(folder: &Path, made_of: &dyn std::fmt::Debug, write: impl FnOnce(&Path)) {
    let kept = Arc::clone(KEPT.lock().unwrap().entry(format!("{made_of:?}")).or_default());
    let files = kept.get_or_init(|| {
        let place = tempfile::tempdir().unwrap();
        let pack = place.path().join("pack");
        write(&pack);
        let mut files = Vec::new();
        read_into(&mut files, &pack, Path::new(""));
        files
    });
    for (path, bytes) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

fn read_into(files: &mut Files, pack: &Path, at: &Path) {
    for entry in fs::read_dir(pack.join(at)).unwrap() {
        let entry = entry.unwrap();
        let path = at.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            read_into(files, pack, &path);
        } else {
            let bytes = fs::read(entry.path()).unwrap();
            files.push((path, bytes));
        }
    }
}

#[test]
fn a_pack_that_is_kept_has_all_files_of_the_one_that_was_written() {
    let places = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let mut written = 0;
    for (place, made_of) in places.iter().zip(["this", "this"]) {
        put_pack(&place.path().join("pack"), &made_of, |pack| {
            written += 1;
            fs::create_dir_all(pack.join("within")).unwrap();
            fs::write(pack.join("a"), "1").unwrap();
            fs::write(pack.join("within/b"), "2").unwrap();
        });
        let text = |name: &str| fs::read_to_string(place.path().join("pack").join(name)).unwrap();
        assert_eq!([text("a"), text("within/b")], ["1", "2"]);
    }
    assert_eq!(written, 1);
    let other = tempfile::tempdir().unwrap();
    put_pack(other.path(), &"that", |pack| fs::create_dir_all(pack).unwrap());
    assert_eq!(fs::read_dir(other.path()).unwrap().count(), 0);
}
