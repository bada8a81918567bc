//! What a vehicle can pass: L = 1.25 m, T = 1 m, R = 0.35 m, w = 0.25 m, clearance 0.35 m. The limits are 0.35 across
//! and 1/4 along.

use glam::{DVec2, DVec3};
use raypencil_chassis::{Chassis, Obstruction, ObstructionKind, Passage, PassageLimits};

use super::shapes::Shape;

const CHASSIS: Chassis =
    Chassis { wheelbase: 1.25, track: 1.0, wheel_radius: 0.35, wheel_width: 0.25, clearance: 0.35 };

const LIMITS: PassageLimits =
    PassageLimits { front: 0.35, rear: 0.35, length: 0.25, step: f64::INFINITY, centre_of_mass: None };

/// Passage with the front axle at x, facing +x.
fn at(shape: &Shape, x: f64) -> Passage {
    CHASSIS.passage(&shape.ground(), DVec2::new(x, 0.0), DVec2::X, &LIMITS)
}

/// The obstruction of a passage that is blocked.
fn obstruction(passage: Passage) -> Obstruction {
    match passage {
        Passage::Blocked(obstruction) => obstruction,
        other => panic!("{other:?}"),
    }
}

fn kind(passage: Passage) -> ObstructionKind {
    obstruction(passage).kind
}

#[test]
fn a_step_just_passes_or_just_not() {
    // With the front axle above the edge the slope is h / L: 5/16 m is 1/4 exactly, and passes. 2^-10 m more does not.
    let height = 0.3125;
    for x in [-0.3, -0.01, 0.0, 0.3, 1.0, 1.25, 2.0] {
        assert_eq!(at(&Shape::step(height), x), Passage::Clear, "{x}");
    }
    let higher = Shape::step(height + 1.0 / 1024.0);
    assert_eq!(kind(at(&higher, 0.01)), ObstructionKind::LengthSlope);
    assert_eq!(at(&higher, 1.26), Passage::Clear);
}

#[test]
fn a_step_stops_the_vehicle_where_its_slope_reaches_the_limit() {
    // With the axle at d before the edge the front wheels are lifted by h - R + sqrt(R^2 - d^2). That is L / 4 at
    // d = sqrt(R^2 - (L / 4 + R - h)^2): 0.14456 m for 11/32 m, 0.19961 m for 3/8 m, 0.30999 m for 1/2 m. A wall of
    // L / 4 + R = 0.6625 m or more is met at its first touch.
    for (height, stop) in
        [(0.34375, 0.14456), (0.375, 0.19961), (0.5, 0.30999), (0.671875, 0.35), (2.0, 0.35)]
    {
        let step = Shape::step(height);
        assert_eq!(at(&step, -stop - 1e-4), Passage::Clear, "{height}");
        let stopped = obstruction(at(&step, -stop + 1e-4));
        assert_eq!(stopped.kind, ObstructionKind::LengthSlope, "{height}");
        // Front wheels on the edge, rear wheels on level ground.
        let axle = -stop + 1e-4;
        let expected =
            [(0.0, 0.5, height), (0.0, -0.5, height), (axle - 1.25, 0.5, 0.0), (axle - 1.25, -0.5, 0.0)];
        assert_eq!(stopped.points.len(), 4);
        for (point, (x, y, z)) in stopped.points.iter().zip(expected) {
            assert!((*point - DVec3::new(x, y, z)).length() < 1e-12, "{point}");
        }
    }
}

#[test]
fn a_step_down_stops_the_vehicle_when_its_wheels_hang_too_low() {
    // Facing -x from above, 11/32 m: the front wheels hang on the edge, R - sqrt(R^2 - d^2) lower with their axle d past
    // it. That is L / 4 = 0.3125 m at d = sqrt(0.35^2 - 0.0375^2) = 0.34799 m.
    let ground = Shape::step(0.34375).ground();
    let down = |x: f64| CHASSIS.passage(&ground, DVec2::new(-x, 0.0), DVec2::NEG_X, &LIMITS);
    assert_eq!(down(0.3479), Passage::Clear);
    assert_eq!(kind(down(0.3481)), ObstructionKind::LengthSlope);
}

#[test]
fn which_of_two_points_carries_a_wheel_does_not_matter() {
    // The right front wheel stands on level ground. A stone 1/4 m before its axle that is R - sqrt(R^2 - 1/16) = 0.105 m
    // high touches its rim, and a millionth of a metre decides which of the two carries it: points that differ by
    // 0.105 m in height. The left wheel stands on a stone of 0.34 or 0.36 m, against a limit of 0.35 m.
    let tie = 0.35 - (0.1225_f64 - 0.0625).sqrt();
    for (height, passes) in [(0.34, true), (0.36, false)] {
        for more in [-1e-6, 1e-6] {
            let under = Shape::plane(0.0, 0.0, 0.0).stone((1.25, 0.5), (0.0625, 0.0625), height);
            let ground = under.stone((1.525, -0.5), (0.025, 0.125), tie + more);
            assert_eq!(at(&ground, 1.25) == Passage::Clear, passes, "{height} {more}");
        }
    }
}

#[test]
fn a_trench_narrower_than_the_wheel_is_bridged() {
    // 1 m deep. 2 R = 0.7 m: the wheel bridges 11/16 m, and falls to the floor of 45/64 m.
    let narrow = Shape::trench(0.6875, 1.0);
    for step in 0..80 {
        let x = -0.5 + 0.03 * f64::from(step);
        assert_eq!(at(&narrow, x), Passage::Clear, "{x}");
    }
    let wide = Shape::trench(0.703125, 1.0);
    assert_eq!(kind(at(&wide, 0.0)), ObstructionKind::LengthSlope);
    assert_eq!(kind(at(&wide, 1.25)), ObstructionKind::LengthSlope);
    // A shallow trench of this width, 1/4 m deep: 1/4 over 1.25 m is 0.2.
    assert_eq!(at(&Shape::trench(0.703125, 0.25), 0.0), Passage::Clear);
}

#[test]
fn wheels_in_a_trench_lower_the_belly_by_their_sagitta() {
    // Clearance c = 0.1 m. With the front axle above the middle of a trench of width g, the front hubs are at
    // f = sqrt(R^2 - g^2/4), the rear ones at R: p = (f - R) / L. Above the trench's rim, g/2 behind the front axle,
    // the underside is at f - p g/2 - (R - c) sqrt(1 + p^2). It reaches 0 between g = 17/32 m (+0.0027 m) and 35/64 m
    // (-0.0041 m).
    let low = Chassis { clearance: 0.1, ..CHASSIS };
    let height = |g: f64| {
        let f = (0.1225 - 0.25 * g * g).sqrt();
        let p = (f - 0.35) / 1.25;
        f - 0.5 * p * g - 0.25 * (1.0 + p * p).sqrt()
    };
    assert!((height(0.53125) - 0.0027).abs() < 1e-4 && (height(0.546875) + 0.0041).abs() < 1e-4);
    let over = |width: f64| low.passage(&Shape::trench(width, 1.0).ground(), DVec2::ZERO, DVec2::X, &LIMITS);
    assert_eq!(over(0.53125), Passage::Clear);
    let hit = obstruction(over(0.546875));
    assert_eq!((hit.kind, hit.points.len()), (ObstructionKind::Belly, 1));
    assert!((hit.points[0].x + 0.2734375).abs() < 1e-12 && hit.points[0].z.abs() < 1e-12, "{:?}", hit.points);
}

#[test]
fn a_ramp_at_its_limit_passes_in_each_direction() {
    // 1/4 along, 0.375 across: exactly at the limit, then 2^-10 more; up, down, and both sides up.
    let limits = PassageLimits::slopes(0.375, 0.375, 0.25);
    let more = 1.0 / 1024.0;
    let pass = |p, q, forward: DVec2| {
        CHASSIS.passage(&Shape::plane(0.0, p, q).ground(), DVec2::new(0.3, 0.2), forward, &limits)
    };
    for forward in [DVec2::X, DVec2::NEG_X] {
        assert_eq!(pass(0.25, 0.0, forward), Passage::Clear);
        assert_eq!(kind(pass(0.25 + more, 0.0, forward)), ObstructionKind::LengthSlope);
        assert_eq!(pass(0.0, 0.375, forward), Passage::Clear);
        assert_eq!(kind(pass(0.0, 0.375 + more, forward)), ObstructionKind::FrontSlope);
        assert_eq!(kind(pass(0.0, -0.375 - more, forward)), ObstructionKind::FrontSlope);
    }
    // The slope along: only its part along the heading counts. 5/16 up towards (0.8, 0.6), heading (1, 0): 0.25.
    assert_eq!(pass(0.25, 0.1875, DVec2::X), Passage::Clear);
}

#[test]
fn a_stone_between_the_wheels_hits_the_belly_at_the_clearance() {
    // Front axle at 1.25 m, so the belly is over x = 0 to 1.25 m, |y| <= (T - w)/2 = 0.375 m. A stone of 1/16 m around
    // (0.5, y): on the centre line, and at y = 1/4 m on either side.
    let stone = |y: f64, height| Shape::plane(0.0, 0.0, 0.0).stone((0.5, y), (0.03125, 0.03125), height);
    for y in [0.0, 0.25, -0.25] {
        assert_eq!(at(&stone(y, 0.34375), 1.25), Passage::Clear, "{y}");
        let hit = obstruction(at(&stone(y, 0.359375), 1.25));
        assert_eq!((hit.kind, hit.points.len()), (ObstructionKind::Belly, 1), "{y}");
        let from_stone = hit.points[0] - DVec3::new(0.5, y, 0.359375);
        assert!(from_stone.abs().max_element() <= 0.03125 + 1e-12 && from_stone.z.abs() < 1e-12, "{y}");
    }
    // Ground that just touches the underside hits it: clearance and stone 3/8 m.
    let high = Chassis { clearance: 0.375, ..CHASSIS };
    let touch = |height| high.passage(&stone(0.0, height).ground(), DVec2::new(1.25, 0.0), DVec2::X, &LIMITS);
    assert_eq!(kind(touch(0.375)), ObstructionKind::Belly);
    assert_eq!(touch(0.375 - 1.0 / 1024.0), Passage::Clear);
    // Nor do the wheels' own tracks belong to the belly, from |y| = 0.375 m on.
    let beside = |y| Shape::plane(0.0, 0.0, 0.0).stone((0.625, y), (0.03125, 0.03125), 0.5);
    assert_eq!(at(&beside(0.4375), 1.25), Passage::Clear);
    assert_eq!(at(&beside(-0.4375), 1.25), Passage::Clear);
    // Behind the rear axle, and before the front axle between the wheels, there is no belly.
    assert_eq!(at(&stone(0.0, 0.5), 0.46), Passage::Clear);
    assert_eq!(at(&stone(0.0, 0.5), 1.79), Passage::Clear);
    assert_eq!(kind(at(&stone(0.0, 0.5), 0.47)), ObstructionKind::Belly);
    assert_eq!(kind(at(&stone(0.0, 0.5), 1.78)), ObstructionKind::Belly);
}

#[test]
fn a_crest_hits_the_belly_between_the_axles() {
    // A roof z = -s |x| along the way, s = 1/2, axles at +-L/2. The wheels touch at a = R s / sqrt(1 + s^2) from the
    // hubs, towards the crest, and the hubs are at -s L/2 + R sqrt(1 + s^2) = -0.3125 + 0.3913 = 0.0788 m. The
    // underside is c - R = 0 above them: the crest (0) is below by 0.0788 m; with a clearance of 0.25 m it is above by
    // 0.0212 m.
    let roof = Shape::profile(&[(-16.0, -8.0), (0.0, 0.0), (16.0, -8.0)]).ground();
    let over = |chassis: Chassis| chassis.passage(&roof, DVec2::new(0.625, 0.0), DVec2::X, &LIMITS);
    assert_eq!(over(CHASSIS), Passage::Clear);
    assert_eq!(over(Chassis { clearance: 0.35 - 0.078, ..CHASSIS }), Passage::Clear);
    assert_eq!(kind(over(Chassis { clearance: 0.35 - 0.079, ..CHASSIS })), ObstructionKind::Belly);
}

#[test]
fn on_a_slope_the_clearance_is_measured_along_the_normal() {
    // z = x / 4. The hubs are R sqrt(17/16) above the slope along z, so the plane of the wheels' lowest points is the
    // slope itself. A blade across the belly reaches the underside at the height c sqrt(17/16) = 0.36077 m along z, not
    // at 0.35 m. It stands at x = -1/2 m, between the wheels.
    let blade = |h: f64| {
        let corner = |y, z| DVec3::new(-0.5, y, z);
        let top = -0.125 + h;
        let plane = Shape::plane(0.0, 0.25, 0.0);
        plane.quad([corner(-0.25, -1.0), corner(0.25, -1.0), corner(0.25, top), corner(-0.25, top)])
    };
    assert_eq!(at(&blade(0.3605), 0.0), Passage::Clear);
    assert_eq!(kind(at(&blade(0.361), 0.0)), ObstructionKind::Belly);
}

#[test]
fn on_a_slope_across_the_belly_leans_with_the_wheels() {
    // z = y / 4, clearance 1/4 m. Each wheel touches on its higher side, so the hubs are w/2 / 4 + R = 0.38125 m above
    // the slope, and the underside is (R - c) sqrt(17/16) = 0.10308 m lower: 0.27817 m. Blades of this height on
    // either side of the centre line, their tops parallel to the slope.
    let low = Chassis { clearance: 0.25, ..CHASSIS };
    let blade = |y: f64, h: f64| {
        let corner = |y: f64, z| DVec3::new(-0.5, y, 0.25 * y + z);
        let plane = Shape::plane(0.0, 0.0, 0.25);
        plane.quad([corner(y, -1.0), corner(y + 0.0625, -1.0), corner(y + 0.0625, h), corner(y, h)])
    };
    let at = |shape: Shape| low.passage(&shape.ground(), DVec2::ZERO, DVec2::X, &LIMITS);
    for y in [0.25, -0.3125] {
        assert_eq!(at(blade(y, 0.278)), Passage::Clear, "{y}");
        assert_eq!(kind(at(blade(y, 0.2785))), ObstructionKind::Belly, "{y}");
    }
}

#[test]
fn a_stone_under_one_wheel_is_a_slope_across() {
    // Under the front left wheel only, on y = 7/16 to 9/16 m: its slope is h / T against 0.35.
    let stone = |x: f64, y: f64, h| Shape::plane(0.0, 0.0, 0.0).stone((x, y), (0.0625, 0.0625), h);
    assert_eq!(at(&stone(1.25, 0.5, 0.34375), 1.25), Passage::Clear);
    let tilted = obstruction(at(&stone(1.25, 0.5, 0.359375), 1.25));
    assert_eq!(tilted.kind, ObstructionKind::FrontSlope);
    assert_eq!(tilted.points, [DVec3::new(1.25, 0.5, 0.359375), DVec3::new(1.25, -0.5, 0.0)]);
    let tilted = obstruction(at(&stone(0.0, -0.5, 0.359375), 1.25));
    assert_eq!(tilted.kind, ObstructionKind::RearSlope);
    assert_eq!(tilted.points, [DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.0, -0.5, 0.359375)]);
}

#[test]
fn without_ground_below_a_wheel_there_is_no_passage() {
    // The ground ends at 16 m. Front rims reach 0.35 m ahead of the front axle, rear ones 0.9 m to 1.6 m behind it.
    let plane = Shape::plane(0.0, 0.0, 0.0);
    assert_eq!(at(&plane, 15.9), Passage::Clear);
    assert_eq!(at(&plane, 16.36), Passage::OffGround);
    assert_eq!(at(&plane, -14.7), Passage::Clear);
    assert_eq!(at(&plane, -15.11), Passage::OffGround);
    let nowhere = CHASSIS.passage(&plane.ground(), DVec2::new(f64::NAN, 0.0), DVec2::X, &LIMITS);
    assert_eq!(nowhere, Passage::OffGround);
}

#[test]
fn slopes_block_a_thousandth_above_their_limits_and_pass_a_thousandth_below() {
    // A stone under the middle of one wheel lifts its centre by the height of the stone: a rise of 0.35 m over the track
    // of 1 m is the limit, at either axle. The front axle is at x = 1.25 m, the rear one at 0. Along, the same stone is
    // half as high over 1.25 m, 0.14 against 0.25.
    for (x, kind_of) in [(1.25, ObstructionKind::FrontSlope), (0.0, ObstructionKind::RearSlope)] {
        for y in [0.5, -0.5] {
            let on = |height: f64| {
                let level = Shape::plane(0.0, 0.0, 0.0);
                at(&level.stone((x, y), (0.0625, 0.0625), height), 1.25)
            };
            assert_eq!(on(0.3496), Passage::Clear, "{x} {y}");
            assert_eq!(kind(on(0.3504)), kind_of, "{x} {y}");
        }
    }
}

/// Slopes of any size pass; the centre of mass is at this place of the vehicle frame.
fn with_mass(x: f64, h: f64) -> PassageLimits {
    let centre_of_mass = Some(DVec3::new(x, 0.0, h));
    PassageLimits { centre_of_mass, ..PassageLimits::slopes(10.0, 10.0, 10.0) }
}

#[test]
fn a_plane_tips_the_vehicle_over_at_half_its_base_over_the_height_of_its_mass() {
    // 2.5 m high: L / (2 h) = 0.25 up and down, T / (2 h) = 0.2 on either side. A thousandth of a slope beside the limits.
    let pass = |p: f64, q: f64, forward: DVec2| {
        let ground = Shape::plane(0.0, p, q).ground();
        CHASSIS.passage(&ground, DVec2::new(0.3, 0.2), forward, &with_mass(0.0, 2.5))
    };
    for (forward, side) in [(DVec2::X, 1.0), (DVec2::NEG_X, 1.0), (DVec2::X, -1.0)] {
        assert_eq!(pass(side * 0.249, 0.0, forward), Passage::Clear, "{forward} {side}");
        let tipped = obstruction(pass(side * 0.251, 0.0, forward));
        assert_eq!((tipped.kind, tipped.points.len()), (ObstructionKind::TipOver, 4), "{forward} {side}");
        assert_eq!(pass(0.0, side * 0.199, forward), Passage::Clear, "{forward} {side}");
        assert_eq!(kind(pass(0.0, side * 0.201, forward)), ObstructionKind::TipOver, "{forward} {side}");
    }
    // Exactly at it the vertical meets the line through two wheels, and it stands.
    assert_eq!(pass(0.25, 0.0, DVec2::X), Passage::Clear);
}

#[test]
fn an_oblique_slope_tips_the_vehicle_over_its_nearer_line() {
    // z = 0.2 x + 0.15 y. Heading x: p = 0.2, q = 0.15. The foot is h 0.2 sqrt(1.0625 / 1.04) = 0.202153 h behind and
    // h 0.15 / sqrt(1.04) = 0.147087 h aside: at 0.625 m behind for h = 3.0917 m, at 0.5 m aside for 3.399 m.
    // Heading y: p = 0.15, q = -0.2: h 0.2 / sqrt(1.0225) = 0.197788 h aside, 0.5 m for h = 2.5280 m.
    let ground = Shape::plane(0.0, 0.2, 0.15).ground();
    let pass = |forward, h: f64| CHASSIS.passage(&ground, DVec2::ZERO, forward, &with_mass(0.0, h));
    assert_eq!(pass(DVec2::X, 3.091), Passage::Clear);
    assert_eq!(kind(pass(DVec2::X, 3.092)), ObstructionKind::TipOver);
    assert_eq!(pass(DVec2::Y, 2.527), Passage::Clear);
    assert_eq!(kind(pass(DVec2::Y, 2.529)), ObstructionKind::TipOver);
}

#[test]
fn a_mass_before_the_middle_tips_over_later_uphill() {
    // 0.1 m ahead of the middle and 2.5 m high: behind at (0.625 + 0.1) / 2.5 = 0.29 uphill, ahead at 0.21 downhill.
    let pass = |p: f64| {
        let ground = Shape::plane(0.0, p, 0.0).ground();
        CHASSIS.passage(&ground, DVec2::ZERO, DVec2::X, &with_mass(0.1, 2.5))
    };
    assert_eq!((pass(0.289), pass(-0.209)), (Passage::Clear, Passage::Clear));
    assert_eq!(kind(pass(0.291)), ObstructionKind::TipOver);
    assert_eq!(kind(pass(-0.211)), ObstructionKind::TipOver);
}

/// The step that a wheel has to climb on the last 0.1 m of its way to where the front axle is at x, facing +x.
fn climbed(shape: &Shape, x: f64, height: f64) -> Option<Obstruction> {
    CHASSIS.step(&shape.ground(), DVec2::new(x, 0.0), DVec2::X, 0.1, height)
}

#[test]
fn a_step_a_hundredth_too_high_for_a_wheel_stops_it() {
    // A wheel touches the edge of 0.2 m with its axle sqrt(0.35^2 - 0.15^2) = 0.3162 m before it: on the way from -0.35 m
    // to -0.25 m. The slope along, 0.2 / 1.25, is far below its limit.
    let step = Shape::step(0.2);
    assert_eq!(at(&step, -0.25), Passage::Clear);
    let stopped = climbed(&step, -0.25, 0.2 / 1.01).unwrap();
    assert_eq!((stopped.kind, stopped.points.len()), (ObstructionKind::Step, 1));
    let edge = stopped.points[0] - DVec3::new(0.0, 0.5, 0.2);
    assert!(edge.length() < 1e-7, "{edge}");
    assert_eq!(climbed(&step, -0.25, 0.2 / 0.99), None);
    // Before it, and once the wheels are on it, there is nothing to climb.
    assert_eq!((climbed(&step, -0.32, 0.19), climbed(&step, 0.0, 0.19)), (None, None));
    // The rear wheels climb it 1.25 m later. Down there is none.
    assert!(climbed(&step, 1.0, 0.2 / 1.01).is_some() && climbed(&step, 1.0, 0.2 / 0.99).is_none());
    let down = CHASSIS.step(&step.ground(), DVec2::new(-0.1, 0.0), DVec2::NEG_X, 0.5, 0.01);
    assert_eq!(down, None);
    // A wall higher than the hub is met at its first touch, 0.35 m before it.
    let wall = Shape::step(0.5);
    assert!(climbed(&wall, -0.34, 0.5 / 1.01).is_some() && climbed(&wall, -0.34, 0.5 / 0.99).is_none());
}

#[test]
fn a_stone_under_one_wheel_is_a_step() {
    // Under the track of the right front wheel alone, 0.15 m high, from x = 1 m on; on the whole way there at once.
    let stone = Shape::plane(0.0, 0.0, 0.0).stone((1.125, -0.5), (0.125, 0.0625), 0.15);
    let way = |height| CHASSIS.step(&stone.ground(), DVec2::new(3.0, 0.0), DVec2::X, 2.5, height);
    let point = way(0.15 / 1.01).unwrap().points[0];
    assert!((point.x - 1.0).abs() < 1e-6 && (point.z - 0.15).abs() < 1e-7 && point.y < 0.0, "{point}");
    assert_eq!(way(0.15 / 0.99), None);
}

#[test]
fn a_slope_is_no_step_but_its_foot_is_a_small_one() {
    // 1:4 for 5 m.
    let slope = Shape::plane(0.0, 0.25, 0.0).ground();
    assert_eq!(CHASSIS.step(&slope, DVec2::new(4.0, 0.0), DVec2::X, 5.0, 1e-3), None);
    // Where a ramp of 1:1 begins, the point that carries a wheel jumps by R (1 - cos 45 degrees) = 0.10251 m. The ramp itself
    // rises by 0.5 m.
    let ramp = Shape::profile(&[(-16.0, 0.0), (0.0, 0.0), (0.5, 0.5), (16.0, 0.5)]).ground();
    let way = |height| CHASSIS.step(&ramp, DVec2::new(1.0, 0.0), DVec2::X, 2.0, height);
    assert!(way(0.1020).is_some());
    assert_eq!(way(0.1030), None);
}

#[test]
fn a_way_that_begins_without_ground_has_no_step_there() {
    // The ground begins at -16 m with a wall that nobody climbs: the rear wheels come from beyond its edge.
    let ground = Shape::plane(0.0, 0.0, 0.0).ground();
    assert_eq!(CHASSIS.step(&ground, DVec2::new(-14.0, 0.0), DVec2::X, 2.0, 0.01), None);
}
