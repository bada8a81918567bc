//! Wrong scene files: line, column, marked text and message of each error.

use miette::Diagnostic;

use raypencil_files::write_npy;
use raypencil_scene::Image;
use raypencil_scene_io::{Overrides, SceneIoError, TomlProblem};

use super::load_path;

fn problem(text: &str) -> TomlProblem {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.toml");
    std::fs::write(&path, text).unwrap();
    match load_path(&path, &Overrides::default()).unwrap_err() {
        SceneIoError::Toml(problem) => *problem,
        other => panic!("not a problem of a line: {other}"),
    }
}

/// Checks the error in the third line, after `version = 1` and the header of a table.
fn third_line(table: &str, line: &str, marked: &str, message: &str) {
    let problem = problem(&format!("version = 1\n{table}\n{line}\n"));
    assert_eq!(problem.message, message, "{line}");
    assert_eq!((problem.line, problem.marked()), (3, marked), "{line}");
    let column = line.find(marked).unwrap() + 1;
    assert_eq!(problem.column, column, "{line}");
    assert!(problem.to_string().contains(&format!("bad.toml:3:{column}: ")), "{problem}");
}

#[test]
fn numbers_out_of_range_name_the_key_the_value_and_the_unit() {
    let degrees = "expected -360 to 360 degrees";
    third_line(
        "[camera]",
        "pitch_down_deg = 400",
        "400",
        &format!("`camera.pitch_down_deg` is 400; {degrees}"),
    );
    third_line("[camera]", "yaw_left_deg = nan", "nan", &format!("`camera.yaw_left_deg` is NaN; {degrees}"));
    third_line(
        "[vehicle]",
        "heading_deg = -inf",
        "-inf",
        &format!("`vehicle.heading_deg` is -inf; {degrees}"),
    );
    third_line(
        "[[beam]]",
        "fan_deg = 180",
        "180",
        "`beam.0.fan_deg` is 180; expected 0.001 to 179.9 degrees",
    );
    third_line(
        "[[beam]]",
        "wavelength_nm = 810e-9",
        "810e-9",
        "`beam.0.wavelength_nm` is 8.1e-7; expected 10 to 1000000 nanometres",
    );
    third_line("[camera]", "width_px = 0", "0", "`camera.width_px` is 0; expected 1 to 1048576 pixels");
    third_line("[camera]", "height_px = -5", "-5", "`camera.height_px` is -5; expected 1 to 1048576 pixels");
    third_line(
        "[camera]",
        "width_px = 1048576",
        "1048576",
        "`camera.width_px x height_px` is 1048576 x 1024; expected at most 67108864 pixels",
    );
    third_line(
        "[camera]",
        "pixel_pitch_um = [9, -9]",
        "[9, -9]",
        "`camera.pixel_pitch_um` is -9; expected 0.01 to 100000 micrometres",
    );
    third_line(
        "[camera]",
        "principal_point_px = [1]",
        "[1]",
        "`camera.principal_point_px` has 1 numbers; expected 2",
    );
    third_line("[vehicle]", "position_m = [1]", "[1]", "`vehicle.position_m` has 1 numbers; expected 2 or 3");
    third_line(
        "[vehicle]",
        "position_m = [0, inf]",
        "[0, inf]",
        "`vehicle.position_m` is inf; expected -1e12 to 1e12 metres",
    );
    third_line("[[beam]]", "position_m = [1, 2]", "[1, 2]", "`beam.0.position_m` has 2 numbers; expected 3");
    third_line(
        "[atmosphere]",
        "attenuation_per_m = -1",
        "-1",
        "`atmosphere.attenuation_per_m` is -1; expected 0 to 1000 per metre",
    );
    third_line("[terrain]", "reflectivity = 1.5", "1.5", "`terrain.reflectivity` is 1.5; expected 0 to 1");
    third_line(
        "[terrain]",
        "generate = { faces = 0 }",
        "0",
        "`terrain.generate.faces` is 0; expected 1 to 16777216",
    );
    third_line(
        "[terrain]",
        "generate = { seed = -1 }",
        "-1",
        "`terrain.generate.seed` is -1; expected 0 to 9223372036854775807",
    );
}

#[test]
fn keys_of_generated_ground_are_checked_alone_and_together() {
    let generate = |keys: &str, marked: &str, message: &str| {
        third_line("[terrain]", &format!("generate = {{ {keys} }}"), marked, message);
    };
    generate(
        "preset = \"worst\", hurst = 1.5",
        "1.5",
        "`terrain.generate.hurst` is 1.5; expected 0.01 to 0.99",
    );
    generate(
        "preset = \"venus\"",
        "\"venus\"",
        "`terrain.generate.preset` is \"venus\"; expected one of \"smooth\", \"viking1\", \"pathfinder\", \"crater_field\", \"crevassed\", \"worst\"",
    );
    generate(
        "preset = \"smooth\", kind = \"plain\"",
        "\"plain\"",
        "`terrain.generate.kind` beside `preset`; expected one of the two",
    );
    generate(
        "preset = \"smooth\", faces = 100",
        "100",
        "`terrain.generate.faces` beside `preset`; expected `post_spacing_m` and `rock_smallest_m`, from which they follow",
    );
    generate(
        "kind = \"plain\", hurst = 0.5",
        "0.5",
        "`terrain.generate.hurst` without a `preset`; expected it only with one",
    );
    let whole = "{ preset = \"smooth\", rock_smallest_m = 2 }";
    third_line(
        "[terrain]",
        &format!("generate = {whole}"),
        whole,
        "`terrain.generate.rock_largest_m` is 0.5; expected 2 to 100",
    );
    let whole = "{ preset = \"smooth\", extent_m = 1e5 }";
    third_line(
        "[terrain]",
        &format!("generate = {whole}"),
        whole,
        "`terrain.generate.post_spacing_m` is 0.1 m: 2000000000000 faces; expected at most 33554432 faces in all",
    );
}

#[test]
fn words_are_listed() {
    third_line(
        "[flux]",
        "model = \"lux\"",
        "\"lux\"",
        "`flux.model` is \"lux\"; expected one of \"radiometric\", \"eq1\"",
    );
    third_line(
        "[[beam]]",
        "profile = \"flat\"",
        "\"flat\"",
        "`beam.0.profile` is \"flat\"; expected one of \"paper\", \"uniform_angle\", \"gaussian\"",
    );
    third_line(
        "[terrain]",
        "builtin = \"moon\"",
        "\"moon\"",
        "`terrain.builtin` is \"moon\"; expected one of \"pyramids\", \"facets\"",
    );
    third_line(
        "[terrain]",
        "generate = { kind = \"odd\" }",
        "\"odd\"",
        "`terrain.generate.kind` is \"odd\"; expected one of \"plain\", \"nasty\"",
    );
}

#[test]
fn unknown_keys_are_marked() {
    let cases = [
        ("[camera]\nfocal_lenght_mm = 8", "focal_lenght_mm"),
        ("[vehicle]\npitch_deg = 8", "pitch_deg"),
        ("[[beam]]\nfan = 8", "fan"),
        ("[terrain]\ndem_m = \"x.tif\"", "dem_m"),
        ("[terrain]\ngenerate = { size = 3 }", "size"),
        ("[atmosphere]\nsigma = 3", "sigma"),
        ("[flux]\nkind = 3", "kind"),
        ("\n[sun]", "sun"),
    ];
    for (text, key) in cases {
        let problem = problem(&format!("version = 1\n{text}\n"));
        assert!(problem.message.starts_with(&format!("unknown key `{key}`")), "{}", problem.message);
        assert_eq!((problem.line, problem.marked()), (3, key), "{text}");
    }
}

#[test]
fn wrong_types_are_marked() {
    let cases = [
        ("[camera]", "pitch_down_deg = \"20\"", "\"20\""),
        ("[camera]", "width_px = 10.5", "10.5"),
        ("[camera]", "pixel_pitch_um = [1, 2, 3]", "[1, 2, 3]"),
        ("[camera]", "pixel_pitch_um = [1]", "[1]"),
        ("[camera]", "pixel_pitch_um = \"9\"", "\"9\""),
        ("[vehicle]", "position_m = 3", "3"),
        ("[terrain]", "generate = 7", "7"),
    ];
    for (table, line, marked) in cases {
        let problem = problem(&format!("version = 1\n{table}\n{line}\n"));
        assert_eq!((problem.line, problem.marked()), (3, marked), "{line}: {problem}");
        assert!(problem.message.contains("expected"), "{problem}");
    }
    // Tables and lists mistaken for one another.
    assert!(problem("version = 1\n[beam]\nrows = 3\n").message.starts_with("a table; expected a list"));
    assert!(
        problem("version = 1\n[[camera]]\n").message.contains("camera")
            || problem("version = 1\n[[camera]]\n").line == 2
    );
}

#[test]
fn the_version_is_read_first() {
    let missing = problem("[camera]\nnew_key = 1\n");
    assert_eq!(missing.message, "`version` is missing; expected `version = 1`, the only version there is");
    assert_eq!((missing.line, missing.column), (1, 1));
    assert_eq!(problem("").line, 1);
    for version in ["2", "0", "1.0", "\"1\"", "true"] {
        let newer = problem(&format!("# of the future\nversion = {version}\n[camera]\nnew_key = 1\n"));
        assert!(
            newer.message.starts_with(&format!("`version` is {version}; expected `version = 1`")),
            "{newer}"
        );
        assert_eq!((newer.line, newer.column, newer.marked()), (2, 11, version));
    }
}

#[test]
fn text_that_is_no_toml_is_marked() {
    let broken = problem("version = 1\n[camera]\nwidth_px = \n");
    assert_eq!(broken.line, 3, "{broken}");
    let twice = problem("version = 1\n[camera]\nwidth_px = 3\nwidth_px = 4\n");
    assert_eq!((twice.line, twice.message.as_str()), (4, "duplicate key"), "{twice}");
    // Deep nesting ends in an error, not in a stack overflow.
    let deep = problem(&format!("version = 1\nx = {}\n", "[".repeat(200_000)));
    assert_eq!(deep.line, 2, "{deep}");
    let tables = problem(&format!("version = 1\nx{} = 1\n", ".x".repeat(200_000)));
    assert_eq!(tables.message, "recursion limit");
}

#[test]
fn exactly_one_ground() {
    let one = "expected exactly one of `builtin`, `file`, `dem` and `generate`";
    let none = problem("version = 1\n[terrain]\nreflectivity = 0.1\n");
    assert_eq!((none.message, none.line), (format!("`terrain` has no ground; {one}"), 2));
    let two = problem("version = 1\n[terrain]\nfile = \"a.glb\"\nbuiltin = \"pyramids\"\n");
    assert_eq!(two.marked(), "\"pyramids\"");
    assert_eq!((two.message, two.line), (format!("`terrain.builtin` is one ground too many; {one}"), 4));
    let three = problem("version = 1\n[terrain]\nbuiltin = \"pyramids\"\nfile = \"a.glb\"\ngenerate = {}\n");
    assert_eq!((three.message, three.line), (format!("`terrain.generate` is one ground too many; {one}"), 5));
}

#[test]
fn only_a_gaussian_has_a_width() {
    let without = problem("version = 1\n[[beam]]\nprofile = \"gaussian\"\n");
    assert_eq!(
        without.message,
        "`beam.0.profile` is \"gaussian\" without a width; expected `gaussian_half_width_deg` too"
    );
    assert_eq!(without.line, 3);
    let with = problem("version = 1\n[[beam]]\n[[beam]]\ngaussian_half_width_deg = 20\n");
    assert_eq!(
        with.message,
        "`beam.1.gaussian_half_width_deg` is given; expected it only with profile = \"gaussian\", not \"paper\""
    );
    assert_eq!((with.line, with.marked()), (4, "20"));
    let narrow = problem("version = 1\n[[beam]]\nprofile = \"gaussian\"\ngaussian_half_width_deg = 0\n");
    assert_eq!(narrow.message, "`beam.0.gaussian_half_width_deg` is 0; expected 0.001 to 10000 degrees");
}

#[test]
fn terrain_files_are_found_or_marked() {
    third_line(
        "[terrain]",
        "file = \"x.off\"",
        "\"x.off\"",
        "`terrain.file` is \"x.off\"; expected a file that ends in .glb, .gltf, .stl, .obj or .ply",
    );
    let missing = problem("version = 1\n[terrain]\nfile = \"no/such.glb\"\n");
    assert!(
        missing.message.contains("there is no file") && missing.message.contains("such.glb"),
        "{missing}"
    );
    assert_eq!((missing.line, missing.marked()), (3, "\"no/such.glb\""));
}

#[test]
fn a_vehicle_off_the_ground_is_marked() {
    let off = problem("version = 1\n[vehicle]\nposition_m = [1e5, 3]\n");
    assert!(
        off.message
            .starts_with("`vehicle.position_m`: no ground under (100000, 3); expected a place within x"),
        "{off}"
    );
    assert_eq!((off.line, off.marked()), (3, "[1e5, 3]"));
}

#[test]
fn columns_count_characters() {
    let problem =
        problem("version = 1\n[terrain]\ngenerate = { kind = \"\u{e9}\u{e9}\u{1f600}\", seed = -3 }\n");
    assert_eq!(problem.marked(), "\"\u{e9}\u{e9}\u{1f600}\"");
    assert_eq!(problem.column, 21);
    let problem = self::problem("version = 1\n[vehicle]\n\"\u{e9}\" = 3\n");
    assert_eq!(problem.line, 3);
}

#[test]
fn the_report_shows_the_line_and_a_caret() {
    let problem = problem("version = 1\n[camera]\npitch_down_deg = 400 # steep\n");
    let error = SceneIoError::Toml(Box::new(problem));
    assert_eq!(error.code().unwrap().to_string(), "raypencil::toml");
    let mut report = String::new();
    let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
    handler.render_report(&mut report, &error).unwrap();
    assert!(report.contains("3 \u{2502} pitch_down_deg = 400 # steep"), "{report}");
    assert!(report.contains("here"), "{report}");
}

#[test]
fn a_file_that_is_no_text_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("binary.toml");
    std::fs::write(&path, b"version = 1\n# \xff\n").unwrap();
    let message = load_path(&path, &Overrides::default()).unwrap_err().to_string();
    assert!(message.contains("binary.toml: cannot read: invalid utf-8"), "{message}");
    std::fs::write(&path, vec![b' '; (1 << 20) + 1]).unwrap();
    let message = load_path(&path, &Overrides::default()).unwrap_err().to_string();
    assert!(message.contains("larger than 1048576 bytes"), "{message}");
}

#[test]
fn a_drive_names_its_keys() {
    let bad = |line: &str, marked: &str, message: &str| {
        third_line("[drive]", line, marked, message);
    };
    bad("waypoints_m = [[1, 2], [3]]", "[3]", "`drive.waypoints_m` has 1 numbers; expected 2");
    bad("waypoints_m = []", "[]", "`drive.waypoints_m` has 0 places; expected 1 to 10000");
    let message = "`drive.waypoints_m` has this place twice in a row; expected another one after it";
    bad("waypoints_m = [[1, 2], [3, 4], [3, 4.0]]", "[3, 4.0]", message);

    let bad = |line: &str, marked: &str, message: &str| {
        let problem = problem(&format!("version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n{line}\n"));
        assert_eq!((problem.message.as_str(), problem.marked()), (message, marked), "{line}");
        assert_eq!(problem.column, line.find(marked).unwrap() + 1, "{line}");
    };
    let message = "`drive.rear_needed` is false; expected it only with the paper's tests, rules = { tests = \"paper\" }: the \
                   mended ones need the ground under every wheel";
    bad("rear_needed = false", "false", message);
    bad("frames_per_s = 0", "0", "`drive.frames_per_s` is 0; expected 0.001 to 10000 per second");
    bad(
        "sensor = \"film\"",
        "\"film\"",
        "`drive.sensor` is \"film\"; expected one of \"ideal\", \"ccd_1989\", \"cmos\"",
    );
    bad("map_points = 200", "200", "`drive.map_points` is 200; expected an odd number from 3 to 2001");
    bad("least_rows = 0", "0", "`drive.least_rows` is 0; expected 1 to 1000000");
    let slope = "is -1; expected 0 to 1000 of rise over distance";
    for key in ["front", "rear", "length", "closer"] {
        bad(&format!("slope_{key} = -1"), "-1", &format!("`drive.slope_{key}` {slope}"));
    }
    for key in ["grid_first_m", "grid_last_m", "vector_large_m", "vector_small_m", "scan_inconsistency_m"] {
        bad(&format!("{key} = 2e3"), "2e3", &format!("`drive.{key}` is 2000; expected 0 to 1000 metres"));
    }
    for key in ["front", "rear", "length"] {
        bad(&format!("true_slope_{key} = -1"), "-1", &format!("`drive.true_slope_{key}` {slope}"));
    }
    bad("true_step_m = 0", "0", "`drive.true_step_m` is 0; expected 0.001 to 100 metres");
    bad("true_clearance_m = 0", "0", "`drive.true_clearance_m` is 0; expected 0.01 to 100 metres");
    bad(
        "true_centre_of_mass_m = [0, 0]",
        "[0, 0]",
        "`drive.true_centre_of_mass_m` has 2 numbers; expected 3",
    );
    bad("grid_step_m = 0", "0", "`drive.grid_step_m` is 0; expected 0.001 to 1000 metres");
    bad("grid_half_angle_deg = 181", "181", "`drive.grid_half_angle_deg` is 181; expected 0 to 180 degrees");
    let sun = "is 91; expected 0 to 90 degrees";
    bad("sun = { elevation_deg = 91 }", "91", &format!("`drive.sun.elevation_deg` {sun}"));
    for (key, value, expected) in [
        ("azimuth_deg", "361", "-360 to 360 degrees"),
        ("optical_depth", "11", "0 to 10 of dust"),
        ("irradiance_w_per_m2_nm", "101", "0 to 100 W/m^2 per nm"),
    ] {
        let message = format!("`drive.sun.{key}` is {value}; expected {expected}");
        bad(&format!("sun = {{ elevation_deg = 30, {key} = {value} }}"), value, &message);
    }
    let line = "sun = { elevation_deg = 30, colour = 1 }";
    let unknown = problem(&format!("version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n{line}\n"));
    assert!(unknown.message.contains("unknown key `colour`"), "{}", unknown.message);
    let line = "sun = { azimuth_deg = 30 }";
    let missing = problem(&format!("version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n{line}\n"));
    assert!(missing.message.contains("the key `elevation_deg` is missing"), "{}", missing.message);
    for (angle, expected) in [
        ("0", "more than 0, or `grid_sectors` 1: all sectors have one direction"),
        ("180", "less than 180, or `grid_sectors` 1: the first sector and the last have one direction"),
    ] {
        let message = format!("`drive.grid_half_angle_deg` is {angle}; expected {expected}");
        bad(&format!("grid_half_angle_deg = {angle}"), angle, &message);
    }
    let small = |reach: &str, first: &str| {
        format!(
            "the map reaches {reach} m from its middle; expected the first radius or more, {first} m: nothing can be tested on it \
             (`drive.map_points`, `drive.map_spacing_m`, `drive.grid_first_m`)"
        )
    };
    bad("map_points = 3", "3", &small("0.1", "0.7"));
    bad("map_spacing_m = 0.001", "0.001", &small("0.1", "0.7"));
    bad("grid_first_m = 11\ngrid_last_m = 12", "11", &small("10", "11"));
    let wide = |spacing: &str, width: &str| {
        format!(
            "`drive.map_spacing_m` is {spacing}; expected at most the width of the vehicle over its wheels, {width} m \
             (`drive.track_m` plus `drive.wheel_width_m`): a cell of the map would be wider than the vehicle"
        )
    };
    bad("map_spacing_m = 1000", "1000", &wide("1000", "1.25"));
    bad("map_spacing_m = 1.26", "1.26", &wide("1.26", "1.25"));
    // A vehicle narrower than a cell of the default map: the key that made it so is named.
    bad("track_m = 0.0625\nwheel_width_m = 0.03125", "0.0625", &wide("0.1", "0.09375"));
    let order = "expected `vector_small_m` or more";
    let by_default = format!("`drive.vector_large_m` is 0.5; {order}, 0.625");
    bad("vector_large_m = 0.5", "0.5", &by_default);
    bad("vector_small_m = 1.5", "1.5", &format!("`drive.vector_large_m` is 1.25; {order}, 1.5"));
    bad("grid_sectors = 0", "0", "`drive.grid_sectors` is 0; expected 1 to 100000");
    for key in ["scan_from_deg", "scan_to_deg"] {
        bad(&format!("{key} = 200"), "200", &format!("`drive.{key}` is 200; expected -180 to 180 degrees"));
    }
    bad("scan_least_points = 0", "0", "`drive.scan_least_points` is 0; expected 1 to 1000000");
    for key in ["heading_bias_deg", "pitch_bias_deg", "roll_bias_deg"] {
        bad(&format!("{key} = 51"), "51", &format!("`drive.{key}` is 51; expected -50 to 50 degrees"));
    }
    let both = |lines: &str, message: &str| {
        let problem = problem(&format!("version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n{lines}\n"));
        assert_eq!((problem.message.as_str(), problem.line), (message, 5), "{lines}");
    };
    both(
        "detection = \"otsu\"\nthreshold_dn = 3",
        "`drive.threshold_dn` is given; expected none with detection = \"otsu\"",
    );
    both(
        "sensor = \"ccd_1989\"\nthreshold_dn = 255",
        "`drive.threshold_dn` is 255; expected less than 255, the largest number of the camera's 8 bits: no pixel would be \
         bright",
    );
    both(
        "sensor = \"cmos\"\nthreshold_dn = 5000",
        "`drive.threshold_dn` is 5000; expected less than 4095, the largest number of the camera's 12 bits: no pixel would be \
         bright",
    );
    both("scans = false\nscan_steps = 3", "a scan's number beside `scans = false`; expected one of the two");
    both("scans = false\nscan_to_deg = 3", "a scan's number beside `scans = false`; expected one of the two");
    both("grid_first_m = 2\ngrid_last_m = 1", "`drive.grid_last_m` is 1; expected `grid_first_m` or more, 2");
    both(
        "seed = 1\nfix_noise_m = 0.1",
        "`drive.fix_noise_m` is given; expected it only with `fix_every_frames`",
    );
}

#[test]
fn times_of_exposures_name_their_keys() {
    let bad = |line: &str, marked: &str, message: &str| {
        let problem = problem(&format!("version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n{line}\n"));
        assert_eq!((problem.message.as_str(), problem.marked()), (message, marked), "{line}");
    };
    bad(
        "exposure_interval_ms = -1",
        "-1",
        "`drive.exposure_interval_ms` is -1; expected 0 to 1000000 milliseconds",
    );
    bad("motion_blur_samples = 65", "65", "`drive.motion_blur_samples` is 65; expected 1 to 64");
    bad("row_time_us = -1", "-1", "`drive.row_time_us` is -1; expected 0 to 1000000 microseconds");
    bad("row_bands = 3", "3", "`drive.row_bands` is given; expected it only with `row_time_us`");
    let twice = "motion_blur_samples = 4\nrow_time_us = 1\nrow_bands = 17";
    let problem = problem(&format!("version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n{twice}\n"));
    let message =
        "`drive.row_bands` is 17; expected 1 to 16 beside 4 of `motion_blur_samples`, 64 images in all";
    assert_eq!((problem.message.as_str(), problem.marked()), (message, "17"));
}

#[test]
fn a_camera_of_a_drive_names_its_keys() {
    let bad = |table: &str, line: &str, marked: &str, message: &str| {
        let text = format!("version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n[drive.{table}]\n{line}\n");
        let problem = problem(&text);
        assert_eq!((problem.message.as_str(), problem.marked()), (message, marked), "{line}");
        assert_eq!((problem.line, problem.column), (5, line.find(marked).unwrap() + 1), "{line}");
    };
    bad("optics", "oversampling = 0", "0", "`drive.optics.oversampling` is 0; expected 1 to 64");
    bad("optics", "focus_m = -1", "-1", "`drive.optics.focus_m` is -1; expected 0.001 to inf metres");
    bad(
        "optics",
        "blurs = [{ airy_rings = 8 }, { gaussian_px = 101 }]",
        "101",
        "`drive.optics.blurs[1].gaussian_px` is 101; expected 0 to 100 pixels",
    );
    let one = "expected exactly one of `airy_rings`, `gaussian_px`, `gaussian_um`, `kernel`";
    bad("optics", "blurs = [{}]", "{}", &format!("`drive.optics.blurs[0]`: {one}"));
    let two = "{ airy_rings = 8, gaussian_um = 1 }";
    bad("optics", &format!("blurs = [{two}]"), two, &format!("`drive.optics.blurs[0]`: {one}"));
    bad(
        "optics",
        "dust = { halo_share = 2 }",
        "2",
        "`drive.optics.dust.halo_share` is 2; expected 0 to 1 of 1",
    );
    bad(
        "optics",
        "speckle_contrast = 1.5",
        "1.5",
        "`drive.optics.speckle_contrast` is 1.5; expected 0 to 1 of 1",
    );
    bad("electronics", "bits = 17", "17", "`drive.electronics.bits` is 17; expected 1 to 16");
    bad(
        "electronics",
        "temperature_c = -300",
        "-300",
        "`drive.electronics.temperature_c` is -300; expected -223.15 to 226.85 degrees Celsius",
    );
}

#[test]
fn a_kernel_file_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text =
        "version = 1\n[drive]\nwaypoints_m = [[1, 2]]\n[drive.optics]\nblurs = [{ kernel = \"k.npy\" }]\n";
    std::fs::write(&scene, text).unwrap();
    let kernel = folder.path().join("k.npy");
    let message = || load_path(&scene, &Overrides::default()).unwrap_err().to_string();
    let write = |planes: &[&Image<f64>]| write_npy(&kernel, planes).unwrap();
    let odd = Image::filled(3, 3, 1.0);
    assert!(message().contains("`drive.optics.blurs[0].kernel`: there is no file "), "{}", message());
    write(&[&Image::filled(4, 3, 1.0)]);
    assert!(message().contains("kernel.columns is 4; expected an odd number up to 1025"), "{}", message());
    write(&[&Image::filled(3, 3, -1.0)]);
    assert!(message().contains("kernel.weights[0] is -1"), "{}", message());
    write(&[&odd, &odd]);
    assert!(message().contains("has 2 numbers in each cell"), "{}", message());
    std::fs::write(&kernel, b"not an array").unwrap();
    assert!(message().contains("k.npy"), "{}", message());
    write(&[&odd]);
    assert!(load_path(&scene, &Overrides::default()).is_ok());
}
