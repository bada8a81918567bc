//! Stated first hits against the exact ones.
//!
//! A stated hit is *the same* if its face is one of the nearest and these are not too near for the ray's sensor. 'Too near' and a
//! miss are the same if they are the exact answer. What is stated is *rounding* if the referee finds a ray, moved sideways
//! by no more than the program's arithmetic may, of which it is the answer; else it is *wrong*. Values are compared where
//! the face is the same, with bounds that follow from the same errors (u: the unit roundoff, S: the largest coordinate
//! seen from the ray, d: the ray's direction, kappa and c as in the referee's ruling):
//!
//! | value | bound | because |
//! | --- | --- | --- |
//! | range | R = 72 kappa u S / c | n.a' / n.d |
//! | t | R / abs(d) | range = t abs(d) |
//! | point | R + 16 u S | o + t d |
//! | barycentric | 16 u S / (c h) | moved sideways by 16 u S, it moves in the plane by 1 / c as much; a weight changes by 1 / h for one, with h the least height of the triangle |
//! | normal | 16 kappa u (1 + S / e) | two edges, each within 2 u S if vertices are rounded; e: the shortest edge |
//! | cosine | that of the normal + 8 u | |
//!
//! Where a value was stored with fewer digits than it was computed with, the error of storing is added (`Stated::stored`). Of an array it
//! is half a unit in the last place of its type, of a vector that of its largest part. Of a point of a cloud it is the length of the vector
//! of half units, which no turn of axes changes, so it holds for t along the ray and for each part of the point in any frame.
//!
//! A value that is not a number is wrong, and so is a ray of which one array says that it hits something and another that it does not.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_referee::{CastMeeting, ExactCast, Rounded, Ruling, aspect};
use raypencil_scene::{CastRay, FaceId, Precision, Progress, Reading, Sides, Triangles};

use super::stated::Stated;
use super::verdict::{CastValue, Comparison, RayVerdict, ValueTally, Wrong};
use crate::answers::side_number;

/// Compares stated first hits with the exact ones, on all threads. `precision` is that of the arithmetic that they come from.
///
/// ```
/// use raypencil_cast::{Stated, compare};
/// use raypencil_scene::{FaceId, Precision, Sides, Silent, Triangles};
///
/// let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Triangles::new(square, vec![[0, 1, 2], [0, 2, 3]])?;
/// // On the diagonal both faces are right; beside it one is.
/// let rays = raypencil_cast::rays_from_bytes(b"0.5,0.5,1,0,0,-1\n0.75,0.5,1,0,0,-1", "here".as_ref())?.rays;
/// let second = Stated { face: Some(vec![Some(FaceId(1)); 2]), ..Stated::default() };
/// let counts = compare(&mesh, &rays, Sides::Both, &second, Precision::F64, &Silent).counts();
/// assert_eq!((counts.same, counts.ties, counts.rounding, counts.wrong), (1, 1, 0, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Panics
/// If `stated` says of no ray whether it hits, or has not one value for each ray.
pub fn compare(
    mesh: &Triangles,
    rays: &[CastRay],
    sides: Sides,
    stated: &Stated,
    precision: Precision,
    progress: &dyn Progress,
) -> Comparison {
    progress.stage(&format!("comparing {} rays", rays.len()));
    compare_with(&ExactCast::new(mesh), mesh, rays, sides, stated, precision)
}

/// [`compare`] with a tree of the mesh that is there already.
pub fn compare_with(
    exact: &ExactCast<'_>,
    mesh: &Triangles,
    rays: &[CastRay],
    sides: Sides,
    stated: &Stated,
    precision: Precision,
) -> Comparison {
    let judge = Judge { exact, mesh, sides, stated, precision };
    let judged: Vec<Judged> = rays.par_iter().enumerate().map(|(index, ray)| judge.ray(index, ray)).collect();
    let given = |value: &CastValue| stated.part(*value, 0).is_some() || rays.is_empty();
    let tally = |value: CastValue| {
        let mut tally = ValueTally { value, compared: 0, not_compared: 0, wrong: 0, worst: None };
        for (index, judged) in judged.iter().enumerate() {
            let ratio = match judged.values[value as usize] {
                Some(Compared::Ratio(ratio)) => ratio,
                Some(Compared::Anything) => {
                    tally.not_compared += 1;
                    continue;
                }
                None => continue,
            };
            tally.compared += 1;
            tally.wrong += u64::from(ratio > 1.0);
            if tally.worst.is_none_or(|(worst, _)| ratio > worst) {
                tally.worst = Some((ratio, index));
            }
        }
        tally
    };
    Comparison {
        values: CastValue::ALL.into_iter().filter(given).map(tally).collect(),
        met: judged.iter().filter(|judged| judged.is_met).count() as u64,
        verdicts: judged.into_iter().map(|judged| judged.verdict).collect(),
        precision,
    }
}

impl Stated {
    /// The parts of a value of a ray, if it is given: one or three numbers; a side is 1 or -1, and 0 if it is not said.
    pub(crate) fn part(&self, value: CastValue, index: usize) -> Option<[f64; 3]> {
        let number = |array: &Option<Vec<f64>>| Some([*array.as_ref()?.get(index)?, 0.0, 0.0]);
        let vector = |array: &Option<Vec<DVec3>>| Some(array.as_ref()?.get(index)?.to_array());
        match value {
            CastValue::T => number(&self.t),
            CastValue::Range => number(&self.range),
            CastValue::Side => {
                let side = self.side.as_ref()?.get(index)?;
                Some([side.map_or(0.0, |side| f64::from(side_number(side))), 0.0, 0.0])
            }
            CastValue::Point => vector(&self.point),
            CastValue::Normal => vector(&self.normal),
            CastValue::Barycentric => vector(&self.barycentric),
            CastValue::CosIncidence => number(&self.cos_incidence),
        }
    }
}

impl CastValue {
    /// Whether it has three numbers.
    pub(crate) fn is_vector(self) -> bool {
        matches!(self, Self::Point | Self::Normal | Self::Barycentric)
    }

    /// The exact parts, as [`Stated::part`] has those that are stated.
    pub(crate) fn exact(self, hit: &CastMeeting<'_>) -> [f64; 3] {
        let three = |parts: [Rounded; 3]| parts.map(|part| part.double);
        match self {
            Self::T => [hit.t().double, 0.0, 0.0],
            Self::Range => [hit.range().double, 0.0, 0.0],
            Self::Side => [f64::from(side_number(hit.side())), 0.0, 0.0],
            Self::Point => three(hit.point()),
            Self::Normal => three(hit.normal()),
            Self::Barycentric => three(hit.barycentric()),
            Self::CosIncidence => [hit.cos_incidence().double, 0.0, 0.0],
        }
    }
}

/// How far rounding may move each part of a face's normal.
pub(crate) fn normal_error(
    exact: &ExactCast<'_>,
    mesh: &Triangles,
    ray: &CastRay,
    face: FaceId,
    precision: Precision,
) -> f64 {
    let corners = mesh.corners(face);
    let shortest = edge_lengths(corners).into_iter().fold(f64::INFINITY, f64::min);
    aspect(corners) * (16.0 * precision.unit_roundoff + exact.lateral_error(ray, precision) / shortest)
}

/// The lengths of the edges of a triangle of any size.
fn edge_lengths([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [b - a, c - b, a - c].map(|edge| {
        let largest = edge.abs().max_element();
        // Squares of tiny lengths would be 0.
        if largest > 0.0 { (edge / largest).length() * largest } else { 0.0 }
    })
}

/// What became of a value.
#[derive(Debug, Clone, Copy)]
enum Compared {
    /// Its error as a part of its bound.
    Ratio(f64),
    /// Rounding may make anything of it: the face is too thin for this arithmetic.
    Anything,
}

/// One ray, judged.
struct Judged {
    verdict: RayVerdict,
    /// Whether the ray meets something, too near or not.
    is_met: bool,
    /// Each value, where there is one to compare.
    values: [Option<Compared>; 7],
}

/// Whether a t, which storing may have moved by `stored`, is the end of the ray: as it is, or as arithmetic of single precision has it.
fn is_end(ray: &CastRay, t: f64, stored: f64, precision: Precision) -> bool {
    let is_single = precision.unit_roundoff >= Precision::F32.unit_roundoff;
    let ends = [Some(ray.t_max), is_single.then_some(f64::from(ray.t_max as f32))];
    ends.into_iter().flatten().any(|end| (t - end).abs() <= stored)
}

/// Whether weights are those of a corner.
fn is_corner(weights: [f64; 3]) -> bool {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].contains(&weights)
}

/// The same ray without its ends.
fn endless(ray: &CastRay) -> CastRay {
    CastRay { t_min: 0.0, t_max: f64::INFINITY, ..*ray }
}

struct Judge<'a> {
    exact: &'a ExactCast<'a>,
    mesh: &'a Triangles,
    sides: Sides,
    stated: &'a Stated,
    precision: Precision,
}

impl Judge<'_> {
    fn ray(&self, index: usize, ray: &CastRay) -> Judged {
        let read = self.exact.reading(ray, self.sides);
        let judged = |verdict| Judged { verdict, is_met: !matches!(read, Reading::Miss), values: [None; 7] };
        if let Some(wrong) = self.disagreement(index, ray) {
            return judged(RayVerdict::Wrong(wrong));
        }
        let stated = match self.stated_reading(index, ray, &read) {
            Ok(stated) => stated,
            Err(wrong) => return judged(RayVerdict::Wrong(wrong)),
        };
        let is_same = match (stated, &read) {
            (Reading::Hit(face), Reading::Hit(faces)) => faces.contains(&face),
            (Reading::TooNear, Reading::TooNear) | (Reading::Miss, Reading::Miss) => true,
            _ => false,
        };
        let ruling = match is_same {
            true => Ruling::Exact,
            false => self.exact.rule(ray, self.sides, stated, self.precision),
        };
        match ruling {
            Ruling::Rounding(by) => judged(RayVerdict::Rounding { moved: by.to_array() }),
            Ruling::Wrong => {
                let exact = read.clone().map(|faces| faces[0]);
                judged(RayVerdict::Wrong(Wrong::Hit { stated, exact }))
            }
            Ruling::Exact | Ruling::Tie => {
                let hit = stated.hit().and_then(|face| self.exact.meeting(ray, *face));
                let (wrong, values) = match hit {
                    None => (None, [None; 7]),
                    Some(hit) => self.values(index, ray, &hit),
                };
                if wrong.is_some()
                    && let (Reading::Hit(face), Reading::Hit(faces)) = (stated, &read)
                    && let Some((verdict, values)) = self.unnamed_face(index, ray, (face, faces))
                {
                    return Judged { values, ..judged(verdict) };
                }
                let is_tie = read.hit().is_some_and(|faces| faces.len() > 1);
                let same = RayVerdict::Same { is_tie };
                Judged { values, ..judged(wrong.map_or(same, RayVerdict::Wrong)) }
            }
        }
    }

    /// Of a program that names no face, whose values are not those of `face`: the verdict by another face for which all fit. That is one
    /// that is met at the same t, or one that rounding lets a program take and whose normal is the one that is stated.
    fn unnamed_face(
        &self,
        index: usize,
        ray: &CastRay,
        (face, nearest): (FaceId, &[FaceId]),
    ) -> Option<(RayVerdict, [Option<Compared>; 7])> {
        if self.stated.face.is_some() {
            return None;
        }
        for other in nearest.iter().filter(|other| **other != face) {
            let Some(hit) = self.exact.meeting(ray, *other) else { continue };
            if let (None, values) = self.values(index, ray, &hit) {
                return Some((RayVerdict::Same { is_tie: true }, values));
            }
        }
        if self.has_normal_of(index, ray, face)? {
            return None;
        }
        let near = self.faces_near(ray).into_iter();
        near.filter(|other| self.has_normal_of(index, ray, *other) == Some(true)).find_map(|other| match self
            .exact
            .rule(ray, self.sides, Reading::Hit(other), self.precision)
        {
            Ruling::Rounding(by) => Some((RayVerdict::Rounding { moved: by.to_array() }, [None; 7])),
            _ => None,
        })
    }

    /// The faces that rounding may let a ray meet, its ends left out.
    fn faces_near(&self, ray: &CastRay) -> Vec<FaceId> {
        let most = self.exact.lateral_error(ray, self.precision);
        self.exact.faces_near(&endless(ray), self.sides, most)
    }

    /// Whether the normal that is stated of a ray is that of a face, as far as rounding may move it; `None`: none is stated.
    fn has_normal_of(&self, index: usize, ray: &CastRay, face: FaceId) -> Option<bool> {
        let stated = self.stated.normal.as_ref()?[index];
        let [a, b, c] = self.mesh.corners(face);
        let normal = (b - a).cross(c - a).normalize();
        // The normal that is formed here may be off by as much as that of another program in double precision.
        let own = normal_error(self.exact, self.mesh, ray, face, Precision::F64);
        let error = normal_error(self.exact, self.mesh, ray, face, self.precision);
        let most = own + error + self.stated.stored.of(CastValue::Normal, index);
        Some((stated - normal).abs().max_element() <= most)
    }

    /// Where one array says that a ray hits something, and another that it does not.
    fn disagreement(&self, index: usize, ray: &CastRay) -> Option<Wrong> {
        let (by, is_hit) = self.stated.speaks(index);
        if let Some(hit) = self.stated.hit.as_ref().map(|hit| hit[index]).filter(|hit| *hit != is_hit) {
            return Some(Wrong::Disagreement { by, is_hit, of: "hit", number: f64::from(u8::from(hit)) });
        }
        let says_otherwise = |value: &CastValue| {
            let parts = self.stated.part(*value, index)?;
            let is_number = parts.iter().any(|part| part.is_finite());
            let otherwise = match (value, is_hit) {
                (CastValue::T | CastValue::Range, true) => !parts[0].is_finite(),
                (_, true) => false,
                // Many programs leave the end of a ray as it was, beside a face that says that nothing is hit.
                (CastValue::T, false) if by == "face" => {
                    let stored = self.stated.stored.of(CastValue::T, index);
                    parts[0].is_finite() && !is_end(ray, parts[0], stored, self.precision)
                }
                (CastValue::T | CastValue::Range, false) => parts[0].is_finite(),
                (CastValue::Point, false) => is_number,
                // No hit has the cosine 0.
                (CastValue::CosIncidence, false) => parts[0].is_finite() && parts[0] != 0.0,
                // A side that is not said is 0, and no normal is 0 long.
                (CastValue::Side | CastValue::Normal, false) => is_number && parts != [0.0; 3],
                // Those of no place, and those of u = v = 0, which belong to a corner.
                (CastValue::Barycentric, false) => is_number && parts != [0.0; 3] && !is_corner(parts),
            };
            let number = parts.into_iter().find(|part| part.is_finite() || is_hit);
            otherwise.then_some(Wrong::Disagreement {
                by,
                is_hit,
                of: value.name(),
                number: number.unwrap_or(parts[0]),
            })
        };
        CastValue::ALL.iter().find_map(says_otherwise)
    }

    /// What is stated: a face, or why there is none.
    fn stated_reading(
        &self,
        index: usize,
        ray: &CastRay,
        read: &Reading<Vec<FaceId>>,
    ) -> Result<Reading<FaceId>, Wrong> {
        let of = |value| Some(self.stated.part(value, index)?[0]);
        let (t, range) = (of(CastValue::T), of(CastValue::Range));
        match &self.stated.face {
            Some(faces) => {
                if let Some(face) = faces[index] {
                    return Ok(Reading::Hit(face));
                }
            }
            None => {
                let Some(distance) = t.or(range) else {
                    let hit = self.stated.hit.as_ref().expect("faces, distances or hits");
                    return if hit[index] { self.something(ray, read) } else { Ok(self.unsaid(ray, read)) };
                };
                if distance.is_finite() {
                    return self.stated_face(index, ray, distance, t.is_some(), read).map(Reading::Hit);
                }
            }
        }
        let says = |distance: Option<f64>| distance.filter(|distance| !distance.is_nan());
        match [says(t), says(range)].map(|said| said.map(|distance| distance == f64::NEG_INFINITY)) {
            [Some(t), Some(range)] if t != range => Err(Wrong::Contradiction),
            [Some(true), _] | [_, Some(true)] => Ok(Reading::TooNear),
            [None, None] => Ok(self.unsaid(ray, read)),
            _ => Ok(Reading::Miss),
        }
    }

    /// The face that a ray hits of which it is stated only that it hits something: the exact one, or else one that rounding may have
    /// brought before the ray.
    fn something(&self, ray: &CastRay, read: &Reading<Vec<FaceId>>) -> Result<Reading<FaceId>, Wrong> {
        if let Reading::Hit(faces) = read {
            return Ok(Reading::Hit(faces[0]));
        }
        // What the ray meets beyond its ends, and what rays around it do.
        let found = self.faces_near(ray).into_iter().find(|face| self.is_excused(ray, *face));
        let exact = read.clone().map(|faces| faces[0]);
        found.map(Reading::Hit).ok_or(Wrong::Something { exact })
    }

    /// Whether a program may say that the ray hits this face.
    fn is_excused(&self, ray: &CastRay, face: FaceId) -> bool {
        self.exact.rule(ray, self.sides, Reading::Hit(face), self.precision) != Ruling::Wrong
    }

    /// What stands in the place of a face, where it is not said: the better one of too near and a miss.
    fn unsaid(&self, ray: &CastRay, read: &Reading<Vec<FaceId>>) -> Reading<FaceId> {
        let is_too_near = match read {
            Reading::TooNear => true,
            Reading::Miss => false,
            Reading::Hit(_) => {
                self.exact.rule(ray, self.sides, Reading::TooNear, self.precision) != Ruling::Wrong
            }
        };
        if is_too_near { Reading::TooNear } else { Reading::Miss }
    }

    /// The face that is met at a distance that is stated, `t` or a range.
    fn stated_face(
        &self,
        index: usize,
        ray: &CastRay,
        distance: f64,
        is_t: bool,
        read: &Reading<Vec<FaceId>>,
    ) -> Result<FaceId, Wrong> {
        let value = if is_t { CastValue::T } else { CastValue::Range };
        let of = |hit: &CastMeeting<'_>| if is_t { hit.t().double } else { hit.range().double };
        let is_on = |ray: &CastRay, face: FaceId| {
            self.exact
                .meeting(ray, face)
                .is_some_and(|hit| (of(&hit) - distance).abs() <= self.bound(value, index, ray, &hit))
        };
        let is_there = |face: &FaceId| is_on(ray, *face);
        let all = || self.exact.all(ray, self.sides).into_iter().flat_map(|group| group.faces);
        let found = read.hit().and_then(|first| first.iter().copied().find(is_there));
        let found = found.or_else(|| all().map(|met| met.face).find(is_there));
        // A face a little beyond an end of the ray, which rounding brings before it.
        let beyond = || {
            let endless = endless(ray);
            let faces = self.exact.all(&endless, self.sides).into_iter().flat_map(|group| group.faces);
            faces.map(|met| met.face).find(|face| is_on(&endless, *face) && self.is_excused(ray, *face))
        };
        let value_of = |face: FaceId| self.exact.meeting(ray, face).map_or(f64::NAN, |hit| of(&hit));
        let exact = read.clone().map(|faces| value_of(faces[0]));
        // A face that only a ray beside this one meets: its distance there is that of its plane, up to the bound.
        let beside = || {
            let most = self.exact.lateral_error(ray, self.precision);
            let around = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
            around.into_iter().find_map(|by: [f64; 2]| {
                let faces = self.exact.first_moved(ray, self.sides, by.map(|part| part * most));
                faces.into_iter().find(|face| self.is_plane_at(index, ray, *face, distance, is_t))
            })
        };
        found.or_else(beyond).or_else(beside).ok_or(Wrong::Distance { stated: distance, exact })
    }

    /// Whether the ray passes the plane of a face at this distance.
    fn is_plane_at(&self, index: usize, ray: &CastRay, face: FaceId, distance: f64, is_t: bool) -> bool {
        let per_t = ray.direction.length();
        let t = self.exact.t_of_plane(ray, face);
        let range = if is_t { distance * per_t } else { distance };
        let stored = &self.stated.stored;
        let of_storing = match is_t {
            true => stored.of(CastValue::T, index) * per_t,
            false => stored.of(CastValue::Range, index),
        };
        (t * per_t - range).abs() <= self.exact.range_error(ray, face, self.precision) + of_storing
    }

    /// How far a value may be off by rounding.
    fn bound(&self, value: CastValue, index: usize, ray: &CastRay, hit: &CastMeeting<'_>) -> f64 {
        let range = || self.exact.range_error(ray, hit.face(), self.precision);
        let lateral = || self.exact.lateral_error(ray, self.precision);
        let normal = || normal_error(self.exact, self.mesh, ray, hit.face(), self.precision);
        let u = self.precision.unit_roundoff;
        let of_arithmetic = match value {
            CastValue::T => range() / ray.direction.length(),
            CastValue::Range => range(),
            CastValue::Side if self.exact.may_turn_side(ray, hit.face(), self.precision) => 2.0,
            CastValue::Side => 0.0,
            CastValue::Point => range() + lateral(),
            CastValue::Barycentric => {
                // 1 / (c h): the least height h of a triangle is twice its area over its longest edge.
                let mut edges = edge_lengths(self.mesh.corners(hit.face()));
                edges.sort_unstable_by(f64::total_cmp);
                lateral() * self.exact.aspect_over_cosine(ray, hit.face()) / edges[1] + 16.0 * u
            }
            CastValue::Normal => normal(),
            CastValue::CosIncidence => normal() + 8.0 * u,
        };
        of_arithmetic + self.stated.stored.of(value, index)
    }

    /// The first value that is wrong, and what became of each.
    fn values(
        &self,
        index: usize,
        ray: &CastRay,
        hit: &CastMeeting<'_>,
    ) -> (Option<Wrong>, [Option<Compared>; 7]) {
        let mut wrong = None;
        let mut values = [None; 7];
        for value in CastValue::ALL {
            let Some(stated) = self.stated.part(value, index) else { continue };
            let exact = value.exact(hit);
            let differences = [0, 1, 2].map(|k: usize| (stated[k] - exact[k]).abs());
            // NaN counts as the worst.
            let worst = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
            let error = worst(worst(differences[0], differences[1]), differences[2]);
            let bound = self.bound(value, index, ray, hit);
            // What a side, a unit vector or a cosine may be at all is no further apart than 2.
            let is_of_unit = matches!(value, CastValue::Side | CastValue::Normal | CastValue::CosIncidence);
            if error.is_finite() && (bound.is_infinite() || is_of_unit && bound >= 2.0 && error <= bound) {
                values[value as usize] = Some(Compared::Anything);
                continue;
            }
            let ratio = if error == 0.0 { 0.0 } else { error / bound };
            let ratio = if ratio.is_nan() { f64::INFINITY } else { ratio };
            values[value as usize] = Some(Compared::Ratio(ratio));
            if ratio > 1.0 && wrong.is_none() {
                wrong = Some(Wrong::Value { value, error, bound });
            }
        }
        (wrong, values)
    }
}
