//! First hits as another program states them.

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Side, Sides, Triangles};

use crate::answers::{Answers, FirstHit};

/// First hits as another program states them: for each quantity that it gives, one value for each ray, in their order.
///
/// Whether a ray hits is said by `face` if it is given, else by `t`, else by `range`, else by `hit`: at least one of them must be. Where
/// it does not, both distances say why: -Inf says that what is hit is too near, +Inf that nothing is hit. `face` or `hit` alone says
/// neither, nor does NaN. Other values of rays that do not hit have no meaning.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stated {
    /// The face; `None` where nothing is hit, or what is hit is too near.
    pub face: Option<Vec<Option<FaceId>>>,
    /// The ray's parameter; -Inf, +Inf or NaN where there is no face.
    pub t: Option<Vec<f64>>,
    /// Distance from the ray's origin; -Inf, +Inf or NaN where there is no face.
    pub range: Option<Vec<f64>>,
    /// Whether anything is hit that is not too near, of programs that say no more: tests of occlusion.
    pub hit: Option<Vec<bool>>,
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
    /// How far storing may have moved the point, in the mesh's unit: it widens the bounds of `t` and `point`. `None`: not at all.
    pub point_error: Option<Vec<f64>>,
    /// The same for `range`.
    pub range_error: Option<Vec<f64>>,
}

impl Stated {
    /// What the tracer answers, on all threads.
    pub fn by_tracer(mesh: &Triangles, rays: &[CastRay], sides: Sides) -> Self {
        Self::of(&Answers::by_tracer(mesh, rays, sides))
    }

    /// The first hits of answers.
    pub fn of(answers: &Answers) -> Self {
        let vector = |value: fn(&FirstHit) -> DVec3| Some(answers.values(value, DVec3::NAN));
        Self {
            face: Some(answers.values(|hit| Some(hit.face), None)),
            t: Some(answers.distances(|hit| hit.t)),
            range: Some(answers.distances(|hit| hit.range)),
            hit: None,
            side: Some(answers.values(|hit| Some(hit.side), None)),
            point: vector(|hit| hit.point),
            normal: vector(|hit| hit.normal),
            barycentric: vector(|hit| DVec3::from_array(hit.barycentric)),
            cos_incidence: Some(answers.values(|hit| hit.cos_incidence, f64::NAN)),
            point_error: None,
            range_error: None,
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
            hit: some(&self.hit, indices),
            side: some(&self.side, indices),
            point: some(&self.point, indices),
            normal: some(&self.normal, indices),
            barycentric: some(&self.barycentric, indices),
            cos_incidence: some(&self.cos_incidence, indices),
            point_error: some(&self.point_error, indices),
            range_error: some(&self.range_error, indices),
        }
    }
}
