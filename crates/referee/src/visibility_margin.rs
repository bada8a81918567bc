//! How far the camera's view of a pencil's hit is from changing.
//!
//! # The proof of lo
//!
//! A part of the unit square of displacements changes nothing if every face that may be hit there gives the same
//! answer wherever it is hit; to be seen everywhere it must also be hit everywhere (`sheet`). While the hit stays
//! on the plane of one face F, all that `sight` asks is bilinear in the displacement (`LineOfSight::parts`).
//!
//! *Not seen*: the camera lies behind F's plane, or one condition of the landing certainly fails, or the point is
//! certainly hidden by a sheet of faces. As in `sheet`, a walk over the edges that may be met in the part leads from a
//! face that hides its middle to faces that have the same edge the other line round and turn the same side to the
//! camera; if it finds one at each such edge, and all are met before the point and at or beyond the image plane over
//! all of the part, then their images cover it: a watertight surface hides as one.
//!
//! *Seen*: the camera lies before F's plane, all conditions of the landing hold, and every face G that the
//! camera's ways to points of F may meet breaks a condition of its own, or two combined, F's own among them. Where
//! F and G touch, all these vanish at once, and no error bound helps. There it is known by exact signs alone
//! that G does not hide any point P of F, if
//!
//! 1. G lies at or behind F's plane: the line from P to the camera leaves that plane at once; or
//! 2. F lies at or on the camera's side of G's plane: the line can be on that plane at P only; or
//! 3. the plane through the camera and a side of one of them has one face on one side and the other on the other,
//!    with no points of the other face on it but corners that they share: the line may meet both there, but
//!    meets either plane once, so both at P; or
//! 4. all pencils of the part meet fronts of some sheet without an end, the camera lies before the planes of all its
//!    faces, and G is at or behind all of them (it may be one of them): a point that is met first lies at the plane
//!    of the sheet's face that the same pencil meets, or before it, and so does the line, as in 1 and 2.

use std::cmp::Ordering;
use std::collections::HashMap;

use glam::DVec3;
use raypencil_scene::SensorId;

use crate::bvh::RayBundle;
use crate::displacement::max_norm;
use crate::face::{ExactRay, Face};
use crate::form::{Form, certainly_fails, line_leaves};
use crate::line_of_sight::{ExactLineOfSight, LineOfSight};
use crate::margin::Margin;
use crate::neighbourhood::Neighbourhood;
use crate::number::{Interval, Number};
use crate::occluder::{Occluder, corners, never_occludes, volume_sign};
use crate::ray::{Aim, MountedSensor};
use crate::subdivision::{Square, subdivide};
use crate::vector::Vector;
use crate::verdict::Referee;
use crate::visibility::Visibility;

/// What the camera sees of a pencil, and how far that is from changing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SightMargins {
    /// Of the pencil itself.
    pub sight: Visibility,
    /// The least displacement at which `visible` changes; a pencil that misses is not visible.
    pub visibility: Margin,
    /// How far from the nearest border of its pixel the point lands, in pixels: between these two numbers. `None`
    /// if it lands on none.
    pub landing: Option<[f64; 2]>,
}

impl Referee<'_> {
    /// What the camera sees of the hit of pencil (i, j), and how far it is from changing; `None` if there is no such
    /// pencil, or it does not hit.
    pub fn sight_margins(&self, beam: usize, i: u32, j: u32) -> Option<SightMargins> {
        let sensor = MountedSensor::of(self.scene, SensorId::Beam(beam))?;
        let (columns, rows) = sensor.size();
        if i >= columns || j >= rows {
            return None;
        }
        let aim = Aim { i, j, dx: 0.0, dy: 0.0 };
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
        Some(SightMargins { sight, visibility: view.margin(), landing })
    }
}

/// The camera's view of the points that the displaced pencils of one cell hit.
struct VisibilitySearch<'a> {
    referee: &'a Referee<'a>,
    sensor: &'a MountedSensor,
    aim: Aim,
    near: Neighbourhood<'a>,
    /// Whether the cell's own pencil is seen.
    visible: bool,
    /// What is known of the faces that may be hit, by their indices in the neighbourhood.
    hit_faces: HashMap<usize, HitFace<'a>>,
    /// Displacements that have been known_displacements exactly, by their bits.
    known_displacements: HashMap<[u64; 2], bool>,
}

/// A face that may be hit, as the camera sees points of it.
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
        if lo >= 1.0 { Margin::CAPPED } else { Margin::of(lo, witness) }
    }

    /// The nearest of some places in and around a part at which the answer is another: its middle, its corners, and
    /// places outside of it, for a change may begin right beyond a side.
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

    /// Whether it is proven that the answer is the same in all of a part.
    fn is_proven(&mut self, square: &Square) -> bool {
        if square.half < 1.0 {
            self.near.extend_to_max_range();
        }
        let (certainly_hit, faces) = self.near.possible(square.middle, square.half);
        if self.visible && !certainly_hit {
            return false;
        }
        faces.into_iter().all(|index| self.is_alike_on(index, square))
    }

    /// Whether all points of one face that are hit in a part have the answer of the cell's own.
    fn is_alike_on(&mut self, index: usize, square: &Square) -> bool {
        if !self.hit_faces.contains_key(&index) {
            let ground = self.ground(index);
            self.hit_faces.insert(index, ground);
        }
        let Self { referee, near, hit_faces, .. } = self;
        let ground = &hit_faces[&index];
        if !ground.is_front_seen {
            return !self.visible;
        }
        let own = near.faces[index].conditions().map(|form| form.about(square.middle));
        let lands = ground.lands.map(|form| form.about(square.middle));
        // Certainly not all of the first `forms`, where the face is hit.
        let fail = |forms: &[Form]| {
            forms.iter().any(|form| form.fails_within() >= square.half)
                || certainly_fails(&[forms, &own].concat(), 0, square.half) >= square.half
        };
        if !self.visible {
            return fail(&lands) || ground.is_covered(square);
        }
        lands.iter().all(|form| form.holds_within() >= square.half || fail(&[form.negated()]))
            && ground.occluders.iter().all(|occluder| {
                let hides = occluder.hides.map(|form| form.about(square.middle));
                fail(&hides) || Self::is_before_sheet(referee, near, occluder, square)
            })
    }

    /// Whether an occluder hides nothing that is met first, for reason 4.
    fn is_before_sheet(
        referee: &Referee<'_>,
        near: &mut Neighbourhood<'_>,
        occluder: &Occluder<'_>,
        square: &Square,
    ) -> bool {
        let camera = referee.scene.camera().scene_from_sensor.position;
        let hidden = corners(occluder.face);
        let is_beyond = |face: &Face| {
            let [a, b, c] = corners(face);
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

    /// All about a face that may be hit, and about what may hide it in the unit square.
    fn ground(&self, index: usize) -> HitFace<'a> {
        let camera = self.referee.scene.camera();
        let face = self.near.faces[index].face;
        let centre = camera.scene_from_sensor.position;
        let parts = LineOfSight::parts(self.sensor, self.aim, face, camera);
        let lands = LineOfSight::lands(&parts, &camera.sensor).map(Form::of);
        let [a, b, c] = corners(face);
        let is_front_seen = volume_sign(a, b, c, centre) == Ordering::Greater;
        let mut occluders = Vec::new();
        let cannot_land = lands.iter().any(|form| form.fails_within() >= 1.0);
        if is_front_seen && !cannot_land {
            let own = self.near.faces[index].conditions();
            let bundle = self.ways(face, &parts);
            self.referee.bvh.visit(&bundle, |other| {
                if other.id != face.id
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

    /// The ways from the camera to all points of a face that are hit in the unit square.
    ///
    /// They lie in a ball around some point p, whichever is smaller: of radius |V - W (p - c)| / W with p the
    /// middle's own, or the face's own around its centroid.
    fn ways(&self, face: &Face, parts: &[LineOfSight<Interval>; 4]) -> RayBundle {
        let origin = self.referee.scene.camera().scene_from_sensor.position;
        let [a, b, c] = corners(face);
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
        // A few roundings of either, each 2^-53 of the sizes, and the tree's own slack.
        let radius = radius * (1.0 + 1e-9) + (to.length() + origin.length()) * 64.0 * f64::EPSILON;
        let length = to.length();
        // Units of directions that differ by `radius` differ by at most that over the shorter one, and by 2.
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
#[path = "../tests/unit/visibility_margin.rs"]
mod tests;
