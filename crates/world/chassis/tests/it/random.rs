//! Random ground: contacts against sampling, and mirror images.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use raypencil_chassis::{Chassis, Passage, PassageLimits};

use super::shapes::Shape;

/// Posts along a side of the random ground, and their spacing, metres.
const POSTS: usize = 13;
const SPACING_M: f64 = 0.25;

/// A continuous ground of POSTS x POSTS vertices around (0, 0): `numbers` are three for each, from -1 to 1. Plan
/// coordinates are moved by up to a fifth of the spacing, so that no face turns over; heights are up to `height`.
fn ground(numbers: &[f64], height: f64) -> Shape {
    let middle = 0.5 * (POSTS - 1) as f64;
    let vertex = |post: usize| {
        let [dx, dy, z] = [0, 1, 2].map(|axis| numbers[3 * post + axis]);
        let (column, row) = ((post % POSTS) as f64 - middle, (post / POSTS) as f64 - middle);
        let plan = DVec2::new(column + 0.2 * dx, row + 0.2 * dy) * SPACING_M;
        // As stored: what samples it must see the same triangles.
        plan.extend(height * z).as_vec3().as_dvec3()
    };
    let faces = (0..(POSTS - 1) * (POSTS - 1)).flat_map(|square| {
        let a = (square / (POSTS - 1) * POSTS + square % (POSTS - 1)) as u32;
        let (b, c, d) = (a + 1, a + POSTS as u32 + 1, a + POSTS as u32);
        [[a, b, c], [a, c, d]]
    });
    Shape { vertices: (0..POSTS * POSTS).map(vertex).collect(), faces: faces.collect() }
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0, 3 * POSTS * POSTS)
}

/// Height of the ground by going through all faces, and the largest slope of any face.
fn height_at(shape: &Shape, place: DVec2) -> Option<f64> {
    let heights = shape.faces.iter().filter_map(|face| {
        let [a, b, c] = face.map(|vertex| shape.vertices[vertex as usize]);
        let shares = [(b, c), (c, a), (a, b)]
            .map(|(from, to)| (from.truncate() - place).perp_dot(to.truncate() - place));
        let area: f64 = shares.iter().sum();
        (area > 0.0 && shares.iter().all(|share| *share >= 0.0))
            .then(|| (shares[0] * a.z + shares[1] * b.z + shares[2] * c.z) / area)
    });
    heights.reduce(f64::max)
}

fn steepest(shape: &Shape) -> f64 {
    let slope = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|vertex| shape.vertices[vertex as usize]);
        let normal = (b - a).cross(c - a);
        normal.truncate().length() / normal.z
    };
    shape.faces.iter().map(slope).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The hub's height by closed form is that of the highest of many samples of the wheel's rectangle. Samples are at
    /// a = R sin(t), with 121 angles t from -pi/2 to pi/2, and at 21 b across. No sample is above it. The point of
    /// contact is within dt/2 and db/2 of a sample; between them a changes by at most R dt/2, the rim R cos(t) by as
    /// much, and the ground, with slopes up to g, by g times the distance.
    #[test]
    fn contacts_are_the_highest_of_many_samples(
        numbers in numbers(),
        (x, y, angle) in (-0.5..0.5, -0.5..0.5, 0.0..6.3),
    ) {
        let shape = ground(&numbers, 0.3);
        let chassis = Chassis::default();
        let (hub, (sin, cos)) = (DVec2::new(x, y), libm::sincos(angle));
        let forward = DVec2::new(cos, sin);
        let contact = chassis.contact(&shape.ground(), hub, forward).unwrap();
        let (radius, half_width) = (chassis.wheel_radius, 0.5 * chassis.wheel_width);
        let mut highest = f64::NEG_INFINITY;
        for step in -60..=60 {
            let (sin, cos) = libm::sincos(f64::from(step) * std::f64::consts::FRAC_PI_2 / 60.0);
            for side in -10..=10 {
                let place = hub + forward * (radius * sin) + forward.perp() * (half_width * f64::from(side) / 10.0);
                highest = highest.max(height_at(&shape, place).unwrap() + radius * cos);
            }
        }
        prop_assert!(highest <= contact.hub_height + 1e-12, "{highest} above {}", contact.hub_height);
        let (along, across) = (radius * std::f64::consts::FRAC_PI_2 / 120.0, half_width / 20.0);
        let bound = along + steepest(&shape) * (along + across);
        prop_assert!(contact.hub_height - highest <= bound, "{} over {highest} + {bound}", contact.hub_height);

        // The point is below the wheel, on the ground, and carries it.
        let from_hub = contact.point.truncate() - hub;
        let (a, b) = (from_hub.dot(forward), from_hub.dot(forward.perp()));
        prop_assert!(a.abs() <= radius + 1e-12 && b.abs() <= half_width + 1e-12);
        let rim = (radius * radius - a * a).max(0.0).sqrt();
        prop_assert!((contact.point.z + rim - contact.hub_height).abs() < 1e-12);
        prop_assert!((height_at(&shape, contact.point.truncate()).unwrap() - contact.point.z).abs() < 1e-12);
    }

    /// A mirror image is passed as its original, with left and right exchanged; it is stood on likewise.
    #[test]
    fn the_mirror_image_is_the_same(
        numbers in numbers(),
        height in 0.0..0.25,
        (x, y, angle) in (-0.2..0.2, -0.2..0.2, 0.0..6.3),
    ) {
        let shape = ground(&numbers, height);
        let chassis = Chassis { wheelbase: 0.8, track: 0.6, wheel_radius: 0.2, wheel_width: 0.15, clearance: 0.2 };
        let limits = PassageLimits::slopes(0.2, 0.2, 0.15);
        let (sin, cos) = libm::sincos(angle);
        let forward = DVec2::new(cos, sin);
        // The middle of the vehicle stays near the middle of the ground.
        let front = DVec2::new(x, y) + forward * 0.4;
        let mirror = |plan: DVec2| DVec2::new(plan.x, -plan.y);
        let passage = chassis.passage(&shape.ground(), front, forward, &limits);
        let image = chassis.passage(&shape.clone().mirrored().ground(), mirror(front), mirror(forward), &limits);
        match (&passage, &image) {
            (Passage::Blocked(one), Passage::Blocked(other)) => {
                prop_assert_eq!(one.kind, other.kind);
                prop_assert_eq!(one.points.len(), other.points.len());
                for (index, point) in one.points.iter().enumerate() {
                    // Left and right exchange; the belly's point has no partner.
                    let partner = if one.points.len() == 1 { index } else { index ^ 1 };
                    let expected = mirror(point.truncate()).extend(point.z);
                    prop_assert!((other.points[partner] - expected).length() < 1e-9);
                }
            }
            _ => prop_assert_eq!(passage, image),
        }
        let place = DVec2::new(x, y);
        let rest = chassis.rest(&shape.ground(), place, angle).unwrap();
        let image = chassis.rest(&shape.mirrored().ground(), mirror(place), -angle).unwrap();
        if rest.residual < 1e-12 && image.residual < 1e-12 {
            prop_assert!((rest.position.z - image.position.z).abs() < 1e-9);
            prop_assert!((rest.pitch_down - image.pitch_down).abs() < 1e-9);
            prop_assert!((rest.roll_right + image.roll_right).abs() < 1e-9);
        }
    }

    /// Random ground is stood on where its hubs' paths are not too steep: the mismatch is rounding, and the four hubs
    /// fit the body's plane as well as any.
    #[test]
    fn gentle_random_ground_is_always_solved(
        numbers in numbers(),
        (x, y, angle) in (-0.3..0.3, -0.3..0.3, 0.0..6.3),
    ) {
        let shape = ground(&numbers, 0.1);
        let chassis = Chassis { wheelbase: 0.8, track: 0.6, wheel_radius: 0.2, wheel_width: 0.15, clearance: 0.2 };
        let rest = chassis.rest(&shape.ground(), DVec2::new(x, y), angle).unwrap();
        prop_assert!(rest.residual < 1e-12, "{rest:?}");
        let pose = rest.pose();
        let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let lifts = signs.map(|(sx, sy)| (sx, sy, pose * DVec3::new(0.4 * sx, 0.3 * sy, 0.2)));
        let lifts = lifts.iter().zip(rest.contacts).map(|((sx, sy, hub), at)| (sx, sy, at.hub_height - hub.z));
        let (mut mean, mut nose, mut left) = (0.0, 0.0, 0.0);
        for (sx, sy, lift) in lifts {
            mean += lift;
            nose += sx * lift;
            left += sy * lift;
        }
        prop_assert!(f64::abs(mean) < 1e-12 && f64::abs(nose) < 1e-12 && f64::abs(left) < 1e-12);
    }
}
