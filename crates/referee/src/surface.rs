//! How far a ray is from a jump of the range: the margin `surface`.
//!
//! The margin is the least displacement, in cells, within which the nearest surface does not stay one
//! continuous sheet: the ray comes to miss, or to hit, or its range jumps. Edges *inside* a surface do not
//! count, nor lines where two surfaces pass through one another: there the range is continuous.
//!
//! # The proof of lo
//!
//! For a square |dx|, |dy| <= r call a face *possible* if no condition of its own (edges, front, plane, range,
//! or two of them combined) fails over all of the square. From a possible face walk over each of its edges
//! that may lie in the square to the possible face that has the same edge the other way round. If that
//! succeeds for every edge, and the front, plane and range conditions of all faces walked over hold over
//! all of the square, then these faces form a sheet without an end in it: the union of their images is
//! closed, not empty, and has no border inside the square, since a border could only be an edge, and on the
//! other side of every edge lies the mate. So the sheet covers the square; having no fold (at a fold one of
//! the two faces shows its back), it covers it once, and its range is continuous.
//!
//! If the nearest face's sheet has no end, and every other possible face either lies in a sheet without an
//! end or is certainly met after all faces of the first sheet, then the nearest range over the square is the
//! least of finitely many continuous functions, and there is no jump.

use std::collections::HashMap;

use raypencil_scene::SensorId;

use crate::face::{ExactRay, Face};
use crate::forms::{FaceForms, Form, MovingRay, certainly_fails};
use crate::margin::Margin;
use crate::pencil::{Aim, Sensor};
use crate::region::{Region, size};
use crate::verdict::{Displacement, Referee, bundle};

/// Two ranges at almost one displacement whose ratio differs from 1 by more than this have a jump between
/// them. CHOICE: 2^-20 is tuned: far above what a slope does over the distance of a witness (2^-30 cells),
/// far below any step that matters.
const JUMP: f64 = 1.0 / (1u32 << 20) as f64;

/// How far to both sides of an edge a witness looks, in cells.
const BESIDE: f64 = 1.0 / (1u32 << 30) as f64;

/// Points of an edge at which a witness is looked for.
const POINTS: u32 = 16;

impl Referee<'_> {
    /// The margin of the surface of cell (i, j), or `None` if there is no such cell.
    pub fn surface_margin(&self, sensor: SensorId, i: u32, j: u32) -> Option<Margin> {
        let face = self.face_margin(sensor, i, j)?;
        if face.lo >= 1.0 {
            return Some(face);
        }
        let sensor = Sensor::of(self.scene, sensor)?;
        let aim = Aim { i, j, dx: 0.0, dy: 0.0 };
        let nearest = self.nearest(&sensor, aim);
        if nearest.is_empty() {
            // Whatever ends a miss is a hit.
            return Some(face);
        }
        let ray = MovingRay::new(&sensor, aim);
        let mut around = bundle(&sensor, aim, 1.0);
        around.reach = sensor.max_range();
        let mut faces = Vec::new();
        self.tree.visit(&around, |face, _| {
            faces.push(Neighbour::new(&ray, face));
            around.reach
        });
        let starts: Vec<usize> = (0..faces.len())
            .filter(|&k| nearest.iter().any(|face| face.id == faces[k].forms.face.id))
            .collect();
        let neighbourhood = Neighbourhood::new(faces);

        // The largest r that can be proven, to a part in 2^12 of itself: no jump within a larger square means
        // none within a smaller one.
        if neighbourhood.is_continuous(&starts, 1.0) {
            return Some(Margin::CAPPED);
        }
        let (mut lo, mut beyond) = (face.lo, 1.0);
        if lo > 0.0 && !neighbourhood.is_continuous(&starts, lo) {
            // The face alone proves its own margin.
            beyond = lo;
        }
        while beyond > lo * (1.0 + 1.0 / 4096.0) && beyond > 1e-13 {
            let middle = if lo > 0.0 { (lo * beyond).sqrt() } else { beyond / 4.0 };
            if !(middle > lo && middle < beyond) {
                break;
            }
            if neighbourhood.is_continuous(&starts, middle) {
                lo = middle;
            } else {
                beyond = middle;
            }
        }
        let witness = neighbourhood.jump(self, &sensor, aim, lo);
        Some(Margin { lo, hi: witness.map_or(1.0, |at| at.size().min(1.0)), witness })
    }
}

/// A face near a ray, with its conditions.
struct Neighbour<'a> {
    forms: FaceForms<'a>,
    edges: [Form; 3],
    front: Form,
    plane: Form,
    range: Form,
    /// The largest square in which the face is not possible.
    absent_within: f64,
    /// The largest square in which each edge certainly does not lie.
    edge_absent_within: [f64; 3],
}

impl<'a> Neighbour<'a> {
    fn new(ray: &'a MovingRay, face: &'a Face) -> Self {
        let forms = FaceForms::new(ray, face);
        let [a, b, c, front, plane, range] = forms.own();
        let edges = [a, b, c];
        let absent_within = certainly_fails(&[a, b, c, front, plane, range], 1.0);
        let edge_absent_within = [0, 1, 2].map(|k: usize| {
            // On the edge its own form is 0: it may be added with any weight, of either sign.
            let (edge, others) = (&edges[k], [&edges[(k + 1) % 3], &edges[(k + 2) % 3]]);
            let mut best = edge.holds_within().max(absent_within);
            for other in others {
                for (slope, slope_edge) in [(other.x, edge.x), (other.y, edge.y)] {
                    let weight = -slope.middle() / slope_edge.middle();
                    if weight.is_finite() {
                        best = best.max(other.plus(edge, weight).fails_within());
                    }
                }
            }
            best
        });
        Self { forms, edges, front, plane, range, absent_within, edge_absent_within }
    }

    /// Whether the face's surface goes on past the square wherever its edges let it.
    fn goes_on(&self, r: f64) -> bool {
        [&self.front, &self.plane, &self.range].iter().all(|form| form.holds_within() >= r)
    }
}

/// All faces near a ray, and who lies on the other side of each edge.
struct Neighbourhood<'a> {
    faces: Vec<Neighbour<'a>>,
    /// By the positions of its two ends, in the face's own direction.
    by_edge: HashMap<[[u32; 3]; 2], Vec<usize>>,
}

/// A position as a key: -0 and +0 are one.
fn key(corner: [f32; 3]) -> [u32; 3] {
    corner.map(|coordinate| (coordinate + 0.0).to_bits())
}

impl<'a> Neighbourhood<'a> {
    fn new(faces: Vec<Neighbour<'a>>) -> Self {
        let mut by_edge: HashMap<_, Vec<usize>> = HashMap::new();
        for (index, face) in faces.iter().enumerate() {
            let corners = face.forms.face.corners;
            for k in 0..3 {
                by_edge.entry([key(corners[k]), key(corners[(k + 1) % 3])]).or_default().push(index);
            }
        }
        Self { faces, by_edge }
    }

    /// The faces of the sheet that starts at `start`, or `None` if it has an end within the square.
    fn sheet(&self, start: usize, r: f64) -> Option<Vec<usize>> {
        let mut sheet = vec![start];
        let mut next = 0;
        while let Some(&index) = sheet.get(next) {
            next += 1;
            let face = &self.faces[index];
            if !face.goes_on(r) {
                return None;
            }
            let corners = face.forms.face.corners;
            for k in 0..3 {
                if face.edge_absent_within[k] >= r {
                    continue;
                }
                let mates = self.by_edge.get(&[key(corners[(k + 1) % 3]), key(corners[k])])?;
                // Where more than two faces share an edge, any front will do.
                let mate = *mates.iter().find(|&&mate| self.faces[mate].goes_on(r))?;
                if !sheet.contains(&mate) {
                    sheet.push(mate);
                }
            }
        }
        Some(sheet)
    }

    /// Whether the nearest range is certainly continuous over the square.
    fn is_continuous(&self, starts: &[usize], r: f64) -> bool {
        let Some(&start) = starts.first() else { return false };
        let Some(first) = self.sheet(start, r) else { return false };
        let mut continuous: Vec<usize> = first.clone();
        for index in 0..self.faces.len() {
            if continuous.contains(&index) || self.faces[index].absent_within >= r {
                continue;
            }
            // Nowhere in the square may it be nearest where a face of the first sheet is met.
            let face = &self.faces[index];
            let behind = first.iter().all(|&kept| {
                let kept = &self.faces[kept];
                let before = face.forms.at_or_before(&kept.forms);
                if before.fails_within() >= r {
                    return true;
                }
                let [a, b, c] = &face.edges;
                let [d, e, f] = &kept.edges;
                certainly_fails(&[before, *a, *b, *c, *d, *e, *f], r) >= r
            });
            if behind {
                continue;
            }
            match self.sheet(index, r) {
                Some(sheet) => continuous.extend(sheet),
                None => return false,
            }
        }
        true
    }

    /// A displaced ray beyond a jump, as near as it can be found.
    fn jump(&self, referee: &Referee<'_>, sensor: &Sensor, aim: Aim, lo: f64) -> Option<Displacement> {
        // Where faces end: along edges, and where front, plane or range come to fail.
        let mut points: Vec<([f64; 2], [f64; 2])> = Vec::new();
        for face in self.faces.iter().filter(|face| face.absent_within < 1.0) {
            let all = [face.edges[0], face.edges[1], face.edges[2], face.front, face.plane, face.range];
            for ending in &all {
                let slope = [ending.x.middle(), ending.y.middle()];
                let length = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
                if !(length > 0.0) || ending.holds_within() >= 1.0 {
                    continue;
                }
                // A thin region along the end, from which its points are taken.
                let thin = Form {
                    constant: negated(ending.constant),
                    x: negated(ending.x),
                    y: negated(ending.y),
                    ..*ending
                };
                let mut forms = all.to_vec();
                forms.push(thin);
                let Some(region) = Region::of(&forms) else { continue };
                let outward = [-slope[0] / length, -slope[1] / length];
                points.push((region.near, outward));
                for (k, &a) in region.corners.iter().enumerate() {
                    let b = region.corners[(k + 1) % region.corners.len()];
                    for step in 0..POINTS {
                        let s = f64::from(step) / f64::from(POINTS);
                        points.push(([0, 1].map(|axis: usize| a[axis] + s * (b[axis] - a[axis])), outward));
                    }
                }
            }
        }
        points.retain(|(at, _)| size(*at) <= 1.0 && size(*at) >= lo * 0.5);
        points.sort_by(|(a, _), (b, _)| size(*a).total_cmp(&size(*b)));
        let range = |at: [f64; 2]| {
            let aim = Aim { dx: at[0], dy: at[1], ..aim };
            let exact = ExactRay::new(sensor, aim);
            referee.nearest(sensor, aim).first().map(|face| face.range(&exact))
        };
        points.iter().find_map(|&(at, outward)| {
            let beside = |sign: f64| [0, 1].map(|k: usize| at[k] + sign * BESIDE * outward[k]);
            let (inside, outside) = (beside(-1.0), beside(1.0));
            let jumps = match (range(inside), range(outside)) {
                (Some(a), Some(b)) => (a - b).abs() > JUMP * a.min(b),
                (a, b) => a.is_some() != b.is_some(),
            };
            let farther = if size(inside) > size(outside) { inside } else { outside };
            jumps.then_some(Displacement { dx: farther[0], dy: farther[1] })
        })
    }
}

/// -x.
fn negated(x: crate::number::Interval) -> crate::number::Interval {
    crate::number::Interval { low: -x.high, high: -x.low }
}
