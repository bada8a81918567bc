//! Blind cases: a hostile scene from a seed, so that nobody can have tuned for its answers.

use raypencil_scene::Scene;
use raypencil_scene_io::{LoadedScene, SceneIoError, Subject, load_text, scene_sha256};

/// The numbers of a seed, in order. (splitmix64; G. Steele, D. Lea, C. Flood, 2014)
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// A multiple of `step` from `low` to `high`.
    fn between(&mut self, low: f64, high: f64, step: f64) -> f64 {
        let steps = ((high - low) / step).round() as u64;
        low + step * (self.next() % (steps + 1)) as f64
    }

    fn one_of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[(self.next() % words.len() as u64) as usize]
    }
}

/// The text of the scene of a seed: rough ground with rocks, overhangs, walls and slivers, a rig like the default
/// one but turned and moved, every profile, and now and then air, a filter, an offset of a thousand kilometres.
fn text(seed: u64) -> String {
    let mut draws = Draws(seed);
    let faces = draws.between(500.0, 4000.0, 1.0);
    let ground_seed = draws.next() >> 1;
    let offset = draws.one_of(&["[0, 0, 0]", "[0, 0, 0]", "[1e3, -2e3, 50]", "[1e6, 3e5, -2e3]"]);
    let position = match offset {
        "[0, 0, 0]" => "[0, 0]",
        "[1e3, -2e3, 50]" => "[1e3, -2e3]",
        _ => "[1e6, 3e5]",
    };
    let mut text = format!(
        "version = 1\n[terrain]\ngenerate = {{ kind = \"nasty\", seed = {ground_seed}, faces = {faces}, offset_m = {offset} }}\n"
    );
    let heading = draws.between(-180.0, 180.0, 0.25);
    text += &format!("[vehicle]\nposition_m = {position}\nheading_deg = {heading}\n");
    let roll = draws.between(-10.0, 10.0, 0.25);
    let pitch = draws.between(10.0, 35.0, 0.25);
    text += &format!(
        "[camera]\nwidth_px = 96\nheight_px = 72\npixel_pitch_um = [96, 98]\npitch_down_deg = {pitch}\nroll_right_deg = {roll}\n"
    );
    if draws.next().is_multiple_of(2) {
        let (centre, width) = (draws.between(805.0, 820.0, 0.5), draws.between(5.0, 30.0, 0.5));
        text += &format!("filter = {{ centre_nm = {centre}, width_nm = {width} }}\n");
    }
    for _ in 0..2 {
        let pitch = draws.between(15.0, 45.0, 0.25);
        let (yaw, roll) = (draws.between(-10.0, 10.0, 0.25), draws.between(-10.0, 10.0, 0.25));
        let (fan, thickness) = (draws.between(20.0, 150.0, 1.0), draws.between(1.0, 100.0, 0.5));
        let profile = draws.one_of(&["paper", "uniform_angle", "gaussian"]);
        text += &format!(
            "[[beam]]\ncolumns = 128\nrows = 4\npitch_down_deg = {pitch}\nyaw_left_deg = {yaw}\nroll_right_deg = {roll}\nfan_deg = {fan}\nthickness_mm = {thickness}\nprofile = \"{profile}\"\n"
        );
        if profile == "gaussian" {
            let width = draws.between(10.0, 60.0, 1.0);
            text += &format!("gaussian_half_width_deg = {width}\n");
        }
    }
    let sigma = draws.one_of(&["0", "0", "0.01", "0.1"]);
    let model = draws.one_of(&["radiometric", "eq1"]);
    text + &format!("[atmosphere]\nattenuation_per_m = {sigma}\n[flux]\nmodel = \"{model}\"\n")
}

/// The scene of a blind seed.
///
/// # Errors
/// If this version cannot make it: none should exist.
pub fn blind_scene(seed: u64) -> Result<Scene, SceneIoError> {
    loaded(seed).map(|loaded| loaded.scene)
}

/// The same with its names.
///
/// # Errors
/// As [`blind_scene`].
pub fn blind_subject(seed: u64) -> Result<Subject, SceneIoError> {
    let loaded = loaded(seed)?;
    let sha256 = scene_sha256(&loaded.scene);
    Ok(Subject { arguments: loaded.name.clone(), name: loaded.name, scene: loaded.scene, sha256 })
}

fn loaded(seed: u64) -> Result<LoadedScene, SceneIoError> {
    load_text(&text(seed), &format!("blind-{seed}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_makes_a_scene_of_its_own() {
        let mut digests = std::collections::BTreeSet::new();
        for seed in (0..40).chain([u64::MAX, 1 << 63]) {
            let scene = blind_scene(seed).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            assert_eq!(scene.beams().len(), 2);
            assert!(digests.insert(scene_sha256(&scene)), "seed {seed}");
            assert_eq!(scene_sha256(&blind_scene(seed).unwrap()), scene_sha256(&scene));
        }
    }
}
