//! Scenes whose answer is known in closed form, asserted on both renderers. (Contract: camera, beam, hit)
//!
//! Unless stated otherwise, the sensor is at the scene's origin with the scene's axes: z is forward, x right and y
//! down. Both sensors have dyadic numbers: see [`small_camera`] and [`small_beam`].

use std::f64::consts::FRAC_PI_6;
use std::sync::Arc;

use approx::assert_abs_diff_eq;
use glam::{DQuat, DVec3};
use raypencil::{Beam, Camera, FaceId, Mesh, Mounted, Pose, Scene, SensorId, SensorMap};
use raypencil_tests::{at_origin, cells_hit, for_each_map, for_each_map_of, hit, mesh, rig, scene};

/// Maximum error of a renderer, in metres or without a unit: the bound 36 kappa u S / c of the comparison for the
/// widest of these scenes (S = R + longest edge <= 200 m, aspect kappa <= 3, cosine c >= 1/30).
const MAX_ERROR: f64 = 36.0 * 3.0 * 1.2e-16 * 200.0 * 30.0;

type Triangle = [[f32; 3]; 3];

/// A mesh of loose triangles.
fn soup(triangles: &[Triangle]) -> Arc<Mesh> {
    let faces = (0..triangles.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]);
    mesh(triangles.concat(), faces.collect())
}

/// A rectangle of two faces at depth `z`, their fronts to the origin.
fn screen(z: f32, [left, right]: [f32; 2], [top, bottom]: [f32; 2]) -> [Triangle; 2] {
    // Down the left side first: seen with y down this is counter-clockwise.
    let (a, b, c, d) = ([left, top, z], [left, bottom, z], [right, bottom, z], [right, top, z]);
    [[a, b, c], [a, c, d]]
}

/// The triangle, wound so that `viewer` sees its front.
fn facing(viewer: [f32; 3], [a, b, c]: Triangle) -> Triangle {
    let [p, q, r, eye] = [a, b, c, viewer].map(|v| DVec3::from_array(v.map(f64::from)));
    if (q - p).cross(r - p).dot(eye - p) > 0.0 { [a, b, c] } else { [a, c, b] }
}

/// The triangle with front and back exchanged.
fn reversed([a, b, c]: Triangle) -> Triangle {
    [a, c, b]
}

/// 16 x 16 pixels of 1/16 m at f_c = 1/2 m: x_i = (2i - 15) / 32 m, and y_j alike.
fn small_camera() -> Camera {
    rig::camera(16, 16, 0.0625, 0.5)
}

/// 16 columns of 1/16 m at g = 1/2 m, so x_i = (2i - 15) / 32 m as in [`small_camera`]; 4 rows 1/256 m apart, so
/// y_j = (2j - 3) / 512 m.
fn small_beam() -> Beam {
    rig::beam(16, 4, [0.0625, 1.0 / 256.0], 0.5)
}

/// x_i of [`small_camera`] and [`small_beam`], y_j of [`small_camera`], metres on the SPP.
fn centre(index: u32) -> f64 {
    (2.0 * f64::from(index) - 15.0) / 32.0
}

/// y_j of [`small_beam`], metres.
fn row(j: u32) -> f64 {
    (2.0 * f64::from(j) - 3.0) / 512.0
}

/// The triangles before [`small_camera`] and [`small_beam`].
fn before_both(triangles: &[Triangle]) -> Scene {
    scene(soup(triangles), at_origin(small_camera()), vec![at_origin(small_beam())])
}

/// The triangles before one camera.
fn before_camera(triangles: &[Triangle], camera: Camera) -> Scene {
    scene(soup(triangles), at_origin(camera), Vec::new())
}

/// The expected hit.
struct Known {
    face: u32,
    range: f64,
    depth: f64,
    point: [f64; 3],
    normal: [f64; 3],
    cos_incidence: f64,
}

/// Asserts the hit of cell (i, j).
fn assert_hit(what: &str, map: &SensorMap, (i, j): (u32, u32), known: &Known) {
    let Some(hit) = hit(map, i, j) else { panic!("{what} {i},{j}: no hit") };
    println!("{what} {i},{j}");
    assert_eq!(hit.face, FaceId(known.face), "{what} {i},{j}");
    assert_abs_diff_eq!(hit.range, known.range, epsilon = MAX_ERROR);
    assert_abs_diff_eq!(hit.depth, known.depth, epsilon = MAX_ERROR);
    for axis in 0..3 {
        assert_abs_diff_eq!(hit.point[axis], known.point[axis], epsilon = MAX_ERROR);
        assert_abs_diff_eq!(hit.normal[axis], known.normal[axis], epsilon = MAX_ERROR);
    }
    assert_abs_diff_eq!(hit.cos_incidence, known.cos_incidence, epsilon = MAX_ERROR);
}

/// Asserts that a cell hits if and only if `is_hit` returns true.
fn assert_hits_exactly(what: &str, map: &SensorMap, is_hit: impl Fn(u32, u32) -> bool) {
    let cells = (0..map.height).flat_map(|j| (0..map.width).map(move |i| (i, j)));
    let expected: Vec<_> = cells.filter(|&(i, j)| is_hit(i, j)).collect();
    assert_eq!(cells_hit(map), expected, "{what}");
}

/// Asserts the range of each cell, or a miss where `range` is `None`.
fn assert_ranges(what: &str, map: &SensorMap, range: impl Fn(u32, u32) -> Option<f64>) {
    for j in 0..map.height {
        for i in 0..map.width {
            match (hit(map, i, j), range(i, j)) {
                (Some(hit), Some(range)) => {
                    assert!(
                        (hit.range - range).abs() <= MAX_ERROR,
                        "{what} {i},{j}: {} not {range}",
                        hit.range
                    );
                }
                (None, None) => {}
                (found, range) => panic!("{what} {i},{j}: {found:?}, but the range is {range:?}"),
            }
        }
    }
}

/// |q| / f of a cell: metres of range per metre of depth. The q of a beam has no y component.
fn secant(sensor: SensorId, i: u32, j: u32) -> f64 {
    let y = if sensor == SensorId::Camera { centre(j) } else { 0.0 };
    let x = centre(i);
    ((x * x + y * y) / 0.25 + 1.0).sqrt()
}

// ---- Ranges, depths, points, normals, cosines -------------------------------------------------------

/// Level ground z = 0 (z up), a sensor 1 m above the scene's origin that looks along x, 30 degrees down.
fn level_ground() -> [Triangle; 2] {
    // All rays hit the second face, which is on one side of the diagonal y = x - 4.
    let (a, b, c, d) = ([-4.0, -8.0, 0.0], [12.0, -8.0, 0.0], [12.0, 8.0, 0.0], [-4.0, 8.0, 0.0]);
    [[a, b, c], [a, c, d]]
}

#[test]
fn level_ground_under_a_camera_that_looks_thirty_degrees_down() {
    // Pixels are f tan 30 degrees wide: 3 x 3 of them look 0, 30 and 60 degrees down, and tan 30 sideways.
    let (tan, sqrt_3) = (1.0 / 3.0_f64.sqrt(), 3.0_f64.sqrt());
    let camera = rig::camera(3, 3, 0.125 * tan, 0.125);
    let mounted = rig::pitched(DVec3::new(0.0, 0.0, 1.0), FRAC_PI_6, camera);
    let scene = scene(soup(&level_ground()), mounted, Vec::new());
    let known = |range: f64, depth: f64, x: f64, y: f64| Known {
        face: 1,
        range,
        depth,
        point: [x, y, 0.0],
        normal: [0.0, 0.0, 1.0],
        // 1 m of height over the range.
        cos_incidence: 1.0 / range,
    };
    for_each_map(&scene, |what, map| {
        // The middle pixel: R = 1 / sin 30 = 2 m, cos(psi) = sin 30 = 1/2, sqrt 3 m ahead.
        assert_hit(what, map, (1, 1), &known(2.0, 2.0, sqrt_3, 0.0));
        // Sideways the depth stays 2 m, the point moves 2 tan 30, and R = 2 / cos 30. Column 0 looks left,
        // which is +y.
        let aside = 2.0 * tan;
        assert_hit(what, map, (0, 1), &known(4.0 * tan, 2.0, sqrt_3, aside));
        assert_hit(what, map, (2, 1), &known(4.0 * tan, 2.0, sqrt_3, -aside));
        // 60 degrees down, in the lower row: R = 1 / sin 60, depth = R cos 30 = 1 m, 1 / tan 60 ahead.
        assert_hit(what, map, (1, 2), &known(2.0 * tan, 1.0, tan, 0.0));
        // A corner: q = (-tan 30, tan 30, 1) falls sin 30 + tan 30 cos 30 = 1 m, |q|^2 = 1 + 2/3.
        let corner = (5.0_f64 / 3.0).sqrt();
        assert_hit(what, map, (0, 2), &known(corner, 1.0, tan, tan));
        assert_hit(what, map, (2, 2), &known(corner, 1.0, tan, -tan));
        // The upper row is horizontal: no hits.
        for i in 0..3 {
            assert_eq!(hit(map, i, 0), None, "{what}");
        }
    });
}

#[test]
fn level_ground_under_a_beam_that_looks_thirty_degrees_down() {
    // 3 columns at -30, 0 and 30 degrees, for which the half width is 3/2 g tan 30; 3 rows 2 mm apart.
    let tan = 1.0 / 3.0_f64.sqrt();
    let cos = 0.75_f64.sqrt();
    let beam = Beam { half_width: 1.5 * 0.125 * tan, ..rig::beam(3, 3, [0.0625, 0.002], 0.125) };
    let mounted = rig::pitched(DVec3::new(0.0, 0.0, 1.0), FRAC_PI_6, beam);
    let scene = scene(soup(&level_ground()), at_origin(small_camera()), vec![mounted]);
    for_each_map_of(&scene, SensorId::Beam(0), |what, map| {
        for (j, y) in [(0, -0.002), (1, 0.0), (2, 0.002)] {
            // The row starts y below the beam's centre along its y axis, (-sin 30, 0, -cos 30) in the
            // vehicle: at height h = 1 - y cos 30, and sin 30 y further back.
            let height = 1.0 - y * cos;
            let depth = 2.0 * height;
            let x = -0.5 * y + depth * cos;
            let known = |range: f64, y: f64| Known {
                face: 1,
                range,
                depth,
                point: [x, y, 0.0],
                normal: [0.0, 0.0, 1.0],
                cos_incidence: height / range,
            };
            assert_hit(what, map, (1, j), &known(depth, 0.0));
            // 30 degrees aside: depth tan 30 to the left (+y) or the right, R = depth / cos 30.
            assert_hit(what, map, (0, j), &known(depth / cos, depth * tan));
            assert_hit(what, map, (2, j), &known(depth / cos, -depth * tan));
        }
    });
}

#[test]
fn a_slope_of_three_in_four() {
    // The plane 3 y + 4 z = 8 (m), which meets the axis at z = 2 m: n = (0, -3, -4) / 5 looks back and up.
    // The ray of pixel (i, j): 3 t y + 4 t / 2 = 8, t = 8 / (3 y + 2). Depth = t / 2, cos(psi) = (3/5 y +
    // 4/5 * 1/2) / |q|. A pencil starts at y_j and keeps it: 2 t = 8 - 3 y_j.
    let z = |y: f32| (8.0 - 3.0 * y) / 4.0;
    let [left, right, top, bottom] = [-16.0, 16.0, -24.0, 2.0];
    let corners = [[left, top, z(top)], [left, bottom, z(bottom)], [right, bottom, z(bottom)]];
    let other = [corners[0], corners[2], [right, top, z(top)]];
    // The diagonal is the line x / 16 = (y + 11) / 13. The second face is where y is smaller (up).
    let scene = before_both(&[corners, other]);
    let normal = [0.0, -0.6, -0.8];
    for_each_map(&scene, |what, map| {
        for (i, j) in [(0, 0), (7, 1), (15, 3), (4, 2)] {
            let x = centre(i);
            let (start, y, t) = match map.sensor {
                SensorId::Camera => (0.0, centre(j), 8.0 / (3.0 * centre(j) + 2.0)),
                SensorId::Beam(_) => (row(j), 0.0, (8.0 - 3.0 * row(j)) / 2.0),
            };
            let q_length = (x * x + y * y + 0.25).sqrt();
            let point = [t * x, start + t * y, 0.5 * t];
            // The face depends on the side of the diagonal.
            let face = u32::from(point[0] / 16.0 > (point[1] + 11.0) / 13.0);
            let cos_incidence = (0.6 * y + 0.4) / q_length;
            let known = Known { face, range: t * q_length, depth: 0.5 * t, point, normal, cos_incidence };
            assert_hit(what, map, (i, j), &known);
        }
    });
}

#[test]
fn range_is_distance_along_the_ray_not_depth() {
    // The plane z = 2 m: depth 2 everywhere. In the camera's corner q = (15, 15, 16) / 32, so R = 2 |q| / f
    // = 2 sqrt(1 + 2 (15/16)^2) = sqrt(706) / 8; at the beam's end q has no y: R = 2 sqrt(1 + (15/16)^2) =
    // sqrt(481) / 8.
    let scene = before_both(&screen(2.0, [-4.0, 5.0], [-4.0, 4.0]));
    for_each_map(&scene, |what, map| {
        let (range, j) = match map.sensor {
            SensorId::Camera => (706.0_f64.sqrt() / 8.0, 15),
            SensorId::Beam(_) => (481.0_f64.sqrt() / 8.0, 3),
        };
        let hit = hit(map, 15, j).expect("the plane fills the view");
        assert_abs_diff_eq!(hit.range, range, epsilon = MAX_ERROR);
        assert_abs_diff_eq!(hit.depth, 2.0, epsilon = MAX_ERROR);
        assert_ranges(what, map, |i, j| Some(2.0 * secant(map.sensor, i, j)));
    });
}

#[test]
fn ranges_jump_at_the_column_of_a_step() {
    // Near at 2 m where x < 0, which is columns 0 to 7; far at 4 m everywhere.
    let near = screen(2.0, [-4.0, 0.0], [-4.0, 4.0]);
    let far = screen(4.0, [-8.0, 8.0], [-8.0, 8.0]);
    let scene = before_both(&[far, near].concat());
    for_each_map(&scene, |what, map| {
        let depth = |i: u32| if i < 8 { 2.0 } else { 4.0 };
        assert_ranges(what, map, |i, j| Some(depth(i) * secant(map.sensor, i, j)));
    });
}

#[test]
fn ranges_jump_at_the_row_of_a_step() {
    // Near at 2 m where y > 0: the lower half of the rows, 8 to 15 of the camera, 2 and 3 of the beam.
    let near = screen(2.0, [-4.0, 4.0], [0.0, 4.0]);
    let far = screen(4.0, [-8.0, 8.0], [-8.0, 8.0]);
    let scene = before_both(&[near, far].concat());
    for_each_map(&scene, |what, map| {
        let depth = |j: u32| if j < map.height / 2 { 4.0 } else { 2.0 };
        assert_ranges(what, map, |i, j| Some(depth(j) * secant(map.sensor, i, j)));
    });
}

#[test]
fn the_nearest_of_many_sheets_is_hit() {
    // Seven sheets at 3, 1, 7, 2, 5, 6, 4 m: the one at 1 m, faces 2 and 3, hides the others.
    let sheets = [3.0, 1.0, 7.0, 2.0, 5.0, 6.0, 4.0].map(|z| screen(z, [-8.0, 8.0], [-8.0, 8.0])).concat();
    for_each_map(&before_both(&sheets), |what, map| {
        assert_ranges(what, map, |i, j| Some(secant(map.sensor, i, j)));
        assert!(cells_hit(map).iter().all(|&(i, j)| [2, 3].contains(&hit(map, i, j).unwrap().face.0)));
    });
}

#[test]
fn among_coincident_faces_the_lowest_index_is_reported() {
    // Three copies of the same two faces at 2 m: faces 0 and 1 win everywhere.
    let sheet = screen(2.0, [-4.0, 4.0], [-4.0, 4.0]);
    for_each_map(&before_both(&[sheet, sheet, sheet].concat()), |what, map| {
        let faces = cells_hit(map).into_iter().map(|(i, j)| hit(map, i, j).unwrap().face.0);
        assert!(faces.clone().all(|face| face < 2), "{what}: {:?}", faces.collect::<Vec<_>>());
        assert_hits_exactly(what, map, |_, _| true);
    });
}

// ---- The SPP ----------------------------------------------------------------------------------------

/// A floor y = 1/4 m under [`small_camera`], and a wall x = 1/4 m right of [`small_beam`], both cut by the SPP z = 1/2
/// m: the ray of row (column) k meets it at t = 1/4 / centre(k), which is at least 1 up to centre(k) = 7/32 (k = 11),
/// and below 1 from 9/32 on. `triangle` gives the (across, z) of the corners.
fn cut_by_the_spp(triangle: [[f32; 2]; 3]) -> Scene {
    let floor = facing([0.0; 3], triangle.map(|[across, z]| [across, 0.25, z]));
    let wall = facing([0.0; 3], triangle.map(|[across, z]| [0.25, across, z]));
    // The wall and its beam are in the same scene, out of the camera's view.
    let aside = Pose::from_position(DVec3::new(0.0, 4096.0, 0.0));
    let wall = wall.map(|[x, y, z]| [x, y + 4096.0, z]);
    let beam = Mounted { scene_from_sensor: aside, sensor: small_beam() };
    let camera = Camera { max_range: 100.0, ..small_camera() };
    scene(soup(&[floor, wall]), at_origin(camera), vec![beam])
}

/// Hits for 0 < centre(k) <= 1/4 and nothing else, at R = t |q|.
fn assert_cut_by_the_spp(scene: &Scene) {
    for_each_map(scene, |what, map| {
        assert_ranges(what, map, |i, j| {
            let across = if map.sensor == SensorId::Camera { j } else { i };
            let t = 0.25 / centre(across);
            let q_length = 0.5 * secant(map.sensor, i, j);
            (8..=11).contains(&across).then_some(t * q_length)
        });
    });
}

#[test]
fn a_face_with_one_vertex_behind_the_spp_is_hit_beyond_it_only() {
    // One corner far behind; where the rays meet it, at z = 4/7 to 4 m, it is 64 m wide and more.
    assert_cut_by_the_spp(&cut_by_the_spp([[0.0, -63.5], [-128.0, 64.5], [128.0, 64.5]]));
}

#[test]
fn a_face_with_two_vertices_behind_the_spp_is_hit_beyond_it_only() {
    // Two corners behind, one far ahead; at z = 4 m it is still 2 * 32 * 60.5 / 64 = 60 m wide.
    assert_cut_by_the_spp(&cut_by_the_spp([[-32.0, 0.25], [32.0, 0.25], [0.0, 64.25]]));
}

#[test]
fn a_face_nearer_than_the_spp_is_not_hit() {
    // The floor ends at z = 3/8 m, nearer than the SPP at 1/2 m: every ray would meet it at t < 1.
    let scene = cut_by_the_spp([[-32.0, -64.0], [32.0, -64.0], [0.0, 0.375]]);
    for_each_map(&scene, |what, map| assert_hits_exactly(what, map, |_, _| false));
}

#[test]
fn a_point_exactly_on_the_spp_is_hit() {
    // t >= 1 includes 1. With the principal point half a pixel off, y_j = (j - 8) / 16, and row 12 meets
    // the floor y = 1/4 exactly on the SPP: R = |q|, depth 1/2. Row 13 does not.
    let floor = facing([0.0; 3], [[-32.0, 0.25, 0.25], [32.0, 0.25, 0.25], [0.0, 0.25, 64.25]]);
    let camera = Camera { principal_point: [8.0, 8.5], ..small_camera() };
    for_each_map(&before_camera(&[floor], camera), |what, map| {
        assert_hits_exactly(what, map, |_, j| (9..=12).contains(&j));
        let x = centre(3);
        let known = Known {
            face: 0,
            range: (x * x + 0.0625 + 0.25).sqrt(),
            depth: 0.5,
            point: [x, 0.25, 0.5],
            normal: [0.0, -1.0, 0.0],
            cos_incidence: 0.25 / (x * x + 0.0625 + 0.25).sqrt(),
        };
        assert_hit(what, map, (3, 12), &known);
    });
    // A screen that lies in the SPP: every pencil and pixel meets it at t = 1, R = |q|.
    let in_spp = before_both(&screen(0.5, [-1.0, 1.0], [-1.0, 1.0]));
    for_each_map(&in_spp, |what, map| {
        assert_ranges(what, map, |i, j| Some(0.5 * secant(map.sensor, i, j)));
    });
    // One ulp of f32 nearer than 1/2 m, no ray hits.
    let before = before_both(&screen(0.5_f32.next_down(), [-1.0, 1.0], [-1.0, 1.0]));
    for_each_map(&before, |what, map| assert_hits_exactly(what, map, |_, _| false));
}

// ---- Which faces are hit ----------------------------------------------------------------------------

#[test]
fn the_back_of_a_face_is_not_hit() {
    let front = screen(2.0, [-4.0, 4.0], [-4.0, 4.0]);
    for_each_map(&before_both(&front.map(reversed)), |what, map| {
        assert_hits_exactly(what, map, |_, _| false);
    });
    // A back before a front hides nothing.
    let behind = screen(4.0, [-8.0, 8.0], [-8.0, 8.0]);
    for_each_map(&before_both(&[front.map(reversed), behind].concat()), |what, map| {
        assert_ranges(what, map, |i, j| Some(4.0 * secant(map.sensor, i, j)));
    });
}

/// The closed cuboid between two corners, its fronts outside.
fn cuboid(low: [f32; 3], high: [f32; 3]) -> Vec<Triangle> {
    let middle = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [low[axis], high[axis]] {
            let corner = |u: f32, v: f32| {
                let mut corner = [u, u, u];
                corner[axis] = side;
                corner[(axis + 1) % 3] = u;
                corner[(axis + 2) % 3] = v;
                corner
            };
            let ([u0, v0], [u1, v1]) = ([low, high].map(|c| [c[(axis + 1) % 3], c[(axis + 2) % 3]])).into();
            let [a, b, c, d] = [corner(u0, v0), corner(u1, v0), corner(u1, v1), corner(u0, v1)];
            // The middle sees the backs.
            triangles.extend([reversed(facing(middle, [a, b, c])), reversed(facing(middle, [a, c, d]))]);
        }
    }
    triangles
}

#[test]
fn a_closed_box_is_hit_from_outside_and_not_from_inside() {
    let around = before_both(&cuboid([-3.0, -3.0, -3.0], [4.0, 4.0, 4.0]));
    for_each_map(&around, |what, map| assert_hits_exactly(what, map, |_, _| false));
    // From outside, its near side at 2 m fills the view.
    let before = before_both(&cuboid([-3.0, -3.0, 2.0], [3.0, 3.0, 5.0]));
    for_each_map(&before, |what, map| {
        assert_ranges(what, map, |i, j| Some(2.0 * secant(map.sensor, i, j)));
    });
}

#[test]
fn a_wall_parallel_to_the_beam_rows_is_not_hit() {
    // The walls y = -3/512, -1/1024, 0 and 1/512 m, two of them exactly in a row's plane (rows 0 and 2), each
    // with both windings: q has no y, so n.q = 0. Every pencil passes along them to the screen at 4 m.
    let behind = screen(4.0, [-8.0, 8.0], [-8.0, 8.0]);
    let walls = [-3.0 / 512.0, -1.0 / 1024.0, 0.0, 1.0 / 512.0].map(|y: f32| {
        let wall = [[-8.0, y, 0.0], [8.0, y, 0.0], [0.0, y, 3.5]];
        [wall, reversed(wall)]
    });
    let scene = before_both(&[walls.concat(), behind.to_vec()].concat());
    for_each_map_of(&scene, SensorId::Beam(0), |what, map| {
        assert_ranges(what, map, |i, j| Some(4.0 * secant(map.sensor, i, j)));
    });
    // The camera's rays do have a y. Those of row 8, y = 1/32 m, meet the last wall, y = 1/512 m, at t = 1/16:
    // before the SPP. So does every lower one, and the camera sees the screen alone too.
    for_each_map_of(&scene, SensorId::Camera, |what, map| {
        assert_ranges(what, map, |i, j| Some(4.0 * secant(map.sensor, i, j)));
    });
}

#[test]
fn a_face_in_the_plane_of_a_ray_is_not_hit_by_it() {
    // 17 columns (rows): the middle one lies in the plane x = 0 (y = 0), which contains a fin with both
    // windings. Its rays hit the screen behind it. So do all others: those to the left meet the fin's plane at
    // the focal axis only.
    let fins = [[0.0, -8.0, 1.0], [0.0, 8.0, 1.0], [0.0, 0.0, 3.0]];
    let shelf = fins.map(|[x, y, z]| [y, x, z]);
    let behind = screen(4.0, [-8.0, 8.0], [-8.0, 8.0]);
    let triangles = [vec![fins, reversed(fins), shelf, reversed(shelf)], behind.to_vec()].concat();
    let camera = rig::camera(17, 17, 0.0625, 0.5);
    let beam = rig::beam(17, 3, [0.0625, 1.0 / 256.0], 0.5);
    let scene = scene(soup(&triangles), at_origin(camera), vec![at_origin(beam)]);
    for_each_map(&scene, |what, map| {
        assert_hits_exactly(what, map, |_, _| true);
        for (i, j) in cells_hit(map) {
            let hit = hit(map, i, j).unwrap();
            assert!(hit.face.0 >= 4 && (hit.depth - 4.0).abs() <= MAX_ERROR, "{what} {i},{j}: {hit:?}");
        }
    });
}

#[test]
fn a_ray_along_an_edge_passes_between_the_faces_that_share_it() {
    // A roof whose ridge from (0, 0, 2) to (0, 0, 3) *is* the middle ray of the camera, and its two slopes
    // y = |x|. The middle ray lies in both faces' planes and hits the screen at 4 m. Beside it, pixel (i, 8)
    // passes above the slopes (y = 0 < |x|); pixel (8, 9) has x = 0 and y > 0: inside the roof, where it
    // meets no front; pixel (10, 8 + 1), q = (1/8, 1/16, 1/2), passes above y = |x| as well.
    let (a, b) = ([0.0, 0.0, 2.0], [0.0, 0.0, 3.0]);
    let above = [0.0, -1.0, 2.5];
    let roof = [[a, b, [4.0, 4.0, 2.0]], [a, b, [-4.0, 4.0, 2.0]]].map(|slope| facing(above, slope));
    let behind = screen(4.0, [-8.0, 8.0], [-8.0, 8.0]);
    let camera = rig::camera(17, 17, 0.0625, 0.5);
    for_each_map(&before_camera(&[roof, behind].concat(), camera), |what, map| {
        for cell in [(8, 8), (3, 8), (12, 8), (8, 9), (10, 9)] {
            let hit = hit(map, cell.0, cell.1).unwrap();
            assert!(hit.face.0 >= 2 && (hit.depth - 4.0).abs() <= MAX_ERROR, "{what} {cell:?}: {hit:?}");
        }
    });
}

#[test]
fn triangles_are_closed_vertices_and_edges_included() {
    // 9 x 9 pixels of 1/16 m, f = 1/2, at z = 2 m: the pixel centres lie (i - 4) / 4 m apart. The triangle
    // (-3/4, -3/4), (-3/4, 3/4), (3/4, 3/4) has pixels exactly on its corners and all its sides: hit are
    // columns and rows 1 to 7 with i <= j. A pencil of row j crosses it at y_j = j/4 - 1, same numbers.
    let triangle = facing([0.0; 3], [[-0.75, -0.75, 2.0], [-0.75, 0.75, 2.0], [0.75, 0.75, 2.0]]);
    let camera = rig::camera(9, 9, 0.0625, 0.5);
    let beam = rig::beam(9, 9, [0.0625, 0.25], 0.5);
    let scene = scene(soup(&[triangle]), at_origin(camera), vec![at_origin(beam)]);
    for_each_map(&scene, |what, map| {
        assert_hits_exactly(what, map, |i, j| 1 <= i && i <= j && j <= 7);
    });
}

#[test]
fn the_longest_range_cuts_a_circle_from_a_plane() {
    // One face at z = 2 m whose vertices are 100 m away, a longest range of 2.5 m: hit where |q| / f <= 5/4,
    // that is x^2 + y^2 <= (3/8)^2 m^2 for f = 1/2. With 64 x 64 pixels of 1/64 m, x = a / 128 with a odd,
    // it reads a^2 + b^2 <= 48^2 (a sum of two odd squares is 2 mod 8, so none lies on the circle).
    let face = facing([0.0; 3], [[-100.0, -100.0, 2.0], [100.0, -100.0, 2.0], [0.0, 130.0, 2.0]]);
    let camera = Camera { max_range: 2.5, ..rig::camera(64, 64, 1.0 / 64.0, 0.5) };
    // In a beam only x counts: |a| <= 48, every row.
    let beam = Beam { max_range: 2.5, ..rig::beam(64, 4, [1.0 / 64.0, 1.0 / 256.0], 0.5) };
    let scene = scene(soup(&[face]), at_origin(camera), vec![at_origin(beam)]);
    for_each_map(&scene, |what, map| {
        assert_hits_exactly(what, map, |i, j| {
            let [a, b] = [i, j].map(|index| 2 * i64::from(index) - 63);
            if map.sensor == SensorId::Camera { a * a + b * b <= 48 * 48 } else { a.abs() <= 48 }
        });
    });
}

#[test]
fn the_longest_range_itself_is_included() {
    // A screen at z = 2 m; the middle of 17 x 17 pixels sees it at R = 2 m. At a longest range of 2 m that
    // pixel alone hits, at one below it none does.
    let triangles = screen(2.0, [-8.0, 8.0], [-8.0, 9.0]);
    for (max_range, hits) in [(2.0, true), (2.0_f64.next_down(), false)] {
        let camera = Camera { max_range, ..rig::camera(17, 17, 0.0625, 0.5) };
        for_each_map(&before_camera(&triangles, camera), |what, map| {
            assert_hits_exactly(what, map, |i, j| hits && (i, j) == (8, 8));
        });
    }
}

#[test]
fn faces_of_no_area_are_never_hit() {
    // 17 x 17 rays, of which the middle row and column lie at y = 0 and x = 0. A point, a needle along the
    // middle row with its third corner on it, one that goes there and back, one along the middle ray: all
    // before a screen at 4 m, faces 4 and 5.
    let degenerate = [
        [[0.0, 0.0, 2.0]; 3],
        [[-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [1.0, 0.0, 2.0]],
        [[0.0, -2.0, 2.0], [0.0, 2.0, 2.0], [0.0, -2.0, 2.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0, 0.0, 3.0]],
    ];
    let behind = screen(4.0, [-8.0, 8.0], [-8.0, 8.0]);
    let camera = rig::camera(17, 17, 0.0625, 0.5);
    let beam = rig::beam(17, 3, [0.0625, 1.0 / 256.0], 0.5);
    let mesh = soup(&[degenerate.to_vec(), behind.to_vec()].concat());
    assert_eq!(mesh.zero_area_faces(), 4);
    let scene = scene(mesh, at_origin(camera), vec![at_origin(beam)]);
    for_each_map(&scene, |what, map| {
        assert_hits_exactly(what, map, |_, _| true);
        for (i, j) in cells_hit(map) {
            assert!(hit(map, i, j).unwrap().face.0 >= 4, "{what} {i},{j}");
        }
    });
    // Without the screen the map is empty.
    let mesh = soup(&degenerate);
    let alone = raypencil_tests::scene(mesh, at_origin(camera), vec![at_origin(beam)]);
    for_each_map(&alone, |what, map| assert_hits_exactly(what, map, |_, _| false));
}

#[test]
fn an_empty_mesh_gives_empty_maps() {
    let empty = scene(mesh(Vec::new(), Vec::new()), at_origin(small_camera()), vec![at_origin(small_beam())]);
    for_each_map(&empty, |what, map| assert_hits_exactly(what, map, |_, _| false));
}

// ---- Conventions of camera, beam and pose -----------------------------------------------------------

#[test]
fn a_pixel_is_a_square_and_its_ray_goes_through_the_middle() {
    // 12 x 9 pixels of 1/64 x 1/32 m, principal point (5.25, 1.5), f = 1/2. At z = 2 m, 4 f, the border of
    // column i lies at x = 4 (i - 5.25) / 64, that of row j at y = 4 (j - 1.5) / 32. A screen over [3, 7) x
    // [2, 5), grown by up to just under half a pixel either way, covers exactly these centres. Grown by more
    // than a half it covers one more on each side; shrunk by more than a half, one less.
    let camera = Camera {
        pixel_pitch: [1.0 / 64.0, 1.0 / 32.0],
        principal_point: [5.25, 1.5],
        ..rig::camera(12, 9, 1.0, 0.5)
    };
    for (grown, more) in [(-0.51, -1_i64), (-0.49, 0), (0.0, 0), (0.49, 0), (0.51, 1)] {
        let x = [3.0 - grown, 7.0 + grown].map(|i: f64| ((i - 5.25) / 16.0) as f32);
        let y = [2.0 - grown, 5.0 + grown].map(|j: f64| ((j - 1.5) / 8.0) as f32);
        for_each_map(&before_camera(&screen(2.0, x, y), camera), |what, map| {
            assert_hits_exactly(&format!("{what}, grown by {grown}"), map, |i, j| {
                let (i, j) = (i64::from(i), i64::from(j));
                (3 - more..7 + more).contains(&i) && (2 - more..5 + more).contains(&j)
            });
        });
    }
    // The point of pixel (4, 3): q = (-0.75 / 64, 2 / 32, 1/2), four times as far.
    let whole = screen(2.0, [-4.0, 4.0], [-4.0, 6.0]);
    for_each_map(&before_camera(&whole, camera), |_, map| {
        let point = hit(map, 4, 3).unwrap().point;
        assert_abs_diff_eq!(point.x, -0.046875, epsilon = MAX_ERROR);
        assert_abs_diff_eq!(point.y, 0.25, epsilon = MAX_ERROR);
    });
}

#[test]
fn a_principal_point_may_lie_outside_the_image() {
    // 8 x 8 pixels of 1/16 m, principal point (-2, 12), f = 1/2: x_i = (i + 2.5) / 16 is right of the axis,
    // y_j = (j - 11.5) / 16 above it. On the plane z = 2 m: four times that.
    let camera = Camera { principal_point: [-2.0, 12.0], ..rig::camera(8, 8, 0.0625, 0.5) };
    for_each_map(&before_camera(&screen(2.0, [-1.0, 8.0], [-8.0, 1.0]), camera), |what, map| {
        assert_hits_exactly(what, map, |_, _| true);
        for (i, j) in cells_hit(map) {
            let point = hit(map, i, j).unwrap().point;
            assert_abs_diff_eq!(point.x, (f64::from(i) + 2.5) / 4.0, epsilon = MAX_ERROR);
            assert_abs_diff_eq!(point.y, (f64::from(j) - 11.5) / 4.0, epsilon = MAX_ERROR);
        }
    });
}

#[test]
fn pencils_start_on_the_focal_axis_and_keep_their_height() {
    // On the plane z = 3 m, six times g, pencil (i, j) lands at (6 x_i, y_j, 3): columns run to the right,
    // rows downward, row 0 on top, and the sheet is as thick there as at the grid.
    let scene = before_both(&screen(3.0, [-8.0, 8.0], [-8.0, 9.0]));
    for_each_map_of(&scene, SensorId::Beam(0), |what, map| {
        assert_hits_exactly(what, map, |_, _| true);
        for (i, j) in cells_hit(map) {
            let hit = hit(map, i, j).unwrap();
            assert_abs_diff_eq!(hit.point.x, 6.0 * centre(i), epsilon = MAX_ERROR);
            assert_abs_diff_eq!(hit.point.y, row(j), epsilon = MAX_ERROR);
            assert_abs_diff_eq!(hit.point.z, 3.0, epsilon = MAX_ERROR);
            // R starts on the axis: 6 |q| with q = (x_i, 0, 1/2).
            assert_abs_diff_eq!(hit.range, 6.0 * (centre(i) * centre(i) + 0.25).sqrt(), epsilon = MAX_ERROR);
        }
    });
    // A strip above the axis (y < 0) is met by rows 0 and 1, a post to the right by columns 8 to 15.
    let strip = before_both(&screen(3.0, [-8.0, 8.0], [-1.0, 0.0]));
    for_each_map_of(&strip, SensorId::Beam(0), |what, map| assert_hits_exactly(what, map, |_, j| j < 2));
    let post = before_both(&screen(3.0, [0.0, 8.0], [-1.0, 1.0]));
    for_each_map_of(&post, SensorId::Beam(0), |what, map| assert_hits_exactly(what, map, |i, _| i >= 8));
}

#[test]
fn fans_up_to_170_degrees_spread_evenly_on_the_grid() {
    // Plane z = 1 m: pencil i lands at x = tan(fan / 2) (2i + 1 - n) / n, at R = sqrt(1 + x^2). At 170
    // degrees tan 85 = 11.43, so the outermost of 32 pencils goes 11.07 m aside and 11.12 m far.
    for fan_deg in [1.0, 60.0, 120.0, 170.0_f64] {
        let fan = fan_deg.to_radians();
        let beam = Beam { half_width: Beam::half_width_of(0.1, fan), ..rig::beam(32, 3, [1.0, 0.002], 0.1) };
        let triangles = screen(1.0, [-16.0, 16.0], [-1.0, 1.5]);
        let scene = scene(soup(&triangles), at_origin(small_camera()), vec![at_origin(beam)]);
        for_each_map_of(&scene, SensorId::Beam(0), |what, map| {
            assert_hits_exactly(what, map, |_, _| true);
            for (i, j) in cells_hit(map) {
                let x = libm::tan(0.5 * fan) * (2.0 * f64::from(i) - 31.0) / 32.0;
                let hit = hit(map, i, j).unwrap();
                assert_abs_diff_eq!(hit.point.x, x, epsilon = MAX_ERROR);
                assert_abs_diff_eq!(hit.range, (1.0 + x * x).sqrt(), epsilon = MAX_ERROR);
                assert_abs_diff_eq!(hit.cos_incidence, 1.0 / (1.0 + x * x).sqrt(), epsilon = MAX_ERROR);
            }
        });
    }
}

#[test]
fn a_straight_edge_is_a_curve_on_the_beam_grid() {
    // A face z = 2 m below the line from (-2, 0) to (2, 1/4): y >= (x + 2) / 16. Pencil (i, j) comes to
    // x = 4 x_i, y = y_j there. And the same line leaning back to z = 4 m at its right end: at parameter s
    // the edge is at (4 s - 2, s / 4, 2 + 2 s), and row y cuts it at s = 4 y, where x / z = (16 y - 2) / (2 + 8 y):
    // no straight line in y. The face lies right of it.
    let rows = 64;
    let beam = rig::beam(16, rows, [0.0625, 1.0 / 256.0], 0.5);
    for lean in [0.0, 2.0_f32] {
        let (a, b) = ([-2.0, 0.0, 2.0], [2.0, 0.25, 2.0 + lean]);
        // The third corner is right and up, at the depth of the right end.
        let c = [2.0, 0.0, 2.0 + lean];
        let face = facing([0.0; 3], [a, b, c]);
        let scene = scene(soup(&[face]), at_origin(small_camera()), vec![at_origin(beam)]);
        for_each_map_of(&scene, SensorId::Beam(0), |what, map| {
            assert_hits_exactly(&format!("{what}, leaning {lean}"), map, |i, j| {
                let y = (2.0 * f64::from(j) + 1.0 - f64::from(rows)) / 512.0;
                let s = 4.0 * y;
                let edge = (4.0 * s - 2.0) / (2.0 + f64::from(lean) * s);
                // The right side is the line x = 2, z = 2 + lean.
                let right = 2.0 / (2.0 + f64::from(lean));
                let tan = centre(i) / 0.5;
                y >= 0.0 && edge <= tan && tan <= right
            });
        });
    }
}

/// A post 2 m before a sensor: 1/4 m wide, its middle at `x` to the right and `y` down, in the scene frame.
fn post(pose: &Pose, x: f64, y: f64) -> Vec<Triangle> {
    let corner = |dx: f64, dy: f64| {
        let point = *pose * DVec3::new(x + dx, y + dy, 2.0);
        point.to_array().map(|coordinate| coordinate as f32)
    };
    let [a, b, c, d] = [(-0.1, -0.1), (-0.1, 0.1), (0.1, 0.1), (0.1, -0.1)].map(|(dx, dy)| corner(dx, dy));
    vec![[a, b, c], [a, c, d]]
}

#[test]
fn left_right_up_and_down_are_those_of_the_vehicle() {
    // A camera 1 m above a vehicle that stands at (10, 20, 0) with its nose to the north (+y): forward is +y,
    // right is +x, down is -z. A post 2 m ahead, 3/8 m to the right and 1/8 m up, is at (10.375, 22, 1.125).
    // In the image it lies at x = 0.375 / 4 = 3/32 m, y = -1/32 m: column 9, row 7 ((2k - 15) / 32 = 3/32 and
    // -1/32), and R^2 = 0.375^2 + 0.125^2 + 2^2.
    let position = DVec3::new(10.0, 20.0, 1.0);
    let heading = Pose { position, rotation: DQuat::from_xyzw(0.0, 0.0, 1.0, 1.0) };
    let pose = heading * Pose::VEHICLE_FROM_FORWARD_SENSOR;
    let [x, y, z] = [10.375_f32, 22.0, 1.125];
    // 0.1 m to each side, the front to the south.
    let corners =
        [[x - 0.1, y, z + 0.1], [x - 0.1, y, z - 0.1], [x + 0.1, y, z - 0.1], [x + 0.1, y, z + 0.1]];
    let [a, b, c, d] = corners;
    let mounted = Mounted { scene_from_sensor: pose, sensor: small_camera() };
    let mesh = soup(&[[a, b, c], [a, c, d]]);
    for_each_map_of(&scene(mesh, mounted, Vec::new()), SensorId::Camera, |what, map| {
        assert_hits_exactly(what, map, |i, j| (i, j) == (9, 7));
        let hit = hit(map, 9, 7).unwrap();
        assert_abs_diff_eq!(hit.range, (0.140625 + 0.015625 + 4.0_f64).sqrt(), epsilon = MAX_ERROR);
        assert_abs_diff_eq!(hit.depth, 2.0, epsilon = MAX_ERROR);
        let off = hit.point - DVec3::new(10.375, 22.0, 1.125);
        assert!(off.length() <= MAX_ERROR, "{what}: {off}");
        // The front of the post faces south, to the camera.
        assert!((hit.normal - DVec3::NEG_Y).length() <= MAX_ERROR, "{what}: {}", hit.normal);
    });
}

#[test]
fn a_post_fixed_to_the_camera_is_in_the_same_pixel_for_every_pose() {
    // 0.375 m right and 0.125 m up at 2 m: column 9, row 7, as above, for every pose and every length of its
    // quaternion. Vertices are rounded to f32, by less than 1e-6 m at 16 m; the post reaches 0.1 m beyond the
    // pixel's ray and ends 0.15 m before the next.
    let turns = [
        (0.5, 0.5, 0.5, 0.5),
        (1.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 3.0, -3.0),
        (0.1, -0.7, 0.4, 0.2),
        (-20.0, 13.0, 7.0, 1.0),
        (0.001, 0.002, -0.003, 0.004),
    ];
    for (x, y, z, w) in turns {
        let position = DVec3::new(7.0, -3.5, 0.25);
        let pose = Pose { position, rotation: DQuat::from_xyzw(x, y, z, w) };
        let mounted = Mounted { scene_from_sensor: pose, sensor: small_camera() };
        let post = soup(&post(&pose, 0.375, -0.125));
        for_each_map_of(&scene(post, mounted, Vec::new()), SensorId::Camera, |what, map| {
            assert_hits_exactly(&format!("{what}, quaternion {x}, {y}, {z}, {w}"), map, |i, j| {
                (i, j) == (9, 7)
            });
            // Without rounding of the vertices, R^2 = 4.15625.
            let range = hit(map, 9, 7).unwrap().range;
            assert_abs_diff_eq!(range, 4.15625_f64.sqrt(), epsilon = 1e-5);
        });
    }
}

#[test]
fn the_scene_s_origin_does_not_change_a_map() {
    // The same ground 1000 km away: vertices and points are offsets from the origin.
    let materials = vec![raypencil::Material { name: "ground".into(), reflectivity: 0.25 }];
    let near: Vec<DVec3> = screen(2.0, [-4.0, 4.0], [-4.0, 4.0])
        .concat()
        .iter()
        .map(|v| DVec3::from_array(v.map(f64::from)))
        .collect();
    let far: Vec<DVec3> = near.iter().map(|v| *v + DVec3::new(1e6, -2e6, 998.0)).collect();
    let faces = vec![[0, 1, 2], [3, 4, 5]];
    let mesh = Mesh::from_global(&far, faces, vec![0, 0], materials).unwrap();
    // The middle of the bounding box, in whole metres.
    assert_eq!(mesh.origin(), DVec3::new(1e6, -2e6, 1000.0));
    let pose = Pose::from_position(DVec3::new(0.0, 0.0, -2.0));
    let mounted = Mounted { scene_from_sensor: pose, sensor: small_camera() };
    for_each_map(&scene(Arc::new(mesh), mounted, Vec::new()), |what, map| {
        assert_ranges(what, map, |i, j| Some(2.0 * secant(map.sensor, i, j)));
        assert_abs_diff_eq!(hit(map, 3, 9).unwrap().point.z, 0.0, epsilon = MAX_ERROR);
    });
}
