//! What a range sensor reads along a ray.

/// What a range sensor reads along a ray, by the words of REP-117: the nearest hit, unless that is nearer than the
/// sensor's shortest range.
///
/// No sensor looks through what is too near: whatever stands behind it is not read either. So a ray is followed from its own
/// start, its nearest hit is found, and that one alone decides.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::{CastRay, Reading};
///
/// // A sensor that measures from 0.5 m on. A surface at exactly 0.5 m is measured.
/// let ray = CastRay { t_blind: 0.5, ..CastRay::new(DVec3::ZERO, DVec3::X) };
/// let read = |nearest: Option<f64>| Reading::of(nearest, |&t| ray.is_too_near(t));
/// assert_eq!(read(Some(0.5)), Reading::Hit(0.5));
/// assert_eq!(read(Some(0.25)), Reading::TooNear);
/// assert_eq!(read(None), Reading::Miss);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading<T> {
    /// The nearest hit.
    Hit(T),
    /// The nearest hit is nearer than the shortest range.
    TooNear,
    /// Nothing is hit.
    Miss,
}

impl<T> Reading<T> {
    /// The reading of a ray whose nearest hit is this.
    pub fn of(nearest: Option<T>, is_too_near: impl FnOnce(&T) -> bool) -> Self {
        match nearest {
            None => Self::Miss,
            Some(hit) if is_too_near(&hit) => Self::TooNear,
            Some(hit) => Self::Hit(hit),
        }
    }

    /// The hit; `None` for what is too near and for a miss.
    pub fn hit(&self) -> Option<&T> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::TooNear | Self::Miss => None,
        }
    }

    /// The same with another value for the hit.
    pub fn map<U>(self, of: impl FnOnce(T) -> U) -> Reading<U> {
        match self {
            Self::Hit(hit) => Reading::Hit(of(hit)),
            Self::TooNear => Reading::TooNear,
            Self::Miss => Reading::Miss,
        }
    }
}
