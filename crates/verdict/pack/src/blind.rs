//! Blind scenes: a scene with every hard case, made from a seed, so that no renderer can have been tuned for its
//! answers. A [bench](crate::bench) stands in each, so that every clause of the contract decides some of its rays.

use raypencil_scene::Scene;
use raypencil_scene_io::{LoadedScene, SceneIoError, Subject, load_text, scene_sha256};

use crate::bench::{Edition, with_bench_of};
use crate::split_mix::SplitMix64;

/// The scene file of a seed.
///
/// The ground is rough, with rocks, overhangs, walls and slivers. The rig is the default one with a third beam, turned and
/// moved; each beam has another profile. The lens has a filter, and there is air. The camera's maximum range is shorter
/// than the beams'. The seed also chooses the flux model, and whether the scene is offset by up to 1000 km.
fn scene_toml(seed: u64) -> String {
    let mut random = SplitMix64::new(seed);
    let faces = random.between(500.0, 4000.0, 1.0);
    let ground_seed = random.next_u64() >> 1;
    let offset = random.one_of(&["[0, 0, 0]", "[0, 0, 0]", "[1e3, -2e3, 50]", "[1e6, 3e5, -2e3]"]);
    let position = match offset {
        "[0, 0, 0]" => "[0, 0]",
        "[1e3, -2e3, 50]" => "[1e3, -2e3]",
        _ => "[1e6, 3e5]",
    };
    let mut text = format!(
        "version = 1\n[terrain]\ngenerate = {{ kind = \"nasty\", seed = {ground_seed}, faces = {faces}, offset_m = {offset} }}\n"
    );
    let heading = random.between(-180.0, 180.0, 0.25);
    text += &format!("[vehicle]\nposition_m = {position}\nheading_deg = {heading}\n");
    let roll = random.between(-10.0, 10.0, 0.25);
    let pitch = random.between(10.0, 35.0, 0.25);
    text += &format!(
        "[camera]\nwidth_px = 96\nheight_px = 72\npixel_pitch_um = [96, 108]\npitch_down_deg = {pitch}\nroll_right_deg = {roll}\n"
    );
    let point = [random.between(44.0, 51.0, 0.1) + 0.03, random.between(33.0, 38.0, 0.1) + 0.03];
    let range = random.between(2.0, 3.0, 0.1);
    let transmission = random.between(0.5, 0.95, 0.01);
    text +=
        &format!("principal_point_px = {point:?}\nmax_range_m = {range}\ntransmission = {transmission}\n");
    let (centre, width) = (random.between(805.0, 820.0, 0.5), random.between(5.0, 30.0, 0.5));
    text += &format!("filter = {{ centre_nm = {centre}, width_nm = {width} }}\n");
    let first = random.next_u64() as usize % 3;
    for beam in 0..3 {
        let pitch = random.between(15.0, 45.0, 0.25);
        let (yaw, roll) = (random.between(-10.0, 10.0, 0.25), random.between(-10.0, 10.0, 0.25));
        let (fan, thickness) = (random.between(20.0, 150.0, 1.0), random.between(1.0, 100.0, 0.5));
        let profile = ["paper", "uniform_angle", "gaussian"][(first + beam) % 3];
        text += &format!(
            "[[beam]]\ncolumns = 128\nrows = 4\npitch_down_deg = {pitch}\nyaw_left_deg = {yaw}\nroll_right_deg = {roll}\nfan_deg = {fan}\nthickness_mm = {thickness}\nprofile = \"{profile}\"\n"
        );
        if profile == "gaussian" {
            let width = random.between(10.0, 60.0, 1.0);
            text += &format!("gaussian_half_width_deg = {width}\n");
        }
    }
    let sigma = random.one_of(&["0.02", "0.05", "0.1"]);
    let model = random.one_of(&["radiometric", "eq1"]);
    text + &format!("[atmosphere]\nattenuation_per_m = {sigma}\n[flux]\nmodel = \"{model}\"\n")
}

/// The scene of a blind seed.
///
/// ```
/// use raypencil_pack::blind_scene;
/// use raypencil_scene::SensorId;
///
/// let scene = blind_scene(7).expect("every seed makes a scene");
/// // Every blind scene has a camera of 96 x 72 pixels, three beams of 128 x 4 pencils, and those of the bench.
/// assert_eq!(scene.beams().len(), 3 + raypencil_pack::BENCH_BEAMS);
/// assert_eq!(scene.size(SensorId::Camera), Some((96, 72)));
/// assert_eq!(scene.size(SensorId::Beam(1)), Some((128, 4)));
/// ```
///
/// # Errors
/// A scene file that the loader refuses. No seed is known that makes one.
pub fn blind_scene(seed: u64) -> Result<Scene, SceneIoError> {
    blind_scene_of(seed, Edition::Second)
}

/// The scene of a blind seed with the bench of an edition: packs of the first one are still checked.
pub(crate) fn blind_scene_of(seed: u64, edition: Edition) -> Result<Scene, SceneIoError> {
    Ok(on_bench(&load(seed)?.scene, edition))
}

fn on_bench(scene: &Scene, edition: Edition) -> Scene {
    with_bench_of(scene, edition).expect("ten beams, and faces within 200 m")
}

/// The scene of a blind seed, with its name `blind-SEED` and its digest.
///
/// # Errors
/// As [`blind_scene`].
pub fn blind_subject(seed: u64) -> Result<Subject, SceneIoError> {
    let loaded = load(seed)?;
    let scene = on_bench(&loaded.scene, Edition::Second);
    let arguments = loaded.name.clone();
    Ok(Subject { sha256: scene_sha256(&scene), scene, ..loaded.into_subject(arguments) })
}

fn load(seed: u64) -> Result<LoadedScene, SceneIoError> {
    load_text(&scene_toml(seed), &format!("blind-{seed}"))
}

#[cfg(test)]
mod tests {
    use raypencil_files::{hex_digits, sha256};

    use super::*;
    use crate::bench::BENCH_BEAMS;

    /// A blind pack has no scene but that of its seed: with another text for its seed it is refused.
    #[test]
    fn the_scene_of_a_seed_stays_what_it_is() {
        let texts = (0..64).map(scene_toml).collect::<String>();
        let digest = "fb553bc4b41a530ec7cb5cbe2c41b22082bfd5df27962344d678fdbe55e037fe";
        assert_eq!(hex_digits(&sha256(texts.as_bytes())), digest);
        // The vehicle stands on its ground, wherever that is.
        for (offset, position) in
            [("[0, 0, 0]", "[0, 0]"), ("[1e3, -2e3, 50]", "[1e3, -2e3]"), ("[1e6, 3e5, -2e3]", "[1e6, 3e5]")]
        {
            let there = |text: &String| text.contains(&format!("offset_m = {offset} }}"));
            let of_offset: Vec<String> = (0..64).map(scene_toml).filter(there).collect();
            let stands = |text: &String| text.contains(&format!("position_m = {position}\n"));
            assert!(!of_offset.is_empty() && of_offset.iter().all(stands), "{offset}");
        }
    }

    #[test]
    fn every_seed_makes_a_scene_of_its_own() {
        let mut digests = std::collections::BTreeSet::new();
        for seed in (0..6).chain([u64::MAX, 1 << 63]) {
            let scene = blind_scene(seed).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            assert_eq!(scene.beams().len(), 3 + BENCH_BEAMS);
            assert!(digests.insert(scene_sha256(&scene)), "seed {seed}");
            assert_eq!(scene_sha256(&blind_scene(seed).unwrap()), scene_sha256(&scene));
        }
    }
}
