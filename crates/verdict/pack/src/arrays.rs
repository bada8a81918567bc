//! The answers of a sensor as NPY arrays. `docs/formats/files.md` has their names.

use std::path::Path;

use glam::DVec3;
use raypencil_files::{FileError, write_npy};
use raypencil_judge::{Answers, BeamLight, flux_channel, image_channel};
use raypencil_scene::{FaceId, FluxModel, HitQuantity, HitRaster, Image, Maybe, Pixel, Sample, SensorId};

use crate::canonical_nan::CANONICAL_NAN;
use crate::manifest::{ChannelType, FileRole, FileType, ManifestChannel, ManifestFile};
use crate::margins::SensorMargins;
use crate::units::unit_of_flux;

/// Writes the arrays of one sensor into a pack, and lists them.
pub(crate) struct ArrayWriter<'a> {
    pack: &'a Path,
    sensor: SensorId,
    files: Vec<ManifestFile>,
}

impl<'a> ArrayWriter<'a> {
    pub(crate) fn new(pack: &'a Path, sensor: SensorId) -> Self {
        Self { pack, sensor, files: Vec::new() }
    }

    /// Writes every quantity and every margin of the sensor. Returns the manifest's entries.
    pub(crate) fn write(
        mut self,
        answers: &Answers,
        margins: &SensorMargins,
        model: FluxModel,
    ) -> Result<Vec<ManifestFile>, FileError> {
        let map = answers.map(self.sensor);
        for quantity in HitQuantity::ALL {
            let [name, ..] = quantity.channels() else { continue };
            match map.raster(quantity) {
                Some(HitRaster::Scalar(image)) if quantity.is_length() => self.lengths(name, Some(image))?,
                Some(HitRaster::Scalar(image)) => self.cosines(name, Some(image))?,
                // `P.X`, `P.Y` and `P.Z` are one array, `P`.
                Some(HitRaster::Vector(image)) => {
                    self.vectors(name.trim_end_matches(".X"), quantity.unit(), image)?;
                }
                None => {}
            }
        }
        if let Some(faces) = &map.face {
            let index = |face: Maybe<FaceId>| face.get().map_or(u32::MAX, |FaceId(index)| index);
            self.integers("face.I", &convert(faces, index))?;
        }
        match self.sensor {
            SensorId::Camera => {
                for (beam, light) in answers.light.iter().enumerate() {
                    self.flux(&image_channel(beam, None), model, light.image.as_ref())?;
                    let second = model.other();
                    self.flux(&image_channel(beam, Some(second)), second, light.other_image.as_ref())?;
                }
            }
            SensorId::Beam(beam) => self.returns(&answers.light[beam], model)?,
        }
        for (name, unit, image) in margins.channels() {
            self.reals(name, unit, image)?;
        }
        Ok(self.files)
    }

    /// What the camera receives of each pencil.
    fn returns(&mut self, light: &BeamLight, model: FluxModel) -> Result<(), FileError> {
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
            let index = |axis: fn(Pixel) -> u32| {
                convert(pixel, |cell: Maybe<Pixel>| axis(cell.get().unwrap_or(Pixel::NOTHING)))
            };
            self.integers("pixel.I", &index(|pixel| pixel.i))?;
            self.integers("pixel.J", &index(|pixel| pixel.j))?;
        }
        self.lengths("view.Z", returns.depth.as_ref())?;
        self.cosines("offAxis.V", returns.cos_off_axis.as_ref())?;
        self.cosines("emission.V", returns.cos_view.as_ref())?;
        self.flux(&flux_channel(None), model, returns.flux.as_ref())?;
        let second = model.other();
        self.flux(&flux_channel(Some(second)), second, light.other_flux.as_ref())
    }

    /// Metres; infinity where nothing is hit.
    fn lengths(&mut self, name: &str, image: Option<&Image<Maybe<f64>>>) -> Result<(), FileError> {
        let Some(image) = image else { return Ok(()) };
        self.reals(name, "m", &convert(image, |cell: Maybe<f64>| cell.get().unwrap_or(f64::INFINITY)))
    }

    /// Cosines; NaN where nothing is hit.
    fn cosines(&mut self, name: &str, image: Option<&Image<Maybe<f64>>>) -> Result<(), FileError> {
        let Some(image) = image else { return Ok(()) };
        self.reals(name, "1", &convert(image, |cell: Maybe<f64>| cell.get().unwrap_or(CANONICAL_NAN)))
    }

    fn flux(&mut self, name: &str, model: FluxModel, image: Option<&Image<f64>>) -> Result<(), FileError> {
        image.map_or(Ok(()), |image| self.reals(name, unit_of_flux(model), image))
    }

    /// Vectors as arrays of shape (rows, columns, 3); NaN where nothing is hit.
    fn vectors(&mut self, name: &str, unit: &str, image: &Image<Maybe<DVec3>>) -> Result<(), FileError> {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| {
            convert(image, |cell: Maybe<DVec3>| cell.get().map_or(CANONICAL_NAN, |vector| vector[axis]))
        });
        let path = self.path(name);
        write_npy(self.pack.join(&path), &[&x, &y, &z])?;
        let names = [".X", ".Y", ".Z"].map(|axis| format!("{name}{axis}"));
        let channels = names.each_ref().map(|name| (name.as_str(), unit));
        self.list(path, (FileType::Float64, ChannelType::Float64), x.width(), x.height(), &channels)
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

    fn integers(&mut self, name: &str, image: &Image<u32>) -> Result<(), FileError> {
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

    /// The path of an array from the pack's folder.
    fn path(&self, name: &str) -> String {
        format!("{}/{name}.npy", self.sensor)
    }

    /// Lists an array that was written. Its shape has a third axis if it has several channels.
    fn list(
        &mut self,
        path: String,
        (kind, channel_kind): (FileType, ChannelType),
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
            channels: channels.iter().map(|(name, unit)| channel(name, unit, channel_kind)).collect(),
            ..ManifestFile::of(self.pack, path, FileRole::Answers)?
        });
        Ok(())
    }
}

/// A manifest's entry of a channel.
pub(crate) fn channel(name: &str, unit: &str, kind: ChannelType) -> ManifestChannel {
    ManifestChannel { name: name.to_string(), unit: unit.to_string(), kind }
}

/// An image with `change` applied to each cell.
pub(crate) fn convert<T: Copy, U: Copy>(image: &Image<T>, change: impl Fn(T) -> U) -> Image<U> {
    Image::from_cells(image.width(), image.height(), image.cells().iter().map(|cell| change(*cell)).collect())
}
