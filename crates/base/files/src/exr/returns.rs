//! Returns of a beam's pencils and flux images as channels, and back.

use std::path::Path;

use raypencil_scene::{FluxModel, Image, Maybe, Pixel, Returns, Sample};

use crate::error::{Fault, FileError};
use crate::exr::map::{ExrMap, NO_VALUE, Raster, channel, convert};

const VISIBLE: &str = "visible.V";

const PIXEL: [&str; 2] = ["pixel.I", "pixel.J"];

const FLUX: &str = "flux.V";

/// Depth of the hit before the camera, r in the equations of the flux.
const VIEW_DEPTH: &str = "view.Z";

/// Cosine of the angle phi off the camera's axis.
const OFF_AXIS: &str = "offAxis.V";

/// Cosine of the angle theta between normal and view. The name is that of the published format.
const EMISSION: &str = "emission.V";

/// Unit of a flux.
fn unit(model: FluxModel) -> &'static str {
    match model {
        FluxModel::Radiometric => "W",
        FluxModel::Eq1 => "W/m",
    }
}

impl ExrMap {
    /// Adds the returns of a beam's pencils: those of `visible.V`, `pixel.I`, `pixel.J`, `view.Z`, `offAxis.V`,
    /// `emission.V` and `flux.V` that `returns` has.
    ///
    /// # Panics
    /// If the returns have another size than the map.
    pub fn insert_returns(&mut self, returns: &Returns, model: FluxModel) {
        if let Some(visible) = &returns.visible {
            let cell = |visible| if visible { 1.0 } else { 0.0 };
            self.insert(VISIBLE, Raster::F32(convert(visible, cell)));
        }
        if let Some(pixel) = &returns.pixel {
            let index = |of: fn(Pixel) -> u32| {
                convert(pixel, |cell: Maybe<Pixel>| of(cell.get().unwrap_or(Pixel::NOTHING)))
            };
            self.insert(PIXEL[0], Raster::U32(index(|pixel| pixel.i)));
            self.insert(PIXEL[1], Raster::U32(index(|pixel| pixel.j)));
        }
        if let Some(flux) = &returns.flux {
            self.insert(FLUX, Raster::F32(convert(flux, |flux| flux as f32)));
        }
        self.insert_scalar(VIEW_DEPTH, returns.depth.as_ref(), f32::INFINITY);
        self.insert_scalar(OFF_AXIS, returns.cos_off_axis.as_ref(), NO_VALUE);
        self.insert_scalar(EMISSION, returns.cos_view.as_ref(), NO_VALUE);
        let units = "visible: 0 or 1; pixel: index; view: metre; offAxis, emission: 1; flux: ";
        let attributes = [
            ("returnUnit", format!("{units}{}", unit(model))),
            ("noReturn", "visible, flux: 0; pixel: 4294967295; view: +Inf; offAxis, emission: NaN".into()),
        ];
        self.attributes.extend(attributes.map(|(name, value)| (name.to_string(), value)));
    }

    /// Adds the flux of beam N on the camera's image: `flux.beamN`.
    ///
    /// # Panics
    /// If the image has another size than the map.
    pub fn insert_flux(&mut self, beam: usize, image: &Image<f64>, model: FluxModel) {
        self.insert(format!("flux.beam{beam}"), Raster::F32(convert(image, |flux| flux as f32)));
        self.attributes.insert("fluxUnit".into(), format!("{} per pixel", unit(model)));
    }

    /// Returns of a beam, from the channels that are present.
    ///
    /// # Errors
    /// Names `file` and the channel that has the wrong type, or is absent while its sibling is present.
    pub fn to_returns(&self, file: &Path) -> Result<Returns, FileError> {
        self.returns().map_err(|fault| FileError::Exr(fault.in_file(file)))
    }

    fn returns(&self) -> Result<Returns, Fault> {
        let mut returns = Returns::unsupported(self.width, self.height);
        returns.visible = self.reals(VISIBLE)?.map(|image| convert(image, |cell| cell > 0.5));
        returns.flux = self.reals(FLUX)?.map(|image| convert(image, f64::from));
        returns.depth = self.scalar(VIEW_DEPTH)?;
        returns.cos_off_axis = self.scalar(OFF_AXIS)?;
        returns.cos_view = self.scalar(EMISSION)?;
        returns.pixel = match [self.wholes(PIXEL[0])?, self.wholes(PIXEL[1])?] {
            [Some(i), Some(j)] => {
                let cells = i.cells().iter().zip(j.cells());
                let cells = cells.map(|(&i, &j)| {
                    Some(Pixel { i, j }).filter(|pixel| !pixel.is_nothing() && j != u32::MAX).into()
                });
                Some(Image::from_cells(self.width, self.height, cells.collect()))
            }
            [None, None] => None,
            [i, _] => {
                let absent = PIXEL[usize::from(i.is_some())];
                return Err(Fault::new(channel(absent), "absent", format!("all of {}", PIXEL.join(", "))));
            }
        };
        Ok(returns)
    }

    /// Flux of a beam on the camera's image; `None` without the channel.
    ///
    /// # Errors
    /// Names `file` and the channel if it has the wrong type.
    pub fn to_flux(&self, beam: usize, file: &Path) -> Result<Option<Image<f64>>, FileError> {
        let image = self.reals(&format!("flux.beam{beam}"));
        let image = image.map_err(|fault| FileError::Exr(fault.in_file(file)))?;
        Ok(image.map(|image| convert(image, f64::from)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn returns_come_back_as_they_were_written() {
        let mut returns = Returns::empty(3, 2);
        let back = raypencil_scene::Return {
            visible: true,
            pixel: Some(Pixel { i: 7, j: 1023 }),
            depth: 2.0,
            cos_off_axis: 0.5,
            cos_view: 0.5,
            flux: 0.0078125,
        };
        returns.put(1, 0, &back);
        returns.put(2, 1, &raypencil_scene::Return { visible: false, pixel: None, flux: 0.0, ..back });
        let mut map = ExrMap::new(3, 2);
        map.insert_returns(&returns, FluxModel::Eq1);
        assert_eq!(map.to_returns(Path::new("here")).unwrap(), returns);
        assert!(map.attributes["returnUnit"].ends_with("W/m"));
        map.channels.remove("pixel.I");
        let error = map.to_returns(Path::new("here")).unwrap_err().to_string();
        assert!(error.contains("pixel.I") && error.contains("here"), "{error}");
        map.insert("pixel.J", Raster::F32(Image::filled(3, 2, 0.0)));
        let error = map.to_returns(Path::new("here")).unwrap_err().to_string();
        assert!(error.contains("pixel.J") && error.contains("U32"), "{error}");
    }

    #[test]
    fn each_quantity_of_a_return_has_the_channel_of_the_documentation() {
        // docs/formats/files.md: `pixel.I` is the column, `pixel.J` the row, `offAxis.V` cos(phi), `emission.V` cos(theta).
        // No two numbers are alike, so that two channels that are exchanged show.
        let back = raypencil_scene::Return {
            visible: true,
            pixel: Some(Pixel { i: 7, j: 1023 }),
            depth: 2.0,
            cos_off_axis: 0.75,
            cos_view: 0.5,
            flux: 0.25,
        };
        let mut returns = Returns::empty(1, 1);
        returns.put(0, 0, &back);
        let mut map = ExrMap::new(1, 1);
        map.insert_returns(&returns, FluxModel::Radiometric);
        let whole = |name: &str| map.channels[name].as_u32().map(|image| image.at(0, 0));
        assert_eq!((whole("pixel.I"), whole("pixel.J")), (Some(7), Some(1023)));
        let real = |name: &str| map.channels[name].as_f32().map(|image| image.at(0, 0));
        assert_eq!((real("offAxis.V"), real("emission.V")), (Some(0.75), Some(0.5)));
        assert_eq!((real("visible.V"), real("view.Z"), real("flux.V")), (Some(1.0), Some(2.0), Some(0.25)));
    }

    #[test]
    fn flux_images_come_back_as_they_were_written() {
        let mut map = ExrMap::new(2, 1);
        let image = Image::from_cells(2, 1, vec![0.0, 0.25]);
        map.insert_flux(1, &image, FluxModel::Radiometric);
        assert_eq!(map.to_flux(1, Path::new("here")).unwrap(), Some(image));
        assert_eq!(map.to_flux(0, Path::new("here")).unwrap(), None);
        assert_eq!(map.attributes["fluxUnit"], "W per pixel");
    }
}
