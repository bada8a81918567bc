//! Scenes on meshes of any format: alone, in a scene file, and with axes and a unit of their own.

use std::fs;
use std::path::PathBuf;

use raypencil_files::{combined_sha256_hex, hex_digits, sha256};
use raypencil_scene_io::{
    Grounds, LoadedScene, Overrides, SceneIoError, SceneSource, Setting, load, load_ray_scene, load_sharing,
    write_resolved,
};
use tempfile::TempDir;

/// A level floor of 20 m by 20 m at a height of 2 m, in millimetres and with y up: in the file x runs from -10 m to 10 m, z
/// from -4 m to 16 m. On the ground y is -z: from -16 m to 4 m.
const FLOOR_MM: &str =
    "v -10000 2000 -4000\nv -10000 2000 16000\nv 10000 2000 16000\nv 10000 2000 -4000\nf 1 2 3 4\n";

/// A floor of metres with z up.
const FLOOR_M: &str = "v -10 -16 2\nv 10 -16 2\nv 10 4 2\nv -10 4 2\nf 1 2 3 4\n";

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("mm.obj"), FLOOR_MM).unwrap();
    fs::write(folder.path().join("m.obj"), FLOOR_M).unwrap();
    folder
}

/// Loads a scene file with this `[terrain]`.
fn with(folder: &TempDir, terrain: &str) -> Result<LoadedScene, SceneIoError> {
    let path = scene_file(folder, terrain, "");
    load(path.to_str().unwrap(), &Overrides::default())
}

fn scene_file(folder: &TempDir, terrain: &str, more: &str) -> PathBuf {
    let path = folder.path().join("scene.toml");
    fs::write(&path, format!("version = 1\n[terrain]\n{terrain}\n{more}")).unwrap();
    path
}

fn settings(texts: &[&str]) -> Overrides {
    let settings = texts.iter().map(|text| Setting::parse(text).unwrap()).collect();
    Overrides { settings, ..Overrides::default() }
}

#[test]
fn a_mesh_alone_gets_the_default_rig_in_its_middle() {
    let folder = folder();
    let path = folder.path().join("m.obj");
    let loaded = load(path.to_str().unwrap(), &Overrides::default()).unwrap();
    assert_eq!(loaded.source, SceneSource::Mesh(path));
    assert_eq!(loaded.name, "m");
    assert_eq!(loaded.vehicle.position.to_array(), [0.0, -6.0, 2.0]);
    assert_eq!(loaded.scene.mesh().materials()[0].reflectivity, 0.25);
    // The digest of a lone file is that of the file.
    assert_eq!(loaded.source_sha256, hex_digits(&sha256(FLOOR_M.as_bytes())));
    for (name, bytes) in [("m.ply", ply()), ("m.stl", stl())] {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let other = load(path.to_str().unwrap(), &Overrides::default()).unwrap();
        // The corners of STL and the fan of OBJ are the same vertices in the same order.
        assert_eq!(other.scene_sha256, loaded.scene_sha256, "{name}");
    }
}

/// The floor of metres as PLY.
fn ply() -> Vec<u8> {
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    format!("{header}-10 -16 2\n10 -16 2\n10 4 2\n-10 4 2\n4 0 1 2 3\n").into_bytes()
}

/// The floor of metres as STL.
fn stl() -> Vec<u8> {
    let facet = |corners: [&str; 3]| {
        let corners = corners.map(|corner| format!("vertex {corner}\n")).concat();
        format!("facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let [a, b, c, d] = ["-10 -16 2", "10 -16 2", "10 4 2", "-10 4 2"];
    format!("solid\n{}{}endsolid\n", facet([a, b, c]), facet([a, c, d])).into_bytes()
}

#[test]
fn axes_and_unit_of_a_scene_file_hold() {
    let folder = folder();
    let loaded = with(&folder, "file = \"mm.obj\"\nup = \"y\"\nscale = 0.001\nreflectivity = 0.5").unwrap();
    let mesh = loaded.scene.mesh();
    // Corner 0: (-10, 2, -4) m with y up is (-10, 4, 2).
    assert_eq!(mesh.vertices()[0], [-10.0, 4.0, 2.0]);
    assert_eq!(mesh.materials()[0].reflectivity, 0.5);
    assert_eq!(loaded.vehicle.position.to_array(), [0.0, 0.0, 2.0]);
    // As the same words of the command line, on the mesh alone. The vehicle then stands in the middle of the ground.
    let path = folder.path().join("mm.obj");
    let words = ["terrain.up=y", "terrain.scale=0.001", "terrain.reflectivity=0.5"];
    let alone = load(path.to_str().unwrap(), &settings(&words)).unwrap();
    assert_eq!(alone.scene.mesh(), mesh);
    assert_eq!(alone.vehicle.position.to_array(), [0.0, -6.0, 2.0]);
    // Another ground in its place takes neither.
    let path = scene_file(&folder, "file = \"mm.obj\"\nup = \"y\"\nscale = 0.001", "");
    let builtin = load(path.to_str().unwrap(), &settings(&["terrain.builtin=pyramids"])).unwrap();
    assert_eq!(builtin.scene_sha256, load("pyramids", &Overrides::default()).unwrap().scene_sha256);
    // But another file does, such as each of a campaign's.
    fs::copy(folder.path().join("mm.obj"), folder.path().join("other.obj")).unwrap();
    let other = load(path.to_str().unwrap(), &settings(&["terrain.file=other.obj"])).unwrap();
    assert_eq!(other.scene.mesh().vertices(), mesh.vertices());
}

#[test]
fn identities_depend_on_axes_and_unit() {
    let folder = folder();
    let scenes: Vec<LoadedScene> = [
        "file = \"m.obj\"",
        "file = \"m.obj\"\nup = \"z\"",
        "file = \"m.obj\"\nscale = 0.5",
        "file = \"m.obj\"\nscale = 1.0",
    ]
    .iter()
    .map(|terrain| with(&folder, terrain).unwrap())
    .collect();
    // The numbers: z up and a scale of 1 change none.
    assert_eq!(scenes[0].scene_sha256, scenes[1].scene_sha256);
    assert_eq!(scenes[0].scene_sha256, scenes[3].scene_sha256);
    assert_ne!(scenes[0].scene_sha256, scenes[2].scene_sha256);
    // The input: each file is another one, and the terrain's digest follows that of the scene file.
    for (index, scene) in scenes.iter().enumerate() {
        assert!(scenes[..index].iter().all(|other| other.source_sha256 != scene.source_sha256));
    }
    let text = fs::read(folder.path().join("scene.toml")).unwrap();
    let parts = [sha256(&text), sha256(FLOOR_M.as_bytes())];
    assert_eq!(scenes[3].source_sha256, combined_sha256_hex(&parts));
    // A ground that scenes share is not taken for one of another unit.
    let grounds = Grounds::new(2);
    let shared = |words: &[&str]| {
        let path = folder.path().join("m.obj");
        load_sharing(path.to_str().unwrap(), &settings(words), &grounds).unwrap().scene.mesh().vertices()[0]
    };
    assert_eq!(shared(&[]), [-10.0, -16.0, 2.0]);
    assert_eq!(shared(&["terrain.scale=2"]), [-20.0, -32.0, 4.0]);
}

#[test]
fn a_resolved_scene_holds_the_turned_and_scaled_numbers() {
    let folder = folder();
    let loaded = with(&folder, "file = \"mm.obj\"\nup = \"y\"\nscale = 0.001").unwrap();
    let path = folder.path().join("resolved.toml");
    write_resolved(&path, &loaded.scene, "resolved.glb").unwrap();
    let back = load(path.to_str().unwrap(), &Overrides::default()).unwrap();
    assert_eq!(back.scene_sha256, loaded.scene_sha256);
    assert_eq!(back.scene.mesh().vertices()[0], [-10.0, 4.0, 2.0]);
}

#[test]
fn rays_alone_are_cast_on_the_turned_and_scaled_triangles() {
    let folder = folder();
    let rays = "[vehicle]\nposition_m = [1, -2]\n[[rays]]\nname = \"down\"\n\
                spinning = { elevations_deg = [-90], steps = 1 }\n";
    let path = scene_file(&folder, "file = \"mm.obj\"\nup = \"y\"\nscale = 0.001", rays);
    let scene = load_ray_scene(&path, &[]).unwrap();
    assert_eq!(scene.triangles.vertices()[1], [-10.0, -16.0, 2.0]);
    // The vehicle stands on the floor.
    assert_eq!(scene.sets[0].set.rays()[0].origin.to_array(), [1.0, -2.0, 2.0]);
    // Without the keys the numbers of the file stay as they are.
    let path = scene_file(&folder, "file = \"mm.obj\"", &rays.replace("[1, -2]", "[1, -2, 5]"));
    assert_eq!(load_ray_scene(&path, &[]).unwrap().triangles.vertices()[1], [-10000.0, 2000.0, 16000.0]);
}

#[test]
fn what_is_wrong_is_marked_or_named() {
    let folder = folder();
    let refused = |terrain: &str, words: &[&str]| {
        let error = with(&folder, terrain).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let file = "file = \"m.obj\"\n";
    refused(
        &format!("{file}up = \"x\""),
        &["scene.toml:4:6", "`terrain.up` is \"x\"; expected one of \"y\", \"z\""],
    );
    for (value, said) in [("0", "0"), ("-1", "-1"), ("nan", "NaN"), ("1e7", "10000000"), ("1e-7", "1e-7")] {
        let found =
            format!("`terrain.scale` is {said}; expected 1e-6 to 1000000 metres for each unit of the file");
        refused(&format!("{file}scale = {value}"), &["scene.toml:4:9", &found]);
    }
    let only = "is given; expected it only with `file`";
    refused("builtin = \"pyramids\"\nup = \"y\"", &["scene.toml:4:6", "`terrain.up`", only]);
    refused("builtin = \"pyramids\"\nscale = 2", &["scene.toml:4:9", "`terrain.scale`", only]);
    fs::write(folder.path().join("bad.stl"), "solid\nfacet\n").unwrap();
    refused("file = \"bad.stl\"", &["bad.stl: line 2", "expected `normal`"]);
    refused(
        "file = \"m.off\"",
        &["scene.toml:3:8", "expected a file that ends in .glb, .gltf, .stl, .obj or .ply"],
    );
}
