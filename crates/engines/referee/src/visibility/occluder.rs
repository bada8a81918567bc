//! Faces that may hide points of another face from the camera, and exact proofs that they do not.

use std::cmp::Ordering;

use glam::DVec3;

use crate::hits::face::Face;
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::vector::Vector;
use crate::rays::form::Form;
use crate::trees::bvh::InBox;
use crate::visibility::line_of_sight::LineOfSight;

/// A face that may hide points of another.
pub(crate) struct Occluder<'a> {
    pub(crate) face: &'a Face,
    /// Whether the camera lies before its plane.
    pub(crate) turned_to_camera: bool,
    /// The conditions under which it hides a point, positive where they hold: three sides, front or back, before the
    /// point, at or beyond the image plane.
    pub(crate) hides: [Form; 6],
}

impl<'a> Occluder<'a> {
    /// The conditions under which a face hides a point, or `None` if it hides nothing because the camera is in its
    /// plane.
    ///
    /// To be met between point and camera, the plane must have the camera on the side that the line comes from. That
    /// side does not depend on the point.
    pub(crate) fn of(face: &'a Face, parts: &[LineOfSight<Interval>; 4], centre: DVec3) -> Option<Self> {
        let [a, b, c] = face.corners();
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
        let coefficients = |value: &dyn Fn(&LineOfSight<Interval>) -> Interval| {
            Form::of([0, 1, 2, 3].map(|part: usize| signed(value(&parts[part]))))
        };
        let side = |k: usize| {
            let along = face.corner::<Interval>((k + 1) % 3).sub(&face.corner(k));
            let moment = from_centre(k).cross(&along);
            coefficients(&|line| line.direction.dot(&moment))
        };
        let facing = |line: &LineOfSight<Interval>| normal.dot(&line.direction);
        let hides = [
            side(0),
            side(1),
            side(2),
            coefficients(&facing),
            coefficients(&|line| facing(line).sub(&height.mul(&line.scale))),
            coefficients(&|line| height.mul(&line.in_camera.0[2]).sub(&line.focal().mul(&facing(line)))),
        ];
        Some(Self { face, turned_to_camera: !is_behind, hides })
    }
}

/// The exact sign of (b - a) x (c - a) . (d - a).
pub(crate) fn volume_sign(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Ordering {
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

/// Whether a face certainly hides no point of `ground`, by reasons 1 to 3 of `visibility_margin` and by exact signs.
/// The camera lies before the plane of `ground` and not in the plane of `face`.
pub(crate) fn never_occludes(face: &Face, ground: &Face, camera: DVec3) -> bool {
    let (other, own) = (face.corners(), ground.corners());
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
