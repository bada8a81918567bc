//! Faults injected into files: correct maps are corrupted on their way to a file. The reader must refuse each of them,
//! or the check must find it, in the quantity that the fault changes.

use std::fs;

use raypencil::Silent;
use raypencil::io::Subject;
use raypencil::judge::{Quantity, RecordingError};
use raypencil::pack::{CheckError, PackLabel, check_pack, write_pack};
use raypencil::{Precision, Scene};
use raypencil_tests::injected_faults::files::{FileFault, FileRejection, check_files, write};
use raypencil_tests::injected_faults::geometry::{pyramids, range_cut_wall};

/// A small scene with misses that reveals every fault.
fn wall() -> Scene {
    range_cut_wall()
}

#[test]
fn correct_files_pass() {
    for scene in [pyramids(), wall()] {
        assert!(check_files(&scene, None).is_none());
    }
}

#[test]
fn every_fault_of_files_is_found_in_the_quantity_it_changes() {
    for fault in FileFault::ALL {
        for (name, scene) in [("pyramids", pyramids()), ("wall", wall())] {
            let found = check_files(&scene, Some(fault));
            let quantity = match (&found, fault) {
                (Some(FileRejection::Refused(refusal)), FileFault::MinusOneForNoHit) => {
                    // The message names the first miss. On the wall this is the first cell: it is beyond the maximum
                    // range.
                    let message = refusal.to_string();
                    let says = ["`range.T` at", "-1", "+Inf"].iter().all(|word| message.contains(word));
                    assert!(says, "{name}: {message}");
                    assert!(matches!(refusal, RecordingError::Channel { cell: Some(_), .. }), "{name}");
                    continue;
                }
                (Some(FileRejection::Wrong(_, item, _)), _) => item.quantity,
                _ => panic!("{fault:?} on {name}: {found:?}"),
            };
            let expected: &[Quantity] = match fault {
                FileFault::DepthAsRange => &[Quantity::Range],
                FileFault::FacesFromOne => &[Quantity::Face],
                FileFault::PointsOfGltf => &[Quantity::Point],
                FileFault::NormalsAsColours => &[Quantity::Normal],
                // The wall is symmetric but for its two faces. 2 m is exact in half precision, an oblique range is not.
                FileFault::RowsBottomUp => &[Quantity::Range, Quantity::Face, Quantity::Point],
                FileFault::ThroughHalf => &[Quantity::Range],
                FileFault::MinusOneForNoHit => &[],
            };
            assert!(expected.contains(&quantity), "{fault:?} on {name}: {quantity}");
        }
    }
}

#[test]
fn a_pack_finds_faults_of_files_too() {
    let scene = wall();
    let folder = tempfile::tempdir().unwrap();
    let pack = folder.path().join("pack");
    let subject = Subject {
        sha256: raypencil::io::scene_sha256(&scene),
        scene,
        name: "wall".into(),
        arguments: "wall.toml".into(),
        vehicle: None,
        file_facts: Default::default(),
    };
    write_pack(&subject, None, &PackLabel::NONE, &pack, &Silent).unwrap();
    for fault in std::iter::once(None).chain(FileFault::ALL.map(Some)) {
        let candidate = folder.path().join("candidate");
        let _ = fs::remove_dir_all(&candidate);
        write(&subject.scene, fault, &candidate).unwrap();
        let found = check_pack(&pack, &candidate, Some(Precision::F64), &Silent);
        match (fault, found) {
            (None, Ok(checked)) => assert!(checked.check.passes()),
            (Some(FileFault::MinusOneForNoHit), Err(CheckError::Candidate(_))) => {}
            (Some(fault), Ok(checked)) => assert!(!checked.check.passes(), "{fault:?}"),
            (fault, Err(error)) => panic!("{fault:?}: {error}"),
        }
    }
}
