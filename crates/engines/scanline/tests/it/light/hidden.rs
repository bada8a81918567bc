//! The faces that hide a point from the camera, and those that do not.

use glam::DVec3;
use raypencil_scanline::{Fidelity, ScanlineOptions, Switches};
use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin};

use super::rig::{Face, Rig, render, return_at, reversed, rig_on, wall};

/// A triangle at `z` that reaches from far above down to y = `bottom`.
fn blind(bottom: f32, z: f32) -> Face {
    [[-9.0, bottom, z], [0.0, bottom - 9.0, z], [9.0, bottom, z]]
}

#[test]
fn a_lid_hides_the_points_that_it_covers_however_close_it_is() {
    // The camera is 2 m above the pencils' plane y = 0 and 2 m from the wall. So its ray to a point of the stripe is at
    // y = -h where it is h in front of the wall. A lid there that reaches down to y = -h/2 blocks that ray, and not the
    // laser's. It does so with its front and with its back.
    assert!(Rig::new().pencil_return(3).visible);
    // The last h is one f32 step below z = 2.
    for h in [0.1, 1e-3, 1e-4, 1e-6, 2.0 - 2_f32.next_down()] {
        let z = 2.0 - h;
        assert!(z < 2.0);
        // As rounded.
        let h = 2.0 - z;
        for covering in [blind(-0.5 * h, z), reversed(blind(-0.5 * h, z))] {
            let rig = Rig::new().with(&[covering]);
            for i in 0..4 {
                let returned = rig.pencil_return(i);
                assert!(!returned.visible && returned.flux == 0.0 && returned.depth == 2.0, "{h} {i}");
            }
        }
        // A lid that ends at y = -1.5 h, or one that is h behind the wall, hides nothing.
        for clear in [blind(-1.5 * h, z), blind(-0.5 * h, 2.0 + h)] {
            let rig = Rig::new().with(&[clear, reversed(clear)]);
            assert!((0..4).all(|i| rig.pencil_return(i).visible), "{h}");
        }
    }
}

#[test]
fn a_blade_hides_from_the_spp_on() {
    // The camera's ray to the last point runs from (0, -2, 0) along (1/2, 1, 1) z. A blade 1 mm beyond the camera's SPP
    // at z = 1/128 hides the point; one 1 mm in front of the SPP does not.
    let spp = 1.0 / 128.0;
    let around = |z: f32| -> Face { [[-0.5, -2.5, z], [0.0, -1.5, z], [0.5, -2.5, z]] };
    for (z, seen) in [(spp + 1e-3, false), (spp, false), (spp - 1e-3, true)] {
        for blade in [around(z), reversed(around(z))] {
            assert_eq!(Rig::new().with(&[blade]).pencil_return(3).visible, seen, "{z}");
        }
    }
    // Blades that the SPP cuts. The ray y + 2 = z does not meet the plane z = spp + (y + 2). It meets the plane
    // z = spp - 0.9 mm + (y + 2)/8 at z = (spp - 0.9 mm) 8/7 = 7.9 mm, beyond the SPP at 7.8 mm.
    let leaning = |at: f32, slope: f32| -> Face {
        [[-0.5, -2.5, at - 0.5 * slope], [0.5, -2.5, at - 0.5 * slope], [0.0, -1.0, at + slope]]
    };
    for (blade, seen) in [(leaning(spp, 1.0), true), (leaning(spp - 9e-4, 0.125), false)] {
        for blade in [blade, reversed(blade)] {
            assert_eq!(Rig::new().with(&[blade]).pencil_return(3).visible, seen, "{blade:?}");
        }
    }
    // It meets z = spp - 2 mm + (y + 2)/8 at 6.6 mm, in front of the SPP.
    assert!(Rig::new().with(&[leaning(spp - 2e-3, 0.125)]).pencil_return(3).visible);
    // The laser's grid is at z = 1/8. A blade 1 mm beyond it blocks the laser, one in front of it does not. Both are
    // below the camera's rays to the wall.
    let g = 0.125;
    let before = |z: f32| -> Face { [[-1.5, -0.1, z], [-0.5, 0.3, z], [0.5, -0.1, z]] };
    for (z, depth) in [(g + 1e-3, f64::from(g + 1e-3)), (g - 1e-3, 2.0)] {
        let blocked = Rig::new().with(&[before(z)]).pencil_return(3);
        assert!((blocked.depth - depth).abs() < 1e-12);
    }
}

#[test]
fn a_vertex_or_edge_that_touches_the_line_of_sight_hides() {
    // At z = 1 the camera's ray to the last point is at (1/2, -1). A small face touches exactly that point with a vertex
    // (its topmost, bottommost, leftmost or rightmost) or with the middle of an edge.
    let at = |x: f32, y: f32| [0.5 + x, -1.0 + y, 1.0];
    let r = 0.0625;
    for (touching, beside) in [
        ([at(0.0, 0.0), at(r, r), at(-r, r)], [0.0, r]),
        ([at(0.0, 0.0), at(-r, -r), at(r, -r)], [0.0, -r]),
        ([at(0.0, 0.0), at(r, -r), at(r, r)], [r, 0.0]),
        ([at(0.0, 0.0), at(-r, r), at(-r, -r)], [-r, 0.0]),
        ([at(-r, 0.0), at(r, 0.0), at(0.0, r)], [0.0, r]),
        ([at(-r, 0.0), at(0.0, -r), at(r, 0.0)], [0.0, -r]),
    ] {
        let apart = touching.map(|[x, y, z]| [x + 0.0625 * beside[0], y + 0.0625 * beside[1], z]);
        for (face, seen) in [(touching, false), (apart, true)] {
            for face in [face, reversed(face)] {
                assert_eq!(Rig::new().with(&[face]).pencil_return(3).visible, seen, "{face:?}");
            }
        }
    }
}

#[test]
fn a_face_seen_edge_on_hides_nothing() {
    // A face in the plane x = z/2, which contains the camera's ray to the last point: parallel to the segment.
    let edge_on: Face = [[0.25, -9.0, 0.5], [0.5, 9.0, 1.0], [0.75, -9.0, 1.5]];
    let rig = Rig::new().with(&[edge_on, reversed(edge_on)]);
    assert!(rig.pencil_return(3).visible);
}

#[test]
fn faces_without_area_hide_nothing() {
    // The camera's ray to the last point is at (1/2, -1, 1).
    let line: Face = [[-0.5, -1.0, 1.0], [0.5, -1.0, 1.0], [1.5, -1.0, 1.0]];
    let point: Face = [[0.5, -1.0, 1.0]; 3];
    assert!(Rig::new().with(&[line, point]).pencil_return(3).visible);
}

#[test]
fn coplanar_faces_do_not_hide_the_point() {
    // Many random planes through points of small integers, which are exact in `f32`. In each: the hit face, the same face
    // with its vertices cycled and reversed, and other faces in the same plane, also reversed. All contain the point, and
    // none hides it, however their planes are rounded. The camera is anywhere in front.
    let mut random = super::rig::RandomNumbers(1);
    let mut asked = 0;
    while asked < 300 {
        let [a, e, f] = [100.0, 8.0, 8.0].map(|size| (random.vector() * size).round());
        let at = |u: f64, v: f64| (DVec3::new(0.0, 0.0, 300.0) + a + e * u + f * v).as_vec3().to_array();
        let n = e.cross(f);
        // The front is towards the sensors, at an angle that is not too steep.
        if n.z > -0.3 * n.length() || n == DVec3::ZERO {
            continue;
        }
        let face = [at(-9.0, -9.0), at(0.0, 9.0), at(9.0, -9.0)].map(|[x, y, z]| [x, y, z]);
        let face = if DVec3::new(0.0, 0.0, 1.0).dot(n) < 0.0 { reversed(face) } else { face };
        let others: [Face; 4] = [
            [face[1], face[2], face[0]],
            reversed(face),
            [at(-7.0, -8.0), at(9.0, -9.0), at(-1.0, 11.0)],
            [at(-10.0, -7.0), at(8.0, -9.0), at(-1.0, 13.0)],
        ];
        let mut rig = Rig { faces: vec![face], ..Rig::new() }.with(&others).with(&others.map(reversed));
        // The laser is close to the normal axis through the face's middle, the camera beside it.
        let middle = DVec3::new(0.0, 0.0, 300.0) + a;
        rig.beams[0].scene_from_sensor.position = middle + random.vector() * 0.5 - DVec3::Z * 40.0;
        rig.beams[0].sensor.max_range = 1e3;
        rig.beams[0].sensor.columns = 1;
        rig.scene_from_camera.position = middle + random.vector() * 5.0 - DVec3::Z * 50.0;
        rig.scene_from_camera.rotation = random.rotation();
        let frame = rig.render();
        let Some(returned) = return_at(&frame, 0, 0, 0) else { continue };
        if returned.pixel.is_none() || returned.cos_view < 1e-3 {
            continue;
        }
        assert!(returned.visible, "{face:?}");
        asked += 1;
    }
}

#[test]
fn neighbours_do_not_hide_a_point_on_their_common_edge() {
    // A ridge or a valley along x = 1. The last pencil hits it on the edge, or in one of its two vertices.
    for bend in [-0.3_f32, 0.3, -0.1, 0.7] {
        let p = |x: f32, y: f32| [x, y, 2.0 + bend * (1.0 - x).abs()];
        for ends in [[-3.0, 5.0], [0.0, 5.0], [-3.0, 0.0]] {
            let [low, high] = ends;
            let faces = [[p(1.0, low), p(-7.0, 1.0), p(1.0, high)], [p(1.0, low), p(1.0, high), p(9.0, 0.1)]];
            let rig = Rig { faces: faces.to_vec(), ..Rig::new() };
            assert!(rig.pencil_return(3).visible, "{bend} {ends:?}");
        }
    }
}

#[test]
fn skipping_changes_nothing() {
    // Without skipping, every point is tested against every face.
    let exact = |skip_unseen, switches| ScanlineOptions { skip_unseen, switches };
    // Grounds with additional slivers, some of them across many pixels.
    let grounds = (0..8).map(|seed| {
        let slivers = if seed < 4 { 75 } else { 1000 };
        RandomGround { slivers, ..RandomGround::nasty(seed, 1500) }.build()
    });
    for ground in grounds.chain(BUILTIN_NAMES.iter().map(|name| builtin(name, 0.25).unwrap())) {
        let scene = rig_on(ground, 0.08);
        for switches in Switches::subsets().filter(|of| of.skip_rules == Fidelity::Exact) {
            let (with, without) =
                (render(&scene, exact(true, switches)), render(&scene, exact(false, switches)));
            assert!(with.returns == without.returns && with.flux == without.flux, "{switches}");
        }
    }
}

#[test]
fn exact_occlusion_agrees_with_a_test_of_segments_and_triangles() {
    // Expected, by volumes of tetrahedra in the scene's frame: P and the projection centre c are on different sides of the
    // triangle, and the segment passes all its edges on one side. Planes within 1 nm of P are taken to contain it. No
    // segment here passes an edge within rounding.
    let mut hidden = 0;
    for seed in 10..14 {
        let scene = rig_on(RandomGround::nasty(seed, 1500).build(), 0.08);
        let frame = render(&scene, ScanlineOptions::EXACT);
        let mesh = scene.mesh();
        let c = scene.camera().scene_from_sensor.position;
        let faces: Vec<_> = mesh
            .faces()
            .iter()
            .map(|face| face.map(|v| glam::Vec3::from(mesh.vertices()[v as usize]).as_dvec3() - c))
            .collect();
        for (beam, map) in frame.beams.iter().enumerate() {
            for (i, j) in (0..map.height).flat_map(|j| (0..map.width).map(move |i| (i, j))) {
                let Some(point) = map.point.as_ref().unwrap().at(i, j).get() else { continue };
                let returned = return_at(&frame, beam, i, j).unwrap();
                let p = point - c;
                let blocks = |[a, b, e]: &[DVec3; 3]| {
                    let n = (*b - *a).cross(*e - *a);
                    let (of_c, of_p) = (-n.dot(*a), n.dot(p - *a));
                    if of_c * of_p >= 0.0 || of_p.abs() <= 1e-9 * n.length() {
                        return false;
                    }
                    let sides = [a.cross(*b), b.cross(*e), e.cross(*a)].map(|side| side.dot(p));
                    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
                };
                let visible =
                    returned.cos_view > 0.0 && returned.pixel.is_some() && !faces.iter().any(blocks);
                assert_eq!(returned.visible, visible, "{seed} {beam} ({i}, {j})");
                hidden += usize::from(returned.cos_view > 0.0 && returned.pixel.is_some() && !visible);
            }
        }
    }
    assert!(hidden > 300, "{hidden}");
}

#[test]
fn the_cameras_maximum_range_does_not_matter() {
    let mut rig = Rig::new().with(&[blind(-0.05, 1.9)]);
    let hidden = rig.render();
    rig.camera.max_range = 0.5;
    assert_eq!(rig.render().returns, hidden.returns);
    let mut rig = Rig::new();
    rig.camera.max_range = 0.5;
    assert!(rig.pencil_return(3).visible);
    assert_eq!(rig.faces, [wall(2.0)]);
}
