//! First hits as another program states them.

use std::collections::BTreeSet;

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Side, Sides, Triangles};

use super::verdict::CastValue;
use crate::answers::{Answers, FirstHit, side_number};

/// First hits as another program states them: for each quantity that it gives, one value for each ray, in their order.
///
/// Whether a ray hits is said by `face` if it is given, else by `t`, else by `range`, else by `hit`: one of them must be. Where
/// it does not, both distances say why: -Inf says that what is hit is too near, +Inf that nothing is hit. `face` or `hit` alone says
/// neither, nor does NaN. The others have to say the same: where nothing is hit, no value is a number (of a normal and of weights
/// (0, 0, 0) is none either), and where something is hit, both distances are.
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
    /// How far storing may have moved these values.
    pub stored: StoredErrors,
}

/// How far storing may have moved each part of a value, for each ray and in the value's own unit: it widens the value's bound. `None`:
/// not at all.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StoredErrors {
    /// Of `t`.
    pub t: Option<Vec<f64>>,
    /// Of `range`.
    pub range: Option<Vec<f64>>,
    /// Of the parts of `point`.
    pub point: Option<Vec<f64>>,
    /// Of the parts of `normal`.
    pub normal: Option<Vec<f64>>,
    /// Of the parts of `barycentric`.
    pub barycentric: Option<Vec<f64>>,
    /// Of `cos_incidence`.
    pub cos_incidence: Option<Vec<f64>>,
    /// Of each value that is stored more coarsely than in single precision: how, in words. None of them is exact.
    pub coarse: Vec<(CastValue, String)>,
}

impl StoredErrors {
    /// How coarsely the values are stored, in words: `half precision`, `steps of 0.001 m`; `None` if all are finer.
    pub fn coarseness(&self) -> Option<String> {
        let words: BTreeSet<&str> = self.coarse.iter().map(|(_, words)| words.as_str()).collect();
        (!words.is_empty()).then(|| words.into_iter().collect::<Vec<_>>().join(" and "))
    }

    /// The error of a value of a ray; 0 if it is stored as it was computed.
    pub(crate) fn of(&self, value: CastValue, index: usize) -> f64 {
        let errors = match value {
            CastValue::T => &self.t,
            CastValue::Range => &self.range,
            CastValue::Point => &self.point,
            CastValue::Normal => &self.normal,
            CastValue::Barycentric => &self.barycentric,
            CastValue::CosIncidence => &self.cos_incidence,
            CastValue::Side => &None,
        };
        errors.as_ref().map_or(0.0, |errors| errors[index])
    }

    /// Adds to the error of a value of one of so many rays.
    pub(crate) fn widen(&mut self, value: CastValue, (index, count): (usize, usize), by: f64) {
        let errors = match value {
            CastValue::T => &mut self.t,
            CastValue::Range => &mut self.range,
            CastValue::Point => &mut self.point,
            CastValue::Normal => &mut self.normal,
            CastValue::Barycentric => &mut self.barycentric,
            CastValue::CosIncidence => &mut self.cos_incidence,
            CastValue::Side => return,
        };
        errors.get_or_insert_with(|| vec![0.0; count])[index] += by;
    }
}

impl Stated {
    /// The array that says whether a ray hits, and what it says.
    pub(crate) fn speaks(&self, index: usize) -> (&'static str, bool) {
        if let Some(faces) = &self.face {
            return ("face", faces[index].is_some());
        }
        if let Some(t) = &self.t {
            return ("t", t[index].is_finite());
        }
        match (&self.range, &self.hit) {
            (Some(range), _) => ("range", range[index].is_finite()),
            (None, Some(hit)) => ("hit", hit[index]),
            (None, None) => unreachable!("faces, distances or hits"),
        }
    }

    /// Whether a ray hits by its face, or without faces by what else is said of it; see [`hits_beside_face`](Self::hits_beside_face).
    pub(crate) fn hits_but(&self, index: usize, is_none: impl Fn(f64, f64) -> bool) -> bool {
        match &self.face {
            Some(faces) => faces[index].is_some(),
            None => self.hits_beside_face(index, is_none),
        }
    }

    /// Whether a ray hits by any array but that of faces: by its truth value, by a distance, or where no distance is given by its point.
    /// `is_none` says of a number, and of how far storing may have moved it, that it stands for no hit.
    pub(crate) fn hits_beside_face(&self, index: usize, is_none: impl Fn(f64, f64) -> bool) -> bool {
        if self.hit.as_ref().is_some_and(|hit| hit[index]) {
            return true;
        }
        let lengths = [(&self.t, CastValue::T), (&self.range, CastValue::Range)];
        let mut given = lengths.into_iter().filter_map(|(of, value)| Some((of.as_ref()?[index], value)));
        if self.t.is_some() || self.range.is_some() {
            return given
                .any(|(length, value)| length.is_finite() && !is_none(length, self.stored.of(value, index)));
        }
        self.point.as_ref().is_some_and(|points| {
            let (point, error) = (points[index], self.stored.of(CastValue::Point, index));
            point.is_finite() && !point.to_array().iter().all(|part| is_none(*part, error))
        })
    }

    /// Whether two rays have the same answer, bit by bit.
    pub(crate) fn is_same_answer(&self, ray: usize, other: usize) -> bool {
        let of_face = self.face.as_ref().is_none_or(|faces| faces[ray] == faces[other]);
        let of_hit = self.hit.as_ref().is_none_or(|hits| hits[ray] == hits[other]);
        let bits = |value: CastValue, ray: usize| Some(self.part(value, ray)?.map(f64::to_bits));
        of_face && of_hit && CastValue::ALL.into_iter().all(|value| bits(value, ray) == bits(value, other))
    }

    /// Makes distances +Inf that are not numbers, and of rays that do not hit otherwise those that stand for no hit.
    pub(crate) fn without_distances(&mut self, is_none: impl Fn(f64, f64) -> bool) {
        let count = [&self.t, &self.range].into_iter().flatten().map(Vec::len).next().unwrap_or(0);
        for index in 0..count {
            let is_hit = self.hits_but(index, &is_none);
            let errors = [CastValue::T, CastValue::Range].map(|value| self.stored.of(value, index));
            for (lengths, error) in [&mut self.t, &mut self.range].into_iter().zip(errors) {
                let Some(length) = lengths.as_mut().map(|lengths| &mut lengths[index]) else { continue };
                if length.is_nan() || !is_hit && is_none(*length, error) {
                    *length = f64::INFINITY;
                }
            }
        }
    }

    /// Takes the values of rays away that hit nothing by their own words, where `is_none` says of each part of a value, and of how far
    /// storing may have moved it, that it stands for none.
    pub(crate) fn without_values(&mut self, is_none: impl Fn(f64, f64) -> bool) {
        let count = [&self.t, &self.range].into_iter().flatten().map(Vec::len).next();
        let count = count.or(self.face.as_ref().map(Vec::len)).or(self.hit.as_ref().map(Vec::len));
        for index in 0..count.unwrap_or(0) {
            if self.speaks(index).1 {
                continue;
            }
            let error = |value| self.stored.of(value, index);
            let [of_point, of_normal, of_weights, of_cos] =
                [CastValue::Point, CastValue::Normal, CastValue::Barycentric, CastValue::CosIncidence]
                    .map(error);
            let of_vectors = [
                (&mut self.point, of_point),
                (&mut self.normal, of_normal),
                (&mut self.barycentric, of_weights),
            ];
            for (vectors, error) in of_vectors {
                let vector = vectors.as_mut().map(|vectors| &mut vectors[index]);
                if let Some(vector) = vector.filter(|v| v.to_array().iter().all(|part| is_none(*part, error)))
                {
                    *vector = DVec3::NAN;
                }
            }
            if let Some(cos) = self.cos_incidence.as_mut().map(|cosines| &mut cosines[index])
                && is_none(*cos, of_cos)
            {
                *cos = f64::NAN;
            }
            if let Some(side) = self.side.as_mut().map(|sides| &mut sides[index])
                && side.is_some_and(|side| is_none(f64::from(side_number(side)), 0.0))
            {
                *side = None;
            }
        }
    }

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
            stored: StoredErrors::default(),
        }
    }

    /// The answers to the rays with these indices.
    pub fn some_of(&self, indices: &[usize]) -> Self {
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
            stored: StoredErrors {
                t: some(&self.stored.t, indices),
                range: some(&self.stored.range, indices),
                point: some(&self.stored.point, indices),
                normal: some(&self.stored.normal, indices),
                barycentric: some(&self.stored.barycentric, indices),
                cos_incidence: some(&self.stored.cos_incidence, indices),
                coarse: self.stored.coarse.clone(),
            },
        }
    }
}
