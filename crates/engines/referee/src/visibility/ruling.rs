//! Rulings on visibility: whether an answer about the camera's view is right, or one that a correct renderer of
//! finite precision may give.
//!
//! A renderer's ray may be displaced by delta, and its point may be wrong by epsilon. Then it may give the right
//! answer of some ray displaced by at most delta, and it may take a face that passes within epsilon of the point to lie on either
//! side of it. To epsilon comes the error of the face's own plane, which is larger for a needle. Within that error of the camera
//! a face may be taken not to be in the way; where the line crosses the image plane, to be on either side of it. And an edge that passes the line of sight within the error of both may seem to be
//! [on its other side](crate::visibility::rounded_line).
//!
//! A face in the plane of the hit face contains the point, so it does not hide it. Rounding is no excuse for its shadow: the point
//! is off the plane by at most (10 kappa + 45) u S, however flatly it is seen, and a program can take all faces as near as
//! that to contain it.

use glam::DVec3;
use raypencil_scene::{FaceId, Pixel, SensorId};

use crate::hits::face::{ExactRay, Face};
use crate::hits::rounded_face::plane_error;
use crate::hits::ruling::{Ruling, Tolerance};
use crate::hits::verdict::Referee;
use crate::numbers::number::Interval;
use crate::numbers::vector::Vector;
use crate::rays::displacement::Displacement;
use crate::rays::ray::{Aim, MountedSensor};
use crate::trees::bvh::{InBox, RayBundle};
use crate::visibility::line_of_sight::ExactLineOfSight;
use crate::visibility::rounded_line::RoundedLine;
use crate::visibility::seen::Visibility;

/// The referee's ruling on one answer about the camera's view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibilityRuling {
    /// The ruling on whether the point is seen.
    pub visible: Ruling,
    /// The ruling on where it lands.
    pub pixel: Ruling,
}

/// The displacements that are tried, in units of the lateral tolerance.
const TRIED_DISPLACEMENTS: [[f64; 2]; 8] =
    [[-1.0, -1.0], [0.0, -1.0], [1.0, -1.0], [-1.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [0.0, 1.0], [1.0, 1.0]];

/// The farthest that an edge may seem displaced, as a share of the line of sight. A needle so thin that its edges slip farther is
/// not excused. CHOICE: it keeps the faces few that are asked for.
const MAX_SLIP: f64 = 1.0 / 64.0;

/// The least step past an edge, as a share of the line of sight: some dozen roundings of the `f64` in which that is tried.
const LEAST_STEP: f64 = 1.0 / (1_u64 << 46) as f64;

impl Referee<'_> {
    /// The ruling on a renderer's answer about the point where pencil (i, j), displaced by `by`, meets the plane of
    /// `face`; `None` if there is no such pencil or face.
    #[expect(clippy::too_many_arguments, reason = "a pencil, an answer and a tolerance")]
    pub fn rule_visibility(
        &self,
        beam: usize,
        i: u32,
        j: u32,
        by: Displacement,
        face: FaceId,
        visible: bool,
        pixel: Option<Pixel>,
        tolerance: Tolerance,
    ) -> Option<VisibilityRuling> {
        let sensor = MountedSensor::of(self.scene, SensorId::Beam(beam))?;
        let (columns, rows) = sensor.size();
        let mesh = self.scene.mesh();
        if i >= columns || j >= rows || face.0 as usize >= mesh.faces().len() {
            return None;
        }
        let face = Face::of(mesh, face);
        let aim = Aim { i, j, dx: by.dx, dy: by.dy };
        let exact = self.visibility_of(&sensor, aim, &face);
        if exact.visible == visible && exact.pixel == pixel {
            return Some(VisibilityRuling { visible: Ruling::Exact, pixel: Ruling::Exact });
        }
        let lateral = tolerance.lateral.clamp(0.0, 1.0);
        let beside: Vec<(Displacement, Visibility)> = TRIED_DISPLACEMENTS
            .iter()
            .map(|[x, y]| {
                let (dx, dy) = (x * lateral, y * lateral);
                let aim = Aim { dx: aim.dx + dx, dy: aim.dy + dy, ..aim };
                (Displacement { dx, dy }, self.visibility_of(&sensor, aim, &face))
            })
            .collect();
        let witness = |is_so: &dyn Fn(&Visibility) -> bool| {
            beside.iter().find(|(_, sight)| is_so(sight)).map(|(by, _)| Ruling::Rounding(*by))
        };

        let ray = ExactRay::new(&sensor, aim);
        let line = ExactLineOfSight::new(&ray, &face, self.scene.camera());
        let off = tolerance.depth + tolerance.position;
        let of_plane = |face: &Face| {
            let camera = self.scene.camera().scene_from_sensor.position;
            let size = camera.length() + line.centre_to_point().length() + face.longest_edge();
            plane_error(face, size, tolerance.unit_roundoff)
        };
        let may_pass = || {
            let from = line.centre_to_point();
            let direction = middle(&ray.fast().direction).normalize();
            let centre = self.scene.camera().scene_from_sensor.position;
            let rounded = RoundedLine {
                ends: [centre + from, centre],
                position: tolerance.position,
                hit: tolerance.depth * direction.cross(from.normalize()).length(),
                image_plane: self.scene.camera().sensor.focal_length / line.depth(),
                unit_roundoff: tolerance.unit_roundoff,
            };
            self.may_pass(&line, &rounded, &face, exact, visible, off, of_plane)
        };
        let of_visible = if exact.visible == visible {
            Ruling::Exact
        } else if let Some(witness) = witness(&|sight| sight.visible == visible) {
            witness
        } else if self.may_see(&line, &face, exact, visible, off, of_plane) || may_pass() {
            Ruling::Rounding(Displacement::ZERO)
        } else {
            Ruling::Wrong
        };
        let of_pixel = if exact.pixel == pixel {
            Ruling::Exact
        } else if let Some(witness) = witness(&|sight| sight.pixel == pixel) {
            witness
        } else if self.may_land(&line, pixel, off) {
            Ruling::Rounding(Displacement::ZERO)
        } else {
            Ruling::Wrong
        };
        Some(VisibilityRuling { visible: of_visible, pixel: of_pixel })
    }

    /// Whether a point with an error of `off` metres may be called seen, or hidden, against the exact answer. `of_plane` is the
    /// error of a face's plane, metres.
    fn may_see(
        &self,
        line: &ExactLineOfSight<'_>,
        face: &Face,
        exact: Visibility,
        visible: bool,
        off: f64,
        of_plane: impl Fn(&Face) -> f64,
    ) -> bool {
        let from_centre = line.centre_to_point();
        let centre = self.scene.camera().scene_from_sensor.position;
        let point = centre + from_centre;
        let may_hold_point = |of: &Face| distance_from_plane(of, point).abs() <= off + of_plane(of);
        // The camera's place is known without error: only the plane's is not.
        let may_hold_camera = |of: &Face| distance_from_plane(of, centre).abs() <= of_plane(of);
        // Where the line crosses the image plane a way begins that a program has only rounded: it is off as the point is, in
        // proportion to its distance, and as a face's plane is by rounding the sum of both.
        let share = self.scene.camera().sensor.focal_length / line.depth();
        let crossing = centre + from_centre * share;
        let off_at_crossing = off * share;
        let may_hold_crossing =
            |of: &Face| distance_from_plane(of, crossing).abs() <= off_at_crossing + of_plane(of);
        // Whether the hit face's front is seen: a program may take the point's position for the plane's.
        let side = distance_from_plane(face, centre);
        if side.abs() <= off + of_plane(face) {
            return true;
        }
        if visible {
            return exact.pixel.is_some()
                && side > 0.0
                && self.occluders(line).iter().all(|other| {
                    may_hold_point(other) || may_hold_camera(other) || may_hold_crossing(other)
                });
        }
        // A face that does not hide the point passes within rounding of it.
        let mut found = false;
        let bundle = RayBundle { start_radius: off, ..line.bundle() };
        self.bvh.visit(&bundle, |other| {
            // A face in the hit face's own plane never hides it: rounding does not excuse the shadow of a duplicate.
            found |= !other.is_in_plane_of(face)
                && (may_hold_point(other) && is_beside(other, point, off)
                    || may_hold_crossing(other) && is_beside(other, crossing, off_at_crossing));
            if found { f64::NEG_INFINITY } else { bundle.max_range }
        });
        found
    }

    /// Whether an edge of a face may seem to be on the other side of the line of sight, so that the point is called seen, or hidden,
    /// against the exact answer.
    #[expect(clippy::too_many_arguments, reason = "a line, exact and rounded, an answer and two tolerances")]
    fn may_pass(
        &self,
        line: &ExactLineOfSight<'_>,
        rounded: &RoundedLine,
        face: &Face,
        exact: Visibility,
        visible: bool,
        off: f64,
        of_plane: impl Fn(&Face) -> f64,
    ) -> bool {
        if exact.pixel.is_none() || !line.is_front_seen() {
            return false;
        }
        let bundle = line.bundle();
        let bundle = RayBundle { start_radius: bundle.max_range * MAX_SLIP, ..bundle };
        let mut near: Vec<Face> = Vec::new();
        self.bvh.visit(&bundle, |other| {
            let is_at_point = other.is_in_plane_of(face);
            if !is_at_point
                && rounded.uncertain_edge(other).is_some_and(|across| across.length() <= bundle.start_radius)
            {
                near.push(*other);
            }
            bundle.max_range
        });
        if !visible {
            return !near.is_empty();
        }
        // The line may be moved past the edge of any occluder, but must then be free. A line through an edge that two faces
        // share is never free: moved past the end of one, it meets the other.
        let [point, centre] = rounded.ends;
        let is_at_an_end = |other: &Face| {
            distance_from_plane(other, point).abs() <= off + of_plane(other)
                || distance_from_plane(other, centre).abs() <= of_plane(other)
        };
        let mut around: Vec<Face> = Vec::new();
        self.bvh.visit(&bundle, |other| {
            if other.id != face.id && !is_at_an_end(other) {
                around.push(*other);
            }
            bundle.max_range
        });
        let step = rounded.position.max(bundle.max_range * LEAST_STEP);
        let past = |across: DVec3| across + across.normalize_or_zero() * step;
        near.iter().filter_map(|other| rounded.uncertain_edge(other)).any(|across| {
            let moved = rounded.moved(past(across));
            !around.iter().any(|other| moved.meets(other))
        })
    }

    /// Whether a point with an error of `off` metres may be said to land in `pixel`.
    fn may_land(&self, line: &ExactLineOfSight<'_>, pixel: Option<Pixel>, off: f64) -> bool {
        let mounted = self.scene.camera();
        let camera = &mounted.sensor;
        let [x, y] = line.landing();
        let across = [camera.width, camera.height].map(f64::from);
        let depth = line.depth();
        // An error of `off` moves the image by that over the depth, and more where the line is oblique. The
        // coordinates themselves are rounded too.
        let slack = [0, 1].map(|axis: usize| {
            let slope = ([x, y][axis] - camera.principal_point[axis]) * camera.pixel_pitch[axis]
                / camera.focal_length;
            let pixels = camera.focal_length / (depth.abs() * camera.pixel_pitch[axis]);
            off * (1.0 + slope.abs()) * pixels
                + 8.0
                    * f64::EPSILON
                    * ([x, y][axis].abs() + camera.principal_point[axis].abs() + across[axis])
        });
        match pixel {
            Some(Pixel { i, j }) => {
                let within = |at: f64, index: u32, slack: f64| {
                    at >= f64::from(index) - slack && at <= f64::from(index) + 1.0 + slack
                };
                i < camera.width
                    && j < camera.height
                    && within(x, i, slack[0])
                    && within(y, j, slack[1])
                    && depth > camera.focal_length - off
            }
            // It may be said to miss the image if it lands that near to its border.
            None => {
                let near = |at: f64, side: f64, slack: f64| at <= slack || at >= side - slack;
                near(x, across[0], slack[0])
                    || near(y, across[1], slack[1])
                    || depth <= camera.focal_length + off
            }
        }
    }
}

/// The middle of a vector of intervals.
fn middle(vector: &Vector<Interval>) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|k| vector.0[k].middle()))
}

/// The signed distance of a point from a face's plane, metres, positive in front, to f64 rounding.
fn distance_from_plane(face: &Face, point: DVec3) -> f64 {
    let [a, b, c] = face.corners();
    let n = (b - a).cross(c - a);
    n.dot(point - a) / n.length()
}

/// Whether a point near a face's plane is within `off` metres of the face, except near its corners: inside of every
/// side, or beyond it by at most `off`.
fn is_beside(face: &Face, point: DVec3, off: f64) -> bool {
    let corners = face.corners();
    let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    (0..3).all(|k| {
        let along = corners[(k + 1) % 3] - corners[k];
        let inward = n.cross(along);
        inward.dot(point - corners[k]) >= -off * inward.length()
    })
}
