//! Unit tests of `shares`: sums and ratios against closed forms.

use raypencil_scene::{Beam, Sampling};

use super::*;

const PAPER: Beam = Beam {
    columns: 1024,
    rows: 4,
    thickness: 5e-3,
    grid_distance: 0.1,
    // 0.1 tan 30 degrees.
    half_width: 0.057_735_026_918_962_574,
    max_range: 20.0,
    power: 2.0,
    wavelength: 810e-9,
    profile: Profile::Paper,
};
const JITTERED: Sampling = Sampling::Jittered { seed: 5 };

fn total(beam: Beam, sampling: Sampling) -> f64 {
    let shares = PowerShares::new(PencilGrid::new(beam, 0, sampling));
    (0..beam.rows).flat_map(|j| (0..beam.columns).map(move |i| (i, j))).map(|(i, j)| shares.power(i, j)).sum()
}

#[test]
fn the_papers_shares_fall_short_of_the_laser_by_a_twentieth() {
    // The mean of cos(alpha) over tan(alpha) is ln(sec a + tan a) / tan a. At a = 30 degrees it is
    // ln(3 / sqrt 3) / (1 / sqrt 3) = (sqrt 3 / 2) ln 3 = 0.951426... The error of the midpoint sum over 1024
    // columns is h^2 / 24 times the difference of slopes, 1e-8.
    let expected = 2.0 * 0.5 * 3f64.sqrt() * libm::log(3.0);
    assert!((total(PAPER, Sampling::Centres) - expected).abs() < 1e-6);
    // Stratified draws have a standard deviation far below that of 4096 independent ones, 0.04 / 64.
    assert!((total(PAPER, JITTERED) - expected).abs() < 1e-4);
}

#[test]
fn the_other_profiles_add_up_to_the_laser() {
    for profile in [Profile::UniformAngle, Profile::Gaussian { half_width: 0.2 }] {
        for sampling in [Sampling::Centres, JITTERED] {
            // 4096 additions, each with an error of at most about 2^-52 of 2 W.
            assert!((total(Beam { profile, ..PAPER }, sampling) - 2.0).abs() < 2e-12);
        }
    }
}

#[test]
fn weights_follow_the_profile() {
    // Four columns at x = -3w/4, -w/4, w/4, 3w/4 with w = g tan 30 degrees = g / sqrt 3: the outer
    // pencils have tan(alpha) = 3/4 / sqrt 3, cos^2(alpha) = 1 / (1 + 3/16) = 16/19, the inner ones
    // tan(alpha) = 1/4 / sqrt 3, cos^2(alpha) = 1 / (1 + 1/48) = 48/49. The ratio is 784 / 912 = 49/57.
    let beam = Beam { columns: 4, rows: 1, ..PAPER };
    let ratio = |profile| {
        let shares = PowerShares::new(PencilGrid::new(Beam { profile, ..beam }, 0, Sampling::Centres));
        shares.power(0, 0) / shares.power(1, 0)
    };
    assert!((ratio(Profile::UniformAngle) - 49.0 / 57.0).abs() < 1e-15);
    assert!((ratio(Profile::Paper) - (49.0_f64 / 57.0).sqrt()).abs() < 1e-15);
    // 0.4086379^2 - 0.1433476^2 = 0.1669849 - 0.0205485 rad^2: times -2 / 0.4^2, exp(-1.8304548) = 0.1603407.
    let half_width = 0.4;
    let (outer, inner) = (libm::atan(0.75 / 3f64.sqrt()), libm::atan(0.25 / 3f64.sqrt()));
    let gaussian = libm::exp(-2.0 * (outer * outer - inner * inner) / 0.16);
    assert!((ratio(Profile::Gaussian { half_width }) - gaussian).abs() < 1e-15);
    assert!((gaussian - 0.160_340_7).abs() < 1e-7);
}

#[test]
fn a_beam_narrower_than_a_pencil_goes_to_the_innermost_ones() {
    // The innermost pencils have alpha = 5.6e-4 rad: exp(-2 (alpha / w)^2) = exp(-6e5), which is 0 in f64. They
    // still share the 2 W: two columns of four rows, 1/4 W each.
    let beam = Beam { profile: Profile::Gaussian { half_width: 1e-6 }, ..PAPER };
    let shares = PowerShares::new(PencilGrid::new(beam, 0, Sampling::Centres));
    assert!((shares.power(511, 2) - 0.25).abs() < 1e-9 && shares.power(510, 2) == 0.0);
}
