//! Where everything stands: angles against the turns that made the pose, and the plan from above.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Pose, Scene, rig};
use raypencil_survey::{Attitude, Whereabouts, plan};

/// Heading to the left, pitch down, roll to the right, degrees: turns about z, then y, then x.
fn turned([heading, pitch, roll]: [f64; 3]) -> Pose {
    let turn = |axis, degrees: f64| Pose::from_axis_angle(axis, degrees.to_radians());
    turn(DVec3::Z, heading) * turn(DVec3::Y, pitch) * turn(DVec3::X, roll)
}

fn angles(of: Attitude) -> [f64; 3] {
    [of.heading_deg, of.pitch_down_deg, of.roll_right_deg]
}

fn assert_near(found: [f64; 3], expected: [f64; 3]) {
    let is_near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9);
    assert!(is_near, "{found:?} for {expected:?}");
}

#[test]
fn the_angles_are_those_that_made_the_pose() {
    for made in [[0.0; 3], [30.0, 20.0, 10.0], [-170.0, -45.0, 0.0], [90.0, 0.0, -15.0], [10.0, 89.0, 100.0]]
    {
        let pose = turned(made);
        assert_near(angles(Attitude::of_vehicle(&pose)), made);
        assert_near(angles(Attitude::of_sensor(&(pose * Pose::VEHICLE_FROM_FORWARD_SENSOR))), made);
    }
    // Straight down and straight up the heading is still that of the turn about z.
    assert_near(angles(Attitude::of_vehicle(&turned([40.0, 90.0, 0.0]))), [40.0, 90.0, 0.0]);
    assert_near(angles(Attitude::of_vehicle(&turned([40.0, -90.0, 0.0]))), [40.0, -90.0, 0.0]);
}

/// The default rig in the middle of a flat square of 40 m.
fn scene() -> Scene {
    let corners = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)];
    let corners = corners.map(|(x, y)| DVec3::new(x, y, 0.0));
    let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    let mesh = Mesh::from_global(&corners, vec![[0, 1, 2], [0, 2, 3]], vec![0; 2], vec![sand]).unwrap();
    let (camera, beams) = rig::default_rig(32, DVec3::ZERO, 0.0);
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric).unwrap()
}

#[test]
fn the_default_rig_stands_where_its_mounts_are() {
    let found = Whereabouts::of(&scene(), Some(&Pose::IDENTITY));
    assert_eq!(
        found.vehicle_line(),
        "vehicle at (0.00, 0.00, 0.00) m, heading 0.0°, pitch down 0.0°, roll 0.0°"
    );
    let beam = "beam-1 at (0.30, 0.00, 2.00) m, heading 0.0°, pitch down 22.0°, roll 0.0°";
    assert_eq!(found.lines()[2], format!("{beam}; sees a fan of 60.0°, to 20.0 m"));
    // An image of 32 pixels of 288 um behind 8 mm: 2 atan(4.608 / 8) = 59.8839 degrees.
    assert!((found.sensors[0].field_of_view_deg[0] - 59.8839).abs() < 1e-4, "{found:?}");
    assert!(
        found.terrain_line().starts_with("terrain x -20.00 to 20.00, y -20.00 to 20.00, z 0.00 to "),
        "{found:?}"
    );
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!(json["sensors"][1]["sensor"], "beam-0");
    assert_eq!(json["vehicle"]["position_m"], serde_json::json!([0.0, 0.0, 0.0]));
    assert_eq!(Whereabouts::of(&scene(), None).vehicle_line(), "no vehicle: sensors alone");
}

#[test]
fn an_off_centre_image_keeps_both_halves_of_its_view() {
    let scene = scene();
    let mut camera = *scene.camera();
    // All of the image is to the right of the axis: from 0 to atan(32 x 288 um / 8 mm) = 49.0402 degrees.
    camera.sensor.principal_point[0] = 0.0;
    let moved =
        Scene::new(scene.mesh().clone(), camera, Vec::new(), scene.atmosphere(), scene.flux_model()).unwrap();
    let view = Whereabouts::of(&moved, None).sensors[0].field_of_view_deg;
    assert!((view[0] - 49.0402).abs() < 1e-3, "{view:?}");
}

#[test]
fn the_plan_has_a_scale_and_what_stands_in_it() {
    let drawing = plan(&scene(), Some(&Pose::IDENTITY));
    let svg = drawing.svg();
    // 22 m to each side: a bar of 10 m, since 20 m would be more than a third of 44 m.
    for words in ["10 m</text>", "x, heading 0</text>", "camera</text>", "beams</text>", "terrain</text>"] {
        assert!(svg.contains(words), "{words} is not in {svg}");
    }
    // Terrain and vehicle are filled; the views of a camera and two beams, four lines of axes, and the bar are not.
    assert_eq!(svg.matches("fill=\"none\"").count(), 3 + 4 + 1);
    // The ground ends 20 m from the middle, at 20/22 of 170 pixels from 210: at 55.5 and 364.5.
    assert!(svg.contains("M55.5,364.5L364.5,364.5L364.5,55.5L55.5,55.5z"), "{svg}");
    // Without a vehicle the plan is about the camera, and has no arrow.
    let alone = plan(&scene(), None).svg();
    assert_eq!(svg.matches("z\" fill").count() - alone.matches("z\" fill").count(), 1);
}

#[test]
fn rounded_vertices_are_counted_and_the_largest_move_is_told() {
    let mesh = |corners: &[DVec3]| {
        let sand = Material { name: "sand".into(), reflectivity: 0.25 };
        Mesh::from_global(corners, vec![[0, 1, 2]], vec![0], vec![sand]).unwrap()
    };
    let stands = |mesh: Mesh| {
        let (camera, beams) = rig::default_rig(32, DVec3::ZERO, 0.0);
        let air = Atmosphere { attenuation: 0.0 };
        let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric).unwrap();
        Whereabouts::of(&scene, None)
    };
    // All offsets are f32 numbers.
    let whole = stands(mesh(&[DVec3::ZERO, DVec3::X, DVec3::Y]));
    assert_eq!(whole.rounding_line(), "3 vertices, none of them rounded");
    // Between 1 and 2 metres f32 numbers are 2^-23 = 8 * 2^-26 apart: 2 * 2^-26 and 3 * 2^-26 are rounded away.
    let fine = |parts: f64| DVec3::new(1.0 + parts / 67_108_864.0, 0.0, 0.0);
    let moved = stands(mesh(&[fine(2.0), fine(3.0), DVec3::Y]));
    assert_eq!((moved.rounded_vertices.count, moved.rounded_vertices.of), (2, 3));
    assert_eq!(moved.rounded_vertices.largest_m, 3.0 / 67_108_864.0);
    assert_eq!(moved.rounding_line(), "3 vertices, 2 rounded to f32 offsets, by 4.5e-8 m at most");
    // Far out the origin is 2^24 in x: then 2^-28 is an offset that f32 holds, though it holds no such coordinate.
    let far = DVec3::new(16_777_216.0, 0.0, 0.0);
    let lost = stands(mesh(&[far, far + DVec3::X / 268_435_456.0, far + DVec3::Y]));
    assert_eq!(lost.rounded_vertices.count, 0, "{lost:?}");
}
