//! The answers of a sensor as one OpenEXR file in f32.

use std::path::Path;

use raypencil_files::{Attributes, ExrMap, FileError, Raster, write_exr};
use raypencil_judge::{Answers, flux_channel, image_channel};
use raypencil_scene::{FluxModel, Image, SensorId};

use crate::arrays::{channel, convert};
use crate::canonical_nan::CANONICAL_NAN_F32;
use crate::manifest::{ChannelType, FileRole, FileType, ManifestFile};
use crate::margins::SensorMargins;
use crate::units::{unit_of_channel, unit_of_flux};

/// Writes the answers in f32: the channels of every renderer's file, the flux of the other model, and the margins.
pub(crate) fn write_exr_map(
    answers: &Answers,
    margins: &SensorMargins,
    model: FluxModel,
    attributes: &Attributes,
    sensor: SensorId,
    folder: &Path,
) -> Result<ManifestFile, FileError> {
    let mut exr = ExrMap::from_sensor_map(answers.map(sensor), attributes);
    let other = model.other();
    let single = |image: &Image<f64>| Raster::F32(convert(image, |flux| flux as f32));
    match sensor {
        SensorId::Camera => {
            for (beam, light) in answers.light.iter().enumerate() {
                if let Some(image) = &light.image {
                    exr.insert_flux(beam, image, model);
                }
                if let Some(image) = &light.other_image {
                    exr.insert(image_channel(beam, Some(other)), single(image));
                }
            }
        }
        SensorId::Beam(beam) => {
            exr.insert_returns(&answers.light[beam].returns, model);
            if let Some(flux) = &answers.light[beam].other_flux {
                exr.insert(flux_channel(Some(other)), single(flux));
            }
        }
    }
    for (name, _, image) in margins.channels() {
        exr.insert(name, Raster::F32(convert(image, single_margin)));
    }
    let extra = [
        (
            "rounding",
            "each value is the single nearest to the exact number; margins are rounded down".to_string(),
        ),
        ("otherFluxUnit", format!("flux.{}: {}", other.word(), unit_of_flux(other))),
        ("marginUnit", "face, surface, visibility: cell; landing: camera pixel".into()),
    ];
    exr.attributes.extend(extra.map(|(name, value)| (name.to_string(), value)));
    let path = format!("{sensor}.exr");
    write_exr(folder.join(&path), &exr)?;
    let entry = |(name, raster): (&String, &Raster)| {
        let kind = if raster.as_u32().is_some() { ChannelType::Uint32 } else { ChannelType::Float32 };
        channel(name, unit_of_channel(name, model), kind)
    };
    Ok(ManifestFile {
        kind: Some(FileType::Exr),
        shape: Some(vec![exr.height, exr.width]),
        channels: exr.channels.iter().map(entry).collect(),
        ..ManifestFile::of(folder, path, FileRole::Answers)?
    })
}

/// A margin as f32. It was rounded down to f32 before, so this is exact.
fn single_margin(margin: f64) -> f32 {
    if margin.is_nan() { CANONICAL_NAN_F32 } else { margin as f32 }
}
