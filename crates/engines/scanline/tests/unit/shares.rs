//! Unit tests of `shares`: sums and single shares against closed forms.

use raypencil_scene::Pose;

use super::*;

fn beam(columns: u32, rows: u32, profile: Profile) -> Beam {
    let (g, fan) = (0.1, 60_f64.to_radians());
    Beam {
        columns,
        rows,
        thickness: 5e-3,
        grid_distance: g,
        half_width: Beam::half_width_of(g, fan),
        max_range: 20.0,
        power: 3.0,
        wavelength: 810e-9,
        profile,
    }
}

fn sum(beam: &Beam) -> f64 {
    let shares = ColumnShares::new(beam);
    (0..beam.rows).flat_map(|_| &shares.watts).sum::<f64>() / beam.power
}

#[test]
fn the_papers_shares_fall_short_of_the_whole() {
    // The sum is the mean of cos(alpha) over the grid: the midpoint rule for the mean of 1 / sqrt(1 + u^2) over
    // |u| < tan(a). Its limit is asinh(tan a) / tan a = ln(sec a + tan a) / tan a = 0.549306 / 0.577350 = 0.951426
    // at 30 degrees. The midpoint rule exceeds the limit by h^2/24 (f'(-b) - f'(b)) / (2b), f' = -u / (1 + u^2)^(3/2),
    // which is h^2/24 cos^3(a) with h = 2 tan(a) / columns: 0.6495 (4/3) / 24 / columns^2 = 0.0361 / columns^2. That is
    // 1.4e-4 for 16 columns and 3.4e-8 for 1024.
    let limit = 3_f64.sqrt() * libm::log(3_f64.sqrt());
    assert!((limit - 0.951_426).abs() < 5e-7);
    let fine = sum(&beam(1024, 16, Profile::Paper));
    assert!((fine - 0.951_426_2).abs() < 5e-8 && (fine - limit - 3.4e-8).abs() < 1e-9, "{fine}");
    let coarse = sum(&beam(16, 4, Profile::Paper));
    assert!((coarse - 0.951_57).abs() < 5e-6 && (coarse - limit - 1.41e-4).abs() < 1e-6, "{coarse}");
}

#[test]
fn the_other_profiles_add_up_to_the_whole() {
    for profile in [Profile::UniformAngle, Profile::Gaussian { half_width: 0.3 }] {
        for columns in [1, 2, 16, 1023] {
            assert!((sum(&beam(columns, 7, profile)) - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn four_columns_by_hand() {
    // x / g = t (-3, -1, 1, 3) / 4 with t = tan 30 = 1/sqrt(3): (x/g)^2 = 3/16 and 1/48, cos^2(alpha) = 16/19 and
    // 48/49. Two rows of 3 W.
    let (outer, inner) = (16.0 / 19.0, 48.0 / 49.0);
    let close = |a: &[f64], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
    let cosines = [outer, inner, inner, outer].map(|squared: f64| 3.0 * squared.sqrt() / 8.0);
    assert!(close(&ColumnShares::new(&beam(4, 2, Profile::Paper)).watts, cosines));
    let of_sum = [outer, inner, inner, outer].map(|weight| 3.0 * weight / (4.0 * (outer + inner)));
    assert!(close(&ColumnShares::new(&beam(4, 2, Profile::UniformAngle)).watts, of_sum));
    // tan(alpha) = sqrt(3)/4 and sqrt(3)/12: alpha = 0.408638 and 0.143348 rad; with w = 0.2 rad exp(-2 (alpha/w)^2)
    // = exp(-8.34925) and exp(-1.02743): 2.3654e-4 and 0.357926.
    let (outer, inner) = (2.3654e-4, 0.357_926);
    let of_sum = [outer, inner, inner, outer].map(|weight: f64| 3.0 * weight / (4.0 * (outer + inner)));
    let gaussian = ColumnShares::new(&beam(4, 2, Profile::Gaussian { half_width: 0.2 }));
    for (share, expected) in gaussian.watts.iter().zip(of_sum) {
        assert!((share / expected - 1.0).abs() < 1e-3, "{share} {expected}");
    }
}

#[test]
fn a_beam_narrower_than_its_pencils_keeps_its_power() {
    // All exponentials of the definition are 0 in f64: exp(-2 (0.14 / 1e-6)^2).
    let narrow = beam(4, 1, Profile::Gaussian { half_width: 1e-6 });
    assert_eq!(ColumnShares::new(&narrow).watts, [0.0, 1.5, 1.5, 0.0]);
}

#[test]
fn shares_serve_the_beams_that_they_were_made_for_in_their_order() {
    let at = |beam: &Beam| Mounted { scene_from_sensor: Pose::IDENTITY, sensor: *beam };
    let [one, other] = [4, 8].map(|columns| beam(columns, 2, Profile::Paper));
    let shares = [one, other].map(|beam| ColumnShares::new(&beam));
    assert!(ColumnShares::fit(&shares, &[at(&one), at(&other)]));
    assert!(!ColumnShares::fit(&shares, &[at(&other), at(&one)]));
    assert!(!ColumnShares::fit(&shares, &[at(&one)]));
    assert!(!ColumnShares::fit(&shares[..1], &[at(&one), at(&other)]));
}
