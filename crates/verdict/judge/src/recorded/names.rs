//! Names of the channels of a recording, as `docs/formats/files.md` lists them.

use crate::quantity::{Item, Quantity};
use raypencil_scene::{FluxModel, HitQuantity, Scene, SensorId};

pub(super) const FACE: &str = "face.I";
pub(super) const VISIBLE: &str = "visible.V";
pub(super) const PIXEL: [&str; 2] = ["pixel.I", "pixel.J"];
pub(super) const VIEW: &str = "view.Z";
pub(super) const OFF_AXIS: &str = "offAxis.V";
pub(super) const EMISSION: &str = "emission.V";
pub(super) const FLUX: &str = "flux.V";

/// Lengths that depth images hold as whole numbers.
pub(super) const MAYBE_WHOLE: [&str; 3] = ["range.T", "depth.Z", VIEW];

/// The names of all maps of a sensor of a scene but those of path tracers.
pub(super) fn maps_of(scene: &Scene, sensor: SensorId) -> Vec<String> {
    let fixed = HitQuantity::ALL.into_iter().flat_map(|quantity| quantity.channels().iter().copied());
    let fixed = fixed.chain([FACE, VISIBLE, PIXEL[0], PIXEL[1], VIEW, OFF_AXIS, EMISSION]).map(String::from);
    let models = [None, Some(scene.flux_model().other())];
    let of_beams = (0..scene.beams().len()).flat_map(|beam| models.map(|model| image_channel(beam, model)));
    let all = fixed.chain(models.map(flux_channel)).chain(of_beams);
    all.filter(|name| item_of_channel(scene, sensor, name).is_some()).collect()
}

/// Whether a channel holds radiance or a Monte Carlo estimate, which only a path tracer has.
pub(super) fn is_path_tracer_channel(key: &str) -> bool {
    let Some((sensor, name)) = key.split_once('/') else { return false };
    let is_camera = sensor == SensorId::Camera.to_string();
    let parts: Vec<&str> = name.split('.').collect();
    match parts[..] {
        ["radiance", "V"] => !is_camera,
        ["radiance", beam] => is_camera && beam.starts_with("beam"),
        [_, "mean" | "error", beam] => is_camera && beam.starts_with("beam"),
        _ => false,
    }
}

/// Name of the channel of a beam's flux: `flux.V`, or `flux.eq1.V` for the model that is not the scene's.
pub fn flux_channel(model: Option<FluxModel>) -> String {
    match model {
        None => FLUX.into(),
        Some(model) => format!("flux.{}.V", model.word()),
    }
}

/// Name of the camera's channel of a beam's flux: `flux.beam0`, or `flux.eq1.beam0`.
pub fn image_channel(beam: usize, model: Option<FluxModel>) -> String {
    match model {
        None => format!("flux.beam{beam}"),
        Some(model) => format!("flux.{}.beam{beam}", model.word()),
    }
}

/// The item that a channel of a sensor holds; `None` if its name is not known.
pub fn item_of_channel(scene: &Scene, sensor: SensorId, name: &str) -> Option<Item> {
    let second = scene.flux_model().other();
    let of_flux = |item: Item, own: &str, others: &str| {
        let is_other_model = name == others;
        (name == own || is_other_model).then_some(Item { is_other_model, ..item })
    };
    if sensor == SensorId::Camera {
        let image = (0..scene.beams().len()).find_map(|beam| {
            of_flux(Item::of_image(beam), &image_channel(beam, None), &image_channel(beam, Some(second)))
        });
        if image.is_some() {
            return image;
        }
    } else if let flux @ Some(_) =
        of_flux(Quantity::PencilFlux.into(), &flux_channel(None), &flux_channel(Some(second)))
    {
        return flux;
    }
    if let Some(quantity) = HitQuantity::ALL.into_iter().find(|one| one.channels().contains(&name)) {
        return Some(Quantity::from(quantity).into());
    }
    let quantity = match name {
        FACE => Quantity::Face,
        VISIBLE => Quantity::Visible,
        name if PIXEL.contains(&name) => Quantity::Pixel,
        VIEW => Quantity::CameraDepth,
        OFF_AXIS => Quantity::CosOffAxis,
        EMISSION => Quantity::CosView,
        _ => return None,
    };
    quantity.is_of(sensor).then(|| quantity.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_images_and_radiance_are_known() {
        for (key, is_known) in [
            ("camera/direct.mean.beam0", true),
            ("camera/direct.error.beam1", true),
            ("camera/radiance.beam0", true),
            ("beam-1/radiance.V", true),
            ("beam-1/direct.mean.beam0", false),
            ("camera/radiance.V", false),
            ("camera/range.T", false),
            ("direct.mean.beam0", false),
        ] {
            assert_eq!(is_path_tracer_channel(key), is_known, "{key}");
        }
    }
}
