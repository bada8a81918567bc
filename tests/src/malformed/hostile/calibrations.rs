//! Hostile calibrations of cameras, as ROS has them.

use super::Family;
use super::edits::{cut_anywhere, with_each_word, word_of};
use crate::malformed::case::Case;

/// A message, with each kind of value that the reader looks at.
pub(super) const MESSAGE: &str = "width: 64
height: 48
d: [0, 0]
k: [60, 0, 31.5, 0, 60, 23.5, 0, 0, 1]
binning_x: 0
roi: {x_offset: 0, y_offset: 0, width: 0, height: 0}
";

/// One of a camera whose rectified images have a projection of their own.
const RECTIFIED: &str = "width: 64
height: 48
k: [1, 0, 0, 0, 1, 0, 0, 0, 1]
p: [60, 0, 31.5, 0, 0, 60, 23.5, 0, 0, 0, 1, 0]
";

/// Hostile calibrations.
pub fn calibrations() -> Family {
    let mut cases = Vec::new();
    let mut add = |name: String, bytes: Vec<u8>, is_rectified: bool| {
        let rectified = if is_rectified { "camera_info_rectified = true\n" } else { "" };
        let scene = format!("version = 1\n[camera]\ncamera_info = \"left.yaml\"\n{rectified}");
        let run = "scene show scene.toml";
        let case = Case::of_file(&name, "a changed calibration", run, "left.yaml", bytes, "");
        // A fault of the file is told with its line; what is out of range, with the line of the scene that names the file.
        cases.push(case.file("scene.toml", scene).says(&["left.yaml"]));
    };
    for (kind, message) in [("own", MESSAGE), ("rectified", RECTIFIED)] {
        let words = with_each_word(message, " :,[]{}\n", &[("alias", "*left"), ("tag", "!!binary AAAA")]);
        for (name, text) in words {
            add(format!("{kind}-{name}"), text.into_bytes(), kind == "rectified");
        }
        for (name, bytes) in cut_anywhere(message.as_bytes()) {
            add(format!("{kind}-{name}"), bytes, kind == "rectified");
        }
    }
    Family { is_good, ..Family::of(cases) }
}

/// Other keys than those that the reader asks for are ignored: a message has many. So are, of a rectified camera, the numbers of
/// its own matrix, and how far the projection moves a second camera.
fn is_good(name: &str) -> bool {
    const OTHER_KEYS: [&str; 9] =
        ["half", "nan", "overflow", "tag", "two-to-63", "word", "minus-inf", "minus-one", "two-to-64"];
    const NUMBERS: [&str; 4] = ["half", "minus-one", "two-to-63", "two-to-64"];
    if let Some(cut) = name.strip_prefix("own-cut-at-") {
        // After the matrix, after a key without a value, and before the region.
        return ["70", "80", "82", "88"].contains(&cut);
    }
    match (name.starts_with("rectified"), word_of(name)) {
        (_, None) => name.ends_with("-unchanged"),
        (false, Some((4 | 17 | 19 | 20 | 22 | 24 | 26, what))) => OTHER_KEYS.contains(&what),
        (false, Some(change)) => [(10, "half"), (12, "half"), (13, "minus-one")].contains(&change),
        (true, Some((5..=12 | 18 | 22, what))) => NUMBERS.contains(&what),
        (true, Some((13, what))) => what == "none" || NUMBERS.contains(&what),
        (true, Some(change)) => [(17, "minus-one"), (20, "half"), (21, "minus-one")].contains(&change),
    }
}
