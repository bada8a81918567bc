//! The input pack: its files, and what is told of a loader that gets faces wrong.

use std::path::{Path, PathBuf};

use raypencil_files::write_npy;
use raypencil_pack::{InputChecked, LoadingClause, check_input, input_faces, write_input};
use raypencil_scene::Image;
use serde_json::Value;

fn pack() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/input")
}

/// The check of a loader that gives the right faces but for a change: of their rows of nine numbers, and of their reflectivities.
fn checked(change: impl FnOnce(&mut Vec<[f64; 9]>, &mut Vec<f64>)) -> InputChecked {
    let faces = input_faces();
    let row = |corners: [[f64; 3]; 3]| std::array::from_fn(|k| corners[k / 3][k % 3]);
    let mut rows: Vec<[f64; 9]> = faces.iter().map(|face| row(face.corners)).collect();
    let mut reflectivities: Vec<f64> = faces.iter().map(|face| face.reflectivity).collect();
    change(&mut rows, &mut reflectivities);
    let folder = tempfile::tempdir().expect("a folder");
    let triangles = Image::from_cells(9, rows.len() as u32, rows.concat());
    write_npy(folder.path().join("triangles.npy"), &[&triangles]).expect("an array");
    let reflectivity = Image::from_cells(1, reflectivities.len() as u32, reflectivities);
    write_npy(folder.path().join("reflectivity.npy"), &[&reflectivity]).expect("an array");
    check_input(&pack(), folder.path()).expect("arrays of the right shape")
}

/// The file for loaders and the triangles that it must become, by closed forms apart from it, are those that are published: loaders were
/// tested against them.
#[test]
fn an_input_pack_is_written_as_it_is_published() {
    let folder = tempfile::tempdir().expect("a folder");
    write_input(folder.path()).expect("a writable folder");
    for name in ["ground.glb", "triangles.npy", "reflectivity.npy"] {
        let [written, published] =
            [folder.path(), &pack()].map(|folder| std::fs::read(folder.join(name)).expect("a file"));
        assert!(written == published, "{name}");
    }
}

#[test]
fn wrong_faces_are_counted_by_their_clauses_and_those_too_many_are_of_the_scene() {
    let right = checked(|_, _| ());
    assert!(right.passes() && right.has_reflectivity && right.given == input_faces().len());
    for clause in LoadingClause::ALL {
        let faces = input_faces().iter().filter(|face| face.clause == *clause).count();
        assert_eq!(right.of(*clause), (faces, 0), "{clause:?}");
    }
    // Both faces of the strip, the first of the fan, a reflectivity, and a face that the file does not have.
    let at = |clause: LoadingClause| input_faces().iter().position(|face| face.clause == clause).unwrap();
    let (strip, fan, grey) =
        (at(LoadingClause::Strip), at(LoadingClause::Fan), at(LoadingClause::Reflectivity));
    let wrong = checked(|rows, reflectivities| {
        for face in [strip, strip + 1, fan] {
            rows[face][4] += 0.25;
        }
        // A millionth is excused.
        reflectivities[fan + 1] += 0.9e-6;
        reflectivities[grey] += 1.1e-6;
        rows.push(rows[0]);
        reflectivities.push(0.25);
    });
    assert!(!wrong.passes());
    let counts = [
        LoadingClause::Axes,
        LoadingClause::Strip,
        LoadingClause::Fan,
        LoadingClause::Reflectivity,
        LoadingClause::Scene,
    ];
    assert_eq!(counts.map(|clause| wrong.of(clause)), [(1, 0), (2, 2), (2, 1), (2, 1), (0, 1)]);
    // The first of each clause comes before a second one of any.
    let json: Value = serde_json::from_str(&wrong.document().json()).expect("JSON");
    let listed = json["bundles"][0]["worst_defects"].as_array().expect("a list");
    let listed: Vec<u64> = listed.iter().filter_map(|one| one["ray"][0].as_u64()).collect();
    assert_eq!(listed, [strip, fan, grey, strip + 1].map(|face| face as u64));
    assert!(wrong.document().headline.contains("4 of 28 faces are wrong; 29 are given."));
}
