//! Narrow sensors aimed at what is hard: vertices, edges, silhouettes, faces seen at a grazing angle.
//!
//! Each is a beam of a few rows and columns whose middle ray goes through the target, to the rounding of its pose,
//! and whose other rays pass it at distances from a part of a micrometre on. A scene holds up to 64 beams, so that
//! one tree serves them all.

use glam::{DQuat, DVec3};
use std::f64::consts::TAU;
use std::sync::Arc;

use crate::cases::at_origin;
use crate::cases::lattice::hash;
use raypencil_scene::{Atmosphere, Beam, FluxModel, Mesh, Mounted, Pose, Scene, rig};

/// What a sensor is aimed at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// A corner of a face.
    Vertex,
    /// A point of a side of a face.
    Edge,
    /// A point of a side of a face that the sensor sees edge on: it stands in the face's plane, or all but.
    Silhouette,
    /// A point inside a face, from so near its plane that it is grazed.
    Grazing,
}

const TARGETS: [Target; 4] = [Target::Vertex, Target::Edge, Target::Silhouette, Target::Grazing];

/// The most beams of a scene.
pub const MOST: usize = 64;

/// Numbers of one scene, in order.
struct Draws {
    seed: u64,
    next: u64,
}

impl Draws {
    fn bits(&mut self) -> u64 {
        self.next += 1;
        hash(self.seed, self.next)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// From 0 to 1.
    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// 10^x for x between the two.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, low + (high - low) * self.unit())
    }

    fn direction(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = libm::sincos(TAU * self.unit());
        let level = (1.0 - z * z).sqrt();
        DVec3::new(level * cos, level * sin, z)
    }
}

/// A scene of `count` aimed beams of 17 columns and 3 rows before `mesh`, at most [`MOST`]; fewer if faces without
/// area are drawn too often, and none before a mesh without faces.
pub fn scene(mesh: &Arc<Mesh>, seed: u64, count: usize) -> Scene {
    let mut draws = Draws { seed, next: 0 };
    let tries = 4 * count.min(MOST);
    let faces = mesh.faces().len();
    let beams: Vec<Mounted<Beam>> = (0..if faces == 0 { 0 } else { tries })
        .filter_map(|k| {
            let target = TARGETS[k % TARGETS.len()];
            let face = draws.below(faces);
            aimed(mesh, face, target, &mut draws)
        })
        .take(count.min(MOST))
        .collect();
    // A camera there must be; it looks away from everything.
    let camera = at_origin(rig::camera(1, 1, 1e-5, 1e-2));
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(Arc::clone(mesh), camera, beams, air, FluxModel::Radiometric).expect("a scene of narrow beams")
}

/// A beam aimed at a target of a face; `None` if the face has no area to speak of.
pub(crate) fn aimed(mesh: &Mesh, face: usize, target: Target, draws: &mut Draws) -> Option<Mounted<Beam>> {
    let corners = mesh.faces()[face].map(|v| {
        let [x, y, z] = mesh.vertices()[v as usize];
        DVec3::new(f64::from(x), f64::from(y), f64::from(z))
    });
    let first = draws.below(3);
    let [a, b, c] = [0, 1, 2].map(|k: usize| corners[(first + k) % 3]);
    let (along, normal) = (b - a, (b - a).cross(c - a));
    let (length, area) = (along.length(), normal.length());
    if !(length > 1e-6 && area > 1e-9) {
        return None;
    }
    let normal = normal / area;
    let (s, t) = (draws.unit(), draws.unit());
    let inside = a + (b - a) * (s * (1.0 - t)) + (c - a) * t;
    let point = match target {
        Target::Vertex => a,
        Target::Edge | Target::Silhouette => a + along * s,
        Target::Grazing => inside,
    };
    // From where it is seen.
    let distance = draws.decades(-1.5, 1.2);
    let in_plane = along.cross(normal) / length;
    let from = match target {
        Target::Vertex | Target::Edge => {
            let direction = draws.direction();
            if direction.dot(normal) < 0.0 { -direction } else { direction }
        }
        // Across the side, in the plane of the face but for a hair on either side.
        Target::Silhouette => in_plane + normal * (draws.decades(-12.0, -3.0) * sign(draws)),
        // Any way along the plane, a hair above it.
        Target::Grazing => {
            let (sin, cos) = libm::sincos(TAU * draws.unit());
            (along / length) * cos + in_plane * sin + normal * draws.decades(-9.0, -2.0)
        }
    }
    .normalize();
    let scene_from_sensor =
        Pose { position: point + from * distance, rotation: looking(-from, draws.unit()) };
    // Half the fan and half the sheet, as seen at the target: from 10 nm to a tenth of the distance.
    let spread = draws.decades(-8.0, -1.0);
    let grid_distance = 0.02;
    let beam = Beam {
        half_width: (grid_distance * spread).max(2e-6 * grid_distance),
        thickness: (2.0 * distance * spread).clamp(1e-6, 1.0),
        max_range: 100.0,
        ..rig::beam(17, 3, [1.0, 1.0], grid_distance)
    };
    Some(Mounted { scene_from_sensor, sensor: beam })
}

fn sign(draws: &mut Draws) -> f64 {
    if draws.bits() & 1 == 0 { 1.0 } else { -1.0 }
}

/// A rotation that turns z to `direction`, rolled by a part of a turn.
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
    use super::*;
    use raypencil_referee::Referee;
    use raypencil_scene::SensorId;
    use raypencil_terrain::RandomGround;

    #[test]
    fn aimed_rays_are_hard() {
        let mesh = Arc::new(RandomGround::nasty(3, 800).build().into_mesh().expect("a ground"));
        let scene = scene(&mesh, 5, MOST);
        assert_eq!(scene.beams().len(), MOST);
        let referee = Referee::new(&scene);
        // Of the middle rays most see the target or what hides it, and many of those change within a cell.
        let margins: Vec<_> = (0..MOST).filter_map(|k| referee.margins(SensorId::Beam(k), 8, 1)).collect();
        let hits = margins.iter().filter(|margins| margins.verdict.is_hit()).count();
        assert!(hits > MOST / 2, "{hits} of {MOST} hit");
        let close = margins.iter().filter(|margins| margins.face.lo < 1e-3).count();
        assert!(close > MOST / 4, "{close} of {MOST} are close to another answer");
    }
}
