//! Hostile poses of a moving sensor: TUM, and bags.

use super::Family;
use super::edits::{cut_anywhere, with_each_byte, with_each_word};
use crate::malformed::case::Case;
use crate::malformed::trajectory::{BAG, MESH, set};

/// Without files: without optimisation the pictures of a set take longer than the limit.
const RUN: &str = "cast mesh.obj rays.toml";

/// Three poses.
const TUM: &str = "# t x y z qx qy qz qw\n0 0 0 1 0 0 0 1\n1 0.5 0 1 0 0 0 1\n2 1 0 1 0 0 0.6 0.8\n";

/// How many bytes of the bag lie between one that is changed and the next.
const STRIDE: usize = 17;

/// Poses as text. Another number is often as good a pose.
pub fn trajectories() -> Family {
    let words = with_each_word(TUM, " \n", &[("one", "1")]).into_iter();
    let mut texts: Vec<(String, Vec<u8>)> = words.map(|(name, text)| (name, text.into_bytes())).collect();
    texts.extend(cut_anywhere(TUM.as_bytes()));
    texts.extend(with_each_byte(TUM.as_bytes()).into_iter().skip(1));
    let case = |(name, bytes): (String, Vec<u8>)| {
        let case = Case::of_file(&format!("tum-{name}"), "changed poses", RUN, "walk.tum", bytes, "");
        case.says(&[]).file("mesh.obj", MESH).file("rays.toml", set("walk.tum", ""))
    };
    let cases = texts.into_iter().map(case).collect();
    Family { is_good: |name| name.ends_with("unchanged"), open: &[0, 1], ..Family::of(cases) }
}

/// Bags. Theirs are without check sums, so a number in one may be another.
pub fn bags() -> Family {
    let changed = with_each_byte(BAG);
    let case = |(name, bytes): (String, Vec<u8>)| {
        let case =
            Case::of_file(&format!("bag-{name}"), "a changed byte of a bag", RUN, "walk.mcap", bytes, "");
        let set = set("walk.mcap", "poses_topic = \"/odom\"\nstart_s = 1700000000\n");
        case.says(&[]).file("mesh.obj", MESH).file("rays.toml", set)
    };
    let some = changed.into_iter().step_by(STRIDE).map(case);
    Family { is_good: |name| name.ends_with("unchanged"), open: &[0, 1], ..Family::of(some.collect()) }
}
