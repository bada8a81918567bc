//! Occlusion of pencils from the camera, by every renderer; and the paper's claim that on closed ground back faces
//! suffice. (§6)

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use raypencil::{Beam, Mesh, Mounted, Pose, Request, Scene};
use raypencil_tests::draws::SplitMix64;
use raypencil_tests::light::{evaluations, fluxes, is_visible, relative, total};
use raypencil_tests::{at_origin, cells_hit, hit, rig, scene};

/// Maximum relative error of a range: a few roundings.
const MAX_RELATIVE_ERROR: f64 = 1e-14;

/// A mesh of rectangles, each with its bounds in x, its bounds in y, and its depth z. The front faces -z, or +z if it
/// is turned away.
fn plates(plates: &[([f32; 2], [f32; 2], f32, bool)]) -> Arc<Mesh> {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for &([left, right], [top, bottom], z, turned_away) in plates {
        let k = vertices.len() as u32;
        vertices.extend([[left, top, z], [left, bottom, z], [right, bottom, z], [right, top, z]]);
        let front = [[k, k + 1, k + 2], [k, k + 2, k + 3]];
        faces.extend(front.map(|[a, b, c]| if turned_away { [a, c, b] } else { [a, b, c] }));
    }
    raypencil_tests::mesh(vertices, faces)
}

/// The ground: a wall at z = 2 m.
const WALL: ([f32; 2], [f32; 2], f32, bool) = ([-8.0, 8.0], [-8.0, 8.0], 2.0, false);

/// A beam along z from the origin, 16 x 3 pencils, its sheet in the plane y = 0 and 23 um thick, its grid at 1/8 m;
/// a camera at `position` that looks along z too, with slopes up to 3/2 and the image plane at 1/64 m.
fn beside(mesh: Arc<Mesh>, position: DVec3) -> Scene {
    let beam = rig::beam(16, 3, [1.0 / 512.0, 1.0 / 131_072.0], 0.125);
    let camera = rig::camera(64, 64, 3.0 / 4096.0, 1.0 / 64.0);
    let camera = Mounted { scene_from_sensor: Pose::from_position(position), sensor: camera };
    scene(mesh, camera, vec![at_origin(beam)])
}

/// Calls `visit` with the column, range and flux of every pencil, for every renderer. Asserts that exactly the visible
/// pencils return flux, and that the image holds all of it.
fn for_each_pencil(scene: &Scene, mut visit: impl FnMut(&str, u32, f64, f64)) {
    for renderer in evaluations() {
        let output = renderer.render(scene, &Request::EVERYTHING);
        let fluxes = fluxes(&output.returns[0]);
        for (i, j) in (0..3).flat_map(|j| (0..16).map(move |i| (i, j))) {
            let range = hit(&output.beams[0], i, j).expect("every pencil hits").range;
            assert_eq!(is_visible(&output.returns[0], i, j), fluxes.at(i, j) > 0.0);
            visit(&format!("{} {i},{j}", renderer.name()), i, range, fluxes.at(i, j));
        }
        let (image, sum) = (total(&output.flux[0]), total(fluxes));
        assert!((image - sum).abs() <= 1e-14 * sum, "{}: {image:e}, {sum:e} W", renderer.name());
    }
}

#[test]
fn a_lid_a_tenth_of_a_millimetre_before_the_wall_hides_it() {
    // The camera is 2 m above the sheet, so that it sees the stripe along a slope of 1. In the plane 0.1 mm before the
    // wall, the lines of sight are 0.1 mm above the sheet, within half of its thickness, 12 um. A lid in this plane
    // that begins 0.05 mm above the sheet does not meet the laser and hides the stripe. One that begins at 0.15 mm
    // does not hide it. Both hold for a lid that faces either side.
    let camera = DVec3::new(0.0, -2.0, 0.0);
    let z = 2.0 - 1e-4_f32;
    let lid = |bottom: f32, turned_away| ([-8.0, 8.0], [-1.0, bottom], z, turned_away);
    for turned_away in [false, true] {
        for (bottom, hides) in [(-0.5e-4, true), (-1.5e-4, false)] {
            let scene = beside(plates(&[WALL, lid(bottom, turned_away)]), camera);
            for_each_pencil(&scene, |what, _, range, flux| {
                assert!(range >= 2.0, "{what}: the lid at {bottom} m blocks the laser");
                assert_eq!(flux == 0.0, hides, "{what}: {flux:e} W past a lid at {bottom} m");
            });
        }
    }
    // A lid across the sheet blocks the laser and returns its light. If it shows its back, the laser passes, because
    // backs are not hit, and the lid hides the wall.
    let secant = |i: u32| {
        let tan = (2.0 * f64::from(i) - 15.0) / 1024.0 / 0.125;
        (1.0 + tan * tan).sqrt()
    };
    for (turned_away, depth) in [(false, f64::from(z)), (true, 2.0)] {
        for_each_pencil(&beside(plates(&[WALL, lid(1.0, turned_away)]), camera), |what, i, range, flux| {
            assert!(relative(range, depth * secant(i)) < MAX_RELATIVE_ERROR, "{what}: {range} m");
            assert_eq!(flux == 0.0, turned_away, "{what}: {flux:e} W");
        });
    }
}

#[test]
fn a_blade_a_millimetre_beyond_the_grid_blocks_the_laser() {
    // The grid is at 1/8 m. A blade covers the left half of the fan. 1 mm beyond the grid it stops columns 0 to 7,
    // which return nothing, because the camera is at z = 1/2 m. 1 mm before the grid, or with its back to the laser,
    // the blade has no effect.
    let camera = DVec3::new(0.0, -1.0, 0.5);
    let blade = |z: f32, turned_away| ([-1.0, 0.0], [-1.0, 1.0], z, turned_away);
    let mut bare = Vec::new();
    for_each_pencil(&beside(plates(&[WALL]), camera), |_, _, _, flux| bare.push(flux));
    assert!(bare.iter().all(|flux| *flux > 0.0));
    for (z, turned_away, blocks) in [(0.126, false, true), (0.124, false, false), (0.126, true, false)] {
        let mut bare = bare.iter();
        let scene = beside(plates(&[WALL, blade(z, turned_away)]), camera);
        for_each_pencil(&scene, |what, i, range, flux| {
            let unblocked = *bare.next().expect("as many pencils");
            if blocks && i < 8 {
                // Slopes are up to 15 / 128.
                assert!((0.126..0.127).contains(&range), "{what}: {range} m");
                assert_eq!(flux, 0.0, "{what}");
            } else {
                assert!(range >= 2.0, "{what}: {range} m");
                assert_eq!(flux, unblocked, "{what}");
            }
        });
    }
}

#[test]
fn faces_nearer_than_the_image_plane_do_not_hide() {
    // The image plane is 1/64 m in front of the projection centre. A plate at 0.99 of this distance hides nothing, one
    // at 1.01 everything.
    let camera = DVec3::new(0.0, -1.0, 0.0);
    for (share, hides) in [(0.99, false), (1.01, true)] {
        for turned_away in [false, true] {
            let plate = ([-0.1, 0.1], [-1.1, -0.9], share / 64.0, turned_away);
            for_each_pencil(&beside(plates(&[WALL, plate]), camera), |what, _, _, flux| {
                assert_eq!(flux == 0.0, hides, "{what}: a plate at {share} of the focal length");
            });
        }
    }
}

/// A height field of 12 x 12 m, closed by sides and a bottom, with rotated boxes on it and partly in it. All vertices
/// are below 0.9 m.
fn closed_ground(seed: u64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    const CELLS: u32 = 12;
    let mut random = SplitMix64::new(seed);
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let across = CELLS + 1;
    for j in 0..across {
        for i in 0..across {
            let place = |k: u32| f64::from(k) * 12.0 / f64::from(CELLS) - 6.0;
            vertices.push(DVec3::new(place(i), place(j), random.between(-0.25, 0.25)));
        }
    }
    for j in 0..CELLS {
        for i in 0..CELLS {
            let [a, b] = [j * across + i, j * across + i + 1];
            faces.extend([[a, b, b + across], [a, b + across, a + across]]);
        }
    }
    // The border, counter-clockwise from above, with its sides, and the bottom as a fan around its middle.
    let mut border: Vec<u32> = (0..CELLS).collect();
    border.extend((0..CELLS).map(|j| j * across + CELLS));
    border.extend((1..across).rev().map(|i| CELLS * across + i));
    border.extend((1..across).rev().map(|j| j * across));
    let low = vertices.len() as u32;
    for &top in &border {
        let DVec3 { x, y, .. } = vertices[top as usize];
        vertices.push(DVec3::new(x, y, -1.0));
    }
    let middle = vertices.len() as u32;
    vertices.push(DVec3::new(0.0, 0.0, -1.0));
    for (k, &top) in border.iter().enumerate() {
        let next = (k + 1) % border.len();
        let (under, under_next) = (low + k as u32, low + next as u32);
        faces.extend([
            [top, under, under_next],
            [top, under_next, border[next]],
            [middle, under_next, under],
        ]);
    }
    for _ in 0..20 {
        let centre =
            DVec3::new(random.between(1.0, 5.0), random.between(-2.5, 2.5), random.between(-0.1, 0.3));
        let turn =
            Pose { position: centre, ..Pose::from_axis_angle(random.direction(), random.between(0.0, PI)) };
        let half =
            DVec3::new(random.between(0.02, 0.4), random.between(0.02, 0.4), random.between(0.02, 0.2));
        let first = vertices.len() as u32;
        for corner in 0..8_u32 {
            let sign = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
            vertices.push(turn * (half * DVec3::new(sign(0), sign(1), sign(2))));
        }
        let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        for [a, b, c, d] in sides.map(|side| side.map(|corner: u32| first + corner)) {
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, faces)
}

/// Whether one of `faces`, except the hit face, meets the segment c + u (P - c), nearest <= u < 1.
fn is_hidden(faces: &[Face], hit: u32, centre: DVec3, point: DVec3, nearest: f64) -> bool {
    let to_point = point - centre;
    faces.iter().any(|&(face, corners)| {
        let [a, b, c] = corners.map(|corner| corner - centre);
        let n = (b - a).cross(c - a);
        let towards = n.dot(to_point);
        // Faces with a common edge compute the same side function for it, up to the sign.
        let side = |a: DVec3, b: DVec3| to_point.dot(a.cross(b));
        let sides = [side(a, b), side(b, c), side(c, a)];
        let is_inside = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
        face != hit && towards != 0.0 && is_inside && {
            let u = n.dot(a) / towards;
            nearest <= u && u < 1.0
        }
    })
}

/// A face's index and corners.
type Face = (u32, [DVec3; 3]);

/// All faces of a scene, and those that show their back to the camera.
fn faces_and_backs(scene: &Scene) -> [Vec<Face>; 2] {
    let (mesh, centre) = (scene.mesh(), scene.camera().scene_from_sensor.position);
    let corner = |v: u32| DVec3::from_array(mesh.vertices()[v as usize].map(f64::from));
    let all: Vec<_> = (0..).zip(mesh.faces().iter().map(|face| face.map(corner))).collect();
    let is_back = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).dot(centre - a) < 0.0;
    let backs = all.iter().copied().filter(|&(_, face)| is_back(face)).collect();
    [all, backs]
}

#[test]
fn on_closed_ground_backs_alone_decide_what_is_hidden() {
    // The paper tests only faces that show their back to the camera (section 6). A segment from a point outside all
    // solids to the camera that meets a solid enters it through a face whose front is to the point and whose back is to
    // the camera. So backs suffice if every solid is closed, and camera, beams and points are outside.
    let (mut pencils, mut in_shadow) = (0, 0);
    let camera = rig::camera(96, 96, 1e-4, 8e-3);
    let beam = Beam {
        thickness: 0.3,
        half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
        ..rig::beam(96, 8, [1.0, 1.0], 0.1)
    };
    for seed in 0..6 {
        let (vertices, faces) = closed_ground(seed);
        let vertices: Vec<[f32; 3]> = vertices.iter().map(|v| v.as_vec3().to_array()).collect();
        // Closed: every edge of a face is an edge of another face, in the opposite direction.
        let mut sides: Vec<[u32; 2]> = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        sides.sort_unstable();
        let turned = |[a, b]: &[u32; 2]| sides.binary_search(&[*b, *a]).is_ok();
        assert!(sides.iter().all(turned) && sides.windows(2).all(|pair| pair[0] != pair[1]), "not closed");
        // Fronts outside: six times the volume is positive. The sensors are above all vertices, at 1.2 m or more.
        let corner = |v: u32| DVec3::from_array(vertices[v as usize].map(f64::from));
        let corners: Vec<[DVec3; 3]> = faces.iter().map(|face| face.map(corner)).collect();
        assert!(corners.iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum::<f64>() > 0.0);
        assert!(vertices.iter().all(|vertex| vertex[2] < 0.9));

        let mut random = SplitMix64::new(100 + seed);
        let mut mount = |height: f64| {
            let place = DVec3::new(random.between(-1.0, 0.0), random.between(-1.0, 1.0), height);
            (place, random.between(0.35, 0.6))
        };
        let ((at, down), beams) = (mount(1.2), [mount(1.6), mount(2.2)]);
        let beams = beams.map(|(at, down)| rig::pitched(at, down, beam)).to_vec();
        let mesh = raypencil_tests::mesh(vertices, faces);
        let scene = scene(mesh, rig::pitched(at, down, camera), beams);

        let centre = scene.camera().scene_from_sensor.position;
        let [all, backs] = faces_and_backs(&scene);
        assert!(!backs.is_empty() && backs.len() < all.len());
        for renderer in evaluations() {
            let output = renderer.render(&scene, &Request::EVERYTHING);
            for (map, returns) in output.beams.iter().zip(&output.returns) {
                let depths = returns.depth.as_ref().expect("depths are known");
                let emissions = returns.cos_view.as_ref().expect("angles are known");
                let pixels = returns.pixel.as_ref().expect("pixels are known");
                for (i, j) in cells_hit(map) {
                    let met = hit(map, i, j).expect("a hit");
                    // Points off the image and faces turned away are never visible.
                    let turned_to = emissions.at(i, j).get().expect("of a hit") > 0.0;
                    if !turned_to || pixels.at(i, j).get().is_none() {
                        assert!(!is_visible(returns, i, j));
                        continue;
                    }
                    let nearest = camera.focal_length / depths.at(i, j).get().expect("of a hit");
                    let [by_all, by_backs] =
                        [&all, &backs].map(|faces| is_hidden(faces, met.face.0, centre, met.point, nearest));
                    let what = format!("seed {seed}, {} {} {i},{j}", renderer.name(), map.sensor);
                    assert_eq!(by_all, by_backs, "{what}");
                    assert_eq!(is_visible(returns, i, j), !by_all, "{what}");
                    pencils += 1;
                    in_shadow += u32::from(by_all);
                }
            }
        }
    }
    println!(
        "{pencils} pencils land on the image on faces turned to the camera, {in_shadow} of them are hidden"
    );
    // Enough pencils of both kinds for a meaningful test.
    assert!(pencils > 6_000 && in_shadow > pencils / 50 && in_shadow < pencils / 2);
}

#[test]
fn on_open_ground_fronts_hide_too() {
    // The claim does not hold on open ground: a single plate shows its front to the camera, half way to the wall. The
    // renderers test all faces and find the wall hidden. No face shows its back.
    let plate = ([-8.0, 8.0], [-0.75, -0.25], 1.0, false);
    let scene = beside(plates(&[WALL, plate]), DVec3::new(0.0, -1.0, 0.0));
    assert!(faces_and_backs(&scene)[1].is_empty());
    for_each_pencil(&scene, |what, _, range, flux| {
        assert!(range >= 2.0, "{what}: {range} m");
        assert_eq!(flux, 0.0, "{what}");
    });
}
