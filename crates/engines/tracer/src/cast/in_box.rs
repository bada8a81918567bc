//! A ray that runs nearly in a face's plane: it meets the face within the face's box or not at all.
//!
//! With n = (b - a) x (c - a), t = n.(a - o) / n.q. Where the ray runs in the plane to the last digits, both are nothing but
//! rounding, and so is t; and of the edge functions some are 0 that should have a sign, so that a ray in the plane passes for one
//! that meets the face though it runs beside it. A walk that visits the face's box would have such a crossing, wherever it lies, and
//! one that met something before that box would not. So t is moved into the part of the ray that lies in the face's box, and there
//! is no crossing where the ray passes beside the box: what a ray meets then depends on the ray and the face alone.
//!
//! # When t may be off
//!
//! With e = |b - a|, f = |c - a|, w = |a - o|, all by their largest components, and u = 2^-53: a component of n is off by at most
//! 8 u e f, so n.q by 32 u e f |q| and n.(a - o) by 40 u e f w. No point of the face is farther from o than
//! sqrt(3) W with W = w + e + f. So the way t |q| is off by at most
//!
//! ```text
//! (40 u e f w + 32 u e f sqrt(3) W) |q| / |n.q|  <=  100 u e f W |q| / |n.q|
//! ```
//!
//! and this is below 2^-24 if `|n.q| > 2^-22 e f W |q|`.
//!
//! # What the boxes have room for
//!
//! A vertex seen from o, projected along the ray, is off by at most 20 u W. The box is wider than the face by [`WIDER`] W = 64 u W here,
//! so no ray that meets the face is refused. W is below 2^26, where rays are traced by boxes: 64 u W is less than 4 * 2^-24, and
//! with the 2^-24 above less than what is left of a box's padding (`frame`): 9 * 7 of which 8 * 7 are needed, in 2^-24.

use glam::DVec3;

use crate::tile::UNDERFLOW;

/// 2^-22, derived above: 100 u / 2^-24.
const GRAZING: f64 = 1.0 / (1 << 22) as f64;

/// 64 u, derived above.
const WIDER: f64 = 1.0 / (1_u64 << 47) as f64;

/// Up to which |n.q| / |q| the t of a face may be off; `offset` is a - o.
#[inline(always)]
pub(super) fn doubtful_below([a, b, c]: [DVec3; 3], offset: DVec3) -> f64 {
    let largest = |v: DVec3| v.abs().max_element();
    let (e, f) = (largest(b - a), largest(c - a));
    GRAZING * (e * f) * (largest(offset) + e + f) + UNDERFLOW
}

/// `t`, moved into the part of the ray `origin` + t `direction` that lies in the box of these corners; NaN if no part does.
#[cold]
pub(super) fn moved_into_box(t: f64, [a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> f64 {
    let (low, high) = (a.min(b).min(c) - origin, a.max(b).max(c) - origin);
    let wider = WIDER * low.abs().max(high.abs()).max_element();
    let (mut entry, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..3 {
        let [from, to] = [low[k] - wider, high[k] + wider].map(|side| side / direction[k]);
        // 0 / 0: the ray stays on a side of the box.
        if !(from.is_nan() || to.is_nan()) {
            entry = entry.max(from.min(to));
            exit = exit.min(from.max(to));
        }
    }
    if entry <= exit { t.max(entry).min(exit) } else { f64::NAN }
}
