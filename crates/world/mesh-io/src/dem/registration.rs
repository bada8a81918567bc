//! Registration of pixels: whether a pixel is an area or a point. (GeoTIFF 1.1, GTRasterTypeGeoKey)

/// Meaning of a pixel in an elevation model. Posts are at the middles of pixels in both meanings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Registration {
    /// An area: the tie point is at a pixel's outer corner, so that posts lie half a pixel further in.
    Area,
    /// An area, since the file states nothing.
    AreaByDefault,
    /// A point: the tie point is at a post.
    Point,
}

impl Registration {
    /// Whether the file states the registration.
    pub fn is_stated(self) -> bool {
        self != Self::AreaByDefault
    }

    /// Name of the registration: `area` or `point`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Area | Self::AreaByDefault => "area",
            Self::Point => "point",
        }
    }
}
