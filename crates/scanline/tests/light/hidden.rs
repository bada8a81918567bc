//! What hides a point from the camera, and what does not.

use glam::DVec3;
use raypencil_scanline::{Fidelity, Options, Switches};
use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin};

use crate::rig::{Face, Rig, back, render, reversed, rig_on, wall};

/// A triangle at `z` whose lower side is at y = `bottom`.
fn blind(bottom: f32, z: f32) -> Face {
    [[-9.0, bottom, z], [0.0, bottom - 9.0, z], [9.0, bottom, z]]
}

#[test]
fn a_lid_hides_what_it_covers_however_low_it_is() {
    // The camera is 2 m above the pencils' plane y = 0 and 2 m from the wall: its ray to a point of the stripe is at
    // y = -h where it is h in front of the wall. A lid at that height down to y = -h/2 is in its way, and not in
    // the laser's. It hides as a front and as a back.
    assert!(Rig::new().pencil(3).visible);
    // The last: the next number below 2 of those that a vertex can have.
    for h in [0.1, 1e-3, 1e-4, 1e-6, 2.0 - 2_f32.next_down()] {
        let z = 2.0 - h;
        assert!(z < 2.0);
        // As rounded.
        let h = 2.0 - z;
        for covering in [blind(-0.5 * h, z), reversed(blind(-0.5 * h, z))] {
            let rig = Rig::new().and(&[covering]);
            for i in 0..4 {
                let back = rig.pencil(i);
                assert!(!back.visible && back.flux == 0.0 && back.depth == 2.0, "{h} {i}");
            }
        }
        // Up to y = -1.5 h only, or at that height behind the wall, it hides nothing.
        for clear in [blind(-1.5 * h, z), blind(-0.5 * h, 2.0 + h)] {
            let rig = Rig::new().and(&[clear, reversed(clear)]);
            assert!((0..4).all(|i| rig.pencil(i).visible), "{h}");
        }
    }
}

#[test]
fn a_blade_counts_from_the_spp_on() {
    // The last pencil's ray to the camera passes (1/2, 1) z from (0, -2, 0). A blade 1 mm beyond the camera's SPP at
    // z = 1/128 hides everything; one 1 mm before it nothing.
    let spp = 1.0 / 128.0;
    let around = |z: f32| -> Face { [[-0.5, -2.5, z], [0.0, -1.5, z], [0.5, -2.5, z]] };
    for (z, seen) in [(spp + 1e-3, false), (spp, false), (spp - 1e-3, true)] {
        for blade in [around(z), reversed(around(z))] {
            assert_eq!(Rig::new().and(&[blade]).pencil(3).visible, seen, "{z}");
        }
    }
    // One that the SPP cuts: of the plane z = spp + (y + 2), which the ray y + 2 = z does not meet, nothing; of
    // z = spp - 1 mm + (y + 2)/8, met at z = (spp - 1 mm) 8/7 = 7.8 mm > spp, the part beyond the SPP.
    let leaning = |at: f32, slope: f32| -> Face {
        [[-0.5, -2.5, at - 0.5 * slope], [0.5, -2.5, at - 0.5 * slope], [0.0, -1.0, at + slope]]
    };
    for (blade, seen) in [(leaning(spp, 1.0), true), (leaning(spp - 9e-4, 0.125), false)] {
        for blade in [blade, reversed(blade)] {
            assert_eq!(Rig::new().and(&[blade]).pencil(3).visible, seen, "{blade:?}");
        }
    }
    // And z = spp - 2 mm + (y + 2)/8, met at 6.6 mm < spp.
    assert!(Rig::new().and(&[leaning(spp - 2e-3, 0.125)]).pencil(3).visible);
    // The laser's grid is at z = 1/8. A blade 1 mm beyond it blocks the laser, one before it does not. It is below
    // the camera's rays to the wall.
    let g = 0.125;
    let before = |z: f32| -> Face { [[-1.5, -0.1, z], [-0.5, 0.3, z], [0.5, -0.1, z]] };
    for (z, depth) in [(g + 1e-3, f64::from(g + 1e-3)), (g - 1e-3, 2.0)] {
        let blocked = Rig::new().and(&[before(z)]).pencil(3);
        assert!((blocked.depth - depth).abs() < 1e-12);
    }
}

#[test]
fn a_corner_that_touches_the_line_of_sight_hides() {
    // At z = 1 the camera's ray to the last point is at (1/2, -1). A small face there whose corner, or the middle of
    // whose side, is exactly that point: its top, bottom, leftmost and rightmost.
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
                assert_eq!(Rig::new().and(&[face]).pencil(3).visible, seen, "{face:?}");
            }
        }
    }
}

#[test]
fn a_face_seen_edge_on_hides_nothing() {
    // In the plane x = (z)/2 of the camera's ray to the last point: parallel to the segment.
    let edge_on: Face = [[0.25, -9.0, 0.5], [0.5, 9.0, 1.0], [0.75, -9.0, 1.5]];
    let rig = Rig::new().and(&[edge_on, reversed(edge_on)]);
    assert!(rig.pencil(3).visible);
}

#[test]
fn faces_without_area_hide_nothing() {
    // The camera's ray to the last point is at (1/2, -1, 1).
    let line: Face = [[-0.5, -1.0, 1.0], [0.5, -1.0, 1.0], [1.5, -1.0, 1.0]];
    let point: Face = [[0.5, -1.0, 1.0]; 3];
    assert!(Rig::new().and(&[line, point]).pencil(3).visible);
}

#[test]
fn coplanar_faces_do_not_hide_the_point() {
    // In each of many random planes through points of small integers, which `f32` holds exactly: the face, then the
    // same from the other corners and reversed, and others in the same plane, also reversed. All hold the point, and
    // none hides it, however the planes of each are rounded. The camera looks on from anywhere in front.
    let mut numbers = crate::rig::Numbers(1);
    let mut asked = 0;
    while asked < 300 {
        let [a, e, f] = [100.0, 8.0, 8.0].map(|size| (numbers.vector() * size).round());
        let at = |u: f64, v: f64| (DVec3::new(0.0, 0.0, 300.0) + a + e * u + f * v).as_vec3().to_array();
        let n = e.cross(f);
        // Towards the sensors, not too steep.
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
        let mut rig = Rig { faces: vec![face], ..Rig::new() }.and(&others).and(&others.map(reversed));
        // The laser straight below the face's middle, the camera beside it.
        let middle = DVec3::new(0.0, 0.0, 300.0) + a;
        rig.beams[0].scene_from_sensor.position = middle + numbers.vector() * 0.5 - DVec3::Z * 40.0;
        rig.beams[0].sensor.max_range = 1e3;
        rig.beams[0].sensor.columns = 1;
        rig.scene_from_camera.position = middle + numbers.vector() * 5.0 - DVec3::Z * 50.0;
        rig.scene_from_camera.rotation = numbers.rotation();
        let frame = rig.render();
        let Some(back) = back(&frame, 0, 0, 0) else { continue };
        if back.pixel.is_none() || back.cos_view < 1e-3 {
            continue;
        }
        assert!(back.visible, "{face:?}");
        asked += 1;
    }
}

#[test]
fn neighbours_do_not_hide_a_point_on_their_common_side() {
    // A ridge along x = 1, which the last pencil hits on the edge, and at two of its vertices; and a valley.
    for bend in [-0.3_f32, 0.3, -0.1, 0.7] {
        let p = |x: f32, y: f32| [x, y, 2.0 + bend * (1.0 - x).abs()];
        for ends in [[-3.0, 5.0], [0.0, 5.0], [-3.0, 0.0]] {
            let [low, high] = ends;
            let faces = [[p(1.0, low), p(-7.0, 1.0), p(1.0, high)], [p(1.0, low), p(1.0, high), p(9.0, 0.1)]];
            let rig = Rig { faces: faces.to_vec(), ..Rig::new() };
            assert!(rig.pencil(3).visible, "{bend} {ends:?}");
        }
    }
}

#[test]
fn skipping_changes_nothing() {
    // Without skipping, every point is asked of every face.
    let exact = |skip_unseen, switches| Options { skip_unseen, switches };
    // Slivers, some of them across many pixels, besides all else.
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
fn exact_occlusion_is_that_of_segments_and_triangles() {
    // By six volumes each, in the scene's frame: P and the projection centre c on different sides of the triangle,
    // and the segment on one side of all its sides. Planes nearer to P than 1 nm are taken to hold it, and no
    // segment here passes an edge as closely as rounding.
    let mut hidden = 0;
    for seed in 10..14 {
        let scene = rig_on(RandomGround::nasty(seed, 1500).build(), 0.08);
        let frame = render(&scene, Options::EXACT);
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
                let back = back(&frame, beam, i, j).unwrap();
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
                let visible = back.cos_view > 0.0 && back.pixel.is_some() && !faces.iter().any(blocks);
                assert_eq!(back.visible, visible, "{seed} {beam} ({i}, {j})");
                hidden += usize::from(back.cos_view > 0.0 && back.pixel.is_some() && !visible);
            }
        }
    }
    assert!(hidden > 300, "{hidden}");
}

#[test]
fn the_cameras_range_plays_no_role() {
    let mut rig = Rig::new().and(&[blind(-0.05, 1.9)]);
    let hidden = rig.render();
    rig.camera.max_range = 0.5;
    assert_eq!(rig.render().returns, hidden.returns);
    let mut rig = Rig::new();
    rig.camera.max_range = 0.5;
    assert!(rig.pencil(3).visible);
    assert_eq!(rig.faces, [wall(2.0)]);
}
