//! Faces that never hide others, and margins of visibility by hand.

use std::sync::Arc;

use glam::DQuat;
use raypencil_scene::{
    Atmosphere, Beam, Camera, FaceId, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Scene,
};

use super::*;
use crate::hits::face::ExactRay;
use crate::hits::ruling::{Ruling, Tolerance};
use crate::rays::displacement::Displacement;
use crate::visibility::line_of_sight::ExactLineOfSight;

fn face(corners: [[f32; 3]; 3]) -> Face {
    Face { id: FaceId(0), corners }
}

/// The ground of these tests: its front up, seen by a camera above it.
fn ground() -> Face {
    face([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]])
}

const EYE: DVec3 = DVec3::new(0.0, 0.0, 10.0);

#[test]
fn a_face_that_hides_something_is_never_let_go() {
    // Above the middle, either side up.
    let lid = [[0.5, 0.5, 5.0], [1.0, 0.5, 5.0], [0.5, 1.0, 5.0]];
    assert!(!never_occludes(&face(lid), &ground(), EYE));
    assert!(!never_occludes(&face([lid[0], lid[2], lid[1]]), &ground(), EYE));
    // Leaning on a corner of the ground, over it; and half of it below the ground.
    assert!(!never_occludes(&face([[0.0, 0.0, 0.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]]), &ground(), EYE));
    assert!(!never_occludes(&face([[1.0, 1.0, -2.0], [1.0, 2.0, -2.0], [0.25, 1.0, 4.0]]), &ground(), EYE));
    // Wider than the ground, on all sides of it.
    assert!(!never_occludes(
        &face([[-9.0, -9.0, 2.0], [19.0, -9.0, 2.0], [-9.0, 19.0, 2.0]]),
        &ground(),
        EYE
    ));
}

#[test]
fn reason_1_a_face_at_or_behind_the_grounds_plane_hides_nothing() {
    for z in [0.0, -1.0] {
        assert!(never_occludes(&face([[1.0, 1.0, z], [2.0, 1.0, -1.0], [1.0, 2.0, -2.0]]), &ground(), EYE));
    }
}

#[test]
fn reason_2_a_face_behind_whose_plane_no_ground_lies_hides_nothing() {
    // A wall that cuts the ground's plane beside it, leaning outward: camera and ground on one side of it. In the
    // camera's image it crosses the ground's sides drawn on, and the ground the wall's.
    let wall = [[6.0, -20.0, -1.0], [6.0, 20.0, -1.0], [6.0, 1.0, 9.0]];
    assert!(never_occludes(&face(wall), &ground(), EYE));
    assert!(never_occludes(&face([wall[0], wall[2], wall[1]]), &ground(), EYE));
    // Touching the ground with an edge is no hiding either.
    let on_edge = [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 4.0, 5.0]];
    assert!(never_occludes(&face(on_edge), &ground(), EYE));
}

#[test]
fn reason_3_a_plane_through_the_camera_and_a_side_keeps_them_apart() {
    // Level, 5 m up: behind it, as seen from the camera, lies all the ground's plane. Image points are twice as far
    // out. By the ground's sides:
    for beside in [
        [[2.5, 0.0, 5.0], [4.0, 0.0, 5.0], [2.5, 2.0, 5.0]],
        [[0.0, -1.0, 5.0], [1.0, -1.0, 5.0], [0.0, -0.5, 5.0]],
        [[-1.0, 0.0, 5.0], [-0.5, 1.0, 5.0], [-1.0, 1.0, 5.0]],
    ] {
        assert!(never_occludes(&face(beside), &ground(), EYE), "{beside:?}");
        assert!(never_occludes(&face([beside[0], beside[2], beside[1]]), &ground(), EYE), "{beside:?}");
    }
    // By a side of its own alone: every side of the ground, drawn on, crosses its image, of which one side is the line
    // y = 5 - 0.9 x. Whichever of its corners comes first.
    let bar = [[-10.0, 11.5, 5.0], [15.0, -11.0, 5.0], [15.0, 15.0, 5.0]];
    for k in 0..3 {
        let turned = [bar[k], bar[(k + 1) % 3], bar[(k + 2) % 3]];
        assert!(never_occludes(&face(turned), &ground(), EYE), "{k}");
    }
    // One that shares a corner with the ground and rises away from it: the corner is in the plane, and shared.
    assert!(never_occludes(&face([[4.0, 0.0, 0.0], [6.0, 0.0, 4.0], [6.0, 1.0, 4.0]]), &ground(), EYE));
    // One with a corner in that plane that is not shared: the line may meet both.
    let touching = [[2.0, 0.0, 5.0], [4.0, 0.0, 5.0], [4.0, 2.0, 5.0]];
    let by_own_sides_too = never_occludes(&face(touching), &ground(), EYE);
    assert!(!by_own_sides_too, "its corner's image is the ground's corner");
}

/// A camera at (1, 2, 10) and a beam that looks straight down from 8 m onto level ground of one face. Its middle
/// pencil meets (0, 0, 0); a cell is 8 `step` m across and `row` m down.
fn level(size: f32, step: f64, row: f64) -> Scene {
    level_with(size, step, row, &[])
}

/// The same with more faces.
fn level_with(size: f32, step: f64, row: f64, others: &[[[f32; 3]; 3]]) -> Scene {
    let material = Material { name: "ground".into(), reflectivity: 0.25 };
    let mut vertices = vec![[-size, -size, 0.0], [2.0 * size, -size, 0.0], [-size, 2.0 * size, 0.0]];
    vertices.extend(others.iter().flatten());
    let count = 1 + others.len();
    let faces = (0..count as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    let mesh = Mesh::new(DVec3::ZERO, vertices, faces, vec![0; count], vec![material]).expect("a mesh");
    let down = |position: DVec3| Pose { position, rotation: DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0) };
    let camera = Camera {
        width: 8,
        height: 8,
        pixel_pitch: [1e-3; 2],
        focal_length: 8e-3,
        principal_point: [4.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 3,
        rows: 3,
        thickness: 3.0 * row,
        grid_distance: 1.0,
        half_width: 1.5 * step,
        max_range: 20.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    let camera = Mounted { scene_from_sensor: down(DVec3::new(1.0, 2.0, 10.0)), sensor: camera };
    let beam = Mounted { scene_from_sensor: down(DVec3::new(0.0, 0.0, 8.0)), sensor: beam };
    Scene::new(Arc::new(mesh), camera, vec![beam], Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .expect("a scene")
}

fn ways_of(scene: &Scene) -> RayBundle {
    let referee = Referee::new(scene);
    let sensor = MountedSensor::of(scene, SensorId::Beam(0)).expect("a beam");
    let aim = Aim { i: 1, j: 1, dx: 0.0, dy: 0.0 };
    let near = Neighbourhood::new(&referee, &sensor, aim);
    let face = near.faces[0].face;
    let parts = LineOfSight::parts(&sensor, aim, face, scene.camera());
    let view = VisibilitySearch {
        referee: &referee,
        sensor: &sensor,
        aim,
        near,
        visible: true,
        hit_faces: HashMap::new(),
        known_displacements: HashMap::new(),
    };
    view.lines_to(face, &parts)
}

#[test]
fn the_ways_to_what_is_hit_are_a_narrow_bundle() {
    let eye = DVec3::new(1.0, 2.0, 10.0);
    // Small cells: half a metre across and a quarter down about the middle's own point.
    let bundle = ways_of(&level(4.0, 0.0625, 0.25));
    let (length, radius) = (eye.length(), libm::hypot(0.5, 0.25));
    assert_eq!(bundle.origin, eye);
    assert!((bundle.direction + eye / length).length() < 1e-12, "{}", bundle.direction);
    assert!((bundle.max_range - (length + radius)).abs() < 1e-6, "{}", bundle.max_range);
    assert!((bundle.spread - radius / (length - radius)).abs() < 1e-6, "{}", bundle.spread);
    // Cells so large that the face itself is smaller: about its centre, (0, 0, 0) as well, to its farthest corner.
    let bundle = ways_of(&level(0.5, 0.5, 2.0));
    let radius = libm::hypot(1.0, 0.5);
    assert!((bundle.direction + eye / length).length() < 1e-12, "{}", bundle.direction);
    assert!((bundle.max_range - (length + radius)).abs() < 1e-6, "{}", bundle.max_range);
    assert!((bundle.spread - radius / (length - radius)).abs() < 1e-6, "{}", bundle.spread);
}

/// The way of one point is a line as long as it, in units of its length.
#[test]
fn the_way_to_a_point_ends_there() {
    let scene = level(4.0, 0.0625, 0.25);
    let referee = Referee::new(&scene);
    let sensor = MountedSensor::of(&scene, SensorId::Beam(0)).expect("a beam");
    let ray = ExactRay::new(&sensor, Aim { i: 1, j: 1, dx: 0.0, dy: 0.0 });
    let ground = Face::of(referee.scene.mesh(), FaceId(0));
    let bundle = ExactLineOfSight::new(&ray, &ground, scene.camera()).bundle();
    assert!((bundle.direction.length() - 1.0).abs() < 1e-12, "{}", bundle.direction);
    let end = bundle.origin + bundle.direction * bundle.max_range;
    assert!(end.length() < 1e-12 && bundle.start_radius == 0.0 && bundle.spread == 0.0, "{bundle:?}");
}

/// Two thirds of a lid 1 m above the ground, whose two faces meet along a line from its middle to the left. The
/// camera sees the ground's (x, y) through the lid's (0.9 x + 0.1, 0.9 y + 0.2). Pencils pass the lid from behind.
/// Cells are 1/4 m, and the camera sees the lid's middle one and a half cells to the right of the point. The line of
/// the missing third's side crosses a corner of the region that a pencil may hit; the side itself does not.
#[test]
fn a_lid_of_several_faces_hides_as_one() {
    let (middle, left) = ([0.4375, 0.2, 1.0], [-4.5625, 0.2, 1.0]);
    let (up, down) = ([2.4375, 3.7, 1.0], [2.4375, -3.3, 1.0]);
    let of = |lid: &[[[f32; 3]; 3]]| {
        let scene = level_with(4.0, 0.03125, 0.25, lid);
        let margins = Referee::new(&scene).visibility_margins(0, 1, 1).expect("a pencil");
        (margins.sight.visible, margins.visibility)
    };
    assert_eq!(of(&[]), (true, Margin::CAPPED));
    let (visible, margin) = of(&[[middle, left, up], [middle, down, left]]);
    assert!(!visible);
    assert_eq!(margin, Margin::CAPPED, "hidden all over");
    // Of the lower half alone the upper side leaves the upper half of the ground open: it lies above y = 0.
    let (visible, margin) = of(&[[middle, down, left]]);
    assert!(!visible && margin.lo < 1e-6 && margin.hi < 1e-3, "{margin:?}");
    // A little higher it hides the point by a part of a cell, 0.1 m / 0.9 of 1/4 m.
    let higher = |[x, y, z]: [f32; 3]| [x, y + 0.1, z];
    let (visible, margin) = of(&[[higher(middle), higher(down), higher(left)]]);
    let edge = 0.1 / 0.9 / 0.25;
    assert!(!visible && margin.lo <= edge && edge <= margin.hi && margin.hi < 1.5 * margin.lo, "{margin:?}");
}

/// A lid so small that it hides one displaced ray alone excuses an answer if that ray is within the tolerance: in
/// each of the eight directions that are tried.
#[test]
fn a_ray_beside_excuses_what_is_true_of_it() {
    for (x, y) in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (x, y))).filter(|at| *at != (0, 0)) {
        let (dx, dy) = (f64::from(x), f64::from(y));
        // A cell is 1/4 m, y down in the beam; seen through the plane 1 m up. A tenth of a cell about it.
        let [to_x, to_y] = [0.9 * 0.25 * dx + 0.1, -0.9 * 0.25 * dy + 0.2].map(|at| at as f32);
        let lid =
            [[to_x - 0.025, to_y - 0.025, 1.0], [to_x, to_y + 0.05, 1.0], [to_x + 0.025, to_y - 0.025, 1.0]];
        let scene = level_with(4.0, 0.03125, 0.25, &[lid]);
        let referee = Referee::new(&scene);
        let pixel = referee.visibility(0, 1, 1, Displacement::ZERO).expect("a pencil").pixel;
        let rule = |lateral: f64| {
            let tolerance = Tolerance { lateral, depth: 0.0, position: 0.0, unit_roundoff: 0.0 };
            let ruled =
                referee.rule_visibility(0, 1, 1, Displacement::ZERO, FaceId(0), false, pixel, tolerance);
            ruled.expect("a pencil").visible
        };
        assert_eq!(rule(1.0), Ruling::Rounding(Displacement { dx, dy }), "{dx},{dy}");
        assert_eq!(rule(0.5), Ruling::Wrong, "{dx},{dy}");
        assert_eq!(rule(7.0), rule(1.0), "a cell at most");
    }
}

/// A lid covers a part as large as the part that its conditions hold in, and no larger one.
#[test]
fn a_lid_covers_what_its_conditions_hold_in() {
    let always = Form { constant: 1.0, x: 0.0, y: 0.0, xy: 0.0, error: 0.0, bend: 0.0 };
    let before_the_point = Form { constant: 0.5, x: 1.0, ..always };
    let face = ground();
    let hides = [always, always, always, always, before_the_point, always];
    let lid = Occluder { face: &face, turned_to_camera: true, hides };
    let hit = HitFace { is_front_seen: true, lands: [always; 5], occluders: vec![lid] };
    let is_covered = |half: f64| hit.is_covered(&Square { middle: [0.0; 2], half });
    let most = before_the_point.holds_within();
    assert!((most - 0.5).abs() < 1e-11 && is_covered(most) && !is_covered(most.next_up()), "{most}");
}

/// The line of a side may cross a part where the side itself does not. Of two faces with a common edge, along dy = -1/4, the lower one ends on
/// the right at (1, -1/4), and its other side there runs on, as a line, through the part above the common edge.
#[test]
fn a_side_beyond_its_end_leaves_a_part_covered() {
    let form = |constant: f64, x: f64, y: f64| Form { constant, x, y, xy: 0.0, error: 1e-15, bend: 0.0 };
    let always = form(1.0, 0.0, 0.0);
    let [end, left, up, down] = [[1.0, 0.0], [-9.0, 0.0], [9.0, 9.0], [9.0, -9.0]].map(|[x, y]| [x, y, 1.0]);
    let (upper, lower) = (face([end, left, up]), face([end, down, left]));
    let above = form(0.25, 0.0, 1.0);
    // Through (1, -1/4) and (1/4, 1/4).
    let side = form(5.0 / 12.0, -2.0 / 3.0, -1.0);
    let occluder = |face, sides: [Form; 3]| {
        let [a, b, c] = sides;
        Occluder { face, turned_to_camera: true, hides: [a, b, c, always, always, always] }
    };
    let covered_by = |occluders| {
        let hit = HitFace { is_front_seen: true, lands: [always; 5], occluders };
        hit.is_covered(&Square { middle: [0.0; 2], half: 0.5 })
    };
    let above_it = || occluder(&upper, [above, always, always]);
    assert!(covered_by(vec![above_it(), occluder(&lower, [side, always, above.negated()])]));
    assert!(!covered_by(vec![above_it()]));
    // A side through the lower face itself leaves a part open.
    let nearer = form(0.0, -1.0, -0.5);
    assert!(!covered_by(vec![above_it(), occluder(&lower, [nearer, always, above.negated()])]));
}
