//! How the default vehicle stands: L = 1.2 m, T = 1 m, R = 0.35 m, w = 0.25 m.

use glam::{DVec2, DVec3};
use raypencil_chassis::{Chassis, Rest};

use super::shapes::{Shape, agree};

#[test]
fn on_a_plane_the_body_is_parallel_to_it() {
    // Slopes up to 30 degrees, eight ways up, eleven headings. All four wheels are equally high above the plane. With
    // the slopes m along and n across the heading, a hub is |n| w/2 + R sqrt(1 + m^2) above it; the body's plane is R
    // below the hubs along the normal, thus R sqrt(1 + m^2 + n^2) along z.
    let chassis = Chassis::default();
    let place = DVec2::new(0.3, -0.7);
    for slope in [0.0, 0.1, 0.3, 3.0_f64.sqrt() / 3.0] {
        for way in 0..8 {
            let (sin, cos) = libm::sincos(0.8 * f64::from(way));
            // Multiples of 2^-12, so that the corners of the plane are stored exactly.
            let [p, q] = [cos, sin].map(|part| (4096.0 * slope * part).round() / 4096.0);
            let ground = Shape::plane(0.0, p, q).ground();
            for turn in 0..11 {
                let heading = 0.6 * f64::from(turn);
                let rest = chassis.rest(&ground, place, heading).expect("ground");
                let (s, c) = libm::sincos(heading);
                let (m, n) = (p * c + q * s, q * c - p * s);
                let up = rest.pose().rotate(DVec3::Z);
                assert!((up - DVec3::new(-p, -q, 1.0).normalize()).length() < 1e-12, "{slope} {heading}");
                let above = 0.125 * n.abs() + 0.35 * ((1.0 + m * m).sqrt() - (1.0 + m * m + n * n).sqrt());
                let z = p * place.x + q * place.y + above;
                assert!((rest.position.z - z).abs() < 1e-12, "{slope} {heading}");
                assert_eq!((rest.position.truncate(), rest.heading), (place, heading));
                assert!(rest.residual < 2e-13);
            }
        }
    }
}

#[test]
fn a_block_under_one_wheel_pitches_and_rolls_a_quarter() {
    // h = 1/8 m under the front left wheel. Front hubs are h/2 higher on average than rear ones, left ones h/2 higher
    // than right ones, all hubs h/4 higher than on level ground: sin(pitch) = -h/2 / L, sin(roll) cos(pitch) = h/2 /
    // T, and the origin is R cos(roll) cos(pitch) below the hubs' mean.
    let ground = Shape::plane(0.0, 0.0, 0.0).stone((0.6, 0.5), (0.5, 0.25), 0.125).ground();
    let rest = Chassis::default().rest(&ground, DVec2::ZERO, 0.0).unwrap();
    let sin_pitch: f64 = -0.0625 / 1.2;
    let cos_pitch = (1.0 - sin_pitch * sin_pitch).sqrt();
    let sin_roll = 0.0625 / cos_pitch;
    let cos_roll = (1.0 - sin_roll * sin_roll).sqrt();
    assert!(agree(libm::sin(rest.pitch_down), sin_pitch) && agree(libm::sin(rest.roll_right), sin_roll));
    assert!(agree(rest.position.z, 0.03125 + 0.35 * (1.0 - cos_roll * cos_pitch)));
    // What the wheels touch: the block, and level ground.
    assert_eq!(rest.contacts.map(|contact| contact.hub_height), [0.475, 0.35, 0.35, 0.35]);
}

/// The stance on a step up towards +x, with the vehicle's origin at x.
fn on_step(height: f64, x: f64) -> Rest {
    Chassis::default().rest(&Shape::step(height).ground(), DVec2::new(x, 0.1), 0.0).expect("ground")
}

#[test]
fn on_a_low_step_every_stance_is_solved_and_follows_the_place() {
    // h = 0.2 m. Before the edge a hub's path is a circle around it; where the wheel leaves the level ground it is
    // steepest, with the slope d / (R - h) = sqrt(R^2 - (R - h)^2) / (R - h) = 0.316 / 0.15 = 2.11. The pitch is the
    // zero of front - rear + L sin(pitch). A turn moves a hub in plan by at most R + L/2 |sin| a radian, |sin| <= 0.2
    // / 1.2, so this grows by at least L cos - 2.11 (R + 0.1) = 1.18 - 0.95 = 0.23 m a radian: one solution. A motion
    // of 1e-6 m changes the heights by at most 2.11e-6 m, hence the pitch by 2.11e-6 / 0.23 < 1e-5. The origin's
    // height: half of one hub's change, which is 2.11 (1e-6 + 0.45 x 1e-5), and as much again for the turn: < 2e-5 m.
    for step in 0..220 {
        let x = -1.1 + 0.01 * f64::from(step);
        let (here, there) = (on_step(0.2, x), on_step(0.2, x + 1e-6));
        assert!(here.residual < 1e-12, "{x}: {here:?}");
        assert!((here.pitch_down - there.pitch_down).abs() < 1e-5, "{x}");
        assert!((here.position.z - there.position.z).abs() < 2e-5, "{x}");
        assert!(here.roll_right.abs() < 1e-12, "{x}");
        assert_eq!(here, on_step(0.2, x));
        // The hubs are where the pose has them: front and rear mean.
        let hub = |x: f64| (here.pose() * DVec3::new(x, 0.0, 0.35)).z;
        let mean = |a: usize, b: usize| 0.5 * (here.contacts[a].hub_height + here.contacts[b].hub_height);
        assert!((hub(0.6) - mean(0, 1)).abs() < 1e-12 && (hub(-0.6) - mean(2, 3)).abs() < 1e-12, "{x}");
    }
    // Both ways of leaving the step behind.
    assert!(on_step(0.2, -2.0).position.z.abs() < 1e-12);
    assert!((on_step(0.2, 2.0).position.z - f64::from(0.2_f32)).abs() < 1e-12);
}

#[test]
fn front_wheels_on_a_step_almost_as_high_as_the_hub_are_solved() {
    // h = 0.3 m: where a front wheel leaves the level ground its hub's path has the slope 0.346 / 0.05 = 6.9. If the
    // nose goes up, the hub goes back by R a radian and down by 6.9 R: 2.4 m, twice the L = 1.2 m of the axle.
    // Fixed-point steps swing between two attitudes. But front - rear + L sin(pitch) grows by L cos + 6.9 (R - 0.15) >
    // 1.1 + 1.3 m a radian there: there is one solution, and 1e-6 m of motion turns it by less than 6.9e-6 / 2.4 rad.
    for step in 0..120 {
        let x = -1.1 + 0.007 * f64::from(step);
        let (here, there) = (on_step(0.3, x), on_step(0.3, x + 1e-6));
        assert!(here.residual < 1e-12, "{x}: {here:?}");
        assert!((here.pitch_down - there.pitch_down).abs() < 3e-6, "{x}");
        assert_eq!(here, on_step(0.3, x));
    }
}

#[test]
fn before_a_wall_the_search_ends_and_says_what_it_misses() {
    // h = 1 m: when a hub comes within R of the wall, its height jumps from 0.35 m to 1 m. The pitch that fits lies in
    // the jump for some places: the front end rears up, its hub goes back from the wall, and comes down again. Every
    // search ends; the residual there is a share of the jump, at least 1 mm at the worst of these places.
    let places = (0..300).map(|step| -1.5 + 0.01 * f64::from(step));
    let stances: Vec<Rest> = places.clone().map(|x| on_step(1.0, x)).collect();
    assert!(stances.iter().all(|rest| rest.pitch_down.abs() < 1.6 && rest.residual < 0.65));
    assert!(stances.iter().any(|rest| rest.residual > 1e-3));
    // Where nothing jumps it is solved: on level ground on both sides.
    assert!(stances[0].residual < 1e-12 && stances[299].residual < 1e-12);
    for (x, rest) in places.zip(&stances) {
        assert_eq!(*rest, on_step(1.0, x));
    }
}

#[test]
fn oblique_steps_are_solved_too() {
    // Heading 0.5: one wheel after the other climbs 0.2 m.
    let ground = Shape::step(0.2).ground();
    for step in 0..150 {
        let place = DVec2::new(-1.2 + 0.016 * f64::from(step), 0.0);
        let rest = Chassis::default().rest(&ground, place, 0.5).unwrap();
        assert!(rest.residual < 1e-12, "{place}: {rest:?}");
    }
}

#[test]
fn without_ground_below_a_wheel_there_is_no_stance() {
    let ground = Shape::plane(0.0, 0.0, 0.0).ground();
    let rest = |x| Chassis::default().rest(&ground, DVec2::new(x, 0.0), 0.0);
    // The ground ends at 16 m; the front hubs are 0.6 m ahead, and their rims 0.35 m more.
    assert!(rest(15.3).is_some() && rest(15.8).is_none() && rest(f64::NAN).is_none());
}
