//! `cast`: any rays on any mesh.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use raypencil::io::{Limits, read_npy_numbers};
use raypencil_tests::schema::schema_faults;
use tempfile::TempDir;

use super::{assert_trouble, command, raypencil, screen, text};

/// The project's own mesh and rays.
fn data(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/rays").join(name).display().to_string()
}

#[test]
fn arrays_have_the_shape_of_the_rays() {
    let folder = TempDir::new().unwrap();
    let (cube, rays) = (data("cube.obj"), data("cube.npy"));
    let shown = screen(folder.path(), &["cast", &cube, &rays, "-o", "out", "--all", "--any"], 0);
    assert!(shown.contains("8 vertices, 12 faces; 2 x 2 x 2 wide"), "{shown}");
    assert!(shown.contains("25 rays: 9 hit, 3 of them at a tie; 16 miss"), "{shown}");
    let read =
        |name: &str| read_npy_numbers(folder.path().join("out").join(name), &Limits::default()).unwrap();
    // From z = 3 down to the top at z = 1, at x, y = -1.5, -1, 0, 1, 1.5: the middle 3 x 3 rays hit. The diagonal of the top
    // belongs to both of its faces, and runs through three of them.
    let t = read("t.npy");
    assert_eq!(t.shape, [5, 5]);
    for (k, &t) in t.values.iter().enumerate() {
        let is_hit = (1..4).contains(&(k % 5)) && (1..4).contains(&(k / 5));
        assert_eq!(t, if is_hit { 2.0 } else { f64::INFINITY });
    }
    assert_eq!(read("ties.npy").values.iter().filter(|&&ties| ties == 2.0).count(), 3);
    assert_eq!(read("any.npy").values.iter().sum::<f64>(), 9.0);
    let point = read("point.npy");
    assert_eq!((point.shape, &point.values[3 * 6..3 * 7]), (vec![5, 5, 3], &[-1.0, -1.0, 1.0][..]));
    // Each of the nine rays enters by the top and leaves by the bottom: at t = 2 and t = 4.
    let (start, all, crossing) = (read("all.start.npy"), read("all.t.npy"), read("all.crossing.npy"));
    assert_eq!((start.shape, start.values.last()), (vec![26], Some(&(all.values.len() as f64))));
    assert!(all.values.iter().all(|&t| t == 2.0 || t == 4.0));
    // The middle ray: two faces at the top, two at the bottom.
    let [from, to] = [12, 13].map(|k: usize| start.values[k] as usize);
    assert_eq!(all.values[from..to], [2.0, 2.0, 4.0, 4.0]);
    assert_eq!(crossing.values[from..to], [1.0, 1.0, -1.0, -1.0]);
    assert_eq!(read("all.group.npy").values[from..to], [0.0, 0.0, 1.0, 1.0]);
    let summary = fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    let schema = include_str!("../../../../../../docs/formats/cast.schema.json");
    let schema: serde_json::Value = serde_json::from_str(schema).unwrap();
    assert_eq!(schema_faults(&schema, &serde_json::from_str(&summary).unwrap()), Vec::<String>::new());
}

#[test]
fn each_set_of_rays_decides_and_eight_rays_are_told_one_by_one() {
    let folder = TempDir::new().unwrap();
    let cube = data("cube.obj");
    let set = |name: &str, x: i32| {
        let grid = "grid = { columns = 8, rows = 6, width_deg = 30, height_deg = 20 }";
        format!("[[rays]]\nname = \"{name}\"\n{grid}\nposition_m = [{x}, 0, 0]\n")
    };
    // From 40 m the cube lies behind: a set that hits nothing proves nothing, first or last.
    for (name, sets, code) in [
        ("one", [set("a", -4), set("b", -4)], 0),
        ("first", [set("a", 40), set("b", -4)], 1),
        ("last", [set("a", -4), set("b", 40)], 1),
    ] {
        let file = format!("{name}.toml");
        fs::write(folder.path().join(&file), sets.concat()).unwrap();
        screen(folder.path(), &["cast", &cube, &file, "--with", "tracer"], code);
    }
    for (count, is_told) in [(8, true), (9, false)] {
        fs::write(folder.path().join("rays.csv"), "0.25,0.5,3,0,0,-1\n".repeat(count)).unwrap();
        let told = screen(folder.path(), &["cast", &cube, "rays.csv", "--json"], 0);
        let told: serde_json::Value = serde_json::from_str(&told).unwrap();
        assert_eq!(told["rays"].as_array().map(Vec::len), is_told.then_some(count), "{told}");
        let shown = screen(folder.path(), &["cast", &cube, "rays.csv"], 0);
        let expected = if is_told { count } else { 0 };
        assert_eq!(shown.matches("from (0.25, 0.5, 3) along (0, 0, -1)").count(), expected, "{shown}");
    }
}

#[test]
fn one_ray_is_answered_on_the_screen_and_as_json() {
    let folder = TempDir::new().unwrap();
    let cube = data("cube.obj");
    let ray = "--ray=-3,0.25,0.5,2,0,0";
    let shown = screen(folder.path(), &["cast", &cube, ray, "--all"], 0);
    for line in [
        "face 0, front",
        "t            1\n",
        "range        2\n",
        "point        (-1, 0.25, 0.5)",
        "t 2: face 3 (back)",
    ] {
        assert!(shown.contains(line), "{line} is not in\n{shown}");
    }
    let json = screen(folder.path(), &["cast", &cube, ray, "--json", "--any"], 0);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["decided"], serde_json::json!({ "filter": 1, "intervals": 0, "exact": 0 }));
    // Through a diagonal: only exact arithmetic tells that.
    let through = screen(folder.path(), &["cast", &cube, "--ray=-3,0.5,0.5,2,0,0", "--json"], 0);
    let through: serde_json::Value = serde_json::from_str(&through).unwrap();
    assert_eq!(through["decided"], serde_json::json!({ "filter": 0, "intervals": 0, "exact": 1 }));
    let first = &json["rays"][0]["first"];
    assert_eq!(
        (&first["face"], &first["t"], &json["rays"][0]["any"]),
        (&0.into(), &1.0.into(), &true.into())
    );
    // From inside only backs are met.
    let inside = ["cast", &cube, "--ray", "0,0.25,0.5,1,0,0"];
    assert!(screen(folder.path(), &inside, 0).contains("face 3, back"));
    assert!(screen(folder.path(), &[&inside[..], &["--fronts-only"]].concat(), 0).contains("nothing is hit"));
}

#[test]
fn rays_come_from_standard_input() {
    let folder = TempDir::new().unwrap();
    let mut child = command(folder.path(), &["cast", &data("cube.obj"), "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(b"0,0,3,0,0,-1\n9,9,9,0,0,1\n").unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(
        text(&output.stdout).contains("2 rays: 1 hit, 1 of them at a tie; 1 miss"),
        "{}",
        text(&output.stdout)
    );
}

#[test]
fn rubbish_is_refused_with_its_place() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("bad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
    fs::write(folder.path().join("bad.csv"), "0,0,0,0,0,1\n0,0,0,0,0,0\n").unwrap();
    let refused = |arguments: &[&str], words: &[&str]| {
        assert_trouble(&raypencil(folder.path(), &[&["cast"], arguments].concat()), words);
    };
    let (cube, rays) = (data("cube.obj"), data("cube.npy"));
    refused(&["bad.obj", &rays, "-o", "out"], &["bad.obj: line 2: vertex 3", "expected 1 to 1"]);
    refused(&[&cube, "bad.csv", "-o", "out"], &["bad.csv: line 2: ray 1.direction is [0, 0, 0]"]);
    refused(&[&cube, "none.npy"], &["none.npy: cannot read"]);
    refused(&[&cube, "--ray", "1,2,3"], &["--ray", "3 fields; expected 6 numbers"]);
    refused(&[&cube], &["no rays are given; expected RAYS, --ray"]);
    // Nothing was written.
    assert!(!folder.path().join("out").exists());
}

#[test]
fn sets_of_rays_have_a_folder_each_with_clouds_and_pictures() {
    let folder = TempDir::new().unwrap();
    let cube = data("cube.obj");
    let grid = "grid = { columns = 8, rows = 6, width_deg = 30, height_deg = 20 }\nposition_m = [-4, 0, 0]\n";
    let set = |name: &str| format!("[[rays]]\nname = \"{name}\"\n{grid}");
    fs::write(folder.path().join("one.toml"), set("front")).unwrap();
    fs::write(folder.path().join("two.toml"), set("front") + &set("again")).unwrap();
    let shown = screen(folder.path(), &["cast", &cube, "one.toml", "-o", "one"], 0);
    assert!(shown.contains("front: 48 rays: 48 hit"), "{shown}");
    let shown = screen(folder.path(), &["cast", &cube, "two.toml", "-o", "two"], 0);
    assert!(shown.contains("again: 48 rays: 48 hit"), "{shown}");
    let schema = include_str!("../../../../../../docs/formats/cast.schema.json");
    let schema: serde_json::Value = serde_json::from_str(schema).unwrap();
    for of_set in ["one", "two/front", "two/again"] {
        let of_set = folder.path().join(of_set);
        let summary = fs::read_to_string(of_set.join("summary.json")).unwrap();
        assert_eq!(schema_faults(&schema, &serde_json::from_str(&summary).unwrap()), Vec::<String>::new());
        for file in ["t.npy", "cloud.ply", "cloud.pcd", "range.png", "top.png"] {
            assert!(of_set.join(file).is_file(), "{file}");
        }
        // The front of the cube is 3 m ahead.
        let point = read_npy_numbers(of_set.join("point.npy"), &Limits::default()).unwrap();
        assert_eq!(point.shape, [6, 8, 3]);
        assert!(point.values.chunks_exact(3).all(|point| point[0] == -1.0));
    }
    let shown = screen(folder.path(), &["cast", &cube, "two.toml", "--json"], 0);
    let shown: serde_json::Value = serde_json::from_str(&shown).unwrap();
    assert_eq!(
        (&shown["sets"][1]["name"], &shown["sets"][1]["counts"]["hits"]),
        (&"again".into(), &48.into())
    );
}

#[test]
fn wrong_sets_of_rays_are_an_error_with_a_place() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("rays.toml"), "[[rays]]\nname = \"a\"\n").unwrap();
    let cube = data("cube.obj");
    let output = raypencil(folder.path(), &["cast", &cube, "rays.toml"]);
    assert_trouble(&output, &["rays.toml:1:1", "`rays 0` has no pattern"]);
}

#[test]
fn a_renderer_stands_beside_the_truth() {
    let folder = TempDir::new().unwrap();
    let (cube, rays) = (data("cube.obj"), data("cube.npy"));
    let shown = screen(folder.path(), &["cast", &cube, &rays, "--with", "tracer", "-o", "out"], 0);
    // All numbers of these rays are exact in f64.
    for line in ["tracer: 25 the same (3 at ties), 0 rounding, 0 wrong", "All 25 rays agree."] {
        assert!(shown.contains(line), "{shown}");
    }
    let verdicts =
        read_npy_numbers(folder.path().join("out/tracer.verdict.npy"), &Limits::default()).unwrap();
    assert_eq!((verdicts.shape, verdicts.values.iter().sum::<f64>()), (vec![5, 5], 3.0));
    // Where nothing is hit, nothing is compared.
    let shown = screen(folder.path(), &["cast", &cube, "--ray=0,0,3,0,0,1", "--with", "tracer"], 1);
    assert!(shown.contains("Nothing is hit: 1 ray compared, and all miss the mesh."), "{shown}");
    let shown =
        screen(folder.path(), &["cast", &cube, "--ray=0,0,3,0,0,-1", "--with", "tracer", "--json"], 0);
    let json: serde_json::Value = serde_json::from_str(&shown).unwrap();
    assert_eq!(
        json["compared"]["counts"],
        serde_json::json!({"same": 1, "ties": 1, "rounding": 0, "wrong": 0})
    );
    let refused = raypencil(folder.path(), &["cast", &cube, &rays, "--with", "scanline"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("possible values: tracer"), "{}", text(&refused.stderr));
}

#[test]
fn packs_of_rays_judge_arrays() {
    let folder = TempDir::new().unwrap();
    let (cube, rays) = (data("cube.obj"), data("cube.npy"));
    let shown = screen(folder.path(), &["pack", &cube, "--rays", &rays, "-o", "pack"], 0);
    let untested = "Not tested by any of its rays: backs of faces, t_min, t_max";
    assert!(
        shown.contains("25 rays; 9 hit, 3 of them at a tie, 16 miss") && shown.contains(untested),
        "{shown}"
    );
    screen(folder.path(), &["cast", &cube, &rays, "-o", "mine"], 0);
    let shown = screen(folder.path(), &["check", "pack", "mine", "-o", "checked"], 0);
    assert!(
        shown.contains("✓ 25 rays agree with the exact answers: 22 exact, 3 tie, 0 rounding."),
        "{shown}"
    );
    assert!(folder.path().join("checked/junit.xml").is_file());
    // Whichever pack it is, and whatever the candidate is of: what is no pack is named as such.
    for candidate in ["mine", "mine/t.npy"] {
        assert_trouble(
            &raypencil(folder.path(), &["check", candidate, "pack"]),
            &[
                &format!("{candidate}: pack: no pack, and the candidate, pack, is one"),
                "`raypencil check PACK CANDIDATE` (are the two exchanged?)",
            ],
        );
    }
    let neither = text(&raypencil(folder.path(), &["check", "mine", "mine"]).stderr);
    assert!(!neither.contains("exchanged"), "{neither}");
    let check = fs::read_to_string(folder.path().join("checked/check.json")).unwrap();
    let check: serde_json::Value = serde_json::from_str(&check).unwrap();
    assert_eq!((&check["kind"], &check["verdict"]), (&"rays".into(), &"agrees".into()));
    let schema =
        serde_json::from_str(include_str!("../../../../../../docs/formats/check.schema.json")).unwrap();
    assert_eq!(schema_faults(&schema, &check), Vec::<String>::new());
    // A program that finds nothing: the rays through the top's outline are excused by rounding, that through its middle,
    // on an edge that two faces share, is not.
    let nothing = [f64::INFINITY; 25];
    for name in ["t", "range"] {
        raypencil::io::write_npy_numbers(folder.path().join(format!("mine/{name}.npy")), &[25], &nothing)
            .unwrap();
    }
    fs::remove_file(folder.path().join("mine/face.npy")).unwrap();
    // The other values still say that nine rays hit.
    let shown = screen(folder.path(), &["check", "pack", "mine"], 1);
    assert!(shown.contains("9 of 25 rays are wrong."), "{shown}");
    assert!(shown.contains("t says that nothing is hit, and side is 1"), "{shown}");
    for name in ["side", "point", "normal", "barycentric", "cos_incidence"] {
        fs::remove_file(folder.path().join(format!("mine/{name}.npy"))).unwrap();
    }
    let shown = screen(folder.path(), &["check", "pack", "mine"], 1);
    assert!(shown.contains("1 of 25 rays is wrong."), "{shown}");
    assert!(shown.contains("Why: every ray is a miss: nothing at all is hit."), "{shown}");
    assert!(shown.contains("raypencil cast pack --ray=0,0,3,0,0,-1,0,inf --all --margins"), "{shown}");
    // The command is to be copied into a shell, whatever the folder is called.
    fs::rename(folder.path().join("pack"), folder.path().join("a;id")).unwrap();
    let shown = screen(folder.path(), &["check", "a;id", "mine"], 1);
    assert!(shown.contains("raypencil cast 'a;id' --ray=0,0,3,0,0,-1,0,inf --all"), "{shown}");
}

#[test]
fn a_scene_without_a_camera_has_its_terrain_as_the_file_gives_it() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    // A tilted square around (0.1, 0.1) whose heights are no f32 numbers, in a text file.
    let hill = "v -1 -1 0.1\nv 1.2 -1 0.1\nv 1.2 1.2 0.3\nv -1 1.2 0.3\nf 1 2 3\nf 1 3 4\n";
    fs::write(at.join("hill.obj"), hill).expect("a file");
    let scene = "version = 1\n[terrain]\nfile = \"hill.obj\"\n[vehicle]\nposition_m = [0.1, 0.25]\n";
    let sets = "[[rays]]\nname = \"down\"\nspinning = { elevations_deg = [-90], steps = 1 }\nposition_m = [0, 0, 1]\n";
    fs::write(at.join("scene.toml"), format!("{scene}{sets}")).expect("a file");
    let shown = screen(at, &["cast", "scene.toml", "-o", "out", "--with", "tracer", "--margins"], 0);
    assert!(shown.contains("4 vertices, 2 faces") && shown.contains("down: 1 ray"), "{shown}");
    let read = |name: &str| {
        let array = read_npy_numbers(at.join("out").join(format!("{name}.npy")), &Limits::default());
        array.expect("an array").values
    };
    // The vehicle stands on the ground and the ray starts 1 m above it: to the rounding of the vehicle's height, which
    // comes from f32.
    let point = read("point");
    assert!((point[2] - (0.1 + 0.2 * (0.25 + 1.0) / 2.2)).abs() < 1e-15, "{point:?}");
    assert!((read("range")[0] - 1.0).abs() < 1e-6);
    // Other rays on the same terrain, as the commands of wrong rays have them.
    let shown = screen(at, &["cast", "scene.toml", "--ray", "-1,-1,1,0,0,-1"], 0);
    assert!(shown.contains("(-1, -1, 0.1)"), "{shown}");
    // The same scene with a camera keeps f32 offsets and says so.
    let shown = screen(at, &["validate", "scene.toml", "--set", "camera.width_px=8", "-o", "seen"], 0);
    assert!(shown.contains("4 vertices, 4 rounded to f32 offsets, by 4.8e-8 m at most"), "{shown}");
    fs::write(at.join("no-rays.toml"), scene).expect("a file");
    assert_trouble(
        &raypencil(at, &["cast", "no-rays.toml"]),
        &["no-rays.toml", "there is no table `[[rays]]`"],
    );
    let outcome = raypencil(at, &["cast", "hill.obj"]);
    assert_trouble(&outcome, &["hill.obj: no rays are given; expected RAYS, --ray, or a scene file"]);
    fs::write(at.join("off.toml"), scene.replace("0.25]", "9]") + sets).expect("a file");
    assert_trouble(&raypencil(at, &["cast", "off.toml"]), &["off.toml:5:14", "no ground under (0.1, 9)"]);
}

#[test]
fn a_scan_of_a_room_in_millimetres_is_told_and_scaled() {
    let folder = TempDir::new().unwrap();
    // A room of 4 m by 4 m in millimetres, y up, and a spinning head in metres within it.
    let corner = |k: u32| {
        let [x, y, z] = [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
        format!("v {} {} {}\n", 4000.0 * x - 2000.0, 2500.0 * y - 1200.0, 4000.0 * z - 2000.0)
    };
    let room: String = (0..8).map(corner).collect();
    let squares = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
    fs::write(folder.path().join("room.obj"), room + squares).unwrap();
    let scan =
        "[[rays]]\nname = \"scan\"\nspinning = { preset = \"vlp-16\", steps = 36 }\nposition_m = [0, 0, 0]\n";
    fs::write(folder.path().join("scan.toml"), scan).unwrap();
    let cast = |more: &[&str]| raypencil(folder.path(), &[&["cast", "room.obj", "scan.toml"], more].concat());
    let nothing = cast(&["-o", "nothing"]);
    assert_eq!(nothing.status.code(), Some(1), "{}", text(&nothing.stderr));
    let told = text(&nothing.stderr);
    for words in [
        "scan: none of the 576 rays hits the mesh",
        "the nearest at 2000 where the limit is 100",
        "millimetres",
    ] {
        assert!(told.contains(words), "{words} is not in\n{told}");
    }
    let summary = fs::read_to_string(folder.path().join("nothing/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["warnings"][0]["code"], "no_hits");
    assert_eq!(cast(&["--allow-empty"]).status.code(), Some(0));
    assert_eq!(cast(&["--allow-empty", "--with", "tracer"]).status.code(), Some(0));
    assert_eq!(cast(&["--with", "tracer"]).status.code(), Some(1));
    // In metres and with z up every ray meets a wall, the floor or the ceiling; the head is inside, so it meets fronts turned inwards.
    let scaled = cast(&["--scale", "0.001", "--up", "y", "-o", "scaled", "--with", "tracer"]);
    assert_eq!(scaled.status.code(), Some(0), "{}", text(&scaled.stderr));
    assert!(text(&scaled.stdout).contains("576 hit"), "{}", text(&scaled.stdout));
    let summary = fs::read_to_string(folder.path().join("scaled/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!((&summary["mesh"]["up"], &summary["mesh"]["scale"]), (&"y".into(), &0.001.into()));
    assert_eq!(summary["mesh"]["polygons"]["count"], 6);
    let schema = include_str!("../../../../../../docs/formats/cast.schema.json");
    let schema: serde_json::Value = serde_json::from_str(schema).unwrap();
    assert_eq!(schema_faults(&schema, &summary), Vec::<String>::new());
    // A single ray is a question: a miss is its answer. It is asked again with the same frame.
    let miss = cast(&["--scale", "1e9"]);
    assert_trouble(&miss, &["--scale 1000000000: expected 1e-6 to 1e6 metres"]);
    let one = raypencil(folder.path(), &["cast", "room.obj", "--ray", "0,0,9,0,0,1", "--scale", "0.001"]);
    assert_eq!((one.status.code(), text(&one.stderr).as_str()), (Some(0), ""));
}

#[test]
fn polygons_that_are_not_convex_or_cross_themselves_are_told() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    // A U: two legs and a courtyard. A ray into the courtyard hits nothing; one into a leg hits it once.
    let u = "v 0 0 0\nv 8 0 0\nv 8 5 0\nv 6 5 0\nv 6 2 0\nv 2 2 0\nv 2 5 0\nv 0 5 0\nf 1 2 3 4 5 6 7 8\n";
    write("u.obj", u);
    let cast = |ray: &str| screen(folder.path(), &["cast", "u.obj", "--ray", ray, "--all"], 0);
    assert!(cast("4,3,5,0,0,-1").contains("nothing is hit"));
    let leg = cast("1,4,5,0,0,-1");
    assert!(
        leg.contains("t            5") && leg.contains("1 polygon of more than three corners, 1 of them"),
        "{leg}"
    );
    let inspected = screen(folder.path(), &["terrain", "inspect", "u.obj"], 0);
    for words in [
        "area 28.000 m2",
        "polygons of more than three corners; not convex, and cut truly: 1",
        "PASS 10 checks",
    ] {
        assert!(inspected.contains(words), "{words} is not in\n{inspected}");
    }
    write("hourglass.obj", "v 0 0 0\nv 4 4 0\nv 4 0 0\nv 0 5 0\nv 9 4 2\nf 1 2 3 4\nf 1 3 2 5\n");
    let told = raypencil(folder.path(), &["cast", "hourglass.obj", "--ray", "1,1,9,0,0,-1"]);
    let words = "warning: 1 polygon of the file crosses itself, the first is polygon 0 (line 6)";
    assert!(text(&told.stderr).contains(words), "{}", text(&told.stderr));
    let inspected = screen(folder.path(), &["terrain", "inspect", "hourglass.obj"], 1);
    for words in [
        "!           1  polygons of the file that cross themselves",
        "the first: polygon 0 (line 6)",
        "not planar",
    ] {
        assert!(inspected.contains(words), "{words} is not in\n{inspected}");
    }
    let json = screen(folder.path(), &["terrain", "inspect", "hourglass.obj", "--json"], 1);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((&json["passes"], &json["polygons"]["crossing"]["first"]["line"]), (&false.into(), &6.into()));
    // A scene on such a file says it too, as do its summary and its page.
    let scene = "version = 1\nterrain = { file = \"hourglass.obj\" }\nvehicle = { position_m = [1, 1, 2] }\n\
                 camera = { width_px = 16, height_px = 16 }\nbeam = [{ columns = 16, rows = 2 }]\n";
    write("scene.toml", scene);
    let shown = raypencil(folder.path(), &["validate", "scene.toml", "--allow-empty", "-o", "out"]);
    assert!(text(&shown.stdout).contains("crosses itself"), "{}", text(&shown.stdout));
    let summary = fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    assert!(
        summary.contains("\"polygons_cross\"") && summary.contains("\"polygons_not_planar\""),
        "{summary}"
    );
}

/// A plate 0.5 m before the origin and a wall 10 m behind it.
const PLATE_AND_WALL: &str = "v 0.5 -1 -1\nv 0.5 1 -1\nv 0.5 1 1\nv 0.5 -1 1\nv 10 -20 -20\nv 10 20 -20\nv 10 20 20\n\
    v 10 -20 20\nf 1 3 2\nf 1 4 3\nf 5 7 6\nf 5 8 7\n";

#[test]
fn what_is_nearer_than_a_sensors_shortest_range_is_too_near() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    fs::write(at.join("near.obj"), PLATE_AND_WALL).expect("a file");
    let set = |min: f64| {
        let grid = "columns = 3, rows = 3, width_deg = 20, height_deg = 20";
        format!("[[rays]]\nname = \"os1\"\ngrid = {{ {grid}, min_range_m = {min}, max_range_m = 120 }}\n")
    };
    fs::write(at.join("near.toml"), set(0.8)).expect("a file");
    fs::write(at.join("nearer.toml"), set(0.4)).expect("a file");
    let read = |path: &str| read_npy_numbers(at.join(path), &Limits::default()).expect("an array").values;
    let shown =
        screen(at, &["cast", "near.obj", "near.toml", "--with", "tracer", "--any", "--all", "-o", "out"], 0);
    assert!(shown.contains("os1: 9 rays: 0 hit, 0 of them at a tie; 9 too near; 0 miss"), "{shown}");
    assert!(shown.contains("tracer: 9 the same") && shown.contains("All 9 rays agree."), "{shown}");
    assert_eq!(read("out/range.npy"), [f64::NEG_INFINITY; 9]);
    assert_eq!((read("out/any.npy"), read("out/face.npy")), (vec![1.0; 9], vec![f64::from(u32::MAX); 9]));
    // The plate and the wall behind it; the middle ray runs through the diagonals of both.
    assert_eq!(read("out/all.t.npy").len(), 2 * (9 + 1));
    let summary = fs::read_to_string(at.join("out/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let counts = serde_json::json!({ "hits": 0, "tooNear": 9, "misses": 0, "ties": 0 });
    assert_eq!(summary["counts"], counts);
    let schema = include_str!("../../../../../../docs/formats/cast.schema.json");
    assert_eq!(schema_faults(&serde_json::from_str(schema).expect("JSON"), &summary), Vec::<String>::new());
    // A sensor that measures from 0.4 m on sees the plate, and the same rays with a start at 0.8 m the wall.
    let shown = screen(at, &["cast", "near.obj", "nearer.toml", "-o", "seen"], 0);
    assert!(shown.contains("9 hit") && !shown.contains("too near"), "{shown}");
    let shown = screen(at, &["cast", "near.obj", "--ray=0,0,0,1,0,0,0.8,120"], 0);
    assert!(shown.contains("  t            10"), "{shown}");
    // One of its rays again.
    let ray = "--ray=0,0,0,1,0,0,0,120,0.8";
    let shown = screen(at, &["cast", "near.obj", ray, "--all", "--margins"], 0);
    for line in
        ["too near     the nearest surface is met before t 0.8", "all          t 0.5", "all          t 10"]
    {
        assert!(shown.contains(line), "{shown}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&screen(at, &["--json", "cast", "near.obj", ray], 0)).expect("JSON");
    let one = &json["rays"][0];
    assert_eq!(
        (&one["tooNear"], &one["tBlind"], &one["first"]),
        (&true.into(), &0.8.into(), &serde_json::Value::Null)
    );
    assert_eq!(json["counts"]["tooNear"], 1);
}

#[test]
fn recordings_tell_too_near_from_a_miss() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    fs::write(at.join("near.obj"), PLATE_AND_WALL).expect("a file");
    // Two rays into the plate, one past it onto the wall, one into the air, of a sensor that is blind before 0.8.
    let rays = "0,0,0,1,0.25,0,0,inf,0.8\n0,0,0,1,0,0.5,0,inf,0.8\n0,1.5,0,1,0,0,0,inf,0.8\n0,0,0,-1,0,0,0,inf,0.8\n";
    fs::write(at.join("rays.csv"), rays).expect("a file");
    let shown = screen(at, &["pack", "near.obj", "--rays", "rays.csv", "-o", "pack"], 0);
    assert!(shown.contains("4 rays; 1 hit, 0 of them at a tie, 2 too near, 1 miss"), "{shown}");
    for name in ["right", "other"] {
        let folder = at.join(format!("{name}/rays/mast"));
        screen(at, &["cast", "near.obj", "rays.csv", "-o", &folder.display().to_string()], 0);
    }
    let mine = at.join("other/rays/mast");
    for name in ["t", "range"] {
        let path = mine.join(format!("{name}.npy"));
        // Each -Inf becomes +Inf.
        let array = read_npy_numbers(&path, &Limits::default()).expect("an array");
        let missed: Vec<f64> =
            array.values.iter().map(|t| if t.is_finite() { *t } else { f64::INFINITY }).collect();
        raypencil::io::write_npy_numbers(&path, &array.shape, &missed).expect("a file");
    }
    let shown = screen(at, &["check", "pack", "right/rays/mast"], 0);
    assert!(shown.contains("4 rays agree with the exact answers"), "{shown}");
    let shown = screen(at, &["check", "pack", "other/rays/mast"], 1);
    for words in [
        "2 of 4 rays are wrong.",
        "no hit; exactly what is hit is too near: its surface stands before the sensor's shortest range",
        "--ray=0,0,0,1,0.25,0,0,inf,0.8 --all --margins",
        "what is too near is not told from a miss: it is -Inf, a miss is +Inf",
    ] {
        assert!(shown.contains(words), "{shown}");
    }
    // `diff` knows no scene: -inf is another number than inf, which nothing allows.
    for name in ["right", "other"] {
        let path = at.join(format!("{name}/rays/mast/range.npy"));
        let values = read_npy_numbers(path, &Limits::default()).expect("an array").values;
        let flat = at.join(format!("{name}-flat"));
        fs::create_dir(&flat).expect("a folder");
        raypencil::io::write_npy_numbers(flat.join("range.npy"), &[2, 2], &values).expect("a file");
    }
    let shown = screen(at, &["diff", "right-flat", "other-flat", "--fail", "1e9"], 1);
    assert!(shown.contains("A -inf, B inf"), "{shown}");
}

#[test]
fn a_mesh_without_any_face_is_refused_where_rays_are_cast() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    fs::write(folder.join("words.obj"), "garbage in\ngarbage out\n").unwrap();
    fs::write(folder.join("rays.csv"), "0,0,1,0,0,-1\n").unwrap();
    fs::write(
        folder.join("scene.toml"),
        "version = 1\n[terrain]\nfile = \"words.obj\"\n[vehicle]\nposition_m = [0, 0, 2]\n[[rays]]\nname = \"down\"\n\
         spinning = { elevations_deg = [-90], steps = 1 }\n",
    )
    .unwrap();
    let words =
        ["words.obj: file: no vertex and no face; its lines begin with \"garbage\"", "at least one face"];
    for line in [
        &["cast", "words.obj", "--ray", "0,0,1,0,0,-1"][..],
        &["cast", "words.obj", "rays.csv", "-o", "out"],
        &["cast", "scene.toml", "-o", "out"],
        &["pack", "words.obj", "--rays", "rays.csv", "-o", "out"],
    ] {
        assert_trouble(&raypencil(folder, line), &words);
        assert!(!folder.join("out").exists(), "{line:?}");
    }
}

/// Twenty posts 2 m apart, to the south-east of a map's (1000000, 500), all 7 m high.
#[test]
fn clouds_of_ground_in_a_map_name_their_origin() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    fs::write(at.join("flat.tif"), super::terrain::import::geotiff(5, 4, &[7.0; 20])).expect("a file");
    // The sensor stands 2 m over the middle of the ground, and looks straight down.
    let scene = "version = 1\n[terrain]\ndem = \"flat.tif\"\n[vehicle]\nposition_m = [1000005, 496]\n[[rays]]\nname = \"down\"\n\
                 spinning = { elevations_deg = [-90], steps = 2 }\nposition_m = [0, 0, 2]\n";
    fs::write(at.join("scene.toml"), scene).expect("a file");
    let json = |path: &str| -> serde_json::Value {
        serde_json::from_str(&fs::read_to_string(at.join(path)).expect("a summary")).expect("JSON")
    };
    let schema = |text: &str| -> serde_json::Value { serde_json::from_str(text).expect("JSON") };
    screen(at, &["cast", "scene.toml", "--bag", "velodyne", "-o", "out"], 0);
    let summary = json("out/summary.json");
    let of_cast = schema(include_str!("../../../../../../docs/formats/cast.schema.json"));
    assert_eq!(schema_faults(&of_cast, &summary), Vec::<String>::new());
    let origin: Vec<f64> = summary["mesh"]["originM"]
        .as_array()
        .expect("three")
        .iter()
        .map(|x| x.as_f64().expect("a number"))
        .collect();
    // Point and origin together are the place on the map, in whole numbers.
    let point = read_npy_numbers(at.join("out/point.npy"), &Limits::default()).expect("an array").values;
    let place: Vec<f64> = (0..3).map(|axis| origin[axis] + point[axis]).collect();
    assert_eq!(place, [1_000_005.0, 496.0, 7.0]);
    assert!(origin[0] > 999_999.0 && point[0].abs() < 10.0, "{origin:?}");
    for cloud in ["cloud.ply", "cloud.pcd", "cloud-sensor.pcd"] {
        let bytes = fs::read(at.join("out").join(cloud)).expect("a cloud");
        let line = format!(" map_origin_m {} {} {}\n", origin[0], origin[1], origin[2]);
        assert!(String::from_utf8_lossy(&bytes).contains(&line), "{cloud}");
    }
    screen(at, &["cast", "scene.toml", "--scans", "1", "--bag", "velodyne", "-o", "scans"], 0);
    let of_scans = schema(include_str!("../../../../../../docs/formats/scans.schema.json"));
    let summary = json("scans/summary.json");
    assert_eq!(schema_faults(&of_scans, &summary), Vec::<String>::new());
    assert_eq!(summary["mesh"]["originM"], serde_json::json!(origin));
    assert_eq!(summary["scans"]["count"], 2);
}

#[test]
fn rays_in_the_coordinates_of_a_map_are_told_where_the_scene_has_its_origin() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    fs::write(at.join("flat.tif"), super::terrain::import::geotiff(5, 4, &[7.0; 20])).expect("a file");
    let scene = "version = 1\n[terrain]\ndem = \"flat.tif\"\n[vehicle]\nposition_m = [1000005, 496]\n[[rays]]\nname = \"down\"\n\
                 spinning = { elevations_deg = [-90], steps = 2 }\nposition_m = [0, 0, 2]\n";
    fs::write(at.join("scene.toml"), scene).expect("a file");
    fs::write(at.join("rays.csv"), "1000005,496,9,0,0,-1\n").expect("a file");
    let words = [
        "warning: the ray does not hit the mesh. 1 of 1 that were tried would if they began (",
        "frame of the scene",
    ];
    for (rays, code) in [(["--ray", "1000005,496,9,0,0,-1"].as_slice(), 0), (&["rays.csv"], 1)] {
        let run = raypencil(at, &[&["cast", "scene.toml"], rays].concat());
        assert_eq!(run.status.code(), Some(code), "{rays:?}");
        let told = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(words.iter().all(|word| told.contains(word)), "{told}");
        // What it names is what makes the ray hit, and the first line of the screen has it as well.
        let (_, origin) = told.split_once("began (").expect("an origin");
        let origin = origin.split_once(')').expect("its end").0;
        let first = String::from_utf8_lossy(&run.stdout).lines().next().expect("a line").to_string();
        assert!(first.contains(&format!("its origin at ({origin}) of the map")), "{first}");
        let parts: Vec<f64> = origin.split(", ").map(|part| part.parse().expect("a number")).collect();
        let ray = format!("{},{},{},0,0,-1", 1_000_005.0 - parts[0], 496.0 - parts[1], 9.0 - parts[2]);
        let shown = screen(at, &["cast", "scene.toml", &format!("--ray={ray}")], 0);
        assert!(shown.contains("1 ray: 1 hit") && shown.contains("0 miss"), "{shown}");
    }
}

#[test]
fn returns_of_beams_are_counted_and_written() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    // Two walls, of which the nearer ends in the middle of the view.
    let walls = "v 10 -0.001 -9\nv 10 9 -9\nv 10 9 9\nv 10 -0.001 9\nv 20 -9 -9\nv 20 9 -9\nv 20 9 9\nv 20 -9 9\nf 1 2 3 4\nf 5 6 7 8\n";
    fs::write(at.join("walls.obj"), walls).expect("a file");
    let of =
        "of = { grid = { columns = 3, rows = 1, width_deg = 40, height_deg = 0 } }, divergence_mrad = 20";
    let set =
        format!("[[rays]]\nname = \"wide\"\ncone = {{ {of}, returns = {{ keep = 2, separation_m = 1 }} }}\n");
    fs::write(at.join("wide.toml"), set).expect("a file");
    let shown = screen(at, &["cast", "walls.obj", "wide.toml", "--bag", "ouster", "-o", "out"], 0);
    assert!(shown.contains("wide: 3 footprints: 3 have a return, 1 are mixed; 4 returns told"), "{shown}");
    // The number of a point's return is judged, and so is it said.
    screen(at, &["pack", "walls.obj", "--rays", "wide.toml", "-o", "pack"], 0);
    let checked = screen(at, &["check", "pack", "out/cloud.pcd", "--frame", "mesh"], 0);
    let judged = checked.split("Judged: ").nth(1).expect("what was judged").lines().next().expect("a line");
    assert!(judged.split([' ', ',', '.']).any(|word| word == "return"), "{judged}");
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(at.join("out/summary.json")).expect("a summary"))
            .expect("JSON");
    let schema = include_str!("../../../../../../docs/formats/cast.schema.json");
    assert_eq!(schema_faults(&serde_json::from_str(schema).expect("JSON"), &summary), Vec::<String>::new());
    assert_eq!(summary["returns"]["keep"], 2);
    let read =
        |name: &str| read_npy_numbers(at.join("out").join(name), &Limits::default()).expect("an array");
    // The left beam is on the near wall, the middle one on both, the right one on the far wall.
    assert_eq!(
        (read("return.count.npy").shape, read("return.count.npy").values),
        (vec![1, 3], vec![1.0, 2.0, 1.0])
    );
    assert_eq!(read("return.range.npy").shape, [1, 3, 2]);
    let page = fs::read_to_string(at.join("out/report.html")).expect("a page");
    assert!(page.contains("\"mixed\"") && page.contains("\"return\""), "maps of returns");
    let json = screen(at, &["--json", "cast", "walls.obj", "wide.toml"], 0);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["sets"][0]["returns"]["mixed"], 1);
}
