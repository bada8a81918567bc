// The scene of the doc examples. They include this file, since doc tests share no other code.

/// A camera of 3 x 1 pixels and a beam of one pencil, both 10 m above a horizontal triangle, looking straight down.
pub fn scene_above(triangle: [[f32; 3]; 3]) -> raypencil_scene::Scene {
    use glam::{DQuat, DVec3};
    use raypencil_scene::{
        Atmosphere, Beam, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Scene,
    };
    let ground = Material { name: "ground".into(), reflectivity: 0.25 };
    let mesh = Mesh::new(DVec3::ZERO, triangle.to_vec(), vec![[0, 1, 2]], vec![0], vec![ground]);
    // Half a turn about x: z forward becomes z down.
    let down = Pose { position: DVec3::new(0.0, 0.0, 10.0), rotation: DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0) };
    let camera = Camera {
        width: 3,
        height: 1,
        pixel_pitch: [3.0 / 256.0; 2],
        focal_length: 1.0 / 64.0,
        principal_point: [1.5, 0.5],
        aperture: 0.002,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 1,
        rows: 1,
        thickness: 0.005,
        grid_distance: 0.125,
        half_width: 0.125,
        max_range: 20.0,
        power: 4.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    Scene::new(
        mesh.expect("a valid mesh").into(),
        Mounted { scene_from_sensor: down, sensor: camera },
        vec![Mounted { scene_from_sensor: down, sensor: beam }],
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )
    .expect("a valid scene")
}
