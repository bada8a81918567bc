//! How far the camera's view of a pencil's hit is from changing.
//!
//! # The proof of lo
//!
//! A part of the unit square of displacements changes nothing if every face that may be hit there gives the same
//! answer wherever it is hit; to be seen everywhere it must also be hit everywhere (`sheet`). While the hit stays
//! on the plane of one face F, all that `sight` asks is bilinear in the displacement (`Way::parts`).
//!
//! *Not seen*: the camera lies behind F's plane, or one condition of the landing certainly fails, or the point is
//! certainly hidden by a sheet of faces. As in `sheet`, a walk over the edges that may be met in the part leads from a
//! face that hides its middle to faces that have the same edge the other way round and turn the same side to the
//! camera; if it finds one at each such edge, and all are met before the point and at or beyond the image plane over
//! all of the part, then their images cover it: a watertight surface hides as one.
//!
//! *Seen*: the camera lies before F's plane, all conditions of the landing hold, and every face G that the
//! camera's ways to points of F may meet breaks a condition of its own, or two combined, F's own among them. Where
//! F and G touch, all these vanish at once, and no error bound helps. There it is known by exact signs alone
//! that G does not hide any point P of F, if
//!
//! 1. G lies at or behind F's plane: the way from P to the camera leaves that plane at once; or
//! 2. F lies at or on the camera's side of G's plane: the way can be on that plane at P only; or
//! 3. the plane through the camera and a side of one of them has one face on one side and the other on the other,
//!    with no points of the other face on it but corners that they share: the way may meet both there, but
//!    meets either plane once, so both at P; or
//! 4. all pencils of the part meet fronts of some sheet without an end, the camera lies before the planes of all its
//!    faces, and G is at or behind all of them (it may be one of them): a point that is met first lies at the plane
//!    of the sheet's face that the same pencil meets, or before it, and so does the way, as in 1 and 2.

use std::cmp::Ordering;
use std::collections::HashMap;

use glam::DVec3;
use raypencil_scene::SensorId;

use crate::cull::Bundle;
use crate::divide::{Square, divided};
use crate::face::{ExactRay, Face};
use crate::forms::{Form, certainly_fails, line_leaves};
use crate::margin::Margin;
use crate::near::Neighbourhood;
use crate::number::{Dyadic, Interval, Number};
use crate::pencil::{Aim, Sensor};
use crate::region::size;
use crate::sight::{ExactWay, Sight, Way};
use crate::vector::Vector;
use crate::verdict::Referee;

/// What the camera sees of a pencil, and how far that is from changing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SightMargins {
    /// Of the pencil itself.
    pub sight: Sight,
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
        let sensor = Sensor::of(self.scene, SensorId::Beam(beam))?;
        let (columns, rows) = sensor.size();
        if i >= columns || j >= rows {
            return None;
        }
        let aim = Aim { i, j, dx: 0.0, dy: 0.0 };
        let near = Neighbourhood::new(self, &sensor, aim);
        let nearest = near.nearest_at([0.0; 2]);
        let face = near.faces[*nearest.first()?].face;
        let sight = self.sight_of(&sensor, aim, face);
        let ray = ExactRay::new(&sensor, aim);
        let way = ExactWay::new(&ray, face, self.scene.camera());
        let landing = sight.pixel.map(|pixel| way.border_distance(pixel));
        let mut view = View {
            referee: self,
            sensor: &sensor,
            aim,
            near,
            visible: sight.visible,
            grounds: HashMap::new(),
            judged: HashMap::new(),
        };
        Some(SightMargins { sight, visibility: view.margin(), landing })
    }
}

/// The camera's view of the points that the displaced pencils of one cell hit.
struct View<'a> {
    referee: &'a Referee<'a>,
    sensor: &'a Sensor,
    aim: Aim,
    near: Neighbourhood<'a>,
    /// Whether the cell's own pencil is seen.
    visible: bool,
    /// What is known of the faces that may be hit, by their indices in the neighbourhood.
    grounds: HashMap<usize, Ground<'a>>,
    /// Displacements that have been judged exactly, by their bits.
    judged: HashMap<[u64; 2], bool>,
}

/// A face that may be hit, as the camera sees points of it.
struct Ground<'a> {
    /// Whether the camera is on its front side.
    is_front_seen: bool,
    /// The conditions of the landing.
    lands: [Form; 5],
    occluders: Vec<Occluder<'a>>,
}

/// A face that may hide points of another.
struct Occluder<'a> {
    face: &'a Face,
    /// Whether the camera lies before its plane.
    turned_to_camera: bool,
    /// Positive where it hides: the three sides, front or back, before the point, beyond the image plane.
    hides: [Form; 6],
}

impl<'a> View<'a> {
    fn margin(&mut self) -> Margin {
        let (lo, witness) =
            divided(
                0.0,
                None,
                |square, lo| {
                    if self.is_proven(square) { None } else { Some(self.changed_in(square, lo)) }
                },
            );
        if lo >= 1.0 { Margin::CAPPED } else { Margin::of(lo, witness) }
    }

    /// The nearest of some places in and around a part at which the answer is another: its middle, its corners, and
    /// places outside of it, for a change may begin right beyond a side.
    fn changed_in(&mut self, square: &Square, lo: f64) -> Option<[f64; 2]> {
        let around = Square { half: 1.5 * square.half, ..*square };
        let mut places: Vec<[f64; 2]> = around.corners().into_iter().chain(square.corners()).collect();
        places.push(square.middle);
        places.retain(|&at| size(at) >= lo && size(at) <= 1.0);
        places.sort_by(|a, b| size(*a).total_cmp(&size(*b)));
        places.into_iter().find(|&at| self.visible_at(at) != self.visible)
    }

    /// Whether the displaced pencil's hit is seen, exactly.
    fn visible_at(&mut self, [dx, dy]: [f64; 2]) -> bool {
        let (referee, sensor, aim) = (self.referee, self.sensor, Aim { dx, dy, ..self.aim });
        *self.judged.entry([dx, dy].map(f64::to_bits)).or_insert_with(|| {
            let nearest = referee.nearest(sensor, aim);
            nearest.first().is_some_and(|face| referee.sight_of(sensor, aim, face).visible)
        })
    }

    /// Whether it is proven that the answer is the same in all of a part.
    fn is_proven(&mut self, square: &Square) -> bool {
        if square.half < 1.0 {
            self.near.reach_all();
        }
        let (certainly_hit, faces) = self.near.possible(square.middle, square.half);
        if self.visible && !certainly_hit {
            return false;
        }
        faces.into_iter().all(|index| self.is_alike_on(index, square))
    }

    /// Whether all points of one face that are hit in a part have the answer of the cell's own.
    fn is_alike_on(&mut self, index: usize, square: &Square) -> bool {
        if !self.grounds.contains_key(&index) {
            let ground = self.ground(index);
            self.grounds.insert(index, ground);
        }
        let Self { referee, near, grounds, .. } = self;
        let ground = &grounds[&index];
        if !ground.is_front_seen {
            return !self.visible;
        }
        let own = near.faces[index].own().map(|form| form.about(square.middle));
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
            let is_met = first.own().iter().all(|form| form.is_positive_at(square.middle) == Some(true));
            is_met
                && is_beyond(first.face)
                && near
                    .covering_sheet(square.middle, start, square.half)
                    .is_some_and(|sheet| sheet.into_iter().all(|index| is_beyond(near.faces[index].face)))
        })
    }

    /// All about a face that may be hit, and about what may hide it in the unit square.
    fn ground(&self, index: usize) -> Ground<'a> {
        let camera = self.referee.scene.camera();
        let face = self.near.faces[index].face;
        let centre = camera.scene_from_sensor.position;
        let parts = Way::parts(self.sensor, self.aim, face, camera);
        let lands = Way::lands(&parts, &camera.sensor).map(Form::of);
        let [a, b, c] = corners(face);
        let is_front_seen = volume_sign(a, b, c, centre) == Ordering::Greater;
        let mut occluders = Vec::new();
        let cannot_land = lands.iter().any(|form| form.fails_within() >= 1.0);
        if is_front_seen && !cannot_land {
            let own = self.near.faces[index].own();
            let bundle = self.ways(face, &parts);
            self.referee.tree.visit(&bundle, |other| {
                if other.id != face.id
                    && let Some(occluder) = Occluder::of(other, &parts, centre)
                    && !occluder.hides.iter().any(|form| form.fails_within() >= 1.0)
                    && !(certainly_fails(&[&occluder.hides[..], own].concat(), 0, 1.0) >= 1.0)
                    && !never_hides(other, face, centre)
                {
                    occluders.push(occluder);
                }
                bundle.reach
            });
        }
        Ground { is_front_seen, lands, occluders }
    }

    /// The ways from the camera to all points of a face that are hit in the unit square.
    ///
    /// They lie in a ball around some point p, whichever is smaller: of radius |V - W (p - c)| / W with p the
    /// middle's own, or the face's own around its centroid.
    fn ways(&self, face: &Face, parts: &[Way<Interval>; 4]) -> Bundle {
        let origin = self.referee.scene.camera().scene_from_sensor.position;
        let [a, b, c] = corners(face);
        let centroid = (a + b + c) / 3.0;
        let mut to = centroid - origin;
        let mut radius = [a, b, c].into_iter().map(|corner| corner.distance(centroid)).fold(0.0, f64::max);
        let middle = &parts[0];
        let scale = middle.scale.low - parts[1].scale.magnitude();
        let at = DVec3::from_array(middle.along.0.map(|part| part.middle())) / middle.scale.middle();
        if scale > 0.0 && at.is_finite() {
            let to_at = Vector::<Interval>::of(at);
            let squared: f64 = (0..3)
                .map(|k| {
                    let moved = |part: &Way<Interval>| part.along.0[k].sub(&part.scale.mul(&to_at.0[k]));
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
        Bundle {
            origin,
            direction,
            reach: (length + radius) * (1.0 + 64.0 * f64::EPSILON),
            start_radius: 0.0,
            spread,
        }
    }
}

impl<'a> Occluder<'a> {
    /// The conditions under which a face hides, or `None` if it does not hide anything: the camera is in its plane.
    ///
    /// To be met between point and camera, the plane has the camera on the side that the way comes from: the side
    /// is known once and for all.
    fn of(face: &'a Face, parts: &[Way<Interval>; 4], centre: DVec3) -> Option<Self> {
        let [a, b, c] = corners(face);
        // The sign of n.V where it is met: that of n.(a - c).
        let is_behind = match volume_sign(a, b, c, centre) {
            Ordering::Equal => return None,
            Ordering::Less => true,
            Ordering::Greater => false,
        };
        let signed = |value: Interval| if is_behind { value } else { value.negated() };
        let from_centre = |k: usize| face.corner::<Interval>(k % 3).sub(parts[0].centre());
        let normal = face.normal::<Interval>();
        let height = normal.dot(&from_centre(0));
        let coefficients = |value: &dyn Fn(&Way<Interval>) -> Interval| {
            Form::of([0, 1, 2, 3].map(|part: usize| signed(value(&parts[part]))))
        };
        let side = |k: usize| {
            let along = face.corner::<Interval>((k + 1) % 3).sub(&face.corner(k));
            let moment = from_centre(k).cross(&along);
            coefficients(&|way| way.along.dot(&moment))
        };
        let facing = |way: &Way<Interval>| normal.dot(&way.along);
        let hides = [
            side(0),
            side(1),
            side(2),
            coefficients(&facing),
            coefficients(&|way| facing(way).sub(&height.mul(&way.scale))),
            coefficients(&|way| height.mul(&way.seen.0[2]).sub(&way.focal().mul(&facing(way)))),
        ];
        Some(Self { face, turned_to_camera: !is_behind, hides })
    }
}

impl Ground<'_> {
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

/// A face's corners, unrounded.
fn corners(face: &Face) -> [DVec3; 3] {
    face.corners.map(|[x, y, z]| DVec3::new(f64::from(x), f64::from(y), f64::from(z)))
}

/// The exact sign of (b - a) x (c - a) . (d - a).
fn volume_sign(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Ordering {
    fn volume<T: Number>([a, b, c, d]: [DVec3; 4]) -> T {
        let [a, b, c, d] = [a, b, c, d].map(Vector::<T>::of);
        b.sub(&a).cross(&c.sub(&a)).dot(&d.sub(&a))
    }
    if d == a || d == b || d == c {
        return Ordering::Equal;
    }
    let exact = || volume::<Dyadic>([a, b, c, d]).sign().unwrap_or(Ordering::Equal);
    volume::<Interval>([a, b, c, d]).sign().unwrap_or_else(exact)
}

/// Whether a face certainly hides no point of `ground`, before whose plane the camera lies: one of the reasons 1 to
/// 3, by exact signs. The camera is not in the plane of `face`.
fn never_hides(face: &Face, ground: &Face, camera: DVec3) -> bool {
    let (other, own) = (corners(face), corners(ground));
    let side = |[a, b, c]: [DVec3; 3], point: DVec3| volume_sign(a, b, c, point);
    if other.iter().all(|&corner| side(own, corner) != Ordering::Greater) {
        return true;
    }
    let beyond = side(other, camera).reverse();
    if own.iter().all(|&corner| side(other, corner) != beyond) {
        return true;
    }
    let separates = |of: &[DVec3; 3], from: &[DVec3; 3]| {
        (0..3).any(|k| {
            let (a, b, third) = (of[k], of[(k + 1) % 3], of[(k + 2) % 3]);
            let inner = volume_sign(camera, a, b, third);
            from.iter().all(|corner| match volume_sign(camera, a, b, *corner) {
                Ordering::Equal => of.contains(corner),
                side => side != inner,
            })
        })
    };
    separates(&own, &other) || separates(&other, &own)
}

#[cfg(test)]
#[path = "../tests/unit/sight_margin.rs"]
mod tests;
