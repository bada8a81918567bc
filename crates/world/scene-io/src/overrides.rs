//! Changes that the command line makes to a scene.

use raypencil_scene::{Beam, FluxModel};

use crate::parse::shared::{FAN_DEG, GLOBAL_M, THICKNESS_MM, TURN_DEG};
use crate::parse::source::number_text;
use crate::plan::ScenePlan;
use crate::scene_error::SceneIoError;
use crate::settings::Setting;

/// Numbers that replace those of a scene, in the units of the command line. `None`: the scene's own.
///
/// ```
/// use raypencil_scene_io::{Overrides, load};
///
/// let overrides = Overrides { fan_deg: Some(90.0), thickness_mm: Some(4.0), ..Overrides::default() };
/// let beam = load("pyramids", &overrides)?.scene.beams()[0].sensor;
/// assert_eq!(beam.thickness, 0.004);
/// // A full angle of 90 degrees is as wide to either side as the grid plane is far: tan(45 degrees) = 1.
/// assert!((beam.half_width / beam.grid_distance - 1.0).abs() < 1e-15);
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overrides {
    /// Position of the vehicle on the ground, global x and y, metres. It also replaces a height.
    pub at: Option<[f64; 2]>,
    /// Heading of the vehicle, degrees to the left of the global x axis.
    pub heading_deg: Option<f64>,
    /// Full fan angle of every beam, degrees.
    pub fan_deg: Option<f64>,
    /// Thickness T of every beam's sheet, millimetres.
    pub thickness_mm: Option<f64>,
    /// Model of the flux.
    pub flux_model: Option<FluxModel>,
    /// Keys of the scene file, set before it is read; the numbers above come after them.
    pub settings: Vec<Setting>,
    /// The scene is for a drive, which needs ground where the vehicle stands: an error does not offer a height in its place.
    pub for_drive: bool,
}

impl Overrides {
    /// The changes in words, for digests; `None`: there are none beside settings, which are part of the scene's text.
    pub(crate) fn words(&self) -> Option<String> {
        let Self { at, heading_deg, fan_deg, thickness_mm, flux_model, settings: _, for_drive: _ } = self;
        let changed = at.is_some()
            || flux_model.is_some()
            || [heading_deg, fan_deg, thickness_mm].iter().any(|number| number.is_some());
        // The words of earlier versions, so that a digest of then is that of now.
        changed.then(|| {
            format!(
                "Overrides {{ at: {at:?}, heading_deg: {heading_deg:?}, fan_deg: {fan_deg:?}, thickness_mm: \
                 {thickness_mm:?}, flux_model: {flux_model:?} }}"
            )
        })
    }

    /// Refuses a number out of range.
    pub(crate) fn check(&self) -> Result<(), SceneIoError> {
        let [x, y] = self.at.map_or([None; 2], |at| at.map(Some));
        let all = [
            ("at x", x, GLOBAL_M, "metres"),
            ("at y", y, GLOBAL_M, "metres"),
            ("heading", self.heading_deg, TURN_DEG, "degrees"),
            ("fan", self.fan_deg, FAN_DEG, "degrees"),
            ("thickness", self.thickness_mm, THICKNESS_MM, "millimetres"),
        ];
        for (name, value, range, unit) in all {
            if let Some(value) = value.filter(|value| !range.contains(value)) {
                let [low, high] = [range.start(), range.end()].map(|end| number_text(*end));
                let expected = format!("{low} to {high} {unit}");
                return Err(SceneIoError::Override { name, value: number_text(value), expected });
            }
        }
        self.check_settings()
    }

    /// Refuses a setting of what is given as a number of its own, too.
    fn check_settings(&self) -> Result<(), SceneIoError> {
        let numbers = [
            ("at", self.at.is_some(), "vehicle.position_m"),
            ("heading", self.heading_deg.is_some(), "vehicle.heading_deg"),
            ("fan", self.fan_deg.is_some(), "beam.fan_deg"),
            ("thickness", self.thickness_mm.is_some(), "beam.thickness_mm"),
            ("flux", self.flux_model.is_some(), "flux.model"),
        ];
        for (name, _, key) in numbers.into_iter().filter(|(_, is_given, _)| *is_given) {
            let own = Setting::new(key, "")?;
            if let Some(setting) = self.settings.iter().find(|setting| setting.overlaps(&own)) {
                return Err(
                    setting.refused(format!("{name} (--{name}) sets the same; expected one of the two"))
                );
            }
        }
        Ok(())
    }

    /// Refuses to place a vehicle: a resolved scene has none.
    pub(crate) fn check_resolved(&self) -> Result<(), SceneIoError> {
        let at = self.at.map(|[x, y]| ("at", format!("{x},{y}")));
        let heading = self.heading_deg.map(|heading| ("heading", heading.to_string()));
        match at.or(heading) {
            None => Ok(()),
            Some((name, value)) => {
                let expected = "none: a resolved scene has no vehicle to place, only sensors".to_string();
                Err(SceneIoError::Override { name, value, expected })
            }
        }
    }

    /// Puts the overrides in place of the numbers of a plan.
    pub(crate) fn apply(&self, plan: &mut ScenePlan) {
        if let Some(at) = self.at {
            plan.vehicle.position = at;
            plan.vehicle.height = None;
        }
        if let Some(heading_deg) = self.heading_deg {
            plan.vehicle.heading_deg = heading_deg;
        }
        plan.beams.iter_mut().for_each(|(_, beam)| self.apply_to_beam(beam));
        if let Some(flux_model) = self.flux_model {
            plan.flux_model = flux_model;
        }
    }

    /// Puts the overrides in place of the numbers of one beam.
    pub(crate) fn apply_to_beam(&self, beam: &mut Beam) {
        if let Some(fan_deg) = self.fan_deg {
            beam.half_width = Beam::half_width_of(beam.grid_distance, fan_deg.to_radians());
        }
        if let Some(thickness_mm) = self.thickness_mm {
            beam.thickness = thickness_mm / 1e3;
        }
    }
}
