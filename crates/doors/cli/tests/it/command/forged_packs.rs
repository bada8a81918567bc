//! Packs that were changed and sealed anew, and folders that only look like packs.

use std::fs;
use std::path::Path;

use raypencil::Image;
use raypencil::io::{Limits, Raster, file_sha256_hex, read_exr, read_npy, write_exr, write_npy};
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen};

const SCENE: &str = "version = 1\n[camera]\nwidth_px = 12\nheight_px = 8\npixel_pitch_um = 800\npitch_down_deg = \
                     40\n[terrain]\nbuiltin = \"pyramids\"\n[[beam]]\ncolumns = 16\nrows = 2\n";

/// A folder with the pack `pack`, and `right`: the same again, as a candidate.
fn packed() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    for name in ["pack", "right"] {
        screen(folder.path(), &["pack", "scene.toml", "--no-bench", "-o", name], 0);
    }
    folder
}

/// Writes the digests of a pack's files anew.
fn seal(pack: &Path) {
    let path = pack.join("manifest.json");
    let mut manifest: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    for file in manifest["files"].as_array_mut().unwrap() {
        let (bytes, sha256) = file_sha256_hex(&pack.join(file["path"].as_str().unwrap())).unwrap();
        file["bytes"] = bytes.into();
        file["sha256"] = sha256.into();
    }
    fs::write(path, manifest.to_string()).unwrap();
}

/// Changes the manifest of a pack.
fn with_manifest(pack: &Path, change: impl FnOnce(&mut serde_json::Value)) {
    let path = pack.join("manifest.json");
    let mut manifest: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    change(&mut manifest);
    fs::write(path, manifest.to_string()).unwrap();
}

/// Writes numbers of a channel in place of a pack's own, as NPY and rounded as EXR.
fn write_channel(pack: &Path, sensor: &str, channel: &str, (width, height): (u32, u32), cells: Vec<f64>) {
    let path = pack.join(format!("{sensor}.exr"));
    let mut exr = read_exr(&path, &Limits::default()).unwrap();
    assert!(exr.channels.contains_key(channel), "{channel}");
    let singles = cells.iter().map(|cell| *cell as f32).collect();
    exr.insert(channel, Raster::F32(Image::from_cells(width, height, singles)));
    write_exr(&path, &exr).unwrap();
    let path = pack.join(sensor).join(format!("{channel}.npy"));
    write_npy(path, &[&Image::from_cells(width, height, cells)]).unwrap();
    seal(pack);
}

/// Changes one range by one part in a thousand, where it is a number; returns whether it was.
fn forge(pack: &Path, cell: usize) -> bool {
    let (width, height, mut cells) = cells(&pack.join("camera/range.T.npy"));
    if !cells[cell].is_finite() {
        return false;
    }
    cells[cell] *= 1.001;
    write_channel(pack, "camera", "range.T", (width, height), cells);
    true
}

#[test]
fn no_right_renderer_is_wrong_by_a_changed_answer() {
    let mut forged = 0;
    let whole = packed();
    let folder = whole.path();
    let original = ["camera/range.T.npy", "camera.exr"]
        .map(|name| (folder.join("pack").join(name), fs::read(folder.join("pack").join(name)).unwrap()));
    for cell in (0..96).step_by(7) {
        original.iter().for_each(|(path, bytes)| fs::write(path, bytes).unwrap());
        if !forge(&folder.join("pack"), cell) {
            continue;
        }
        forged += 1;
        // Who copies the changed answer is found, too.
        for candidate in ["right", "pack"] {
            let output = raypencil(folder, &["check", "pack", candidate]);
            assert_trouble(&output, &["its answer to camera", "is not the referee's"]);
        }
    }
    assert!(forged > 5, "{forged}");
}

/// What a manifest says beside the answers follows from the scene, too, and each answer stands twice.
#[test]
fn a_manifest_that_says_what_is_not_so_is_refused() {
    let whole = packed();
    let folder = whole.path();
    let pack = folder.join("pack");
    let manifest = fs::read(pack.join("manifest.json")).unwrap();
    let refused = |change: &dyn Fn(&mut serde_json::Value), words: &[&str]| {
        with_manifest(&pack, change);
        assert_trouble(&raypencil(folder, &["check", "pack", "right"]), words);
        fs::write(pack.join("manifest.json"), &manifest).unwrap();
    };
    refused(
        &|of| of["clauses"][0]["rays"] = 77.into(),
        &["manifest.json: clauses[0]", "decides 77 rays; expected"],
    );
    refused(&|of| of["clauses"] = serde_json::json!([]), &["clauses[0]", "no count; expected"]);
    refused(&|of| _ = of["clauses"].as_array_mut().unwrap().pop(), &["manifest.json: clauses: "]);
    refused(&|of| of["clauses"][1]["clause"] = "always-right".into(), &["clauses: ", "always-right"]);
    refused(
        &|of| of["fluxModel"] = "eq1".into(),
        &["fluxModel: Eq1; expected Radiometric, as the scene has"],
    );
    refused(
        &|of| of["files"][4]["channels"][0]["unit"] = "km".into(),
        &["files[4]", "unit \"km\"", "expected"],
    );
    refused(&|of| of["files"][4]["channels"][0]["name"] = "best.T".into(), &["files[4]", "best.T"]);
    refused(&|of| of["sensors"][1]["name"] = "lidar".into(), &["sensors[1]: \"lidar\"", "beam-0"]);
    refused(
        &|of| {
            of["sharpness"] =
                serde_json::json!([{ "slack": "shift-right", "unit": "of a cell", "f64": 1e-15 }])
        },
        &["sharpness: 1 sizes; expected none: there is no bench"],
    );
    let no_maps = |of: &mut serde_json::Value| {
        of["files"].as_array_mut().unwrap().retain(|file| file["path"] != "camera.exr");
    };
    refused(&no_maps, &["of camera in an EXR file that manifest.json lists; expected"]);
    let no_map_at_all = |of: &mut serde_json::Value| {
        of["files"]
            .as_array_mut()
            .unwrap()
            .retain(|file| !file["path"].as_str().is_some_and(|path| path.ends_with(".exr")));
    };
    refused(&no_map_at_all, &["no EXR file with answers that manifest.json lists; expected"]);
    // It calls itself what is published.
    let is_hard = |of: &mut serde_json::Value| {
        of["scene"]["name"] = "hard".into();
        of["version"] = "2.0.0".into();
    };
    refused(
        &is_hard,
        &["says that it is hard 2.0.0, and has the digest", "as it is published, or another version"],
    );
    // A map without one of its channels, and one that says something else than the arrays.
    let path = pack.join("camera.exr");
    let original = fs::read(&path).unwrap();
    let changed = |change: &dyn Fn(&mut raypencil::io::ExrMap), words: &[&str]| {
        let mut exr = read_exr(&path, &Limits::default()).unwrap();
        change(&mut exr);
        write_exr(&path, &exr).unwrap();
        seal(&pack);
        assert_trouble(&raypencil(folder, &["check", "pack", "right"]), words);
        fs::write(&path, &original).unwrap();
    };
    changed(&|exr| _ = exr.channels.remove("range.T"), &["no range of camera in an EXR file"]);
    let farther = |exr: &mut raypencil::io::ExrMap| {
        let cells = exr.channels["range.T"].as_f32().unwrap().cells().iter().map(|cell| 2.0 * cell).collect();
        exr.insert("range.T", Raster::F32(Image::from_cells(12, 8, cells)));
    };
    changed(&farther, &["channel \"camera/range.T\", cell", "to within half an ulp, as in"]);
    seal(&pack);
    let shown = screen(folder, &["check", "pack", "right"], 0);
    assert!(shown.contains("(By a pack that is not published: sha256 "), "{shown}");
}

/// The numbers of a file of one channel, with its columns and rows.
fn cells(path: &Path) -> (u32, u32, Vec<f64>) {
    let array = read_npy(path, &Limits::default()).unwrap().planes.remove(0);
    let (width, height) = array.size();
    (width, height, (0..(width * height) as usize).map(|index| array.real(index)).collect())
}

/// A candidate without pencils is judged by the pack's pencils, whose sum a pixel is.
#[test]
fn no_right_image_is_wrong_by_a_changed_pencil() {
    let whole = packed();
    let folder = whole.path();
    let pack = folder.join("pack");
    let (of_pencils, of_pixels) = (pack.join("beam-0/flux.V.npy"), pack.join("camera/flux.beam0.npy"));
    fs::create_dir_all(folder.join("image/camera")).unwrap();
    fs::copy(&of_pixels, folder.join("image/camera/flux.beam0.npy")).unwrap();
    screen(folder, &["check", "pack", "image"], 0);
    let [(columns, rows, pencils), (width, height, pixels)] =
        [&of_pencils, &of_pixels].map(|path| cells(path));
    let [at_i, at_j] = ["I", "J"].map(|axis| cells(&pack.join(format!("beam-0/pixel.{axis}.npy"))).2);
    let mut forged = 0;
    for pencil in (0..pencils.len()).filter(|&pencil| pencils[pencil] > 0.0) {
        // The pencil delivers twice as much, and its pixel gets that too: the pack fits together.
        let (mut pencils, mut pixels) = (pencils.clone(), pixels.clone());
        pixels[at_j[pencil] as usize * width as usize + at_i[pencil] as usize] += pencils[pencil];
        pencils[pencil] *= 2.0;
        write_channel(&pack, "beam-0", "flux.V", (columns, rows), pencils);
        write_channel(&pack, "camera", "flux.beam0", (width, height), pixels);
        let output = raypencil(folder, &["check", "pack", "image"]);
        assert_trouble(&output, &["its answer to beam-0", "is not the referee's"]);
        forged += 1;
    }
    assert!(forged >= 4, "{forged}");
}

#[test]
fn a_check_says_what_it_verified() {
    let whole = packed();
    let said = screen(whole.path(), &["check", "pack", "right"], 0);
    let all = "): all 128 of 128 answers are the referee's, and so is each by which a ray is wrong; 2 arrays of rays are \
               those of its scene. Found again, too: all 51 of 51 counts of clauses.";
    assert!(said.contains(all), "{said}");
    assert_eq!(screen(whole.path(), &["check", "pack", "right", "--verify"], 0), said);
    let json = screen(whole.path(), &["check", "pack", "right", "--verify", "--json"], 0);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        json["verified"],
        serde_json::json!({
            "answers": 128, "of": 128, "seed": null, "ray_files": 2,
            "clauses": { "found": 51, "of": 51 }, "sizes": { "found": 0, "of": 0 },
        })
    );
    // Which pack it is: not a published one.
    let (_, sha256) = file_sha256_hex(&whole.path().join("pack/manifest.json")).unwrap();
    let expected = serde_json::json!({ "name": "scene", "sha256": sha256, "version": null, "licence": null, "published": false });
    assert_eq!(json["pack"], expected);
    assert!(said.contains(&format!("The pack (sha256 {}...): ", &sha256[..12])), "{said}");
}

#[test]
fn changed_rays_are_refused() {
    let whole = packed();
    let pack = whole.path().join("pack");
    let path = pack.join("rays-camera.npy");
    let mut bytes = fs::read(&path).unwrap();
    let last = bytes.len() - 8;
    bytes[last] ^= 1;
    fs::write(&path, bytes).unwrap();
    seal(&pack);
    let output = raypencil(whole.path(), &["check", "pack", "right"]);
    assert_trouble(&output, &["rays-camera.npy does not have the rays of camera"]);
}

#[test]
fn packing_again_removes_what_the_pack_has_and_nothing_else() {
    let whole = packed();
    let folder = whole.path();
    let pack = folder.join("pack");
    // A file that the manifest names and that was changed, one that it does not name, and one out of the folder.
    fs::write(pack.join("rays-beam-0.npy"), "changed by hand").unwrap();
    fs::write(pack.join("notes.txt"), "mine").unwrap();
    fs::write(folder.join("outside.txt"), "mine").unwrap();
    let text = fs::read_to_string(pack.join("manifest.json")).unwrap();
    fs::write(folder.join("scene.toml"), format!("beam = []\n{}", SCENE.split("[[beam]]").next().unwrap()))
        .unwrap();
    screen(folder, &["pack", "scene.toml", "--no-bench", "-o", "pack"], 0);
    assert!(!pack.join("beam-0/range.T.npy").exists(), "an answer of the earlier pack stays");
    for name in ["rays-beam-0.npy", "notes.txt"] {
        assert!(pack.join(name).exists(), "{name}");
    }
    screen(folder, &["pack", "scene.toml", "--no-bench", "-o", "again"], 0);
    screen(folder, &["check", "pack", "again"], 0);
    // A planted manifest: a pack's text that names other files.
    let planted = folder.join("planted");
    fs::create_dir(&planted).unwrap();
    fs::write(planted.join("rays-camera.npy"), "precious").unwrap();
    fs::write(planted.join("manifest.json"), &text).unwrap();
    screen(folder, &["pack", "scene.toml", "--no-bench", "-o", "planted"], 0);
    // It was in the way of a file of the new pack; the others were not there.
    assert_eq!(fs::read_to_string(folder.join("outside.txt")).unwrap(), "mine");
    fs::write(planted.join("manifest.json"), "{\"of\": \"another program\"}").unwrap();
    assert_trouble(
        &raypencil(folder, &["pack", "scene.toml", "--no-bench", "-o", "planted"]),
        &["manifest.json"],
    );
    assert_eq!(fs::read_to_string(planted.join("manifest.json")).unwrap(), "{\"of\": \"another program\"}");
}

#[test]
fn a_pack_that_fails_leaves_the_earlier_one() {
    let whole = packed();
    let folder = whole.path();
    // A folder in the way of a file: the new pack cannot be put in its place.
    fs::write(folder.join("broken.toml"), SCENE.replace("pyramids", "no-such-ground")).unwrap();
    assert_trouble(&raypencil(folder, &["pack", "broken.toml", "-o", "pack"]), &["no-such-ground"]);
    screen(folder, &["check", "pack", "pack"], 0);
    let left: Vec<_> =
        fs::read_dir(folder.join("pack")).unwrap().map(|one| one.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().contains(".part")), "{left:?}");
}

#[cfg(unix)]
#[test]
fn a_pipe_in_place_of_a_manifest_is_not_waited_for() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::create_dir(folder.path().join("pack")).unwrap();
    let pipe = folder.path().join("pack/manifest.json");
    assert!(std::process::Command::new("mkfifo").arg(pipe).status().unwrap().success());
    let output = raypencil(folder.path(), &["pack", "scene.toml", "--no-bench", "-o", "pack"]);
    assert_trouble(&output, &["manifest.json", "not a regular file"]);
}
