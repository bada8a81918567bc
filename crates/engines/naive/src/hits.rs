//! The first hit of a ray, by a test of every face, and its values.

use glam::DVec3;
use raypencil_scene::{FaceId, Hit};

use crate::fault::Fault;
use crate::injected::Injected;
use crate::quaternion::{conjugate, rotate};
use crate::rays::{PosedSensor, SceneRay};
use crate::slack::Slack;

/// Rounding error of a side function, relative to the product of the three lengths.
///
/// Each component of a x b is two products and a difference, 2 u (|a_x b_y| + |a_y b_x|) <= 2 u |a| |b|, so
/// the vector is off by at most 2 sqrt 3 u |a| |b|; the dot product with q adds 3 u |q| |a x b|. That makes
/// 6.5 u |q| |a| |b|, rounded up. The differences a and b are rounded too, but alike in every face: the rays meet
/// a mesh whose vertices are displaced by that rounding, and this mesh has no holes either.
const MAX_SIDE_ERROR: f64 = 8.0 * (f64::EPSILON / 2.0);

/// The faces that a sensor's rays are tested against. None needs to be clipped, because every hit must have t >= 1.
/// The fault replaces the faces that it loses by faces without area.
pub(crate) fn clipped(faults: Injected, faces: &[[DVec3; 3]], sensor: &PosedSensor<'_>) -> Vec<[DVec3; 3]> {
    if !faults.has(Fault::ClipCaseLost) {
        return faces.to_vec();
    }
    let axis = rotate(sensor.pose.rotation, DVec3::Z, false);
    let is_behind = |corner: &&DVec3| axis.dot(**corner - sensor.pose.position) < sensor.plane;
    let one_behind = |face: &[DVec3; 3]| face.iter().filter(is_behind).count() == 1;
    faces.iter().map(|face| if one_behind(face) { [face[0]; 3] } else { *face }).collect()
}

/// A sphere around a face. A ray that passes well beside it cannot meet the face, so that most faces need no test. It
/// decides nothing: its radius is enlarged by more than what rounding, or a fault, moves a face by.
#[derive(Debug, Clone, Copy)]
struct Sphere {
    centre: DVec3,
    squared_radius: f64,
}

impl Sphere {
    fn around([a, b, c]: &[DVec3; 3]) -> Self {
        let centre = (a + b + c) / 3.0;
        let farthest =
            [a, b, c].map(|corner| corner.distance_squared(centre)).into_iter().fold(0.0, f64::max);
        Self { centre, squared_radius: 1.01 * farthest }
    }

    /// A sphere around spheres.
    fn around_all(spheres: &[Self]) -> Self {
        let centre = spheres.iter().map(|sphere| sphere.centre).sum::<DVec3>() / spheres.len() as f64;
        let reach = |sphere: &Self| sphere.centre.distance(centre) + sphere.squared_radius.sqrt();
        let farthest = spheres.iter().map(reach).fold(0.0, f64::max);
        Self { centre, squared_radius: 1.01 * farthest * farthest }
    }

    fn may_meet(&self, ray: &SceneRay, squared_length: f64) -> bool {
        (self.centre - ray.origin).cross(ray.q).length_squared() <= self.squared_radius * squared_length
    }
}

/// Number of faces that follow each other in the mesh and have one sphere around them. Neighbours in the list are neighbours in
/// most meshes; where they are not, the sphere is large and saves nothing.
const GROUPED_FACES: usize = 16;

/// Spheres around the faces, and around groups of them.
pub(crate) struct Spheres {
    of_faces: Vec<Sphere>,
    of_groups: Vec<Sphere>,
}

impl Spheres {
    pub(crate) fn around(faces: &[[DVec3; 3]]) -> Self {
        let of_faces: Vec<Sphere> = faces.iter().map(Sphere::around).collect();
        let of_groups = of_faces.chunks(GROUPED_FACES).map(Sphere::around_all).collect();
        Self { of_faces, of_groups }
    }

    /// The faces that a ray may meet, in their order.
    pub(crate) fn near(&self, ray: &SceneRay) -> impl Iterator<Item = usize> {
        let squared_length = ray.q.length_squared();
        let groups = self.of_groups.iter().zip(self.of_faces.chunks(GROUPED_FACES)).enumerate();
        let near = groups.filter(move |(_, (group, _))| group.may_meet(ray, squared_length));
        near.flat_map(move |(number, (_, faces))| {
            let first = number * GROUPED_FACES;
            let near = faces.iter().enumerate().filter(move |(_, face)| face.may_meet(ray, squared_length));
            near.map(move |(within, _)| first + within)
        })
    }
}

/// Whether t counts: at or beyond the SPP, and R = t |q| within the maximum range.
fn is_within(faults: Injected, sensor: &PosedSensor<'_>, ray: &SceneRay, t: f64) -> bool {
    let from_plane = if faults.has(Fault::HitsBeforePlane) {
        t >= 0.0
    } else if faults.has(Fault::PlaneExcluded) {
        t > 1.0
    } else {
        t >= 1.0 - faults.size(Slack::PlaneEarlier) + faults.size(Slack::PlaneLater)
    };
    let metres = if faults.has(Fault::MaxRangeLimitsDepth) { sensor.plane } else { ray.q.length() };
    let in_range = if faults.has(Fault::MaxRangeIgnored) {
        true
    } else if faults.has(Fault::MaxRangeExcluded) {
        t * metres < sensor.max_range
    } else {
        let stretch = 1.0 + faults.size(Slack::RangeLonger) - faults.size(Slack::RangeShorter);
        t * metres <= sensor.max_range * stretch
    };
    from_plane && in_range
}

/// The nearest hit with t >= 1 and R = t |q| <= the maximum range. Among equals, the face of the lowest index.
pub(crate) fn first_hit(
    faults: Injected,
    faces: &[[DVec3; 3]],
    spheres: &Spheres,
    sensor: &PosedSensor<'_>,
    ray: &SceneRay,
) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    let farther = 1.0 + faults.size(Slack::FartherFace);
    let mut nearest = f64::INFINITY;
    for index in spheres.near(ray) {
        let Some(t) = meets(faults, &faces[index], ray) else { continue };
        if !is_within(faults, sensor, ray, t) {
            continue;
        }
        if let Some((_, of_best)) = best
            && faults.has(Fault::TiesCancel)
            && t == of_best
        {
            best = None;
            continue;
        }
        let is_better = match best {
            None => true,
            Some(_) if faults.has(Fault::FirstInOrderWins) => false,
            Some((_, of_best)) if faults.has(Fault::FarthestWins) => t > of_best,
            Some((_, of_best)) => t < of_best,
        };
        nearest = nearest.min(t);
        if is_better {
            best = Some((index, t));
        }
    }
    if farther > 1.0 {
        let all = spheres.near(ray).filter_map(|index| Some((index, meets(faults, &faces[index], ray)?)));
        let near = all.filter(|(_, t)| is_within(faults, sensor, ray, *t) && *t <= nearest * farther);
        return near.max_by(|a, b| a.1.total_cmp(&b.1));
    }
    best
}

/// The parameter t at which a ray meets the plane of a face.
pub(crate) fn plane_parameter([a, b, c]: &[DVec3; 3], ray: &SceneRay) -> f64 {
    let n = (b - a).cross(c - a);
    n.dot(a - ray.origin) / n.dot(ray.q)
}

/// The parameter t at which a ray meets the front of a closed triangle.
pub(crate) fn meets(faults: Injected, &[a, b, c]: &[DVec3; 3], ray: &SceneRay) -> Option<f64> {
    // The front faces the ray: n.q < 0.
    let n = (b - a).cross(c - a);
    let n_dot_q = n.dot(ray.q);
    if faults.has(Fault::ZeroAreaHit) && n == DVec3::ZERO {
        return meets_line([a, b, c], ray);
    }
    let faces_ray = if faults.has(Fault::BackFacesHit) {
        n_dot_q != 0.0
    } else if faults.has(Fault::WindingOfOneQuadrant) && ray.is_lower_right {
        n_dot_q > 0.0
    } else {
        let cosine = |size: f64| size * n.length() * ray.q.length();
        n_dot_q < 0.0 && -n_dot_q >= cosine(faults.size(Slack::GrazingLost))
            || n_dot_q > 0.0 && n_dot_q < cosine(faults.size(Slack::GrazingBacksMet))
    };
    if !faces_ray || (faults.has(Fault::SmallDeterminantsDropped) && n_dot_q.abs() < 1e-6) {
        return None;
    }

    // The ray passes on the inner side of each edge from p to p', or through it: q.(p' x p) >= 0 with corners
    // relative to its origin. For a back face the sign is reversed.
    let mut corners = [a - ray.origin, b - ray.origin, c - ray.origin];
    if faults.has(Fault::VerticesInSinglePrecision) {
        corners = corners.map(|corner| corner.as_vec3().as_dvec3());
    }
    let [a, b, c] = corners;
    if faults.has(Fault::EdgesComputedApart) {
        let (ab, ac) = (b - a, c - a);
        let p = ray.q.cross(ac);
        let determinant = ab.dot(p);
        let u = -a.dot(p) / determinant;
        let v = ray.q.dot((-a).cross(ab)) / determinant;
        return (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| n.dot(a) / n_dot_q);
    }
    let edges = if n_dot_q < 0.0 { [(a, b), (b, c), (c, a)] } else { [(b, a), (c, b), (a, c)] };
    let sides = edges.map(|(from, to)| ray.q.dot(to.cross(from)));
    let errors = edges.map(|(from, to)| MAX_SIDE_ERROR * ray.q.length() * from.length() * to.length());
    for (k, (side, error)) in sides.into_iter().zip(errors).enumerate() {
        let is_inside = if faults.has(Fault::EdgesExcluded) || faults.has(Fault::EdgesOpenOnOneSide) && k != 0
        {
            side > 0.0
        } else if faults.has(Fault::EdgesWidened) {
            side >= -1e-6 * (sides[0] + sides[1] + sides[2])
        } else {
            let moved = faults.size(Slack::EdgesNarrower) - faults.size(Slack::EdgesWider);
            side >= moved * (sides[0] + sides[1] + sides[2]) - error
        };
        if !is_inside {
            return None;
        }
    }
    let through_edge = |k: &usize| sides[*k].abs() <= errors[*k];
    if faults.has(Fault::VerticesExcluded) && [0, 1, 2].iter().filter(|k| through_edge(k)).count() >= 2 {
        return None;
    }

    // The plane of the face: n.(o + t q) = n.a.
    Some(n.dot(a) / n_dot_q)
}

/// The parameter t at which a ray meets a face without area, which is a line or a point. Only a fault asks for it.
fn meets_line(corners: [DVec3; 3], ray: &SceneRay) -> Option<f64> {
    let corners = corners.map(|corner| corner - ray.origin);
    // Each edge runs through the ray's line in turn; the first that crosses it decides.
    [(0, 1), (1, 2), (2, 0)].into_iter().find_map(|(from, to)| {
        let (p, edge) = (corners[from], corners[to] - corners[from]);
        let across = ray.q.cross(edge);
        let is_coplanar = p.dot(across).abs() <= MAX_SIDE_ERROR * p.length() * ray.q.length() * edge.length();
        let squared = across.length_squared();
        if !is_coplanar || squared == 0.0 {
            return None;
        }
        // o + t q = p + s e: both parameters by cross products with the other direction.
        let t = p.cross(edge).dot(across) / squared;
        let s = p.cross(ray.q).dot(across) / squared;
        (0.0..=1.0).contains(&s).then_some(t)
    })
}

/// Every quantity of a hit, each by its definition.
pub(crate) fn describe(
    faults: Injected,
    faces: &[[DVec3; 3]],
    sensor: &PosedSensor<'_>,
    ray: &SceneRay,
    index: usize,
    t: f64,
) -> Hit {
    let [a, b, c] = faces[index];
    let n = (b - a).cross(c - a);
    // Only a fault meets a face without area, which has no normal: it may show any.
    let n = if n == DVec3::ZERO { -ray.q } else { n };
    let rotation = sensor.pose.rotation;

    let true_range = t * ray.q.length() * (1.0 + faults.size(Slack::RangeScaled));
    let true_depth = t * sensor.plane * (1.0 + faults.size(Slack::DepthScaled));
    let range = if faults.has(Fault::DepthForRange) {
        true_depth
    } else if faults.has(Fault::TForRange) {
        t
    } else if faults.has(Fault::RangeFromPlane) {
        (t - 1.0) * ray.q.length()
    } else {
        true_range
    };
    let depth = if faults.has(Fault::RangeForDepth) { true_range } else { true_depth };
    let normal = if faults.has(Fault::NormalNotNormalised) {
        n
    } else if faults.has(Fault::NormalInSensorFrame) {
        rotate(conjugate(rotation), n / n.length(), false)
    } else if faults.has(Fault::NormalReversed) {
        -n / n.length()
    } else {
        let unit = n / n.length();
        let turn = faults.size(Slack::NormalTurned);
        if turn > 0.0 { (unit + turn * unit.any_orthonormal_vector()).normalize() } else { unit }
    };
    let point = ray.origin + ray.q * (t * (1.0 + faults.size(Slack::PointMoved)));
    let point = if faults.has(Fault::PointInSensorFrame) {
        rotate(conjugate(rotation), point - sensor.pose.position, false)
    } else {
        point
    };
    let towards =
        if faults.has(Fault::IncidenceAgainstAxis) { rotate(rotation, DVec3::Z, false) } else { ray.q };
    Hit {
        face: FaceId(index as u32),
        range,
        point,
        normal,
        depth,
        cos_incidence: -n.dot(towards) / (n.length() * towards.length())
            * (1.0 + faults.size(Slack::IncidenceScaled)),
    }
}
