//! Smaller sensors that have exactly the same ray: the same rational function of their stored numbers.

use raypencil_scene::{Beam, Camera};

/// The camera of the image's part of `width x height` pixels from `(left, top)` on. `None`: its principal point would
/// be rounded, which would change its rays.
///
/// A ray depends on (i + 1/2 - c_x) p_x, which is the same for i - left and c_x - left.
pub(crate) fn cropped(camera: &Camera, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> Option<Camera> {
    let [x, y] = camera.principal_point;
    let principal_point = [difference(x, f64::from(left))?, difference(y, f64::from(top))?];
    Some(Camera { width, height, principal_point, ..*camera })
}

/// `a - b`, if it is exact. (D. Knuth's two-sum: its rounding error is a double)
fn difference(a: f64, b: f64) -> Option<f64> {
    let difference = a - b;
    let b_virtual = a - difference;
    let a_virtual = difference + b_virtual;
    let error = (a - a_virtual) + (b_virtual - b);
    (error == 0.0).then_some(difference)
}

/// A cell on one axis of a beam's grid of `count` cells over `extent` (w across, T down).
///
/// The middle of cell `index` is at extent (2 index + 1 - count) / count across, and at half of that down.
#[derive(Debug, Clone, Copy, PartialEq)]
struct AxisCell {
    extent: f64,
    count: u32,
    index: u32,
}

impl AxisCell {
    /// A cell with exactly the same middle: the only cell of its axis, or else the outer one of two. `None`: the extent
    /// would be rounded.
    fn fewest(self) -> Option<Self> {
        let Self { extent, count, index } = self;
        let k = 2 * i64::from(index) + 1 - i64::from(count);
        if k == 0 {
            return Some(Self { extent, count: 1, index: 0 });
        }
        // extent' / 2 = extent |k| / count.
        let extent = ratio(extent, 2 * k.unsigned_abs(), u64::from(count))?;
        Some(Self { extent, count: 2, index: u32::from(k > 0) })
    }

    /// A cell with exactly the same middle and extent. The count is divided by the greatest common divisor of
    /// 2 index + 1 and the count.
    fn fewer(self) -> Self {
        let Self { extent, count, index } = self;
        let divisor = gcd(2 * index + 1, count);
        Self { extent, count: count / divisor, index: ((2 * index + 1) / divisor - 1) / 2 }
    }
}

/// Beams of fewer pencils that have the ray of pencil `[i, j]` of this beam, with the pencil's cell in each. The beam
/// of the fewest pencils comes first.
pub(crate) fn narrowed(beam: &Beam, [i, j]: [u32; 2]) -> Vec<(Beam, [u32; 2])> {
    let across = AxisCell { extent: beam.half_width, count: beam.columns, index: i };
    let down = AxisCell { extent: beam.thickness, count: beam.rows, index: j };
    let [across, down] =
        [across, down].map(|cells| [cells.fewest(), Some(cells.fewer()), Some(cells)].into_iter().flatten());
    let mut found: Vec<(Beam, [u32; 2])> = Vec::new();
    for x in across {
        for y in down.clone() {
            let (half_width, thickness) = (x.extent, y.extent);
            let beam = Beam { columns: x.count, rows: y.count, half_width, thickness, ..*beam };
            found.push((beam, [x.index, y.index]));
        }
    }
    found.sort_by_key(|(beam, _)| u64::from(beam.columns) * u64::from(beam.rows));
    found
}

/// `x p / q`, if it is a double. p and q are below 2^32, x is finite and positive.
fn ratio(x: f64, p: u64, q: u64) -> Option<f64> {
    let (mantissa, exponent) = libm::frexp(x);
    // 53 bits times 32 bits fit into 128 bits.
    let product = u128::from((mantissa * (1_u64 << 53) as f64) as u64) * u128::from(p);
    let twos = q.trailing_zeros();
    let odd = u128::from(q >> twos);
    let quotient = product / odd;
    if quotient * odd != product || quotient == 0 {
        return None;
    }
    let zeros = quotient.trailing_zeros();
    let digits = quotient >> zeros;
    let exponent = exponent - 53 + zeros as i32 - twos as i32;
    (digits < 1 << 53).then(|| libm::ldexp(digits as f64, exponent))
}

/// Greatest common divisor.
fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_principal_point_is_moved_only_if_that_is_exact() {
        // 0.3 has 54 binary places, and -999.7 room for 43 of them.
        assert_eq!(difference(31.3, 31.0).map(|rest| rest + 31.0), Some(31.3));
        assert_eq!(difference(0.3, 1000.0), None);
        assert_eq!(difference(0.25, 1000.0), Some(-999.75));
        assert_eq!(difference(7.0, 0.0), Some(7.0));
    }

    #[test]
    fn a_ratio_is_exact_or_none() {
        assert_eq!(ratio(0.75, 10, 4), Some(1.875));
        assert_eq!(ratio(0.75, 2, 3), Some(0.5));
        assert_eq!(ratio(0.25, 2, 3), None);
        // 0.1 has 53 digits: three times as much has 55.
        assert_eq!(ratio(0.1, 3, 1), None);
        assert_eq!(ratio(0.1, 4, 64), Some(0.1 / 16.0));
    }

    #[test]
    fn a_smaller_grid_has_the_same_middle() {
        let middle = |cells: AxisCell| {
            cells.extent * (2.0 * f64::from(cells.index) + 1.0 - f64::from(cells.count))
                / f64::from(cells.count)
        };
        // Cell 5 of 16 over a half width of 1: -5/16; cell 4 of 9 is the middle one; cell 2 of 15: 5/15 across.
        for (count, index, fewest, fewer) in [(16, 5, Some(2), 16), (9, 4, Some(1), 1), (15, 2, None, 3)] {
            let cells = AxisCell { extent: 1.0, count, index };
            assert_eq!(cells.fewest().map(|cells| cells.count), fewest, "{count} {index}");
            assert_eq!(cells.fewer().count, fewer, "{count} {index}");
            for smaller in [cells.fewest(), Some(cells.fewer())].into_iter().flatten() {
                assert_eq!(middle(smaller), middle(cells), "{smaller:?}");
            }
        }
    }
}
