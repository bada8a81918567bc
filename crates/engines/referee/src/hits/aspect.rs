//! The aspect of a triangle, on which the rounding of its normal depends.

use std::cmp::Ordering;

use dashu_int::Sign;
use glam::DVec3;

use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::root;
use crate::numbers::vector::Vector;

/// kappa of a triangle: the product of its two longest edges over |n|, twice its area. It is at least 1, and infinite or not
/// a number for a triangle without area.
///
/// A program forms n = e1 x e2 from the two edges at one corner, with an error of a few roundings of |e1| |e2|. Which corner
/// it takes is its own affair: the first of the face, or the lowest of the three. So kappa is that of the worst corner.
///
/// ```
/// use glam::DVec3;
/// // Edges of 3, 4 and 5 m; |n| = 12 m^2.
/// let triangle = [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
/// assert_eq!(raypencil_referee::aspect(triangle), 20.0 / 12.0);
/// ```
pub fn aspect([a, b, c]: [DVec3; 3]) -> f64 {
    let [ab, bc, ca] = [b - a, c - b, a - c].map(DVec3::length);
    let product = (ab * bc).max(bc * ca).max(ca * ab);
    let normal = (b - a).cross(c - a).length();
    if is_in_range(product) && normal >= LEAST_SHARE * product {
        return product / normal;
    }
    exact_aspect([a, b, c]).unwrap_or(product / 0.0)
}

/// A normal that is shorter than this share of the product of its edges is formed exactly. f64 forms it with an error of a few units
/// of 2^-53 of that product, so the normals above it are good to nine digits.
pub(crate) const LEAST_SHARE: f64 = 1.0 / (1 << 20) as f64;

/// Whether products and squares of numbers of this size neither leave f64 nor lose digits.
pub(crate) fn is_in_range(product: f64) -> bool {
    (1e-140..=1e140).contains(&product)
}

/// The square of the product of the two longest edges, and the normal n, of which the direction may be reversed.
pub(crate) fn exact_parts(corners: [DVec3; 3]) -> (Dyadic, Vector<Dyadic>) {
    let [a, b, c] = corners.map(Vector::<Dyadic>::of);
    let edges = [b.sub(&a), c.sub(&b), a.sub(&c)];
    let squares = [0, 1, 2].map(|k: usize| edges[k].length_squared());
    let products = [0, 1, 2].map(|k: usize| squares[k].mul(&squares[(k + 1) % 3]));
    let larger = |one: Dyadic, other: Dyadic| match other.sub(&one).sign() {
        Some(Ordering::Greater) => other,
        _ => one,
    };
    let [first, second, third] = products;
    (larger(larger(first, second), third), edges[0].cross(&edges[1]))
}

/// The aspect, rounded once, at the end; `None` without an area.
fn exact_aspect(corners: [DVec3; 3]) -> Option<f64> {
    let (product, normal) = exact_parts(corners);
    let normal = normal.length_squared();
    (normal.sign() != Some(Ordering::Equal)).then(|| root(Sign::Positive, &product, &normal).double)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_aspect_is_that_of_the_triangle_wherever_its_corners_begin() {
        let [a, b, c] = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(9.0, 2.0, 3.0), DVec3::new(1.5, 2.0, 3.25)];
        let kappa = aspect([a, b, c]);
        // |n| = 8 (1/4) = 2; the edges are 8, sqrt(56.3125) and sqrt(0.3125).
        assert!((kappa - 8.0 * 56.3125_f64.sqrt() / 2.0).abs() < 1e-12, "{kappa}");
        assert_eq!([aspect([b, c, a]), aspect([c, a, b]), aspect([a, c, b])], [kappa; 3]);
    }

    #[test]
    fn the_aspect_of_a_needle_is_exact_where_f64_makes_its_normal_0() {
        // Corners on a line but for 2^-54 of the last one: |n| = 2^-54 sqrt(2), and the two longest edges are 4 sqrt(2) and 3 sqrt(2)
        // to sixteen digits.
        let tiny = libm::scalbn(1.0, -54);
        let needle = [DVec3::ZERO, DVec3::new(4.0, 4.0, 0.0), DVec3::new(1.0, 1.0, tiny)];
        let kappa = aspect(needle);
        // n = (4 tiny, -4 tiny, 0).
        let expected = 24.0 / (4.0 * core::f64::consts::SQRT_2 * tiny);
        assert!((kappa / expected - 1.0).abs() < 1e-12, "{kappa:e}, {expected:e}");
        // Corners at (0.1, 0.1) and (0.3, 0.3 + ulp), seen from the origin: n = 0.1 ulp.
        let bent = [DVec3::ZERO, DVec3::new(0.1, 0.1, 0.0), DVec3::new(0.3, 0.3_f64.next_up(), 0.0)];
        let ulp = 0.3_f64.next_up() - 0.3;
        assert_eq!((bent[1] - bent[0]).cross(bent[2] - bent[0]).z, 0.1 * (0.3 + ulp) - 0.1 * 0.3);
        let expected = 0.3 * 0.2 * 2.0 / (0.1 * ulp);
        assert!((aspect(bent) / expected - 1.0).abs() < 1e-3, "{:e}, {expected:e}", aspect(bent));
    }

    #[test]
    fn the_aspect_does_not_depend_on_the_unit() {
        let [a, b] = [DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
        for unit in [1e-200, 1e-160, 1e-75, 1.0, 1e75, 1e160] {
            let kappa = aspect([DVec3::ZERO, unit * a, unit * b]);
            assert!((kappa - 20.0 / 12.0).abs() < 1e-12, "{unit:e}: {kappa}");
        }
    }

    #[test]
    fn a_triangle_without_area_has_no_finite_aspect() {
        let [a, b] = [DVec3::ZERO, DVec3::X];
        assert_eq!(aspect([a, b, 2.0 * b]), f64::INFINITY);
        assert!(aspect([a; 3]).is_nan());
    }
}
