//! The part of a small square of displacements where all conditions of a face hold.

use crate::forms::Form;

/// A convex polygon in the square |dx|, |dy| <= 1, from the linear parts of some forms: good enough to say
/// where to look, not to prove.
#[derive(Debug)]
pub(crate) struct Region {
    pub(crate) corners: Vec<[f64; 2]>,
    /// Its point nearest to the origin by the larger of |dx| and |dy|.
    pub(crate) near: [f64; 2],
    /// The mean of its corners.
    pub(crate) middle: [f64; 2],
}

impl Region {
    /// `None` if it is empty.
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

/// Between which dx all forms hold at `dy`, or `None` if nowhere in |dx| <= 1.
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

/// The larger of |dx| and |dy|.
pub(crate) fn size(at: [f64; 2]) -> f64 {
    at[0].abs().max(at[1].abs())
}

/// The point of least [`size`] on the sides of a polygon.
fn nearest(corners: &[[f64; 2]]) -> [f64; 2] {
    let mut near = corners[0];
    for (k, &here) in corners.iter().enumerate() {
        let next = corners[(k + 1) % corners.len()];
        let (ux, uy) = (next[0] - here[0], next[1] - here[1]);
        // On a side it is least at an end, where a part vanishes, or where both are equal.
        let cuts = [
            0.0,
            -here[0] / ux,
            -here[1] / uy,
            -(here[0] - here[1]) / (ux - uy),
            -(here[0] + here[1]) / (ux + uy),
        ];
        for s in cuts.into_iter().filter(|s| (0.0..=1.0).contains(s)) {
            let at = [here[0] + s * ux, here[1] + s * uy];
            if size(at) < size(near) {
                near = at;
            }
        }
    }
    near
}
