//! The part of a small square of displacements where all conditions of a face hold.

use crate::rays::displacement::max_norm;
use crate::rays::form::Form;

/// A convex polygon in the square |dx|, |dy| <= 1, from the linear parts of some forms. It says where to search; it
/// proves nothing.
#[derive(Debug)]
pub(crate) struct Region {
    pub(crate) corners: Vec<[f64; 2]>,
    /// The point of least max norm.
    pub(crate) near: [f64; 2],
    /// The mean of the corners.
    pub(crate) middle: [f64; 2],
}

impl Region {
    /// The region where all forms hold; `None` if it is empty.
    pub(crate) fn of(forms: &[Form]) -> Option<Self> {
        let mut corners = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        for form in forms {
            let mut kept = Vec::with_capacity(corners.len() + 1);
            for (k, &here) in corners.iter().enumerate() {
                let next = corners[(k + 1) % corners.len()];
                let (a, b) = (form.at(here), form.at(next));
                if a >= 0.0 {
                    kept.push(here);
                }
                if (a >= 0.0) != (b >= 0.0) {
                    let s = a / (a - b);
                    kept.push([here[0] + s * (next[0] - here[0]), here[1] + s * (next[1] - here[1])]);
                }
            }
            corners = kept;
            if corners.is_empty() {
                return None;
            }
        }
        let count = corners.len() as f64;
        let middle = [0, 1].map(|k: usize| corners.iter().map(|corner| corner[k]).sum::<f64>() / count);
        let near = nearest(&corners);
        Some(Self { corners, near, middle })
    }
}

/// The interval of dx in which all forms hold at `dy`; `None` if it is empty in |dx| <= 1.
pub(crate) fn holds_between(forms: &[Form], dy: f64) -> Option<[f64; 2]> {
    let (mut from, mut to) = (-1.0_f64, 1.0_f64);
    for form in forms {
        let constant = form.at([0.0, dy]);
        let slope = form.at([1.0, dy]) - constant;
        if slope > 0.0 {
            from = from.max(-constant / slope);
        } else if slope < 0.0 {
            to = to.min(-constant / slope);
        } else if constant < 0.0 {
            return None;
        }
    }
    if from <= to { Some([from, to]) } else { None }
}

/// The point of least [`max_norm`] on the sides of a polygon.
fn nearest(corners: &[[f64; 2]]) -> [f64; 2] {
    let mut near = corners[0];
    for (k, &here) in corners.iter().enumerate() {
        let next = corners[(k + 1) % corners.len()];
        let (ux, uy) = (next[0] - here[0], next[1] - here[1]);
        // On a side the norm is least at an end, where a part vanishes, or where both are equal.
        let cuts = [
            0.0,
            -here[0] / ux,
            -here[1] / uy,
            -(here[0] - here[1]) / (ux - uy),
            -(here[0] + here[1]) / (ux + uy),
        ];
        for s in cuts.into_iter().filter(|s| (0.0..=1.0).contains(s)) {
            let at = [here[0] + s * ux, here[1] + s * uy];
            if max_norm(at) < max_norm(near) {
                near = at;
            }
        }
    }
    near
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(constant: f64, x: f64, y: f64) -> Form {
        Form { constant, x, y, xy: 0.0, error: 0.0, bend: 0.0 }
    }

    #[test]
    fn a_square_is_cut_where_conditions_begin() {
        // dx >= 1/2: the right quarter.
        let region = Region::of(&[form(-0.5, 1.0, 0.0)]).expect("a part of the square");
        assert_eq!(region.corners, [[0.5, -1.0], [1.0, -1.0], [1.0, 1.0], [0.5, 1.0]]);
        // Many points are as near: the middle of the side is chosen.
        assert_eq!((region.near, region.middle), ([0.5, 0.0], [0.75, 0.0]));
        let region = Region::of(&[form(-0.5, 0.0, 1.0)]).expect("a part of the square");
        assert_eq!(region.near, [0.0, 0.5]);
        // dx + dy >= 1 and dy <= 1/4: a triangle, nearest at (3/4, 1/4).
        let region = Region::of(&[form(-1.0, 1.0, 1.0), form(0.25, 0.0, -1.0)]).expect("a part");
        assert_eq!(region.corners, [[1.0, 0.0], [1.0, 0.25], [0.75, 0.25]]);
        assert_eq!(max_norm(region.near), 0.75);
        assert!(Region::of(&[form(-1.5, 1.0, 0.0)]).is_none());
        assert!(Region::of(&[form(-0.5, 1.0, 0.0), form(0.25, -1.0, 0.0)]).is_none());
    }

    #[test]
    fn the_nearest_point_of_a_polygon_may_be_inside_a_side() {
        // Where both parts are equal, with like and with unlike signs; and at a corner.
        assert_eq!(nearest(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]), [0.5, 0.5]);
        assert_eq!(nearest(&[[-1.0, 0.0], [0.0, 1.0], [-1.0, 1.0]]), [-0.5, 0.5]);
        assert_eq!(nearest(&[[0.25, 0.5], [1.0, 1.0], [0.0, 1.0]]), [0.25, 0.5]);
        // Through the middle.
        assert_eq!(max_norm(nearest(&[[-1.0, -0.5], [1.0, 0.5], [1.0, 1.0]])), 0.0);
    }

    #[test]
    fn conditions_hold_between_two_places_or_nowhere() {
        // dx >= -1/2 + dy, dx <= 1/4.
        let forms = [form(0.5, 1.0, -1.0), form(0.5, -2.0, 0.0)];
        assert_eq!(holds_between(&forms, 0.0), Some([-0.5, 0.25]));
        assert_eq!(holds_between(&forms, 0.5), Some([0.0, 0.25]));
        assert_eq!(holds_between(&forms, 0.75), Some([0.25, 0.25]));
        assert_eq!(holds_between(&forms, 1.0), None);
        // Level in dx: everywhere or nowhere.
        assert_eq!(holds_between(&[form(0.5, 0.0, 1.0)], -0.25), Some([-1.0, 1.0]));
        assert_eq!(holds_between(&[form(0.5, 0.0, 1.0)], -0.5), Some([-1.0, 1.0]));
        assert_eq!(holds_between(&[form(0.5, 0.0, 1.0)], -0.75), None);
    }
}
