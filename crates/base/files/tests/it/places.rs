//! Places that files and folders may have, streams, and words about storage.

use std::fs;
use std::io::ErrorKind;

use raypencil_files::{FolderError, Step, Storage, ask_place, begin_output_folder, bytes::read_stream};

#[test]
fn a_file_cannot_take_the_place_of_a_folder() {
    let parent = tempfile::tempdir().unwrap();
    let refused = ask_place(parent.path()).unwrap_err().to_string();
    assert!(refused.contains("it is a folder"), "{refused}");
    let file = parent.path().join("file");
    ask_place(&file).unwrap();
    fs::write(&file, "here").unwrap();
    ask_place(&file).unwrap();
}

#[test]
fn an_output_folder_cannot_be_where_a_file_is_and_its_mark_is_a_file() {
    let parent = tempfile::tempdir().unwrap();
    let file = parent.path().join("file");
    fs::write(&file, "here").unwrap();
    let refused = begin_output_folder(&file, "summary.json").unwrap_err().to_string();
    assert!(refused.contains("it is a file; expected a folder"), "{refused}");
    // A mark that cannot be removed would say that the folder is complete.
    let folder = parent.path().join("out");
    fs::create_dir_all(folder.join("summary.json")).unwrap();
    let refused = begin_output_folder(&folder, "summary.json").unwrap_err();
    assert!(matches!(refused, FolderError::RemoveEarlier { .. }), "{refused}");
}

#[test]
fn a_stream_is_read_up_to_its_limit() {
    let all = [7_u8, 8, 9];
    assert_eq!(read_stream(&all[..], 3).unwrap(), all);
    assert_eq!(read_stream(&all[..2], 3).unwrap(), all[..2]);
    assert_eq!(read_stream(&all[..], 2).unwrap_err().kind(), ErrorKind::InvalidData);
}

#[test]
fn storage_coarser_than_single_precision_is_told_in_words() {
    let words = |storage: Storage| storage.coarse_words();
    assert_eq!(words(Storage::F16).as_deref(), Some("half precision"));
    assert_eq!(words(Storage::Steps(Step::new(0.001).unwrap())).as_deref(), Some("steps of 0.001 m"));
    assert_eq!([Storage::F32, Storage::F64, Storage::Whole].map(words), [None, None, None]);
}
