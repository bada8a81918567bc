//! Malformed scene files: rigs and resolved scenes.

use super::case::{Case, Item};

const FILE: &str = "scene.toml";
const RUN: &str = "validate scene.toml -o out";

/// A well-formed resolved scene whose terrain file is missing.
const RESOLVED: &str = r#"version = 1
kind = "resolved"
[camera]
scene_from_camera = { position_m = [0, 0, 1], quaternion_xyzw = [1, 0, 0, 0] }
width_px = 16
height_px = 16
pixel_pitch_m = [1e-5, 1e-5]
focal_length_m = 0.008
principal_point_px = [8, 8]
aperture_m = 0.002
transmission = 1
max_range_m = 20
[[beam]]
scene_from_beam = { position_m = [0, 0, 1], quaternion_xyzw = [1, 0, 0, 0] }
columns = 16
rows = 2
thickness_m = 0.005
grid_distance_m = 0.1
half_width_m = 0.05
max_range_m = 20
power_w = 1
wavelength_m = 8e-7
profile = "paper"
[terrain]
file = "ground.glb"
origin_m = [0, 0, 0]
[atmosphere]
attenuation_per_m = 0
[flux]
model = "radiometric"
"#;

pub(super) fn cases() -> Vec<Case> {
    let case = |name: &str, what, place: &str, text: &[u8]| {
        Case::of_file(&format!("toml-{name}"), what, RUN, FILE, text.to_vec(), place)
    };
    let rig = |name: &str, what, place: &str, text: &str| {
        case(name, what, place, format!("version = 1\n{text}").as_bytes())
    };
    let resolved = |name: &str, what, place: &str, old: &str, new: &str| {
        assert!(RESOLVED.contains(old), "{old}");
        case(&format!("resolved-{name}"), what, place, RESOLVED.replacen(old, new, 1).as_bytes())
    };
    let terrain = |name: &str, what, file: &str| {
        rig(&format!("terrain-{name}"), what, "scene.toml:3:", &format!("[terrain]\nfile = '{file}'\n"))
    };
    vec![
        case("empty", "an empty file", "`version` is missing", b""),
        case("null", "null bytes", "scene.toml:1:", &[0; 64]),
        case("not-utf8", "a byte that is not UTF-8", "utf-8", b"version = 1\n# \xff\n"),
        case("large", "a comment of two megabytes", "larger than", &vec![b'#'; 1 << 21]),
        case("version-2", "an unknown version", "scene.toml:1:11", b"version = 2"),
        case("version-text", "a version in quotes", "scene.toml:1:11", b"version = \"1\""),
        case("version-beyond", "a version beyond 2^64", "scene.toml:1:", b"version = 99999999999999999999"),
        case("kind", "an unknown kind", "scene.toml:2:", b"version = 1\nkind = \"evil\""),
        rig("cut-key", "a key without a value", "scene.toml:2:", "camera ="),
        rig("cut-table", "a truncated table header", "scene.toml:2:", "[camera"),
        rig("cut-text", "an unterminated string", "scene.toml:2:", "kind = \"res"),
        rig("cut-list", "an unterminated list", "scene.toml:", "[vehicle]\nposition_m = [0,"),
        rig(
            "deep-lists",
            "a hundred thousand open brackets",
            "scene.toml:2:",
            &format!("beam = {}", "[".repeat(100_000)),
        ),
        rig(
            "deep-tables",
            "a hundred thousand open braces",
            "scene.toml:2:",
            &format!("beam = {}", "{a=".repeat(100_000)),
        ),
        rig(
            "deep-keys",
            "a key of a hundred thousand parts",
            "recursion limit",
            &format!("a{} = 1", ".a".repeat(100_000)),
        ),
        rig(
            "deep-header",
            "a table of a hundred thousand parts",
            "recursion limit",
            &format!("[a{}]", ".a".repeat(100_000)),
        ),
        rig(
            "deep-closed",
            "a thousand brackets, all closed",
            "scene.toml:2:",
            &format!("beam = {}{}", "[".repeat(1000), "]".repeat(1000)),
        ),
        rig(
            "long-line",
            "a line of a million letters",
            "scene.toml:2:",
            &format!("evil = \"{}\"", "x".repeat(1_000_000)),
        ),
        rig(
            "long-key",
            "a key of a million letters",
            "scene.toml:2:",
            &format!("{} = 1", "x".repeat(1_000_000)),
        ),
        rig(
            "many-keys",
            "a hundred thousand unknown keys",
            "scene.toml:2:",
            &(0..100_000).map(|key| format!("k{key}=1\n")).collect::<String>(),
        ),
        rig(
            "many-tables",
            "fifty thousand unknown tables",
            "scene.toml:2:",
            &(0..50_000).map(|key| format!("[t.k{key}]\n")).collect::<String>(),
        ),
        rig("many-beams", "a hundred thousand beams", "", &"[[beam]]\n".repeat(100_000)),
        rig("escape", "terminal escape codes", "scene.toml:2:", "camera = \"\u{1b}[2J\""),
        rig(
            "escape-written",
            "terminal escape codes, escaped in TOML",
            "scene.toml:3:",
            "[flux]\nmodel = \"\\u001b[2J\\u0007\"",
        ),
        rig("key-twice", "a duplicate key", "scene.toml:4:", "[flux]\nmodel = \"eq1\"\nmodel = \"eq1\""),
        rig("table-twice", "a duplicate table", "scene.toml:3:", "[flux]\n[flux]"),
        rig("table-number", "a number in place of a table", "scene.toml:2:", "camera = 1"),
        rig("nan", "a range that is not a number", "scene.toml:3:", "[camera]\nmax_range_m = nan"),
        rig("infinite", "a heading of infinity", "scene.toml:3:", "[vehicle]\nheading_deg = -inf"),
        rig("beyond-double", "a position of 1e999", "scene.toml:3:", "[vehicle]\nposition_m = [1e999, 0]"),
        rig("width-0", "a camera without columns", "scene.toml:3:", "[camera]\nwidth_px = 0"),
        rig("width-negative", "a negative width", "scene.toml:3:", "[camera]\nwidth_px = -1"),
        rig("width-2-53", "a width beyond 2^53", "scene.toml:3:", "[camera]\nwidth_px = 9007199254740993"),
        rig("width-real", "a width of 16.5", "scene.toml:3:", "[camera]\nwidth_px = 16.5"),
        rig(
            "square",
            "2^20 x 2^20 pixels",
            "scene.toml:4:",
            "[camera]\nwidth_px = 1048576\nheight_px = 1048576",
        ),
        rig("pencils", "2^40 pencils", "scene.toml:4:", "[[beam]]\ncolumns = 1048576\nrows = 1048576"),
        rig(
            "faces",
            "2^62 generated faces",
            "scene.toml:3:",
            "[terrain]\ngenerate = { faces = 4611686018427387904 }",
        ),
        rig("faces-negative", "-1 generated faces", "scene.toml:3:", "[terrain]\ngenerate = { faces = -1 }"),
        rig(
            "position-long",
            "a position of a hundred thousand numbers",
            "scene.toml:3:",
            &format!("[vehicle]\nposition_m = [{}]", "0,".repeat(100_000)),
        ),
        rig(
            "position-tall",
            "a position of a hundred thousand numbers, one in each line",
            "scene.toml:3:",
            &format!("[vehicle]\nposition_m = [{}]", "0,\n".repeat(100_000)),
        ),
        rig(
            "far-right",
            "a syntax error a hundred thousand columns to the right",
            "scene.toml:2:",
            &format!("a = [{}]]", " ".repeat(100_000)),
        ),
        rig(
            "letters",
            "a long line of letters of three bytes",
            "scene.toml:2:",
            &format!("evil = \"{}\"", "\u{2668}".repeat(10_000)),
        ),
        rig(
            "turned",
            "letters that reverse the direction of writing",
            "scene.toml:2:",
            "evil = \"\u{202e}\u{2066}\"",
        ),
        rig(
            "two-grounds",
            "two terrains",
            "scene.toml:4:",
            "[terrain]\nbuiltin = \"pyramids\"\nfile = \"a.glb\"",
        ),
        rig(
            "off-ground",
            "a vehicle far from the terrain",
            "scene.toml:3:",
            "[vehicle]\nposition_m = [1e9, 0]",
        ),
        terrain("missing", "a missing terrain", "ground.glb"),
        terrain("not-known", "/etc/passwd as terrain", "/etc/passwd"),
        terrain("null", "a terrain with an unknown file extension", "ground.glb%00"),
        rig(
            "terrain-null-byte",
            "a terrain with a null byte in its name",
            "scene.toml:3:",
            "[terrain]\nfile = \"ground\\u0000.glb\"",
        ),
        terrain("folder", "a folder in place of the terrain", "ground.glb").item("ground.glb", Item::Folder),
        terrain("pipe", "a pipe in place of the terrain", "ground.glb").item("ground.glb", Item::Pipe),
        terrain("device", "a link to /dev/zero in place of the terrain", "ground.glb")
            .item("ground.glb", Item::Link("/dev/zero".into())),
        rig(
            "terrain-empty",
            "a good scene with an empty terrain file",
            "ground.glb",
            "[terrain]\nfile = \"ground.glb\"",
        )
        .file("ground.glb", "")
        .says(&["ground.glb", "first bytes"]),
        resolved(
            "key-missing",
            "a resolved scene without a camera's aperture",
            "scene.toml:",
            "aperture_m = 0.002\n",
            "",
        ),
        resolved(
            "key-unknown",
            "a resolved scene with an unknown key",
            "scene.toml:",
            "[flux]\n",
            "[flux]\nevil = 1\n",
        ),
        resolved(
            "quaternion-nan",
            "a rotation that is not a number",
            "scene.toml:4:",
            "[1, 0, 0, 0]",
            "[nan, 0, 0, 0]",
        )
        .file("ground.glb", super::glb::good()),
        resolved("quaternion-0", "a rotation of length 0", "scene.toml", "[1, 0, 0, 0]", "[0, 0, 0, 0]")
            .file("ground.glb", super::glb::good()),
        resolved(
            "quaternion-tiny",
            "a rotation whose squared length underflows to 0",
            "scene.toml",
            "[1, 0, 0, 0]",
            "[1e-200, 0, 0, 0]",
        )
        .file("ground.glb", super::glb::good()),
        resolved(
            "width-2-32",
            "a width of 2^32 + 16",
            "scene.toml:5:",
            "width_px = 16",
            "width_px = 4294967312",
        ),
        resolved(
            "square",
            "2^20 x 2^20 pixels",
            "scene.toml:5:",
            "width_px = 16\nheight_px = 16",
            "width_px = 1048576\nheight_px = 1048576",
        ),
        resolved("range", "a range of infinity", "scene.toml:12:", "max_range_m = 20", "max_range_m = inf"),
        resolved("half-width", "a fan of width 0", "scene.toml:", "half_width_m = 0.05", "half_width_m = 0"),
        resolved(
            "origin",
            "an origin at 1e300 m",
            "scene.toml:",
            "origin_m = [0, 0, 0]",
            "origin_m = [1e300, 0, 0]",
        ),
        resolved(
            "origin-short",
            "an origin of two numbers",
            "scene.toml:",
            "origin_m = [0, 0, 0]",
            "origin_m = [0, 0]",
        ),
        resolved("ground-missing", "a missing terrain", "scene.toml:25:", "ground.glb", "ground.glb"),
        Case::new("toml-folder", "a folder in place of the file", RUN, &[FILE, "folder"])
            .item(FILE, Item::Folder),
        Case::new("toml-pipe", "a pipe in place of the file", RUN, &[FILE, "not a regular file"])
            .item(FILE, Item::Pipe),
        Case::new("toml-missing", "no file", RUN, &[FILE, "does not exist"]),
    ]
}
