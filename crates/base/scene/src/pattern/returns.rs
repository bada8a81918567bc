//! Which returns of a beam with a width are told.

use crate::SceneError;
use crate::error::{check_count, check_range};

/// Which of a beam's returns a sensor tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// The nearest one.
    First,
    /// The one with the most light; of equals the nearest.
    Strongest,
    /// The farthest one.
    Last,
    /// The strongest ones, so many at most.
    UpTo(u64),
}

/// A beam's returns: the rays of its footprint that meet the mesh, in groups by their ranges.
///
/// The ranges of a footprint stand in ascending order. Two neighbours belong to one return, unless they are more than
/// [`separation_m`](Self::separation_m) apart.
///
/// (Velodyne VLP-16 User Manual 63-9243 Rev. D, "Laser Return Modes": strongest, last; Hesai PandarXT-16: first, strongest, last; Ouster firmware
/// manual, "Return Order": the two strongest)
///
/// ```
/// use raypencil_scene::pattern::{Keep, Returns};
///
/// assert!(Returns { keep: Keep::UpTo(2), separation_m: 1.0 }.validate("returns").is_ok());
/// let error = Returns { keep: Keep::UpTo(0), separation_m: 1.0 }.validate("returns").unwrap_err();
/// assert_eq!(error.to_string(), "returns.keep is 0: expected 1 to 16");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Returns {
    /// Which of them are told.
    pub keep: Keep,
    /// Gap between two neighbouring ranges that two returns have at least, metres.
    pub separation_m: f64,
}

impl Returns {
    /// Most returns of a beam that can be told.
    pub const MAX: u64 = 16;

    /// How many of a beam are told at most.
    pub fn most(&self) -> u64 {
        match self.keep {
            Keep::First | Keep::Strongest | Keep::Last => 1,
            Keep::UpTo(most) => most,
        }
    }

    /// Refuses a number of returns or a separation that no sensor has. `field` names them.
    ///
    /// # Errors
    /// Names the part that is wrong, its value and what is expected.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_count(|| format!("{field}.keep"), self.most(), 1, Self::MAX)?;
        check_range(|| format!("{field}.separation"), self.separation_m, 1e-6, 1e6, "m")
    }
}
