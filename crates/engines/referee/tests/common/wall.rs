/// A wall at z = 2 m whose front faces the origin and whose right side is at x = 1/8 m.
///
/// The camera is at the origin and looks along z: 9 x 9 pixels of 1/8 of the focal length, so that a pixel is 1/4 m
/// wide on the wall, and pixel (4, 4) looks exactly along z. The beam has one pencil. It starts at (-1, 0, 0), runs
/// along z, and hits the wall at (-1, 0, 2); its cell is 1 m wide there.
pub fn wall_scene() -> raypencil_scene::Scene {
    use glam::DVec3;
    use raypencil_scene::*;

    let wall = vec![[0.125, -40.0, 2.0], [-90.0, 0.0, 2.0], [0.125, 40.0, 2.0]];
    let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    let mesh = Mesh::new(DVec3::ZERO, wall, vec![[0, 1, 2]], vec![0], vec![plaster]).unwrap();
    let camera = Camera {
        width: 9,
        height: 9,
        pixel_pitch: [0.0625; 2],
        focal_length: 0.5,
        principal_point: [4.5; 2],
        aperture: 1.0 / 512.0,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 1,
        rows: 1,
        thickness: 1.0 / 256.0,
        grid_distance: 0.5,
        half_width: 0.125,
        max_range: 20.0,
        power: 4.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let beam_pose = Pose::from_position(DVec3::new(-1.0, 0.0, 0.0));
    Scene::new(
        std::sync::Arc::new(mesh),
        Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera },
        vec![Mounted { scene_from_sensor: beam_pose, sensor: beam }],
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )
    .unwrap()
}
