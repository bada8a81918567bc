//! Returns of a beam's pencils and flux images as channels.

use raypencil_scene::{FluxModel, Image, Maybe, Pixel, Returns, Sample};

use crate::exr::map::{ExrMap, NO_VALUE, Raster, convert};

const VISIBLE: &str = "visible.V";

const PIXEL: [&str; 2] = ["pixel.I", "pixel.J"];

const FLUX: &str = "flux.V";

/// Depth of the hit before the camera, r in the equations of the flux.
const VIEW_DEPTH: &str = "view.Z";

/// Cosine of the angle phi off the camera's axis.
const OFF_AXIS: &str = "offAxis.V";

/// Cosine of the angle theta between normal and view. The name is that of the published format.
const EMISSION: &str = "emission.V";

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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pencil_without_a_return_has_the_numbers_of_the_documentation() {
        let back = raypencil_scene::Return {
            visible: true,
            pixel: Some(Pixel { i: 7, j: 1023 }),
            depth: 2.0,
            cos_off_axis: 0.5,
            cos_view: 0.25,
            flux: 0.0078125,
        };
        let mut returns = Returns::empty(3, 1);
        returns.put(1, 0, &back);
        returns.put(2, 0, &raypencil_scene::Return { visible: false, pixel: None, flux: 0.0, ..back });
        let mut map = ExrMap::new(3, 1);
        map.insert_returns(&returns, FluxModel::Eq1);
        // No point, a point that is seen, a point that is hidden.
        let bits =
            |name: &str| map.channels[name].as_f32().unwrap().cells().iter().map(|cell| cell.to_bits());
        for (name, expected) in [
            ("visible.V", [0.0, 1.0, 0.0]),
            ("flux.V", [0.0, 0.0078125, 0.0]),
            ("view.Z", [f32::INFINITY, 2.0, 2.0]),
            ("offAxis.V", [NO_VALUE, 0.5, 0.5]),
            ("emission.V", [NO_VALUE, 0.25, 0.25]),
        ] {
            assert!(bits(name).eq(expected.map(f32::to_bits)), "{name}");
        }
        let whole = |name: &str| map.channels[name].as_u32().unwrap().cells().to_vec();
        assert_eq!(whole("pixel.I"), [u32::MAX, 7, u32::MAX]);
        assert_eq!(whole("pixel.J"), [u32::MAX, 1023, u32::MAX]);
        assert!(map.attributes["returnUnit"].ends_with("W/m"));
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
    fn a_flux_image_has_the_name_of_its_beam_and_its_unit() {
        let mut map = ExrMap::new(2, 1);
        map.insert_flux(1, &Image::from_cells(2, 1, vec![0.0, 0.25]), FluxModel::Radiometric);
        assert_eq!(map.channels.keys().collect::<Vec<_>>(), ["flux.beam1"]);
        assert_eq!(map.channels["flux.beam1"].as_f32().unwrap().cells(), [0.0, 0.25]);
        assert_eq!(map.attributes["fluxUnit"], "W per pixel");
    }
}
