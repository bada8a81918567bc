//! Elevation and obstacle maps from ideal stripes on grounds of a few faces.

use super::common;

use common::{extruded, from_vehicle, rig, stripe};
use glam::{DVec2, DVec3};
use raypencil_rover::{
    Attitude, ElevationSource, Label, LocalisationReading, MapRules, MapSize, Mapper, ObstacleMap,
    RadialGrid, Rig, SheetPlane, StartRule, Sweep, TraversabilityRules, TraversabilityTest, Triangulation,
    Vehicle,
};
use raypencil_scene::{Material, Mesh, Pose};
use raypencil_terrain::Ground;

/// Reading of perfect sensors: the vehicle stands level at (x, 0).
fn sensed(x: f64) -> LocalisationReading {
    LocalisationReading { position: DVec2::new(x, 0.0), attitude: Attitude::default(), proximity: Some(0.0) }
}

fn stand(x: f64) -> Pose {
    Pose::from_position(DVec3::new(x, 0.0, 0.0))
}

/// The points of a whole vertical scan from x, vehicle frame.
fn scan(rig: &Rig, mesh: &Mesh, x: f64) -> Vec<DVec3> {
    let faces = from_vehicle(mesh, stand(x));
    let mut points = Vec::new();
    for pan in Sweep::default().pans() {
        let panned = rig.panned(pan);
        for beam in 0..2 {
            points.extend(stripe(&panned, beam, &faces).into_iter().map(|(point, _)| point));
        }
    }
    points
}

/// The points of one frame from x, vehicle frame.
fn frame(rig: &Rig, mesh: &Mesh, x: f64) -> Vec<DVec3> {
    let faces = from_vehicle(mesh, stand(x));
    (0..2).flat_map(|beam| stripe(rig, beam, &faces)).map(|(point, _)| point).collect()
}

fn obstacles(mapper: &Mapper) -> ObstacleMap {
    let vehicle = Vehicle::default();
    let (rules, grid) = (TraversabilityRules::as_printed(&vehicle), RadialGrid::for_vehicle(&vehicle));
    ObstacleMap::extract(mapper.map(), &vehicle, &rules, &grid, &mapper.pose())
}

/// The printed rules, with all ground under the vehicle known at the start and after a scan: else every sector would end
/// unknown there, before it comes to what these tests are about.
fn start() -> Mapper {
    let rules = MapRules { start: StartRule::Footprint, ..MapRules::AS_PRINTED };
    Mapper::with_rules(Vehicle::default(), MapSize::default(), rules, &sensed(0.0), 0.0)
}

#[test]
fn the_map_of_level_ground_is_the_ground_within_the_footprint() {
    // With whole pixels the error of a point is at most its pixel's footprint on the edge plane, and so is the error of
    // its elevation. The stripes are 3.3 and 5.25 m away.
    let (rig, mesh) = (rig(512, 1), extruded(&[(-20.0, 0.0), (20.0, 0.0)]));
    let tables: Vec<_> = (0..2).map(|beam| Triangulation::new(&rig, beam, SheetPlane::LowerEdge)).collect();
    let faces = from_vehicle(&mesh, stand(0.0));
    let (mut points, mut bound) = (Vec::new(), [0.0_f64; 2]);
    for (beam, triangulation) in tables.iter().enumerate() {
        let table = triangulation.table();
        for (point, (u, v)) in stripe(&rig, beam, &faces) {
            let (i, j) = (u as u32, v as u32);
            let (Some(measured), Some(footprint)) = (table.at_pixel(i, j), triangulation.footprint(i, j))
            else {
                continue;
            };
            assert_eq!(Some(measured), triangulation.at_pixel(i, j));
            assert!((measured - point).length() <= footprint + 1e-9);
            bound[beam] = bound[beam].max(footprint);
            points.push(measured);
        }
    }
    assert!(points.len() > 900, "{} points", points.len());
    // A pixel is 1.125 mrad wide. Half its diagonal, over the angle between the camera's ray and the sheet (4.4 and 5.1
    // degrees at 3.3 and 5.25 m), is 3 to 5 cm along the sheet.
    assert!(bound[0] < 0.04 && bound[1] < 0.06, "{bound:?}");
    let mut mapper = start();
    let pose = Pose { position: DVec3::new(0.0, 0.0, 0.0), ..stand(0.0) };
    assert_eq!(mapper.pose(), pose);
    mapper.update(&sensed(0.0), points);
    let mut measured = 0;
    for point in mapper.map().points() {
        let Some(z) = mapper.map().elevation(point) else { continue };
        assert!(z.abs() <= bound[1], "{z} at {}", mapper.map().place(point));
        measured += usize::from(mapper.map().source(point) == ElevationSource::Measured);
    }
    // The stripes are 3.5 and 6.1 m long, with one grid point per 0.1 m.
    assert!((80..=250).contains(&measured), "{measured} measured points");
}

#[test]
fn a_step_of_0_4_m_is_an_obstacle_and_one_of_0_1_m_is_not() {
    for (height, expected) in [(0.4, Label::Obstacle), (0.1, Label::Visibility)] {
        let mesh = extruded(&[(-20.0, 0.0), (3.0, 0.0), (3.0, height), (20.0, height)]);
        let mut mapper = start();
        mapper.update_from_scan(&sensed(0.0), scan(&rig(256, 1), &mesh, 0.0), true);
        let all = obstacles(&mapper);
        let ahead = all.sectors[15];
        assert_eq!(ahead.label, expected, "{ahead:?}");
        if expected == Label::Obstacle {
            // The front axle is at the first grid point on the upper level: 3.0 or 3.1 m.
            assert_eq!(ahead.failed, Some(TraversabilityTest::Length));
            assert!((3.0..3.11).contains(&(ahead.radius + 1e-9)), "{ahead:?}");
        } else {
            assert!(all.sectors.iter().all(|sector| sector.label != Label::Obstacle));
        }
    }
}

#[test]
fn a_trench_is_unknown_from_afar_and_an_obstacle_from_nearer() {
    // A trench with vertical walls from x = 4 to 5 m, 0.6 m deep.
    let profile = [(-20.0, 0.0), (4.0, 0.0), (4.0, -0.6), (5.0, -0.6), (5.0, 0.0), (20.0, 0.0)];
    let (rig, mesh) = (rig(256, 1), extruded(&profile));

    // From x = 0 the camera, 1.5 m up and 3.7 m before the edge, sees the upper 1.5 / 3.7 * 1 = 0.41 m of the far wall,
    // and no ground of the trench: nothing is known from 4.2 m on (one spacing is extrapolated beyond the edge).
    let mut mapper = start();
    mapper.update_from_scan(&sensed(0.0), scan(&rig, &mesh, 0.0), true);
    let ahead = obstacles(&mapper).sectors[15];
    assert_eq!(ahead.label, Label::Unknown);
    assert!((4.0..4.31).contains(&ahead.radius), "{ahead:?}");

    // The vehicle drives up to the trench without a scan. The near part stays hidden: both stripes jump from the edge
    // to the far wall. At x = 3.1 the front wheels' rims are at the edge.
    for step in 1..=31 {
        let x = 0.1 * f64::from(step);
        mapper.update(&sensed(x), frame(&rig, &mesh, x));
    }
    let ahead = obstacles(&mapper).sectors[15];
    assert_eq!(ahead.label, Label::Unknown);
    assert!((4.0..4.31).contains(&(ahead.radius + 3.1)), "{ahead:?}");

    // A scan from x = 2.8, with the camera 0.9 m before the edge: 0.6 / 1.5 * 0.9 = 0.36 m are hidden from it. 4.1 is
    // extrapolated from the edge, and 4.3 from the first visible ground, at 4.36, whose grid point is 4.4. 4.2 stays
    // unknown.
    let mut farther = mapper.clone();
    farther.update_from_scan(&sensed(2.8), scan(&rig, &mesh, 2.8), true);
    let ahead = obstacles(&farther).sectors[15];
    assert_eq!(ahead.label, Label::Unknown);
    assert!((ahead.radius + 2.8 - 4.2).abs() < 1e-9, "{ahead:?}");

    // A scan from x = 3.1: the edge is 0.6 m before camera and beams. The camera sees the ground of the trench from
    // 0.6 / 1.5 * 0.6 = 0.24 m behind the edge on, and beam 0 (1.8 m up) lights it from 0.2 m on. Extrapolation by one
    // spacing from each side closes this gap. The slope is then known: 0.6 m over 1.2 m; the maximum is 0.35 m over
    // 1.2 m.
    mapper.update_from_scan(&sensed(3.1), scan(&rig, &mesh, 3.1), true);
    let ahead = obstacles(&mapper).sectors[15];
    assert_eq!((ahead.label, ahead.failed), (Label::Obstacle, Some(TraversabilityTest::Length)));
    assert!((4.0..4.31).contains(&(ahead.radius + 3.1)), "{ahead:?}");
}

#[test]
fn a_rock_too_low_to_matter_hides_ground_and_gaps_may_be_crossed() {
    // A ridge 0.1 m thick at x = 4.5, so low that it fails neither a slope test nor the belly test. From x = 0 the
    // camera, 1.5 m up and 4.3 m before the ridge's far side, does not see the first h / (1.5 - h) * 4.3 m behind it.
    let ridge = |height: f64| {
        let profile = [(-20.0, 0.0), (4.5, 0.0), (4.5, height), (4.6, height), (4.6, 0.0), (20.0, 0.0)];
        let mut mapper = start();
        mapper.update_from_scan(&sensed(0.0), scan(&rig(256, 1), &extruded(&profile), 0.0), true);
        let vehicle = Vehicle::default();
        let grid = RadialGrid { last: 6.5, ..RadialGrid::for_vehicle(&vehicle) };
        let rules = TraversabilityRules::as_printed(&vehicle);
        [rules, rules.crossing_gaps(&vehicle)].map(|rules| {
            ObstacleMap::extract(mapper.map(), &vehicle, &rules, &grid, &mapper.pose()).sectors[15].label
        })
    };
    // h = 0.15: 0.48 m are hidden, from 4.6 to 5.08. Extrapolation fills 4.7 and 5.0, and 4.8 and 4.9 stay unknown. That is
    // no gap of 0.2 m: what was extrapolated is a guess, and a wheel of 0.25 m does not bridge 0.48 m.
    assert_eq!(ridge(0.15), [Label::Unknown, Label::Unknown]);
    // h = 0.06: 0.18 m are hidden, from 4.6 to 4.78: the grid points 4.7 and at most 4.8. A wheel bridges them.
    assert_eq!(ridge(0.06)[1], Label::Visibility);
}

/// Level ground with a post of 0.1 x 0.1 x 1 m, whose front face is at x = 9 m, in the middle of the way.
fn post() -> std::sync::Arc<Mesh> {
    let square = |z: f64, [x0, x1]: [f64; 2], y: f64| {
        [(x0, -y), (x1, -y), (x1, y), (x0, y)].map(|(x, y)| DVec3::new(x, y, z))
    };
    let corners =
        [square(0.0, [-20.0, 20.0], 20.0), square(0.0, [9.0, 9.1], 0.05), square(1.0, [9.0, 9.1], 0.05)];
    let mut faces = vec![[0, 1, 2], [0, 2, 3], [8, 9, 10], [8, 10, 11]];
    for side in 0..4 {
        let (a, b) = (4 + side, 4 + (side + 1) % 4);
        faces.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
    }
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let (vertices, face_materials) = (corners.concat(), vec![0; faces.len()]);
    std::sync::Arc::new(Ground { vertices, faces, face_materials, materials }.into_mesh().expect("a ground"))
}

#[test]
fn a_post_is_as_high_as_its_face_was_lit_until_the_far_stripe_has_climbed_the_clearance() {
    // The limit that docs/theory/rover.md states. The far sheet starts 2 m up and 0.3 m ahead, 22 degrees down: at the distance D it
    // stands 2 - (D - 0.3) tan 22 degrees high on the post. That is the clearance of 0.35 m at D = 4.38 m, and with the margin of
    // two standard errors, 2 cm and more, some 7 cm before it.
    let (rig, mesh) = (rig(128, 1), post());
    let mut mapper =
        Mapper::with_rules(Vehicle::default(), MapSize::default(), MapRules::MENDED, &sensed(0.0), 0.0);
    mapper.update_from_scan(&sensed(0.0), scan(&rig, &mesh, 0.0), true);
    let vehicle = Vehicle::default();
    let (rules, grid) = (TraversabilityRules::for_vehicle(&vehicle), RadialGrid::for_vehicle(&vehicle));
    let mut passed = Vec::new();
    for n in 1..=87 {
        let x = 0.06 * f64::from(n);
        mapper.update(&sensed(x), frame(&rig, &mesh, x));
        // The belly of a vehicle with its front axle at the last radius, 4.8 m, is over the post from here on.
        let distance = 9.0 - x;
        if distance > 4.75 {
            continue;
        }
        let end = ObstacleMap::extract(mapper.map(), &vehicle, &rules, &grid, &mapper.pose()).sectors[15];
        if end.radius > distance + 0.15 || end.label == Label::Visibility {
            passed.push(distance);
        }
    }
    let (first, last) = (passed[0], passed[passed.len() - 1]);
    // It is passed on 0.3 m of way, one second, and on none nearer.
    assert!(first > 4.7 && (4.38..4.52).contains(&last), "{passed:?}");
    assert_eq!(passed.len(), ((first - last) / 0.06).round() as usize + 1, "{passed:?}");
}
