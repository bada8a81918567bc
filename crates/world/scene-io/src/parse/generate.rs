//! `generate = { ... }`: a random ground for tests by `kind`, or a Mars-like ground by `preset`.

use glam::DVec3;
use serde::Deserialize;
use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;
use toml::Spanned;

use raypencil_terrain::{MarsGround, PRESET_NAMES};

use crate::parse::key::{Key, span};
use crate::parse::source::Source;
use crate::plan::Terrain;
use crate::scene_error::SceneIoError;

/// Faces of a random ground. The largest takes about a gigabyte.
const RANDOM_FACES: RangeInclusive<i64> = 1..=1 << 24;

/// Number of faces of a random ground without `faces`.
const DEFAULT_RANDOM_FACES: usize = 10_000;

/// Distance between posts, metres.
const POST_SPACING_M: RangeInclusive<f64> = 1e-3..=1e4;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GenerateKeys {
    kind: Key<String>,
    preset: Key<String>,
    seed: Key<i64>,
    faces: Key<i64>,
    extent_m: Key<f64>,
    offset_m: Key<Vec<f64>>,
    post_spacing_m: Key<f64>,
    fine_radius_m: Key<f64>,
    coarse: Key<String>,
    hurst: Key<f64>,
    roughness_m: Key<f64>,
    octave_gains: Key<Vec<f64>>,
    rock_coverage: Key<f64>,
    rock_smallest_m: Key<f64>,
    rock_largest_m: Key<f64>,
    crater_density: Key<f64>,
    crater_smallest_m: Key<f64>,
    crater_largest_m: Key<f64>,
    crevasses: Key<i64>,
    crevasse_width_m: Key<f64>,
    crevasse_depth_m: Key<f64>,
    crevasse_overhang_m: Key<f64>,
}

impl Source<'_> {
    pub(super) fn generate(&self, generate: &Spanned<GenerateKeys>) -> Result<Terrain, SceneIoError> {
        let keys = generate.get_ref();
        match (&keys.preset, &keys.kind) {
            (Some(preset), None) => {
                let words: Vec<_> = PRESET_NAMES.iter().map(|name| (*name, *name)).collect();
                let name = self.word(preset, "terrain.generate.preset", &words)?;
                self.mars(name, keys, generate.span())
            }
            (Some(_), Some(kind)) => {
                let message = "`terrain.generate.kind` beside `preset`; expected one of the two";
                Err(self.error(kind.span(), message))
            }
            (None, _) => self.random(keys),
        }
    }

    fn seed(&self, key: &Key<i64>) -> Result<u64, SceneIoError> {
        let mut seed = 0;
        self.integer(key, "terrain.generate.seed", &mut seed, 0..=i64::MAX, "")?;
        Ok(seed)
    }

    fn offset(&self, key: &Key<Vec<f64>>) -> Result<DVec3, SceneIoError> {
        let Some(offset) = key else { return Ok(DVec3::ZERO) };
        let numbers = self.list(offset, "terrain.generate.offset_m", &[3], -1e7..=1e7, "metres")?;
        Ok(DVec3::from_slice(numbers))
    }

    fn random(&self, keys: &GenerateKeys) -> Result<Terrain, SceneIoError> {
        let mut nasty = false;
        let kinds = [("plain", false), ("nasty", true)];
        self.choice(&keys.kind, "terrain.generate.kind", &mut nasty, &kinds)?;
        let seed = self.seed(&keys.seed)?;
        let mut faces = DEFAULT_RANDOM_FACES;
        self.integer(&keys.faces, "terrain.generate.faces", &mut faces, RANDOM_FACES, "")?;
        let extent = self.optional(&keys.extent_m, "terrain.generate.extent_m", 0.1..=1e5, "metres")?;
        let offset = self.offset(&keys.offset_m)?;
        if let Some((name, span)) = first_of_preset(keys) {
            let message = format!("`terrain.generate.{name}` without a `preset`; expected it only with one");
            return Err(self.error(span, message));
        }
        Ok(Terrain::Generate { nasty, seed, faces, extent, offset })
    }

    /// Mars-like ground of the preset `name`; `place` is that of all keys.
    fn mars(&self, name: &str, keys: &GenerateKeys, place: Range<usize>) -> Result<Terrain, SceneIoError> {
        if let Some(faces) = &keys.faces {
            let message = "`terrain.generate.faces` beside `preset`; expected `post_spacing_m` and \
                           `rock_smallest_m`, from which they follow";
            return Err(self.error(faces.span(), message));
        }
        let seed = self.seed(&keys.seed)?;
        let mut ground = MarsGround::preset(name, seed).expect("a word of the list of presets");
        ground.offset = self.offset(&keys.offset_m)?;
        let (roughness, rocks) = (&mut ground.roughness, &mut ground.rocks);
        let (craters, crevasses) = (&mut ground.craters, &mut ground.crevasses);
        let numbers = [
            ("extent_m", &keys.extent_m, &mut ground.extent, 1.0..=1e5, "metres"),
            ("post_spacing_m", &keys.post_spacing_m, &mut ground.post_spacing, POST_SPACING_M, "metres"),
            ("fine_radius_m", &keys.fine_radius_m, &mut ground.fine_radius, 0.0..=1e4, "metres"),
            ("hurst", &keys.hurst, &mut roughness.hurst, 0.01..=0.99, ""),
            ("roughness_m", &keys.roughness_m, &mut roughness.rms_at_1_m, 0.0..=10.0, "metres"),
            ("rock_coverage", &keys.rock_coverage, &mut rocks.coverage, 0.0..=0.4, ""),
            ("rock_smallest_m", &keys.rock_smallest_m, &mut rocks.smallest, 1e-3..=100.0, "metres"),
            ("rock_largest_m", &keys.rock_largest_m, &mut rocks.largest, 1e-3..=100.0, "metres"),
            ("crater_density", &keys.crater_density, &mut craters.density, 0.0..=0.5, ""),
            ("crater_smallest_m", &keys.crater_smallest_m, &mut craters.smallest, 0.01..=1e4, "metres"),
            ("crater_largest_m", &keys.crater_largest_m, &mut craters.largest, 0.01..=1e4, "metres"),
            ("crevasse_width_m", &keys.crevasse_width_m, &mut crevasses.width, 1e-3..=100.0, "metres"),
            ("crevasse_depth_m", &keys.crevasse_depth_m, &mut crevasses.depth, 1e-3..=1e3, "metres"),
            (
                "crevasse_overhang_m",
                &keys.crevasse_overhang_m,
                &mut crevasses.overhang,
                0.0..=100.0,
                "metres",
            ),
        ];
        for (name, key, slot, range, unit) in numbers {
            self.number(key, &format!("terrain.generate.{name}"), slot, range, unit)?;
        }
        self.integer(&keys.crevasses, "terrain.generate.crevasses", &mut crevasses.count, 0..=1000, "")?;
        if let Some(gains) = &keys.octave_gains {
            let any: Vec<usize> = (0..=64).collect();
            let gains = self.list(gains, "terrain.generate.octave_gains", &any, 0.0..=100.0, "")?;
            roughness.octave_gains = gains.to_vec();
        }
        let coarse = keys.coarse.as_ref().map(|file| (PathBuf::from(file.get_ref()), file.span()));
        // Errors that show only when the numbers are taken together.
        ground.validate().map_err(|error| {
            let message =
                format!("`terrain.generate.{}` is {}; expected {}", error.field, error.value, error.expected);
            self.error(place, message)
        })?;
        Ok(Terrain::Mars { ground: Box::new(ground), coarse })
    }
}

/// First key that is given although it makes sense only with a `preset`, and its place.
fn first_of_preset(keys: &GenerateKeys) -> Option<(&'static str, Range<usize>)> {
    [
        ("post_spacing_m", span(&keys.post_spacing_m)),
        ("fine_radius_m", span(&keys.fine_radius_m)),
        ("hurst", span(&keys.hurst)),
        ("roughness_m", span(&keys.roughness_m)),
        ("rock_coverage", span(&keys.rock_coverage)),
        ("rock_smallest_m", span(&keys.rock_smallest_m)),
        ("rock_largest_m", span(&keys.rock_largest_m)),
        ("crater_density", span(&keys.crater_density)),
        ("crater_smallest_m", span(&keys.crater_smallest_m)),
        ("crater_largest_m", span(&keys.crater_largest_m)),
        ("crevasse_width_m", span(&keys.crevasse_width_m)),
        ("crevasse_depth_m", span(&keys.crevasse_depth_m)),
        ("crevasse_overhang_m", span(&keys.crevasse_overhang_m)),
        ("coarse", span(&keys.coarse)),
        ("octave_gains", span(&keys.octave_gains)),
        ("crevasses", span(&keys.crevasses)),
    ]
    .into_iter()
    .find_map(|(name, span)| Some((name, span?)))
}
