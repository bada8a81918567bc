//! `[terrain]`: exactly one ground.

use serde::Deserialize;
use std::path::PathBuf;
use toml::Spanned;

use raypencil_terrain::BUILTIN_NAMES;

use crate::parse::dem::DemKeys;
use crate::parse::generate::GenerateKeys;
use crate::parse::key::{Key, Word, span};
use crate::parse::source::Source;
use crate::plan::{DemPart, MeshPart, ScenePlan, Terrain};
use crate::scene_error::SceneIoError;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TerrainKeys {
    builtin: Key<String>,
    file: Key<String>,
    up: Key<String>,
    scale: Key<f64>,
    dem: Key<String>,
    dem_window_m: Key<Vec<f64>>,
    dem_max_error_m: Key<f64>,
    dem_nodata: Key<Word>,
    dem_unit: Key<Word>,
    dem_z_unit: Key<Word>,
    generate: Key<GenerateKeys>,
    reflectivity: Key<f64>,
}

impl Source<'_> {
    pub(super) fn terrain(
        &self,
        terrain: &Spanned<TerrainKeys>,
        plan: &mut ScenePlan,
    ) -> Result<(), SceneIoError> {
        let keys = terrain.get_ref();
        plan.reflectivity = self.optional(&keys.reflectivity, "terrain.reflectivity", 0.0..=1.0, "")?;
        let frame = self.file_frame(&keys.up, &keys.scale, &keys.file)?;
        let of_dem = DemKeys {
            window: &keys.dem_window_m,
            max_error: &keys.dem_max_error_m,
            nodata: &keys.dem_nodata,
            unit: &keys.dem_unit,
            z_unit: &keys.dem_z_unit,
        };
        let dem = self.dem_part(of_dem, &keys.dem)?;
        let one = "exactly one of `builtin`, `file`, `dem` and `generate`";
        plan.terrain = match (&keys.builtin, &keys.file, &keys.dem, &keys.generate) {
            (Some(name), None, None, None) => {
                let names: Vec<_> = BUILTIN_NAMES.iter().map(|name| (*name, *name)).collect();
                Terrain::Builtin(self.word(name, "terrain.builtin", &names)?.to_string())
            }
            (None, Some(file), None, None) => {
                plan.terrain_span = file.span();
                Terrain::File(MeshPart { file: PathBuf::from(file.get_ref()), frame })
            }
            (None, None, Some(file), None) => {
                plan.terrain_span = file.span();
                Terrain::Dem(DemPart { file: PathBuf::from(file.get_ref()), ..dem })
            }
            (None, None, None, Some(generate)) => self.generate(generate)?,
            (None, None, None, None) => {
                let message = format!("`terrain` has no ground; expected {one}");
                return Err(self.error(terrain.span(), message));
            }
            // The last of them is marked.
            (builtin, file, dem, generate) => {
                let named = [
                    ("builtin", span(builtin)),
                    ("file", span(file)),
                    ("dem", span(dem)),
                    ("generate", span(generate)),
                ];
                let given = named.into_iter().filter_map(|(name, span)| Some((span?, name)));
                let (span, last) =
                    given.max_by_key(|(span, _)| span.start).unwrap_or((terrain.span(), "terrain"));
                let message = format!("`terrain.{last}` is one ground too many; expected {one}");
                return Err(self.error(span, message));
            }
        };
        Ok(())
    }
}
