//! Declared conventions of a recording: what is refused without them, with which help, and what they change.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use raypencil_files::write_npy;
use raypencil_judge::{Conventions, GroundTruth, Quantity, Recorded, RecordingError, check};
use raypencil_scene::{
    Atmosphere, Camera, FluxModel, Image, Lens, Material, Mesh, Mounted, Pose, Precision, Scene, Silent, rig,
};

/// A wall at z = 2 m that ends at x = 1/8 m, before a camera of 9 x 8 pixels at the origin that looks along z. Columns 0
/// to 4 hit it.
fn wall() -> Scene {
    let corners = vec![[0.125, -40.0, 2.0], [-90.0, 0.0, 2.0], [0.125, 40.0, 2.0]];
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let wall = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], vec![plaster]).unwrap();
    let camera = Camera {
        width: 9,
        height: 8,
        pixel_pitch: [0.0625; 2],
        focal_length: 0.5,
        principal_point: [4.5, 4.0],
        aperture: 0.01,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(Arc::new(wall), camera, vec![], air, FluxModel::Radiometric).unwrap()
}

/// Ranges of the wall, with a number where nothing is hit: R = |q| 2 / (1/2).
fn ranges(miss: f64) -> Image<f64> {
    let cell = |k: u32| {
        let (x, y) = ((f64::from(k % 9) - 4.0) / 16.0, (f64::from(k / 9) - 3.5) / 16.0);
        if k % 9 < 5 { 4.0 * (x * x + y * y + 0.25).sqrt() } else { miss }
    };
    Image::from_cells(9, 8, (0..72).map(cell).collect())
}

fn faces(miss: u32) -> Image<u32> {
    Image::from_cells(9, 8, (0..72).map(|k| if k % 9 < 5 { 0 } else { miss }).collect())
}

fn read(folder: &Path, conventions: Conventions) -> Result<Recorded, RecordingError> {
    Recorded::read_by(folder, &wall(), Precision::F64, conventions)
}

fn passes(recorded: &Recorded) -> bool {
    let scene = wall();
    check(&GroundTruth::certified(&scene, &Silent), recorded, &Silent).passes()
}

/// A folder with ranges, and with faces if they are given.
fn folder(ranges: &Image<f64>, faces: Option<&Image<u32>>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let camera = folder.path().join("camera");
    std::fs::create_dir(&camera).unwrap();
    write_npy(camera.join("range.T.npy"), &[ranges]).unwrap();
    if let Some(faces) = faces {
        write_npy(camera.join("face.I.npy"), &[faces]).unwrap();
    }
    folder
}

fn miss(number: f64) -> Conventions {
    Conventions { miss: Some(number), ..Conventions::STANDARD }
}

/// The help of a refusal.
#[track_caller]
fn help(folder: &Path) -> String {
    read(folder, Conventions::STANDARD).expect_err("a refusal").help().expect("a line of help")
}

#[test]
fn the_ranges_of_this_test_are_right() {
    let folder = folder(&ranges(f64::INFINITY), Some(&faces(u32::MAX)));
    assert!(passes(&read(folder.path(), Conventions::STANDARD).unwrap()));
}

#[test]
fn a_number_for_no_hit_beside_faces_is_refused_with_help_and_can_be_declared() {
    for (number, word) in [(-1.0, "-1"), (0.0, "0"), (20.0, "20")] {
        let folder = folder(&ranges(number), Some(&faces(u32::MAX)));
        assert!(help(folder.path()).contains(&format!("declare --miss {word}")), "{}", help(folder.path()));
        assert!(passes(&read(folder.path(), miss(number)).unwrap()), "{word}");
        assert!(read(folder.path(), miss(7.0)).is_err(), "{word}");
    }
}

#[test]
fn a_number_for_no_hit_without_faces_can_be_declared() {
    let negative = folder(&ranges(-1.0), None);
    assert!(
        help(negative.path()).ends_with("declare --miss -1 to check, or \"miss\": -1 in its candidate.json")
    );
    assert!(passes(&read(negative.path(), miss(-1.0)).unwrap()));
    // 0 is a length; but another channel holds no number there.
    let zero = folder(&ranges(0.0), None);
    let depths = Image::from_cells(9, 8, (0..72).map(|k| if k % 9 < 5 { 2.0 } else { f64::NAN }).collect());
    write_npy(zero.path().join("camera/depth.Z.npy"), &[&depths]).unwrap();
    assert!(help(zero.path()).contains("declare --miss 0 to check, or "), "{}", help(zero.path()));
    assert!(passes(&read(zero.path(), miss(0.0)).unwrap()));
    // NaN, like +Inf, needs no declaration.
    let not_a_number = folder(&ranges(f64::NAN), None);
    for conventions in [Conventions::STANDARD, miss(f64::NAN)] {
        assert!(passes(&read(not_a_number.path(), conventions).unwrap()));
    }
    // 0 is a length like another until it is declared.
    let folder = folder(&ranges(0.0), None);
    assert!(!passes(&read(folder.path(), Conventions::STANDARD).unwrap()));
    assert!(passes(&read(folder.path(), miss(0.0)).unwrap()));
}

#[test]
fn a_declared_number_is_a_value_where_a_face_is_hit() {
    // The shortest range, of the pixels in the middle.
    let shortest = ranges(f64::INFINITY).at(4, 3);
    let folder = folder(&ranges(shortest), Some(&faces(u32::MAX)));
    assert!(passes(&read(folder.path(), miss(shortest)).unwrap()));
}

#[test]
fn faces_can_be_left_out() {
    // Face 7 does not exist, and every ray is said to hit.
    let own = Image::filled(9, 8, 7_u32);
    let folder = folder(&ranges(f64::INFINITY), Some(&own));
    let declare = "declare --no-faces to check, or \"no_faces\": true in its candidate.json";
    assert!(help(folder.path()).contains(declare), "{}", help(folder.path()));
    let recorded = read(folder.path(), Conventions { ignores_faces: true, ..Conventions::STANDARD }).unwrap();
    assert!(recorded.unknown.is_empty() && passes(&recorded));
    let scene = wall();
    let found = check(&GroundTruth::certified(&scene, &Silent), &recorded, &Silent);
    assert_eq!(found.totals()[&Quantity::Face.into()].compared(), 0);
}

#[test]
fn a_transposed_array_is_refused_with_help() {
    let cells = ranges(f64::INFINITY);
    let turned = (0..9).flat_map(|i| (0..8).map(move |j| (i, j))).map(|(i, j)| cells.at(i, j));
    let folder = folder(&Image::from_cells(8, 9, turned.collect()), None);
    assert!(help(folder.path()).contains("(rows, columns): transpose it"));
}

#[test]
fn faces_may_be_stored_as_floating_point_numbers() {
    // Any number that is not finite, -1 and 4294967295 mean "none".
    let read_faces = |face: f64, miss: f64| {
        let folder = folder(&ranges(f64::INFINITY), None);
        let cells = faces(1).cells().iter().map(|&index| if index == 1 { miss } else { face }).collect();
        write_npy(folder.path().join("camera/face.I.npy"), &[&Image::<f64>::from_cells(9, 8, cells)])
            .unwrap();
        read(folder.path(), Conventions::STANDARD)
    };
    for miss in [-1.0, 4_294_967_295.0, f64::NAN, f64::INFINITY] {
        assert!(passes(&read_faces(0.0, miss).unwrap()), "{miss}");
    }
    // The first cell is a hit, and the first miss is in column 5.
    for (face, miss, wrong, place) in [(0.5, -1.0, "0.5", (0, 0)), (0.0, -2.0, "-2", (5, 0))] {
        let RecordingError::Channel { cell, found, .. } = read_faces(face, miss).unwrap_err() else {
            panic!("a channel is at fault")
        };
        assert_eq!((found.as_str(), cell), (wrong, Some(place)));
    }
}

#[test]
fn a_folder_of_recordings_is_refused_by_their_names() {
    let parent = tempfile::tempdir().unwrap();
    let refusal = || read(parent.path(), Conventions::STANDARD).unwrap_err().to_string();
    // A folder of maps in one recording, and a file of them in another.
    let folder = parent.path().join("mine/beam-0");
    std::fs::create_dir_all(&folder).unwrap();
    assert!(refusal().contains("another folder, mine, and no maps itself"), "{}", refusal());
    std::fs::create_dir(parent.path().join("theirs")).unwrap();
    std::fs::create_dir(parent.path().join("notes")).unwrap();
    std::fs::write(parent.path().join("theirs/camera.exr"), []).unwrap();
    assert!(refusal().contains("2 recordings, mine, theirs"), "{}", refusal());
    // A text beside them is no recording.
    std::fs::write(parent.path().join("notes/camera.txt"), []).unwrap();
    assert!(refusal().contains("2 recordings, mine, theirs"), "{}", refusal());
}

#[test]
fn what_pixels_outside_the_image_show_is_looked_for_in_all_beams() {
    let wall = wall();
    let (_, mut beams) = rig::default_rig(16, DVec3::ZERO, 0.0);
    beams.iter_mut().for_each(|beam| (beam.sensor.columns, beam.sensor.rows) = (4, 1));
    let (mesh, camera) = (Arc::clone(wall.mesh()), *wall.camera());
    let scene = Scene::new(mesh, camera, beams, wall.atmosphere(), wall.flux_model()).unwrap();
    let refused = |rows: [[u32; 4]; 2]| {
        let folder = tempfile::tempdir().unwrap();
        for (beam, (rows, columns)) in rows.into_iter().zip([[0, 1, 2, 3], [5, 6, 7, 8]]).enumerate() {
            let beam = folder.path().join(format!("beam-{beam}"));
            std::fs::create_dir(&beam).unwrap();
            for (name, cells) in [("pixel.I.npy", columns), ("pixel.J.npy", rows)] {
                write_npy(beam.join(name), &[&Image::from_cells(4, 1, cells.to_vec())]).unwrap();
            }
        }
        let read = Recorded::read_by(folder.path(), &scene, Precision::F64, Conventions::STANDARD);
        format!("{:?}", read.unwrap_err())
    };
    // The second beam lands in the last row alone, which is row 7 of 8; the first one shows that none is row 0.
    let told = refused([[1, 2, 3, 4], [8; 4]]);
    assert!(told.contains("\"rows count from 0, and not from 1\""), "{told}");
    // Row 0 is there: the second beam is wrong.
    let told = refused([[0, 1, 2, 3], [8; 4]]);
    assert!(told.contains("expected") && !told.contains("count from"), "{told}");
}
