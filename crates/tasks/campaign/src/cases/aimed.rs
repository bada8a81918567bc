//! Narrow beams aimed at hard targets: vertices, edges, silhouettes, faces seen at a grazing angle.
//!
//! Each beam has a few rows and columns. Its middle ray goes through the target, up to the rounding of its pose. Its
//! other rays pass the target at distances from less than a micrometre on. A scene holds up to 64 beams, so that one
//! tree serves them all.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scene::{Atmosphere, Beam, FluxModel, Mesh, Mounted, Pose, Scene, rig};

use crate::cases::at_origin;
use crate::cases::split_mix::SplitMix64;

/// Target of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// A corner of a face.
    Vertex,
    /// A point on a side of a face.
    Edge,
    /// A point on a side of a face. The beam stands in the face's plane, or almost.
    Silhouette,
    /// A point inside a face, seen from almost in the face's plane.
    Grazing,
}

const TARGETS: [Target; 4] = [Target::Vertex, Target::Edge, Target::Silhouette, Target::Grazing];

/// Maximum number of beams of a scene.
pub const MAX_BEAMS: usize = 64;

/// A scene of `count` beams of 17 columns and 3 rows aimed at `mesh`, at most [`MAX_BEAMS`]. There are fewer if faces
/// without area are chosen too often, and none if the mesh has no faces.
pub fn scene(mesh: &Arc<Mesh>, seed: u64, count: usize) -> Scene {
    let mut random = SplitMix64::new(seed);
    let tries = 4 * count.min(MAX_BEAMS);
    let faces = mesh.faces().len();
    let beams: Vec<Mounted<Beam>> = (0..if faces == 0 { 0 } else { tries })
        .filter_map(|k| {
            let target = TARGETS[k % TARGETS.len()];
            let face = random.below(faces);
            aimed_beam(mesh, face, target, &mut random)
        })
        .take(count.min(MAX_BEAMS))
        .collect();
    // Every scene has a camera; this one has a single pixel and is of no interest.
    let camera = at_origin(rig::camera(1, 1, 1e-5, 1e-2));
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(Arc::clone(mesh), camera, beams, air, FluxModel::Radiometric).expect("a scene of narrow beams")
}

/// A beam aimed at a target of a face. `None`: the face has almost no area.
fn aimed_beam(mesh: &Mesh, face: usize, target: Target, random: &mut SplitMix64) -> Option<Mounted<Beam>> {
    let corners = mesh.faces()[face].map(|v| {
        let [x, y, z] = mesh.vertices()[v as usize];
        DVec3::new(f64::from(x), f64::from(y), f64::from(z))
    });
    let first = random.below(3);
    let [a, b, c] = [0, 1, 2].map(|k: usize| corners[(first + k) % 3]);
    let (along, normal) = (b - a, (b - a).cross(c - a));
    let (length, area) = (along.length(), normal.length());
    if !(length > 1e-6 && area > 1e-9) {
        return None;
    }
    let normal = normal / area;
    let (s, t) = (random.unit(), random.unit());
    let inside = a + (b - a) * (s * (1.0 - t)) + (c - a) * t;
    let point = match target {
        Target::Vertex => a,
        Target::Edge | Target::Silhouette => a + along * s,
        Target::Grazing => inside,
    };
    // The beam's position.
    let distance = random.power_of_ten(-1.5, 1.2);
    let in_plane = along.cross(normal) / length;
    let from = match target {
        Target::Vertex | Target::Edge => {
            let direction = random.direction();
            if direction.dot(normal) < 0.0 { -direction } else { direction }
        }
        // Across the side, in the plane of the face, except for a tiny angle to either side.
        Target::Silhouette => in_plane + normal * (random.power_of_ten(-12.0, -3.0) * random.sign()),
        // In any direction along the plane, a tiny angle above it.
        Target::Grazing => {
            let (sin, cos) = libm::sincos(TAU * random.unit());
            (along / length) * cos + in_plane * sin + normal * random.power_of_ten(-9.0, -2.0)
        }
    }
    .normalize();
    let scene_from_sensor =
        Pose { position: point + from * distance, rotation: looking(-from, random.unit()) };
    // Half the fan and half the sheet at the target, as a fraction of the distance: 1e-8 to 0.1.
    let spread = random.power_of_ten(-8.0, -1.0);
    let grid_distance = 0.02;
    let beam = Beam {
        half_width: (grid_distance * spread).max(2e-6 * grid_distance),
        thickness: (2.0 * distance * spread).clamp(1e-6, 1.0),
        max_range: 100.0,
        ..rig::beam(17, 3, [1.0, 1.0], grid_distance)
    };
    Some(Mounted { scene_from_sensor, sensor: beam })
}

/// A rotation that turns z to `direction`, after a roll about z by the fraction `roll` of a turn.
fn looking(direction: DVec3, roll: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * TAU * roll);
    let rolled = DQuat::from_xyzw(0.0, 0.0, sin, cos);
    // The half-way quaternion between z and the direction, or half a turn if they are opposite.
    let half = DVec3::Z + direction;
    let turn = if half.length_squared() > 1e-6 {
        let cross = DVec3::Z.cross(direction);
        DQuat::from_xyzw(cross.x, cross.y, cross.z, 1.0 + DVec3::Z.dot(direction)).normalize()
    } else {
        DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0)
    };
    turn * rolled
}

#[cfg(test)]
mod tests {
    use raypencil_referee::Referee;
    use raypencil_scene::SensorId;
    use raypencil_terrain::RandomGround;

    use super::*;
    use crate::cases::mesh;

    #[test]
    fn a_face_without_area_is_no_target() {
        // Three corners on a line, and one corner that is there twice.
        for last in [[2.0, 4.0, 3.0], [1.0, 2.0, 3.0]] {
            let thin = mesh(vec![[0.0, 0.0, 3.0], [1.0, 2.0, 3.0], last], vec![[0, 1, 2]]);
            assert_eq!(scene(&thin, 5, MAX_BEAMS).beams().len(), 0);
        }
    }

    #[test]
    fn aimed_rays_are_close_to_other_answers() {
        let mesh = Arc::new(RandomGround::nasty(3, 800).build().into_mesh().expect("a ground"));
        let scene = scene(&mesh, 5, MAX_BEAMS);
        assert_eq!(scene.beams().len(), MAX_BEAMS);
        let referee = Referee::new(&scene);
        // Most middle rays hit the target or a face before it. Many of them have another answer within 1e-3 cells.
        let margins: Vec<_> =
            (0..MAX_BEAMS).filter_map(|k| referee.verdict_with_margins(SensorId::Beam(k), 8, 1)).collect();
        let hits = margins.iter().filter(|(verdict, _)| verdict.is_hit()).count();
        assert!(hits > MAX_BEAMS / 2, "{hits} of {MAX_BEAMS} hit");
        let close = margins.iter().filter(|(_, margins)| margins.face.lo < 1e-3).count();
        assert!(close > MAX_BEAMS / 4, "{close} of {MAX_BEAMS} are close to another answer");
    }
}
