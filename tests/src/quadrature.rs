//! Gauss-Legendre quadrature, for reference values that a test integrates by itself.

use std::f64::consts::PI;

/// Nodes and weights of the rule with `count` nodes on [-1, 1]. It is exact for polynomials of degree 2 count - 1.
///
/// The nodes are found by Newton's method on the Legendre polynomial, from the usual guess
/// cos(pi (k + 3/4) / (count + 1/2)).
///
/// ```
/// // The integral of x^2 over [-1, 1] is 2/3. Two nodes are exact up to degree 3.
/// let sum: f64 = raypencil_tests::quadrature::gauss_legendre(2).iter().map(|[x, weight]| weight * x * x).sum();
/// assert!((sum - 2.0 / 3.0).abs() < 1e-15);
/// ```
pub fn gauss_legendre(count: usize) -> Vec<[f64; 2]> {
    let degree = count as f64;
    let rule = (0..count).map(|k| {
        let mut x = libm::cos(PI * (k as f64 + 0.75) / (degree + 0.5));
        let mut slope = 1.0;
        // From that guess five steps suffice; further steps change nothing.
        for _ in 0..10 {
            let (mut before, mut value) = (1.0, x);
            for n in 2..=count {
                let n = n as f64;
                (before, value) = (value, ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n);
            }
            slope = degree * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        [x, 2.0 / ((1.0 - x * x) * slope * slope)]
    });
    rule.collect()
}

/// The integral of `f` over [a, b] x [c, d], by `nodes[0]` times `nodes[1]` nodes.
pub fn over_rectangle(
    [[a, b], [c, d]]: [[f64; 2]; 2],
    nodes: [usize; 2],
    f: impl Fn(f64, f64) -> f64,
) -> f64 {
    let [across, down] = nodes.map(gauss_legendre);
    let (half_width, half_height) = (0.5 * (b - a), 0.5 * (d - c));
    let mut sum = 0.0;
    for [v, weight_v] in down {
        let y = 0.5 * (c + d) + half_height * v;
        let row: f64 = across.iter().map(|[u, w]| w * f(0.5 * (a + b) + half_width * u, y)).sum();
        sum += weight_v * row;
    }
    sum * half_width * half_height
}
