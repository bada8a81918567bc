//! Bodies of rocks: closed, as wide as asked for, of several kinds, tilted, and on the slope they lie on.

use super::*;
use crate::ground::tests::assert_closed_and_outward;

/// Number of faces of a rock of that diameter.
pub(in crate::mars) fn faces(diameter: f64) -> usize {
    32 << (2 * (subdivisions(diameter) - 1))
}

/// A rock of that diameter at the origin.
fn rock(bodies: &mut RockBodies, diameter: f64, gradient: DVec2) -> Ground {
    let mut ground = Ground::default();
    bodies.add(&mut ground, DVec3::ZERO, gradient, diameter, 0);
    ground
}

/// Lowest and highest vertex, diameters.
fn low_and_high(ground: &Ground, diameter: f64) -> (f64, f64) {
    let heights = ground.vertices.iter().map(|v| v.z / diameter);
    heights.fold((0.0_f64, 0.0_f64), |(low, high), z| (low.min(z), high.max(z)))
}

#[test]
fn the_part_above_a_level_by_hand() {
    // A square pyramid of side 4 and height 2: at level 1 its section has the side 2. All of its upward faces above
    // that make up the 4 square metres of the section; above the base all 16.
    let mut ground = Ground::default();
    ground.add_pyramid(DVec3::ZERO, 2.0, 2.0, 0.3, 0);
    let area = |level: f64| plan_area_above(&ground.vertices, &ground.faces, level);
    assert!((area(1.0) - 4.0).abs() < 1e-12 && (area(0.0) - 16.0).abs() < 1e-12, "{}", area(1.0));
    assert!((area(0.5) - 9.0).abs() < 1e-12 && area(2.5) == 0.0);
}

#[test]
fn bodies_are_closed_outward_and_as_wide_as_asked_for() {
    let mut bodies = RockBodies::new(5);
    for k in 0..200 {
        let diameter = 0.05 + 0.01 * f64::from(k);
        let mut ground = Ground::default();
        let place = DVec3::new(3.0, -2.0, 0.7);
        // On a slope as on level ground: along z a shear keeps the outline.
        let gradient = if k % 2 == 0 { DVec2::ZERO } else { DVec2::new(0.3, -0.4) };
        bodies.add(&mut ground, place, gradient, diameter, 0);
        assert_eq!(ground.faces.len(), faces(diameter));
        assert_closed_and_outward(&ground, 0..ground.faces.len());
        let level = |v: DVec3| v - DVec3::Z * (place.z + gradient.dot((v - place).truncate()));
        let upright: Vec<DVec3> = ground.vertices.iter().map(|&v| level(v)).collect();
        let plan = plan_area_above(&upright, &ground.faces, 0.0);
        let circle = std::f64::consts::FRAC_PI_4 * diameter * diameter;
        assert!((plan / circle - 1.0).abs() < 1e-9, "{plan} for {circle}");
    }
}

#[test]
fn heights_are_those_of_three_kinds() {
    // Heights above ground and depths below it, in diameters. The share of flat rocks is a fifth; a rounded or angular
    // one is half as high as wide on the average.
    let mut bodies = RockBodies::new(7);
    let rocks: Vec<(f64, f64)> =
        (0..1000).map(|_| low_and_high(&rock(&mut bodies, 0.3, DVec2::ZERO), 0.3)).collect();
    assert!(rocks.iter().all(|(low, high)| (-0.8..-0.02).contains(low) && (0.05..0.95).contains(high)));
    let mean = rocks.iter().map(|(_, high)| high).sum::<f64>() / 1000.0;
    assert!((0.35..0.5).contains(&mean), "{mean}");
    // From bottom to top the flat ones measure less than half of a diameter, the others more.
    let flat = rocks.iter().filter(|(low, high)| high - low < 0.5).count();
    assert!((140..260).contains(&flat), "{flat} flat rocks of 1000");
}

#[test]
fn rocks_are_tilted_and_some_hang_over() {
    // The outline of an upright body is level: its widest place in each direction is equally high. That of a tilted one
    // rises on one side.
    let mut bodies = RockBodies::new(8);
    let (mut tilted, mut hanging) = (0, 0);
    for _ in 0..400 {
        let ground = rock(&mut bodies, 1.0, DVec2::ZERO);
        // Heights of the widest place in 24 directions: their first harmonic is the tilt.
        let (mut harmonic, mut widest_above) = (DVec2::ZERO, 0);
        for k in 0..24 {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / 24.0);
            let outward = DVec3::new(cos, sin, 0.0);
            let widest = ground.vertices.iter().max_by(|a, b| a.dot(outward).total_cmp(&b.dot(outward)));
            let widest = widest.expect("vertices");
            harmonic += outward.truncate() * (widest.z / widest.dot(outward)) / 12.0;
            widest_above += i32::from(widest.z > 0.05);
        }
        tilted += i32::from(harmonic.length() > libm::tan(8_f64.to_radians()));
        hanging += i32::from(widest_above > 12);
    }
    println!("{tilted} of 400 tilted by more than 8 degrees, {hanging} hang over");
    assert!(tilted > 130, "{tilted} of 400 are tilted by more than 8 degrees");
    assert!(hanging > 60, "{hanging} of 400 hang over");
}

#[test]
fn on_a_slope_a_rock_lies_as_on_level_ground() {
    // The shear moves each vertex up by slope x distance; steeper than 0.7 it stays at that.
    let [level, slope, steep] = [DVec2::ZERO, DVec2::new(0.2, -0.5), DVec2::new(0.0, 3.0)]
        .map(|gradient| rock(&mut RockBodies::new(9), 0.8, gradient));
    for ((a, b), c) in level.vertices.iter().zip(&slope.vertices).zip(&steep.vertices) {
        assert!((b.z - a.z - 0.2 * a.x + 0.5 * a.y).abs() < 1e-12 && b.truncate() == a.truncate());
        assert!((c.z - a.z - 0.7 * a.y).abs() < 1e-12);
    }
}

#[test]
fn the_outline_is_as_large_as_the_faces_say() {
    // The upper side hardly ever folds over itself. The outline, counted on a raster of 2 % of the diameter,
    // therefore equals the sum of the projected faces within 1 %, on the mean of 40 rocks.
    let mut bodies = RockBodies::new(6);
    let mut ratio = 0.0;
    for _ in 0..40 {
        let mut ground = Ground::default();
        bodies.add(&mut ground, DVec3::ZERO, DVec2::ZERO, 1.0, 0);
        // Of the outline of the whole body, not of the part above ground.
        let triangles: Vec<[DVec2; 3]> =
            ground.faces.iter().map(|f| f.map(|v| ground.vertices[v as usize].truncate())).collect();
        let promised = plan_area_above(&ground.vertices, &ground.faces, f64::NEG_INFINITY);
        let inside = |p: DVec2| {
            triangles.iter().any(|[a, b, c]| {
                let side = |a: &DVec2, b: &DVec2| (*b - *a).perp_dot(p - *a) >= 0.0;
                side(a, b) && side(b, c) && side(c, a)
            })
        };
        let step = 0.02;
        let raster = (-50..50).flat_map(|i| (-50..50).map(move |j| DVec2::new(f64::from(i), f64::from(j))));
        let count = raster.filter(|&p| inside((p + 0.5) * step)).count();
        ratio += count as f64 * step * step / promised / 40.0;
    }
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}
