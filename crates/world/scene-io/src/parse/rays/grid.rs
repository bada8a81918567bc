//! `grid = { ... }`: a raster of azimuth and elevation.

use serde::Deserialize;
use std::ops::RangeInclusive;
use toml::Spanned;

use raypencil_scene::pattern::{GRID_PRESETS, Grid, Spacing};

use crate::parse::key::Key;
use crate::parse::rays::keys::in_keys;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Number of steps, columns or rows.
pub(super) const COUNT: RangeInclusive<i64> = 1..=100_000_000;

/// Range of a sensor, metres.
pub(super) const RANGE_M: RangeInclusive<f64> = 0.0..=1e9;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GridKeys {
    preset: Key<String>,
    columns: Key<i64>,
    rows: Key<i64>,
    width_deg: Key<f64>,
    height_deg: Key<f64>,
    spacing: Key<String>,
    min_range_m: Key<f64>,
    max_range_m: Key<f64>,
}

impl Source<'_> {
    pub(super) fn grid(&self, name: &str, table: &Spanned<GridKeys>) -> Result<Grid, SceneIoError> {
        let keys = table.get_ref();
        let key = |key: &str| format!("{name}.{key}");
        let mut grid = Grid {
            columns: 0,
            rows: 0,
            width_deg: 0.0,
            height_deg: 0.0,
            spacing: Spacing::Angle,
            min_range_m: 0.0,
            max_range_m: f64::INFINITY,
        };
        if let Some(preset) = &keys.preset {
            let words = GRID_PRESETS.map(|name| (name, name));
            let word = self.word(preset, &key("preset"), &words)?;
            let Some(of_preset) = Grid::preset(word) else { unreachable!("a word of the list") };
            grid = of_preset;
        } else {
            let required = [
                ("columns", keys.columns.is_some()),
                ("rows", keys.rows.is_some()),
                ("width_deg", keys.width_deg.is_some()),
                ("height_deg", keys.height_deg.is_some()),
            ];
            if let Some((missing, _)) = required.iter().find(|(_, is_given)| !is_given) {
                let message = format!(
                    "`{}` is missing; expected columns, rows, width_deg and height_deg, or a preset",
                    key(missing)
                );
                return Err(self.error(table.span(), message));
            }
        }
        self.integer(&keys.columns, &key("columns"), &mut grid.columns, COUNT, "")?;
        self.integer(&keys.rows, &key("rows"), &mut grid.rows, COUNT, "")?;
        self.number(&keys.width_deg, &key("width_deg"), &mut grid.width_deg, 0.0..=360.0, "degrees")?;
        self.number(&keys.height_deg, &key("height_deg"), &mut grid.height_deg, 0.0..=180.0, "degrees")?;
        let words = [("angle", Spacing::Angle), ("tangent", Spacing::Tangent)];
        self.choice(&keys.spacing, &key("spacing"), &mut grid.spacing, &words)?;
        self.number(&keys.min_range_m, &key("min_range_m"), &mut grid.min_range_m, RANGE_M, "metres")?;
        self.number(&keys.max_range_m, &key("max_range_m"), &mut grid.max_range_m, RANGE_M, "metres")?;
        grid.validate(name).map_err(|error| self.refused(table.span(), &in_keys(error)))?;
        Ok(grid)
    }
}
