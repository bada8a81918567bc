//! Units of channels.

use raypencil_scene::FluxModel;

pub(crate) fn unit_of_flux(model: FluxModel) -> &'static str {
    match model {
        FluxModel::Radiometric => "W",
        FluxModel::Eq1 => "W/m",
    }
}

pub(crate) fn unit_of_channel(channel: &str, model: FluxModel) -> &'static str {
    let other = model.other();
    match channel {
        "range.T" | "depth.Z" | "view.Z" | "P.X" | "P.Y" | "P.Z" => "m",
        "face.I" | "pixel.I" | "pixel.J" => "index",
        "margin.landing" => "pixel",
        name if name.starts_with("margin.") => "cell",
        name if name.starts_with(&format!("flux.{}.", other.word())) => unit_of_flux(other),
        name if name.starts_with("flux.") => unit_of_flux(model),
        _ => "1",
    }
}
