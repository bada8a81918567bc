//! Gauss-Legendre integration.

use raypencil_tests::quadrature::{gauss_legendre, over_rectangle};

#[test]
fn polynomials_are_integrated_exactly() {
    // Integral of x^n over [-1, 1]: 2 / (n + 1) for even n, 0 for odd.
    for count in 2..=40 {
        let rule = gauss_legendre(count);
        for n in 0..2 * count {
            let power = |x: f64| (0..n).fold(1.0, |product, _| product * x);
            let found: f64 = rule.iter().map(|[x, weight]| weight * power(*x)).sum();
            let derived = if n % 2 == 0 { 2.0 / (n as f64 + 1.0) } else { 0.0 };
            assert!((found - derived).abs() < 1e-14, "{count} nodes, degree {n}: {found}");
        }
    }
    // Integral of x^2 y over [0, 3] x [1, 2]: 9 * 3/2.
    let found = over_rectangle([[0.0, 3.0], [1.0, 2.0]], [2, 1], |x, y| x * x * y);
    assert!((found - 13.5).abs() < 1e-14);
}
