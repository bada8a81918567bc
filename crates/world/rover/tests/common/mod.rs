//! Grounds, the default rig, and ideal stripes: rays against a few triangles.

#![allow(dead_code, reason = "no test needs all of it")]

use std::sync::Arc;

use glam::DVec3;
use raypencil_rover::{OnVehicle, Rig};
use raypencil_scene::{Beam, Camera, Lens, Material, Mesh, Pose, Profile};
use raypencil_terrain::Ground;

/// The default rig: camera 1.5 m up and 20 degrees down, beams 1.8 and 2.0 m up, 31 and 22 degrees down, each with
/// `columns` by `rows` pencils.
pub fn rig(columns: u32, rows: u32) -> Rig {
    let camera = Camera {
        width: 1024,
        height: 1024,
        pixel_pitch: [9e-6; 2],
        focal_length: 8e-3,
        principal_point: [512.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns,
        rows,
        thickness: 5e-3,
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let mount = |height, down: f64| Rig::mount(DVec3::new(0.3, 0.0, height), down.to_radians());
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, down)| OnVehicle { vehicle_from_sensor: mount(height, down), sensor: beam });
    Rig { camera: OnVehicle { vehicle_from_sensor: mount(1.5, 20.0), sensor: camera }, beams: beams.to_vec() }
}

/// Ground that is the same for every y from -20 to 20 m: a profile of points (x, z), extruded along y. x must not
/// decrease; two points with the same x make a wall.
pub fn extruded(profile: &[(f64, f64)]) -> Arc<Mesh> {
    let vertices = profile
        .iter()
        .flat_map(|&(x, z)| [DVec3::new(x, -20.0, z), DVec3::new(x, 20.0, z)])
        .collect::<Vec<_>>();
    let pieces = profile.len() as u32 - 1;
    // Vertices 2n and 2n + 1 are right and left of profile point n. Faces are counter-clockwise from above.
    let faces: Vec<[u32; 3]> =
        (0..pieces).map(|n| 2 * n).flat_map(|a| [[a, a + 2, a + 3], [a, a + 3, a + 1]]).collect();
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let face_materials = vec![0; faces.len()];
    Arc::new(Ground { vertices, faces, face_materials, materials }.into_mesh().expect("a ground"))
}

/// Corners of every face, in the scene frame.
pub fn corners(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    let corner = |v: u32| DVec3::from_array(mesh.vertices()[v as usize].map(f64::from));
    mesh.faces().iter().map(|face| face.map(corner)).collect()
}

/// Intersection of the ray `origin + t direction` with a triangle, from either side: t, and whether the ray meets the
/// front. (T. Möller and B. Trumbore, 1997)
pub fn intersect(origin: DVec3, direction: DVec3, [a, b, c]: &[DVec3; 3]) -> Option<(f64, bool)> {
    let (u, v) = (*b - *a, *c - *a);
    let across = direction.cross(v);
    let det = u.dot(across);
    if det == 0.0 {
        return None;
    }
    let from = origin - *a;
    let s = from.dot(across) / det;
    let turned = from.cross(u);
    let r = direction.dot(turned) / det;
    let inside = s >= 0.0 && r >= 0.0 && s + r <= 1.0;
    inside.then(|| (v.dot(turned) / det, u.cross(v).dot(direction) < 0.0))
}

/// First intersection of a ray with the faces. `None` if there is none, or if it is on the back of a face.
pub fn first_hit(faces: &[[DVec3; 3]], origin: DVec3, direction: DVec3) -> Option<DVec3> {
    let hits = faces.iter().filter_map(|face| intersect(origin, direction, face)).filter(|hit| hit.0 > 1e-9);
    let (t, front) = hits.min_by(|a, b| a.0.total_cmp(&b.0))?;
    front.then(|| origin + direction * t)
}

/// Image point (u, v) of a point; `None` if the camera does not see it. Point and faces are in the vehicle frame.
pub fn seen_at(rig: &Rig, faces: &[[DVec3; 3]], point: DVec3) -> Option<(f64, f64)> {
    let OnVehicle { vehicle_from_sensor, sensor } = rig.camera;
    let p = vehicle_from_sensor.inverse() * point;
    if p.z <= sensor.focal_length {
        return None;
    }
    let u = sensor.principal_point[0] + sensor.focal_length * p.x / p.z / sensor.pixel_pitch[0];
    let v = sensor.principal_point[1] + sensor.focal_length * p.y / p.z / sensor.pixel_pitch[1];
    if !(0.0..f64::from(sensor.width)).contains(&u) || !(0.0..f64::from(sensor.height)).contains(&v) {
        return None;
    }
    let from = vehicle_from_sensor.position;
    let first = first_hit(faces, from, point - from)?;
    ((first - point).length() < 1e-6).then_some((u, v))
}

/// Corners of every face, in the vehicle frame.
pub fn from_vehicle(mesh: &Mesh, global_from_vehicle: Pose) -> Vec<[DVec3; 3]> {
    let vehicle_from_global = global_from_vehicle.inverse();
    let origin = mesh.origin();
    corners(mesh).into_iter().map(|face| face.map(|corner| vehicle_from_global * (corner + origin))).collect()
}

/// Ideal stripe: points of a beam's lower edge plane on the ground that the camera sees, at most one per column of the
/// beam. Each is given in the vehicle frame, metres, and as an image point (u, v).
pub fn stripe(rig: &Rig, beam: usize, faces: &[[DVec3; 3]]) -> Vec<(DVec3, (f64, f64))> {
    let OnVehicle { vehicle_from_sensor, sensor } = rig.beams[beam];
    let origin = vehicle_from_sensor * DVec3::new(0.0, 0.5 * sensor.thickness, 0.0);
    let column = |i| {
        let direction = vehicle_from_sensor.rotate(sensor.direction(i));
        let point = first_hit(faces, origin, direction)?;
        Some((point, seen_at(rig, faces, point)?))
    };
    (0..sensor.columns).filter_map(column).collect()
}
