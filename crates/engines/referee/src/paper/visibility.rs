//! Explanations of wrong visibility: whether an approximation of the paper's §6 accounts for an answer against the
//! contract.
//!
//! "Removing stripe sections occluded by terrain" examines only faces that are turned away, only those with a vertex
//! not past the furthest extent of the upper beam, and only at the centre of a pixel. So it may call a hidden point
//! *seen* if every face that hides it is one that is not examined, or not met there. It may call a seen point
//! *hidden* if some face that is examined is met nearer than the point at the centre of its pixel.

use std::fmt;

use raypencil_scene::{FaceId, Pixel, SensorId};

use crate::hits::face::{ExactRay, Face};
use crate::hits::ruling::Tolerance;
use crate::hits::verdict::{Referee, bundle};
use crate::numbers::kleene::Kleene;
use crate::numbers::number::{Interval, Number};
use crate::paper::approximations::Approximations;
use crate::paper::raster::PaperRay;
use crate::rays::ray::{Aim, MountedSensor};
use crate::trees::bvh::RayBundle;
use crate::visibility::line_of_sight::ExactLineOfSight;

/// The paper's approximations that an answer about the camera's view was made with. (§6)
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VisibilityApproximations {
    /// Only faces turned away from the camera's *axis* occlude.
    pub facing: bool,
    /// Only faces with a vertex no deeper than this occlude, metres along the camera's axis.
    pub extent: Option<f64>,
    /// Faces turned away occlude at the centre of a pixel; away from the camera's position unless `facing` holds.
    pub place: bool,
}

/// The reason why an approximation calls a hidden point seen, or a seen point hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum VisibilityReason {
    /// The face is not turned away from the camera's axis.
    Facing,
    /// All vertices of the face are deeper than the furthest extent of the upper beam.
    Extent,
    /// At the centre of the pixel the face is not met nearer than the point though it hides the point, or the
    /// reverse; or the face shows the camera its front, and only backs are examined there.
    Place,
}

impl fmt::Display for VisibilityReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Facing => "it is not turned away from the camera's axis",
            Self::Extent => "all its vertices are deeper than the upper beam's furthest extent",
            Self::Place => "the centre of the pixel and the point itself give different answers, or the face is not a back",
        })
    }
}

/// A face that hides a point, or does not, against the contract, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExplainedVisibility {
    /// The face.
    pub face: FaceId,
    /// All reasons that hold; at least one.
    pub reasons: Vec<VisibilityReason>,
}

impl Referee<'_> {
    /// Explains a renderer's answer on whether the camera sees the point where pencil (i, j) meets the plane of
    /// `face`, by the approximations it was made with; `None` if they do not explain it.
    #[expect(clippy::too_many_arguments, reason = "a pencil, an answer, its making and a tolerance")]
    pub fn explain_visibility(
        &self,
        beam: usize,
        i: u32,
        j: u32,
        face: FaceId,
        visible: bool,
        with: VisibilityApproximations,
        tolerance: Tolerance,
    ) -> Option<Vec<ExplainedVisibility>> {
        let sensor = MountedSensor::of(self.scene, SensorId::Beam(beam))?;
        let (columns, rows) = sensor.size();
        let mesh = self.scene.mesh();
        if i >= columns || j >= rows || face.0 as usize >= mesh.faces().len() {
            return None;
        }
        let face = Face::of(mesh, face);
        let ray = ExactRay::new(&sensor, Aim { i, j, dx: 0.0, dy: 0.0 });
        let line = ExactLineOfSight::new(&ray, &face, self.scene.camera());
        // §6 concerns only points that a face hides, or could hide.
        let pixel = line.pixel().filter(|_| line.is_front_seen())?;
        let camera = MountedSensor::camera(*self.scene.camera());
        let section = Section6::new(&camera, with, pixel, line.centre_to_point().length(), tolerance);
        let occluders = self.occluders(&line);
        let explained: Vec<ExplainedVisibility> = match (visible, occluders.is_empty()) {
            (true, false) => occluders
                .iter()
                .map(|other| ExplainedVisibility { face: other.id, reasons: section.overlooks(other) })
                .collect(),
            (false, true) if with.place => {
                let mut found: Vec<ExplainedVisibility> = Vec::new();
                self.bvh.visit(&section.bundle_at_centre(&camera, pixel), |other| {
                    if section.hides(other).may_hold {
                        found.push(ExplainedVisibility {
                            face: other.id,
                            reasons: vec![VisibilityReason::Place],
                        });
                    }
                    section.distance * 2.0
                });
                found.sort_by_key(|one| one.face);
                found
            }
            _ => return None,
        };
        let all = !explained.is_empty() && explained.iter().all(|one| !one.reasons.is_empty());
        all.then_some(explained)
    }
}

/// The tests of §6, for one point.
struct Section6<'a> {
    with: VisibilityApproximations,
    /// The ray through the centre of the pixel.
    centre: PaperRay<'a>,
    /// Distance of the point from the projection centre, metres.
    distance: f64,
    /// Error of a point's position, metres.
    off: f64,
}

impl<'a> Section6<'a> {
    fn new(
        camera: &'a MountedSensor,
        with: VisibilityApproximations,
        pixel: Pixel,
        distance: f64,
        tolerance: Tolerance,
    ) -> Self {
        let aim = Aim { i: pixel.i, j: pixel.j, dx: 0.0, dy: 0.0 };
        let off = tolerance.depth + tolerance.position;
        // The pixel's ray is displaced by rounding only; points near the image plane have the error `off`.
        let tolerance = Tolerance { lateral: 1e-9, depth: off, position: off, ..tolerance };
        let centre = PaperRay::new(camera, aim, Approximations::default(), tolerance);
        Self { with, centre, distance, off }
    }

    /// The reasons for which a face that hides the point is not found.
    fn overlooks(&self, face: &Face) -> Vec<VisibilityReason> {
        let mut reasons = Vec::new();
        if self.with.facing && self.is_turned_away(face).may_fail {
            reasons.push(VisibilityReason::Facing);
        }
        if self.is_within_extent(face).may_fail {
            reasons.push(VisibilityReason::Extent);
        }
        let is_asked_at_centre = self.is_turned_away(face) & self.is_nearer_at_centre(face);
        if self.with.place && is_asked_at_centre.may_fail {
            reasons.push(VisibilityReason::Place);
        }
        reasons
    }

    /// Whether a face is found to hide the point at the centre of its pixel.
    fn hides(&self, face: &Face) -> Kleene {
        self.is_turned_away(face) & self.is_within_extent(face) & self.is_nearer_at_centre(face)
    }

    /// Whether a face is turned away from the axis, or without `facing` from the camera.
    fn is_turned_away(&self, face: &Face) -> Kleene {
        let [a, b, c] = face.corners.map(|corner| self.centre.in_sensor_frame(corner));
        let normal = b.sub(&a).cross(&c.sub(&a));
        if self.with.facing { Kleene::positive(normal.0[2]) } else { Kleene::positive(normal.dot(&a)) }
    }

    /// Whether some vertex is no deeper than the extent.
    fn is_within_extent(&self, face: &Face) -> Kleene {
        let Some(extent) = self.with.extent else { return Kleene::TRUE };
        let extent = Interval::of(extent).wider(self.off);
        Kleene::any(
            face.corners
                .map(|corner| Kleene::not_negative(extent.sub(&self.centre.in_sensor_frame(corner).0[2]))),
        )
    }

    /// Whether the ray through the pixel's centre meets a face, from either side, nearer than the point.
    fn is_nearer_at_centre(&self, face: &Face) -> Kleene {
        self.centre.meets_nearer_than(face, Interval::of(self.distance).wider(self.off))
    }

    /// The ray bundle through the pixel's centre.
    fn bundle_at_centre(&self, camera: &MountedSensor, pixel: Pixel) -> RayBundle {
        let mut around = bundle(camera, Aim { i: pixel.i, j: pixel.j, dx: 0.0, dy: 0.0 }, 1e-6);
        around.max_range = self.distance * 2.0;
        around.start_radius = self.off;
        around
    }
}
