//! First hits as another program states them.

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Side, Sides, Triangles};

use crate::answers::{Answers, FirstHit};

/// First hits as another program states them: for each quantity that it gives, one value for each ray, in their order.
///
/// Whether a ray hits is said by `face` if it is given, else by `t`, else by `range`: at least one of them must be.
/// Values of rays that hit nothing have no meaning.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stated {
    /// The face; `None` where nothing is hit.
    pub face: Option<Vec<Option<FaceId>>>,
    /// The ray's parameter; not finite where nothing is hit.
    pub t: Option<Vec<f64>>,
    /// Distance from the ray's origin; not finite where nothing is hit.
    pub range: Option<Vec<f64>>,
    /// The side that is met.
    pub side: Option<Vec<Option<Side>>>,
    /// The point.
    pub point: Option<Vec<DVec3>>,
    /// The unit normal to the face's front.
    pub normal: Option<Vec<DVec3>>,
    /// The weights of the face's corners.
    pub barycentric: Option<Vec<DVec3>>,
    /// Cosine of the angle between the normal and the reversed ray.
    pub cos_incidence: Option<Vec<f64>>,
}

impl Stated {
    /// What the tracer answers, on all threads.
    pub fn by_tracer(mesh: &Triangles, rays: &[CastRay], sides: Sides) -> Self {
        Self::of(&Answers::by_tracer(mesh, rays, sides))
    }

    /// The first hits of answers.
    pub fn of(answers: &Answers) -> Self {
        let hits = &answers.first;
        let number = |value: fn(&FirstHit) -> f64, miss: f64| {
            Some(hits.iter().map(|hit| hit.as_ref().map_or(miss, value)).collect())
        };
        let vector = |value: fn(&FirstHit) -> DVec3| {
            Some(hits.iter().map(|hit| hit.as_ref().map_or(DVec3::NAN, value)).collect())
        };
        Self {
            face: Some(hits.iter().map(|hit| hit.map(|hit| hit.face)).collect()),
            t: number(|hit| hit.t, f64::INFINITY),
            range: number(|hit| hit.range, f64::INFINITY),
            side: Some(hits.iter().map(|hit| hit.map(|hit| hit.side)).collect()),
            point: vector(|hit| hit.point),
            normal: vector(|hit| hit.normal),
            barycentric: vector(|hit| DVec3::from_array(hit.barycentric)),
            cos_incidence: number(|hit| hit.cos_incidence, f64::NAN),
        }
    }

    /// The answers to the rays with these indices.
    pub(crate) fn some_of(&self, indices: &[usize]) -> Self {
        fn some<T: Copy>(array: &Option<Vec<T>>, indices: &[usize]) -> Option<Vec<T>> {
            let array = array.as_ref()?;
            Some(indices.iter().map(|&index| array[index]).collect())
        }
        Self {
            face: some(&self.face, indices),
            t: some(&self.t, indices),
            range: some(&self.range, indices),
            side: some(&self.side, indices),
            point: some(&self.point, indices),
            normal: some(&self.normal, indices),
            barycentric: some(&self.barycentric, indices),
            cos_incidence: some(&self.cos_incidence, indices),
        }
    }
}
