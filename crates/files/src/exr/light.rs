//! Returns and flux images as channels.

use std::path::Path;

use crate::error::{Fault, FileError};
use crate::exr::{ExrMap, NO_VALUE, Raster, channel, convert};
use raypencil_scene::{FluxModel, Image, Maybe, Pixel, Returns, Sample};

const VISIBLE: &str = "visible.V";

const PIXEL: [&str; 2] = ["pixel.I", "pixel.J"];

const FLUX: &str = "flux.V";

/// r, cos(phi) and cos(theta): what the flux is made of.
const VIEW_DEPTH: &str = "view.Z";

const OFF_AXIS: &str = "offAxis.V";

const EMISSION: &str = "emission.V";

/// The unit of a flux.
fn unit(model: FluxModel) -> &'static str {
    match model {
        FluxModel::Radiometric => "W",
        FluxModel::Eq1 => "W/m",
    }
}

impl ExrMap {
    /// Adds what comes back of a beam's pencils: `visible.V`, `pixel.I`, `pixel.J`, `view.Z`, `offAxis.V`, `cos_view.V`
    /// and `flux.V`, those that there are.
    ///
    /// # Panics
    /// If they are of another size.
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
        self.scalar(VIEW_DEPTH, returns.depth.as_ref(), f32::INFINITY);
        self.scalar(OFF_AXIS, returns.cos_off_axis.as_ref(), NO_VALUE);
        self.scalar(EMISSION, returns.cos_view.as_ref(), NO_VALUE);
        let units = "visible: 0 or 1; pixel: index; view: metre; offAxis, emission: 1; flux: ";
        let attributes = [
            ("returnUnit", format!("{units}{}", unit(model))),
            ("noReturn", "visible, flux: 0; pixel: 4294967295; view: +Inf; offAxis, emission: NaN".into()),
        ];
        self.attributes.extend(attributes.map(|(name, value)| (name.to_string(), value)));
    }

    /// Adds the flux of a beam on the camera's image: `flux.beamN`.
    ///
    /// # Panics
    /// If it is of another size.
    pub fn insert_flux(&mut self, beam: usize, image: &Image<f64>, model: FluxModel) {
        self.insert(format!("flux.beam{beam}"), Raster::F32(convert(image, |flux| flux as f32)));
        self.attributes.insert("fluxUnit".into(), format!("{} per pixel", unit(model)));
    }

    /// The returns of a beam: each of the channels that is there.
    ///
    /// # Errors
    /// Names the channel that is of the wrong type, or absent where its sibling is there.
    pub fn to_returns(&self, file: &Path) -> Result<Returns, FileError> {
        self.returns().map_err(|fault| FileError::Exr(fault.in_file(file)))
    }

    fn returns(&self) -> Result<Returns, Fault> {
        let mut returns = Returns::unsupported(self.width, self.height);
        returns.visible = self.reals(VISIBLE)?.map(|image| convert(image, |cell| cell > 0.5));
        returns.flux = self.reals(FLUX)?.map(|image| convert(image, f64::from));
        returns.depth = self.scalar_of(VIEW_DEPTH)?;
        returns.cos_off_axis = self.scalar_of(OFF_AXIS)?;
        returns.cos_view = self.scalar_of(EMISSION)?;
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

    /// The flux of a beam on the camera's image, if the file has it.
    ///
    /// # Errors
    /// Names the channel if it is of the wrong type.
    pub fn to_flux(&self, beam: usize, file: &Path) -> Result<Option<Image<f64>>, FileError> {
        let image = self.reals(&format!("flux.beam{beam}"));
        let image = image.map_err(|fault| FileError::Exr(fault.in_file(file)))?;
        Ok(image.map(|image| convert(image, f64::from)))
    }

    fn wholes(&self, name: &str) -> Result<Option<&Image<u32>>, Fault> {
        match self.channels.get(name) {
            None => Ok(None),
            Some(Raster::U32(image)) => Ok(Some(image)),
            Some(Raster::F32(_)) => Err(Fault::new(channel(name), "of type F32 or F16", "U32")),
        }
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
    fn flux_images_come_back_as_they_were_written() {
        let mut map = ExrMap::new(2, 1);
        let image = Image::from_cells(2, 1, vec![0.0, 0.25]);
        map.insert_flux(1, &image, FluxModel::Radiometric);
        assert_eq!(map.to_flux(1, Path::new("here")).unwrap(), Some(image));
        assert_eq!(map.to_flux(0, Path::new("here")).unwrap(), None);
        assert_eq!(map.attributes["fluxUnit"], "W per pixel");
    }
}
