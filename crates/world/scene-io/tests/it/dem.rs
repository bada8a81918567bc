//! Scenes on elevation models: alone, and named in a scene file.

use super::tiff::Tiff;
use super::tiff::Values::Double;
use raypencil_mesh_io::{read_dem, write_terrain_glb};
use raypencil_scene_io::{LoadedScene, Overrides, SceneIoError, SceneSource, load};

/// A folder with `dem.tif`, 41 x 31 posts 1 m apart whose pixels are areas: x from 100.5 to 140.5, y from 169.5 to
/// 199.5, level but for a step of 2 m at x = 130.
pub(crate) fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut tiff = Tiff::plain()
        .tag(33550, Double(vec![1.0, 1.0, 0.0]))
        .tag(33922, Double(vec![0.0, 0.0, 0.0, 100.0, 200.0, 0.0]));
    (tiff.size, tiff.block) = ([41, 31], vec![16, 16]);
    tiff.with(|column, _| if column < 30 { 1.0 } else { 3.0 }).write(folder.path());
    folder
}

fn load_text(folder: &tempfile::TempDir, terrain: &str) -> Result<LoadedScene, SceneIoError> {
    let path = folder.path().join("scene.toml");
    let text = format!("version = 1\n[vehicle]\nposition_m = [120, 180]\n[terrain]\n{terrain}\n");
    std::fs::write(&path, text).unwrap();
    load(path.to_str().unwrap(), &Overrides::default())
}

#[test]
fn a_model_alone_gets_the_default_rig_in_its_middle() {
    let folder = folder();
    let path = folder.path().join("dem.tif");
    let loaded = load(path.to_str().unwrap(), &Overrides::default()).unwrap();
    assert_eq!(loaded.source, SceneSource::Dem(path.clone()));
    assert_eq!(loaded.name, "dem");
    // The middle of x 100.5 to 140.5 and y 169.5 to 199.5, on the ground at 1 m.
    assert_eq!(loaded.vehicle.position.to_array(), [120.5, 184.5, 1.0]);
    assert_eq!(loaded.scene.mesh().faces().len(), 2 * 40 * 30);
    assert_eq!(loaded.scene.mesh().materials()[0].reflectivity, 0.25);
    // Imported as a terrain it gives the same scene.
    let glb = folder.path().join("dem.glb");
    let mesh = read_dem(&path, None).unwrap().mesh(None, 0.25).unwrap();
    write_terrain_glb(&glb, &mesh, &serde_json::json!({})).unwrap();
    let imported = load(glb.to_str().unwrap(), &Overrides::default()).unwrap();
    assert_eq!(imported.scene_sha256, loaded.scene_sha256);
    // A lone file has its own digest.
    use sha2::Digest;
    let sha = sha2::Sha256::digest(std::fs::read(&path).unwrap());
    assert_eq!(loaded.source_sha256, sha.iter().map(|byte| format!("{byte:02x}")).collect::<String>());
}

#[test]
fn a_scene_file_chooses_a_part_and_a_bound() {
    let folder = folder();
    let all = load_text(&folder, "dem = \"dem.tif\"\nreflectivity = 0.5").unwrap();
    assert_eq!(all.scene.mesh().faces().len(), 2 * 40 * 30);
    assert_eq!(all.scene.mesh().materials()[0].reflectivity, 0.5);
    assert_eq!(all.vehicle.position.z, 1.0);
    // x 110.5 to 135.5 and y 175.5 to 190.5: 26 x 16 posts.
    let window = "dem = \"dem.tif\"\ndem_window_m = [110, 175, 26, 16]";
    let part = load_text(&folder, window).unwrap();
    assert_eq!(part.scene.mesh().faces().len(), 2 * 25 * 15);
    // Level ground needs few faces, but keeps its step.
    let simple = load_text(&folder, &format!("{window}\ndem_max_error_m = 0.01")).unwrap();
    assert!(simple.scene.mesh().faces().len() < 300, "{}", simple.scene.mesh().faces().len());
    for (x, z) in [(129.5, 1.0), (130.5, 3.0)] {
        assert_eq!(raypencil_terrain::height_at(simple.scene.mesh(), x, 180.5), Some(z));
    }
    // The digests cover the window and the bound, and the file itself.
    let mut digests = vec![all.source_sha256, part.source_sha256, simple.source_sha256.clone()];
    let path = folder.path().join("dem.tif");
    let mut bytes = std::fs::read(&path).unwrap();
    bytes.push(0);
    std::fs::write(&path, bytes).unwrap();
    let longer = load_text(&folder, &format!("{window}\ndem_max_error_m = 0.01")).unwrap();
    assert_eq!(longer.scene_sha256, simple.scene_sha256);
    digests.push(longer.source_sha256);
    digests.sort();
    digests.dedup();
    assert_eq!(digests.len(), 4);
}

#[test]
fn keys_that_are_wrong_are_marked() {
    let folder = folder();
    for (terrain, marked, message) in [
        (
            "dem = \"a.glb\"",
            "\"a.glb\"",
            "`terrain.dem` is \"a.glb\"; expected a file that ends in .tif or .tiff",
        ),
        ("dem = \"no.tif\"", "\"no.tif\"", "`terrain.dem`: there is no file"),
        (
            "builtin = \"facets\"\ndem = \"dem.tif\"",
            "\"dem.tif\"",
            "`terrain.dem` is one ground too many; expected exactly one of `builtin`, `file`, `dem` and `generate`",
        ),
        (
            "builtin = \"facets\"\ndem_window_m = [0, 0, 1, 1]",
            "[0, 0, 1, 1]",
            "`terrain.dem_window_m` is given; expected it only with `dem`",
        ),
        (
            "file = \"a.glb\"\ndem_max_error_m = 1",
            "1",
            "`terrain.dem_max_error_m` is given; expected it only with",
        ),
        (
            "dem = \"dem.tif\"\ndem_window_m = [1, 2, 3]",
            "[1, 2, 3]",
            "`terrain.dem_window_m` has 3 numbers; expected 4",
        ),
        (
            "dem = \"dem.tif\"\ndem_window_m = [1, 2, 0, 4]",
            "[1, 2, 0, 4]",
            "`terrain.dem_window_m` is 0; expected 0.001 to 1e9 metres, for a width and a height",
        ),
        (
            "dem = \"dem.tif\"\ndem_max_error_m = 0",
            "0",
            "`terrain.dem_max_error_m` is 0; expected 1e-6 to 1000000 metres",
        ),
        ("dem = 5", "5", "the number 5; expected a text in quotes"),
        (
            "builtin = \"facets\"\ndem_nodata = -9999",
            "-9999",
            "`terrain.dem_nodata` is given; expected it only with `dem`",
        ),
        (
            "dem = \"dem.tif\"\ndem_nodata = \"nothing\"",
            "\"nothing\"",
            "`terrain.dem_nodata` is \"nothing\"; expected the samples of unknown heights, such as -9999, or none",
        ),
        (
            "dem = \"dem.tif\"\ndem_unit = \"feet\"",
            "\"feet\"",
            "`terrain.dem_unit` is \"feet\"; expected m, km, cm, mm, ft (0.3048 m)",
        ),
        ("dem = \"dem.tif\"\ndem_z_unit = 9102", "9102", "`terrain.dem_z_unit` is \"9102\"; expected m, km"),
        ("dem = \"dem.tif\"\ndem_nodata = [1]", "[1]", "expected a number, or a text in quotes"),
    ] {
        match load_text(&folder, terrain) {
            Err(SceneIoError::Toml(problem)) => {
                assert_eq!(problem.marked(), marked, "{problem}");
                assert_names(&problem.message, &[message]);
            }
            other => panic!("{terrain}: {other:?}"),
        }
    }
    // A fault of the model names the model's file.
    let message =
        load_text(&folder, "dem = \"dem.tif\"\ndem_window_m = [0, 0, 1, 1]").unwrap_err().to_string();
    assert_names(&message, &["dem.tif: window: no post in x 0 to 1", "posts of x 100.5 to 140.5"]);
}

#[test]
fn a_scene_file_says_what_the_model_does_not() {
    let folder = folder();
    let metres = load_text(&folder, "dem = \"dem.tif\"").unwrap();
    // A map in units of 9001 and heights in international feet: 0.3048 m and 0.9144 m, as single precision has them.
    let feet = load_text(&folder, "dem = \"dem.tif\"\ndem_unit = 9001\ndem_z_unit = \"ft\"").unwrap();
    let heights = |scene: &LoadedScene| {
        let z = scene.scene.mesh().origin().z;
        [120.5, 135.5]
            .map(|x| (raypencil_terrain::height_at(scene.scene.mesh(), x, 180.5).unwrap() - z) as f32)
    };
    assert_eq!(heights(&metres), [1.0, 3.0]);
    assert_eq!(heights(&feet), [0.3048, 0.9144]);
    // The step is no ground if its upper level is not known; the same by a setting.
    let lower = load_text(&folder, "dem = \"dem.tif\"\ndem_nodata = 3").unwrap();
    assert_eq!(lower.scene.mesh().faces().len(), 2 * 29 * 30);
    let settings = vec![raypencil_scene_io::Setting::parse("terrain.dem_nodata=3").unwrap()];
    let alone = folder.path().join("dem.tif");
    let set = load(alone.to_str().unwrap(), &Overrides { settings, ..Overrides::default() }).unwrap();
    assert_eq!(set.scene.mesh().faces().len(), 2 * 29 * 30);
}

fn assert_names(message: &str, words: &[&str]) {
    for word in words {
        assert!(message.contains(word), "{message}\nhas no {word:?}");
    }
}
