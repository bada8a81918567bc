//! The neighbourhood of a ray: every face that a ray displaced by at most a cell may meet, with its conditions, and
//! the exact verdict on any of these rays.
//!
//! One traversal of the hierarchy finds the faces. It follows the whole bundle of displaced rays. Faces beside the
//! bundle are left out at once, faces farther than the known range are left for later (`extend_to`).

use std::cell::OnceCell;
use std::cmp::Ordering;

use crate::hits::face::{ExactRay, Face};
use crate::hits::face_forms::{Exclusion, FaceForms};
use crate::hits::through_point::{displacements_between_sides, displacements_inside_corners};
use crate::hits::verdict::{Referee, bundle_of};
use crate::rays::form::Form;
use crate::rays::moving_ray::MovingRay;
use crate::rays::ray::{Aim, MountedSensor};
use crate::trees::bvh::Traversal;

/// The faces near the ray of one cell.
#[derive(Debug)]
pub(crate) struct Neighbourhood<'a> {
    sensor: &'a MountedSensor,
    aim: Aim,
    pub(crate) ray: MovingRay,
    walk: Traversal<'a, Face>,
    /// All faces that may be met within this range, metres, are in `faces`.
    known_range: f64,
    pub(crate) faces: Vec<FaceForms<'a>>,
    /// The bounds of the faces in the square, in a contiguous list: most rays miss most faces.
    bounds: Vec<[[f64; 2]; 2]>,
    /// Faces whose triangles lie beside the square: the other sides of edges that cannot lie in the square either.
    beside: Vec<&'a Face>,
    edges: EdgeIndex,
    /// Faces of which each has other corners; empty until [`Neighbourhood::find_distinct`].
    pub(crate) distinct: Vec<usize>,
}

/// The other side of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EdgeMate {
    /// A face of the neighbourhood, by its index.
    Near(usize),
    /// A face whose triangle lies beside the square, and with it the edge.
    Beside,
}

impl<'a> Neighbourhood<'a> {
    /// All faces that may be met before a face that the ray itself meets, or together with it.
    pub(crate) fn new(referee: &'a Referee<'_>, sensor: &'a MountedSensor, aim: Aim) -> Self {
        let ray = MovingRay::new(sensor, aim);
        let max_range = sensor.max_range();
        let walk = Traversal::new(&referee.bvh, &bundle_of(&ray, max_range, 1.0));
        let mut near = Self {
            sensor,
            aim,
            ray,
            walk,
            known_range: max_range,
            faces: Vec::with_capacity(16),
            bounds: Vec::with_capacity(16),
            beside: Vec::with_capacity(32),
            edges: EdgeIndex::default(),
            distinct: Vec::new(),
        };
        near.gather(true);
        near
    }

    /// Gathers faces up to `known_range`. If `lowers`, a face that is certainly met lowers that range.
    fn gather(&mut self, lowers: bool) {
        while let Some(leaf) = self.walk.next_leaf(self.known_range) {
            for face in leaf {
                let forms = match FaceForms::in_square(&self.ray, face) {
                    Ok(forms) => forms,
                    Err(Exclusion::Beside) => {
                        self.beside.push(face);
                        continue;
                    }
                    // No front in the square: the face is neither met nor part of a sheet.
                    Err(Exclusion::Back) => continue,
                };
                let met = |form: &Form| form.is_positive_at([0.0; 2]) == Some(true);
                if lowers && forms.farthest < self.known_range && forms.conditions().iter().all(met) {
                    self.known_range = forms.farthest;
                }
                self.bounds.push(forms.bounds());
                self.faces.push(forms);
            }
        }
    }

    /// Displacements of at most `max_cells` cells, just inside the corners of a face.
    pub(crate) fn displacements_inside_corners(&self, face: usize, max_cells: f64) -> Vec<[f64; 2]> {
        displacements_inside_corners(self.sensor, self.aim, self.faces[face].face, max_cells)
    }

    /// Displacements of at most a cell, between the points of a face's sides that the ray passes.
    pub(crate) fn displacements_between_sides(&self, face: usize) -> Vec<[f64; 2]> {
        displacements_between_sides(self.sensor, self.aim, self.faces[face].face, 1.0)
    }

    /// Extends the known faces to `range`, metres; returns whether there are new ones.
    pub(crate) fn extend_to(&mut self, range: f64) -> bool {
        if range <= self.known_range {
            return false;
        }
        self.known_range = range;
        self.walk.resume();
        let before = self.faces.len() + self.beside.len();
        self.gather(false);
        before < self.faces.len() + self.beside.len()
    }

    /// Extends the known faces to the sensor's maximum range.
    pub(crate) fn extend_to_max_range(&mut self) {
        self.extend_to(self.sensor.max_range());
    }

    /// The faces that the ray displaced by `at` (at most a cell) meets first, exactly: indices in ascending order of
    /// the face ids. Only known faces count; if one of them is met within the known range, these are the nearest of
    /// all.
    pub(crate) fn nearest_at(&self, at: [f64; 2]) -> Vec<usize> {
        self.nearest_among(0..self.faces.len(), at)
    }

    /// The same among some faces.
    fn nearest_among(&self, faces: impl Iterator<Item = usize>, at: [f64; 2]) -> Vec<usize> {
        let exact = OnceCell::new();
        let exact =
            || exact.get_or_init(|| ExactRay::new(self.sensor, Aim { dx: at[0], dy: at[1], ..self.aim }));
        let mut nearest: Vec<usize> = Vec::new();
        for index in faces {
            let [low, high] = &self.bounds[index];
            let inside = (0..2).all(|axis| (low[axis]..=high[axis]).contains(&at[axis]));
            let forms = &self.faces[index];
            if !inside || !self.is_met(forms, at, exact) {
                continue;
            }
            let order = nearest.first().map(|&kept| {
                let kept = &self.faces[kept];
                match forms.at_or_before(kept).is_positive_at(at) {
                    Some(true) => Ordering::Less,
                    Some(false) => Ordering::Greater,
                    None => forms.face.compare(kept.face, exact()),
                }
            });
            match order {
                None | Some(Ordering::Less) => {
                    nearest.clear();
                    nearest.push(index);
                }
                Some(Ordering::Equal) => nearest.push(index),
                Some(Ordering::Greater) => {}
            }
        }
        nearest.sort_by_key(|&index| self.faces[index].face.id);
        nearest
    }

    /// The condition that one face is met nearer than any point of another; negative if there is no such range.
    pub(crate) fn sooner(&self, face: usize, other: usize) -> Form {
        let closest = self.faces[other].closest(&self.ray).clamp(0.0, self.sensor.max_range());
        self.faces[face].within(&self.ray, closest)
    }

    /// Whether a displaced ray meets a face.
    fn is_met<'r>(&self, forms: &FaceForms<'_>, at: [f64; 2], exact: impl Fn() -> &'r ExactRay<'r>) -> bool {
        let mut certain = true;
        for form in forms.conditions() {
            match form.is_positive_at(at) {
                Some(true) => {}
                Some(false) => return false,
                None => certain = false,
            }
        }
        certain || forms.face.is_met_by(exact(), self.sensor.max_range())
    }

    /// Finds the faces that are not the same triangle as one with a smaller id. The same triangle is met by the same rays at
    /// the same ranges, and a thousand faces at one place would cost a million comparisons. All faces must be known.
    pub(crate) fn find_distinct(&mut self) {
        let triangle = |index: usize| self.faces[index].face.corners.map(key);
        let mut order: Vec<usize> = (0..self.faces.len()).collect();
        order.sort_by_key(|&index| (triangle(index), self.faces[index].face.id));
        order.dedup_by_key(|index| triangle(*index));
        order.sort_unstable();
        self.distinct = order;
    }

    /// The range of a displaced ray, metres, or `None` for a miss. The distinct faces must be known.
    pub(crate) fn range_at(&self, at: [f64; 2]) -> Option<f64> {
        let nearest = *self.nearest_among(self.distinct.iter().copied(), at).first()?;
        let (range, doubt) = self.faces[nearest].range_at(&self.ray, at);
        // An f64 is far finer than the jumps searched for; otherwise the exact polynomials decide.
        if doubt < 1.0 / (1u64 << 30) as f64 {
            return Some(range);
        }
        let exact = ExactRay::new(self.sensor, Aim { dx: at[0], dy: at[1], ..self.aim });
        Some(self.faces[nearest].face.range(&exact))
    }

    /// The known faces on the other side of edge `k` of a face.
    pub(crate) fn mates(&mut self, index: usize, k: usize) -> Vec<EdgeMate> {
        self.edges.catch_up(&self.faces, &self.beside);
        let corners = self.faces[index].face.corners;
        self.edges.find(corners[(k + 1) % 3], corners[k], &self.faces, &self.beside)
    }
}

/// The edges of faces, found by the positions of their ends: neighbouring faces need no common vertex indices.
#[derive(Debug, Default)]
struct EdgeIndex {
    /// (hash of both ends in order, face, edge), sorted. The face is an index into `faces` or, with [`BESIDE_BIT`]
    /// set, into `beside`.
    sorted: Vec<(u64, u32, u32)>,
    faces: usize,
    beside: usize,
}

/// The bit that marks a face as one of `beside`.
const BESIDE_BIT: u32 = 1 << 31;

/// A position as a key: -0 and +0 are one.
fn key(corner: [f32; 3]) -> [u32; 3] {
    corner.map(|coordinate| (coordinate + 0.0).to_bits())
}

/// A hash of both ends of an edge, in order.
fn hash(from: [f32; 3], to: [f32; 3]) -> u64 {
    let parts = key(from).into_iter().chain(key(to));
    parts.fold(0, |hash, part| (hash ^ u64::from(part)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29))
}

impl EdgeIndex {
    /// Adds the faces that are new since the last call.
    fn catch_up(&mut self, faces: &[FaceForms<'_>], beside: &[&Face]) {
        if (self.faces, self.beside) == (faces.len(), beside.len()) {
            return;
        }
        let fresh = faces[self.faces..].iter().enumerate().map(|(k, f)| ((self.faces + k) as u32, f.face));
        let aside = beside[self.beside..].iter().enumerate();
        let fresh = fresh.chain(aside.map(|(k, &face)| ((self.beside + k) as u32 + BESIDE_BIT, face)));
        for (index, face) in fresh {
            let corners = face.corners;
            for k in 0..3 {
                self.sorted.push((hash(corners[k], corners[(k + 1) % 3]), index, k as u32));
            }
        }
        self.sorted.sort_unstable();
        (self.faces, self.beside) = (faces.len(), beside.len());
    }

    /// The faces with an edge from `from` to `to`.
    fn find(&self, from: [f32; 3], to: [f32; 3], faces: &[FaceForms<'_>], beside: &[&Face]) -> Vec<EdgeMate> {
        let hash = hash(from, to);
        let start = self.sorted.partition_point(|&(other, ..)| other < hash);
        let same = self.sorted[start..].iter().take_while(|&&(other, ..)| other == hash);
        same.filter_map(|&(_, index, k)| {
            let (face, mate) = if index & BESIDE_BIT != 0 {
                (beside[(index & !BESIDE_BIT) as usize], EdgeMate::Beside)
            } else {
                (faces[index as usize].face, EdgeMate::Near(index as usize))
            };
            let ends = [face.corners[k as usize], face.corners[(k as usize + 1) % 3]];
            (ends.map(key) == [key(from), key(to)]).then_some(mate)
        })
        .collect()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/neighbourhood.rs"]
mod tests;
