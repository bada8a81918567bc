//! The sets of spinning heads whose rays are made part by part.

use std::ops::Range;

use crate::pattern::{Cone, EchoLight, Mounting, PatternRays, Returns, Spinning, check_rays};
use crate::{NamedRaySet, SceneError, Sides};

/// The set of a spinning head before its rays are made: those of some firing sequences can be asked for, so that not all need be in memory.
///
/// ```
/// use raypencil_scene::pattern::{EchoLight, Mounting, Spinning};
/// use raypencil_scene::{HeadSweep, NamedRaySet, Sides};
///
/// let head = Spinning::preset("vlp-16").expect("a preset");
/// let whole = NamedRaySet::new("turn", head.rays("rays")?, Sides::Both)?;
/// let sweep = HeadSweep {
///     name: "turn".into(),
///     head,
///     cone: None,
///     mounting: Mounting::HERE,
///     start_s: None,
///     sides: Sides::Both,
///     echo: EchoLight::default(),
/// };
/// sweep.check("rays")?;
/// let part = sweep.part(100..102, "rays")?;
/// assert_eq!((part.set.rays(), part.shape.as_slice()), (&whole.set.rays()[1600..1632], &[2, 16][..]));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HeadSweep {
    /// The name: as that of a [`NamedRaySet`].
    pub name: String,
    /// The head.
    pub head: Spinning,
    /// The footprint in place of each ray, and which of its returns are told.
    pub cone: Option<(Cone, Option<Returns>)>,
    /// Where the pattern's own frame stands in the mesh's.
    pub mounting: Mounting,
    /// Time of the first firing sequence, seconds; `None`: 0.
    pub start_s: Option<f64>,
    /// The sides of faces that are hit.
    pub sides: Sides,
    /// What surfaces and air leave of the light of an echo.
    pub echo: EchoLight,
}

impl HeadSweep {
    /// Rays of a firing sequence.
    fn rays_of_sequence(&self) -> u64 {
        let of_beam = self.cone.as_ref().map_or(1, |(cone, _)| cone.count());
        of_beam.saturating_mul(self.head.channels.len() as u64)
    }

    /// Number of all rays.
    pub fn rays(&self) -> u64 {
        self.head.steps.saturating_mul(self.rays_of_sequence())
    }

    /// The set of some firing sequences: bit for bit the part that they are of the set of all. `field` names the set in messages.
    ///
    /// # Errors
    /// Names what is wrong.
    pub fn part(&self, sequences: Range<u64>, field: &str) -> Result<NamedRaySet, SceneError> {
        let of_head = self.head.rays_of(sequences, &format!("{field}.spinning"))?;
        let rays = match &self.cone {
            None => of_head,
            Some((cone, returns)) => {
                let spread = cone.spread(&of_head, &format!("{field}.cone"))?;
                PatternRays { returns: *returns, ..spread }
            }
        };
        let rays = match self.start_s {
            Some(start) => rays.starting_at(start),
            None => rays,
        };
        let set = NamedRaySet::new(&self.name, self.mounting.place(rays, field)?, self.sides)?;
        Ok(NamedRaySet { echo: self.echo, ..set })
    }

    /// Refuses what some part would be refused for: before the first one is made.
    ///
    /// # Errors
    /// As the set of all rays.
    pub fn check(&self, field: &str) -> Result<(), SceneError> {
        NamedRaySet::check_name(&self.name)?;
        self.head.validate(&format!("{field}.spinning"))?;
        let each = self.rays_of_sequence();
        if let Some((cone, _)) = &self.cone {
            cone.validate(&format!("{field}.cone"))?;
        }
        check_rays(field, &[self.head.steps, each])?;
        let Mounting::Moving(poses) = &self.mounting else { return Ok(()) };
        let [first, last] = poses.span_s();
        let of_beam = each / self.head.channels.len() as u64;
        let start = self.start_s.unwrap_or(0.0);
        for step in 0..self.head.steps {
            for (channel, place) in self.head.channels.iter().zip(0..) {
                let time = step as f64 * self.head.period_s + channel.firing_s + start;
                if !(first..=last).contains(&time) {
                    let ray = step * each + place * of_beam;
                    return Err(Mounting::no_pose(field, ray, time, [first, last]));
                }
            }
        }
        Ok(())
    }
}
