//! Small scenes on which faults of light show.

use std::sync::Arc;

use glam::DVec3;
use raypencil::terrain::builtin;
use raypencil::{
    Atmosphere, Beam, Camera, Filter, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Scene,
};

use crate::{mesh, rig};

/// The pyramids, every other face of another reflectivity, in thin dust, through a filter; two beams of unlike power,
/// fan and profile. The camera sees no farther than 3 m by itself: the stripes are 2.5 and 5 m away.
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
        aperture: 2e-3,
        max_range: 3.0,
        ..rig::camera(96, 80, 96e-6, 8e-3)
    };
    let beam = Beam {
        thickness: 5e-3,
        half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
        max_range: 20.0,
        ..rig::beam(192, 4, [1.0, 1.0], 0.1)
    };
    let profile = Profile::Gaussian { half_width: 0.4 };
    let second = Beam { power: 3.0, profile, ..beam };
    let first = Beam { profile: Profile::UniformAngle, ..beam };
    let mount = |height: f64, pitch_deg: f64| {
        rig::pitched(DVec3::new(0.3, 0.0, height), pitch_deg.to_radians(), ()).scene_from_sensor
    };
    Scene::new(
        Arc::new(mesh),
        Mounted { scene_from_sensor: mount(1.5, 20.0), sensor: camera },
        vec![
            Mounted { scene_from_sensor: mount(1.8, 31.0), sensor: first },
            Mounted { scene_from_sensor: mount(2.0, 22.0), sensor: second },
        ],
        Atmosphere { attenuation: 0.05 },
        model,
    )
    .expect("a scene")
}

/// A wall at 2 m, lit by a sheet in the plane y = 0 and seen by a camera 1 m above it; and a plate `before` metres
/// before the wall, above the sheet, that hides all of the stripe from the camera: the ways from there pass its plane
/// at y = -before / 2. It shows the camera its front, or its back.
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
    // 1/32 of slope a pixel, so that slopes reach 1; the stripe is at -1/2. The sheet is 0.09 mm thick, the plate
    // begins 0.12 mm above its middle at least.
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

/// The wall of [`screened`] without a plate, and the same once more, its front the other way: a sheet of two faces.
pub fn doubled() -> Scene {
    let scene = screened(0.25, false);
    let vertices = scene.mesh().vertices()[..4].to_vec();
    let mesh = mesh(vertices, vec![[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]]);
    let beams = scene.beams().to_vec();
    Scene::new(mesh, *scene.camera(), beams, scene.atmosphere(), scene.flux_model()).expect("a scene")
}
