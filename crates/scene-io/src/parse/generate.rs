//! `generate = { ... }`: random grounds of tests by `kind`, ground as Mars has it by `preset`.

use glam::DVec3;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use toml::Spanned;

use crate::keys::{GenerateKeys, Key};
use crate::parse::Source;
use crate::plan::Terrain;
use crate::scene_error::SceneIoError;
use raypencil_terrain::{MarsGround, PRESET_NAMES};

/// Faces of a random ground: a gigabyte or so.
const GENERATED_FACES: RangeInclusive<i64> = 1..=1 << 24;

/// Whole metres and parts of one, of anything that is generated.
const LENGTH_M: RangeInclusive<f64> = 1e-3..=1e4;

impl Source<'_> {
    pub(super) fn generate(&self, keys: Spanned<GenerateKeys>) -> Result<Terrain, SceneIoError> {
        let whole = keys.span();
        let mut keys = keys.into_inner();
        match (&keys.preset, &keys.kind) {
            (Some(preset), None) => {
                let words: Vec<_> = PRESET_NAMES.iter().map(|name| (*name, *name)).collect();
                let name = self.word(preset, "terrain.generate.preset", &words)?;
                self.mars(name, &mut keys, whole)
            }
            (Some(_), Some(kind)) => {
                let message = "`terrain.generate.kind` beside `preset`; expected one of the two";
                Err(self.error(kind.span(), message))
            }
            (None, _) => self.random(keys),
        }
    }

    /// An integer in a range, or its default.
    fn integer(
        &self,
        key: Key<i64>,
        name: &str,
        default: i64,
        range: RangeInclusive<i64>,
    ) -> Result<i64, SceneIoError> {
        match key {
            Some(key) if range.contains(key.get_ref()) => Ok(key.into_inner()),
            Some(key) => {
                let (low, high) = (range.start(), range.end());
                let message =
                    format!("`terrain.generate.{name}` is {}; expected {low} to {high}", key.get_ref());
                Err(self.error(key.span(), message))
            }
            None => Ok(default),
        }
    }

    fn seed(&self, key: Key<i64>) -> Result<u64, SceneIoError> {
        Ok(self.integer(key, "seed", 0, 0..=i64::MAX)?.unsigned_abs())
    }

    fn offset(&self, key: Key<Vec<f64>>) -> Result<DVec3, SceneIoError> {
        let Some(offset) = key else { return Ok(DVec3::ZERO) };
        let numbers = self.list(&offset, "terrain.generate.offset_m", &[3], -1e7..=1e7, "metres")?;
        Ok(DVec3::from_slice(numbers))
    }

    fn random(&self, mut keys: GenerateKeys) -> Result<Terrain, SceneIoError> {
        let nasty = match keys.kind.take() {
            Some(kind) => self.word(&kind, "terrain.generate.kind", &[("plain", false), ("nasty", true)])?,
            None => false,
        };
        let seed = self.seed(keys.seed.take())?;
        let faces = self.integer(keys.faces.take(), "faces", 10_000, GENERATED_FACES)?;
        let mut extent = keys.extent_m.as_ref().map(|key| *key.get_ref());
        if let Some(extent) = &mut extent {
            self.number(keys.extent_m.take(), "terrain.generate.extent_m", extent, 0.1..=1e5, "metres")?;
        }
        let offset = self.offset(keys.offset_m.take())?;
        if let Some((name, span)) = first_given(&keys) {
            let message = format!("`terrain.generate.{name}` without a `preset`; expected it only with one");
            return Err(self.error(span, message));
        }
        Ok(Terrain::Generate { nasty, seed, faces: faces.unsigned_abs() as usize, extent, offset })
    }

    fn mars(
        &self,
        name: &str,
        keys: &mut GenerateKeys,
        whole: std::ops::Range<usize>,
    ) -> Result<Terrain, SceneIoError> {
        if let Some(faces) = &keys.faces {
            let message = "`terrain.generate.faces` beside `preset`; expected `post_spacing_m` and `rock_smallest_m`, from which they follow";
            return Err(self.error(faces.span(), message));
        }
        let seed = self.seed(keys.seed.take())?;
        let mut ground = MarsGround::preset(name, seed).expect("a word of the list of presets");
        ground.offset = self.offset(keys.offset_m.take())?;
        let numbers = [
            (keys.extent_m.take(), "extent_m", &mut ground.extent, 1.0..=1e5, "metres"),
            (keys.post_spacing_m.take(), "post_spacing_m", &mut ground.post_spacing, LENGTH_M, "metres"),
            (keys.hurst.take(), "hurst", &mut ground.roughness.hurst, 0.01..=0.99, ""),
            (keys.roughness_m.take(), "roughness_m", &mut ground.roughness.rms_at_1_m, 0.0..=10.0, "metres"),
            (keys.rock_coverage.take(), "rock_coverage", &mut ground.rocks.coverage, 0.0..=0.4, ""),
            (
                keys.rock_smallest_m.take(),
                "rock_smallest_m",
                &mut ground.rocks.smallest,
                1e-3..=100.0,
                "metres",
            ),
            (keys.rock_largest_m.take(), "rock_largest_m", &mut ground.rocks.largest, 1e-3..=100.0, "metres"),
            (keys.crater_density.take(), "crater_density", &mut ground.craters.density, 0.0..=0.5, ""),
            (
                keys.crater_smallest_m.take(),
                "crater_smallest_m",
                &mut ground.craters.smallest,
                0.01..=1e4,
                "metres",
            ),
            (
                keys.crater_largest_m.take(),
                "crater_largest_m",
                &mut ground.craters.largest,
                0.01..=1e4,
                "metres",
            ),
            (
                keys.crevasse_width_m.take(),
                "crevasse_width_m",
                &mut ground.crevasses.width,
                1e-3..=100.0,
                "metres",
            ),
            (
                keys.crevasse_depth_m.take(),
                "crevasse_depth_m",
                &mut ground.crevasses.depth,
                1e-3..=1e3,
                "metres",
            ),
            (
                keys.crevasse_overhang_m.take(),
                "crevasse_overhang_m",
                &mut ground.crevasses.overhang,
                0.0..=100.0,
                "metres",
            ),
        ];
        for (key, name, slot, range, unit) in numbers {
            self.number(key, &format!("terrain.generate.{name}"), slot, range, unit)?;
        }
        let count = i64::from(ground.crevasses.count);
        let count = self.integer(keys.crevasses.take(), "crevasses", count, 0..=1000)?;
        ground.crevasses.count = u32::try_from(count).expect("0 to 1000");
        if let Some(gains) = keys.octave_gains.take() {
            let any: Vec<usize> = (0..=64).collect();
            let gains = self.list(&gains, "terrain.generate.octave_gains", &any, 0.0..=100.0, "")?.to_vec();
            ground.roughness.octave_gains = gains;
        }
        let coarse = keys.coarse.take().map(|file| (PathBuf::from(file.get_ref()), file.span()));
        // What only shows when the numbers are taken together.
        ground.validate().map_err(|error| {
            let message =
                format!("`terrain.generate.{}` is {}; expected {}", error.field, error.value, error.expected);
            self.error(whole, message)
        })?;
        Ok(Terrain::Mars { ground: Box::new(ground), coarse })
    }
}

/// The first key that is still there, with its place.
fn first_given(keys: &GenerateKeys) -> Option<(&'static str, std::ops::Range<usize>)> {
    let place = |name, span: Option<std::ops::Range<usize>>| Some((name, span?));
    let numbers = [
        ("post_spacing_m", &keys.post_spacing_m),
        ("hurst", &keys.hurst),
        ("roughness_m", &keys.roughness_m),
        ("rock_coverage", &keys.rock_coverage),
        ("rock_smallest_m", &keys.rock_smallest_m),
        ("rock_largest_m", &keys.rock_largest_m),
        ("crater_density", &keys.crater_density),
        ("crater_smallest_m", &keys.crater_smallest_m),
        ("crater_largest_m", &keys.crater_largest_m),
        ("crevasse_width_m", &keys.crevasse_width_m),
        ("crevasse_depth_m", &keys.crevasse_depth_m),
        ("crevasse_overhang_m", &keys.crevasse_overhang_m),
    ];
    let number = numbers.into_iter().find_map(|(name, key)| place(name, key.as_ref().map(Spanned::span)));
    number
        .or_else(|| place("coarse", keys.coarse.as_ref().map(Spanned::span)))
        .or_else(|| place("octave_gains", keys.octave_gains.as_ref().map(Spanned::span)))
        .or_else(|| place("crevasses", keys.crevasses.as_ref().map(Spanned::span)))
}
