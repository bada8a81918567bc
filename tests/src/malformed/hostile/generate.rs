//! Hostile settings of generated ground, in a scene file and on the command line.

use super::Family;
use super::edits::{hostile_toml, hostile_words};
use crate::malformed::case::Case;

/// Keys of a Mars-like ground, with values that make a small one.
const MARS: [(&str, &str); 19] = [
    ("preset", "\"worst\""),
    ("seed", "1"),
    ("extent_m", "4"),
    ("offset_m", "[0, 0, 0]"),
    ("post_spacing_m", "0.5"),
    ("fine_radius_m", "0"),
    ("hurst", "0.5"),
    ("roughness_m", "0.1"),
    ("octave_gains", "[1]"),
    ("rock_coverage", "0"),
    ("rock_smallest_m", "0.5"),
    ("rock_largest_m", "1"),
    ("crater_density", "0"),
    ("crater_smallest_m", "1"),
    ("crater_largest_m", "2"),
    ("crevasses", "0"),
    ("crevasse_width_m", "0.1"),
    ("crevasse_depth_m", "0.1"),
    ("crevasse_overhang_m", "0"),
];

/// Keys of a random ground.
const RANDOM: [(&str, &str); 5] =
    [("kind", "\"nasty\""), ("seed", "1"), ("faces", "20"), ("extent_m", "4"), ("offset_m", "[0, 0, 0]")];

/// Options of `terrain generate`, with values that make a small ground.
const OPTIONS: [(&str, &str); 8] = [
    ("--preset", "smooth"),
    ("--seed", "1"),
    ("--extent", "4"),
    ("--post-spacing", "0.5"),
    ("--fine-radius", "0"),
    ("--rock-coverage", "0"),
    ("--rock-smallest", "0.5"),
    ("--crevasses", "0"),
];

/// Hostile settings.
pub fn generators() -> Family {
    let mut cases = Vec::new();
    let mut scene = |name: String, generate: &str| {
        let text = format!("version = 1\n[terrain]\ngenerate = {{ {generate} }}\n");
        let run = "terrain inspect scene.toml";
        cases.push(Case::of_file(&name, "changed settings", run, "scene.toml", text.into_bytes(), ""));
    };
    let values = hostile_toml();
    for (ground, keys) in [("mars", &MARS[..]), ("random", &RANDOM)] {
        let table = |change: &dyn Fn(usize, &str, &str) -> String| {
            let keys = keys.iter().enumerate().map(|(at, (key, value))| change(at, key, value));
            keys.filter(|one| !one.is_empty()).collect::<Vec<_>>().join(", ")
        };
        scene(format!("{ground}-unchanged"), &table(&|_, key, value| format!("{key} = {value}")));
        for (at, (key, _)) in keys.iter().enumerate() {
            for (name, hostile) in &values {
                let one =
                    table(&|k, key, value| format!("{key} = {}", if k == at { hostile } else { value }));
                scene(format!("{ground}-{key}-{name}"), &one);
            }
            let twice = table(&|k, key, value| match k == at {
                true => format!("{key} = {value}, {key} = {value}"),
                false => format!("{key} = {value}"),
            });
            scene(format!("{ground}-{key}-twice"), &twice);
            let misspelt =
                table(&|k, key, value| format!("{key}{} = {value}", if k == at { "\u{455}" } else { "" }));
            scene(format!("{ground}-{key}-misspelt"), &misspelt);
        }
    }
    for (at, (option, _)) in OPTIONS.iter().enumerate() {
        // No command line has a byte 0, and a system limits its length.
        for (name, hostile) in hostile_words().iter().filter(|(name, _)| !["byte-0", "long"].contains(name)) {
            // Messages name the option, or the number of the ground that it sets.
            let option = &option[2..];
            let word = option.split('-').next().expect("its first word");
            let mut case = Case::new(format!("option-{option}-{name}"), "a changed option", "", &[word]);
            case.command = vec!["terrain".into(), "generate".into(), "-o".into(), "out.glb".into()];
            for (k, (option, value)) in OPTIONS.iter().enumerate() {
                case.command.push(format!("{option}={}", if k == at { hostile } else { *value }));
            }
            cases.push(case);
        }
    }
    Family { is_good, ..Family::of(cases) }
}

/// Values in the range of their key or option.
const GOOD: [&str; 23] = [
    "mars-crater_density-half",
    "mars-crater_density-tiny",
    "mars-crater_smallest_m-half",
    "mars-crevasse_depth_m-half",
    "mars-crevasse_overhang_m-half",
    "mars-crevasse_overhang_m-tiny",
    "mars-crevasse_width_m-half",
    "mars-fine_radius_m-half",
    "mars-fine_radius_m-tiny",
    "mars-hurst-half",
    "mars-octave_gains-list",
    "mars-post_spacing_m-half",
    "mars-rock_largest_m-half",
    "mars-rock_smallest_m-half",
    "mars-roughness_m-half",
    "mars-roughness_m-tiny",
    "mars-seed-top",
    "option-fine-radius-half",
    "option-post-spacing-half",
    "option-rock-smallest-half",
    "option-seed-two-to-63",
    "random-extent_m-half",
    "random-seed-top",
];

fn is_good(name: &str) -> bool {
    name.ends_with("unchanged") || GOOD.contains(&name)
}
