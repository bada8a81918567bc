//! The aspect of a triangle, on which the rounding of its normal depends.

use glam::DVec3;

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
    (ab * bc).max(bc * ca).max(ca * ab) / (b - a).cross(c - a).length()
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
    fn a_triangle_without_area_has_no_finite_aspect() {
        let [a, b] = [DVec3::ZERO, DVec3::X];
        assert_eq!(aspect([a, b, 2.0 * b]), f64::INFINITY);
        assert!(aspect([a; 3]).is_nan());
    }
}
