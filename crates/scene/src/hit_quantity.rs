//! The values of a hit and their channels in files: one table, which files, packs and recordings follow.

use glam::DVec3;

use crate::{Image, Maybe, SensorMap};

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

/// The raster of one quantity of a sensor's maps.
#[derive(Debug, Clone, Copy)]
pub enum HitRaster<'a> {
    /// One number for each cell.
    Scalar(&'a Image<Maybe<f64>>),
    /// One vector for each cell.
    Vector(&'a Image<Maybe<DVec3>>),
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

    /// Names of the channels in files: one of a number, three of a vector.
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
}

impl SensorMap {
    /// The raster of a quantity, if the maps have it.
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
