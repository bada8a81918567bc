//! Hostile keys and values of settings, of `--set` and of a list of runs. What a key takes stands here once more, from the tables of
//! docs/guide/scene.md: so it is known of every value whether it is right to be accepted.

use super::Family;
use super::edits::hostile_toml;
use crate::malformed::case::Case;

/// A scene of a few rays, in which all keys below can be set.
const SCENE: &str = "version = 1
[vehicle]
position_m = [-0.6, 0, 0]
[camera]
width_px = 8
height_px = 6
pixel_pitch_um = 1000
pitch_down_deg = 40
filter = { centre_nm = 810, width_nm = 10 }
[terrain]
builtin = \"pyramids\"
[[beam]]
columns = 4
rows = 1
";

/// What a key takes.
#[derive(Clone, Copy)]
enum Takes {
    /// Whole numbers in a range.
    Whole(i64, i64),
    /// Numbers in a range.
    Number(f64, f64),
    /// A number in a range, or a list of two.
    OneOrTwo(f64, f64),
    /// Some words.
    Words(&'static [&'static str]),
}

use Takes::{Number, OneOrTwo, Whole, Words};

const TURN: Takes = Number(-360.0, 360.0);

const KEYS: [(&str, Takes); 31] = [
    ("vehicle.heading_deg", TURN),
    ("vehicle.pitch_down_deg", TURN),
    ("vehicle.roll_right_deg", TURN),
    ("camera.pitch_down_deg", TURN),
    ("camera.yaw_left_deg", TURN),
    ("camera.roll_right_deg", TURN),
    ("camera.width_px", Whole(1, 1 << 20)),
    ("camera.height_px", Whole(1, 1 << 20)),
    ("camera.pixel_pitch_um", OneOrTwo(0.01, 1e5)),
    ("camera.focal_length_mm", Number(0.01, 1e5)),
    ("camera.aperture_mm", Number(0.001, 1e4)),
    ("camera.transmission", Number(0.0, 1.0)),
    ("camera.filter.centre_nm", Number(10.0, 1e6)),
    ("camera.filter.width_nm", Number(0.001, 1e6)),
    ("camera.filter.index", Number(1.0, 10.0)),
    ("camera.max_range_m", Number(0.001, 1e7)),
    ("beam.0.pitch_down_deg", TURN),
    ("beam.0.yaw_left_deg", TURN),
    ("beam.0.roll_right_deg", TURN),
    ("beam.0.fan_deg", Number(0.001, 179.9)),
    ("beam.0.thickness_mm", Number(0.001, 1e5)),
    ("beam.0.grid_distance_mm", Number(0.1, 1e5)),
    ("beam.0.columns", Whole(1, 1 << 20)),
    ("beam.0.rows", Whole(1, 1 << 20)),
    ("beam.0.power_w", Number(0.0, 1e6)),
    ("beam.0.wavelength_nm", Number(10.0, 1e6)),
    ("beam.0.max_range_m", Number(0.001, 1e7)),
    ("beam.0.profile", Words(&["paper", "uniform_angle"])),
    ("terrain.reflectivity", Number(0.0, 1.0)),
    ("atmosphere.attenuation_per_m", Number(0.0, 1000.0)),
    ("flux.model", Words(&["radiometric", "eq1"])),
];

/// Keys that are none, or none of a scene.
fn no_keys() -> Vec<String> {
    let mut keys: Vec<String> = [
        "",
        ".",
        "..",
        "camera",
        "camera.",
        ".camera",
        "camera..width_px",
        "camera.width_px.",
        "camera.width_px.x",
        "camera.0.width_px",
        "beam.1.columns",
        "beam.-1.columns",
        "beam.+0.columns",
        "beam.00.columns",
        "beam.18446744073709551616.columns",
        "beam.0.0.columns",
        "beam.x.columns",
        "beam.0",
        "version.x",
        "Camera.width_px",
        "camera.WIDTH_PX",
        "camera width_px",
        "camera/width_px",
        "camera.width px",
        " ",
        "camera[0].width_px",
        "beam[0].columns",
        "camera.\"width_px",
        "'camera.width_px",
        "camera.{width_px}",
        "#camera.width_px",
        "camera.width_px#",
        "camera.width_px\n[x]\ny",
        "c\u{e0}mera.width_px",
        "camera\u{2024}width_px",
        "\u{202e}camera.width_px",
        "\u{1b}[2J",
        "camera.filter.centre_nm.x",
        "rays.0.name",
        "drive",
        "__proto__.x",
        "terrain.file.x",
        "terrain.generate",
        "sensor.width_px",
        "0",
        "-1",
        "camera.width_px;camera.height_px",
    ]
    .map(String::from)
    .to_vec();
    keys.extend([84, 85, 1000, 30_000].map(|parts| vec!["a"; parts].join(".")));
    keys.extend([100, 10_000, 100_000].map(|letters| "a".repeat(letters)));
    keys
}

/// Values with whether they are right for a key, by name.
fn values(takes: Takes) -> Vec<(String, String, bool)> {
    let mut texts: Vec<(String, String)> =
        hostile_toml().into_iter().map(|(name, text)| (name.to_string(), text)).collect();
    // An argument has no zero byte, and no place for what makes it one of two.
    texts.retain(|(name, _)| name != "byte-0");
    let mut add = |name: &str, text: String| texts.push((name.into(), text));
    match takes {
        Whole(least, most) => {
            for (name, number) in
                [("least", least), ("most", most), ("below", least - 1), ("above", most + 1), ("two", 2)]
            {
                add(name, number.to_string());
            }
            add("least-as-real", format!("{least}.0"));
            add("least-in-quotes", format!("\"{least}\""));
            add("least-in-hexadecimal", format!("{least:#x}"));
        }
        Number(least, most) | OneOrTwo(least, most) => {
            let beyond = (most - least) * 1e-6;
            for (name, number) in [
                ("least", least),
                ("most", most),
                ("below", least - beyond),
                ("above", most + beyond),
                ("middle", least + (most - least) / 3.0),
            ] {
                add(name, format!("{number:?}"));
            }
            add("middle-in-quotes", format!("\"{:?}\"", (most + least) / 2.0));
            add("middle-listed", format!("[{:?}]", (most + least) / 2.0));
            add("middle-twice", format!("[{0:?}, {0:?}]", (most + least) / 2.0));
            add("middle-and-above", format!("[{:?}, {most}9]", (most + least) / 2.0));
            add("three", format!("[{0:?}, {0:?}, {0:?}]", (most + least) / 2.0));
        }
        Words(words) => {
            for (at, word) in words.iter().enumerate() {
                add(&format!("word-{at}"), word.to_string());
                add(&format!("quoted-{at}"), format!("\"{word}\""));
                add(&format!("upper-{at}"), word.to_uppercase());
                add(&format!("longer-{at}"), format!("{word}x"));
                add(&format!("blank-{at}"), format!("\"{word} \""));
            }
            add("beyond", "gaussian".into());
        }
    }
    let with_truth = |(name, text): (String, String)| {
        let is_right = is_right(takes, &text);
        (name, text, is_right)
    };
    texts.into_iter().map(with_truth).collect()
}

/// Whether a key takes a value, which is TOML, or else a text.
fn is_right(takes: Takes, text: &str) -> bool {
    let toml = toml::from_str::<toml::Table>(&format!("x = {text}\n"));
    let value = toml.ok().and_then(|mut table| table.remove("x")).unwrap_or_else(|| text.into());
    let number = |value: &toml::Value, least: f64, most: f64| {
        let number = value.as_float().or_else(|| value.as_integer().map(|number| number as f64));
        number.is_some_and(|number| (least..=most).contains(&number))
    };
    match takes {
        Whole(least, most) => value.as_integer().is_some_and(|number| (least..=most).contains(&number)),
        Number(least, most) => number(&value, least, most),
        OneOrTwo(least, most) => match value.as_array() {
            Some(two) => two.len() == 2 && two.iter().all(|one| number(one, least, most)),
            None => number(&value, least, most),
        },
        Words(words) => value.as_str().is_some_and(|word| words.contains(&word)),
    }
}

/// A key, a value, and a name that says by its end whether both are right.
fn all() -> Vec<(String, String, String)> {
    let mut all = Vec::new();
    for (at, (key, takes)) in KEYS.into_iter().enumerate() {
        for (name, value, is_right) in values(takes) {
            let end = if is_right { "good" } else { "wrong" };
            all.push((format!("{at}-{name}-{end}"), key.to_string(), value));
        }
        // A letter that is left out makes another key, which there is not.
        for left_out in 0..key.len() {
            let other = format!("{}{}", &key[..left_out], &key[left_out + 1..]);
            all.push((format!("{at}-without-{left_out}-wrong"), other, "1".into()));
        }
    }
    for (at, key) in no_keys().into_iter().enumerate() {
        all.push((format!("no-key-{at}-wrong"), key, "1".into()));
    }
    // Neighbouring letters that are the same make one key twice.
    let mut seen = std::collections::BTreeSet::new();
    all.retain(|(_, key, value)| seen.insert((key.clone(), value.clone())));
    all
}

/// Good settings as seeds of a fuzz target, and a list of each.
pub(super) fn good() -> Vec<String> {
    let good = all().into_iter().filter(|(name, _, _)| is_good(name));
    good.flat_map(|(_, key, value)| [format!("{key}={value}"), format!("{key}\n{value}\n")]).collect()
}

fn is_good(name: &str) -> bool {
    name.ends_with("-good")
}

/// Settings of `--set`.
pub fn settings() -> Family {
    let case = |(name, key, value): (String, String, String)| {
        let mut case = Case::new(format!("set-{name}"), "a setting", "scene show scene.toml --set", &[]);
        case.command.push(format!("{key}={value}"));
        case.file("scene.toml", SCENE)
    };
    Family { is_good, ..Family::of(all().into_iter().map(case).collect()) }
}

/// The same in a list of runs, with marks that a spreadsheet writes.
pub fn lists() -> Family {
    let cell = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut cases = Vec::new();
    for (name, key, value) in all() {
        // An empty cell is the scene's own value; a large sensor would be rendered.
        let is_large = key.ends_with("_px") || key.ends_with("columns") || key.ends_with("rows");
        if value.is_empty() || is_large && is_good(&name) && value.len() > 1 {
            continue;
        }
        let text = format!("{}\n{}\n", cell(&key), cell(&value));
        let run = "sweep scene.toml --list runs.csv --do render -o out";
        cases.push(
            Case::new(format!("list-{name}"), "a list of runs", run, &[])
                .file("runs.csv", text)
                .file("scene.toml", SCENE),
        );
    }
    Family { is_good, ..Family::of(cases) }
}
