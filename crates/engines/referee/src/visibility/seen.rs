//! Visibility: whether the camera sees a pencil's hit, and in which pixel. Exactly.

use raypencil_scene::{FaceId, Pixel, SensorId};

use crate::hits::face::{ExactRay, Face};
use crate::hits::verdict::Referee;
use crate::rays::displacement::Displacement;
use crate::rays::ray::{Aim, MountedSensor};
use crate::visibility::line_of_sight::ExactLineOfSight;

/// The contract's answer about the camera's view of a pencil's hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Visibility {
    /// Whether the camera sees the point.
    pub visible: bool,
    /// The pixel in which the point lands, hidden or not.
    pub pixel: Option<Pixel>,
    /// A face that meets the segment between the point and the image plane.
    pub hidden_by: Option<FaceId>,
}

impl Referee<'_> {
    /// The camera's view of the hit of pencil (i, j), displaced by `by`; `None` if there is no such pencil, or it
    /// does not hit.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::{Displacement, Referee};
    /// use raypencil_scene::Pixel;
    ///
    /// let scene = wall_scene();
    /// // The pencil hits the wall at (-1, 0, 2). No face is between it and the camera at the origin.
    /// let view = Referee::new(&scene).visibility(0, 0, 0, Displacement::ZERO).unwrap();
    /// assert!(view.visible && view.hidden_by.is_none());
    /// // f x / z / p = -4 pixels from the principal point (4.5, 4.5): (0.5, 4.5).
    /// assert_eq!(view.pixel, Some(Pixel { i: 0, j: 4 }));
    /// ```
    pub fn visibility(&self, beam: usize, i: u32, j: u32, by: Displacement) -> Option<Visibility> {
        let sensor = MountedSensor::of(self.scene, SensorId::Beam(beam))?;
        let (columns, rows) = sensor.size();
        if i >= columns || j >= rows || !by.dx.is_finite() || !by.dy.is_finite() {
            return None;
        }
        let aim = Aim { i, j, dx: by.dx, dy: by.dy };
        let nearest = self.nearest(&sensor, aim);
        Some(self.visibility_of(&sensor, aim, nearest.first()?))
    }

    /// The camera's view of the point where an aim meets `face`.
    pub(crate) fn visibility_of(&self, sensor: &MountedSensor, aim: Aim, face: &Face) -> Visibility {
        let ray = ExactRay::new(sensor, aim);
        let line = ExactLineOfSight::new(&ray, face, self.scene.camera());
        let pixel = line.pixel();
        let could_be_seen = pixel.is_some() && line.is_front_seen();
        let hidden_by = if could_be_seen { self.occluder(&line) } else { None };
        Visibility { visible: could_be_seen && hidden_by.is_none(), pixel, hidden_by }
    }

    /// One face that hides the end of a line of sight: the lowest in the first leaf that has any.
    fn occluder(&self, line: &ExactLineOfSight<'_>) -> Option<FaceId> {
        let bundle = line.bundle();
        let mut found: Option<FaceId> = None;
        self.bvh.visit(&bundle, |face| {
            if found.is_none() && line.is_hidden_by(face) {
                found = Some(face.id);
            }
            // One occluder suffices.
            if found.is_some() { f64::NEG_INFINITY } else { bundle.max_range }
        });
        found
    }

    /// Every face that hides the end of a line of sight, in ascending order.
    pub(crate) fn occluders(&self, line: &ExactLineOfSight<'_>) -> Vec<Face> {
        let bundle = line.bundle();
        let mut found: Vec<Face> = Vec::new();
        self.bvh.visit(&bundle, |face| {
            if line.is_hidden_by(face) {
                found.push(*face);
            }
            bundle.max_range
        });
        found.sort_by_key(|face| face.id);
        found
    }
}
