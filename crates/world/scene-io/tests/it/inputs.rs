//! The files that decide a scene: each of them, and no other.

use std::collections::BTreeSet;
use std::path::Path;

use raypencil_files::{write_npy, write_npy_numbers};
use raypencil_scene::Image;
use raypencil_scene_io::{InputFile, SceneInputs, Setting};

/// A scene that names a file wherever it can.
const SCENE: &str = "version = 1
[camera]
camera_info = \"left.yaml\"
[terrain]
file = \"g.gltf\"
[drive]
waypoints_m = [[1, 0]]
sensor = \"ccd_1989\"
[drive.optics]
blurs = [{ kernel = \"blur.npy\" }]
[[rays]]
name = \"a\"
file = \"rays.csv\"
times_file = \"t.npy\"
poses_file = \"w.tum\"
";

const CALIBRATION: &str = "image_width: 640\nimage_height: 480\ndistortion_model: plumb_bob\n\
    camera_matrix: {rows: 3, cols: 3, data: [600, 0, 300, 0, 480, 250, 0, 0, 1]}\n\
    distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n\
    projection_matrix: {rows: 3, cols: 4, data: [500, 0, 320, 0, 0, 500, 240, 0, 0, 0, 1, 0]}\n";

/// Writes the scene and all that it names. Every number may be another one.
fn write(folder: &Path, number: f64) -> Vec<&'static str> {
    let path = |name: &str| folder.join(name);
    let text = |name: &str, text: &str| std::fs::write(path(name), text).unwrap();
    text("scene.toml", &format!("{SCENE}start_s = {number}\n"));
    text("left.yaml", &format!("{CALIBRATION}# {number}\n"));
    let buffers = "[{\"uri\":\"a.bin\",\"byteLength\":4},{\"uri\":\"sub/b%20c.bin\",\"byteLength\":4}]";
    text(
        "g.gltf",
        &format!("{{\"asset\":{{\"version\":\"2.0\",\"copyright\":\"{number}\"}},\"buffers\":{buffers}}}"),
    );
    text("a.bin", &format!("a {number}"));
    text("sub/b c.bin", &format!("b {number}"));
    write_npy(path("blur.npy"), &[&Image::from_cells(3, 1, vec![1.0, number, 1.0])]).unwrap();
    text("rays.csv", &format!("0,0,0,0,{number},-1\n0,0,0,1,0,0\n"));
    write_npy_numbers(path("t.npy"), &[2], &[10.0, 10.0 + number]).unwrap();
    text("w.tum", &format!("0 0 0 {number} 0 0 0 1\n1000 8 0 5 0 0 0 1\n"));
    vec![
        "scene.toml",
        "left.yaml",
        "blur.npy",
        "rays.csv",
        "t.npy",
        "w.tum",
        "g.gltf",
        "a.bin",
        "sub/b c.bin",
    ]
}

fn inputs(scene: &Path, settings: &[&str]) -> Vec<InputFile> {
    let settings: Vec<Setting> = settings.iter().map(|setting| Setting::parse(setting).unwrap()).collect();
    SceneInputs::new().of(&scene.display().to_string(), &settings).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn each_file_that_a_scene_names_decides_it() {
    let [folder, other] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    for folder in [&folder, &other] {
        std::fs::create_dir(folder.path().join("sub")).unwrap();
    }
    let names = write(folder.path(), 0.5);
    write(other.path(), 0.25);
    let scene = folder.path().join("scene.toml");
    let before = inputs(&scene, &[]);
    let found: BTreeSet<&str> = before.iter().map(|input| input.name.as_str()).collect();
    assert_eq!(found, names.iter().copied().collect());
    // What lies beside them decides nothing.
    std::fs::write(folder.path().join("g.mtl"), "Kd 1 1 1").unwrap();
    assert_eq!(inputs(&scene, &[]), before);
    for name in names {
        let was = std::fs::read(folder.path().join(name)).unwrap();
        std::fs::copy(other.path().join(name), folder.path().join(name)).unwrap();
        let now = inputs(&scene, &[]);
        let changed: Vec<&str> = before
            .iter()
            .zip(&now)
            .filter(|(was, now)| was != now)
            .map(|(was, _)| was.name.as_str())
            .collect();
        assert_eq!(changed, [name]);
        std::fs::write(folder.path().join(name), was).unwrap();
    }
    assert_eq!(inputs(&scene, &[]), before);
    // The same elsewhere: names are those of the scene.
    std::fs::create_dir(other.path().join("copy")).unwrap();
    std::fs::create_dir(other.path().join("copy/sub")).unwrap();
    write(&other.path().join("copy"), 0.5);
    assert_eq!(inputs(&other.path().join("copy/scene.toml"), &[]), before);
}

#[test]
fn grounds_of_settings_and_grounds_alone_decide_too() {
    let folder = super::dem::folder();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("scene.toml"), "version = 1\n").unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(path("g.obj"), format!("mtllib g.mtl\n{obj}")).unwrap();
    std::fs::write(path("g.mtl"), "newmtl a\n").unwrap();
    let names = |scene: &str, settings: &[&str]| -> Vec<String> {
        inputs(&path(scene), settings).into_iter().map(|input| input.name).collect()
    };
    assert_eq!(names("scene.toml", &[]), ["scene.toml"]);
    assert_eq!(names("scene.toml", &["terrain.file=g.obj"]), ["scene.toml", "g.obj"]);
    assert_eq!(names("scene.toml", &["terrain.dem=dem.tif"]), ["scene.toml", "dem.tif"]);
    let coarse = ["terrain.generate.preset=smooth", "terrain.generate.coarse=dem.tif"];
    assert_eq!(names("scene.toml", &coarse), ["scene.toml", "dem.tif"]);
    assert_eq!(names("g.obj", &[]), ["g.obj"]);
    assert_eq!(names("g.obj", &["camera.pitch_down_deg=20"]), ["g.obj"]);
    assert_eq!(names("dem.tif", &[]), ["dem.tif"]);
    assert_eq!(SceneInputs::new().of("pyramids", &[]).unwrap(), []);
    // A resolved scene names its ground.
    let loaded = super::load_path(&path("g.obj"), &Default::default()).unwrap();
    raypencil_scene_io::write_resolved(path("resolved.toml"), &loaded.scene, "r.glb").unwrap();
    assert_eq!(names("resolved.toml", &[]), ["resolved.toml", "r.glb"]);
    // A ground that is not there is refused, as it is when it is loaded.
    let error = SceneInputs::new()
        .of(&path("scene.toml").display().to_string(), &[Setting::parse("terrain.file=no.obj").unwrap()])
        .unwrap_err();
    assert!(error.to_string().contains("there is no file"), "{error}");
}
