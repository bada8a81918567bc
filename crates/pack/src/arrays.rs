//! The answers of a sensor as NPY arrays, by the names of `docs/formats/files.md`.

use glam::DVec3;
use std::path::Path;

use crate::manifest::{ChannelType, FileRole, FileType, ManifestChannel, ManifestFile};
use crate::margins::SensorMargins;
use raypencil_files::{FileError, write_npy};
use raypencil_judge::{Answers, BeamLight, flux_channel, image_channel};
use raypencil_scene::{FluxModel, Image, Maybe, Pixel, Sample, SensorId};

/// Writes arrays into one folder of a pack and keeps the list of them.
pub(crate) struct Arrays<'a> {
    pack: &'a Path,
    sensor: SensorId,
    pub(super) files: Vec<ManifestFile>,
}

/// The one NaN that stands for nothing.
const NOTHING: f64 = f64::from_bits(0x7ff8_0000_0000_0000);

impl<'a> Arrays<'a> {
    pub(super) fn new(pack: &'a Path, sensor: SensorId) -> Self {
        Self { pack, sensor, files: Vec::new() }
    }

    /// Everything that is said of this sensor.
    pub(super) fn write(
        &mut self,
        answers: &Answers,
        margins: &SensorMargins,
        model: FluxModel,
    ) -> Result<(), FileError> {
        let map = answers.map(self.sensor);
        for (name, image) in [("range.T", &map.range), ("depth.Z", &map.depth)] {
            self.lengths(name, image.as_ref())?;
        }
        self.vectors("P", "m", map.point.as_ref())?;
        self.vectors("N", "1", map.normal.as_ref())?;
        self.cosines("incidence.V", map.cos_incidence.as_ref())?;
        if let Some(faces) = &map.face {
            let index = |face: Maybe<_>| face.get().map_or(u32::MAX, |raypencil_scene::FaceId(index)| index);
            self.wholes("face.I", &convert(faces, index))?;
        }
        match self.sensor {
            SensorId::Camera => {
                for (beam, light) in answers.light.iter().enumerate() {
                    self.flux(&image_channel(beam, None), model, light.image.as_ref())?;
                    let second = model.other();
                    self.flux(&image_channel(beam, Some(second)), second, light.other_image.as_ref())?;
                }
            }
            SensorId::Beam(beam) => self.light(&answers.light[beam], model)?,
        }
        for (name, unit, image) in margins.channels() {
            self.reals(name, unit, image)?;
        }
        Ok(())
    }

    fn light(&mut self, light: &BeamLight, model: FluxModel) -> Result<(), FileError> {
        let returns = &light.returns;
        if let Some(visible) = &returns.visible {
            let path = self.path("visible.V");
            write_npy(self.pack.join(&path), &[&convert(visible, u8::from)])?;
            self.list(
                path,
                (FileType::Uint8, ChannelType::Uint8),
                visible.width(),
                visible.height(),
                &[("visible.V", "1")],
            )?;
        }
        if let Some(pixel) = &returns.pixel {
            let part = |of: fn(Pixel) -> u32| {
                convert(pixel, |cell: Maybe<Pixel>| of(cell.get().unwrap_or(Pixel::NOTHING)))
            };
            self.wholes("pixel.I", &part(|pixel| pixel.i))?;
            self.wholes("pixel.J", &part(|pixel| pixel.j))?;
        }
        self.lengths("view.Z", returns.depth.as_ref())?;
        self.cosines("offAxis.V", returns.cos_off_axis.as_ref())?;
        self.cosines("emission.V", returns.cos_view.as_ref())?;
        self.flux(&flux_channel(None), model, returns.flux.as_ref())?;
        let second = model.other();
        self.flux(&flux_channel(Some(second)), second, light.other_flux.as_ref())
    }

    fn lengths(&mut self, name: &str, image: Option<&Image<Maybe<f64>>>) -> Result<(), FileError> {
        let Some(image) = image else { return Ok(()) };
        self.reals(name, "m", &convert(image, |cell: Maybe<f64>| cell.get().unwrap_or(f64::INFINITY)))
    }

    fn cosines(&mut self, name: &str, image: Option<&Image<Maybe<f64>>>) -> Result<(), FileError> {
        let Some(image) = image else { return Ok(()) };
        self.reals(name, "1", &convert(image, |cell: Maybe<f64>| cell.get().unwrap_or(NOTHING)))
    }

    fn flux(&mut self, name: &str, model: FluxModel, image: Option<&Image<f64>>) -> Result<(), FileError> {
        image.map_or(Ok(()), |image| self.reals(name, unit_of_flux(model), image))
    }

    fn vectors(
        &mut self,
        name: &str,
        unit: &str,
        image: Option<&Image<Maybe<DVec3>>>,
    ) -> Result<(), FileError> {
        let Some(image) = image else { return Ok(()) };
        let part = |axis: usize| {
            convert(image, |cell: Maybe<DVec3>| cell.get().map_or(NOTHING, |vector| vector[axis]))
        };
        let planes = [part(0), part(1), part(2)];
        self.planes(name, &[&planes[0], &planes[1], &planes[2]], &[".X", ".Y", ".Z"], unit)
    }

    /// Several planes as one array of their components.
    fn planes(
        &mut self,
        name: &str,
        planes: &[&Image<f64>],
        parts: &[&str],
        unit: &str,
    ) -> Result<(), FileError> {
        let path = self.path(name);
        write_npy(self.pack.join(&path), planes)?;
        let names: Vec<String> = parts.iter().map(|part| format!("{name}{part}")).collect();
        let channels: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), unit)).collect();
        self.list(
            path,
            (FileType::Float64, ChannelType::Float64),
            planes[0].width(),
            planes[0].height(),
            &channels,
        )
    }

    fn reals(&mut self, name: &str, unit: &str, image: &Image<f64>) -> Result<(), FileError> {
        let path = self.path(name);
        write_npy(self.pack.join(&path), &[image])?;
        self.list(
            path,
            (FileType::Float64, ChannelType::Float64),
            image.width(),
            image.height(),
            &[(name, unit)],
        )
    }

    fn wholes(&mut self, name: &str, image: &Image<u32>) -> Result<(), FileError> {
        let path = self.path(name);
        write_npy(self.pack.join(&path), &[image])?;
        self.list(
            path,
            (FileType::Uint32, ChannelType::Uint32),
            image.width(),
            image.height(),
            &[(name, "index")],
        )
    }

    fn path(&self, name: &str) -> String {
        format!("{}/{name}.npy", self.sensor)
    }

    fn list(
        &mut self,
        path: String,
        (kind, of_channel): (FileType, ChannelType),
        width: u32,
        height: u32,
        channels: &[(&str, &str)],
    ) -> Result<(), FileError> {
        let mut shape = vec![height, width];
        if channels.len() > 1 {
            shape.push(channels.len() as u32);
        }
        self.files.push(ManifestFile {
            kind: Some(kind),
            shape: Some(shape),
            channels: channels.iter().map(|(name, unit)| channel(name, unit, of_channel)).collect(),
            ..ManifestFile::of(self.pack, path, FileRole::Answers)?
        });
        Ok(())
    }
}

pub(crate) fn channel(name: &str, unit: &str, kind: ChannelType) -> ManifestChannel {
    ManifestChannel { name: name.to_string(), unit: unit.to_string(), kind }
}

/// The unit of a flux.
pub(crate) fn unit_of_flux(model: FluxModel) -> &'static str {
    match model {
        FluxModel::Radiometric => "W",
        FluxModel::Eq1 => "W/m",
    }
}

/// An image cell by cell.
pub(crate) fn convert<T: Copy, U: Copy>(image: &Image<T>, of: impl Fn(T) -> U) -> Image<U> {
    Image::from_cells(image.width(), image.height(), image.cells().iter().map(|cell| of(*cell)).collect())
}
