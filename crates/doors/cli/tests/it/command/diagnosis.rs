//! `check` says why a candidate is wrong nearly everywhere, and what may be declared.

use std::fs;
use std::path::Path;

use raypencil::Image;
use raypencil::io::{ExrMap, Raster};

use super::check::{assert_fails, assert_passes, check, edit, folder, reals};
use super::{assert_trouble, screen, text};

/// The camera's answers alone are left.
fn camera_alone(folder: &Path) {
    for file in ["beam-0.exr", "beam-1.exr"] {
        fs::remove_file(folder.join("mine").join(file)).expect("what was rendered");
    }
}

fn flipped<T: Copy>(image: &Image<T>) -> Image<T> {
    let (width, height) = (image.width(), image.height());
    let cells = (0..height).rev().flat_map(|j| (0..width).map(move |i| image.at(i, j)));
    Image::from_cells(width, height, cells.collect())
}

fn flip(map: &mut ExrMap) {
    for raster in map.channels.values_mut() {
        *raster = match raster {
            Raster::F32(image) => Raster::F32(flipped(image)),
            Raster::U32(image) => Raster::U32(flipped(image)),
        };
    }
}

#[test]
fn reversed_rows_are_named_on_all_reports_and_the_verdict_stays() {
    let folder = folder("pyramids");
    camera_alone(folder.path());
    assert_passes(&check(folder.path(), "pyramids", &[]));
    edit(&folder, "camera.exr", flip);
    let output = check(folder.path(), "pyramids", &["-o", "out"]);
    let why = "Why: 100 % of the wrong rays of the camera agree if rows are reversed: row 0 is the top row (docs/formats/files.md, Orientation)";
    assert_fails(&output, &["rays are wrong", why]);
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).expect("a report");
    let json: serde_json::Value = serde_json::from_str(&read("check.json")).expect("JSON");
    assert_eq!(json["verdict"], "defects");
    let reason = &json["diagnosis"]["reasons"][0];
    assert_eq!(reason["mistakes"][0]["name"], "rows_reversed");
    assert_eq!(reason["bundles"][0], "camera");
    assert_eq!(reason["explained"], reason["wrong"]);
    assert_eq!(reason["broken"], 0);
    assert!(read("junit.xml").contains("agree if rows are reversed"), "{}", read("junit.xml"));
}

#[test]
fn a_number_for_no_hit_is_suggested_and_can_be_declared() {
    for (number, word) in [(-1.0, "-1"), (0.0, "0")] {
        let folder = folder("pyramids");
        camera_alone(folder.path());
        edit(&folder, "camera.exr", |map| {
            for channel in ["range.T", "depth.Z"] {
                let cells = reals(map, channel).cells_mut();
                cells.iter_mut().filter(|x| x.is_infinite()).for_each(|x| *x = number);
            }
        });
        let declare = format!("declare --miss {word} to check, or \"miss\": {word} in its candidate.json");
        assert_trouble(&check(folder.path(), "pyramids", &[]), &["`range.T` at", "+Inf", "help", &declare]);
        assert_passes(&check(folder.path(), "pyramids", &["--miss", word]));
        // Another number declares nothing, and to declare this one in its place is no remedy for the other.
        let only = "write +Inf where nothing is hit: one number alone can be declared to mean that, and 7 is";
        assert_trouble(&check(folder.path(), "pyramids", &["--miss", "7"]), &["`range.T` at", only]);
    }
}

#[test]
fn a_number_for_no_hit_without_faces_is_refused_or_named() {
    let folder = folder("pyramids");
    camera_alone(folder.path());
    let missed = |number: f32| {
        edit(&folder, "camera.exr", |map| {
            map.channels.retain(|name, _| name == "range.T");
            // The first range of all belongs to the sky.
            let was = reals(map, "range.T").at(0, 0);
            let same = |x: &f32| *x == was || x.is_nan() && was.is_nan();
            reals(map, "range.T").cells_mut().iter_mut().filter(|x| same(x)).for_each(|x| *x = number);
        });
    };
    missed(-1.0);
    assert_trouble(&check(folder.path(), "pyramids", &[]), &["no negative length", "declare --miss -1"]);
    assert_passes(&check(folder.path(), "pyramids", &["--miss", "-1"]));
    missed(f32::NAN);
    // A value that is not finite means no hit without a declaration.
    assert_passes(&check(folder.path(), "pyramids", &[]));
    // A range of 0 breaks no rule of files: the rays are judged, and the constant is found.
    missed(0.0);
    assert_fails(
        &check(folder.path(), "pyramids", &[]),
        &["Why: 100 % of the wrong rays of the camera agree if 0 means \"no hit\""],
    );
    assert_passes(&check(folder.path(), "pyramids", &["--miss", "0"]));
}

#[test]
fn negative_depths_are_refused_with_the_remedy() {
    let folder = folder("pyramids");
    camera_alone(folder.path());
    edit(&folder, "camera.exr", |map| {
        let cells = reals(map, "depth.Z").cells_mut();
        cells.iter_mut().filter(|x| x.is_finite()).for_each(|x| *x = -*x);
    });
    // Many numbers mean no "no hit".
    let output = check(folder.path(), "pyramids", &[]);
    assert_trouble(&output, &["no negative length", "a camera that looks along -z writes -z"]);
    assert!(!text(&output.stderr).contains("--miss"), "{}", text(&output.stderr));
}

#[test]
fn pixels_outside_the_image_are_refused_with_the_remedy() {
    let stated = |change: &dyn Fn(u32, u32) -> (u32, u32)| {
        let folder = folder("pyramids");
        // Each beam of the program: others that count otherwise would say that it is no rule of it.
        (0..9).map(|beam| format!("beam-{beam}.exr")).for_each(|beam| {
            edit(&folder, &beam, |map| {
                let [columns, rows] = ["pixel.I", "pixel.J"].map(|name| {
                    let Some(Raster::U32(image)) = map.channels.get(name) else { panic!("no {name}") };
                    image.clone()
                });
                for (name, is_row) in [("pixel.I", false), ("pixel.J", true)] {
                    let Some(Raster::U32(image)) = map.channels.get_mut(name) else { panic!("no {name}") };
                    let pairs = columns.cells().iter().zip(rows.cells());
                    for (cell, (i, j)) in
                        image.cells_mut().iter_mut().zip(pairs).filter(|(_, (i, _))| **i != u32::MAX)
                    {
                        let (column, row) = change(*i, *j);
                        *cell = if is_row { row } else { column };
                    }
                }
            })
        });
        check(folder.path(), "pyramids", &[])
    };
    assert_passes(&stated(&|i, j| (i, j)));
    assert_trouble(
        &stated(&|i, j| (i + 1, j + 1)),
        &["expected a pixel of the camera's", "count from 0, and not from 1"],
    );
    assert_trouble(&stated(&|i, j| (j, i)), &["expected a pixel of the camera's", "they are exchanged"]);
    // Neither would do.
    let output = stated(&|i, j| (i + 1000, j));
    assert_trouble(&output, &["expected a pixel of the camera's"]);
    assert!(!text(&output.stderr).contains("help"), "{}", text(&output.stderr));
}

#[test]
fn faces_of_an_own_order_are_named_and_can_be_left_out() {
    let folder = folder("pyramids");
    camera_alone(folder.path());
    edit(&folder, "camera.exr", |map| {
        let Some(Raster::U32(faces)) = map.channels.get_mut("face.I") else { panic!("no faces") };
        // 224 faces; 137 has no common divisor with 224.
        let others = faces.cells_mut().iter_mut().filter(|face| **face != u32::MAX);
        others.for_each(|face| *face = (137 * *face + 5) % 224);
    });
    assert_fails(
        &check(folder.path(), "pyramids", &[]),
        &["agree if faces are numbered in an order of their own"],
    );
    let output = check(folder.path(), "pyramids", &["--no-faces"]);
    assert_passes(&output);
    let screen = text(&output.stdout);
    assert!(
        screen.contains("Not compared, because not given: face") && !screen.contains("Unknown channel"),
        "{screen}"
    );
    // A face map that says wrongly which rays hit: with 0 for none.
    edit(&folder, "camera.exr", |map| {
        let Some(Raster::U32(faces)) = map.channels.get_mut("face.I") else { panic!("no faces") };
        faces.cells_mut().iter_mut().filter(|face| **face == u32::MAX).for_each(|face| *face = 0);
    });
    assert_trouble(&check(folder.path(), "pyramids", &[]), &["declare --no-faces"]);
    assert_passes(&check(folder.path(), "pyramids", &["--no-faces"]));
}

#[test]
fn an_error_of_one_ray_has_no_explanation() {
    let folder = folder("pyramids");
    edit(&folder, "camera.exr", |map| {
        let range = reals(map, "range.T");
        let value = range.at(40, 50);
        range.set(40, 50, 2.0 * value);
    });
    let output = check(folder.path(), "pyramids", &["--json"]);
    let json: serde_json::Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
    assert_eq!(json["verdict"], "defects");
    assert!(json["diagnosis"].is_null(), "{}", json["diagnosis"]);
}

#[test]
fn a_validation_and_a_campaign_say_why_too() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let folder = folder.path();
    fs::create_dir(folder.join("scenes")).expect("a folder");
    let small = "version = 1\ncamera = { width_px = 48, height_px = 40, pixel_pitch_um = 200 }\n\
                 beam = [{ columns = 64, rows = 2, thickness_mm = 60 }]\n";
    fs::write(folder.join("scenes/small.toml"), small).expect("a scene");
    // A program with another principal point: the light of its beams, which are right, lands elsewhere too.
    let render = "render scenes/small.toml --with tracer -o mine --set camera.principal_point_px=[23.5,20]";
    screen(folder, &render.split(' ').collect::<Vec<_>>(), 0);
    let line = ["validate", "scenes/small.toml", "--candidate", "mine", "-o", "out"];
    let found = screen(folder, &line, 1).split_whitespace().collect::<Vec<_>>().join(" ");
    let why = "Why mine is wrong: 100 % of the wrong rays agree if cx is 23.5 in place of 24 px";
    assert!(found.contains(why), "{found}");
    let read = |path: &str| fs::read_to_string(folder.join(path)).expect("a report");
    assert!(read("out/report.html").contains(why) && read("out/summary.md").contains(why));
    let json: serde_json::Value = serde_json::from_str(&read("out/summary.json")).expect("JSON");
    let of = |index: usize| &json["panel"]["renderers"][index]["diagnosis"];
    assert!(of(0).is_null() && of(1).is_null(), "{json:#}");
    assert_eq!(of(2)["reasons"][0]["bundles"], serde_json::json!(["camera", "beam-0"]));

    // The same in a campaign. In its scene of narrow beams nobody looks through the camera.
    let program = format!(
        "{} render {{pack}}/scene.toml --with tracer -o {{out}} --set camera.principal_point_px=[23.5,20]",
        env!("CARGO_BIN_EXE_raypencil")
    );
    let line = ["campaign", "--scenes", "scenes", "--candidate-command", &program, "-o", "hunt"];
    let found = screen(folder, &line, 1).split_whitespace().collect::<Vec<_>>().join(" ");
    let why = "Why: in terrain 0 own, the only scene with wrong rays, 100 % of them agree if cx is 23.5 in place of 24 px";
    assert!(found.contains(why), "{found}");
    let json: serde_json::Value = serde_json::from_str(&read("hunt/summary.json")).expect("JSON");
    assert_eq!(json["reasons"][0]["explained"], json["reasons"][0]["wrong"]);
}
