//! Bilinear forms in the displacement (dx, dy), in f64 with proven errors.
//!
//! A condition of the contract holds where its form g is positive. From its coefficients follow the squares of
//! displacements in which g certainly holds, or certainly fails.

use crate::numbers::number::Interval;

/// u = 2^-53: the unit roundoff of f64.
pub(crate) const UNIT_ROUNDOFF: f64 = 0.5 * f64::EPSILON;

/// The function `constant + x dx + y dy + xy dx dy`. Anywhere in |dx|, |dy| <= 1 it is wrong by at most `error`,
/// evaluation included, and within |dx|, |dy| <= r by at most `bend` r^2 more.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Form {
    pub(crate) constant: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) xy: f64,
    pub(crate) error: f64,
    pub(crate) bend: f64,
}

impl Form {
    /// A form from its coefficients, each known up to an interval.
    pub(crate) fn of(coefficients: [Interval; 4]) -> Self {
        let middle = coefficients.map(|range| range.middle());
        let doubt = |k: usize| (coefficients[k].high - middle[k]).max(middle[k] - coefficients[k].low);
        let [constant, x, y, xy] = middle;
        let form = Self { constant, x, y, xy, error: 0.0, bend: 0.0 };
        let evaluated = 16.0 * UNIT_ROUNDOFF * form.scale() + f64::MIN_POSITIVE;
        let error = ((doubt(0) + doubt(1)) + (doubt(2) + doubt(3)) + evaluated) * (1.0 + 8.0 * f64::EPSILON);
        Self { error, ..form }
    }

    /// A radius of at most 1 within which g > 0 certainly; 0 if there is none.
    #[inline]
    pub(crate) fn holds_within(&self) -> f64 {
        self.radius(self.constant - self.error)
    }

    /// A radius of at most 1 within which g < 0 certainly; 0 if there is none.
    #[inline]
    pub(crate) fn fails_within(&self) -> f64 {
        self.radius(-self.constant - self.error)
    }

    /// The largest r up to which `room - r (|x| + |y|) - r^2 (|xy| + bend)` stays positive, at most 1.
    ///
    /// The positive root of b r^2 + a r = c is 2 c / (a + sqrt(a^2 + 4 b c)). The result is made smaller by 2^-40 of
    /// itself, far more than a dozen roundings.
    #[inline]
    fn radius(&self, room: f64) -> f64 {
        if !(room > 0.0) {
            return 0.0;
        }
        let a = self.x.abs() + self.y.abs();
        let b = self.xy.abs() + self.bend;
        if room > (a + b) * (1.0 + 8.0 * f64::EPSILON) {
            return 1.0;
        }
        let r = 2.0 * room / (a + (a * a + 4.0 * b * room).sqrt());
        // NaN, from infinite coefficients, certifies nothing.
        if r > 0.0 { (r * (1.0 - 1.0 / (1u64 << 40) as f64)).min(1.0) } else { 0.0 }
    }

    /// The sum of the absolute coefficients: the scale of the rounding of an evaluation.
    fn scale(&self) -> f64 {
        self.constant.abs() + self.x.abs() + self.y.abs() + self.xy.abs()
    }

    /// `self + weight other`. For a positive weight it is negative wherever both are.
    pub(crate) fn plus(&self, other: &Self, weight: f64) -> Self {
        let sum = Self {
            constant: self.constant + weight * other.constant,
            x: self.x + weight * other.x,
            y: self.y + weight * other.y,
            xy: self.xy + weight * other.xy,
            error: 0.0,
            bend: (self.bend + weight.abs() * other.bend) * (1.0 + 4.0 * f64::EPSILON),
        };
        // Two roundings of each coefficient, and the evaluation of the sum where slopes cancel.
        let rounded = 16.0 * UNIT_ROUNDOFF * (self.scale() + weight.abs() * other.scale());
        let error = (self.error + weight.abs() * other.error + rounded) * (1.0 + 4.0 * f64::EPSILON);
        Self { error, ..sum }
    }

    /// The same function of the displacement from `centre`. The centre and all later arguments lie in |dx|, |dy| <=
    /// 1.
    pub(crate) fn about(&self, [cx, cy]: [f64; 2]) -> Self {
        if cx == 0.0 && cy == 0.0 {
            return *self;
        }
        Self {
            constant: self.constant + self.x * cx + self.y * cy + self.xy * cx * cy,
            x: self.x + self.xy * cy,
            y: self.y + self.xy * cx,
            xy: self.xy,
            error: (self.error + self.bend + 16.0 * UNIT_ROUNDOFF * self.scale())
                * (1.0 + 4.0 * f64::EPSILON),
            bend: 0.0,
        }
    }

    /// The value at a displacement, to within `error` and the bend.
    #[inline]
    pub(crate) fn at(&self, [dx, dy]: [f64; 2]) -> f64 {
        self.constant + self.x * dx + self.y * dy + self.xy * dx * dy
    }

    /// Whether g > 0 at a displacement in the unit square; `None` if the sign is not certain.
    #[inline]
    pub(crate) fn is_positive_at(&self, at: [f64; 2]) -> Option<bool> {
        let value = self.at(at);
        // r is at most 1, so r^2 is too.
        let doubt = self.error + self.bend;
        if value > doubt {
            Some(true)
        } else if value < -doubt {
            Some(false)
        } else {
            None
        }
    }

    /// -g.
    pub(crate) fn negated(&self) -> Self {
        Self { constant: -self.constant, x: -self.x, y: -self.y, xy: -self.xy, ..*self }
    }

    /// The same form for displacements in units of `unit` cells, at most 1.
    pub(crate) fn scaled(&self, unit: f64) -> Self {
        Self {
            x: self.x * unit,
            y: self.y * unit,
            xy: self.xy * unit * unit,
            bend: self.bend * unit * unit,
            ..*self
        }
    }
}

/// A radius within which the forms certainly do not all hold, shown by one of them or by two combined: the largest
/// that can be shown, or one of at least `enough`. No two of the first `apart` forms are combined.
pub(crate) fn certainly_fails(forms: &[Form], apart: usize, enough: f64) -> f64 {
    let mut best = forms.iter().map(Form::fails_within).fold(0.0, f64::max);
    for (k, a) in forms.iter().enumerate() {
        for b in &forms[(k + 1).max(apart.min(forms.len()))..] {
            if best >= enough {
                return best;
            }
            best = best.max(both_fail(a, b));
        }
    }
    best
}

/// A radius within which two forms certainly do not both hold, shown by their combinations.
///
/// Where both hold, so does their sum with any positive weight. The weights that make the sum level in dx or in dy
/// are the best for a square.
fn both_fail(a: &Form, b: &Form) -> f64 {
    let mut best = 0.0;
    for (slope_a, slope_b) in [(a.x, b.x), (a.y, b.y)] {
        let weight = -slope_a / slope_b;
        if weight > 0.0 && weight.is_finite() {
            best = a.plus(b, weight).fails_within().max(best);
        }
    }
    best
}

/// A radius within which `other` certainly holds nowhere on the line of `edge`. On the line the form is 0, so it may
/// be added with a weight of either sign.
pub(crate) fn line_leaves(edge: &Form, other: &Form) -> f64 {
    let mut best = 0.0;
    for (slope, slope_edge) in [(other.x, edge.x), (other.y, edge.y)] {
        let weight = -slope / slope_edge;
        if weight.is_finite() {
            best = other.plus(edge, weight).fails_within().max(best);
        }
    }
    best
}

#[cfg(test)]
#[path = "../../tests/unit/form.rs"]
mod tests;
