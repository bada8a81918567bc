//! Keys of `[terrain]` that are given only beside `dem`.

use std::path::PathBuf;

use raypencil_mesh_io::{DemOptions, HeightUnit, LengthUnit, NoData, dem};

use crate::parse::key::{Key, Word, span};
use crate::parse::source::Source;
use crate::plan::DemPart;
use crate::scene_error::SceneIoError;

/// The keys beside `dem`.
pub(super) struct DemKeys<'a> {
    pub window: &'a Key<Vec<f64>>,
    pub max_error: &'a Key<f64>,
    pub nodata: &'a Key<Word>,
    pub unit: &'a Key<Word>,
    pub z_unit: &'a Key<Word>,
}

impl Source<'_> {
    /// Part of an elevation model. The caller fills in its file.
    pub(super) fn dem_part(&self, keys: DemKeys, dem: &Key<String>) -> Result<DemPart, SceneIoError> {
        let DemKeys { window, max_error, nodata, unit, z_unit } = keys;
        let spans = [
            ("dem_window_m", span(window)),
            ("dem_max_error_m", span(max_error)),
            ("dem_nodata", span(nodata)),
            ("dem_unit", span(unit)),
            ("dem_z_unit", span(z_unit)),
        ];
        if let (None, Some((name, span))) =
            (dem, spans.into_iter().find_map(|(name, span)| Some((name, span?))))
        {
            return Err(self.error(span, format!("`terrain.{name}` is given; expected it only with `dem`")));
        }
        let mut part = DemPart { file: PathBuf::new(), options: DemOptions::default(), max_error: None };
        if let Some(window) = window {
            let name = "terrain.dem_window_m";
            if let &[x, y, width, height] = self.list(window, name, &[4], dem::MAP_RANGE_M, "metres")? {
                for side in [width, height] {
                    self.check(
                        side,
                        window.span(),
                        name,
                        dem::WINDOW_SIDE_RANGE_M,
                        "metres, for a width and a height",
                    )?;
                }
                part.options.window = Some([x, y, width, height]);
            }
        }
        part.max_error =
            self.optional(max_error, "terrain.dem_max_error_m", dem::MAX_ERROR_RANGE_M, "metres")?;
        let options = &mut part.options;
        options.nodata = self.parsed(nodata, "dem_nodata", NoData::parse)?.unwrap_or_default();
        options.unit = self.parsed(unit, "dem_unit", LengthUnit::parse)?;
        options.z_unit = self.parsed(z_unit, "dem_z_unit", HeightUnit::parse)?;
        Ok(part)
    }

    /// A word of `[terrain]` with a meaning of its own.
    fn parsed<T>(
        &self,
        key: &Key<Word>,
        name: &str,
        parse: impl Fn(&str) -> Result<T, String>,
    ) -> Result<Option<T>, SceneIoError> {
        let Some(key) = key else { return Ok(None) };
        let Word(word) = key.get_ref();
        match parse(word) {
            Ok(value) => Ok(Some(value)),
            Err(expected) => {
                Err(self.error(key.span(), format!("`terrain.{name}` is \"{word}\"; {expected}")))
            }
        }
    }
}
