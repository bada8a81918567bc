//! The margin `surface`: the least displacement at which the nearest surface is not one continuous sheet any more.
//!
//! There the ray changes between hit and miss, or its range jumps. Edges *inside* a surface do not count, nor lines
//! where two surfaces intersect: there the range is continuous.
//!
//! lo starts as the largest square that `sheet` proves, or as the margin of the face if that is larger. A witness is
//! searched for where surfaces end. If none is found within twice lo, the unit square is subdivided (`subdivision`),
//! and its parts are proven from their own middles. A range that is continuous on each of two closed squares that
//! share a side is continuous on both, so a jump can only be in a part that is not proven.

use crate::hits::neighbourhood::{EdgeMate, Neighbourhood};
use crate::hits::region::Region;
use crate::margins::margin::Margin;
use crate::margins::subdivision::{Square, is_tight, subdivide};
use crate::rays::displacement::max_norm;
use crate::rays::form::Form;

/// Two ranges at almost the same displacement with a greater relative difference have a jump between them. CHOICE:
/// 2^-20 is tuned. It is far below any step that matters, and far above the change of range by a slope over
/// [`MAX_JUMP_WIDTH_CELLS`].
const MIN_RELATIVE_JUMP: f64 = 1.0 / (1u32 << 20) as f64;

/// Distance to both sides of an end at which a witness is searched for first, cells.
const WITNESS_OFFSET_CELLS: f64 = 1.0 / (1u32 << 30) as f64;

/// A step between two rays is a jump if it remains when they are this close, cells. A face seen edge-on, whose range
/// grows by thousands of metres per cell, has none.
const MAX_JUMP_WIDTH_CELLS: f64 = 1.0 / (1u64 << 40) as f64;

/// Number of evenly spaced points of an edge at which a witness is searched for.
const POINTS_PER_EDGE: u32 = 16;

/// A place where a surface may end.
#[derive(Debug, Clone, Copy)]
struct SurfaceEnd {
    at: [f64; 2],
    /// The unit vector across the end.
    outward: [f64; 2],
    /// The edge that it lies on, if any, as (face, corner).
    edge: Option<(usize, usize)>,
    /// The fraction of the edge at which it lies.
    s: f64,
}

impl Neighbourhood<'_> {
    /// The margin of the surface, from the nearest faces and their margin.
    pub(crate) fn surface_margin(&mut self, nearest: &[usize], face: &Margin) -> Margin {
        // A miss ends with a hit: both margins are the same.
        if face.lo >= 1.0 || nearest.is_empty() {
            return *face;
        }
        let lo = self.continuous_within([0.0; 2], nearest, 1.0).max(face.lo);
        if lo >= 1.0 {
            return Margin::CAPPED;
        }
        self.extend_to_max_range();
        self.find_distinct();
        let ends = self.ends();
        let mut witness = self.at_an_end(&ends, lo);
        if !is_tight(lo, witness) {
            witness = self.where_it_begins(&ends, lo, witness);
        }
        if is_tight(lo, witness) {
            return Margin::of(lo, witness);
        }
        let (lo, witness) = subdivide(lo, witness, |square, lo| {
            let nearest = self.nearest_at(square.middle);
            let proven = self.continuous_within(square.middle, &nearest, square.half) >= square.half;
            if proven { None } else { Some(self.jump_within(square, lo)) }
        });
        Margin::of(lo, witness)
    }

    /// A displaced ray beyond a jump where a surface ends: the nearest of the places tried.
    fn at_an_end(&self, ends: &[SurfaceEnd], lo: f64) -> Option<[f64; 2]> {
        let mut ends: Vec<&SurfaceEnd> =
            ends.iter().filter(|end| max_norm(end.at) <= 1.0 && max_norm(end.at) >= lo * 0.5).collect();
        ends.sort_by(|a, b| max_norm(a.at).total_cmp(&max_norm(b.at)));
        ends.iter().find_map(|end| self.jump_at(end, lo))
    }

    /// A displaced ray beyond the jump at an end.
    fn jump_at(&self, end: &SurfaceEnd, lo: f64) -> Option<[f64; 2]> {
        let aside =
            |sign: f64| [0, 1].map(|k: usize| end.at[k] + sign * WITNESS_OFFSET_CELLS * end.outward[k]);
        self.jump_between(aside(-1.0), aside(1.0), lo)
    }

    /// A nearer witness at the place where a jump begins: an edge hidden at one place and visible at the next comes
    /// out from behind another surface, or through it.
    fn where_it_begins(&self, ends: &[SurfaceEnd], lo: f64, witness: Option<[f64; 2]>) -> Option<[f64; 2]> {
        let mut best = witness;
        for pair in ends.windows(2) {
            let ([a, b], least) = ([&pair[0], &pair[1]], best.map_or(1.0, max_norm));
            let (Some(edge), true) = (a.edge, a.edge == b.edge && max_norm(a.at).min(max_norm(b.at)) < least)
            else {
                continue;
            };
            let (mut jumps, mut goes_on) = match (self.jump_at(a, lo), self.jump_at(b, lo)) {
                (Some(at), None) => ((a.s, at), b.s),
                (None, Some(at)) => ((b.s, at), a.s),
                _ => continue,
            };
            for _ in 0..40 {
                let middle = 0.5 * (jumps.0 + goes_on);
                match self.end_at(edge, middle).and_then(|end| self.jump_at(&end, lo)) {
                    Some(at) => jumps = (middle, at),
                    None => goes_on = middle,
                }
            }
            if max_norm(jumps.1) < least {
                best = Some(jumps.1);
            }
        }
        best
    }

    /// The place at the fraction `s` of edge `k` of a face.
    fn end_at(&self, (index, k): (usize, usize), s: f64) -> Option<SurfaceEnd> {
        let face = &self.faces[index];
        let edge = &face.conditions()[k];
        let at = face.edge_point(&self.ray, k, s);
        let slope = [edge.x + edge.xy * at[1], edge.y + edge.xy * at[0]];
        outward(slope).map(|outward| SurfaceEnd { at, outward, edge: Some((index, k)), s })
    }

    /// Places on the ends of surfaces: on edges without a second front, and where the plane or the range ends a face.
    fn ends(&mut self) -> Vec<SurfaceEnd> {
        let mut ends = Vec::new();
        for index in self.distinct.clone() {
            if self.faces[index].conditions().iter().any(|form| form.fails_within() >= 1.0) {
                continue;
            }
            for k in 0..3 {
                let mates = self.mates(index, k);
                let shows_front = |mate: &EdgeMate| match mate {
                    EdgeMate::Near(mate) => self.faces[*mate].conditions()[3].holds_within() >= 1.0,
                    EdgeMate::Beside => true,
                };
                if !mates.iter().any(shows_front) {
                    self.points_of_edge(index, k, &mut ends);
                }
            }
            for part in [4, 5] {
                self.points_of_limit(index, part, &mut ends);
            }
        }
        ends
    }

    /// Points of an edge, among them those that may be nearest: where it crosses an axis or a diagonal.
    fn points_of_edge(&self, index: usize, k: usize, ends: &mut Vec<SurfaceEnd>) {
        let at = |s: f64| self.faces[index].edge_point(&self.ray, k, s);
        // The part of the edge in the square, by the sides that a straight line crosses. A beam bends it but little.
        let (a, b) = (at(0.0), at(1.0));
        let mut cuts: Vec<f64> = vec![0.0, 1.0];
        let across = |f: &dyn Fn([f64; 2]) -> f64| {
            let (mut low, mut high) = (0.0, 1.0);
            if !(f(a) * f(b) < 0.0) {
                return None;
            }
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if f(at(middle)) * f(a) > 0.0 { low = middle } else { high = middle }
            }
            Some(0.5 * (low + high))
        };
        for line in [
            &(|p: [f64; 2]| p[0]) as &dyn Fn([f64; 2]) -> f64,
            &|p| p[1],
            &|p| p[0] - p[1],
            &|p| p[0] + p[1],
            &|p| p[0] - 1.0,
            &|p| p[0] + 1.0,
            &|p| p[1] - 1.0,
            &|p| p[1] + 1.0,
        ] {
            cuts.extend(across(line));
        }
        cuts.retain(|&s| max_norm(at(s)) <= 1.0 + 1e-9);
        let from = cuts.iter().copied().fold(f64::INFINITY, f64::min);
        let to = cuts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if !(from < to) {
            return;
        }
        let length = to - from;
        cuts.extend(
            (0..POINTS_PER_EDGE)
                .map(|step| from + length * (f64::from(step) + 0.5) / f64::from(POINTS_PER_EDGE)),
        );
        // Ends of the edge: a jump grows from zero where an edge comes out of another surface, or at a corner.
        cuts.extend([1e-6, 1e-4, 1e-2].into_iter().flat_map(|s| [from + s * length, to - s * length]));
        cuts.sort_by(f64::total_cmp);
        ends.extend(cuts.into_iter().filter_map(|s| self.end_at((index, k), s)));
    }

    /// Points where a condition other than an edge ends a face.
    fn points_of_limit(&self, index: usize, part: usize, ends: &mut Vec<SurfaceEnd>) {
        let all = self.faces[index].conditions();
        let limit = &all[part];
        if limit.holds_within() >= 1.0 {
            return;
        }
        // The points are taken from a thin region along the end.
        let mut forms: Vec<Form> = all.to_vec();
        forms.push(limit.negated());
        let Some(region) = Region::of(&forms) else { return };
        let Some(outward) = outward([limit.x, limit.y]) else { return };
        let mut push = |at: [f64; 2]| ends.push(SurfaceEnd { at, outward, edge: None, s: 0.0 });
        push(region.near);
        for (k, &a) in region.corners.iter().enumerate() {
            let b = region.corners[(k + 1) % region.corners.len()];
            for step in 0..POINTS_PER_EDGE {
                let s = f64::from(step) / f64::from(POINTS_PER_EDGE);
                push([0, 1].map(|axis: usize| a[axis] + s * (b[axis] - a[axis])));
            }
        }
    }

    /// The farther of two displaced rays with a jump between them, if it lies beyond `lo`. All faces must be known.
    fn jump_between(&self, a: [f64; 2], b: [f64; 2], lo: f64) -> Option<[f64; 2]> {
        let (mut a, mut b) = (a, b);
        let (mut range_a, mut range_b) = (self.range_at(a), self.range_at(b));
        loop {
            if !(relative_step(range_a, range_b) > MIN_RELATIVE_JUMP) {
                return None;
            }
            let apart = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            if apart <= MAX_JUMP_WIDTH_CELLS {
                break;
            }
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            let range = self.range_at(middle);
            // Continue with the half that holds the greater step.
            if relative_step(range_a, range) >= relative_step(range, range_b) {
                (b, range_b) = (middle, range);
            } else {
                (a, range_a) = (middle, range);
            }
        }
        let farther = if max_norm(a) > max_norm(b) { a } else { b };
        (max_norm(farther) >= lo && max_norm(farther) <= 1.0).then_some(farther)
    }

    /// A jump between the middle of a square and one of its corners.
    fn jump_within(&self, square: &Square, lo: f64) -> Option<[f64; 2]> {
        let corners = square.corners();
        let found = corners.into_iter().filter_map(|corner| self.jump_between(square.middle, corner, lo));
        found.min_by(|a, b| max_norm(*a).total_cmp(&max_norm(*b)))
    }
}

/// The relative difference of two ranges; infinite if exactly one is a miss.
fn relative_step(a: Option<f64>, b: Option<f64>) -> f64 {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() / a.min(b),
        (None, None) => 0.0,
        _ => f64::INFINITY,
    }
}

/// The unit vector against a slope.
fn outward([x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let length = (x * x + y * y).sqrt();
    (length > 0.0).then(|| [-x / length, -y / length])
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use raypencil_scene::{Atmosphere, FluxModel, Material, Mesh, Mounted, Pose, Scene, SensorId};

    use super::*;
    use crate::hits::verdict::Referee;
    use crate::rays::ray::{Aim, MountedSensor};
    use crate::small_camera::small_camera;

    /// A face 2 m ahead that ends `cells` cells to the right of the ray; a cell is 1/4 m.
    fn jump(cells: f32, lo: f64) -> Option<[f64; 2]> {
        let end = 0.25 * cells;
        let vertices = vec![[end, -40.0, 2.0], [end - 90.0, 0.0, 2.0], [end, 40.0, 2.0]];
        let material = Material { name: "ground".into(), reflectivity: 0.25 };
        let mesh = Mesh::new(DVec3::ZERO, vertices, vec![[0, 1, 2]], vec![0], vec![material]);
        let mesh = mesh.expect("a mesh");
        let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: small_camera() };
        let air = Atmosphere { attenuation: 0.0 };
        let scene = Scene::new(Arc::new(mesh), camera, vec![], air, FluxModel::Radiometric).expect("a scene");
        let referee = Referee::new(&scene);
        let sensor = MountedSensor::of(&scene, SensorId::Camera).expect("a camera");
        let mut near = Neighbourhood::new(&referee, &sensor, Aim { i: 4, j: 4, dx: 0.0, dy: 0.0 });
        near.extend_to_max_range();
        near.find_distinct();
        near.jump_between([0.0; 2], [1.5, 0.0], lo)
    }

    #[test]
    fn a_jump_is_found_between_two_rays_within_a_cell_and_beyond_what_is_known() {
        for lo in [0.0, 0.7] {
            let [dx, dy] = jump(0.75, lo).expect("the end of the face");
            assert!((dx - 0.75).abs() < 1e-6 && dy == 0.0, "{dx}");
        }
        assert_eq!(jump(0.75, 0.8), None, "nearer than is known to be without");
        assert_eq!(jump(1.25, 0.0), None, "farther than a cell");
        assert_eq!(jump(1.75, 0.0), None, "no jump at all");
    }
}
