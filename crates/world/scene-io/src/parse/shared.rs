//! Limits and words that scene files share with resolved scenes or with the overrides of the command line.

use std::ops::RangeInclusive;
use toml::Spanned;

use raypencil_scene::{FluxModel, Profile};

use crate::parse::key::Key;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Full angle of a fan, from a thread to just below a half plane, degrees.
pub(crate) const FAN_DEG: RangeInclusive<f64> = 0.001..=179.9;

/// Thickness of a beam's sheet, millimetres.
pub(crate) const THICKNESS_MM: RangeInclusive<f64> = 1e-3..=1e5;

/// Angle of a turn, either way, degrees.
pub(crate) const TURN_DEG: RangeInclusive<f64> = -360.0..=360.0;

/// Global coordinate, metres: the limits of a scene origin.
pub(crate) const GLOBAL_M: RangeInclusive<f64> = -1e12..=1e12;

impl Source<'_> {
    pub(crate) fn flux_model(&self, key: &Spanned<String>) -> Result<FluxModel, SceneIoError> {
        let words = [FluxModel::Radiometric, FluxModel::Eq1].map(|model| (model.word(), model));
        self.word(key, "flux.model", &words)
    }

    /// Profile of a beam. The half width of a Gaussian is the value of the key `width_key`, unconverted; that key is
    /// given exactly if the profile is Gaussian.
    pub(crate) fn profile_word(
        &self,
        beam: &str,
        profile: &Spanned<String>,
        width: &Key<f64>,
        width_key: &str,
    ) -> Result<Profile, SceneIoError> {
        let name = format!("{beam}.profile");
        // The half width is filled in below.
        let gaussian = Profile::Gaussian { half_width: 0.0 };
        let words =
            [("paper", Profile::Paper), ("uniform_angle", Profile::UniformAngle), ("gaussian", gaussian)];
        match (self.word(profile, &name, &words)?, width) {
            (Profile::Gaussian { .. }, Some(width)) => Ok(Profile::Gaussian { half_width: *width.get_ref() }),
            (Profile::Gaussian { .. }, None) => {
                let message = format!("`{name}` is \"gaussian\" without a width; expected `{width_key}` too");
                Err(self.error(profile.span(), message))
            }
            (other, None) => Ok(other),
            (_, Some(width)) => {
                let message = format!(
                    "`{beam}.{width_key}` is given; expected it only with profile = \"gaussian\", not \"{}\"",
                    profile.get_ref()
                );
                Err(self.error(width.span(), message))
            }
        }
    }
}
