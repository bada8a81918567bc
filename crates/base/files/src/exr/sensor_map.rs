//! Maps of one sensor as channels, and back. Names and units: `docs/formats/files.md`.

use std::path::Path;

use glam::DVec3;
use raypencil_scene::{
    FaceId, HitQuantity, HitRaster, HitRasterMut, Image, Maybe, Quantities, Sample, SensorId, SensorMap,
};

use crate::error::{Fault, FileError};
use crate::exr::map::{ExrMap, NO_VALUE, Raster, channel, convert};
use crate::exr::read::read_exr;
use crate::exr::write::write_exr;
use crate::limits::Limits;

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

    /// Maps of `sensor` from the channels that `docs/formats/files.md` lists; other channels are ignored.
    ///
    /// A cell whose value is not finite, or whose face is 4294967295, has no hit.
    ///
    /// # Errors
    /// Names `file` and the channel that has the wrong type, or is absent while one of its two siblings is present.
    pub fn to_sensor_map(&self, sensor: SensorId, file: &Path) -> Result<SensorMap, FileError> {
        let in_file = |fault: Fault| FileError::Exr(fault.in_file(file));
        let mut map = SensorMap::empty(sensor, self.width, self.height, Quantities::NONE);
        for quantity in HitQuantity::ALL {
            match map.raster_mut(quantity) {
                HitRasterMut::Scalar(image) => {
                    *image = self.scalar(quantity.channels()[0]).map_err(in_file)?;
                }
                HitRasterMut::Vector(image) => *image = self.vector(quantity.channels()).map_err(in_file)?,
            }
        }
        map.face = faces(self).map_err(in_file)?;
        Ok(map)
    }

    /// Adds the three channels of a vector; cells without a value get NaN.
    fn insert_vector(&mut self, names: &[&str], image: &Image<Maybe<DVec3>>) {
        for (axis, name) in names.iter().enumerate() {
            let cells = convert(image, |cell| cell.get().map_or(NO_VALUE, |vector| vector[axis] as f32));
            self.insert(*name, Raster::F32(cells));
        }
    }

    /// A vector from its three channels; cells that are not finite have no value. `None` without any of them.
    fn vector(&self, names: &[&str]) -> Result<Option<Image<Maybe<DVec3>>>, Fault> {
        let parts = [self.reals(names[0])?, self.reals(names[1])?, self.reals(names[2])?];
        let [Some(x), Some(y), Some(z)] = parts else {
            return match (parts.iter().position(Option::is_some), parts.iter().position(Option::is_none)) {
                (Some(_), Some(absent)) => {
                    Err(Fault::new(channel(names[absent]), "absent", format!("all of {}", names.join(", "))))
                }
                _ => Ok(None),
            };
        };
        let cells = x.cells().iter().zip(y.cells()).zip(z.cells()).map(|((&x, &y), &z)| {
            let vector = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
            Maybe::from(vector.is_finite().then_some(vector))
        });
        Ok(Some(Image::from_cells(self.width, self.height, cells.collect())))
    }
}

/// The face of every cell, if there is a channel of faces.
fn faces(map: &ExrMap) -> Result<Option<Image<Maybe<FaceId>>>, Fault> {
    match map.channels.get(FACE) {
        None => Ok(None),
        Some(Raster::U32(image)) => {
            let cell = |index: u32| Some(FaceId(index)).filter(|face| !face.is_nothing()).into();
            Ok(Some(convert(image, cell)))
        }
        Some(Raster::F32(_)) => Err(Fault::new(channel(FACE), "of type F32 or F16", "U32")),
    }
}

/// Writes the quantities that the maps of one sensor have, in the channels that `docs/formats/files.md` lists.
///
/// The file is replaced as a whole. The same maps give the same bytes on any machine.
///
/// # Errors
/// Maps without a quantity, attributes that are not Latin-1, or an error of the file system, with the path.
pub fn write_exr_map(
    path: impl AsRef<Path>,
    map: &SensorMap,
    attributes: &Attributes,
) -> Result<(), FileError> {
    write_exr(path, &ExrMap::from_sensor_map(map, attributes))
}

/// Reads maps that [`write_exr_map`], or another program under the same channel names, wrote.
///
/// The values are those of the file, widened from `f32`.
///
/// # Errors
/// As [`read_exr`] and [`ExrMap::to_sensor_map`].
pub fn read_exr_map(
    path: impl AsRef<Path>,
    sensor: SensorId,
    limits: &Limits,
) -> Result<SensorMap, FileError> {
    let path = path.as_ref();
    read_exr(path, limits)?.to_sensor_map(sensor, path)
}
