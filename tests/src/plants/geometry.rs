//! Small scenes on which faults of what a ray meets show.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil::terrain::{RandomGround, builtin};
use raypencil::{Beam, Camera, Lens, Mesh, Mounted, Pose, Profile, Scene};

use crate::{mesh, scene};

/// A small rig like the default one, at `position` and heading (radians), with quaternions `length` long.
pub fn rig(mesh: Arc<Mesh>, position: DVec3, heading: f64, length: f64) -> Scene {
    let pose = |height: f64, pitch_deg: f64| {
        let turned = Pose::from_axis_angle(DVec3::Z, heading)
            * Pose::from_axis_angle(DVec3::Y, pitch_deg.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR;
        let [x, y, z, w] = turned.rotation.to_array();
        let rotation = DQuat::from_xyzw(length * x, length * y, length * z, length * w);
        Pose { position: position + DVec3::new(0.3, 0.0, height), rotation }
    };
    let camera = Camera {
        width: 64,
        height: 48,
        pixel_pitch: [144e-6, 180e-6],
        focal_length: 8e-3,
        principal_point: [31.3, 24.8],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 96,
        rows: 4,
        thickness: 5e-3,
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let camera = Mounted { scene_from_sensor: pose(1.5, 20.0), sensor: camera };
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, pitch_deg)| Mounted { scene_from_sensor: pose(height, pitch_deg), sensor: beam });
    scene(mesh, camera, beams.to_vec())
}

/// The built-in pyramids before a rig with quaternions of any length.
pub fn on_pyramids(length: f64) -> Scene {
    let ground = builtin("pyramids", 0.25).expect("a built-in name");
    rig(Arc::new(ground.into_mesh().expect("a mesh")), DVec3::ZERO, 0.0, length)
}

/// The built-in pyramids before the small rig.
pub fn pyramids() -> Scene {
    on_pyramids(1.0)
}

/// The built-in facets before the small rig, turned a little.
pub fn facets() -> Scene {
    let ground = builtin("facets", 0.25).expect("a built-in name");
    rig(Arc::new(ground.into_mesh().expect("a mesh")), DVec3::ZERO, 0.2, 1.0)
}

/// Hills whose middle is at (1e6, -1e6, 0) m; the rig stands at the scene's origin, which is there.
pub fn far_ground() -> Scene {
    let offset = DVec3::new(1e6, -1e6, 0.0);
    let ground = RandomGround { offset, ..RandomGround::plain(3, 200, 24.0) }.build();
    let mesh = ground.into_mesh().expect("a mesh");
    assert!((mesh.origin() - offset).length() < 2.0);
    rig(Arc::new(mesh), DVec3::ZERO, 0.0, 1.0)
}

/// A camera and a beam in one place, looking along the scene's z: `size` cells across and down, their rays
/// `slope` apart in x / z, SPP at `plane` metres, `max_range` metres. The beam's rows are `step` metres apart.
fn along_z(mesh: Arc<Mesh>, size: u32, plane: f64, slope: f64, step: f64, max_range: f64) -> Scene {
    let middle = 0.5 * f64::from(size);
    let camera = Camera {
        width: size,
        height: size,
        pixel_pitch: [slope * plane; 2],
        focal_length: plane,
        principal_point: [middle; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range,
    };
    let beam = Beam {
        columns: size,
        rows: size,
        thickness: f64::from(size) * step,
        grid_distance: plane,
        half_width: middle * slope * plane,
        max_range,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    scene(mesh, camera, vec![Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam }])
}

/// A square wall at depth `z` around the axis, of cells x cells squares of two faces, its front to the
/// sensors: vertices and faces.
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

/// A triangle at 1 m whose right edge is 2^-22 m short of x = 1/16 m.
fn plate(turned_away: bool) -> [[f32; 3]; 3] {
    const RIGHT: f32 = 1.0 / 16.0 - 1.0 / 4_194_304.0;
    let [a, b, c] = [[RIGHT, -0.125, 1.0], [RIGHT - 0.25, 0.0, 1.0], [RIGHT, 0.125, 1.0]];
    if turned_away { [a, c, b] } else { [a, b, c] }
}

/// A triangle that falls away from a corner 0.1 m before the sensor, behind the SPP, to 1.5 m. On the axis it
/// is 0.8 m away: y = -0.3 + 0.6 (z - 0.1) / 1.4 is 0 there.
fn ramp() -> [[f32; 3]; 3] {
    [[0.0, -0.3, 0.1], [-1.0, 0.3, 1.5], [1.0, 0.3, 1.5]]
}

/// A triangle around the axis at 1/4 m.
fn screen() -> [[f32; 3]; 3] {
    [[-0.3, -0.1, 0.25], [0.03, 0.3, 0.25], [0.27, -0.1, 0.25]]
}

/// A wall at 2 m with vertices 1/4 m apart; the 5 x 5 rays cross it at multiples of 1/8 m.
pub fn lattice() -> Scene {
    let (vertices, faces) = wall(2.0, 0.5, 4);
    along_z(mesh(vertices, faces), 5, 0.5, 1.0 / 16.0, 1.0 / 8.0, 100.0)
}

/// A wall at 1/4 m of squares of 1/128 m; the 15 x 15 rays cross it 1/128 m apart, within 7/128 m of its
/// middle, and its border is at 8/128 m.
pub fn fine_wall() -> Scene {
    let (vertices, faces) = wall(0.25, 1.0 / 16.0, 16);
    along_z(mesh(vertices, faces), 15, 1.0 / 128.0, 1.0 / 32.0, 1.0 / 128.0, 100.0)
}

/// A wall at 2 m before sensors that see 2.1 m far, 24 degrees to either side: tan = 7/16.
pub fn range_cut_wall() -> Scene {
    let (vertices, faces) = wall(2.0, 4.0, 1);
    along_z(mesh(vertices, faces), 15, 0.5, 1.0 / 16.0, 1.0 / 8.0, 2.1)
}

/// A roof whose ridge is the line x = 0 at 2 m, its slopes falling back on either side; the middle column of 5 x 5 rays
/// meets it.
pub fn ridge() -> Scene {
    let across = [(-1.0, 3.0), (0.0, 2.0), (1.0, 3.0)];
    let vertices = across.iter().flat_map(|&(x, z)| [[x, -1.0, z], [x, 1.0, z]]).collect();
    let faces = vec![[0, 1, 3], [0, 3, 2], [2, 3, 5], [2, 5, 4]];
    along_z(mesh(vertices, faces), 5, 0.5, 1.0 / 16.0, 1.0 / 8.0, 100.0)
}

/// A plate that shows the rays its back.
pub fn plate_turned_away() -> Scene {
    before_wall(plate(true))
}

/// A plate whose edge a column of rays passes by very little.
pub fn plate_beside_rays() -> Scene {
    before_wall(plate(false))
}

/// A ramp that begins behind the SPP.
pub fn ramp_through_spp() -> Scene {
    before_wall(ramp())
}

/// A screen between the sensors and their SPP.
pub fn screen_before_spp() -> Scene {
    before_wall(screen())
}
