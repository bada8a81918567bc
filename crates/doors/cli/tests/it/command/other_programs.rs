//! Images as other programs write them, as candidates of the pack `hard`: its exact depths in their files.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, SmallVec, WritableImage, f16,
};
use raypencil::Image;
use raypencil::io::{Limits, Values, read_npy, write_npy};
use raypencil_tests::schema::schema_faults;
use serde_json::json;
use tempfile::TempDir;
use tiff::encoder::{TiffEncoder, colortype};

use super::check::{assert_fails, assert_passes, check, pack};
use super::{assert_trouble, raypencil, screen, text};

/// The exact numbers of the pack's camera, row by row, and their size.
fn exact(map: &str) -> (Vec<f64>, [u32; 2]) {
    let array =
        read_npy(pack("hard").join(format!("camera/{map}.npy")), &Limits::default()).expect("an answer");
    let Values::Reals(image) = &array.planes[0] else { panic!("reals") };
    (image.cells().to_vec(), [image.width(), image.height()])
}

/// Millimetres, rounded to the nearest; 0 where nothing is hit. (ROS, 16UC1)
fn millimetres() -> (Vec<u16>, [u32; 2]) {
    let (depths, size) = exact("depth.Z");
    (
        depths
            .iter()
            .map(|depth| if depth.is_finite() { (depth * 1000.0).round() as u16 } else { 0 })
            .collect(),
        size,
    )
}

/// A folder with an empty `mine`, and the path of a file in that.
fn mine(file: &str) -> (TempDir, PathBuf) {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path().join("mine").join(file);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    (folder, path)
}

/// An EXR of these parts, each with its channels.
fn write_parts(path: &Path, size: [u32; 2], parts: &[(&str, Vec<(&str, FlatSamples)>)]) {
    let size = (size[0] as usize, size[1] as usize);
    let layer = |(name, channels): &(&str, Vec<(&str, FlatSamples)>)| {
        let channel = |(name, samples): &(&str, FlatSamples)| AnyChannel::new(*name, samples.clone());
        let channels = AnyChannels::sort(channels.iter().map(channel).collect::<SmallVec<_>>());
        Layer::new(size, LayerAttributes::named(*name), Encoding::SMALL_LOSSLESS, channels)
    };
    let layers: SmallVec<[_; 2]> = parts.iter().map(layer).collect();
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    ExrImage::from_layers(attributes, layers).write().to_file(path).unwrap();
}

fn singles(numbers: &[f64]) -> FlatSamples {
    FlatSamples::F32(numbers.iter().map(|&number| number as f32).collect())
}

#[test]
fn a_layered_file_is_judged_by_what_is_declared_and_remembered() {
    let (folder, file) = mine("camera.exr");
    let (depths, size) = exact("depth.Z");
    // Blender's number for nothing.
    let depths: Vec<f64> = depths.iter().map(|depth| if depth.is_finite() { *depth } else { 1e10 }).collect();
    let alpha = FlatSamples::F16(vec![f16::from_f32(1.0); depths.len()]);
    let channels = vec![("ViewLayer.Combined.A", alpha), ("ViewLayer.Depth.Z", singles(&depths))];
    write_parts(&file, size, &[("", channels)]);
    let named = ["--channel", "depth.Z=ViewLayer.Depth.Z"];

    // Nothing is guessed: the message says what is there, and how to name it.
    assert_trouble(
        &check(folder.path(), "hard", &[]),
        &[
            "holds no channel of this scene",
            "found camera.exr (24 x 18): ViewLayer.Combined.A (half), ViewLayer.Depth.Z (single)",
            "--channel camera/depth.Z=ViewLayer.Depth.Z",
            "\"channels\": {\"camera/depth.Z\":",
            "depth.Z along the optical axis, range.T along the ray",
        ],
    );
    assert_trouble(
        &check(folder.path(), "hard", &["--channel", "depth.Z=Depth.Z"]),
        &[
            "channel \"Depth.Z\", declared to be depth.Z: not there; expected one of camera.exr (24 x 18): ViewLayer.Combined.A",
            "ViewLayer.Depth.Z (single)",
        ],
    );
    let far = [named[0], named[1], "--miss", "1e10"];
    let output = check(folder.path(), "hard", &far);
    assert_passes(&output);
    let shown = text(&output.stdout);
    assert!(shown.contains("Unknown channel, not compared: camera/ViewLayer.Combined.A"), "{shown}");
    assert!(shown.contains("--channel MAP=CHANNEL"), "{shown}");
    // As ranges the same numbers are wrong, and said to be depths.
    let as_range = ["--channel", "range.T=ViewLayer.Depth.Z", "--miss", "1e10"];
    assert_fails(&check(folder.path(), "hard", &as_range), &["rays are wrong"]);

    // The note says the same once for all; an option counts more.
    let note = |channels: serde_json::Value| {
        let note = json!({
            "format": 1, "program": "Blender", "arithmetic": "f64", "miss": 1e10, "channels": channels
        });
        fs::write(folder.path().join("mine/candidate.json"), note.to_string()).unwrap();
    };
    note(json!({ "depth.Z": "ViewLayer.Depth.Z" }));
    assert_passes(&check(folder.path(), "hard", &[]));
    let scene = pack("hard").join("scene.toml");
    let scene = scene.to_string_lossy();
    let shown = screen(folder.path(), &["probe", &scene, "--pixel", "12,15", "--candidate", "mine"], 0);
    assert!(shown.contains("Blender"), "{shown}");
    note(json!({ "depth.Z": "ViewLayer.Combined.A" }));
    assert!(check(folder.path(), "hard", &[]).status.code() != Some(0));
    assert_passes(&check(folder.path(), "hard", &named));
    note(json!({ "dpeth.Z": "ViewLayer.Depth.Z" }));
    assert_trouble(
        &check(folder.path(), "hard", &[]),
        &["there is no such map; expected one of range.T, depth.Z, P.X"],
    );
    note(json!({ "beam-77/depth.Z": "ViewLayer.Depth.Z" }));
    assert_trouble(
        &check(folder.path(), "hard", &[]),
        &["the scene has no sensor beam-77; expected camera, beam-0"],
    );
}

#[test]
fn a_file_of_no_sensor_needs_its_name() {
    let (folder, file) = mine("frame_0001.exr");
    let (ranges, size) = exact("range.T");
    write_parts(&file, size, &[("", vec![("V", singles(&ranges))])]);
    assert_trouble(
        &check(folder.path(), "hard", &["--channel", "range.T=V"]),
        &["its file says of no sensor that it belongs to it; expected camera/range.T or beam-0/range.T"],
    );
    assert_passes(&check(folder.path(), "hard", &["--channel", "camera/range.T=V"]));
}

#[test]
fn parts_and_grey_colours_are_named() {
    let (folder, file) = mine("camera.exr");
    let ((depths, size), (ranges, _)) = (exact("depth.Z"), exact("range.T"));
    let grey = ["R", "G", "B"].map(|name| (name, singles(&ranges)));
    write_parts(&file, size, &[("ViewLayer.Depth", vec![("Z", singles(&depths))]), ("grey", grey.to_vec())]);
    assert_trouble(
        &check(folder.path(), "hard", &[]),
        &["grey/B (single), grey/G (single), grey/R (single), ViewLayer.Depth/Z (single)"],
    );
    for depth in ["ViewLayer.Depth/Z", "ViewLayer.Depth.Z", "Z"] {
        let depth = format!("depth.Z={depth}");
        let output = check(folder.path(), "hard", &["--channel", &depth, "--channel", "range.T=R"]);
        assert_passes(&output);
    }
}

#[test]
fn depth_images_of_16_bits_are_judged_in_their_unit() {
    let (millimetres, size) = millimetres();
    assert!(millimetres.contains(&0));
    let image = Image::from_cells(size[0], size[1], millimetres.iter().map(|&n| u32::from(n)).collect());
    let bytes: Vec<u8> = millimetres.iter().flat_map(|number| number.to_be_bytes()).collect();
    for name in ["depth.Z.npy", "depth.Z.png", "depth.Z.tif"] {
        let (folder, file) = mine(&format!("camera/{name}"));
        match name.rsplit('.').next() {
            Some("npy") => write_npy(&file, &[&image]).unwrap(),
            Some("png") => {
                let mut encoder = png::Encoder::new(fs::File::create(&file).unwrap(), size[0], size[1]);
                encoder.set_color(png::ColorType::Grayscale);
                encoder.set_depth(png::BitDepth::Sixteen);
                encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
            }
            _ => {
                let mut contents = Cursor::new(Vec::new());
                let mut encoder = TiffEncoder::new(&mut contents).unwrap();
                encoder.write_image::<colortype::Gray16>(size[0], size[1], &millimetres).unwrap();
                fs::write(&file, contents.into_inner()).unwrap();
            }
        }
        assert_trouble(
            &check(folder.path(), "hard", &[]),
            &[
                "`depth.Z`: whole numbers; expected floating-point numbers",
                "--scale 0.001 for millimetres. 0 then means \"no hit\"",
            ],
        );
        let output = check(folder.path(), "hard", &["--scale", "0.001", "--json"]);
        assert_passes(&output);
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let quantities = document["bundles"][0]["quantities"].as_array().unwrap();
        let depth = quantities.iter().find(|one| one["quantity"] == "depth").unwrap();
        assert_eq!(depth["storage"], "steps of 0.001 m", "{name}");
        let schema = include_str!("../../../../../../docs/formats/check.schema.json");
        let schema: serde_json::Value = serde_json::from_str(schema).unwrap();
        assert_eq!(schema_faults(&schema, &document), Vec::<String>::new());
        let shown = text(&check(folder.path(), "hard", &["--scale", "0.001"]).stdout);
        assert!(shown.contains("rays agree to steps of 0.001 m: "), "{shown}");
        assert!(shown.contains("Errors below half a step, 0.0005 m, cannot be seen"), "{shown}");
        // A tenth of the unit is another depth.
        assert_fails(&check(folder.path(), "hard", &["--scale", "0.0001"]), &["rays are wrong"]);
        for wrong in ["0", "-1", "inf", "1mm"] {
            assert_eq!(check(folder.path(), "hard", &["--scale", wrong]).status.code(), Some(2));
        }
        // Two recordings: the option concerns the one with whole numbers.
        let exact = pack("hard").join("camera/depth.Z.npy");
        let (mine, exact) = (file.to_string_lossy(), exact.to_string_lossy());
        let words = ["diff", &mine, &exact, "--scale", "0.001", "--fail", "0.0005000001"];
        assert!(screen(folder.path(), &words, 0).contains("1 within what is allowed"));
        let shown = screen(folder.path(), &["diff", &mine, &mine], 0);
        assert!(shown.contains("1 channel compared, the same in every cell"), "{shown}");
    }
}

#[test]
fn a_depth_that_is_a_step_off_is_wrong() {
    let (mut millimetres, size) = millimetres();
    let cell = millimetres.iter().position(|&number| number > 0).unwrap();
    millimetres[cell] += 1;
    let (folder, file) = mine("camera/depth.Z.npy");
    let cells = millimetres.iter().map(|&number| u32::from(number)).collect();
    write_npy(&file, &[&Image::from_cells(size[0], size[1], cells)]).unwrap();
    assert_fails(&check(folder.path(), "hard", &["--scale", "0.001"]), &["1 of 432 rays is wrong"]);
}

#[test]
fn what_is_declared_for_nobody_is_refused() {
    let (folder, file) = mine("camera/depth.Z.npy");
    let (depths, size) = exact("depth.Z");
    write_npy(&file, &[&Image::from_cells(size[0], size[1], depths)]).unwrap();
    assert_trouble(
        &check(folder.path(), "hard", &["--scale", "0.001"]),
        &["scale 0.001: no map that it concerns in camera/depth.Z.npy (24 x 18): camera/depth.Z (double)"],
    );
    let declared = ["validate", "pyramids", "--channel", "depth.Z=Z"];
    assert_trouble(&raypencil(folder.path(), &declared), &["there is no candidate that they concern"]);
    let input = pack("input");
    let declared = ["check", &input.to_string_lossy(), "mine", "--scale", "0.001"];
    assert_trouble(&raypencil(folder.path(), &declared), &["is an input pack, which asks for triangles.npy"]);
    let declared = ["diff", "mine", "mine", "--channel", "depth.Z=Z"];
    assert_trouble(
        &raypencil(folder.path(), &declared),
        &["channel \"Z\", declared to be depth.Z: not there"],
    );
}

#[test]
fn every_format_of_render_is_read_again() {
    let folder = TempDir::new().expect("a temporary folder");
    let scene = pack("hard").join("scene.toml");
    let scene = scene.to_string_lossy();
    for format in ["npy", "npz", "zarr", "exr", "exr-each"] {
        let words = ["render", &scene, "--with", "tracer", "--format", format, "-o", format];
        screen(folder.path(), &words, 0);
        let pack = pack("hard");
        let shown = screen(folder.path(), &["check", &pack.to_string_lossy(), format], 0);
        assert!(!shown.contains("Unknown channel"), "{format}: {shown}");
        assert!(!shown.contains("because not given: range"), "{format}: {shown}");
    }
    let same = |a: &str, b: &str, more: &[&str]| {
        let shown = screen(folder.path(), &[&["diff", a, b], more].concat(), 0);
        assert!(shown.contains("✓ 172 channels compared, the same in every cell"), "{a}, {b}: {shown}");
    };
    same("npy", "npz", &[]);
    same("npy", "zarr", &[]);
    same("npz", "zarr/maps.zarr", &[]);
    same("exr", "exr-each", &[]);
    let shown = screen(folder.path(), &["diff", "zarr", "exr-each", "--fail-ulp", "0.5"], 0);
    assert!(shown.contains("✓ 172 channels compared"), "{shown}");
    let candidates = ["validate", &scene, "--candidate", "npz", "--candidate", "zarr", "-o", "out"];
    assert!(screen(folder.path(), &candidates, 0).contains("2 candidates agree"));
}
