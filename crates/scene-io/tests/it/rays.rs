//! Tables `[[rays]]`: sets from patterns and from files, and what is refused.

use std::path::Path;

use glam::DVec3;
use proptest::prelude::*;
use raypencil_scene::Sides;
use raypencil_scene_io::{LoadedRaySets, ray_sets_from_text, read_ray_sets};

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

#[test]
fn what_is_no_ray_set_is_refused_with_its_place() {
    let spin = "spinning = { preset = \"vlp-16\" }\n";
    let refused = |text: &str| one(text).unwrap_err();
    for (text, message) in [
        (
            "",
            "r.toml:1:1: `rays 0` has no pattern; expected exactly one of `file`, `spinning`, `grid` and `cone`",
        ),
        (
            "file = \"a.npy\"\nspinning = { preset = \"vlp-16\" }\n",
            "r.toml:1:1: `rays 0` has `file` and `spinning`; expected exactly one of `file`, `spinning`, `grid` and \
             `cone`",
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
            "r.toml:3:12: `rays 0.spinning.channels[0].firing` is 2; expected 0 to 0.025 s",
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
            "spinning = { preset = \"vlp-16\", azimuth_end_deg = 90 }",
            "r.toml:3:51: `rays 0.spinning` has `azimuth_end_deg` without `steps`; expected both",
        ),
        (
            "spinning = { preset = \"vlp-16\", min_range_m = 200 }",
            "r.toml:3:12: `rays 0.spinning.max_range` is 100; expected 200 to 1000000000 m",
        ),
        (
            "grid = { columns = 3, rows = 2, width_deg = 60 }",
            "r.toml:3:8: `rays 0.grid.height_deg` is missing; expected columns, rows, width_deg and height_deg, or a \
             preset",
        ),
        (
            "grid = { columns = 3, rows = 2, width_deg = 180, height_deg = 9, spacing = \"tangent\" }",
            "r.toml:3:8: `rays 0.grid.width` is 180; expected 0 to 179.9 degrees",
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
            "r.toml:3:15: `rays 0.cone.of` has no pattern; expected exactly one of `file`, `spinning` and `grid`",
        ),
        (
            "cone = { of = { spinning = { preset = \"vlp-16\" } }, divergence_mrad = 1, rings = 64 }",
            "r.toml:1:1: `rays 0` has 361050368 rays; expected at most 100000000 in all sets",
        ),
        (
            "spinning = { preset = \"vlp-16\" }\npitch = 3\n",
            "r.toml:4:1: unknown key `pitch`; did you mean `pitch_down_deg`, in degrees? Known keys: `name`, `file`, `spinning`, \
             `grid`, `cone`, `sides`, `start_s`, `position_m`, `pitch_down_deg`, `yaw_left_deg`, `roll_right_deg`, `poses`",
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
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/rays/vlp16.toml");
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
