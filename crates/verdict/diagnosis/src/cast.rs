//! Rays cast by other rules, with small code of its own: what a renderer with one of these mistakes would answer.

use glam::DVec3;
use raypencil_scene::{FaceId, Mesh, Place, Scene};

use crate::rules::{Longest, Rules, SensorRay, ray};

/// A ray that passes an edge by so little, relative to the lengths, meets it exactly: a few roundings of doubles.
const ON_EDGE: f64 = 1e-14;

/// A ray that passes an edge by less may be on either side of it for a program whose numbers are rounded otherwise.
const BESIDE_EDGE: f64 = 1e-11;

/// What a ray meets, by some rules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cast {
    pub(crate) hit: Option<CastHit>,
    /// Whether rounding may decide what it meets: it passes an edge by very little.
    pub(crate) is_on_edge: bool,
}

/// A hit by some rules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CastHit {
    pub(crate) face: FaceId,
    pub(crate) range: f64,
    pub(crate) depth: f64,
    pub(crate) point: DVec3,
}

/// The nearest hit of a cell's ray by some rules, found among all faces.
pub(crate) fn cast(scene: &Scene, place: Place, rules: Rules) -> Cast {
    let Some(SensorRay { origin, direction, axis }) = ray(scene, place, &rules.numbers) else {
        return Cast { hit: None, is_on_edge: false };
    };
    let mesh: &Mesh = scene.mesh();
    let corner = |index: u32| {
        let [x, y, z] = mesh.vertices()[index as usize].map(f64::from);
        DVec3::new(x, y, z) - origin
    };
    let length = direction.length();
    let longest = scene.max_range(place.sensor).unwrap_or(f64::INFINITY);
    let t_max = match rules.longest {
        Longest::Range => longest / length,
        Longest::Depth => longest / axis,
        Longest::Nothing => f64::INFINITY,
    };
    let mut nearest: Option<(f64, usize)> = None;
    let mut is_on_edge = false;
    for (face, [a, b, c]) in mesh.faces().iter().enumerate() {
        let [a, b, c] = [corner(*a), corner(*b), corner(*c)];
        let normal = (b - a).cross(c - a);
        let facing = normal.dot(direction);
        if facing == 0.0 || facing > 0.0 && !rules.hits_backs {
            continue;
        }
        // Inside, each edge and the ray have one orientation; closed, so that a zero belongs to the face.
        let sides =
            [[a, b], [b, c], [c, a]].map(|[from, to]| from.cross(to).dot(direction) * facing.signum());
        let least = sides[0].min(sides[1]).min(sides[2]);
        // Sides are volumes: the longest corner bounds them.
        let size = a.length().max(b.length()).max(c.length());
        let volume = size * size * length;
        if least < -BESIDE_EDGE * volume {
            continue;
        }
        let t = normal.dot(a) / facing;
        is_on_edge |= least <= BESIDE_EDGE * volume && t > 0.0 && t <= t_max;
        let is_inside = if rules.edges_open { least > ON_EDGE * volume } else { least >= 0.0 };
        let is_nearer = nearest.is_none_or(|(other, _)| t < other);
        if is_inside && t >= rules.least && t > 0.0 && t <= t_max && is_nearer {
            nearest = Some((t, face));
        }
    }
    let hit = nearest.map(|(t, face)| CastHit {
        face: FaceId(face as u32),
        range: t * length,
        depth: t * axis,
        point: origin + t * direction,
    });
    Cast { hit, is_on_edge }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use raypencil_scene::{Material, SensorId};

    use super::*;
    use crate::it::candidates::walls;
    use crate::rules::Numbers;

    #[test]
    fn a_ray_is_on_an_edge_within_a_part_of_the_volume() {
        let base = walls().scene;
        let corners = vec![[0.0, -10.0, 20.0], [0.0, 10.0, 20.0], [10.0, 0.0, 20.0]];
        let plaster = vec![Material { name: "plaster".into(), reflectivity: 0.5 }];
        let mesh = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], plaster).expect("a mesh");
        let scene = Scene::new(Arc::new(mesh), *base.camera(), vec![], base.atmosphere(), base.flux_model());
        let scene = scene.expect("a scene");
        // The ray at x/z = e/32 passes the edge x = 0 by a volume of 25 e, of which 500 m^2 times the ray's vector is the measure.
        let place = Place { sensor: SensorId::Camera, i: 32, j: 24 };
        let limit = BESIDE_EDGE * 500.0 * DVec3::new(0.0, 0.03125, 2.0).length() / 25.0;
        let found = |beside: f64| {
            let numbers = Numbers { offset: [-0.5 + beside * limit, 0.0], ..Numbers::SCENE };
            let cast = cast(&scene, place, Rules { numbers, ..Rules::CONTRACT });
            (cast.hit.is_some(), cast.is_on_edge)
        };
        assert_eq!([0.9, 1.1].map(found), [(true, true), (true, false)]);
        assert_eq!([-0.9, -1.1].map(found), [(false, true), (false, false)]);
    }
}
