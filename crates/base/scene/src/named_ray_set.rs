//! Ray sets with names.

use glam::DVec3;

use crate::pattern::{EchoLight, Mounting, PatternRays, Returns};
use crate::{CastRay, Pose, RaySet, SceneError, Sides};

/// Greatest length of a ray set's name.
const MAX_NAME_CHARS: usize = 64;

/// A ray set with a name and with the shape of its pattern.
///
/// ```
/// use raypencil_scene::pattern::Grid;
/// use raypencil_scene::{NamedRaySet, Sides};
///
/// let rays = Grid::preset("l515").expect("a preset").rays("rays")?;
/// let set = NamedRaySet::new("front", rays.clone(), Sides::Both)?;
/// assert_eq!(set.shape, [768, 1024]);
/// let error = NamedRaySet::new("Front", rays, Sides::Both).unwrap_err();
/// assert_eq!(error.to_string(), "name is \"Front\": expected 1 to 64 of the characters a to z, 0 to 9 and -");
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct NamedRaySet {
    /// The name: 1 to 64 of the characters a to z, 0 to 9 and `-`.
    pub name: String,
    /// Dimensions; their product is the number of rays. The last dimension runs fastest.
    pub shape: Vec<u64>,
    /// The rays, in the mesh's frame, and the sides that they hit.
    pub set: RaySet,
    /// Time at which each ray is fired, seconds, if there are times.
    pub times: Option<Vec<f64>>,
    /// Shares of a beam's power along the last dimension, if rays are parts of beams.
    pub weights: Option<Vec<f64>>,
    /// Which returns of a beam are told, if rays are parts of beams; `None`: rays stand for themselves.
    pub returns: Option<Returns>,
    /// Elevations of the channels of a spinning head along the second dimension, degrees.
    pub elevations_deg: Option<Vec<f64>>,
    /// Where the pattern's own frame stands in the mesh's.
    pub mounting: Mounting,
    /// What surfaces and air leave of the light of an echo.
    pub echo: EchoLight,
}

impl NamedRaySet {
    /// A set of the rays of a pattern, which stand in the mesh's frame. All light comes back from its echoes.
    ///
    /// # Errors
    /// Names the first ray that is wrong, or the name if it is none.
    pub fn new(name: &str, pattern: PatternRays, sides: Sides) -> Result<Self, SceneError> {
        Self::check_name(name)?;
        let PatternRays { shape, rays, times, weights, returns, elevations_deg, mounting } = pattern;
        let set = RaySet::new(rays, sides)?;
        let (name, echo) = (name.to_string(), EchoLight::default());
        Ok(Self { name, shape, set, times, weights, returns, elevations_deg, mounting, echo })
    }

    /// Up direction of the pattern at its first pose, in the mesh's frame.
    pub fn up(&self) -> DVec3 {
        self.mounting.first().rotate(DVec3::Z)
    }

    /// The set moved with a frame that it is fixed to: origins are rotated and shifted by the pose, directions rotated.
    ///
    /// # Errors
    /// Names the first ray that is none any more, its origin beyond 1e30.
    pub fn placed(&self, pose: &Pose) -> Result<Self, SceneError> {
        let placed = |ray: &CastRay| CastRay {
            origin: pose.rotate(ray.origin) + pose.position,
            direction: pose.rotate(ray.direction),
            ..*ray
        };
        let set = RaySet::new(self.set.rays().iter().map(placed).collect(), self.set.sides())?;
        Ok(Self { set, mounting: self.mounting.moved_by(pose), ..self.clone() })
    }

    /// Refuses what is no name of a set.
    ///
    /// # Errors
    /// Tells the name and what is expected.
    pub fn check_name(name: &str) -> Result<(), SceneError> {
        let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        if !name.is_empty() && name.len() <= MAX_NAME_CHARS && name.chars().all(fits) {
            return Ok(());
        }
        let expected = "1 to 64 of the characters a to z, 0 to 9 and -";
        Err(SceneError::new("name", format!("{name:?}"), expected))
    }
}
