//! No ray slips between the faces of what hides.

use glam::DVec3;

use crate::rig::{Face, Numbers, Rig, at, one_pencil, reversed, wall};

/// Vertices of a lattice of 9 x 9, displaced, at about z = 1, and its faces.
fn sheet(mut displaced: impl FnMut(f64, f64) -> DVec3) -> (Vec<[f32; 3]>, Vec<Face>) {
    let vertices: Vec<[f32; 3]> = (0..81)
        .map(|k| displaced(f64::from(k % 9) / 2.0 - 2.0, f64::from(k / 9) / 2.0 - 2.0).as_vec3().to_array())
        .collect();
    let mut faces = Vec::new();
    for k in (0..72).filter(|k| k % 9 != 8) {
        let [a, b, c, d] = [k, k + 1, k + 9, k + 10].map(|k| vertices[k]);
        // One diagonal or the other, one sense or the other.
        let pair = if k % 2 == 0 { [[a, b, d], [a, d, c]] } else { [[a, b, c], [c, b, d]] };
        faces.extend(if k % 3 == 0 { pair.map(reversed) } else { pair });
    }
    (vertices, faces)
}

/// Points of inner edges and inner vertices.
fn aims(vertices: &[[f32; 3]], faces: &[Face]) -> Vec<DVec3> {
    let p = |v: [f32; 3]| glam::Vec3::from(v).as_dvec3();
    let inner = |v: &[f32; 3]| {
        vertices
            .iter()
            .position(|other| other == v)
            .is_some_and(|k| (1..8).contains(&(k % 9)) && (1..8).contains(&(k / 9)))
    };
    let mut aims: Vec<DVec3> = vertices.iter().filter(|v| inner(v)).map(|v| p(*v)).collect();
    for face in faces {
        for (a, b) in [(face[0], face[1]), (face[1], face[2])] {
            if inner(&a) && inner(&b) {
                aims.extend([0.5, 0.25, 0.3].map(|s| p(a) + (p(b) - p(a)) * s));
            }
        }
    }
    aims
}

/// Asserts that the camera at `c` sees nothing of the wall at z = 2 behind a point of `aims`. The pencils start
/// between sheet and wall.
fn assert_covered(mut rig: Rig, c: DVec3, aims: &[DVec3]) {
    rig.scene_from_camera.position = c;
    // So wide that every aim is on the image of a camera turned a little.
    rig.camera.pixel_pitch = [rig.camera.focal_length / 16.0; 2];
    for aims in aims.chunks(64) {
        rig.beams = aims
            .iter()
            .map(|aim| {
                let p = c + (*aim - c) * ((2.0 - c.z) / (aim.z - c.z));
                at(p.x, p.y, 1.75, one_pencil())
            })
            .collect();
        let frame = rig.render();
        for beam in 0..aims.len() {
            let back = crate::rig::back(&frame, beam, 0, 0).expect("the wall");
            assert!(back.pixel.is_some(), "off the image");
            assert!(!back.visible, "{c} {}", aims[beam]);
        }
    }
}

#[test]
fn rays_through_vertices_and_edges_of_a_plane_lattice_are_hidden() {
    // All numbers are dyadic: the rays meet vertices and edges exactly.
    let (vertices, faces) = sheet(|x, y| DVec3::new(x, y, 1.0));
    let aims = aims(&vertices, &faces);
    let dyadic: Vec<_> = aims
        .into_iter()
        .filter(|aim| (aim.x * 16.0).fract() == 0.0 && (aim.y * 16.0).fract() == 0.0)
        .collect();
    assert!(dyadic.len() > 200);
    let rig = Rig { faces: vec![wall(2.0)], ..Rig::new() }.and(&faces);
    for c in [DVec3::ZERO, DVec3::new(0.25, -0.5, 0.0)] {
        assert_covered(rig.clone(), c, &dyadic);
    }
}

#[test]
fn rays_within_rounding_of_vertices_and_edges_are_hidden() {
    let mut numbers = Numbers(7);
    for _ in 0..12 {
        // Bent, so that the faces on both sides of an edge lean either way; no silhouette within the sheet.
        let (vertices, faces) = sheet(|x, y| DVec3::new(x, y, 1.0) + numbers.vector() * 0.1);
        let aims = aims(&vertices, &faces);
        assert!(aims.len() > 300);
        let mut rig = Rig { faces: vec![wall(2.0)], ..Rig::new() }.and(&faces);
        rig.scene_from_camera.rotation = numbers.rotation();
        assert_covered(rig, numbers.vector() * 0.3 - DVec3::Z * 0.5, &aims);
    }
}

#[test]
fn what_the_spp_cuts_is_watertight_too() {
    // The sheet as a funnel around the camera: its inner vertices are beyond the SPP, others behind the camera.
    let mut numbers = Numbers(9);
    for _ in 0..8 {
        let (vertices, faces) =
            sheet(|x, y| DVec3::new(x, y, 1.0 - 0.9 * (x * x + y * y)) + numbers.vector() * 0.03);
        let c = DVec3::new(0.0, 0.0, 0.3) + numbers.vector() * 0.02;
        let mut rig = Rig { faces: vec![wall(2.0)], ..Rig::new() }.and(&faces);
        rig.camera.focal_length = 0.125;
        // Edges of faces that reach behind the SPP, aimed at where they are well beyond it.
        let cut = |z: f64| z < c.z + 0.125;
        let p = |v: [f32; 3]| glam::Vec3::from(v).as_dvec3();
        let mut aims = Vec::new();
        for [a, b, e] in faces.iter().map(|face| face.map(p)) {
            for (a, b) in [(a, b), (b, e), (e, a)] {
                let border = |p: DVec3| p.x.abs() > 1.8 || p.y.abs() > 1.8;
                if (cut(a.z) || cut(b.z)) && !(border(a) && border(b)) {
                    aims.extend(
                        [0.1, 0.3, 0.5, 0.7, 0.9]
                            .map(|s| a + (b - a) * s)
                            .iter()
                            .filter(|aim| aim.z > c.z + 0.2),
                    );
                }
            }
        }
        assert!(vertices.len() == 81 && aims.len() > 10, "{}", aims.len());
        assert_covered(rig, c, &aims);
    }
}
