//! `cone = { of = { ... }, ... }`: several rays in place of each ray of another pattern.

use serde::Deserialize;
use toml::Spanned;

use raypencil_scene::pattern::{Cone, Keep, Returns};

use crate::parse::key::{Key, Word};
use crate::parse::rays::angles::AnglesKeys;
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
    returns: Key<ReturnsKeys>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReturnsKeys {
    keep: Key<Word>,
    separation_m: Key<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OfKeys {
    pub file: Key<String>,
    pub spinning: Key<SpinningKeys>,
    pub grid: Key<GridKeys>,
    pub angles: Key<AnglesKeys>,
}

impl Source<'_> {
    /// The cone, which of its returns are told, and the keys of the pattern whose rays it replaces.
    pub(super) fn cone<'k>(
        &self,
        name: &str,
        table: &'k Spanned<ConeKeys>,
    ) -> Result<(Cone, Option<Returns>, &'k Spanned<OfKeys>), SceneIoError> {
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
        let returns = keys.returns.as_ref().map(|returns| self.returns(&format!("{name}.returns"), returns));
        Ok((cone, returns.transpose()?, of))
    }

    /// Which returns of a beam are told.
    fn returns(&self, name: &str, table: &Spanned<ReturnsKeys>) -> Result<Returns, SceneIoError> {
        let ReturnsKeys { keep, separation_m } = table.get_ref();
        let expected = "\"first\", \"strongest\", \"last\", or how many of the strongest returns";
        let Some(keep) = keep else {
            return Err(self.error(table.span(), format!("`{name}.keep` is missing; expected {expected}")));
        };
        let Some(separation) = separation_m else {
            let message =
                format!("`{name}.separation_m` is missing; expected the gap between two returns in metres");
            return Err(self.error(table.span(), message));
        };
        let word = keep.get_ref().0.as_str();
        let kept = match word {
            "first" => Keep::First,
            "strongest" => Keep::Strongest,
            "last" => Keep::Last,
            _ => match word.parse().ok().filter(|most| (1..=Returns::MAX).contains(most)) {
                Some(most) => Keep::UpTo(most),
                None => {
                    let message =
                        format!("`{name}.keep` is {word}; expected {expected}, 1 to {}", Returns::MAX);
                    return Err(self.error(keep.span(), message));
                }
            },
        };
        let separation_m = *separation.get_ref();
        let key = format!("{name}.separation_m");
        self.check(separation_m, separation.span(), &key, 1e-6..=1e6, "metres")?;
        Ok(Returns { keep: kept, separation_m })
    }
}
