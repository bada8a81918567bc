//! Rays cast by wrong rules, with small code of its own: what a renderer with one of these mistakes would answer.

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh, Place, Ray, Scene, SensorId};

use crate::mistake::Mistake;

/// Rules of a cast that may differ from the contract's.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    hits_backs: bool,
    has_near_plane: bool,
    has_maximum_range: bool,
    /// From the middle of the cell, in cells.
    offset: [f64; 2],
}

/// A hit by some rules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CastHit {
    pub(crate) face: FaceId,
    pub(crate) range: f64,
    pub(crate) depth: f64,
    pub(crate) point: DVec3,
}

impl Rules {
    const CONTRACT: Self =
        Self { hits_backs: false, has_near_plane: true, has_maximum_range: true, offset: [0.0; 2] };

    /// The rules of a renderer with a mistake; `None` if the mistake is not one of rays.
    fn of(mistake: Mistake) -> Option<Self> {
        match mistake {
            Mistake::BacksHit => Some(Self { hits_backs: true, ..Self::CONTRACT }),
            Mistake::NearPlaneIgnored => Some(Self { has_near_plane: false, ..Self::CONTRACT }),
            Mistake::MaximumRangeIgnored => Some(Self { has_maximum_range: false, ..Self::CONTRACT }),
            Mistake::CornerRays { columns, rows } => Some(Self { offset: [columns, rows], ..Self::CONTRACT }),
            _ => None,
        }
    }
}

impl Rules {
    /// The rules of a renderer with both mistakes.
    fn and(self, other: Self) -> Self {
        Self {
            hits_backs: self.hits_backs || other.hits_backs,
            has_near_plane: self.has_near_plane && other.has_near_plane,
            has_maximum_range: self.has_maximum_range && other.has_maximum_range,
            offset: [0, 1].map(|k| self.offset[k] + other.offset[k]),
        }
    }
}

/// The mistakes of rays, two at a time, and their rules; a ray goes through one corner.
pub(crate) fn pairs_of_wrong_rules() -> Vec<([Mistake; 2], Rules)> {
    let all = wrong_rules();
    let is_corner = |mistake: &Mistake| matches!(mistake, Mistake::CornerRays { .. });
    let later = |k: usize| all[k + 1..].iter().map(move |other| (k, other));
    (0..all.len())
        .flat_map(later)
        .filter(|(k, (other, _))| !(is_corner(&all[*k].0) && is_corner(other)))
        .map(|(k, (other, rules))| ([all[k].0, *other], all[k].1.and(*rules)))
        .collect()
}

/// The mistakes of rays and their rules, the plainest first.
pub(crate) fn wrong_rules() -> Vec<(Mistake, Rules)> {
    let corner = |(columns, rows)| Mistake::CornerRays { columns, rows };
    let corners = [(-0.5, -0.5), (0.5, 0.5), (0.5, -0.5), (-0.5, 0.5)].map(corner);
    [Mistake::BacksHit, Mistake::NearPlaneIgnored, Mistake::MaximumRangeIgnored]
        .into_iter()
        .chain(corners)
        .filter_map(|mistake| Some((mistake, Rules::of(mistake)?)))
        .collect()
}

/// The ray through a point of a cell.
fn ray(scene: &Scene, place: Place, [dx, dy]: [f64; 2]) -> Option<Ray> {
    let Ray { origin, direction } = scene.ray(place.sensor, place.i, place.j)?;
    Some(match place.sensor {
        SensorId::Camera => {
            let camera = scene.camera();
            let [px, py] = camera.sensor.pixel_pitch;
            let moved = camera.scene_from_sensor.rotate(DVec3::new(dx * px, dy * py, 0.0));
            Ray { origin, direction: direction + moved }
        }
        SensorId::Beam(beam) => {
            let beam = &scene.beams()[beam];
            let across = 2.0 * beam.sensor.half_width / f64::from(beam.sensor.columns);
            let down = beam.sensor.thickness / f64::from(beam.sensor.rows);
            let pose = beam.scene_from_sensor;
            Ray {
                origin: origin + pose.rotate(DVec3::new(0.0, dy * down, 0.0)),
                direction: direction + pose.rotate(DVec3::new(dx * across, 0.0, 0.0)),
            }
        }
    })
}

/// The nearest hit of a cell's ray by some rules, found among all faces.
pub(crate) fn cast(scene: &Scene, place: Place, rules: Rules) -> Option<CastHit> {
    let Ray { origin, direction } = ray(scene, place, rules.offset)?;
    let mesh: &Mesh = scene.mesh();
    let corner = |index: u32| {
        let [x, y, z] = mesh.vertices()[index as usize].map(f64::from);
        DVec3::new(x, y, z) - origin
    };
    let length = direction.length();
    let t_min = if rules.has_near_plane { 1.0 } else { 0.0 };
    let longest = scene.max_range(place.sensor).filter(|_| rules.has_maximum_range);
    let t_max = longest.map_or(f64::INFINITY, |longest| longest / length);
    let mut nearest: Option<(f64, usize)> = None;
    for (face, [a, b, c]) in mesh.faces().iter().enumerate() {
        let [a, b, c] = [corner(*a), corner(*b), corner(*c)];
        let normal = (b - a).cross(c - a);
        let facing = normal.dot(direction);
        if facing == 0.0 || facing > 0.0 && !rules.hits_backs {
            continue;
        }
        // Inside, each edge and the ray have one orientation; closed, so that a zero belongs to the face.
        let edges = [a.cross(b), b.cross(c), c.cross(a)].map(|edge| edge.dot(direction));
        let is_inside = edges.iter().all(|edge| *edge * facing.signum() >= 0.0);
        let t = normal.dot(a) / facing;
        let is_nearer = nearest.is_none_or(|(other, _)| t < other);
        if is_inside && t >= t_min && t > 0.0 && t <= t_max && is_nearer {
            nearest = Some((t, face));
        }
    }
    let axis = match place.sensor {
        SensorId::Camera => scene.camera().sensor.focal_length,
        SensorId::Beam(beam) => scene.beams()[beam].sensor.grid_distance,
    };
    nearest.map(|(t, face)| CastHit {
        face: FaceId(face as u32),
        range: t * length,
        depth: t * axis,
        point: origin + t * direction,
    })
}
