//! Situations in which programs for rays and meshes are known to have gone wrong, as people report them, each on a mesh of its own.

use glam::DVec3;
use raypencil_cast::{Answers, Questions, cast};
use raypencil_mesh_io::triangles_from_bytes;
use raypencil_scene::{CastRay, Side, Sides, Silent, Triangles};

const ALL: Questions = Questions { any: true, all: true, margins: false };

fn ray(origin: [f64; 3], direction: [f64; 3]) -> CastRay {
    CastRay::new(DVec3::from_array(origin), DVec3::from_array(direction))
}

fn answers(mesh: &Triangles, rays: &[CastRay], sides: Sides) -> Answers {
    cast(mesh, rays, sides, ALL, &Silent)
}

/// The t of each group of hits of a ray, the number of its faces, and how often the surface is crossed there.
fn groups(mesh: &Triangles, of: CastRay) -> Vec<(f64, usize, i32)> {
    let found = answers(mesh, &[of], Sides::Both).all.expect("all hits");
    found[0].iter().map(|group| (group.t, group.faces.len(), group.crossing)).collect()
}

/// How often a ray has crossed to the inside by its end, less to the outside: 0 if it begins outside of a closed mesh.
fn begins_inside(mesh: &Triangles, of: CastRay) -> bool {
    groups(mesh, of).iter().map(|(_, _, crossing)| crossing).sum::<i32>() != 0
}

/// A mesh from the text of an OBJ file.
fn obj(text: &str) -> Triangles {
    triangles_from_bytes(text.as_bytes(), "a.obj".as_ref()).expect("a mesh")
}

/// Boxes around the origin; with `turn` their fronts are inwards.
fn boxes(halves: &[(f64, bool)]) -> Triangles {
    let corner = |k: usize, half: f64| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { half } else { -half });
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let vertices = halves.iter().flat_map(|&(half, _)| (0..8).map(move |k| corner(k, half))).collect();
    let faces = halves.iter().zip(0_u32..).flat_map(|(&(_, turned), number)| {
        squares.into_iter().flat_map(move |square| {
            let [a, b, c, d] = square.map(|k: u32| 8 * number + k);
            if turned { [[a, c, b], [a, d, c]] } else { [[a, b, c], [a, c, d]] }
        })
    });
    Triangles::new(vertices, faces.collect()).expect("boxes")
}

/// A sphere of rings and columns with a vertex at each pole, around a centre.
fn sphere(centre: [f64; 3], radius: f64, rings: u32, columns: u32) -> Triangles {
    let mut vertices = vec![[0.0, 0.0, radius]];
    for ring in 1..rings {
        let tilt = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        for column in 0..columns {
            let turn = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
            let (across, z) = (radius * libm::sin(tilt), radius * libm::cos(tilt));
            vertices.push([across * libm::cos(turn), across * libm::sin(turn), z]);
        }
    }
    vertices.push([0.0, 0.0, -radius]);
    let last = vertices.len() as u32 - 1;
    let at = |ring: u32, column: u32| 1 + (ring - 1) * columns + column % columns;
    let mut faces = Vec::new();
    for column in 0..columns {
        faces.push([0, at(1, column), at(1, column + 1)]);
        faces.push([last, at(rings - 1, column + 1), at(rings - 1, column)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, column), at(ring, column + 1)];
            let [c, d] = [at(ring + 1, column), at(ring + 1, column + 1)];
            faces.extend([[a, c, d], [a, d, b]]);
        }
    }
    let vertices = vertices.iter().map(|v| [v[0] + centre[0], v[1] + centre[1], v[2] + centre[2]]).collect();
    Triangles::new(vertices, faces).expect("a sphere")
}

#[test]
fn a_rays_way_through_corners_edges_and_diagonals_is_one_crossing() {
    let cube = boxes(&[(1.0, false)]);
    // Both triangles of a side by its diagonal; three sides by a corner, of six faces or fewer; two sides by an edge.
    assert_eq!(groups(&cube, ray([0.25, 0.25, 3.0], [0.0, 0.0, -1.0])), [(2.0, 2, 1), (4.0, 2, -1)]);
    for corner in 0..8_usize {
        let from = [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 2.0 } else { -2.0 });
        let found = groups(&cube, ray(from, from.map(|part| -part)));
        assert_eq!(
            found.iter().map(|(t, _, crossing)| (*t, *crossing)).collect::<Vec<_>>(),
            [(0.5, 1), (1.5, -1)]
        );
        assert!(found.iter().all(|(_, faces, _)| (3..=6).contains(faces)), "{found:?}");
    }
    assert_eq!(groups(&cube, ray([2.0, 2.0, 0.5], [-1.0, -1.0, 0.0])).iter().map(|g| g.2).sum::<i32>(), 0);
    // Along a side, in its plane: those of the ends are met, and nothing is inside.
    assert!(!begins_inside(&cube, ray([3.0, 1.0, 0.5], [-1.0, 0.0, 0.0])));
    assert!(!begins_inside(&cube, ray([3.0, 1.0, 1.0], [-1.0, 0.0, 0.0])));
    // Beside a diagonal by 1e-15: one face, not none and not two.
    let beside = groups(&cube, ray([0.25, 0.25 + 1e-15, 3.0], [0.0, 0.0, -1.0]));
    assert_eq!(beside.iter().map(|g| g.1).collect::<Vec<_>>(), [1, 1]);
}

#[test]
fn a_hollow_box_is_inside_in_its_walls_alone() {
    let hollow = boxes(&[(2.0, false), (1.0, true)]);
    for (at, expected) in [(0.0, false), (1.5, true), (2.5, false), (-1.5, true), (-2.5, false)] {
        for direction in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 1.0, 1.0], [-0.0, 0.0, 1.0]] {
            assert_eq!(
                begins_inside(&hollow, ray([at, 0.0, 0.0], direction)),
                expected,
                "{at}, {direction:?}"
            );
        }
    }
    // Between two shells the fronts alone of one of them are seen.
    let between = |sides| answers(&hollow, &[ray([1.5, 0.1, 0.2], [-1.0, 0.0, 0.0])], sides);
    let first = |answers: &Answers| answers.hits().next().map(|hit| (hit.t, hit.side));
    assert_eq!(first(&between(Sides::Both)), Some((0.5, Side::Back)));
    assert_eq!(first(&between(Sides::Fronts)), Some((2.5, Side::Front)));
}

#[test]
fn points_of_a_lattice_are_inside_a_sphere_by_one_ray_each() {
    // The ray of each point runs through vertices and edges of the sphere by its symmetry. A point counts as inside a polyhedron if
    // it is behind all faces, which are convex together.
    let ball = sphere([0.0; 3], 1.0, 8, 12);
    let is_behind_all = |p: DVec3| {
        ball.faces().iter().all(|face| {
            let [a, b, c] = face.map(|corner| DVec3::from_array(ball.vertices()[corner as usize]));
            (b - a).cross(c - a).dot(p - a) < 0.0
        })
    };
    let (mut inside, mut outside) = (0, 0);
    let lattice = |k: u32| (f64::from(k) - 7.5) / 7.0;
    for k in 0..16 * 16 * 16_u32 {
        let p = DVec3::new(lattice(k % 16), lattice(k / 16 % 16), lattice(k / 256));
        let expected = is_behind_all(p);
        assert_eq!(begins_inside(&ball, CastRay::new(p, DVec3::Z)), expected, "{p}");
        *if expected { &mut inside } else { &mut outside } += 1;
    }
    assert!(inside > 500 && outside > 500, "{inside} inside, {outside} outside");
}

#[test]
fn signs_of_zero_ends_and_small_gaps_decide_nothing_wrongly() {
    let cube = boxes(&[(1.0, false)]);
    for zero in [0.0, -0.0] {
        assert_eq!(groups(&cube, ray([0.3, zero, 3.0], [zero, -zero, -1.0])), [(2.0, 1, 1), (4.0, 1, -1)]);
    }
    // An end exactly at the hit belongs to the ray; just before it the ray misses.
    let until = |t_max: f64| CastRay { t_max, ..ray([0.3, 0.2, 3.0], [0.0, 0.0, -1.0]) };
    assert_eq!(groups(&cube, until(2.0)).len(), 1);
    assert_eq!(groups(&cube, until(2.0_f64.next_down())).len(), 0);
    // Two spheres 4e-5 apart, seen along the line between their centres: four surfaces in order.
    let mesh = [sphere([0.0; 3], 1.0, 8, 12), sphere([0.0, 0.0, 2.00004], 1.0, 8, 12)];
    let vertices = mesh.iter().flat_map(|mesh| mesh.vertices().to_vec()).collect();
    let count = mesh[0].vertices().len() as u32;
    let second = mesh[1].faces().iter().map(|face| face.map(|corner| corner + count));
    let faces = mesh[0].faces().iter().copied().chain(second).collect();
    let both = Triangles::new(vertices, faces).expect("two spheres");
    let found = groups(&both, ray([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]));
    assert_eq!(found.iter().map(|(_, _, crossing)| *crossing).collect::<Vec<_>>(), [1, -1, 1, -1]);
    assert!((found[2].0 - found[1].0 - 4e-5).abs() < 1e-12, "{found:?}");
}

#[test]
fn map_coordinates_keep_their_digits() {
    // A square of 2 m at coordinates of UTM and of the earth's centre, seen from 1 m away, off its middle by a millimetre.
    for [x, y, z] in [[500_000.0, 4_649_776.22, 1_234.5], [3_980_574.247, -102.127, 4_966_824.522]] {
        let corner = |dx: f64, dy: f64| format!("v {} {} {}\n", x + dx, y + dy, z);
        let text = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)].concat()
            + "f 1 2 3 4\n";
        let mesh = obj(&text);
        let found = answers(&mesh, &[ray([x + 0.001, y, z + 1.0], [0.0, 0.0, -1.0])], Sides::Fronts);
        let hit = found.hits().next().expect("a hit");
        assert_eq!(hit.t, (z + 1.0) - z);
        assert_eq!(hit.point.to_array(), [x + 0.001, y, z]);
    }
}

#[test]
fn negative_indices_between_vertices_are_those_before_them() {
    let mesh = obj("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf -3 -2 -1\n");
    assert_eq!(mesh.faces(), [[1, 2, 3], [4, 5, 6]]);
    assert_eq!(
        groups(&mesh, ray([0.2, 0.2, 9.0], [0.0, 0.0, -1.0])).iter().map(|g| g.0).collect::<Vec<_>>(),
        [4.0, 9.0]
    );
}
