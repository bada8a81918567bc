//! `cone = { of = { ... }, ... }`: several rays in place of each ray of another pattern.

use serde::Deserialize;
use toml::Spanned;

use raypencil_scene::pattern::Cone;

use crate::parse::key::Key;
use crate::parse::rays::grid::GridKeys;
use crate::parse::rays::spinning::SpinningKeys;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Number of rings, if the file gives none: 1 + 6 + 12 rays.
const DEFAULT_RINGS: u64 = 2;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConeKeys {
    of: Key<OfKeys>,
    divergence_mrad: Key<f64>,
    rings: Key<i64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OfKeys {
    pub file: Key<String>,
    pub spinning: Key<SpinningKeys>,
    pub grid: Key<GridKeys>,
}

impl Source<'_> {
    /// The cone, and the keys of the pattern whose rays it replaces.
    pub(super) fn cone<'k>(
        &self,
        name: &str,
        table: &'k Spanned<ConeKeys>,
    ) -> Result<(Cone, &'k Spanned<OfKeys>), SceneIoError> {
        let keys = table.get_ref();
        let missing = |key: &str, expected: &str| {
            self.error(table.span(), format!("`{name}.{key}` is missing; expected {expected}"))
        };
        let Some(of) = &keys.of else { return Err(missing("of", "the pattern whose rays it replaces")) };
        let mut cone = Cone { divergence_rad: f64::NAN, rings: DEFAULT_RINGS };
        if keys.divergence_mrad.is_none() {
            return Err(missing("divergence_mrad", "the full angle of the beam in milliradians"));
        }
        let divergence = &mut cone.divergence_rad;
        let key = format!("{name}.divergence_mrad");
        self.converted(&keys.divergence_mrad, &key, divergence, 1e-6..=1e3, "milliradians", |mrad| {
            mrad / 1e3
        })?;
        self.integer(&keys.rings, &format!("{name}.rings"), &mut cone.rings, 1..=64, "")?;
        cone.validate(name).map_err(|error| self.refused(table.span(), &error))?;
        Ok((cone, of))
    }
}
