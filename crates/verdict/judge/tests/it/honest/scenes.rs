//! Random scenes that are hard for rounded arithmetic: small faces, needles, planks from both sides, shells one behind the other,
//! all of it far away; and single lines aimed at an edge.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scene::{
    Atmosphere, Camera, FluxModel, Material, Mesh, Mounted, Place, Pose, Scene, SensorId, rig,
};

/// The generator SplitMix64. (G. Steele, D. Lea and C. Flood 2014, doi:10.1145/2660193.2660195)
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        word ^ (word >> 31)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number whose logarithm is drawn uniformly.
    fn spread(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }

    fn vector(&mut self, bound: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.between(-bound, bound)))
    }

    fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.between(-1.0, 1.0), self.between(0.0, TAU));
        let (sin, cos) = libm::sincos(angle);
        let level = (1.0 - z * z).sqrt();
        DVec3::new(level * cos, level * sin, z)
    }

    /// A direction across another.
    fn across(&mut self, along: DVec3) -> DVec3 {
        along.cross(self.direction()).normalize()
    }

    fn corner(&mut self) -> usize {
        (self.next() % 3) as usize
    }
}

/// What stands on the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    Soup,
    Needles,
    Planks,
    Shells,
}

type Corners = [DVec3; 3];

fn scene_of(faces: &[Corners], camera: Mounted<Camera>, beams: Vec<Mounted<raypencil_scene::Beam>>) -> Scene {
    let vertices = faces.iter().flatten().map(|corner| corner.as_vec3().to_array()).collect();
    let count = faces.len() as u32;
    let indices = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let stone = Material { name: "stone".into(), reflectivity: 0.25 };
    let mesh = Mesh::new(DVec3::ZERO, vertices, indices, vec![0; faces.len()], vec![stone]).unwrap();
    Scene::new(Arc::new(mesh), camera, beams, Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .unwrap()
}

/// A face from both sides. The back begins at another corner.
fn both_sides([a, b, c]: Corners) -> [Corners; 2] {
    [[a, b, c], [c, b, a]]
}

fn things(kind: Kind, draws: &mut Draws) -> Vec<Corners> {
    let place = |draws: &mut Draws| {
        DVec3::new(draws.between(2.0, 8.0), draws.between(-3.0, 3.0), draws.between(-1.0, 2.0))
    };
    match kind {
        Kind::Soup => (0..60)
            .map(|_| {
                let at = place(draws);
                [at, at + draws.vector(1.0), at + draws.vector(1.0)]
            })
            .collect(),
        Kind::Needles => (0..60)
            .flat_map(|_| {
                let (at, along) = (place(draws), draws.direction() * draws.between(1.0, 5.0));
                let thick = draws.direction() * draws.spread(1e-4, 0.1);
                both_sides([at, at + along, at + along * draws.between(0.0, 1.0) + thick])
            })
            .collect(),
        Kind::Planks => (0..40)
            .flat_map(|_| {
                let (a, along) = (place(draws), draws.direction() * draws.between(1.0, 9.0));
                let thick = draws.across(along) * draws.between(5e-3, 0.2);
                let (b, c, d) = (a + along, a + along + thick, a + thick);
                [both_sides([a, b, c]), both_sides([a, c, d])].concat()
            })
            .collect(),
        Kind::Shells => [1.0, 1.0 + 1e-6, 1.0 + 1e-3]
            .into_iter()
            .flat_map(|radius| {
                let at = move |i: u32, j: u32| {
                    let (down, around) = (PI * f64::from(j) / 6.0, TAU * f64::from(i % 8) / 8.0);
                    let (level, up) = (libm::sin(down), libm::cos(down));
                    let out = DVec3::new(level * libm::cos(around), level * libm::sin(around), up);
                    DVec3::new(5.0, 0.0, 0.3) + radius * out
                };
                let cells = (0..8).flat_map(|i| (0..6).map(move |j| (i, j)));
                cells.flat_map(move |(i, j)| {
                    let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                    [both_sides([a, d, c]), both_sides([a, c, b])].concat()
                })
            })
            .collect(),
    }
}

/// The default rig before such things, `far` metres from the scene's origin.
pub(crate) fn drawn(kind: Kind, far: f64, draws: &mut Draws) -> Scene {
    let shift = draws.direction() * far;
    let ground =
        [DVec3::new(-20.0, -30.0, -1.2), DVec3::new(40.0, -30.0, -1.1), DVec3::new(10.0, 40.0, -1.3)];
    let mut faces = vec![ground];
    faces.extend(things(kind, draws));
    let moved: Vec<Corners> = faces.into_iter().map(|face| face.map(|corner| corner + shift)).collect();
    let (mut camera, mut beams) = rig::default_rig(1, shift, 0.0);
    camera.sensor = Camera { max_range: 20.0, ..rig::camera(320, 240, 28.8e-6, 8e-3) };
    for (beam, thickness) in beams.iter_mut().zip([0.01, 1.0]) {
        (beam.sensor.columns, beam.sensor.rows, beam.sensor.thickness) = (100, 2, thickness);
        let raised = Pose::from_axis_angle(DVec3::X, draws.between(0.0, 0.6));
        beam.scene_from_sensor = beam.scene_from_sensor * raised;
    }
    scene_of(&moved, camera, beams)
}

fn looking(position: DVec3, along: DVec3) -> Pose {
    Pose { position, rotation: DQuat::from_rotation_arc(DVec3::Z, along) }
}

fn rounded(face: Corners) -> Corners {
    face.map(|corner| corner.as_vec3().as_dvec3())
}

/// A needle of up to 10 m.
fn needle(draws: &mut Draws) -> Corners {
    let (at, along) = (draws.vector(3.0), draws.direction() * draws.between(1.0, 10.0));
    let thick = draws.direction() * draws.spread(1e-4, 0.4);
    rounded([at, at + along, at + along * draws.between(-0.2, 1.2) + thick])
}

/// The pixel, and the pencil, that are aimed.
pub(crate) const PIXEL: Place = Place { sensor: SensorId::Camera, i: 4, j: 4 };
pub(crate) const PENCIL: Place = Place { sensor: SensorId::Beam(0), i: 4, j: 0 };

/// A pixel that looks at a place up to 400 roundings of its range beside an edge of a needle (face 0), at any angle; behind it a
/// wall (face 1). The cells are so wide, 1e-2 or 1e-6 as an angle, that arithmetic alone sets the
/// tolerance: it is more than 1e-9 of a cell and less than one.
pub(crate) fn beside_a_needle(unit_roundoff: f64, draws: &mut Draws) -> Scene {
    let face = needle(draws);
    let [a, b, c] = face;
    let normal = (b - a).cross(c - a).normalize();
    let cosine = draws.spread(2.5e-3, 1.0);
    let forward = (draws.across(normal) * (1.0 - cosine * cosine).sqrt() - normal * cosine).normalize();
    let (k, share, range) = (draws.corner(), draws.between(0.0, 1.0), draws.between(1.0, 10.0));
    let beside = draws.across(forward) * range * unit_roundoff * draws.spread(0.1, 400.0);
    let at = face[k].lerp(face[(k + 1) % 3], share);
    let pitch = if unit_roundoff > 1e-10 { 1e-4 } else { 1e-8 };
    let (x, y) = forward.any_orthonormal_pair();
    let far = at + 2.0 * forward;
    let wall = [far - 9.0 * (x + y), far + 9.0 * (2.0 * y - x), far + 9.0 * (2.0 * x - y)];
    let camera = Camera { max_range: 100.0, ..rig::camera(9, 9, pitch, 1e-2) };
    let mounted =
        Mounted { scene_from_sensor: looking(at + beside - range * forward, forward), sensor: camera };
    scene_of(&[face, wall], mounted, Vec::new())
}

/// A pencil that meets a face (0) at any angle, and a needle (1) whose edge the way to the camera passes as closely.
pub(crate) fn beside_an_occluder(unit_roundoff: f64, draws: &mut Draws) -> Scene {
    let (normal, at) = (draws.direction(), draws.vector(3.0));
    let cosine = draws.spread(7e-3, 1.0);
    let forward = (draws.across(normal) * (1.0 - cosine * cosine).sqrt() - normal * cosine).normalize();
    let position = at - forward * draws.between(1.0, 10.0);
    let across = draws.across(normal);
    let (long, thick) = (draws.between(1.0, 5.0) * across, draws.spread(7e-3, 3.0) * normal.cross(across));
    let ground = rounded([at - long - thick, at + long - thick, at + 2.0 * thick]);
    let plane = (ground[1] - ground[0]).cross(ground[2] - ground[0]);
    let point = position + forward * (plane.dot(ground[0] - position) / plane.dot(forward));
    let to_camera = (normal * draws.spread(7e-3, 1.0) + draws.across(normal)).normalize();
    // The needle crosses the way between the point and the camera.
    let (share, reach) = (draws.between(0.02, 0.9), draws.between(1.0, 10.0));
    let (crossed, along) = (point + to_camera * reach * share, draws.direction() * draws.between(0.3, 5.0));
    let from = crossed - along * draws.between(0.1, 0.9);
    let third = from + along * draws.between(0.0, 1.0) + draws.direction() * draws.spread(1e-4, 1.0);
    let occluder = rounded([from, from + along, third]);
    let k = draws.corner();
    let edge = occluder[k].lerp(occluder[(k + 1) % 3], draws.between(0.1, 0.9));
    let way = (edge - point).normalize();
    let beside = draws.across(way) * 10.0 * unit_roundoff * draws.spread(0.1, 1000.0);
    let centre = point + way * (edge.distance(point) / share) + beside;
    let camera = Camera { max_range: 100.0, ..rig::camera(9, 9, 1e-3, 1e-2) };
    let beam =
        Mounted { scene_from_sensor: looking(position, forward), sensor: rig::beam(9, 1, [1e-2; 2], 0.1) };
    let camera = Mounted { scene_from_sensor: looking(centre, -way), sensor: camera };
    scene_of(&[ground, occluder], camera, vec![beam])
}
