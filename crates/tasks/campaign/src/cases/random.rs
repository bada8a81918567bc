//! Random rigs on random grounds, for proptest. The text that a failing test prints of a case suffices to build it
//! again.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use proptest::sample::Index;
use raypencil_scene::{
    Atmosphere, Beam, Camera, Filter, FluxModel, Lens, Mesh, Mounted, Pose, Profile, Scene, rig,
};
use raypencil_terrain::{MarsGround, PRESET_NAMES, RandomGround};

use crate::cases::mars::{mars_grounds, mars_grounds_of};

/// Factor by which the sensors of a campaign have more columns and more rows than those of property tests.
const CAMPAIGN_SIZE_FACTOR: u32 = 4;

/// A ground and the sensors in front of it.
#[derive(Debug, Clone)]
pub struct Case {
    /// The ground, with its seed.
    pub ground: AnyGround,
    /// The camera and its placement.
    pub camera: (Camera, SensorPlacement),
    /// The beams and their placements.
    pub beams: Vec<(Beam, SensorPlacement)>,
    /// Attenuation of the air, 1/m.
    pub attenuation: f64,
    /// Flux model.
    pub model: FluxModel,
}

/// A ground made from a seed.
#[derive(Debug, Clone)]
pub enum AnyGround {
    /// Hills, with or without everything that is hard to render.
    Random(RandomGround),
    /// A Mars-like ground.
    Mars(MarsGround),
}

impl AnyGround {
    fn offset(&self) -> DVec3 {
        match self {
            Self::Random(ground) => ground.offset,
            Self::Mars(ground) => ground.offset,
        }
    }

    fn mesh(&self) -> Mesh {
        let ground = match self {
            Self::Random(ground) => ground.build(),
            Self::Mars(ground) => ground.build().expect("numbers that were drawn in their ranges"),
        };
        ground.into_mesh().expect("a random ground is a mesh")
    }
}

/// Pose of a sensor relative to a vertex of the ground.
#[derive(Debug, Clone)]
pub struct SensorPlacement {
    /// The vertex.
    pub vertex: Index,
    /// Vector from the vertex to the sensor, metres.
    pub offset: DVec3,
    /// Rotation of the sensor in the scene.
    pub rotation: DQuat,
}

impl SensorPlacement {
    fn pose(&self, mesh: &Mesh) -> Pose {
        let vertex = mesh.vertices()[self.vertex.index(mesh.vertices().len())];
        let position = DVec3::from_array(vertex.map(f64::from)) + self.offset;
        Pose { position, rotation: self.rotation }
    }
}

impl Case {
    /// The ground as a mesh.
    ///
    /// # Panics
    /// If the ground is no valid mesh. Every strategy of this module gives a valid one.
    pub fn mesh(&self) -> Arc<Mesh> {
        Arc::new(self.ground.mesh())
    }

    /// The scene of these sensors and `mesh`. Their poses are relative to vertices of `placed_on`: the mesh of
    /// [`Case::mesh`], or one that begins with the same vertices.
    pub fn scene_of(&self, mesh: &Arc<Mesh>, placed_on: &Mesh) -> Scene {
        let (camera, place) = &self.camera;
        let camera = Mounted { scene_from_sensor: place.pose(placed_on), sensor: *camera };
        let beams = self
            .beams
            .iter()
            .map(|(beam, place)| Mounted { scene_from_sensor: place.pose(placed_on), sensor: *beam });
        let air = Atmosphere { attenuation: self.attenuation };
        Scene::new(Arc::clone(mesh), camera, beams.collect(), air, self.model).expect("a scene")
    }

    /// The scene of the case's own ground.
    pub fn scene(&self) -> Scene {
        let mesh = self.mesh();
        self.scene_of(&mesh, &mesh)
    }
}

/// 10^x with x from `low` to `high`.
fn powers_of_ten(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|exponent| libm::pow(10.0, exponent))
}

/// Unit vectors, uniform on the sphere.
fn unit_vector() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, 0.0..TAU).prop_map(|(z, angle): (f64, f64)| {
        let (sin, cos) = libm::sincos(angle);
        let level = (1.0 - z * z).sqrt();
        DVec3::new(level * cos, level * sin, z)
    })
}

/// Offsets of a ground: none, 1 km or 1000 km in any direction, metres.
fn offsets() -> impl Strategy<Value = DVec3> {
    (prop_oneof![Just(0.0), Just(1e3), Just(1e6)], unit_vector())
        .prop_map(|(distance, direction): (f64, DVec3)| direction * distance)
}

/// Grounds of 50 to 5000 faces at any offset. Half of them have everything that is hard to render.
pub fn grounds() -> impl Strategy<Value = RandomGround> {
    let ground = (any::<bool>(), any::<u64>(), powers_of_ten(1.7, 3.7), 2.0..60.0);
    (ground, offsets()).prop_map(|((nasty, seed, faces, extent), offset)| {
        let faces = faces as usize;
        let ground =
            if nasty { RandomGround::nasty(seed, faces) } else { RandomGround::plain(seed, faces, extent) };
        RandomGround { offset, ..ground }
    })
}

/// Placements 1 mm to 16 m away from a vertex, mostly above it. Three of five look forward and down as a rover does;
/// the others look anywhere.
fn placements() -> impl Strategy<Value = SensorPlacement> {
    let offset = (unit_vector(), powers_of_ten(-3.0, 1.2), prop::bool::weighted(0.7)).prop_map(
        |(mut direction, distance, above)| {
            if above {
                direction.z = direction.z.abs();
            }
            direction * distance
        },
    );
    let like_a_rover = (-PI..PI, -0.1..1.5, -0.5..0.5).prop_map(|(heading, pitch_down, roll)| {
        let turn = Pose::from_axis_angle(DVec3::Z, heading)
            * Pose::from_axis_angle(DVec3::Y, pitch_down)
            * Pose::from_axis_angle(DVec3::X, roll)
            * Pose::VEHICLE_FROM_FORWARD_SENSOR;
        turn.rotation
    });
    let anyhow = prop::array::uniform4(-1.0..1.0)
        .prop_filter("too short a quaternion", |q| q.iter().map(|x| x * x).sum::<f64>() > 0.01)
        .prop_map(DQuat::from_array);
    let rotation = prop_oneof![3 => like_a_rover, 2 => anyhow];
    (any::<Index>(), offset, rotation).prop_map(|(vertex, offset, rotation)| SensorPlacement {
        vertex,
        offset,
        rotation,
    })
}

/// Small cameras: fields of view of 2 to 150 degrees across, focal lengths of 1 mm to 0.5 m, pixels that are not
/// square, maximum ranges of 0.3 m to 1 km, the principal point in the image or up to a fifth of it outside.
fn cameras() -> impl Strategy<Value = Camera> {
    let size = prop_oneof![Just((96, 64)), Just((41, 97)), Just((7, 301)), Just((1, 1))];
    let principal_point = prop::array::uniform2(-0.2..1.2);
    (size, powers_of_ten(-3.0, -0.3), 2.0..150.0, 0.5..2.0, principal_point, powers_of_ten(-0.5, 3.0))
        .prop_map(|((width, height), focal_length, view_deg, aspect, centre, max_range)| {
            let view = focal_length * libm::tan(0.5 * f64::to_radians(view_deg));
            let pitch = (2.0 * view / f64::from(width.max(20))).clamp(1e-8, 0.04);
            Camera {
                pixel_pitch: [pitch, pitch * aspect],
                principal_point: [centre[0] * f64::from(width), centre[1] * f64::from(height)],
                max_range,
                ..rig::camera(width, height, pitch, focal_length)
            }
        })
}

/// Small beams: fans of 1 to 170 degrees, sheets of 0.1 mm to 1 m, grid distances of 1 mm to 1 m.
fn beams() -> impl Strategy<Value = Beam> {
    let size = prop_oneof![Just((128, 8)), Just((33, 29)), Just((257, 1)), Just((1, 3))];
    (size, powers_of_ten(-3.0, 0.0), 1.0..170.0, powers_of_ten(-4.0, 0.0), powers_of_ten(-0.5, 3.0)).prop_map(
        |((columns, rows), grid_distance, fan_deg, thickness, max_range)| Beam {
            thickness,
            max_range,
            half_width: Beam::half_width_of(grid_distance, f64::to_radians(fan_deg)),
            ..rig::beam(columns, rows, [1.0, 1.0], grid_distance)
        },
    )
}

/// Any ground in front of a camera and two beams.
pub fn cases() -> impl Strategy<Value = Case> {
    let beams = prop::collection::vec((beams(), placements()), 2);
    (grounds(), (cameras(), placements()), beams).prop_map(|(ground, camera, beams)| Case {
        ground: AnyGround::Random(ground),
        camera,
        beams,
        attenuation: 0.0,
        model: FluxModel::Radiometric,
    })
}

fn profiles() -> impl Strategy<Value = Profile> {
    prop_oneof![
        Just(Profile::Paper),
        Just(Profile::UniformAngle),
        powers_of_ten(-2.0, 0.5).prop_map(|half_width| Profile::Gaussian { half_width }),
    ]
}

/// Lenses with and without a filter.
fn lenses() -> impl Strategy<Value = Lens> {
    let filter = prop_oneof![
        Just(Filter::None),
        (790e-9..830e-9, powers_of_ten(-8.5, -6.0), 1.0..3.0)
            .prop_map(|(centre, width, index)| Filter::Interference { centre, width, index }),
    ];
    (0.0..=1.0, filter).prop_map(|(transmission, filter)| Lens { transmission, filter })
}

/// Cases whose beams the camera beside them may see: a rig like a rover's, up to 3 m across, on any ground, in any air,
/// with any profile, lens and flux model.
pub fn lit_cases() -> impl Strategy<Value = Case> {
    let beside = || {
        let turn = prop::array::uniform3(-0.3..0.3).prop_map(|[x, y, z]| {
            Pose::from_axis_angle(DVec3::X, x)
                * Pose::from_axis_angle(DVec3::Y, y)
                * Pose::from_axis_angle(DVec3::Z, z)
        });
        (beams(), profiles(), powers_of_ten(-2.0, 1.0), unit_vector(), powers_of_ten(-2.0, 0.5), turn)
    };
    let rig = (cameras(), lenses(), placements(), prop::collection::vec(beside(), 2));
    let air = prop_oneof![Just(0.0), powers_of_ten(-3.0, 0.0)];
    let model = prop_oneof![Just(FluxModel::Radiometric), Just(FluxModel::Eq1)];
    (grounds(), rig, air, model).prop_map(|(ground, (camera, lens, place, beams), attenuation, model)| {
        let pose = Pose { position: place.offset, rotation: place.rotation };
        let beams = beams.into_iter().map(|(beam, profile, power, direction, distance, turn)| {
            let beside = pose * Pose::from_position(direction * distance) * turn;
            let place =
                SensorPlacement { offset: beside.position, rotation: beside.rotation, ..place.clone() };
            (Beam { profile, power, ..beam }, place)
        });
        Case {
            ground: AnyGround::Random(ground),
            beams: beams.collect(),
            // The principal point in the middle, so that some stripes land on the image.
            camera: (Camera { lens, principal_point: centred(&camera), ..camera }, place),
            attenuation,
            model,
        }
    })
}

/// Mars-like grounds of up to some thousand faces, at any offset, in front of the sensors of a lit case.
pub fn mars_cases() -> impl Strategy<Value = Case> {
    (lit_cases(), mars_grounds(24), offsets()).prop_map(|(case, ground, offset)| Case {
        ground: AnyGround::Mars(MarsGround { offset, ..ground }),
        ..case
    })
}

/// Cases of a campaign's terrain: 2 to a million faces, and sensors of four times as many columns and rows as in
/// property tests, over the same fields of view. Every second terrain is Mars-like; the presets take turns.
pub fn campaign_cases(terrain: u64) -> BoxedStrategy<Case> {
    let cases = prop_oneof![2 => lit_cases(), 1 => cases()];
    if terrain.is_multiple_of(2) {
        let faces = powers_of_ten(0.301, 6.0).prop_map(|faces| faces as usize);
        return (cases, faces, any::<bool>())
            .prop_map(|(case, faces, nasty)| {
                let AnyGround::Random(RandomGround { seed, extent, offset, .. }) = case.ground else {
                    return finer(case);
                };
                // The hard parts alone have some hundred faces, so a smaller ground is plain.
                let ground = if nasty && faces >= 200 {
                    RandomGround::nasty(seed, faces)
                } else {
                    RandomGround::plain(seed, faces, extent)
                };
                finer(Case { ground: AnyGround::Random(RandomGround { offset, ..ground }), ..case })
            })
            .boxed();
    }
    let presets = PRESET_NAMES.len() as u64;
    let name = PRESET_NAMES[(terrain / 2 % presets) as usize];
    // Uniform in the logarithm: as many small grounds as large ones.
    let cells = powers_of_ten(0.602, 2.6).prop_map(|cells| cells as u32);
    let grounds = cells.prop_flat_map(move |cells| mars_grounds_of(name, cells));
    (cases, grounds)
        .prop_map(|(case, ground)| {
            let ground = MarsGround { offset: case.ground.offset(), ..ground };
            finer(Case { ground: AnyGround::Mars(ground), ..case })
        })
        .boxed()
}

/// A case with [`CAMPAIGN_SIZE_FACTOR`] times as many columns and rows.
fn finer(mut case: Case) -> Case {
    let camera = &mut case.camera.0;
    (camera.width, camera.height) =
        (CAMPAIGN_SIZE_FACTOR * camera.width, CAMPAIGN_SIZE_FACTOR * camera.height);
    camera.pixel_pitch = camera.pixel_pitch.map(|pitch| (pitch / f64::from(CAMPAIGN_SIZE_FACTOR)).max(1e-8));
    camera.principal_point = camera.principal_point.map(|centre| centre * f64::from(CAMPAIGN_SIZE_FACTOR));
    for (beam, _) in &mut case.beams {
        (beam.columns, beam.rows) = (CAMPAIGN_SIZE_FACTOR * beam.columns, CAMPAIGN_SIZE_FACTOR * beam.rows);
    }
    case
}

/// The middle of a camera's image, pixels.
fn centred(camera: &Camera) -> [f64; 2] {
    [0.5 * f64::from(camera.width), 0.5 * f64::from(camera.height)]
}
