//! Malformed sets of rays in TOML.

use super::case::Case;

const FILE: &str = "rays.toml";
const RUN: &str = "cast mesh.obj rays.toml -o out";

/// A triangle.
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

pub(super) fn cases() -> Vec<Case> {
    let case = |name: &str, what, place: &str, text: &str| {
        Case::of_file(&format!("rays-{name}"), what, RUN, FILE, text.into(), place).file("mesh.obj", MESH)
    };
    let set = |name: &str, what, place: &str, lines: &str| {
        case(name, what, place, &format!("[[rays]]\nname = \"a\"\n{lines}"))
    };
    let poses: String = (0..20_000).map(|k| format!("{{time_s={k}}},")).collect();
    vec![
        case("empty", "no set", "rays.toml:1:1", ""),
        case("nameless", "a set without a name", "rays.toml:1:1", "[[rays]]\n"),
        case("path", "a name that leads out of the folder", "rays.toml:2:8", "[[rays]]\nname = \"../a\"\n"),
        case(
            "twice",
            "two sets of the same name",
            "rays.toml:5:8",
            &"[[rays]]\nname = \"a\"\nfile = \"a.csv\"\n".repeat(2),
        ),
        case("many", "fifty thousand sets", "rays.toml:", &"[[rays]]\n".repeat(50_000)),
        set("none", "a set without a pattern", "has no pattern", ""),
        set("number", "a number in place of a pattern", "rays.toml:3:8", "grid = 3"),
        set("unknown", "an unknown key", "rays.toml:3:1", "lidar = 3"),
        set("preset", "an unknown preset", "rays.toml:3:23", "spinning = { preset = \"vlp-17\" }"),
        set("missing", "a file that is not there", "rays.toml:3:8", "file = \"gone.npy\""),
        set(
            "steps",
            "a million million steps",
            "rays.toml:3:41",
            "spinning = { preset = \"vlp-16\", steps = 1000000000000 }",
        ),
        set(
            "columns",
            "ten million million rays",
            "number of rays",
            "grid = { columns = 100000000, rows = 100000, width_deg = 9, height_deg = 9 }",
        ),
        set(
            "cone",
            "cones of more than a thousand million rays",
            "rays.toml:1:1",
            "cone = { of = { spinning = { preset = \"hdl-64e\" } }, divergence_mrad = 1, rings = 60 }",
        ),
        set(
            "nested",
            "a cone of a cone",
            "rays.toml:3:17",
            "cone = { of = { cone = { divergence_mrad = 1 } }, divergence_mrad = 1 }",
        ),
        set(
            "nan",
            "an elevation that is not a number",
            "rays.toml:3:31",
            "spinning = { elevations_deg = [nan], steps = 4 }",
        ),
        set(
            "infinite",
            "an infinite position",
            "rays.toml:4:14",
            "grid = { preset = \"l515\" }\nposition_m = [0, inf, 0]",
        ),
        set(
            "times",
            "poses whose times do not ascend",
            "rays 0.poses[1].time_s",
            "grid = { preset = \"l515\" }\nposes = [{ time_s = 1 }, { time_s = 1 }]",
        ),
        set(
            "late",
            "poses that end before the rays",
            "time of ray 16",
            "spinning = { preset = \"vlp-16\" }\nposes = [{ time_s = 0 }, { time_s = 5e-5 }]",
        ),
        set(
            "poses",
            "twenty thousand poses beside a position",
            "rays 0.position_m",
            &format!("grid = {{ preset = \"l515\" }}\nposition_m = [0, 0, 0]\nposes = [{poses}]"),
        ),
    ]
}
