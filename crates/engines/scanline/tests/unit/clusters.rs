//! Unit tests of `clusters`.

use proptest::prelude::*;
use raypencil_scene::{Camera, Material, Mounted, Pose};
use raypencil_terrain::RandomGround;

use super::*;
use crate::Switches;
use crate::cylindrical::Cylindrical;
use crate::fixtures::{beam, camera};
use crate::perspective::Perspective;
use crate::tables::CameraTables;
use crate::transformation::Transformation;

fn ground_of(vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.5 }];
    let of_faces = vec![0; faces.len()];
    Arc::new(Mesh::new(DVec3::ZERO, vertices, faces, of_faces, materials).unwrap())
}

/// Every face is in one cluster, with its own vertices, in the box of the cluster and of its group. Returns the number of
/// clusters.
fn check(mesh: &Arc<Mesh>) -> usize {
    let clusters = Clusters::new(mesh);
    let mut seen = vec![false; mesh.faces().len()];
    let contains = |bounds: &Bounds, vertex: [f32; 3]| {
        (0..3).all(|k| bounds.low[k] <= vertex[k] && vertex[k] <= bounds.high[k])
    };
    for index in clusters.all() {
        let ClusterContent { vertices, faces } = clusters.content(index);
        assert!(!faces.is_empty() && faces.len() <= MAX_FACES && vertices.len() <= MAX_VERTICES);
        for face in faces {
            let corners = face.corners.map(|place| vertices[usize::from(place)]);
            assert_eq!(corners, mesh.faces()[face.id.0 as usize]);
            assert!(!std::mem::replace(&mut seen[face.id.0 as usize], true));
            for vertex in corners.map(|corner| mesh.vertices()[corner as usize]) {
                assert!(contains(&clusters.clusters[index as usize].bounds, vertex));
                assert!(contains(&clusters.groups[index as usize / CLUSTERS_PER_GROUP], vertex));
            }
        }
    }
    assert!(seen.iter().all(|seen| *seen));
    clusters.clusters.len()
}

#[test]
fn every_face_is_in_one_cluster() {
    assert_eq!(check(&ground_of(vec![], vec![])), 0);
    assert_eq!(check(&ground_of(vec![[1.0; 3]], vec![[0; 3]])), 1);
    for seed in 0..4 {
        let mesh = Arc::new(RandomGround::nasty(seed, 20_000).build().into_mesh().unwrap());
        let clusters = check(&mesh);
        assert!(clusters < mesh.faces().len() / 40, "{clusters}");
    }
    // Ten thousand faces in one place that share no vertex: 85 of them fill a cluster, but for the last of each piece.
    let corner = |k: u32| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][(k % 3) as usize];
    let faces = (0..10_000).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let apart = ground_of((0..30_000).map(corner).collect(), faces);
    let of_piece = |first: usize| (10_000 - first).min(64 * MAX_FACES).div_ceil(85);
    assert_eq!(check(&apart), (0..10_000_usize).step_by(64 * MAX_FACES).map(of_piece).sum());
}

/// The places of a cluster's vertices are bytes: the 256th is the last. A cluster of 84 faces that share nothing has 252 vertices; then
/// come faces that bring none to three new ones.
#[test]
fn the_256th_vertex_is_in_a_cluster_and_the_257th_in_the_next() {
    let corner = |k: u32| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][k as usize];
    for news in (0..64_u32).map(|k| [k % 4, k / 4 % 4, k / 16]) {
        let mut vertices: Vec<[f32; 3]> = Vec::new();
        let mut faces: Vec<[u32; 3]> = Vec::new();
        let mut add = |new: u32| {
            // The other corners are those of the first face.
            faces.push([0, 1, 2].map(|k| {
                if k >= new {
                    return k;
                }
                vertices.push(corner(k));
                vertices.len() as u32 - 1
            }));
        };
        (0..84).for_each(|_| add(3));
        news.into_iter().for_each(&mut add);
        (0..5).for_each(|_| add(3));
        assert_eq!(check(&ground_of(vertices, faces)), 2, "{news:?}");
    }
}

#[test]
fn a_million_faces_in_one_place_and_nested_ones_are_clustered_quickly() {
    let one = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(check(&ground_of(one, vec![[0, 1, 2]; 1_000_000])) > 10_000);
    // Triangles around one centre, each a little larger: all have the same middle.
    let corner = |k: u32, x: f32, y: f32| [x * (1.0 + k as f32 * 1e-4), y * (1.0 + k as f32 * 1e-4), 0.0];
    let nested =
        (0..100_000).flat_map(|k| [corner(k, -1.0, -1.0), corner(k, 1.0, -1.0), corner(k, 0.0, 2.0)]);
    check(&ground_of(nested.collect(), (0..100_000).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect()));
}

#[test]
fn neighbours_on_the_curve_are_neighbours_in_space() {
    assert_eq!((spread(0b1011), spread(0x1f_ffff)), (0b1_000_001_001, 0x1249_2492_4924_9249));
    // A plain of 32 x 32 squares, two faces each. The box of a cluster has sides of some 7 squares, not of 32. Squares of a millimetre
    // are sorted as those of a metre are.
    for side in [1.0, 1.0 / 1024.0] {
        let vertices = (0..33 * 33).map(|k| [(k % 33) as f32 * side, (k / 33) as f32 * side, 0.0]).collect();
        let square = |k: u32| {
            let a = k / 32 * 33 + k % 32;
            [[a, a + 1, a + 34], [a, a + 34, a + 33]]
        };
        let mesh = ground_of(vertices, (0..1024).flat_map(square).collect());
        for cluster in &Clusters::new(&mesh).clusters {
            let Bounds { low, high } = cluster.bounds;
            assert!((0..3).all(|k| high[k] - low[k] <= 16.0 * side), "{side} {cluster:?}");
        }
    }
}

#[test]
fn a_box_is_widened_by_a_part_of_its_farthest_offset() {
    // From (10, 20, 30) the offsets are -2 to 1, -1 to 3 and -6 to 5: the farthest are 2, 3 and 6, and 7 together.
    let bounds = Bounds { low: [8.0, 19.0, 24.0], high: [11.0, 23.0, 35.0] };
    let corners = bounds.corners(DVec3::new(10.0, 20.0, 30.0));
    let widening = 7.0 * RELATIVE_WIDENING;
    let [x, y, z] =
        [[-2.0, 1.0], [-1.0, 3.0], [-6.0, 5.0]].map(|[low, high]| [low - widening, high + widening]);
    for corner in 0..8 {
        let expected = DVec3::new(x[corner % 2], y[corner / 2 % 2], z[corner / 4]);
        assert_eq!(corners.iter().filter(|found| **found == expected).count(), 1, "{expected} {corners:?}");
    }
}

proptest! {
    // What is skipped as a cluster would be skipped face by face: its vertices, as they are computed, share a side that they
    // are outside of. Far from the scene's origin too, where positions are coarse.
    #[test]
    fn a_cluster_is_skipped_where_each_of_its_faces_would_be(
        seed in any::<u64>(),
        local_offset in prop_oneof![Just(0.0f32), Just(3e4), Just(2e6)],
        at in prop::array::uniform3(-12.0f64..12.0),
        axis in prop::array::uniform3(-1.0f64..1.0),
        turn in 0.0f64..6.3,
        max_range in 0.5f64..20.0,
    ) {
        let mesh = RandomGround::nasty(seed, 3000).build().into_mesh().unwrap();
        let moved = mesh.vertices().iter().map(|[x, y, z]| [x + local_offset, *y, *z]).collect();
        let mesh = ground_of(moved, mesh.faces().to_vec());
        let clusters = Clusters::new(&mesh);
        let axis = DVec3::from_array(axis).normalize_or(DVec3::Z);
        let position = DVec3::from_array(at) + DVec3::new(f64::from(local_offset), 0.0, 0.0);
        let pose = Pose::from_position(position) * Pose::from_axis_angle(axis, turn);
        let camera = Camera { max_range, ..camera() };
        let tables = CameraTables::new(&camera);
        let perspective = Perspective::new(&Mounted { scene_from_sensor: pose, sensor: camera }, &tables);
        let cylindrical = Cylindrical::new(&Mounted { scene_from_sensor: pose, sensor: beam() }, Switches::EXACT);
        prop_assert!(skips_what_it_may(&mesh, &clusters, &perspective)? <= clusters.all().len());
        prop_assert!(skips_what_it_may(&mesh, &clusters, &cylindrical)? <= clusters.all().len());
    }
}

/// The number of clusters that are skipped; an error if one has vertices that share no side.
fn skips_what_it_may(
    mesh: &Mesh,
    clusters: &Clusters,
    transformation: &impl Transformation,
) -> Result<usize, TestCaseError> {
    let sensor_from_scene = transformation.sensor_from_scene();
    let seen = clusters.seen(sensor_from_scene.position(), |corners| {
        let outside = |corner: &DVec3| transformation.outside(sensor_from_scene.in_sensor_axes(*corner));
        corners.iter().fold(u8::MAX, |all, corner| all & outside(corner)) != 0
    });
    let skipped = clusters.all().into_iter().filter(|cluster| !seen.contains(cluster));
    let mut count = 0;
    for cluster in skipped {
        let outside = |&vertex: &u32| {
            let point = widen(mesh.vertices()[vertex as usize]);
            transformation.outside(sensor_from_scene.in_sensor_axes(sensor_from_scene.offset_of(point)))
        };
        let shared =
            clusters.content(cluster).vertices.iter().map(outside).fold(u8::MAX, |all, bits| all & bits);
        prop_assert!(shared != 0, "cluster {cluster}");
        count += 1;
    }
    Ok(count)
}
