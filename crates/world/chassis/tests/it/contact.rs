//! Contacts of one wheel, R = 0.35 m and w = 0.25 m unless said otherwise.

use glam::{DVec2, DVec3};
use raypencil_chassis::{Chassis, WheelContact};

use super::shapes::{Shape, agree};

const R: f64 = 0.35;

/// Contact of the default wheel, rolling towards +x.
fn at(shape: &Shape, x: f64, y: f64) -> WheelContact {
    Chassis::default().contact(&shape.ground(), DVec2::new(x, y), DVec2::X).expect("ground")
}

#[test]
fn a_plane_touches_uphill_on_its_higher_side() {
    // z = 1 + x / 4 - y / 8, rolling at several headings. With the slopes m along and n across, the wheel touches at
    // a = R m / sqrt(1 + m^2) on the side b = w/2 sign n, and its hub is |n| w/2 + R sqrt(1 + m^2) above the plane.
    let gradient = DVec2::new(0.25, -0.125);
    let ground = Shape::plane(1.0, gradient.x, gradient.y).ground();
    let hub = DVec2::new(0.7, -1.3);
    for (x, y) in [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8), (-0.8, 0.6), (-0.6, -0.8), (0.28, -0.96)] {
        let forward = DVec2::new(x, y);
        let (m, n) = (gradient.dot(forward), gradient.dot(forward.perp()));
        let root = (1.0 + m * m).sqrt();
        let contact = Chassis::default().contact(&ground, hub, forward).unwrap();
        let plane = |plan: DVec2| 1.0 + gradient.dot(plan);
        assert!(agree(contact.hub_height, plane(hub) + 0.125 * n.abs() + R * root), "{forward}");
        let plan = hub + forward * (R * m / root) + forward.perp() * (0.125 * n.signum());
        assert!((contact.point - plan.extend(plane(plan))).length() < 1e-13, "{forward}");
    }
}

#[test]
fn ground_that_is_level_across_touches_below_the_middle_of_the_wheel() {
    // The slope x / 4 carries the wheel along a whole line; the nearest point to the hub is on the wheel's middle.
    let m: f64 = 0.25;
    let contact = at(&Shape::plane(0.0, m, 0.0), 1.0, 0.25);
    assert!(contact.point.y == 0.25 && agree(contact.point.x, 1.0 + R * m / (1.0 + m * m).sqrt()));
    // Also if that line begins in a corner of the face, here below the hub.
    let corner = |x, y| DVec3::new(x, y, m * x);
    let [a, b, c] = [corner(8.0, -8.0), corner(8.0, 8.0), corner(-8.0, 0.0)];
    let fan = [[a, b], [b, c], [c, a]];
    let fan = fan.iter().fold(Shape::default(), |shape, [a, b]| shape.triangle([DVec3::ZERO, *a, *b]));
    assert_eq!(at(&fan, 0.0, 0.0).point.y, 0.0);
}

#[test]
fn a_ridge_is_touched_on_its_crest_or_on_its_flank() {
    // z = 1 - |x| / 4. On the flank the point of contact is 0.35 / 4 / sqrt(17/16) = 0.0849 m uphill of the hub: a hub
    // that is nearer to the crest than this rests on the crest.
    let ridge = Shape::profile(&[(-4.0, 0.0), (0.0, 1.0), (4.0, 0.0)]);
    assert!(agree(at(&ridge, 0.0, 0.0).hub_height, 1.0 + R));
    for x in [-0.05, 0.05, 0.08] {
        let contact = at(&ridge, x, 0.0);
        assert!(agree(contact.hub_height, 1.0 + (R * R - x * x).sqrt()), "{x}");
        assert!((contact.point - DVec3::Z).length() < 1e-13, "{x}");
    }
    for x in [-0.2_f64, 0.09] {
        let flank = 1.0 - 0.25 * x.abs() + R * (17.0_f64 / 16.0).sqrt();
        assert!(agree(at(&ridge, x, 0.0).hub_height, flank), "{x}");
    }
    // Rolling along the crest, which is 1/16 m beside the middle of the wheel.
    let along = Chassis::default().contact(&ridge.ground(), DVec2::new(0.0625, 0.0), DVec2::Y).unwrap();
    assert!(agree(along.hub_height, 1.0 + R) && agree(along.point.x, 0.0));
}

#[test]
fn a_spike_counts_only_below_the_wheel() {
    // Spikes of 1/2 m, ridges 1/32 m long. The wheel's side is at b = 1/8.
    let with = |x, y| Shape::plane(0.0, 0.0, 0.0).spike((x, y), 1.0 / 32.0, 0.5);
    // Below the wheel, 1/8 m ahead of the hub.
    let ahead = (R * R - 1.0 / 64.0).sqrt();
    assert!(agree(at(&with(0.125, 0.09375), 0.0, 0.0).hub_height, 0.5 + ahead));
    // Beside the wheel.
    assert_eq!(at(&with(0.125, 0.1875), 0.0, 0.0).hub_height, R);
    // Its tip is 1/64 m beside the wheel: half of the height remains at the wheel's side, right beside the hub.
    let contact = at(&with(0.0, 0.140_625), 0.0, 0.0);
    assert!(agree(contact.hub_height, 0.25 + R));
    assert!((contact.point - DVec3::new(0.0, 0.125, 0.25)).length() < 1e-13);
    // Its tip is 0.359375 m ahead, out of reach; its flank of slope m = 16 touches where the rim is as steep:
    // z(0) + R sqrt(1 + m^2) = 0.5 - 16 x 0.359375 + 0.35 sqrt(257) = 0.3609 m, 1 cm above level ground.
    let flank = 0.5 - 16.0 * 0.359_375 + R * 257.0_f64.sqrt();
    assert!(agree(at(&with(0.359_375, 0.0), 0.0, 0.0).hub_height, flank));
}

#[test]
fn a_step_is_touched_before_the_axle_is_above_it() {
    // h = 1/4 m. At the distance d before it the wheel rests on the edge if h + sqrt(R^2 - d^2) > R, so up to
    // d = sqrt(R^2 - (R - h)^2) = 0.3354 m.
    let step = Shape::step(0.25);
    for d in [0.5, 0.351, 0.336] {
        let contact = at(&step, -d, 0.0);
        assert!(contact.hub_height == R && agree(contact.point.x, -d), "{d}");
    }
    for d in [0.335, 0.3, 0.125, 0.01] {
        let contact = at(&step, -d, 0.0);
        assert!(agree(contact.hub_height, 0.25 + (R * R - d * d).sqrt()), "{d}");
        assert!((contact.point - DVec3::new(0.0, 0.0, 0.25)).length() < 1e-13, "{d}");
    }
    assert!(agree(at(&step, 0.5, 0.0).hub_height, 0.25 + R));
}

#[test]
fn a_wall_as_high_as_the_hub_is_touched_one_radius_before() {
    // R = 1/2 m, a wall of 3/4 m: the rectangle is closed, so the wall counts at a = R exactly, with its own height.
    let chassis = Chassis { wheel_radius: 0.5, ..Chassis::default() };
    let ground = Shape::step(0.75).ground();
    let hub = |x| chassis.contact(&ground, DVec2::new(x, 0.0), DVec2::X).unwrap().hub_height;
    assert_eq!(hub(-0.5), 0.75);
    assert_eq!(hub(-0.500_001), 0.5);
}

#[test]
fn a_disc_bridges_a_groove_and_sinks_by_its_sagitta() {
    // Width g = 1/4 m, 1 m deep. The rims are g/2 from the middle: the hub is at sqrt(R^2 - (g/2)^2). If the hub is
    // beside the middle, it rests on the nearer rim.
    let groove = Shape::trench(0.25, 1.0);
    for aside in [0.0, 0.05, -0.1] {
        let rim: f64 = 0.125 - f64::abs(aside);
        let contact = at(&groove, aside, 0.0);
        assert!(agree(contact.hub_height, (R * R - rim * rim).sqrt()), "{aside}");
        assert!(agree(contact.point.z, 0.0) && agree(contact.point.x.abs(), 0.125), "{aside}");
    }
    // A trench of 3/4 m is wider than the wheel: it stands on the floor.
    assert!(agree(at(&Shape::trench(0.75, 1.0), 0.0, 0.0).hub_height, R - 1.0));
    // Along the groove the wheel is as wide as it, and stands on both rims: the face with the lower index is named.
    let mut reversed = groove.clone();
    reversed.faces.reverse();
    for (shape, x) in [(groove, -0.125), (reversed, 0.125)] {
        let along = Chassis::default().contact(&shape.ground(), DVec2::ZERO, DVec2::Y).unwrap();
        assert_eq!((along.hub_height, along.point.x), (R, x));
    }
}

#[test]
fn a_thin_wall_is_never_missed() {
    // 1/64 m thick (1.6 cm), h = 1/4 m, from x = 0 on: closed form of the step from both sides.
    let thick = 1.0 / 64.0;
    let wall =
        Shape::profile(&[(-16.0, 0.0), (0.0, 0.0), (0.0, 0.25), (thick, 0.25), (thick, 0.0), (16.0, 0.0)]);
    // And a sheet without thickness or top: two vertical faces, seen from one side only.
    let corner = |y, z| DVec3::new(0.0, y, z);
    let sheet = Shape::plane(0.0, 0.0, 0.0);
    let sheet = sheet.quad([corner(-2.0, -1.0), corner(2.0, -1.0), corner(2.0, 0.25), corner(-2.0, 0.25)]);
    for step in 0..32 {
        let d = 0.01 * f64::from(step);
        let hub = 0.25 + (R * R - d * d).sqrt();
        assert!(agree(at(&wall, -d, 0.1).hub_height, hub), "{d}");
        assert!(agree(at(&wall, thick + d, 0.1).hub_height, hub), "{d}");
        for x in [d, -d] {
            assert!(agree(at(&sheet, x, 0.1).hub_height, hub), "{x}");
            assert!((at(&sheet, x, 0.1).point.z - 0.25).abs() < 1e-13, "{x}");
        }
    }
    assert_eq!(at(&sheet, 0.0, 2.126).hub_height, R);
}

#[test]
fn a_sheet_askew_stands_although_its_vertices_are_rounded() {
    // From (0, 0) to (0.5, 1.5), in 30 pieces whose lower and upper vertices are rounded to f32 each for itself: about
    // half of the faces lean over by some nanometres. Every wheel on it finds 1/4 m + R.
    let place = |share: f64, z: f64| DVec3::new(0.5 * share, 1.5 * share + 1e-9 * z, z);
    let shape = (0..30).fold(Shape::plane(0.0, 0.0, 0.0), |shape, piece| {
        let [from, to] = [f64::from(piece) / 30.0, f64::from(piece + 1) / 30.0];
        let (low_from, low_to) = (f64::from(piece) / 31.0, f64::from(piece + 1) / 31.0);
        shape.quad([place(low_from, -0.5), place(low_to, -0.5), place(to, 0.25), place(from, 0.25)])
    });
    let ground = shape.ground();
    let narrow = Chassis { wheel_width: 0.01, ..Chassis::default() };
    for step in 1..100 {
        let on_top = place(0.01 * f64::from(step), 0.0).truncate();
        // Across the sheet, so that a single piece carries the wheel. 1e-7 m: rounding of the vertices in plan.
        let across = DVec2::new(1.5, -0.5).normalize();
        let hub = narrow.contact(&ground, on_top, across).unwrap().hub_height;
        assert!((hub - 0.25 - R).abs() < 1e-7, "{step}: {hub}");
    }
}

#[test]
fn undersides_do_not_count_and_overhangs_are_solid() {
    let corner = |x, y| DVec3::new(x, y, 1.0);
    let slab = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let [a, b, c, d] = slab;
    let level = Shape::plane(0.0, 0.0, 0.0);
    assert_eq!(at(&level.clone().quad([a, d, c, b]), 0.0, 0.0).hub_height, R);
    assert_eq!(at(&level.clone().quad(slab), 0.0, 0.0).hub_height, 1.0 + R);
    // Nor does a needle: a face without area, which no renderer sees.
    let needle = [DVec3::ZERO, 0.5 * DVec3::Z, 0.25 * DVec3::Z];
    assert_eq!(at(&level.triangle(needle), 0.0, 0.0).hub_height, R);
}

#[test]
fn beside_the_ground_there_is_no_contact() {
    let (chassis, ground) = (Chassis::default(), Shape::plane(0.0, 0.0, 0.0).ground());
    let at = |x, y| chassis.contact(&ground, DVec2::new(x, y), DVec2::X);
    // The ground ends at x = 16 m: the rim's end still reaches it at 16.34 m, with the hub almost at its height.
    assert!(at(16.36, 0.0).is_none());
    let edge = 16.34_f64 - 16.0;
    assert!(agree(at(16.34, 0.0).unwrap().hub_height, (R * R - edge * edge).sqrt()));
    assert!(at(f64::NAN, 0.0).is_none() && at(1e300, 0.0).is_none());
    assert!(chassis.contact(&Shape::default().ground(), DVec2::ZERO, DVec2::X).is_none());
}

#[test]
fn far_from_the_global_origin_nothing_changes() {
    // The mesh's origin follows: 3e6 m is its new middle. Global numbers of this size have a spacing of 5e-10 m.
    let far = DVec3::new(3e6, -2e6, 5e3);
    let contact = Chassis::default()
        .contact(&Shape::step(0.25).moved(far).ground(), far.truncate() - DVec2::new(0.25, 0.0), DVec2::X)
        .unwrap();
    let hub = 0.25 + (R * R - 0.0625_f64).sqrt();
    assert!((contact.hub_height - far.z - hub).abs() < 2e-9);
    assert!((contact.point - far - DVec3::new(0.0, 0.0, 0.25)).length() < 2e-9);
}
