//! Tables `[[rays]]`: sets from patterns and from files, and what is refused.

use std::path::Path;

use glam::DVec3;
use proptest::prelude::*;
use raypencil_scene::pattern::{EchoLight, Keep, Returns};
use raypencil_scene::{Pose, Sides};
use raypencil_scene_io::{
    LoadedRaySets, PoseChoice, poses_from_bag, ray_sets_from_text, read_ray_sets, read_sweeps,
};

fn read(text: &str) -> Result<LoadedRaySets, String> {
    ray_sets_from_text(text, "r.toml".as_ref()).map_err(|error| error.to_string())
}

/// One set `a` with these lines.
fn one(lines: &str) -> Result<LoadedRaySets, String> {
    read(&format!("[[rays]]\nname = \"a\"\n{lines}"))
}

#[test]
fn a_preset_is_mounted_as_a_camera_is() {
    let text = "spinning = { preset = \"vlp-16\", steps = 2 }\nposition_m = [1, 2, 3]\nyaw_left_deg = 90\n\
                pitch_down_deg = 15\nsides = \"fronts\"\nstart_s = 5\n";
    let set = one(text).unwrap().sets.remove(0);
    assert_eq!((set.name.as_str(), &set.shape[..], set.set.sides()), ("a", &[2, 16][..], Sides::Fronts));
    // To the left by 90 degrees, then nose down by 15: channel 0 looks along global y, 30 degrees down.
    let ray = set.set.rays()[0];
    let expected = DVec3::new(0.0, 0.75_f64.sqrt(), -0.5);
    assert!((ray.direction - expected).length() < 1e-15, "{}", ray.direction);
    assert!((ray.origin - DVec3::new(1.0, 2.0, 3.0)).length() < 11.3e-3);
    assert_eq!(ray.t_max, 100.0);
    let times = set.times.unwrap();
    assert_eq!((times[0], times[1]), (5.0, 5.0 + 2.304e-6));
}

/// A Velodyne fires at its own pace: another step of the azimuth is another rate.
#[test]
fn a_preset_keeps_its_period() {
    let times =
        |lines: &str| one(&format!("spinning = {{ {lines} }}\n")).unwrap().sets.remove(0).times.unwrap();
    for (lines, period) in [
        ("preset = \"vlp-16\", steps = 3, azimuth_step_deg = -0.4", 55.296e-6),
        ("preset = \"vlp-16\", steps = 3, azimuth_step_deg = -0.3981312, rate_hz = 20", 55.296e-6),
        ("preset = \"hdl-64e\", steps = 3, azimuth_end_deg = -1", 48e-6),
        // Ouster divides a turn into columns: 512 of them, at 10 Hz.
        ("preset = \"os1-64\", steps = 512, azimuth_step_deg = -0.703125", 0.1 / 512.0),
    ] {
        let times = times(lines);
        let channels = if lines.contains("vlp") { 16 } else { 64 };
        assert!((times[2 * channels] - 2.0 * period).abs() < 1e-18, "{lines}: {}", times[2 * channels]);
    }
}

#[test]
fn a_head_of_ones_own_has_its_channels_and_steps() {
    let text = "spinning = { elevations_deg = [0, 45], firing_times_us = [0, 500], vertical_offsets_mm = [0, 250], \
                steps = 4, rate_hz = 250, max_range_m = 7 }\n";
    let set = one(text).unwrap().sets.remove(0);
    // A turn of 4 ms in 4 steps to the left. The second channel fires half a step later: at 45 degrees.
    assert_eq!(set.times.as_ref().unwrap()[..3], [0.0, 500e-6, 1e-3]);
    let (first, second, third) = (set.set.rays()[0], set.set.rays()[1], set.set.rays()[2]);
    assert_eq!((first.direction, third.direction), (DVec3::X, DVec3::Y));
    assert!((second.direction - DVec3::new(0.5, 0.5, 0.5_f64.sqrt())).length() < 1e-15);
    assert_eq!((second.origin, second.t_max), (DVec3::new(0.0, 0.0, 0.25), 7.0));
    assert_eq!((second.t_min, second.t_blind), (0.0, 0.0));
    // From start to end, clockwise.
    let text =
        "spinning = { elevations_deg = [0], azimuth_start_deg = 90, azimuth_end_deg = -90, steps = 2 }\n";
    let set = one(text).unwrap().sets.remove(0);
    let directions: Vec<DVec3> = set.set.rays().iter().map(|ray| ray.direction).collect();
    assert_eq!(directions, [DVec3::Y, DVec3::X]);
    // Half a turn of a second in ten, in two steps.
    assert_eq!(set.times, Some(vec![0.0, 0.025]));
}

#[test]
fn cones_and_moving_heads_are_read() {
    let text = "cone = { of = { grid = { columns = 3, rows = 2, width_deg = 60, height_deg = 30 } }, \
                divergence_mrad = 3, rings = 1 }\n";
    let set = one(text).unwrap().sets.remove(0);
    assert_eq!((&set.shape[..], set.weights.map(|weights| weights.len())), (&[2, 3, 7][..], Some(7)));
    assert_eq!(set.returns, None);
    // The shortest range of a sensor is that of all its rays, and no start of them.
    let text =
        "cone = { of = { spinning = { preset = \"os1-64\", steps = 1 } }, divergence_mrad = 3, rings = 1 }\n";
    let set = one(text).unwrap().sets.remove(0);
    assert!(set.set.rays().iter().all(|ray| (ray.t_min, ray.t_blind) == (0.0, 0.8)));
    let text = "grid = { preset = \"l515\", columns = 1, rows = 1 }\nstart_s = 0.5\n\
                poses = [{ time_s = 0 }, { time_s = 1, position_m = [2, 0, 4], yaw_left_deg = 90 }]\n";
    let set = one(text).unwrap().sets.remove(0);
    let ray = set.set.rays()[0];
    assert_eq!(ray.origin, DVec3::new(1.0, 0.0, 2.0));
    let half = 0.5_f64.sqrt();
    assert!((ray.direction - DVec3::new(half, half, 0.0)).length() < 1e-15);
    assert_eq!(set.times, Some(vec![0.5]));
}

#[test]
fn a_cone_says_which_of_its_returns_are_told() {
    let read = |returns: &str| {
        let cone =
            "of = { grid = { columns = 3, rows = 2, width_deg = 60, height_deg = 30 } }, divergence_mrad = 3";
        let text = format!("cone = {{ {cone}, returns = {{ {returns} }} }}\n");
        one(&text).map(|mut loaded| loaded.sets.remove(0).returns)
    };
    for (word, keep) in [
        ("\"first\"", Keep::First),
        ("\"strongest\"", Keep::Strongest),
        ("\"last\"", Keep::Last),
        ("2", Keep::UpTo(2)),
    ] {
        let found = read(&format!("keep = {word}, separation_m = 0.4"));
        assert_eq!(found, Ok(Some(Returns { keep, separation_m: 0.4 })));
    }
    let expected = "expected \"first\", \"strongest\", \"last\", or how many of the strongest returns";
    for (returns, message) in [
        ("separation_m = 1", format!("`rays 0.cone.returns.keep` is missing; {expected}")),
        (
            "keep = 2",
            "`rays 0.cone.returns.separation_m` is missing; expected the gap between two returns in metres"
                .into(),
        ),
        ("keep = 0, separation_m = 1", format!("`rays 0.cone.returns.keep` is 0; {expected}, 1 to 16")),
        ("keep = 1.5, separation_m = 1", format!("`rays 0.cone.returns.keep` is 1.5; {expected}, 1 to 16")),
        (
            "keep = \"dual\", separation_m = 1",
            format!("`rays 0.cone.returns.keep` is dual; {expected}, 1 to 16"),
        ),
        (
            "keep = 2, separation_m = 0",
            "`rays 0.cone.returns.separation_m` is 0; expected 1e-6 to 1000000 metres".into(),
        ),
        (
            "keep = 2, separation_m = nan",
            "`rays 0.cone.returns.separation_m` is NaN; expected 1e-6 to 1000000 metres".into(),
        ),
    ] {
        let error = read(returns).unwrap_err();
        assert!(error.starts_with("r.toml:3:") && error.contains(&message), "{error}");
    }
}

#[test]
fn surfaces_and_air_take_light() {
    let set = |keys: &str| {
        one(&format!("grid = {{ columns = 2, rows = 2, width_deg = 60, height_deg = 30 }}\n{keys}"))
    };
    assert_eq!(set("").unwrap().sets[0].echo, EchoLight::default());
    let read = set("reflectivity = 0.25\nextinction_per_m = 1e-3\n").unwrap();
    assert_eq!(read.sets[0].echo, EchoLight { reflectivity: 0.25, extinction_per_m: 1e-3 });
    for (keys, words) in [
        ("reflectivity = 1.5\n", "`rays 0.reflectivity` is 1.5; expected 0 to 1"),
        ("extinction_per_m = -0.01\n", "`rays 0.extinction_per_m` is -0.01; expected 0 to 1000000 1/m"),
        ("extinction_per_m = nan\n", "`rays 0.extinction_per_m` is NaN; expected 0 to 1000000 1/m"),
        ("extinction_per_m = inf\n", "`rays 0.extinction_per_m` is inf; expected 0 to 1000000 1/m"),
    ] {
        let message = set(keys).unwrap_err();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn sweeps_are_the_sets_of_heads_without_their_rays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.toml");
    let head = "spinning = { elevations_deg = [2, -20], steps = 6, firing_times_us = [0, 500] }";
    let poses = "poses = [{ time_s = 0 }, { time_s = 1, position_m = [5, 0, 1] }]\nstart_s = 0.25\n";
    let returns = "returns = { keep = 2, separation_m = 1 }";
    let tables = |poses: &str| {
        format!(
            "[[rays]]\nname = \"alone\"\n{head}\n{poses}sides = \"fronts\"\nextinction_per_m = 0.01\n\
             [[rays]]\nname = \"beams\"\ncone = {{ of = {{ {head} }}, divergence_mrad = 3, rings = 1, {returns} }}\n{poses}"
        )
    };
    std::fs::write(&path, tables(poses)).unwrap();
    let (whole, swept) = (read_ray_sets(&path).unwrap(), read_sweeps(&path).unwrap());
    assert_eq!(whole.sha256, swept.sha256);
    for (set, sweep) in whole.sets.iter().zip(&swept.sweeps) {
        assert_eq!(sweep.part(0..6, "rays").unwrap(), *set);
        assert_eq!(
            sweep.part(4..6, "rays").unwrap().set.rays(),
            &set.set.rays()[4 * set.set.rays().len() / 6..]
        );
    }
    // Refused in the same words, and what is no head by its name.
    std::fs::write(&path, tables("poses = [{ time_s = 0 }, { time_s = 0.045 }]\n")).unwrap();
    let [whole, swept] = [read_ray_sets(&path).unwrap_err(), read_sweeps(&path).unwrap_err()];
    assert_eq!(whole.to_string(), swept.to_string());
    assert!(swept.to_string().contains("time of ray 6"), "{swept}");
    let grid =
        "[[rays]]\nname = \"flash\"\ngrid = { columns = 2, rows = 2, width_deg = 60, height_deg = 30 }\n";
    std::fs::write(&path, grid).unwrap();
    let message = read_sweeps(&path).unwrap_err().to_string();
    assert!(
        message.contains("`rays 0`, flash, has no firing sequences; expected a spinning head"),
        "{message}"
    );
}

#[test]
fn files_lie_beside_the_toml_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("two.csv"), "0,0,0,1,0,0\n0,0,1,0,3,0\n").unwrap();
    let toml = folder.path().join("sets.toml");
    let text = "[[rays]]\nname = \"a\"\nfile = \"two.csv\"\nyaw_left_deg = 90\n[[rays]]\nname = \"b\"\n\
                cone = { of = { file = \"two.csv\" }, divergence_mrad = 1 }\n";
    std::fs::write(&toml, text).unwrap();
    let loaded = read_ray_sets(&toml).unwrap();
    assert_eq!(loaded.sets.iter().map(|set| &set.shape[..]).collect::<Vec<_>>(), [&[2][..], &[2, 19][..]]);
    assert!((loaded.sets[0].set.rays()[1].direction - DVec3::new(-3.0, 0.0, 0.0)).length() < 1e-15);
    // The digest is of the TOML file and of the two files that it names.
    assert_ne!(loaded.sha256, raypencil_files::hex_digits(&raypencil_files::sha256(text.as_bytes())));
}

/// Times and angles in a file, as the scan patterns of Livox's simulator have them.
#[test]
fn angles_of_a_file_are_rays_with_times() {
    let folder = tempfile::tempdir().unwrap();
    let read = |text: &str, keys: &str| {
        std::fs::write(folder.path().join("rosette.csv"), text).unwrap();
        let toml = folder.path().join("sets.toml");
        let set =
            format!("[[rays]]\nname = \"a\"\nangles = {{ file = \"rosette.csv\"{keys} }}\nstart_s = 5\n");
        std::fs::write(&toml, set).unwrap();
        read_ray_sets(&toml).map(|mut loaded| loaded.sets.remove(0)).map_err(|error| error.to_string())
    };
    let set =
        read("# a rosette\n0,90,0\n0.25,-90,30\n0.5,180,-90\n", ", min_range_m = 0.1, max_range_m = 40")
            .unwrap();
    assert_eq!(set.shape, [3]);
    assert_eq!(set.times, Some(vec![5.0, 5.25, 5.5]));
    // To the left; to the right, 30 degrees up; straight down.
    let expected = [DVec3::Y, DVec3::new(0.0, -(0.75_f64.sqrt()), 0.5), DVec3::NEG_Z];
    for (ray, expected) in set.set.rays().iter().zip(expected) {
        assert!((ray.direction - expected).length() < 1e-15, "{}", ray.direction);
        assert_eq!((ray.origin, ray.t_blind, ray.t_max), (DVec3::ZERO, 0.1, 40.0));
    }
    // Zeniths are elevations that count from straight up.
    let zeniths = read("Time/s,Azimuth/deg,Zenith/deg\n0,90,90\n0.25,-90,60\n0.5,180,180\n", "").unwrap();
    let elevations =
        read("time_s, azimuth_deg, elevation_deg\n0,90,0\n0.25,-90,30\n0.5,180,-90\n", "").unwrap();
    assert_eq!(zeniths, elevations);
    assert_eq!(zeniths.set.rays()[1].t_max, f64::INFINITY);
    // As NumPy's `savetxt` has a heading, behind another comment or before one.
    for heading in
        ["time,azimuth,zenith", "Time/s Azimuth/deg Zenith/deg", "t [s] azimuth [deg] zenith [deg]"]
    {
        for rest in ["# 3 rows\n", ""] {
            let text = format!(
                "{rest}# {heading}\n# of a rosette\n0,90,90\n0.25,-90,60\n# {heading}\n0.5,180,180\n"
            );
            assert_eq!(read(&text, "").unwrap(), zeniths, "{text}");
        }
    }
    for (text, keys, message) in [
        (
            "0,90\n",
            "",
            "rosette.csv: line 1: 2 fields; expected 3 with commas between them: time, azimuth, elevation",
        ),
        // Files that were joined.
        (
            "# time,azimuth,zenith\n0,90,90\n# time,azimuth,elevation\n1,90,0\n",
            "",
            "line 3: a heading with elevation; expected zenith, as the rows before it have",
        ),
        (
            "0,90,0\n# Time/s,Azimuth/deg,Zenith/deg\n1,90,90\n",
            "",
            "line 2: a heading with zenith; expected elevation, as the rows before it have",
        ),
        // Names of more columns than there are.
        (
            "# time, azimuth, zenith, line\n0,30,80\n",
            "",
            "line 1: time,azimuth,zenith,line; expected columns in the order",
        ),
        ("0,90,0\n# time,azimuth,phi\n1,90,0\n", "", "line 2: time,azimuth,phi; expected columns"),
        ("0,90,91\n", "", "line 1: field 3: \"91\"; expected -90 to 90, as time, azimuth, elevation"),
        ("0,1,2\n0,nan,2\n", "", "line 2: field 2: \"nan\"; expected -360 to 360"),
        (
            "1700000000000000000,1,2\n",
            "",
            "line 1: field 1: \"1700000000000000000\"; expected -1000000000000 to",
        ),
        (
            "azimuth,time,elevation\n0,1,2\n",
            "",
            "line 1: azimuth,time,elevation; expected columns in the order time",
        ),
        (
            "time/ns,azimuth/deg,zenith/deg\n0,1,2\n",
            "",
            "line 1: time/ns,azimuth/deg,zenith/deg; expected columns",
        ),
        (
            "time/s,azimuth/rad,zenith/rad\n0,1,2\n",
            "",
            "line 1: time/s,azimuth/rad,zenith/rad; expected columns",
        ),
        (
            "time [s],azimuth (rad),elevation (rad)\n0,1,2\n",
            "",
            "line 1: time [s],azimuth (rad),elevation (rad); expected columns",
        ),
        (
            "# a rosette\n# azimuth,zenith,time\n1,2,0\n",
            "",
            "line 2: azimuth,zenith,time; expected columns in the order time",
        ),
        ("#t az el\n0,1,2\n", "", "line 1: t,az,el; expected columns in the order time"),
        (
            "# time [ns], azimuth [deg], elevation [deg]\n0,1,2\n",
            "",
            "line 1: time [ns],azimuth [deg],elevation [deg]; expected",
        ),
        ("# nothing\n", "", "file: no row; expected rows of time"),
        (
            "0,1,2\n",
            ", min_range_m = 2, max_range_m = 1",
            "`rays 0.angles.min_range_m` is 2; expected at most `max_range_m`, 1",
        ),
    ] {
        let error = read(text, keys).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    let error = one("angles = { min_range_m = 1 }\n").unwrap_err();
    assert!(error.contains("`rays 0.angles.file` is missing; expected rows of time, azimuth"), "{error}");
    let error = one("angles = { file = \"no.csv\" }\n").unwrap_err();
    assert!(
        error.contains("`rays 0.angles.file`: there is no file \"no.csv\"; expected angles as CSV"),
        "{error}"
    );
}

#[test]
fn what_is_no_ray_set_is_refused_with_its_place() {
    let spin = "spinning = { preset = \"vlp-16\" }\n";
    let refused = |text: &str| one(text).unwrap_err();
    for (text, message) in [
        (
            "",
            "r.toml:1:1: `rays 0` has no pattern; expected exactly one of `file`, `spinning`, `grid`, `angles` and `cone`",
        ),
        (
            "file = \"a.npy\"\nspinning = { preset = \"vlp-16\" }\n",
            "r.toml:1:1: `rays 0` has `file` and `spinning`; expected exactly one of `file`, `spinning`, `grid`, \
             `angles` and `cone`",
        ),
        (
            "file = \"no.npy\"",
            "r.toml:3:8: `rays 0.file`: there is no file \"no.npy\"; expected rays as NPY or CSV, the path relative to \
             this file",
        ),
        (
            "spinning = { preset = \"vlp-17\" }",
            "r.toml:3:23: `rays 0.spinning.preset` is \"vlp-17\"; expected one of \"vlp-16\", \"hdl-64e\", \"os1-64\"",
        ),
        (
            "spinning = { preset = \"vlp-16\", steps = 1000000000000 }",
            "r.toml:3:41: `rays 0.spinning.steps` is 1000000000000; expected 1 to 100000000",
        ),
        (
            "spinning = { elevations_deg = [0, nan], steps = 4 }",
            "r.toml:3:31: `rays 0.spinning.elevations_deg` is NaN; expected -90 to 90 degrees",
        ),
        (
            "spinning = { elevations_deg = [], steps = 4 }",
            "r.toml:3:31: `rays 0.spinning.elevations_deg` has 0 numbers; expected 1 to 1024, one for each channel",
        ),
        (
            "spinning = { elevations_deg = [1, 2], firing_times_us = [1], steps = 4 }",
            "r.toml:3:57: `rays 0.spinning.firing_times_us` has 1 numbers; expected 2",
        ),
        (
            "spinning = { elevations_deg = [1], firing_times_us = [2e6], steps = 4 }",
            "r.toml:3:12: `rays 0.spinning.firing_times_us[0]` is 2000000; expected 0 to 25000 us",
        ),
        (
            "spinning = { elevations_deg = [1] }",
            "r.toml:3:12: `rays 0.spinning` has no `steps`; expected their number",
        ),
        (
            "spinning = { elevations_deg = [1], preset = \"vlp-16\", steps = 4 }",
            "r.toml:3:12: `rays 0.spinning` has both of `preset` and `elevations_deg`; expected exactly one",
        ),
        (
            "spinning = { preset = \"vlp-16\", azimuth_step_deg = 0 }",
            "r.toml:3:12: `rays 0.spinning`: the step of the azimuth is 0; expected a step to the left or to the right",
        ),
        (
            "spinning = { preset = \"vlp-16\", azimuth_step_deg = -0.4, rate_hz = 10 }",
            "r.toml:3:12: `rays 0.spinning`: a step of 0.4 degrees at 10 turns a second; expected 0.1990656, for the preset has a firing \
             sequence every 55.296 µs",
        ),
        (
            "spinning = { preset = \"vlp-16\", azimuth_step_deg = 30 }",
            "r.toml:3:12: `rays 0.spinning`: a step of 30 degrees every 55.296 µs is 1507 turns a second; expected 0.001 to 1000",
        ),
        (
            "spinning = { preset = \"vlp-16\", azimuth_end_deg = 90 }",
            "r.toml:3:51: `rays 0.spinning` has `azimuth_end_deg` without `steps`; expected both",
        ),
        (
            "spinning = { preset = \"vlp-16\", min_range_m = 200 }",
            "r.toml:3:12: `rays 0.spinning.max_range_m` is 100; expected 200 to 1000000000 m",
        ),
        (
            "grid = { columns = 3, rows = 2, width_deg = 60 }",
            "r.toml:3:8: `rays 0.grid.height_deg` is missing; expected columns, rows, width_deg and height_deg, or a \
             preset",
        ),
        (
            "grid = { columns = 3, rows = 2, width_deg = 180, height_deg = 9, spacing = \"tangent\" }",
            "r.toml:3:8: `rays 0.grid.width_deg` is 180; expected 0 to 179.9 degrees",
        ),
        (
            "grid = { columns = 3, rows = 2, width_deg = 60, height_deg = 180, spacing = \"tangent\" }",
            "r.toml:3:8: `rays 0.grid.height_deg` is 180; expected 0 to 179.9 degrees",
        ),
        (
            "grid = { columns = 3, rows = 2, width_deg = 60, height_deg = 9, min_range_m = 3, max_range_m = 1 }",
            "r.toml:3:8: `rays 0.grid.max_range_m` is 1; expected 3 to 1000000000 m",
        ),
        (
            "grid = { columns = 20000, rows = 20000, width_deg = 60, height_deg = 60 }",
            "r.toml:3:8: `rays 0.grid: number of rays` is 400000000; expected 0 to 100000000",
        ),
        (
            "cone = { divergence_mrad = 1 }",
            "r.toml:3:8: `rays 0.cone.of` is missing; expected the pattern whose rays it replaces",
        ),
        (
            "cone = { of = {}, divergence_mrad = 1 }",
            "r.toml:3:15: `rays 0.cone.of` has no pattern; expected exactly one of `file`, `spinning`, `grid` and `angles`",
        ),
        (
            "cone = { of = { spinning = { preset = \"vlp-16\" } }, divergence_mrad = 1, rings = 64 }",
            "r.toml:1:1: `rays 0` has 361050368 rays; expected at most 100000000 in all sets",
        ),
        (
            "spinning = { preset = \"vlp-16\" }\npitch = 3\n",
            "r.toml:4:1: unknown key `pitch`; did you mean `pitch_down_deg`, in degrees? Known keys: `name`, `file`, `times_file`, `spinning`, \
             `grid`, `angles`, `cone`, `sides`, `start_s`, `position_m`, `pitch_down_deg`, `yaw_left_deg`, `roll_right_deg`, `poses`, `poses_file`, \
             `poses_topic`, `poses_frames`, `reflectivity`, `extinction_per_m`",
        ),
        ("spinning = 3", "r.toml:3:12: the number 3; expected a table of keys, { ... } or [...]"),
    ] {
        assert_eq!(refused(text), message, "{text}");
    }
    for (text, message) in [
        ("position_m = [0, 0]", "r.toml:4:14: `rays 0.position_m` has 2 numbers; expected 3"),
        (
            "sides = \"backs\"",
            "r.toml:4:9: `rays 0.sides` is \"backs\"; expected one of \"both\", \"fronts\"",
        ),
        (
            "yaw_left_deg = 4\nposes = [{ time_s = 0 }]",
            "r.toml:4:16: `rays 0.yaw_left_deg` beside `poses`; expected one of the two",
        ),
        ("poses = []", "r.toml:4:9: `rays 0.poses` is empty; expected at least one pose"),
        (
            "poses = [{ time_s = 0 }, { position_m = [0, 0, 0] }]",
            "r.toml:4:26: `rays 0.poses[1].time_s` is missing; expected the time of the pose in seconds",
        ),
        (
            "poses = [{ time_s = 0.5 }, { time_s = 0.5 }]",
            "r.toml:4:39: `rays 0.poses[1].time_s` is 0.5; expected more than 0.5 seconds, the time before it",
        ),
        (
            "poses = [{ time_s = nan }]",
            "r.toml:4:21: `rays 0.poses[0].time_s` is NaN; expected -1e12 to 1e12 seconds",
        ),
        (
            "poses = [{ time_s = 0 }, { time_s = 0.05 }]",
            "r.toml:1:1: `rays 0: time of ray 14470` is 0.050001408000000004 s; expected 0 to 0.05 s, the times of its poses",
        ),
    ] {
        assert_eq!(refused(&format!("{spin}{text}")), message, "{text}");
    }
    let set = |name: &str| format!("[[rays]]\nname = \"{name}\"\n{spin}");
    for (text, message) in [
        (
            set("a") + &set("a"),
            "r.toml:5:8: `rays 1.name` is \"a\", the name of another set; expected a name of its own",
        ),
        (
            set("A"),
            "r.toml:2:8: `rays 0.name` is \"A\"; expected 1 to 64 of the characters a to z, 0 to 9 and -",
        ),
        (
            set("../a"),
            "r.toml:2:8: `rays 0.name` is \"../a\"; expected 1 to 64 of the characters a to z, 0 to 9 and -",
        ),
        (format!("[[rays]]\n{spin}"), "r.toml:1:1: `rays 0.name` is missing; expected a name for the set"),
        (String::new(), "r.toml:1:1: there is no table `[[rays]]`; expected at least one"),
        (
            "version = 2\n".to_string() + &set("a"),
            "r.toml:1:11: `version` is 2; expected 1, the only version there is",
        ),
    ] {
        assert_eq!(read(&text).unwrap_err(), message, "{text}");
    }
}

#[test]
fn the_sets_of_a_file_have_a_limit_together() {
    let set = |name: &str, columns: u64| {
        let field = "width_deg = 60, height_deg = 60";
        format!("[[rays]]\nname = \"{name}\"\ngrid = {{ columns = {columns}, rows = 1, {field} }}\n")
    };
    let text = set("a", 1000) + &set("b", 99_999_001);
    assert_eq!(
        read(&text).unwrap_err(),
        "r.toml:4:1: `rays 1` has 99999001 rays, 100000001 with those before it; expected at most 100000000 in all sets"
    );
}

#[test]
fn the_projects_own_sets_are_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/rays/vlp16.toml");
    let loaded = read_ray_sets(&path).unwrap();
    assert_eq!((loaded.sets.len(), &loaded.sets[0].shape[..]), (1, &[1808, 16][..]));
}

/// Sets of all kinds, with few rays.
const ALL_KINDS: &str = r#"version = 1
[[rays]]
name = "a"
spinning = { elevations_deg = [1, -2], firing_times_us = [0, 3], steps = 4, azimuth_end_deg = -90, rate_hz = 9 }
poses = [{ time_s = 0, position_m = [1, 2, 3] }, { time_s = 1, yaw_left_deg = 4 }]
[[rays]]
name = "b"
sides = "fronts"
start_s = 2
cone = { of = { grid = { columns = 3, rows = 2, width_deg = 6, height_deg = 3 } }, divergence_mrad = 3, rings = 1 }
"#;

#[test]
fn sets_of_all_kinds_are_read() {
    let shapes: Vec<_> = read(ALL_KINDS).unwrap().sets.into_iter().map(|set| set.shape).collect();
    assert_eq!(shapes, [vec![4, 2], vec![2, 3, 7]]);
}

proptest! {
    /// A changed file is read or refused, with its name; nothing else happens.
    #[test]
    fn changed_sets_are_read_or_refused(
        changes in prop::collection::vec((0..ALL_KINDS.len(), prop::sample::select(b"0.-[]{}\"= \nan,e_".to_vec())), 1..4)
    ) {
        let mut bytes = ALL_KINDS.as_bytes().to_vec();
        for (at, byte) in changes {
            bytes[at] = byte;
        }
        match read(std::str::from_utf8(&bytes).unwrap()) {
            Ok(loaded) => {
                for set in loaded.sets {
                    prop_assert_eq!(set.shape.iter().product::<u64>(), set.set.rays().len() as u64);
                }
            }
            Err(message) => prop_assert!(message.starts_with("r.toml:"), "{}", message),
        }
    }
}

/// Row `index` of a walk: its time, position, and turn to the left in degrees.
fn walk(index: u32) -> (f64, DVec3, f64) {
    let k = f64::from(index);
    (0.1 * k, DVec3::new(0.5 * k, 1.0 / (1.0 + k), 1.2), k / 64.0 - 100.0)
}

/// The rotation of a pose in TOML, which turns about z, y and x.
fn rotation(yaw_left_deg: f64) -> glam::DQuat {
    let turn = |axis, degrees: f64| Pose::from_axis_angle(axis, degrees.to_radians());
    (turn(DVec3::Z, yaw_left_deg) * turn(DVec3::Y, 0.0) * turn(DVec3::X, 0.0)).rotation
}

/// A walk of so many poses, with this between its numbers.
fn trajectory(count: u32, blank: &str) -> String {
    let row = |index| {
        let (time, position, yaw) = walk(index);
        let q = rotation(yaw);
        let row = [time, position.x, position.y, position.z, q.x, q.y, q.z, q.w];
        row.map(|number| format!("{number:?}")).join(blank) + "\n"
    };
    (0..count).map(row).collect()
}

#[test]
fn poses_of_a_file_are_those_of_the_list() {
    let folder = tempfile::tempdir().unwrap();
    let toml = folder.path().join("r.toml");
    let lines = "spinning = { preset = \"vlp-16\", steps = 900 }\nstart_s = 0.25\n";
    let read = |more: &str| {
        let text = format!("[[rays]]\nname = \"a\"\n{lines}{more}");
        ray_sets_from_text(&text, &toml).map_err(|error| error.to_string())
    };
    let list: Vec<String> = (0..200)
        .map(|index| {
            let (time, position, yaw) = walk(index);
            let [x, y, z] = position.to_array();
            format!("{{ time_s = {time:?}, position_m = [{x:?}, {y:?}, {z:?}], yaw_left_deg = {yaw:?} }}")
        })
        .collect();
    let of_list = read(&format!("poses = [{}]\n", list.join(", "))).unwrap();
    for (name, blank) in [("w.tum", " "), ("w.csv", ",")] {
        std::fs::write(folder.path().join(name), trajectory(200, blank)).unwrap();
        let of_file = read(&format!("poses_file = \"{name}\"\n")).unwrap();
        assert_eq!(of_file.sets, of_list.sets, "{name}");
        // Another file is another question.
        assert_ne!(of_file.sha256, of_list.sha256);
        // As many as a TOML file cannot hold.
        std::fs::write(folder.path().join(name), trajectory(20_000, blank)).unwrap();
        let long = read(&format!("poses_file = \"{name}\"\n")).unwrap();
        // Its further poses change no ray.
        let [long_set, set] = [&long, &of_list].map(|one| &one.sets[0]);
        assert!(long_set.set == set.set && long_set.times == set.times, "{name}");
        assert_ne!(long.sha256, of_file.sha256);
    }
    let refused = |more: &str| read(more).unwrap_err();
    assert!(refused("poses_file = \"none.tum\"\n").contains("there is no file"));
    let beside = refused("poses_file = \"w.csv\"\nyaw_left_deg = 1\n");
    assert!(beside.contains("`rays 0.yaw_left_deg` beside `poses_file`"), "{beside}");
    assert!(refused("poses_file = \"w.csv\"\nposes = []\n").contains("`rays 0.poses` beside `poses_file`"));
    std::fs::write(folder.path().join("w.tum"), "0 0 0 0 0 0 0 2\n").unwrap();
    let message = refused("poses_file = \"w.tum\"\n");
    assert!(
        message.contains("w.tum: line 1: a quaternion of length 2; expected 1 to within 0.001"),
        "{message}"
    );
}

#[test]
fn rays_of_a_file_are_fired_at_times_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let rays = "0,0,0,0,0,-1\n0,0,0,1,0,0\n0,1,0,1,0,0\n";
    std::fs::write(path("rays.csv"), rays).unwrap();
    raypencil_files::write_npy_numbers(path("t.npy"), &[3], &[10.0, 10.25, 11.0]).unwrap();
    raypencil_files::write_npy_numbers(path("two.npy"), &[2], &[10.0, 11.0]).unwrap();
    raypencil_files::write_npy_numbers(path("nan.npy"), &[3], &[10.0, f64::NAN, 11.0]).unwrap();
    std::fs::write(path("w.tum"), "10 0 0 5 0 0 0 1\n11 8 0 5 0 0 0 1\n").unwrap();
    let read = |lines: &str| {
        let text = format!("[[rays]]\nname = \"a\"\n{lines}");
        ray_sets_from_text(&text, &path("r.toml")).map_err(|error| error.to_string())
    };
    let mut loaded = read("file = \"rays.csv\"\ntimes_file = \"t.npy\"\nposes_file = \"w.tum\"\n").unwrap();
    let set = loaded.sets.remove(0);
    assert_eq!(set.times, Some(vec![10.0, 10.25, 11.0]));
    // 8 m in a second: a quarter of them after a quarter of it.
    let origins: Vec<DVec3> = set.set.rays().iter().map(|ray| ray.origin).collect();
    assert_eq!(origins, [[0.0, 0.0, 5.0], [2.0, 0.0, 5.0], [8.0, 1.0, 5.0]].map(DVec3::from_array));
    let refused = |lines: &str| read(lines).unwrap_err();
    let shape = refused("file = \"rays.csv\"\ntimes_file = \"two.npy\"\n");
    assert!(
        shape.contains("`rays 0.times_file` has shape [2]; expected [3], a time for each ray of `file`"),
        "{shape}"
    );
    assert!(refused("file = \"rays.csv\"\ntimes_file = \"nan.npy\"\n").contains("the time of ray 1 is NaN"));
    assert!(refused("file = \"rays.csv\"\ntimes_file = \"no.npy\"\n").contains("there is no file"));
    let pattern = refused("spinning = { preset = \"vlp-16\" }\ntimes_file = \"t.npy\"\n");
    assert!(pattern.contains("`rays 0.times_file` without `file`"), "{pattern}");
}

/// A bag of `rosbags`, with poses of three topics: 1.7e9 s + 0.25 s k, k metres along x, turned by 60 k degrees.
#[test]
fn poses_of_a_bag_are_those_of_its_messages() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("walk.mcap"), include_bytes!("../../../../base/rosbag/tests/data/poses-zstd.mcap"))
        .unwrap();
    std::fs::write(path("w.tum"), "10 0 0 5 0 0 0 1\n").unwrap();
    let read = |lines: &str| {
        let lines = lines.replace("BAG", "poses_file = \"walk.mcap\"");
        let text =
            format!("[[rays]]\nname = \"a\"\ngrid = {{ preset = \"l515\", columns = 1, rows = 1 }}\n{lines}");
        ray_sets_from_text(&text, &path("r.toml")).map_err(|error| error.to_string())
    };
    let chosen =
        ["poses_topic = \"/odom\"", "poses_topic = \"/pose\"", "poses_frames = [\"map\", \"lidar\"]"];
    for choice in chosen {
        let loaded = read(&format!("start_s = 1700000000.125\nBAG\n{choice}\n")).unwrap();
        let ray = loaded.sets[0].set.rays()[0];
        // Half-way from the first pose to the second.
        assert_eq!(ray.origin, DVec3::new(0.5, -0.25, 1.5), "{choice}");
        // 30 degrees to the left.
        assert!(
            (ray.direction - DVec3::new(0.75_f64.sqrt(), 0.5, 0.0)).length() < 1e-15,
            "{}",
            ray.direction
        );
    }
    let refused = |lines: &str| read(lines).unwrap_err();
    for (lines, message) in [
        ("BAG", "walk.mcap: file: poses of /odom (base_link in odom), /pose (in map), "),
        (
            "BAG\nposes_topic = \"/imu\"",
            "walk.mcap: topic /imu: no pose; expected messages of nav_msgs/msg/Odometry",
        ),
        (
            "BAG\nposes_frames = [\"map\"]",
            "`rays 0.poses_frames` has 1 names; expected two: the parent and the child",
        ),
        (
            "poses_file = \"w.tum\"\nposes_topic = \"/odom\"",
            "`rays 0.poses_topic` without a bag; expected it beside a `poses_file`",
        ),
        ("poses_frames = [\"map\", \"lidar\"]", "`rays 0.poses_frames` without a bag"),
    ] {
        let error = refused(lines);
        assert!(error.contains(message), "{error}");
    }
}

/// Stamps that do not ascend, and a quaternion of length 2, in bags of this house.
#[test]
fn poses_of_a_bag_are_checked_as_those_of_a_file() {
    use raypencil_rosbag::{BagWriter, Header, Stamp, TfMessage, Topic, TransformStamped};
    let folder = tempfile::tempdir().unwrap();
    let told = |seconds: u64, w: f64| {
        let stamp = Stamp::from_nanoseconds(seconds * 1_000_000_000);
        let header = Header { stamp, frame_id: "map".into() };
        let mut one =
            TransformStamped { header, child_frame_id: "lidar".into(), ..TransformStamped::default() };
        one.transform.rotation.w = w;
        TfMessage { transforms: vec![one] }
    };
    for (second, message) in [
        (told(4, 1.0), "message 2 of /tf: a time of 4; expected more than 4 seconds, the time before it"),
        (told(5, 2.0), "message 2 of /tf: a quaternion of length 2; expected 1 to within 0.001"),
        (told(5, f64::NAN), "message 2 of /tf: a quaternion of length NaN"),
    ] {
        let path = folder.path().join("bag");
        let mut bag = BagWriter::create(&path).unwrap();
        for one in [told(4, 1.0), second] {
            bag.write(&Topic::new("/tf"), Stamp::from_nanoseconds(1), &one).unwrap();
        }
        bag.finish().unwrap();
        let bytes = std::fs::read(path.join("bag_0.mcap")).unwrap();
        let error =
            poses_from_bag(&bytes, &PoseChoice::default(), Path::new("bag_0.mcap")).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}
