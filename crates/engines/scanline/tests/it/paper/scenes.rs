//! Scenes for these tests. A single sensor stands at the scene's origin along its axes: x right, y down,
//! z forward, so a face is written down in the sensor's own frame.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scanline::{Fidelity, Scanline, ScanlineOptions, Switches};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, RenderOutput,
    Renderer, Request, Scene, SensorMap,
};
use raypencil_terrain::{Ground, height_at};

pub(crate) type Face = [[f32; 3]; 3];

/// A camera of 128 x 128 pixels whose screen reaches from -1 to 1 in x/z and y/z. The ray of pixel (i, j) has
/// x/z = (i + 1/2 - 64) / 64.
pub(crate) fn square_camera(max_range: f64) -> Camera {
    Camera {
        width: 128,
        height: 128,
        pixel_pitch: [1.0 / 8192.0; 2],
        focal_length: 1.0 / 128.0,
        principal_point: [64.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range,
    }
}

/// A beam whose screen reaches from -1 to 1 in x/z. Pencil (i, j) runs at x/z = (2i + 1 - columns) / columns and
/// y = T (2j + 1 - rows) / (2 rows). Its grid is 1/8 m away.
pub(crate) fn square_beam(columns: u32, rows: u32, thickness: f64, max_range: f64) -> Beam {
    Beam {
        columns,
        rows,
        thickness,
        grid_distance: 0.125,
        half_width: 0.125,
        max_range,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    }
}

/// Faces as one mesh, each with its own three vertices.
fn mesh_of(faces: &[Face]) -> Arc<Mesh> {
    let vertices = faces.iter().flatten().copied().collect();
    let indices = (0..faces.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let mesh = Mesh::new(DVec3::ZERO, vertices, indices, vec![0; faces.len()], materials);
    Arc::new(mesh.expect("a valid mesh"))
}

pub(crate) fn seen_by_camera(faces: &[Face], camera: Camera) -> Scene {
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    Scene::new(mesh_of(faces), camera, Vec::new(), Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .expect("a valid scene")
}

pub(crate) fn seen_by_beam(faces: &[Face], beam: Beam) -> Scene {
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: square_camera(20.0) };
    let beam = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam };
    Scene::new(mesh_of(faces), camera, vec![beam], Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .expect("a valid scene")
}

/// `square_camera` at the scene's origin and beams at the given positions, all looking along z.
pub(crate) fn seen_by_both(faces: &[Face], beams: &[([f64; 3], Beam)], model: FluxModel) -> Scene {
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: square_camera(20.0) };
    let mounted = |&(position, sensor): &([f64; 3], Beam)| Mounted {
        scene_from_sensor: Pose::from_position(DVec3::from_array(position)),
        sensor,
    };
    let beams = beams.iter().map(mounted).collect();
    Scene::new(mesh_of(faces), camera, beams, Atmosphere { attenuation: 0.0 }, model).expect("a valid scene")
}

/// The default rig on a ground, with this thickness and maximum range, metres.
pub(crate) fn rig_on(ground: Ground, thickness: f64, max_range: f64) -> Scene {
    let mesh = Arc::new(ground.into_mesh().expect("a valid ground"));
    let z = height_at(&mesh, 0.0, 0.0).expect("ground under the vehicle");
    let scene_from_vehicle = Pose::from_position(DVec3::new(0.0, 0.0, z) - mesh.origin());
    let mount = |height: f64, pitch_down_deg: f64| {
        scene_from_vehicle
            * Pose::from_position(DVec3::new(0.3, 0.0, height))
            * Pose::from_axis_angle(DVec3::Y, pitch_down_deg.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR
    };
    let camera = Camera {
        width: 256,
        height: 256,
        pixel_pitch: [36e-6; 2],
        focal_length: 8e-3,
        principal_point: [128.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range,
    };
    let beam = Beam {
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60_f64.to_radians()),
        ..square_beam(512, 8, thickness, max_range)
    };
    let camera = Mounted { scene_from_sensor: mount(1.5, 20.0), sensor: camera };
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, down)| Mounted { scene_from_sensor: mount(height, down), sensor: beam });
    Scene::new(mesh, camera, beams.to_vec(), Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .expect("a valid scene")
}

/// The face, reversed if necessary, so that its front is seen from the origin.
pub(crate) fn towards_origin([a, b, c]: Face) -> Face {
    let p = |v: [f32; 3]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
    let n = (p(b) - p(a)).cross(p(c) - p(a));
    if n.dot(p(a)) < 0.0 { [a, b, c] } else { [a, c, b] }
}

pub(crate) const BEAM_EDGES: Switches = Switches { beam_edges: Fidelity::Paper, ..Switches::EXACT };
pub(crate) const SKIP_RULES: Switches = Switches { skip_rules: Fidelity::Paper, ..Switches::EXACT };
pub(crate) const FACING: Switches = Switches { facing: Fidelity::Paper, ..Switches::EXACT };
pub(crate) const EXTENT: Switches = Switches { extent: Fidelity::Paper, ..Switches::EXACT };
pub(crate) const PLACE: Switches = Switches { place: Fidelity::Paper, ..Switches::EXACT };

pub(crate) fn render(scene: &Scene, switches: Switches) -> RenderOutput {
    Scanline::new(ScanlineOptions { switches, ..ScanlineOptions::EXACT }).render(scene, &Request::EVERYTHING)
}

/// Renders without rules 3, and without 1a where it only saves time.
pub(crate) fn render_unskipped(scene: &Scene, switches: Switches) -> RenderOutput {
    Scanline::new(ScanlineOptions { switches, skip_unseen: false }).render(scene, &Request::EVERYTHING)
}

pub(crate) fn camera_map(scene: &Scene, switches: Switches) -> SensorMap {
    render(scene, switches).camera.expect("asked for")
}

pub(crate) fn beam_map(scene: &Scene, switches: Switches) -> SensorMap {
    render(scene, switches).beams.remove(0)
}

pub(crate) fn same_maps(a: &RenderOutput, b: &RenderOutput) -> bool {
    a.maps().eq(b.maps())
}

/// Whether the camera sees each pencil's point, beam by beam, row by row.
pub(crate) fn visible_pencils(scene: &Scene, switches: Switches) -> Vec<bool> {
    let frame = render(scene, switches);
    frame.returns.iter().flat_map(|of| of.visible.as_ref().expect("served").cells().to_vec()).collect()
}

/// The range of a cell, metres.
pub(crate) fn range(map: &SensorMap, i: u32, j: u32) -> Option<f64> {
    map.range.as_ref().expect("asked for").at(i, j).get()
}

/// The columns of row `j` that have a hit.
pub(crate) fn columns_hit(map: &SensorMap, j: u32) -> Vec<u32> {
    (0..map.width).filter(|&i| range(map, i, j).is_some()).collect()
}

/// The number of cells that have a hit.
pub(crate) fn hits(map: &SensorMap) -> usize {
    (0..map.height).map(|j| columns_hit(map, j).len()).sum()
}

/// The number of cells in which two maps have different faces.
pub(crate) fn differing(a: &SensorMap, b: &SensorMap) -> usize {
    let (a, b) = (a.face.as_ref().expect("asked for"), b.face.as_ref().expect("asked for"));
    a.cells().iter().zip(b.cells()).filter(|(a, b)| a != b).count()
}
