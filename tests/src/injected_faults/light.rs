//! Small scenes that reveal faults of light.

use std::sync::Arc;

use glam::DVec3;
use raypencil::rig::{self, DEFAULT_BEAM_MOUNTS, DEFAULT_CAMERA_MOUNT, DefaultMount};
use raypencil::terrain::builtin;
use raypencil::{
    Atmosphere, Beam, Camera, Filter, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Scene,
};

use crate::mesh;

/// The pyramids with two reflectivities, in thin dust, through a filter, lit by two beams of different power and
/// profile. The camera's maximum range is 3 m; the stripes are 2.5 and 5 m away.
pub fn lit(model: FluxModel) -> Scene {
    let ground = builtin("pyramids", 0.25).expect("a built-in name").into_mesh().expect("a mesh");
    let materials =
        [0.25, 0.75].map(|reflectivity| Material { name: "ground".into(), reflectivity }).to_vec();
    let kinds = (0..ground.faces().len()).map(|face| (face % 2) as u16).collect();
    let (vertices, faces) = (ground.vertices().to_vec(), ground.faces().to_vec());
    let mesh = Mesh::new(ground.origin(), vertices, faces, kinds, materials).expect("a mesh");
    let camera = Camera {
        principal_point: [47.3, 40.8],
        lens: Lens {
            transmission: 0.75,
            filter: Filter::Interference { centre: 815e-9, width: 20e-9, index: 2.0 },
        },
        max_range: 3.0,
        ..rig::camera(96, 80, 96e-6, 8e-3)
    };
    let beam = Beam { columns: 192, rows: 4, ..rig::default_beam() };
    let profile = Profile::Gaussian { half_width: 0.4 };
    let second = Beam { power: 3.0, profile, ..beam };
    let first = Beam { profile: Profile::UniformAngle, ..beam };
    let pose = |mount: DefaultMount| {
        rig::pitched(mount.position, mount.pitch_down_deg.to_radians(), ()).scene_from_sensor
    };
    let [lower, upper] = DEFAULT_BEAM_MOUNTS;
    Scene::new(
        Arc::new(mesh),
        Mounted { scene_from_sensor: pose(DEFAULT_CAMERA_MOUNT), sensor: camera },
        vec![
            Mounted { scene_from_sensor: pose(lower), sensor: first },
            Mounted { scene_from_sensor: pose(upper), sensor: second },
        ],
        Atmosphere { attenuation: 0.05 },
        model,
    )
    .expect("a scene")
}

/// A wall at 2 m, lit by a sheet in the plane y = 0 and seen by a camera 1 m above it. A plate `before` metres before
/// the wall, above the sheet, hides the whole stripe: the lines of sight pass its plane at y = -before / 2. The plate
/// shows the camera its front, or its back if it is `turned_away`.
pub fn screened(before: f32, turned_away: bool) -> Scene {
    let z = 2.0 - before;
    let (top, bottom) = (-0.75 * before, -0.25 * before);
    let vertices = vec![
        [-8.0, -8.0, 2.0],
        [-8.0, 8.0, 2.0],
        [8.0, 8.0, 2.0],
        [8.0, -8.0, 2.0],
        [-1.0, top, z],
        [-1.0, bottom, z],
        [1.0, bottom, z],
        [1.0, top, z],
    ];
    let plate = if turned_away { [[4, 6, 5], [4, 7, 6]] } else { [[4, 5, 6], [4, 6, 7]] };
    let mesh = mesh(vertices, [[[0, 1, 2], [0, 2, 3]], plate].concat());
    // A pixel is 1/32 of slope wide, so that slopes reach 1; the stripe is at the slope 1/2. The sheet is 0.09 mm
    // thick; the plate begins at least 0.12 mm above its middle.
    let camera = rig::camera(64, 64, 1.0 / 2048.0, 1.0 / 64.0);
    let beam = rig::beam(33, 3, [1.0 / 512.0, 1.0 / 32768.0], 0.125);
    let at = |y: f64| Pose::from_position(DVec3::new(0.0, y, 0.0));
    Scene::new(
        mesh,
        Mounted { scene_from_sensor: at(-1.0), sensor: camera },
        vec![Mounted { scene_from_sensor: at(0.0), sensor: beam }],
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )
    .expect("a scene")
}

/// The wall of [`screened`] without the plate, and a second copy of it with the front to the other side.
pub fn doubled() -> Scene {
    let scene = screened(0.25, false);
    let vertices = scene.mesh().vertices()[..4].to_vec();
    let mesh = mesh(vertices, vec![[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]]);
    let beams = scene.beams().to_vec();
    Scene::new(mesh, *scene.camera(), beams, scene.atmosphere(), scene.flux_model()).expect("a scene")
}
