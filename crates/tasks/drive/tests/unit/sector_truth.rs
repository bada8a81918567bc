use glam::{DVec2, DVec3};
use raypencil_rover::{Attitude, Extraction, OnVehicle, RadialGrid, Rig, Route, TraversabilityTest};
use raypencil_scene::{Camera, Lens, Mesh};

use super::*;
use crate::common::mesh;
use crate::exact_map::ExactMap;

/// Ground at 0 up to x = 3 m and at 0.75 m from there to 9 m, where it ends. The step is a wall.
fn step() -> std::sync::Arc<Mesh> {
    let profile = [(-9.0, 0.0), (3.0, 0.0), (3.0, 0.75), (9.0, 0.75)];
    let vertices: Vec<DVec3> =
        profile.iter().flat_map(|&(x, z)| [DVec3::new(x, -9.0, z), DVec3::new(x, 9.0, z)]).collect();
    let faces = (0..3).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]).collect();
    mesh(&vertices, faces)
}

/// A plan with one sector straight ahead, from 0.7 to 4.8 m.
fn plan() -> DrivePlan {
    let camera = Camera {
        width: 8,
        height: 8,
        pixel_pitch: [9e-6; 2],
        focal_length: 8e-3,
        principal_point: [4.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let rig =
        Rig { camera: OnVehicle { vehicle_from_sensor: Pose::IDENTITY, sensor: camera }, beams: Vec::new() };
    let route = Route::through(DVec2::ZERO, vec![DVec2::X]);
    let plan = DrivePlan::new(rig, route, Extraction::thresholding(1.0));
    DrivePlan { grid: RadialGrid { sectors: 1, ..plan.grid }, ..plan }
}

/// End of the sector at this radius.
fn end(radius: f64, label: Label) -> SectorEnd {
    let failed = (label == Label::Obstacle).then_some(TraversabilityTest::Length);
    let missing = (label == Label::Unknown).then_some(Missing {
        part: raypencil_rover::VehiclePart::FrontWheel,
        place: DVec2::new(radius, 0.5),
        reason: MissingReason::NotMeasured,
    });
    SectorEnd { direction: 0.0, radius, point: DVec2::new(radius, 0.0), label, failed, missing }
}

/// Counts of one sector with this end, by a vehicle at (x, 0). `is_seen`: stripes swept all of the ground.
fn counted(x: f64, radius: f64, label: Label, is_seen: bool) -> SectorTruth {
    counted_up_to(x, radius, label, if is_seen { f64::INFINITY } else { f64::NEG_INFINITY })
}

/// The same, with stripes that swept all of the ground up to this height and climbed the wall so far.
fn counted_up_to(x: f64, radius: f64, label: Label, top: f64) -> SectorTruth {
    let (mesh, plan) = (step(), plan());
    let (faces, heights) = (GroundFaces::new(&mesh), HeightIndex::new(&mesh));
    let mut swept = SweptGround::new(plan.map, DVec2::ZERO);
    swept.recentre(DVec2::new(x, 0.0), &heights);
    if top > f64::NEG_INFINITY {
        for i in -20..90 {
            for j in -20..=20 {
                let place = DVec2::new(0.1 * f64::from(i), 0.1 * f64::from(j));
                let z = heights.height_at(place.x, place.y);
                swept.see(place.extend(z.unwrap_or(0.0).min(top)));
            }
        }
    }
    let map = ElevationMap::new(plan.map, DVec2::new(x, 0.0));
    let pose = Attitude::default().at(DVec3::new(x, 0.0, 0.0));
    let ground = TrueGround { heights: &heights, swept: &swept };
    let mut truth = SectorTruth::default();
    let firsts = first_obstacles(&faces, &plan, &pose);
    let judged = truth.add(&[end(radius, label)], &map, &ground, &plan, &pose, &firsts);
    // The judgement of the sector says what its counts say.
    let counted = match judged[0].judgement {
        Judgement::Found => truth.found,
        Judgement::Passed => truth.passed(),
        Judgement::False => truth.false_obstacle,
        Judgement::Unknown => truth.unknown_not_measured,
        Judgement::Clear => truth.clear,
        Judgement::OffGround => truth.off_ground,
    };
    assert_eq!((judged.len(), counted), (1, 1));
    let expected = (truth.with_obstacle > 0).then_some(2.7 - x);
    assert!(judged[0].true_radius.zip(expected).is_none_or(|(a, b)| (a - b).abs() < 1e-9), "{judged:?}");
    assert_eq!(judged[0].true_radius.is_some(), expected.is_some());
    truth
}

// The wheels' rims touch the wall's edge 0.35 m ahead of the front axle, and are lifted by 0.75 - 0.35 = 0.4 m, more than the
// 0.35 m that the slope along the vehicle allows. So it cannot stand with its front axle from 3 - 0.35 = 2.65 m on: the
// first radius is 2.7 m.

#[test]
fn an_obstacle_is_found_within_a_step() {
    for radius in [2.6, 2.7, 2.8, 2.9] {
        let truth = counted(0.0, radius, Label::Obstacle, true);
        assert_eq!((truth.found, truth.with_obstacle, truth.sectors, truth.maps), (1, 1, 1, 1), "{radius}");
    }
}

#[test]
fn an_obstacle_before_the_true_one_is_false() {
    let truth = counted(0.0, 2.5, Label::Obstacle, true);
    assert_eq!((truth.found, truth.false_obstacle, truth.false_before), (0, 1, 1));
    assert_eq!(truth.false_share(), 1.0);
    // From x = -3 m the true one, 5.7 m ahead, is beyond the sector.
    let truth = counted(-3.0, 3.0, Label::Obstacle, true);
    assert_eq!((truth.false_obstacle, truth.false_before, truth.with_obstacle), (1, 0, 0));
}

#[test]
fn clear_beyond_it_by_more_than_a_step_is_missed_if_stripes_swept_it() {
    // Called clear up to 2.8 m: one step beyond. Up to 2.9 m: two.
    let within = counted(0.0, 2.9, Label::Unknown, true);
    assert_eq!((within.missed.all(), within.unknown_not_measured), (0, 1));
    let beyond = counted(0.0, 3.0, Label::Unknown, true);
    // On true elevations of the same cells the rover's own tests stop there: this was an error.
    assert_eq!(
        (beyond.missed, beyond.unknown_not_measured),
        (Missed { by_errors: 1, ..Missed::default() }, 0)
    );
    assert_eq!((beyond.missed_share(), beyond.passed()), (1.0, 1));
    assert_eq!(counted(0.0, 4.8, Label::Visibility, true).missed.all(), 1);
    // No stripe came there: it could not be found.
    let unseen = counted(0.0, 4.8, Label::Visibility, false);
    assert_eq!((unseen.missed.all(), unseen.not_found.not_swept, unseen.missed_share()), (0, 1, 0.0));
    // It is passed all the same, and the sentences say so.
    assert_eq!((within.passed(), unseen.passed()), (0, 1));
    let said = unseen.sentences();
    assert!(said[1].starts_with("1 pass a true obstacle: 0 miss one"), "{said:?}");
    assert!(said[2].ends_with("not seen: hidden 0, not swept 1, outside 0"), "{said:?}");
    assert_eq!(within.sentences().len(), 2);
    // Stripes lit the lower 0.3 m of its 0.75 m: they met it, and not its top, where the wheels touch it. Nothing hid it.
    let in_part = counted_up_to(0.0, 4.8, Label::Visibility, 0.3);
    assert_eq!(in_part.not_found, NotFound { in_part: 1, ..NotFound::default() });
    assert_eq!((in_part.missed.all(), in_part.passed()), (0, 1));
    let said = in_part.sentences();
    let words = "1 pass a true obstacle: 0 miss one that stripes swept, 1 one measured in part, 0 one that could not be seen";
    assert_eq!(said[1], words);
    assert!(said[2].ends_with("measured in part 1; not seen: hidden 0, not swept 0, outside 0"), "{said:?}");
    // Clear up to 2.6 m truly; the bound's sentence has all its counts.
    assert_eq!(unseen.mean_clear_way(), 2.6);
    let bound = unseen.sentence_of_bound();
    assert_eq!(
        bound,
        "exact eyes would end 0 at a true obstacle, 0 at a false one, and pass 1; clear way 2.60 m"
    );
}

#[test]
fn clear_ground_is_clear_and_ground_that_ends_is_not_judged() {
    let clear = counted(-3.0, 4.8, Label::Visibility, true);
    assert_eq!((clear.clear, clear.with_obstacle, clear.clear_mm), (1, 0, 4800));
    // What ends at the first radius, 0.7 m, was clear nowhere; what ends at the second one was clear there.
    let ways = [0.7, 0.8].map(|radius| counted(-3.0, radius, Label::Unknown, true).clear_mm);
    assert_eq!(ways, [0, 700]);
    // From x = 5 m the ground ends 4 m ahead. A front wheel has ground below it up to 0.35 m beyond: to 4.3 m.
    let off = counted(5.0, 4.8, Label::Visibility, true);
    assert_eq!((off.off_ground, off.clear), (1, 0));
    let before = counted(5.0, 4.0, Label::Unknown, true);
    assert_eq!((before.off_ground, before.unknown_not_measured), (0, 1));
}

#[test]
fn exact_eyes_know_the_true_ground_of_what_was_swept_and_nothing_else() {
    let (mesh, plan) = (step(), plan());
    let heights = HeightIndex::new(&mesh);
    let mut swept = SweptGround::new(plan.map, DVec2::ZERO);
    swept.recentre(DVec2::ZERO, &heights);
    // A stripe along y on the upper ground, at x = 4 m.
    for j in -20..=20 {
        swept.see(DVec3::new(4.0, 0.1 * f64::from(j), 0.75));
    }
    let mut exact = ExactMap::new(&plan);
    exact.fill(&swept, &heights);
    let at = |x: f64| exact.map().sample(exact.map().nearest(DVec2::new(x, 0.0)));
    // A cell of the rover has 4 by 4 fine ones, each with the ground at its own place. Cells beside count as seen with it; those
    // beside these are guesses.
    for x in [3.95, 3.975, 4.0, 4.1] {
        assert!((at(x).unwrap() - DVec3::new(x, 0.0, 0.75)).length() < 1e-12, "{x}");
    }
    assert_eq!((at(4.2), at(3.7), at(4.3)), (None, None, None));
    // A scan forgets it, and what was swept before is not added again.
    swept.clear();
    exact.clear();
    exact.end_frame(&ElevationMap::new(plan.map, DVec2::ZERO), &heights, DVec2::ZERO);
    exact.fill(&swept, &heights);
    assert!(exact.map().points().all(|point| exact.map().elevation(point).is_none()));
}

#[test]
fn exact_eyes_see_what_is_narrower_than_a_cell_of_the_rover() {
    // A ridge of 0.36 m along the way, with a top from y = 0.62 to 0.65 m, just under the left wheels of a vehicle that drives along x:
    // their width ends at 0.625 m. The limit across is 0.35 m. In cells of 10 cm the highest of points 2.5 cm apart lies at 0.6375 m, beside
    // the wheel, and the straight line up to it is 0.327 m high at the wheel's side.
    let profile = [(-9.0, 0.0), (0.6, 0.0), (0.62, 0.36), (0.65, 0.36), (0.67, 0.0), (9.0, 0.0)];
    let vertices: Vec<DVec3> =
        profile.iter().flat_map(|&(y, z)| [DVec3::new(-9.0, y, z), DVec3::new(9.0, y, z)]).collect();
    let faces = (0..5).flat_map(|i| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]]).collect();
    let (mesh, plan) = (mesh(&vertices, faces), plan());
    let (faces, heights) = (GroundFaces::new(&mesh), HeightIndex::new(&mesh));
    let mut swept = SweptGround::new(plan.map, DVec2::ZERO);
    swept.recentre(DVec2::ZERO, &heights);
    for (i, j) in (-40..=60).flat_map(|i| (-60..=60).map(move |j| (i, j))) {
        let place = DVec2::new(0.1 * f64::from(i), 0.025 * f64::from(j));
        swept.see(place.extend(heights.height_at(place.x, place.y).unwrap()));
    }
    let mut exact = ExactMap::new(&plan);
    exact.fill(&swept, &heights);
    let pose = Attitude::default().at(DVec3::ZERO);
    let firsts = first_obstacles(&faces, &plan, &pose);
    let DrivePlan { vehicle, rules, grid, .. } = &plan;
    let bound = raypencil_rover::ObstacleMap::extract(exact.map(), vehicle, rules, grid, &pose);
    let First::Obstacle { radius, .. } = firsts[0] else { panic!("the left wheels stand on the ridge") };
    assert_eq!((radius, bound.sectors[0].label), (grid.first, Label::Obstacle));
    assert_eq!(bound.sectors[0].radius, radius);
}

#[test]
fn a_wall_is_seen_only_as_high_as_a_stripe_came() {
    let mesh = step();
    let heights = HeightIndex::new(&mesh);
    let mut swept = SweptGround::new(MapSize::default(), DVec2::ZERO);
    swept.recentre(DVec2::ZERO, &heights);
    let top = DVec3::new(3.0, 0.0, 0.5);
    assert_eq!(swept.at(top), Swept::Never);
    // Half a spacing below the top counts, more does not.
    for (z, expected) in [(0.2, Swept::Lower), (0.44, Swept::Lower), (0.46, Swept::Seen)] {
        swept.see(DVec3::new(2.99, 0.0, z));
        assert_eq!(swept.at(top), expected, "{z}");
    }
    // The foot of what was seen only higher up is not swept yet, either.
    swept.see(DVec3::new(6.0, 0.0, 0.75));
    assert_eq!(swept.at(DVec3::new(6.0, 0.0, 0.5)), Swept::Never);
    // What was swept before a scan counts no more.
    swept.clear();
    assert_eq!(swept.at(top), Swept::Never);
}

/// Radius and rule of the first true obstacle before the wall of 0.75 m at 3 m, for a vehicle at (0, 0).
fn stopped(truth: TrueLimits) -> Option<(f64, ObstructionKind)> {
    let plan = DrivePlan { truth, ..plan() };
    let pose = Attitude::default().at(DVec3::ZERO);
    match first_obstacles(&GroundFaces::new(&step()), &plan, &pose).remove(0) {
        First::Obstacle { radius, obstruction } => Some(((10.0 * radius).round() / 10.0, obstruction.kind)),
        First::Edge { .. } | First::None => None,
    }
}

#[test]
fn the_vehicles_limits_are_apart_from_the_rovers_own() {
    // By default they are the rover's: 0.4 m of lift are more than 0.35 m.
    assert_eq!(stopped(TrueLimits::default()), Some((2.7, ObstructionKind::LengthSlope)));
    // A vehicle that may stand 10 to 1 climbs the wall, until its edge touches the belly: 0.35 m below the hub of the front
    // wheel, where the hubs' plane has fallen by 0.75 d / 1.2 for d = 0.56 m behind it.
    let climber = TrueLimits { length: Some(10.0), ..TrueLimits::default() };
    assert_eq!(stopped(climber), Some((3.6, ObstructionKind::Belly)));
    // 0.1 m lower the underside reaches it for 0.625 d = 0.35 - 0.1 sqrt(1 + 0.625^2), d = 0.371 m.
    let low = TrueLimits { clearance: Some(0.25), ..climber };
    assert_eq!(stopped(low), Some((3.4, ObstructionKind::Belly)));
    // The wheels touch the wall 0.35 m before it, on the way from 2.6 to 2.7 m.
    let steps = [0.74, 0.76].map(|step| stopped(TrueLimits { step: Some(step), ..climber }));
    assert_eq!(steps, [Some((2.7, ObstructionKind::Step)), Some((3.6, ObstructionKind::Belly))]);
    // 0.3 m before the wall the front wheels are lifted by 0.4 + sqrt(0.35^2 - 0.3^2) = 0.58 m: the vehicle rises by 0.484.
    // It tips over if that is more than 0.6 / h: for h = 1.3 m, and not for 1.2 m. 0.2 m before it, it rises by 0.573.
    let mass = |h| stopped(TrueLimits { centre_of_mass: Some(DVec3::new(0.0, 0.0, h)), ..climber });
    assert_eq!(mass(1.3), Some((2.7, ObstructionKind::TipOver)));
    assert_eq!(mass(1.2), Some((2.8, ObstructionKind::TipOver)));
    // The rover's own limit does not move that of the vehicle once it has one.
    let mut plan = DrivePlan { truth: climber, ..plan() };
    plan.rules.slopes.length = 0.01;
    assert_eq!(plan.truth.slopes(&plan.rules.slopes), [0.35, 0.35, 10.0]);
}

#[test]
fn the_rule_of_a_true_obstacle_is_counted_and_told() {
    let truth = counted(0.0, 2.7, Label::Obstacle, true);
    assert_eq!(truth.true_rules, TrueRules { length_slope: 1, ..TrueRules::default() });
    assert_eq!(counted(-3.0, 4.8, Label::Visibility, true).true_rules, TrueRules::default());
}
