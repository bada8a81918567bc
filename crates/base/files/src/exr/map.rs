//! Channels of one OpenEXR file by name, with its text attributes.

use std::collections::{BTreeMap, BTreeSet};

use raypencil_scene::{Image, Maybe};

/// One fixed quiet NaN for cells without a value, so that files have the same bytes everywhere.
pub(super) const NO_VALUE: f32 = f32::from_bits(0x7fc0_0000);

/// Cells of one channel.
#[derive(Debug, Clone)]
pub enum Raster {
    /// Real numbers; those of a half-precision channel are widened exactly.
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

    /// The real numbers; `None` for a channel of whole numbers.
    pub fn as_f32(&self) -> Option<&Image<f32>> {
        match self {
            Self::F32(image) => Some(image),
            Self::U32(_) => None,
        }
    }

    /// The whole numbers; `None` for a channel of real numbers.
    pub fn as_u32(&self) -> Option<&Image<u32>> {
        match self {
            Self::U32(image) => Some(image),
            Self::F32(_) => None,
        }
    }
}

/// Channels of one OpenEXR file by name, with its text attributes.
///
/// ```
/// use raypencil_files::{ExrMap, Limits, Raster, read_exr, write_exr};
/// use raypencil_scene::Image;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("camera.exr");
/// let mut map = ExrMap::new(2, 1);
/// map.insert("range.T", Raster::F32(Image::from_cells(2, 1, vec![2.5, f32::INFINITY])));
/// map.attributes.insert("unit".into(), "metre".into());
/// write_exr(&path, &map)?;
///
/// // Single precision is stored as it is: 2.5 comes back.
/// let back = read_exr(&path, &Limits::default())?;
/// assert_eq!(back.channels["range.T"].as_f32().map(|image| image.at(0, 0)), Some(2.5));
/// assert_eq!(back.attributes["unit"], "metre");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct ExrMap {
    /// Columns of every channel.
    pub width: u32,
    /// Rows of every channel.
    pub height: u32,
    /// Channels by name, as `range.T`.
    pub channels: BTreeMap<String, Raster>,
    /// Text attributes of the file.
    pub attributes: BTreeMap<String, String>,
    /// Names of the channels that were read from half precision. They are written in single precision.
    pub halves: BTreeSet<String>,
}

impl ExrMap {
    /// A map of `width` columns and `height` rows without channels.
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
    /// If the raster has another size than the map.
    pub fn insert(&mut self, name: impl Into<String>, raster: Raster) {
        assert_eq!(raster.size(), (self.width, self.height), "size of a channel");
        self.channels.insert(name.into(), raster);
    }

    /// Adds a scalar channel if there is one; cells without a value get `nothing`.
    pub(super) fn insert_scalar(&mut self, name: &str, image: Option<&Image<Maybe<f64>>>, nothing: f32) {
        if let Some(image) = image {
            let cells = convert(image, |cell| cell.get().map_or(nothing, |value| value as f32));
            self.insert(name, Raster::F32(cells));
        }
    }
}

/// Applies `cell` to every cell of an image.
pub(crate) fn convert<A: Copy, B: Copy>(image: &Image<A>, cell: impl Fn(A) -> B) -> Image<B> {
    let cells = image.cells().iter().map(|&value| cell(value)).collect();
    Image::from_cells(image.width(), image.height(), cells)
}

/// Place of a channel in messages.
pub(super) fn channel(name: &str) -> String {
    format!("channel {name:?}")
}
