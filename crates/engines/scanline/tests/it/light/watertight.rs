//! Watertight occlusion: no line of sight slips between two faces.

use glam::DVec3;

use super::rig::{Face, RandomNumbers, Rig, at, one_pencil, reversed, wall};

/// Vertices of a lattice of 9 x 9, displaced, at about z = 1, and its faces.
fn sheet(mut displaced: impl FnMut(f64, f64) -> DVec3) -> (Vec<[f32; 3]>, Vec<Face>) {
    let vertices: Vec<[f32; 3]> = (0..81)
        .map(|k| displaced(f64::from(k % 9) / 2.0 - 2.0, f64::from(k / 9) / 2.0 - 2.0).as_vec3().to_array())
        .collect();
    let mut faces = Vec::new();
    for k in (0..72).filter(|k| k % 9 != 8) {
        let [a, b, c, d] = [k, k + 1, k + 9, k + 10].map(|k| vertices[k]);
        // Alternate between the two diagonals, and between the two orientations.
        let pair = if k % 2 == 0 { [[a, b, d], [a, d, c]] } else { [[a, b, c], [c, b, d]] };
        faces.extend(if k % 3 == 0 { pair.map(reversed) } else { pair });
    }
    (vertices, faces)
}

/// The inner vertices, and points on the inner edges.
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

/// Asserts that the camera at `c` does not see the wall at z = 2 behind any point of `aims`. The pencils start between
/// the sheet and the wall.
fn assert_covered(mut rig: Rig, c: DVec3, aims: &[DVec3]) {
    rig.scene_from_camera.position = c;
    // So wide that every aim is on the image, even of a camera turned a little.
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
            let returned = super::rig::return_at(&frame, beam, 0, 0).expect("the wall");
            assert!(returned.pixel.is_some(), "off the image");
            assert!(!returned.visible, "{c} {}", aims[beam]);
        }
    }
}

#[test]
fn rays_through_vertices_and_edges_of_a_plane_lattice_are_hidden() {
    // All numbers are dyadic, so the rays meet vertices and edges exactly.
    let (vertices, faces) = sheet(|x, y| DVec3::new(x, y, 1.0));
    let aims = aims(&vertices, &faces);
    let dyadic: Vec<_> = aims
        .into_iter()
        .filter(|aim| (aim.x * 16.0).fract() == 0.0 && (aim.y * 16.0).fract() == 0.0)
        .collect();
    assert!(dyadic.len() > 200);
    let rig = Rig { faces: vec![wall(2.0)], ..Rig::new() }.with(&faces);
    for c in [DVec3::ZERO, DVec3::new(0.25, -0.5, 0.0)] {
        assert_covered(rig.clone(), c, &dyadic);
    }
}

#[test]
fn rays_within_rounding_of_vertices_and_edges_are_hidden() {
    let mut random = RandomNumbers(7);
    for _ in 0..12 {
        // A bent sheet: the faces beside an edge lean either way. It has no silhouette inside.
        let (vertices, faces) = sheet(|x, y| DVec3::new(x, y, 1.0) + random.vector() * 0.1);
        let aims = aims(&vertices, &faces);
        assert!(aims.len() > 300);
        let mut rig = Rig { faces: vec![wall(2.0)], ..Rig::new() }.with(&faces);
        rig.scene_from_camera.rotation = random.rotation();
        assert_covered(rig, random.vector() * 0.3 - DVec3::Z * 0.5, &aims);
    }
}

#[test]
fn faces_that_the_spp_cuts_are_watertight_too() {
    // The sheet is a funnel around the camera: its inner vertices are beyond the SPP, others are behind the camera.
    let mut random = RandomNumbers(9);
    for _ in 0..8 {
        let (vertices, faces) =
            sheet(|x, y| DVec3::new(x, y, 1.0 - 0.9 * (x * x + y * y)) + random.vector() * 0.03);
        let c = DVec3::new(0.0, 0.0, 0.3) + random.vector() * 0.02;
        let mut rig = Rig { faces: vec![wall(2.0)], ..Rig::new() }.with(&faces);
        rig.camera.focal_length = 0.125;
        // Aims on edges that reach behind the SPP, at points well beyond it.
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
