//! The maps of one sensor as named channels, and those as OpenEXR. Conventions: `docs/formats/files.md`.

pub(crate) mod header;
pub(crate) mod light;
pub(crate) mod read;
pub(crate) mod write;

use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::error::{Fault, FileError};
use raypencil_scene::{FaceId, Image, Maybe, Sample, SensorId, SensorMap};

use crate::exr::read::read_exr;
pub use crate::exr::write::write_exr;
pub use crate::limits::Limits;

/// The channel values of a cell without a hit.
pub(crate) const NO_FACE: u32 = u32::MAX;

/// One fixed quiet NaN, so that files are the same bytes everywhere.
pub(crate) const NO_VALUE: f32 = f32::from_bits(0x7fc0_0000);

const RANGE: &str = "range.T";

const DEPTH: &str = "depth.Z";

const FACE: &str = "face.I";

const POINT: [&str; 3] = ["P.X", "P.Y", "P.Z"];

const NORMAL: [&str; 3] = ["N.X", "N.Y", "N.Z"];

const INCIDENCE: &str = "incidence.V";

/// The cells of one channel.
#[derive(Debug, Clone)]
pub enum Raster {
    /// Real numbers. Half-precision channels are widened to this, exactly.
    F32(Image<f32>),
    /// Whole numbers.
    U32(Image<u32>),
}

impl Raster {
    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::F32(image) => (image.width(), image.height()),
            Self::U32(image) => (image.width(), image.height()),
        }
    }

    /// The real numbers, if this is a channel of them.
    pub fn as_f32(&self) -> Option<&Image<f32>> {
        match self {
            Self::F32(image) => Some(image),
            Self::U32(_) => None,
        }
    }

    /// The whole numbers, if this is a channel of them.
    pub fn as_u32(&self) -> Option<&Image<u32>> {
        match self {
            Self::U32(image) => Some(image),
            Self::F32(_) => None,
        }
    }
}

/// The channels of one OpenEXR file, by name, and its text attributes.
#[derive(Debug, Clone)]
pub struct ExrMap {
    /// Columns of every channel.
    pub width: u32,
    /// Rows of every channel.
    pub height: u32,
    /// The channels.
    pub channels: BTreeMap<String, Raster>,
    /// The attributes that are texts.
    pub attributes: BTreeMap<String, String>,
    /// Of the channels, those that were read from half precision. Such a channel is written in single.
    pub halves: BTreeSet<String>,
}

/// What a written file says of itself, beside what follows from its channels.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Attribute `renderer`: who computed the maps.
    pub renderer: String,
    /// Attribute `sceneSha256`: of which scene.
    pub scene_sha256: String,
    /// Any further attributes; a name given here replaces a standard one.
    pub extra: Vec<(String, String)>,
}

impl ExrMap {
    /// No channels yet.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            channels: BTreeMap::new(),
            attributes: BTreeMap::new(),
            halves: BTreeSet::new(),
        }
    }

    /// Adds or replaces a channel.
    ///
    /// # Panics
    /// If the raster has another size.
    pub fn insert(&mut self, name: impl Into<String>, raster: Raster) {
        assert_eq!(raster.size(), (self.width, self.height), "size of a channel");
        self.channels.insert(name.into(), raster);
    }

    /// The quantities that `map` has, rounded to `f32`.
    pub fn from_sensor_map(map: &SensorMap, attributes: &Attributes) -> Self {
        let mut exr = Self::new(map.width, map.height);
        exr.scalar(RANGE, map.range.as_ref(), f32::INFINITY);
        exr.scalar(DEPTH, map.depth.as_ref(), f32::INFINITY);
        exr.vector(POINT, map.point.as_ref());
        exr.vector(NORMAL, map.normal.as_ref());
        exr.scalar(INCIDENCE, map.cos_incidence.as_ref(), NO_VALUE);
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

    /// The maps of `sensor`: each of the channels of `docs/formats/files.md` that is there, other channels left out.
    /// What is not finite (or the face 4294967295) is a cell without a hit.
    ///
    /// # Errors
    /// Names the channel that is of the wrong type, or absent where its two siblings are there.
    pub fn to_sensor_map(&self, sensor: SensorId, file: &Path) -> Result<SensorMap, FileError> {
        let unfit = |fault: Fault| FileError::Exr(fault.in_file(file));
        Ok(SensorMap {
            sensor,
            width: self.width,
            height: self.height,
            range: self.scalar_of(RANGE).map_err(unfit)?,
            depth: self.scalar_of(DEPTH).map_err(unfit)?,
            face: self.faces().map_err(unfit)?,
            point: self.vector_of(POINT).map_err(unfit)?,
            normal: self.vector_of(NORMAL).map_err(unfit)?,
            cos_incidence: self.scalar_of(INCIDENCE).map_err(unfit)?,
        })
    }

    fn scalar(&mut self, name: &str, image: Option<&Image<Maybe<f64>>>, nothing: f32) {
        if let Some(image) = image {
            let cells = convert(image, |cell| cell.get().map_or(nothing, |value| value as f32));
            self.insert(name, Raster::F32(cells));
        }
    }

    fn vector(&mut self, names: [&str; 3], image: Option<&Image<Maybe<DVec3>>>) {
        let Some(image) = image else { return };
        for (axis, name) in names.into_iter().enumerate() {
            let cells = convert(image, |cell| cell.get().map_or(NO_VALUE, |vector| vector[axis] as f32));
            self.insert(name, Raster::F32(cells));
        }
    }

    fn reals(&self, name: &str) -> Result<Option<&Image<f32>>, Fault> {
        match self.channels.get(name) {
            None => Ok(None),
            Some(Raster::F32(image)) => Ok(Some(image)),
            Some(Raster::U32(_)) => Err(Fault::new(channel(name), "of type U32", "F32 or F16")),
        }
    }

    fn scalar_of(&self, name: &str) -> Result<Option<Image<Maybe<f64>>>, Fault> {
        let cell = |value: f32| Maybe::from(value.is_finite().then_some(f64::from(value)));
        Ok(self.reals(name)?.map(|image| convert(image, cell)))
    }

    fn vector_of(&self, names: [&str; 3]) -> Result<Option<Image<Maybe<DVec3>>>, Fault> {
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

    fn faces(&self) -> Result<Option<Image<Maybe<FaceId>>>, Fault> {
        match self.channels.get(FACE) {
            None => Ok(None),
            Some(Raster::U32(image)) => {
                let cell = |index: u32| Some(FaceId(index)).filter(|face| !face.is_nothing()).into();
                Ok(Some(convert(image, cell)))
            }
            Some(Raster::F32(_)) => Err(Fault::new(channel(FACE), "of type F32 or F16", "U32")),
        }
    }
}

/// Writes the maps of one sensor: the quantities that it has, as `docs/formats/files.md` lists them. The file is
/// replaced as a whole, and is the same bytes for the same maps on any machine.
///
/// # Errors
/// What the file system says, with the path.
pub fn write_exr_map(
    path: impl AsRef<Path>,
    map: &SensorMap,
    attributes: &Attributes,
) -> Result<(), FileError> {
    write_exr(path, &ExrMap::from_sensor_map(map, attributes))
}

/// Reads back what [`write_exr_map`] wrote, or what another program wrote under the same channel names:
/// values as they stand in the file, widened from `f32`.
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

pub(crate) fn convert<A: Copy, B: Copy>(image: &Image<A>, cell: impl Fn(A) -> B) -> Image<B> {
    let cells = image.cells().iter().map(|&value| cell(value)).collect();
    Image::from_cells(image.width(), image.height(), cells)
}

/// The place of a channel in messages.
pub(crate) fn channel(name: &str) -> String {
    format!("channel {name:?}")
}
