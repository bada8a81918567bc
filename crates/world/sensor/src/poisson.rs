//! Random numbers of Poisson's law: electrons, given their expectation.

use crate::NoiseStream;

/// Mean below which inversion is used: the search takes a few steps.
const MAX_INVERSION_MEAN: f64 = 10.0;
/// Mean up to which rejection is used: the law is exact but for rounding. Beyond, k ln(mean) - ln(k!) has lost so
/// many digits that the normal law is closer.
const MAX_REJECTION_MEAN: f64 = 1e8;

/// Random number of Poisson's law, a whole one; 0 if `mean` is not positive.
///
/// * Below a mean of 10: inversion, by searching upwards.
/// * Up to 1e8: PTRS (W. Hoermann, "The transformed rejection method for generating Poisson random variables",
///   Insurance: Mathematics and Economics 12, 1993). ln(k!) is good to 2 ulp, so the logarithm of the acceptance
///   probability is off by 4e-16 mean ln(mean), 7e-7 at most.
/// * Beyond: the normal law, rounded to a whole number. Its distribution function is off by up to max |(x^2 - 1)
///   phi(x)| / (6 sqrt(mean)) = 0.0665 / sqrt(mean), 7e-6 at most (Edgeworth's first term, the skewness).
pub fn poisson(mean: f64, stream: &mut NoiseStream) -> f64 {
    if mean < MAX_INVERSION_MEAN {
        inversion(mean, stream)
    } else if mean <= MAX_REJECTION_MEAN {
        transformed_rejection(mean, stream)
    } else {
        (mean + mean.sqrt() * stream.normal()).round().max(0.0)
    }
}

fn inversion(mean: f64, stream: &mut NoiseStream) -> f64 {
    if !(mean > 0.0) {
        return 0.0;
    }
    let mut left = stream.uniform();
    let mut probability = libm::exp(-mean);
    let mut k = 0.0;
    // The probabilities vanish long before k = 200; later only rounding errors are left over.
    while left > probability && k < 200.0 {
        left -= probability;
        k += 1.0;
        probability *= mean / k;
    }
    k
}

fn transformed_rejection(mean: f64, stream: &mut NoiseStream) -> f64 {
    // The constants of algorithm PTRS.
    let b = 0.931 + 2.53 * mean.sqrt();
    let a = -0.059 + 0.024_83 * b;
    let inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    let v_r = 0.9277 - 3.6224 / (b - 2.0);
    let log_mean = libm::log(mean);
    loop {
        let u = stream.uniform() - 0.5;
        let v = stream.uniform();
        let u_s = 0.5 - u.abs();
        let k = ((2.0 * a / u_s + b) * u + mean + 0.43).floor();
        // Nine of ten draws end here. (Step 1)
        if u_s >= 0.07 && v <= v_r {
            return k;
        }
        if k < 0.0 || (u_s < 0.013 && v > u_s) {
            continue;
        }
        let chance = libm::log(v * inverse_alpha / (a / (u_s * u_s) + b));
        if chance <= k * log_mean - mean - libm::lgamma(k + 1.0) {
            return k;
        }
    }
}
