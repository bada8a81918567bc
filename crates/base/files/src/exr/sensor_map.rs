//! Maps of one sensor as channels. Names and units: `docs/formats/files.md`.

use glam::DVec3;
use raypencil_scene::{HitQuantity, HitRaster, Image, Maybe, SensorId, SensorMap};

use crate::exr::map::{ExrMap, NO_VALUE, Raster, convert};

/// Face index of a cell without a hit.
const NO_FACE: u32 = u32::MAX;

const FACE: &str = "face.I";

/// Text attributes of a file of sensor maps, beside the standard ones that follow from its channels.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Attribute `renderer`: name of the program that computed the maps.
    pub renderer: String,
    /// Attribute `sceneSha256`: digest of the rendered scene.
    pub scene_sha256: String,
    /// Further attributes, name and value; a name given here replaces a standard one.
    pub extra: Vec<(String, String)>,
}

impl ExrMap {
    /// Channels of the quantities that `map` has, rounded to `f32`.
    pub fn from_sensor_map(map: &SensorMap, attributes: &Attributes) -> Self {
        let mut exr = Self::new(map.width, map.height);
        for quantity in HitQuantity::ALL {
            let no_hit = if quantity.is_length() { f32::INFINITY } else { NO_VALUE };
            match map.raster(quantity) {
                Some(HitRaster::Scalar(image)) => {
                    exr.insert_scalar(quantity.channels()[0], Some(image), no_hit);
                }
                Some(HitRaster::Vector(image)) => exr.insert_vector(quantity.channels(), image),
                None => {}
            }
        }
        if let Some(faces) = &map.face {
            exr.insert(FACE, Raster::U32(convert(faces, |face| face.get().map_or(NO_FACE, |face| face.0))));
        }
        let rule = match map.sensor {
            SensorId::Camera => {
                "cell (i, j) is pixel (i, j), its ray through the pixel's middle; row 0 on top"
            }
            SensorId::Beam(_) => "cell (i, j) is the central ray of pencil (i, j); row 0 on top",
        };
        let standard = [
            ("unit", "range, depth, P: metre; N, incidence: 1; face: index"),
            ("frame", "scene: z up, global minus the scene origin"),
            ("pixelRule", rule),
            ("noHit", "range, depth: +Inf; P, N, incidence: NaN; face: 4294967295"),
            ("raypencilVersion", env!("CARGO_PKG_VERSION")),
            ("renderer", &attributes.renderer),
            ("sceneSha256", &attributes.scene_sha256),
        ];
        let sensor = map.sensor.to_string();
        let sensor = std::iter::once(("sensor", sensor.as_str()));
        let extra = attributes.extra.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        for (name, value) in standard.into_iter().chain(sensor).chain(extra) {
            exr.attributes.insert(name.to_string(), value.to_string());
        }
        exr
    }

    /// Adds the three channels of a vector; cells without a value get NaN.
    fn insert_vector(&mut self, names: &[&str], image: &Image<Maybe<DVec3>>) {
        for (axis, name) in names.iter().enumerate() {
            let cells = convert(image, |cell| cell.get().map_or(NO_VALUE, |vector| vector[axis] as f32));
            self.insert(*name, Raster::F32(cells));
        }
    }
}
