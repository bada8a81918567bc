//! Area of the intersection of a disc and a rectangle, in closed form.

/// Area of the part of the unit disc about (0, 0) within `[x0, x1] x [y0, y1]`. The areas of cells that fill a
/// rectangle add up to the area of the rectangle, but for rounding.
pub(crate) fn area(x0: f64, x1: f64, y0: f64, y1: f64) -> f64 {
    (corner(x1, y1) - corner(x0, y1)) - (corner(x1, y0) - corner(x0, y0))
}

/// Signed area of the part of the disc between the axes and the corner (x, y): odd in x and in y.
fn corner(x: f64, y: f64) -> f64 {
    // Coordinates beyond the disc add nothing, infinite ones included.
    let (a, b) = (x.abs().min(1.0), y.abs().min(1.0));
    // Up to this x the circle is above y = b.
    let under = (1.0 - b * b).sqrt();
    let quarter = if a <= under { a * b } else { under * b + segment(a) - segment(under) };
    if (x < 0.0) == (y < 0.0) { quarter } else { -quarter }
}

/// Integral of sqrt(1 - u^2) from 0 to x, x in [0, 1].
fn segment(x: f64) -> f64 {
    0.5 * (x * (1.0 - x * x).sqrt() + libm::asin(x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn known_parts_of_a_disc() {
        let all = f64::INFINITY;
        assert!((area(-all, all, -all, all) - PI).abs() < 1e-15);
        assert!((area(0.0, all, 0.0, all) - PI / 4.0).abs() < 1e-15);
        assert!((area(-2.0, 0.0, -3.0, 5.0) - PI / 2.0).abs() < 1e-15);
        // A square within the disc, and one that lies outside near the diagonal.
        assert!((area(-0.5, 0.5, 0.1, 0.6) - 0.5).abs() < 1e-15);
        assert!(area(0.8, 1.0, 0.8, 1.0).abs() < 1e-15);
        // A segment beyond x = 1/2: acos(1/2) - 1/2 sqrt(3/4).
        let expected = libm::acos(0.5) - 0.5 * 0.75_f64.sqrt();
        assert!((area(0.5, 1.0, -1.0, 1.0) - expected).abs() < 1e-15);
    }

    #[test]
    fn a_cell_on_the_edge_is_what_counting_points_gives() {
        // 1000 x 1000 points of a cell. Some 2000 points on the arc, 1e-6 of the cell each, are uncertain, with
        // both signs.
        let (x0, x1, y0, y1) = (0.55, 0.85, -0.8, -0.4);
        let inside = (0..1000)
            .flat_map(|i| (0..1000).map(move |j| (f64::from(i), f64::from(j))))
            .filter(|(i, j)| {
                let (x, y) = (x0 + (x1 - x0) * (i + 0.5) / 1000.0, y0 + (y1 - y0) * (j + 0.5) / 1000.0);
                x * x + y * y < 1.0
            })
            .count();
        let counted = inside as f64 * 1e-6 * (x1 - x0) * (y1 - y0);
        assert!((area(x0, x1, y0, y1) - counted).abs() < 2e-4 * counted);
    }
}
