//! Margins of visibility: how far the camera's view of a pencil's hit is from changing.
//!
//! # The proof of lo
//!
//! A part of the unit square of displacements changes nothing if every face that may be hit there gives the same
//! answer wherever it is hit; to be seen everywhere, the pencil must also hit everywhere (`sheet`). While the hit
//! stays on the plane of one face F, all conditions of `line_of_sight` are bilinear in the displacement
//! (`LineOfSight::parts`).
//!
//! *Not seen*: the camera lies behind F's plane, or one condition of the landing certainly fails, or a sheet of faces
//! certainly hides the point. As in `sheet`, a walk over the edges that may be met in the part leads from a face that
//! hides its middle to faces that have the same edge the other way round and turn the same side to the camera. If it
//! finds one at each such edge, and all are met before the point and at or beyond the image plane over all of the
//! part, then their images cover it: a watertight surface hides as one.
//!
//! *Seen*: the camera lies before F's plane, all conditions of the landing hold, and every face G that the camera's
//! lines to points of F may meet breaks a condition of its own, or two combined, F's own among them. Where F and G
//! touch, all these forms vanish at once, and no error bound helps. There exact signs alone prove that G does not
//! hide any point P of F, if
//!
//! 1. G lies at or behind F's plane: the line from P to the camera leaves that plane at once; or
//! 2. F lies at or on the camera's side of G's plane: the line can be on that plane at P only; or
//! 3. the plane through the camera and a side of one of them has one face on one side and the other on the other,
//!    with no points of the other face on it but corners that they share: the line may meet both there, but meets
//!    either plane once, so both at P; or
//! 4. all pencils of the part meet fronts of some sheet without an end, the camera lies before the planes of all its
//!    faces, and G is at or behind all of them (it may be one of them): a point that is met first lies at the plane
//!    of the sheet's face that the same pencil meets, or before it, and so does the line, as in 1 and 2.

use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

use glam::DVec3;
use raypencil_scene::SensorId;

use crate::hits::face::{ExactRay, Face};
use crate::hits::neighbourhood::Neighbourhood;
use crate::hits::verdict::Referee;
use crate::margins::margin::Margin;
use crate::margins::subdivision::{Square, subdivide};
use crate::numbers::number::{Interval, Number};
use crate::numbers::vector::Vector;
use crate::rays::displacement::max_norm;
use crate::rays::form::{Form, certainly_fails, line_leaves};
use crate::rays::ray::{Aim, MountedSensor};
use crate::trees::bvh::{InBox, RayBundle};
use crate::visibility::line_of_sight::{ExactLineOfSight, LineOfSight};
use crate::visibility::occluder::{Occluder, never_occludes, volume_sign};
use crate::visibility::seen::Visibility;

/// The camera's view of a pencil's hit, and how far it is from changing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibilityMargins {
    /// The view of the pencil itself.
    pub sight: Visibility,
    /// The least displacement at which `visible` changes; a pencil that misses is not visible.
    pub visibility: Margin,
    /// The distance of the point's image from the nearest border of its pixel, pixels: an interval. `None` if it
    /// lands in no pixel.
    pub landing: Option<[f64; 2]>,
}

impl Referee<'_> {
    /// The camera's view of the hit of pencil (i, j), and how far it is from changing; `None` if there is no such
    /// pencil, or it does not hit.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::Referee;
    ///
    /// let scene = wall_scene();
    /// let margins = Referee::new(&scene).visibility_margins(0, 0, 0).unwrap();
    /// // The point lands at (0.5, 4.5), half a pixel from each border.
    /// assert_eq!(margins.landing.map(|range| range.map(|pixels| pixels as f32)), Some([0.5; 2]));
    /// // The image ends half a pixel, 1/8 m on the wall, to the left. The pencil's cell is 1 m wide.
    /// assert!(margins.visibility.lo <= 0.125 && 0.125 <= margins.visibility.hi);
    /// ```
    pub fn visibility_margins(&self, beam: usize, i: u32, j: u32) -> Option<VisibilityMargins> {
        let (sensor, aim) = self.sensor_and_aim(SensorId::Beam(beam), i, j)?;
        let near = Neighbourhood::new(self, &sensor, aim);
        let nearest = near.nearest_at([0.0; 2]);
        let face = near.faces[*nearest.first()?].face;
        let sight = self.visibility_of(&sensor, aim, face);
        let ray = ExactRay::new(&sensor, aim);
        let line = ExactLineOfSight::new(&ray, face, self.scene.camera());
        let landing = sight.pixel.map(|pixel| line.border_distance(pixel));
        let mut view = VisibilitySearch {
            referee: self,
            sensor: &sensor,
            aim,
            near,
            visible: sight.visible,
            hit_faces: HashMap::new(),
            known_displacements: HashMap::new(),
        };
        Some(VisibilityMargins { sight, visibility: view.margin(), landing })
    }
}

/// The search for the margin of one cell: the camera's view of the points that the displaced pencils hit.
struct VisibilitySearch<'a> {
    referee: &'a Referee<'a>,
    sensor: &'a MountedSensor,
    aim: Aim,
    near: Neighbourhood<'a>,
    /// Whether the camera sees the cell's own pencil.
    visible: bool,
    /// The faces that may be hit, by their indices in the neighbourhood.
    hit_faces: HashMap<usize, HitFace<'a>>,
    /// Exact answers for displacements, by the bits of these.
    known_displacements: HashMap<[u64; 2], bool>,
}

/// A face that may be hit, and how the camera sees points of it.
struct HitFace<'a> {
    /// Whether the camera is on its front side.
    is_front_seen: bool,
    /// The conditions of the landing.
    lands: [Form; 5],
    occluders: Vec<Occluder<'a>>,
}

impl<'a> VisibilitySearch<'a> {
    fn margin(&mut self) -> Margin {
        let (lo, witness) = subdivide(0.0, None, |square, lo| {
            if self.is_proven(square) { None } else { Some(self.changed_in(square, lo)) }
        });
        Margin::of(lo, witness)
    }

    /// The nearest place in and around a part at which the answer differs. Tried are its middle, its corners, and
    /// places outside of it, because a change may begin right beyond a side.
    fn changed_in(&mut self, square: &Square, lo: f64) -> Option<[f64; 2]> {
        let around = Square { half: 1.5 * square.half, ..*square };
        let mut places: Vec<[f64; 2]> = around.corners().into_iter().chain(square.corners()).collect();
        places.push(square.middle);
        places.retain(|&at| max_norm(at) >= lo && max_norm(at) <= 1.0);
        places.sort_by(|a, b| max_norm(*a).total_cmp(&max_norm(*b)));
        places.into_iter().find(|&at| self.visible_at(at) != self.visible)
    }

    /// Whether the displaced pencil's hit is seen, exactly.
    fn visible_at(&mut self, [dx, dy]: [f64; 2]) -> bool {
        let (referee, sensor, aim) = (self.referee, self.sensor, Aim { dx, dy, ..self.aim });
        *self.known_displacements.entry([dx, dy].map(f64::to_bits)).or_insert_with(|| {
            let nearest = referee.nearest(sensor, aim);
            nearest.first().is_some_and(|face| referee.visibility_of(sensor, aim, face).visible)
        })
    }

    /// Whether the answer is proven to be the same in all of a part.
    fn is_proven(&mut self, square: &Square) -> bool {
        if square.half < 1.0 {
            self.near.extend_to_max_range();
        }
        let (certainly_hit, mut faces) = self.near.possible(square.middle, square.half);
        if self.visible && !certainly_hit {
            return false;
        }
        // The same triangle is hit at the same points, and they are seen alike: one of its faces stands for all.
        let mut triangles = HashSet::with_capacity(faces.len());
        faces.retain(|&index| {
            triangles.insert(self.near.faces[index].face.corners.map(|corner| corner.map(f32::to_bits)))
        });
        faces.into_iter().all(|index| self.is_alike_on(index, square))
    }

    /// Whether all points of one face that are hit in a part have the cell's own answer.
    fn is_alike_on(&mut self, index: usize, square: &Square) -> bool {
        if !self.hit_faces.contains_key(&index) {
            let hit = self.hit_face(index);
            self.hit_faces.insert(index, hit);
        }
        let Self { referee, near, hit_faces, .. } = self;
        let hit = &hit_faces[&index];
        if !hit.is_front_seen {
            return !self.visible;
        }
        let own = near.faces[index].conditions().map(|form| form.about(square.middle));
        let lands = hit.lands.map(|form| form.about(square.middle));
        // Whether the face is certainly not hit where all of `forms` hold.
        let fail = |forms: &[Form]| {
            forms.iter().any(|form| form.fails_within() >= square.half)
                || certainly_fails(&[forms, &own].concat(), 0, square.half) >= square.half
        };
        if !self.visible {
            return fail(&lands) || hit.is_covered(square);
        }
        lands.iter().all(|form| form.holds_within() >= square.half || fail(&[form.negated()]))
            && hit.occluders.iter().all(|occluder| {
                let hides = occluder.hides.map(|form| form.about(square.middle));
                fail(&hides) || Self::is_before_sheet(referee, near, occluder, square)
            })
    }

    /// Whether an occluder hides no point that is met first, by reason 4.
    fn is_before_sheet(
        referee: &Referee<'_>,
        near: &mut Neighbourhood<'_>,
        occluder: &Occluder<'_>,
        square: &Square,
    ) -> bool {
        let camera = referee.scene.camera().scene_from_sensor.position;
        let hidden = occluder.face.corners();
        let is_beyond = |face: &Face| {
            let [a, b, c] = face.corners();
            let at_or_behind = |&corner: &DVec3| volume_sign(a, b, c, corner) != Ordering::Greater;
            volume_sign(a, b, c, camera) == Ordering::Greater
                && (face.id == occluder.face.id || hidden.iter().all(at_or_behind))
        };
        (0..near.faces.len()).any(|start| {
            let first = &near.faces[start];
            let is_met =
                first.conditions().iter().all(|form| form.is_positive_at(square.middle) == Some(true));
            is_met
                && is_beyond(first.face)
                && near
                    .covering_sheet(square.middle, start, square.half)
                    .is_some_and(|sheet| sheet.into_iter().all(|index| is_beyond(near.faces[index].face)))
        })
    }

    /// A face that may be hit, with the faces that may hide it in the unit square.
    fn hit_face(&self, index: usize) -> HitFace<'a> {
        let camera = self.referee.scene.camera();
        let face = self.near.faces[index].face;
        let centre = camera.scene_from_sensor.position;
        let parts = LineOfSight::parts(self.sensor, self.aim, face, camera);
        let lands = LineOfSight::lands(&parts, &camera.sensor).map(Form::of);
        let [a, b, c] = face.corners();
        let is_front_seen = volume_sign(a, b, c, centre) == Ordering::Greater;
        let mut occluders = Vec::new();
        let cannot_land = lands.iter().any(|form| form.fails_within() >= 1.0);
        if is_front_seen && !cannot_land {
            let own = self.near.faces[index].conditions();
            let bundle = self.lines_to(face, &parts);
            self.referee.bvh.visit(&bundle, |other| {
                // No triangle lies before itself.
                if other.corners != face.corners
                    && let Some(occluder) = Occluder::of(other, &parts, centre)
                    && !occluder.hides.iter().any(|form| form.fails_within() >= 1.0)
                    && !(certainly_fails(&[&occluder.hides[..], own].concat(), 0, 1.0) >= 1.0)
                    && !never_occludes(other, face, centre)
                {
                    occluders.push(occluder);
                }
                bundle.max_range
            });
        }
        HitFace { is_front_seen, lands, occluders }
    }

    /// The lines of sight from the camera to all points of a face that are hit in the unit square.
    ///
    /// The points lie in a ball around some point p. Its radius is the largest |V - W (p - c)| / W, with p the
    /// middle's own point, or else the face's own radius around its centroid: whichever is smaller.
    fn lines_to(&self, face: &Face, parts: &[LineOfSight<Interval>; 4]) -> RayBundle {
        let origin = self.referee.scene.camera().scene_from_sensor.position;
        let [a, b, c] = face.corners();
        let centroid = (a + b + c) / 3.0;
        let mut to = centroid - origin;
        let mut radius = [a, b, c].into_iter().map(|corner| corner.distance(centroid)).fold(0.0, f64::max);
        let middle = &parts[0];
        let scale = middle.scale.low - parts[1].scale.magnitude();
        let at = DVec3::from_array(middle.direction.0.map(|part| part.middle())) / middle.scale.middle();
        if scale > 0.0 && at.is_finite() {
            let to_at = Vector::<Interval>::of(at);
            let squared: f64 = (0..3)
                .map(|k| {
                    let moved =
                        |part: &LineOfSight<Interval>| part.direction.0[k].sub(&part.scale.mul(&to_at.0[k]));
                    parts.iter().map(|part| moved(part).magnitude()).sum::<f64>()
                })
                .map(|moved| moved * moved)
                .sum();
            let around = squared.sqrt() / scale;
            if around < radius {
                (to, radius) = (at, around);
            }
        }
        // Covers a few roundings of 2^-53 of the sizes; the hierarchy has its own slack.
        let radius = radius * (1.0 + 1e-9) + (to.length() + origin.length()) * 64.0 * f64::EPSILON;
        let length = to.length();
        // Unit vectors of directions that differ by `radius` differ by at most that over the shorter length, and by
        // at most 2.
        let spread = if radius < length { (radius / (length - radius)).min(2.0) } else { 2.0 };
        let direction = if length > 0.0 { to / length } else { DVec3::X };
        RayBundle {
            origin,
            direction,
            max_range: (length + radius) * (1.0 + 64.0 * f64::EPSILON),
            start_radius: 0.0,
            spread,
        }
    }
}

impl HitFace<'_> {
    /// Whether all of a part is certainly hidden behind one sheet.
    fn is_covered(&self, square: &Square) -> bool {
        let holds = |form: &Form| form.about(square.middle).holds_within() >= square.half;
        let stands = |occluder: &Occluder<'_>| occluder.hides[3..].iter().all(holds);
        let at_middle = |form: &Form| form.is_positive_at(square.middle) == Some(true);
        (0..self.occluders.len()).any(|start| {
            let first = &self.occluders[start];
            if !(first.hides.iter().all(at_middle) && stands(first)) {
                return false;
            }
            let mut sheet = vec![start];
            let mut next = 0;
            while next < sheet.len() {
                let occluder = &self.occluders[sheet[next]];
                next += 1;
                let sides = [0, 1, 2].map(|k: usize| occluder.hides[k].about(square.middle));
                for k in 0..3 {
                    let others = [&sides[(k + 1) % 3], &sides[(k + 2) % 3]];
                    let is_absent = sides[k].holds_within() >= square.half
                        || sides[k].fails_within() >= square.half
                        || others.into_iter().any(|other| line_leaves(&sides[k], other) >= square.half);
                    if is_absent {
                        continue;
                    }
                    let edge = [occluder.face.corners[(k + 1) % 3], occluder.face.corners[k]];
                    let is_mate = |other: &Occluder<'_>| {
                        other.turned_to_camera == occluder.turned_to_camera
                            && (0..3)
                                .any(|l| [other.face.corners[l], other.face.corners[(l + 1) % 3]] == edge)
                            && stands(other)
                    };
                    match self.occluders.iter().position(is_mate) {
                        Some(mate) if sheet.contains(&mate) => {}
                        Some(mate) => sheet.push(mate),
                        None => return false,
                    }
                }
            }
            true
        })
    }
}

#[cfg(test)]
#[path = "../../tests/unit/visibility_margin.rs"]
mod tests;
