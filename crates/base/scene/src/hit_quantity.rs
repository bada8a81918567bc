//! The values of a hit and their channels in files: one table, which files, packs, recordings, comparisons and probes
//! follow.

use glam::DVec3;

use crate::{FaceId, Hit, Image, Maybe, SensorMap};

/// A value of a hit that is a number or a vector. (The face is an index and has channels of its own kind.)
///
/// ```
/// use raypencil_scene::HitQuantity;
///
/// assert_eq!(HitQuantity::Point.channels(), ["P.X", "P.Y", "P.Z"]);
/// // A length is +Inf in files where nothing is hit; a cosine is NaN there.
/// assert!(HitQuantity::Range.is_length() && !HitQuantity::CosIncidence.is_length());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum HitQuantity {
    /// [`Hit::range`](crate::Hit::range).
    Range,
    /// [`Hit::depth`](crate::Hit::depth).
    Depth,
    /// [`Hit::point`](crate::Hit::point).
    Point,
    /// [`Hit::normal`](crate::Hit::normal).
    Normal,
    /// [`Hit::cos_incidence`](crate::Hit::cos_incidence).
    CosIncidence,
}

/// The value of one quantity of one hit.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::HitValue;
///
/// assert_eq!(HitValue::Scalar(2.5).components(), [2.5]);
/// assert_eq!(HitValue::Vector(DVec3::X).components(), [1.0, 0.0, 0.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HitValue {
    /// A number.
    Scalar(f64),
    /// A vector.
    Vector(DVec3),
}

impl HitValue {
    /// The number, or the three components of the vector.
    #[inline]
    pub fn components(&self) -> &[f64] {
        match self {
            Self::Scalar(number) => std::slice::from_ref(number),
            Self::Vector(vector) => AsRef::<[f64; 3]>::as_ref(vector),
        }
    }

    /// The number; `None` if it is a vector.
    pub fn scalar(self) -> Option<f64> {
        match self {
            Self::Scalar(number) => Some(number),
            Self::Vector(_) => None,
        }
    }

    /// The vector; `None` if it is a number.
    pub fn vector(self) -> Option<DVec3> {
        match self {
            Self::Scalar(_) => None,
            Self::Vector(vector) => Some(vector),
        }
    }
}

/// The raster of one quantity of a sensor's maps.
#[derive(Debug, Clone, Copy)]
pub enum HitRaster<'a> {
    /// One number for each cell.
    Scalar(&'a Image<Maybe<f64>>),
    /// One vector for each cell.
    Vector(&'a Image<Maybe<DVec3>>),
}

impl HitRaster<'_> {
    /// The value of cell (i, j); `None` where nothing is hit.
    #[inline]
    pub fn at(&self, i: u32, j: u32) -> Option<HitValue> {
        match self {
            Self::Scalar(image) => image.at(i, j).get().map(HitValue::Scalar),
            Self::Vector(image) => image.at(i, j).get().map(HitValue::Vector),
        }
    }
}

/// The raster of one quantity, for replacing it.
#[derive(Debug)]
pub enum HitRasterMut<'a> {
    /// One number for each cell.
    Scalar(&'a mut Option<Image<Maybe<f64>>>),
    /// One vector for each cell.
    Vector(&'a mut Option<Image<Maybe<DVec3>>>),
}

impl HitQuantity {
    /// All of them, in the order of files.
    pub const ALL: [Self; 5] = [Self::Range, Self::Depth, Self::Point, Self::Normal, Self::CosIncidence];

    /// How many there are.
    pub const COUNT: usize = Self::ALL.len();

    /// Names of the channels in files: one of a number, three of a vector.
    #[inline]
    pub const fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Range => &["range.T"],
            Self::Depth => &["depth.Z"],
            Self::Point => &["P.X", "P.Y", "P.Z"],
            Self::Normal => &["N.X", "N.Y", "N.Z"],
            Self::CosIncidence => &["incidence.V"],
        }
    }

    /// Unit in files: `m`, or `1` for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Range | Self::Depth | Self::Point => "m",
            Self::Normal | Self::CosIncidence => "1",
        }
    }

    /// Whether it is a length: never negative, and +Inf in files where nothing is hit.
    pub fn is_length(self) -> bool {
        matches!(self, Self::Range | Self::Depth)
    }

    /// Whether it is a vector.
    #[inline]
    pub fn is_vector(self) -> bool {
        self.channels().len() == 3
    }

    /// Whether it belongs to the point that is hit. Two faces that meet there share it; what belongs to the face, as
    /// its normal, they do not.
    #[inline]
    pub fn is_of_point(self) -> bool {
        match self {
            Self::Range | Self::Depth | Self::Point => true,
            Self::Normal | Self::CosIncidence => false,
        }
    }
}

impl Hit {
    /// The value of a quantity.
    pub fn value(&self, quantity: HitQuantity) -> HitValue {
        match quantity {
            HitQuantity::Range => HitValue::Scalar(self.range),
            HitQuantity::Depth => HitValue::Scalar(self.depth),
            HitQuantity::Point => HitValue::Vector(self.point),
            HitQuantity::Normal => HitValue::Vector(self.normal),
            HitQuantity::CosIncidence => HitValue::Scalar(self.cos_incidence),
        }
    }
}

impl SensorMap {
    /// The hit of cell (i, j); `None` where nothing is hit, or where the maps lack a quantity.
    pub fn hit(&self, i: u32, j: u32) -> Option<Hit> {
        fn at<T: crate::Sample>(image: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
            image.as_ref()?.at(i, j).get()
        }
        let face: FaceId = at(&self.face, i, j)?;
        Some(Hit {
            face,
            range: at(&self.range, i, j)?,
            point: at(&self.point, i, j)?,
            normal: at(&self.normal, i, j)?,
            depth: at(&self.depth, i, j)?,
            cos_incidence: at(&self.cos_incidence, i, j)?,
        })
    }

    /// The raster of a quantity, if the maps have it.
    #[inline]
    pub fn raster(&self, quantity: HitQuantity) -> Option<HitRaster<'_>> {
        match quantity {
            HitQuantity::Range => self.range.as_ref().map(HitRaster::Scalar),
            HitQuantity::Depth => self.depth.as_ref().map(HitRaster::Scalar),
            HitQuantity::Point => self.point.as_ref().map(HitRaster::Vector),
            HitQuantity::Normal => self.normal.as_ref().map(HitRaster::Vector),
            HitQuantity::CosIncidence => self.cos_incidence.as_ref().map(HitRaster::Scalar),
        }
    }

    /// The raster of a quantity, to be replaced.
    pub fn raster_mut(&mut self, quantity: HitQuantity) -> HitRasterMut<'_> {
        match quantity {
            HitQuantity::Range => HitRasterMut::Scalar(&mut self.range),
            HitQuantity::Depth => HitRasterMut::Scalar(&mut self.depth),
            HitQuantity::Point => HitRasterMut::Vector(&mut self.point),
            HitQuantity::Normal => HitRasterMut::Vector(&mut self.normal),
            HitQuantity::CosIncidence => HitRasterMut::Scalar(&mut self.cos_incidence),
        }
    }
}
