//! How far beside a needle a ray may be said to meet it, and within it to miss it: at 0.9 of what rounding explains it is excused, at
//! 1.1 it is not.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_judge::{Judge, JudgeShare};
use raypencil_referee::{Ruling, aspect};
use raypencil_scene::{
    Atmosphere, Camera, FaceId, FluxModel, Material, Mesh, Mounted, Place, Pose, Precision, Scene, SensorId,
    rig,
};

const PIXEL: Place = Place { sensor: SensorId::Camera, i: 4, j: 4 };

/// A face of 4 m along x in the plane z = 0, this wide in y, and a wall 1 m under it.
fn corners(width: f32) -> [[f32; 3]; 6] {
    let wall = [[-2.0, -3.0, -1.0], [3.0, -3.0, -1.0], [0.5, 4.0, -1.0]];
    [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, width, 0.0], wall[0], wall[1], wall[2]]
}

/// The face's edge along x under a pixel that looks at it from 3 m away, square to the edge, with this sine between ray and
/// normal. The ray passes the edge `inside` metres within the face, across the ray, or outside if that is negative. Cells are as wide
/// as `cell`, as an angle.
fn scene(width: f32, sine: f64, inside: f64, cell: f64) -> Scene {
    let cosine = (1.0 - sine * sine).sqrt();
    let (forward, across) = (DVec3::new(0.0, sine, -cosine), DVec3::new(0.0, cosine, sine));
    let position = DVec3::new(0.5, 0.0, 0.0) + across * inside - 3.0 * forward;
    // A turn about x: the camera's rows stay parallel to the edge.
    let pose = Pose { position, rotation: DQuat::from_rotation_arc(DVec3::Z, forward) };
    let sensor = Camera { max_range: 100.0, ..rig::camera(9, 9, cell * 1e-2, 1e-2) };
    let stone = Material { name: "stone".into(), reflectivity: 0.25 };
    let faces = vec![[0, 1, 2], [3, 4, 5]];
    let mesh = Mesh::new(DVec3::ZERO, corners(width).to_vec(), faces, vec![0; 2], vec![stone]).unwrap();
    let camera = Mounted { scene_from_sensor: pose, sensor };
    Scene::new(Arc::new(mesh), camera, vec![], Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .unwrap()
}

#[test]
fn a_ray_may_pass_an_edge_by_the_roundings_of_a_direction_and_of_the_planes_point() {
    // A needle, for which the plane's point counts most, and a wide face, for which the direction does.
    let widths: [f32; 2] = [0.0625, 2.0];
    let arithmetics = [(Precision::F64, 2e-6), (Precision::F32, 1e-2)];
    for (width, (precision, cell)) in widths.into_iter().flat_map(|width| arithmetics.map(|one| (width, one)))
    {
        let shapes = [0, 3].map(|first| {
            let [a, b, c] = [0, 1, 2].map(|k| DVec3::from_array(corners(width)[first + k].map(f64::from)));
            (aspect([a, b, c]), a.distance(b).max(b.distance(c)).max(c.distance(a)))
        });
        for sine in [0.0_f64, 0.3, 0.8] {
            // |o| is some millimetres more or less than the distance from the scene's origin, which is 1/2 m beside.
            let angle = |(kappa, longest): (f64, f64), range: f64| {
                let size = range + longest + (9.0_f64 + 0.25).sqrt();
                (21.0 + (10.0 * kappa + 27.0) * sine) * precision.unit_roundoff * size / range
            };
            let of_needle = angle(shapes[0], 3.0);
            let of_wall = angle(shapes[1], 3.0 + 1.0 / (1.0 - sine * sine).sqrt());
            for (share, is_excused) in [(0.9, true), (1.1, false)] {
                for (side, stated) in [(-1.0, 0), (1.0, 1)] {
                    // Where the wall is named, the needle is lost: the larger of the two.
                    let most = 3.0 * if stated == 0 { of_needle } else { of_needle.max(of_wall) };
                    let scene = scene(width, sine, side * share * most, cell);
                    let judge = Judge::new(&scene, JudgeShare::All);
                    let exact = judge.referee().verdict(PIXEL.sensor, 4, 4).unwrap().faces;
                    assert_eq!(exact, [FaceId(1 - stated)]);
                    let ruling = judge.rule(PIXEL, Some(FaceId(stated)), None, precision);
                    let what =
                        format!("{precision:?} sine {sine} {share} of {most:e}, face {stated}: {ruling:?}");
                    assert_eq!(matches!(ruling, Ruling::Rounding(_)), is_excused, "{what}");
                }
            }
        }
    }
}
