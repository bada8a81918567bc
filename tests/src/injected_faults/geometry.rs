//! Small scenes that reveal faults of hits.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil::rig::{self, DEFAULT_BEAM_MOUNTS, DEFAULT_CAMERA_MOUNT, DefaultMount};
use raypencil::terrain::{RandomGround, builtin};
use raypencil::{Beam, Camera, Mesh, Mounted, Pose, Scene};

use crate::{mesh, scene};

/// The default rig with fewer and oblong pixels, at `position` in metres, turned to `heading` in radians, with
/// quaternions of `length`.
pub fn small_rig(mesh: Arc<Mesh>, position: DVec3, heading: f64, length: f64) -> Scene {
    let pose = |mount: DefaultMount| {
        let turned = Pose::from_axis_angle(DVec3::Z, heading)
            * Pose::from_axis_angle(DVec3::Y, mount.pitch_down_deg.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR;
        let [x, y, z, w] = turned.rotation.to_array();
        let rotation = DQuat::from_xyzw(length * x, length * y, length * z, length * w);
        Pose { position: position + mount.position, rotation }
    };
    let camera = Camera {
        width: 64,
        height: 48,
        pixel_pitch: [144e-6, 180e-6],
        principal_point: [31.3, 24.8],
        ..rig::default_camera()
    };
    let beam = Beam { columns: 96, rows: 4, ..rig::default_beam() };
    let camera = Mounted { scene_from_sensor: pose(DEFAULT_CAMERA_MOUNT), sensor: camera };
    let beams = DEFAULT_BEAM_MOUNTS.map(|mount| Mounted { scene_from_sensor: pose(mount), sensor: beam });
    scene(mesh, camera, beams.to_vec())
}

/// The built-in pyramids before the small rig with quaternions of `length`.
pub fn on_pyramids(length: f64) -> Scene {
    let ground = builtin("pyramids", 0.25).expect("a built-in name");
    small_rig(Arc::new(ground.into_mesh().expect("a mesh")), DVec3::ZERO, 0.0, length)
}

/// The built-in pyramids before the small rig.
pub fn pyramids() -> Scene {
    on_pyramids(1.0)
}

/// The built-in facets before the small rig, turned by 0.2 rad.
pub fn facets() -> Scene {
    let ground = builtin("facets", 0.25).expect("a built-in name");
    small_rig(Arc::new(ground.into_mesh().expect("a mesh")), DVec3::ZERO, 0.2, 1.0)
}

/// Hills around (1e6, -1e6, 0) m. The scene's origin is there, and the rig stands on it.
pub fn far_ground() -> Scene {
    let offset = DVec3::new(1e6, -1e6, 0.0);
    let ground = RandomGround { offset, ..RandomGround::plain(3, 200, 24.0) }.build();
    let mesh = ground.into_mesh().expect("a mesh");
    assert!((mesh.origin() - offset).length() < 2.0);
    small_rig(Arc::new(mesh), DVec3::ZERO, 0.0, 1.0)
}

/// A camera and a beam at the scene's origin, looking along z: `size` x `size` cells, rays `slope` apart in x / z, SPP
/// at `plane` metres, maximum range `max_range` metres. The beam's rows are `step` metres apart.
fn along_z(mesh: Arc<Mesh>, size: u32, plane: f64, slope: f64, step: f64, max_range: f64) -> Scene {
    let camera = Camera { max_range, ..rig::camera(size, size, slope * plane, plane) };
    let beam = Beam { max_range, ..rig::beam(size, size, [slope * plane, step], plane) };
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    scene(mesh, camera, vec![Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam }])
}

/// Vertices and faces of a square wall at depth `z` around the axis: cells x cells squares of two faces each, with
/// the front to the sensors.
fn wall(z: f32, half_side: f32, cells: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let at = |k: u32| 2.0 * half_side * k as f32 / cells as f32 - half_side;
    let vertices = (0..=cells).flat_map(|v| (0..=cells).map(move |u| [at(u), at(v), z])).collect();
    let squares = (0..cells).flat_map(|v| (0..cells).map(move |u| v * (cells + 1) + u));
    let faces = squares.flat_map(|a| {
        let (b, c, d) = (a + cells + 1, a + cells + 2, a + 1);
        [[a, b, c], [a, c, d]]
    });
    (vertices, faces.collect())
}

/// One face before a wall at 2 m. The 5 x 5 rays of each sensor cross z = 1 m at multiples of 1/16 m, from
/// -1/8 to 1/8 m (the beam's rows at multiples of 1/8 m); the SPP is at 1/2 m.
fn before_wall(face: [[f32; 3]; 3]) -> Scene {
    let (mut vertices, mut faces) = wall(2.0, 4.0, 1);
    let first = vertices.len() as u32;
    vertices.extend(face);
    faces.push([first, first + 1, first + 2]);
    along_z(mesh(vertices, faces), 5, 0.5, 1.0 / 16.0, 1.0 / 8.0, 100.0)
}

/// A triangle at 1 m. Its right edge is at x = 1/16 - 2^-22 m.
fn plate(turned_away: bool) -> [[f32; 3]; 3] {
    const RIGHT: f32 = 1.0 / 16.0 - 1.0 / 4_194_304.0;
    let [a, b, c] = [[RIGHT, -0.125, 1.0], [RIGHT - 0.25, 0.0, 1.0], [RIGHT, 0.125, 1.0]];
    if turned_away { [a, c, b] } else { [a, b, c] }
}

/// A triangle from a corner at z = 0.1 m, nearer than the SPP, to an edge at z = 1.5 m. It crosses the axis at
/// z = 0.8 m, where y = -0.3 + 0.6 (z - 0.1) / 1.4 is 0.
fn ramp() -> [[f32; 3]; 3] {
    [[0.0, -0.3, 0.1], [-1.0, 0.3, 1.5], [1.0, 0.3, 1.5]]
}

/// A triangle around the axis at 1/4 m.
fn screen() -> [[f32; 3]; 3] {
    [[-0.3, -0.1, 0.25], [0.03, 0.3, 0.25], [0.27, -0.1, 0.25]]
}

/// A wall at 2 m with vertices 1/4 m apart. The 5 x 5 rays cross it at multiples of 1/8 m.
pub fn lattice() -> Scene {
    let (vertices, faces) = wall(2.0, 0.5, 4);
    along_z(mesh(vertices, faces), 5, 0.5, 1.0 / 16.0, 1.0 / 8.0, 100.0)
}

/// A wall at 1/4 m of squares of 1/128 m. The 15 x 15 rays cross it 1/128 m apart, within 7/128 m of its middle. Its
/// border is at 8/128 m.
pub fn fine_wall() -> Scene {
    let (vertices, faces) = wall(0.25, 1.0 / 16.0, 16);
    along_z(mesh(vertices, faces), 15, 1.0 / 128.0, 1.0 / 32.0, 1.0 / 128.0, 100.0)
}

/// A wall at 2 m before sensors with a maximum range of 2.1 m. Their rays reach 24 degrees to either side: tan = 7/16.
pub fn range_cut_wall() -> Scene {
    let (vertices, faces) = wall(2.0, 4.0, 1);
    along_z(mesh(vertices, faces), 15, 0.5, 1.0 / 16.0, 1.0 / 8.0, 2.1)
}

/// A roof with its ridge on the line x = 0 at z = 2 m, and slopes that recede on either side. The middle column of 5 x
/// 5 rays meets the ridge.
pub fn ridge() -> Scene {
    let across = [(-1.0, 3.0), (0.0, 2.0), (1.0, 3.0)];
    let vertices = across.iter().flat_map(|&(x, z)| [[x, -1.0, z], [x, 1.0, z]]).collect();
    let faces = vec![[0, 1, 3], [0, 3, 2], [2, 3, 5], [2, 5, 4]];
    along_z(mesh(vertices, faces), 5, 0.5, 1.0 / 16.0, 1.0 / 8.0, 100.0)
}

/// A plate that shows its back to the rays.
pub fn plate_turned_away() -> Scene {
    before_wall(plate(true))
}

/// A plate with a column of rays 2^-22 m beside its edge.
pub fn plate_beside_rays() -> Scene {
    before_wall(plate(false))
}

/// A ramp that begins nearer than the SPP.
pub fn ramp_through_spp() -> Scene {
    before_wall(ramp())
}

/// A screen between the sensors and their SPP.
pub fn screen_before_spp() -> Scene {
    before_wall(screen())
}
