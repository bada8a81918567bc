//! The clauses of loading: a loader that breaks one fails the input pack, and the right ones pass. Cameras that are written for
//! ROS are read back as they were.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use raypencil::io::{Overrides, load, write_npy};
use raypencil::pack::{InputChecked, LoadingClause, check_input, input_faces, input_glb, write_input};
use raypencil::{Image, Mesh};
use raypencil_tests::naive_loader::{LoadedFace, LoadingFault, NaiveLoader};

fn committed() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/packs/input")
}

/// Writes the answer of a loader, and checks it against the committed pack.
fn checked(faces: &[LoadedFace]) -> InputChecked {
    let folder = tempfile::tempdir().expect("a folder");
    let corners = faces.iter().flat_map(|(corners, _)| corners.as_flattened()).copied();
    let triangles = Image::from_cells(9, faces.len() as u32, corners.collect());
    write_npy(folder.path().join("triangles.npy"), &[&triangles]).expect("a file");
    let reflectivity = faces.iter().map(|(_, reflectivity)| *reflectivity).collect();
    let reflectivity = Image::from_cells(1, faces.len() as u32, reflectivity);
    write_npy(folder.path().join("reflectivity.npy"), &[&reflectivity]).expect("a file");
    check_input(&committed(), folder.path()).expect("an answer as it should be")
}

/// The faces of a mesh, in the global frame.
fn faces_of(mesh: &Mesh) -> Vec<LoadedFace> {
    let corner = |corner: u32| {
        let offset = mesh.vertices()[corner as usize].map(f64::from);
        let origin = mesh.origin().to_array();
        std::array::from_fn(|axis| origin[axis] + offset[axis])
    };
    let faces = mesh.faces().iter().zip(mesh.face_materials());
    faces
        .map(|(face, material)| (face.map(corner), mesh.materials()[usize::from(*material)].reflectivity))
        .collect()
}

#[test]
fn our_loader_and_the_naive_one_pass() {
    let ground = committed().join("ground.glb");
    let scene = load(&ground.to_string_lossy(), &Overrides::default()).expect("a terrain").scene;
    for faces in [faces_of(scene.mesh()), NaiveLoader::faces(&input_glb(), None)] {
        let found = checked(&faces);
        assert!(found.passes(), "{}", found.document().screen());
        assert_eq!((found.given, found.faces, found.has_reflectivity), (28, 28, true));
    }
}

#[test]
fn each_wrong_loader_fails_by_the_clause_that_it_breaks() {
    let mut broken = BTreeSet::new();
    for fault in LoadingFault::ALL {
        let found = checked(&NaiveLoader::faces(&input_glb(), Some(*fault)));
        let clause = fault.clause();
        assert!(!found.passes(), "{fault:?} passes");
        // The faces of the clause itself are wrong, or there are too few or too many faces.
        let (_, wrong) = found.of(clause);
        assert!(wrong > 0 || found.given != found.faces, "{fault:?}: {}", found.document().screen());
        broken.insert(clause);
    }
    assert_eq!(broken.len(), LoadingClause::ALL.len());
}

#[test]
fn any_corner_may_be_first_and_reflectivities_may_be_left_out() {
    let mut faces = NaiveLoader::faces(&input_glb(), None);
    for (number, (corners, _)) in faces.iter_mut().enumerate() {
        corners.rotate_left(number % 3);
    }
    assert!(checked(&faces).passes());
    // A face that is seen from its other side is wrong.
    faces[3].0.swap(0, 1);
    let found = checked(&faces);
    assert_eq!(found.wrong.iter().map(|wrong| wrong.face).collect::<Vec<_>>(), [3]);

    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(committed().join("triangles.npy"), folder.path().join("triangles.npy")).expect("a copy");
    let found = check_input(&committed(), folder.path()).expect("an answer");
    assert!(found.passes() && !found.has_reflectivity);
    assert!(found.document().screen().contains("Reflectivities are not given."));
}

#[test]
fn an_answer_that_cannot_be_read_and_a_changed_pack_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |pack: &Path, words: &[&str]| {
        let said = check_input(pack, folder.path()).expect_err("no answer").to_string();
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    refused(&committed(), &["triangles.npy"]);
    write_npy(folder.path().join("triangles.npy"), &[&Image::filled(3, 28, 0.0)]).expect("a file");
    refused(&committed(), &["triangles.npy", "28 rows and 3 columns", "9 columns"]);
    write_npy(folder.path().join("triangles.npy"), &[&Image::filled(9, 28, f64::NAN)]).expect("a file");
    assert_eq!(check_input(&committed(), folder.path()).expect("an answer").wrong.len(), 28);
    write_npy(folder.path().join("reflectivity.npy"), &[&Image::filled(1, 27, 0.5)]).expect("a file");
    refused(&committed(), &["reflectivity.npy", "27 rows", "28"]);

    let pack = tempfile::tempdir().expect("a folder");
    write_input(pack.path()).expect("a pack");
    let ground = pack.path().join("ground.glb");
    let mut bytes = fs::read(&ground).expect("a file");
    *bytes.last_mut().expect("bytes") ^= 1;
    fs::write(&ground, bytes).expect("a file");
    refused(pack.path(), &["ground.glb", "SHA-256", "as this version writes it"]);
}

#[test]
fn the_committed_pack_is_what_the_command_writes() {
    let folder = tempfile::tempdir().expect("a folder");
    write_input(folder.path()).expect("a pack");
    for name in ["ground.glb", "triangles.npy", "reflectivity.npy", "input.json"] {
        let read = |folder: &Path| fs::read(folder.join(name)).expect("a file");
        assert!(read(folder.path()) == read(&committed()), "{name} differs");
    }
}

#[test]
fn each_clause_has_a_face_and_a_row_on_the_page_of_the_contract() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/theory/contract.md");
    let page = fs::read_to_string(page).expect("the page");
    let faces = input_faces();
    for clause in LoadingClause::ALL {
        let has_face = faces.iter().any(|face| face.clause == *clause);
        assert!(has_face || *clause == LoadingClause::Scene, "{clause:?}");
        let faults = LoadingFault::ALL.iter().filter(|fault| fault.clause() == *clause);
        let faults: Vec<String> = faults.map(|fault| format!("{fault:?}")).collect();
        let row = format!("| `{}` | {} | {} |", clause.key(), clause.sentence(), faults.join(", "));
        assert!(page.contains(&row), "docs/theory/contract.md lacks the row\n{row}");
    }
}

/// Each ray of the camera that is read back is the ray that was written, but for the rounding of fx, cx and one product.
#[test]
fn a_camera_that_is_written_for_ros_is_read_back() {
    let folder = tempfile::tempdir().expect("a folder");
    for keys in [
        "width_px = 640\nheight_px = 480",
        "width_px = 64\nheight_px = 48\nfocal_length_mm = 3.3\npixel_pitch_um = [2.2, 4.7]",
        "width_px = 64\nheight_px = 48\nfocal_length_mm = 5\nprincipal_point_px = [12.3, 70.1]",
        "width_px = 64\nheight_px = 48\nfield_of_view_deg = [71, 20]",
    ] {
        let load_camera = |keys: &str| {
            let file = folder.path().join("scene.toml");
            fs::write(&file, format!("version = 1\n[camera]\n{keys}\n")).expect("a file");
            load(&file.to_string_lossy(), &Overrides::default()).expect("a scene").scene.camera().sensor
        };
        let written = load_camera(keys);
        let text = raypencil::drive::camera_info(&written, "left: \"one\"");
        fs::write(folder.path().join("left.yaml"), text).expect("a file");
        let read = load_camera("camera_info = \"left.yaml\"");
        assert_eq!((read.width, read.height), (written.width, written.height));
        for j in (0..written.height).step_by(5) {
            for i in (0..written.width).step_by(7) {
                let [one, other] = [&written, &read].map(|camera| {
                    let ray = camera.direction(i, j);
                    [ray.x / ray.z, ray.y / ray.z]
                });
                for axis in [0, 1] {
                    // fx = f / p is rounded once, f = fx p' and p' = f / fy once each; then a product and a quotient of the
                    // ray on either side: eight roundings of half an ulp, and cx moves by half an ulp twice.
                    let scale = one[axis].abs().max(written.pixel_pitch[axis] / written.focal_length);
                    let bound = 8.0 * f64::EPSILON * scale;
                    assert!((one[axis] - other[axis]).abs() <= bound, "{keys}: {i}, {j}: {one:?} {other:?}");
                }
            }
        }
    }
}
