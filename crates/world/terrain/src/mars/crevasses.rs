//! Crevasses: winding cracks in any direction, with walls of their own, which may overhang.
//!
//! A crevasse is a course (a line of nodes), and an opening about it that closes at both ends. No two openings touch:
//! each crevasse keeps away from the earlier ones, from the middle of the ground and from its border.
//!
//! The heading of a course is theta(s) = theta_0 + sum of a_i sin(k_i s + phi_i), s metres along it. Two bounds keep
//! the opening from meeting itself. The a_i add up to less than 45 degrees, so that a course never comes back beside
//! itself: no chord can be perpendicular to it at both ends. And the curvature, at most the sum of a_i k_i, times half
//! the width stays below [`MAX_TURN`].

use glam::DVec2;

use crate::random_stream::{RandomStream, StreamPurpose};

/// Number and size of the crevasses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crevasses {
    /// Number of crevasses; each runs in a direction of its own.
    pub count: u32,
    /// Width from edge to edge at the widest place, metres.
    pub width: f64,
    /// Depth from the lower edge to the floor at the deepest place, metres.
    pub depth: f64,
    /// Largest distance that a wall recedes under its edge, metres; 0 for no overhang.
    pub overhang: f64,
}

/// Waves of the heading: amplitude in radians, and length in metres. CHOICE.
const WAVES: [(f64, f64); 3] = [(0.35, 20.0), (0.22, 8.0), (0.18, 3.5)];

/// Largest curvature times half the width of what the crevasse takes below ground; also the largest turn of the course
/// from one node to the next, radians.
const MAX_TURN: f64 = 0.5;

/// Largest sum of a_i k_i of [`WAVES`], per metre, with the shortest waves that are drawn: 0.606 / 0.8.
const MAX_CURVATURE_PER_M: f64 = 0.76;

/// Distance along the course over which an edge or a wall changes its shape, metres. CHOICE.
const RAGGED_M: f64 = 0.5;

/// Size of the bulges of walls, half widths. CHOICE.
const BULGE: f64 = 0.3;

/// Range of the lengths of courses, relative to the shorter side of the ground.
const LENGTH: [f64; 2] = [0.45, 0.85];

/// Number of places that are tried for a crevasse. After each [`TRIES_PER_LENGTH`] of them it gets shorter.
const MAX_TRIES: u32 = 96;
const TRIES_PER_LENGTH: u32 = 8;

/// Number of discs that stand for a course when its place is tried.
const DISCS: usize = 64;

/// The ground that crevasses are drawn on, about the origin.
pub(super) struct Field {
    /// Extent along x and along y, metres.
    pub extent: DVec2,
    /// Distance between posts along x and along y, metres.
    pub spacing: DVec2,
    /// Radius about the middle that stays free, metres.
    pub free_radius: f64,
}

impl Crevasses {
    /// Distance from a course up to which its crevasse takes the ground, above and below, metres.
    fn reach(&self) -> f64 {
        0.5 * self.width + self.overhang
    }

    /// Crevasses on a ground: as many as there are places for, at most `count`.
    pub(super) fn draw(&self, field: &Field, seed: u64) -> Vec<Crevasse> {
        let mut random = RandomStream::new(seed, StreamPurpose::Crevasses);
        let mut found: Vec<Crevasse> = Vec::new();
        while found.len() < self.count as usize {
            let mut length = field.extent.min_element() * random.between(LENGTH[0], LENGTH[1]);
            let mut tries = (0..MAX_TRIES).map(|attempt| {
                if attempt > 0 && attempt % TRIES_PER_LENGTH == 0 {
                    length *= 0.75;
                }
                Crevasse::draw(*self, field, length, &mut random)
            });
            let Some(crevasse) = tries.find(|one| one.fits(field, &found)) else { break };
            found.push(crevasse);
        }
        found
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Crevasse {
    settings: Crevasses,
    /// Nodes of the course, from end to end, about the middle of the ground, metres.
    pub nodes: Vec<DVec2>,
    /// Unit vectors to the left of the course at the nodes.
    left: Vec<DVec2>,
    /// Fraction of the half width that the right and the left edge take at each node: edges are ragged.
    edge_shares: Vec<[f64; 2]>,
    /// How far the right and the left wall bulge at each node, -0.5 to 0.5.
    bulges: Vec<[f64; 2]>,
    /// Phase of the unevenness of the floor, radians.
    floor_phase: f64,
}

impl Crevasse {
    fn draw(settings: Crevasses, field: &Field, length: f64, random: &mut RandomStream) -> Self {
        // As close as posts, and enough of them for the shape of a short one.
        let step = field.spacing.min_element().min(length / 12.0);
        let steps = (length / step).ceil();
        let step = length / steps;
        // Wide crevasses, and those of few nodes, wind in longer waves.
        let stretch = (MAX_CURVATURE_PER_M * settings.reach().max(step) / MAX_TURN).max(1.0);
        let waves = WAVES.map(|(amplitude, wavelength)| {
            let wavelength = wavelength * stretch * random.between(0.8, 1.25);
            (amplitude, std::f64::consts::TAU / wavelength, random.between(0.0, std::f64::consts::TAU))
        });
        let mean = random.between(0.0, std::f64::consts::TAU);
        let heading = |along: f64| {
            let turned: f64 = waves
                .iter()
                .map(|(amplitude, number, phase)| amplitude * libm::sin(number * along + phase))
                .sum();
            let (sin, cos) = libm::sincos(mean + turned);
            DVec2::new(cos, sin)
        };
        let steps = steps as usize;
        let mut nodes = Vec::with_capacity(steps + 1);
        nodes.push(DVec2::ZERO);
        for k in 0..steps {
            nodes.push(nodes[k] + heading((k as f64 + 0.5) * step) * step);
        }
        let left = (0..=steps).map(|k| heading(k as f64 * step).perp()).collect();
        let half = 0.5 * field.extent;
        let centre = DVec2::new(random.between(-half.x, half.x), random.between(-half.y, half.y));
        let shift = centre - 0.5 * (nodes[0] + nodes[steps]);
        nodes.iter_mut().for_each(|node| *node += shift);
        let knots = (RAGGED_M / step).ceil().max(1.0);
        let mut ragged = || {
            let values: Vec<f64> =
                (0..=(steps as f64 / knots) as usize + 2).map(|_| random.uniform()).collect();
            move |node: usize| {
                let at = node as f64 / knots;
                let (knot, t) = (at as usize, at.fract());
                values[knot] + (values[knot + 1] - values[knot]) * (t * t * (3.0 - 2.0 * t))
            }
        };
        let [right, left_edge] = [ragged(), ragged()];
        let bulges = [ragged(), ragged()];
        let edge_shares = (0..=steps).map(|node| [0.75 + 0.25 * right(node), 0.75 + 0.25 * left_edge(node)]);
        let edge_shares = edge_shares.collect();
        let bulges = (0..=steps).map(|node| [0, 1].map(|side| bulges[side](node) - 0.5)).collect();
        Self { settings, nodes, left, edge_shares, bulges, floor_phase: waves[0].2 }
    }

    /// Whether it is on the ground, and away from the middle and from the earlier ones.
    fn fits(&self, field: &Field, earlier: &[Self]) -> bool {
        let reach = self.settings.reach();
        let border = 0.5 * field.extent - DVec2::splat(reach + 0.3 * field.spacing.length());
        let (discs, radius) = self.discs();
        // The discs are wider than the crevasse, by half of the distance between them.
        self.nodes.iter().all(|node| node.abs().cmple(border).all())
            && discs.iter().all(|disc| disc.length() > radius + field.free_radius)
            && earlier.iter().all(|other| {
                let (others, other_radius) = other.discs();
                // Half a width of ground between them.
                let least = radius + other_radius + 0.5 * self.settings.width;
                discs.iter().all(|disc| others.iter().all(|o| disc.distance(*o) > least))
            })
    }

    /// Centres and radius of discs that cover the crevasse.
    fn discs(&self) -> (Vec<DVec2>, f64) {
        let stride = self.nodes.len().div_ceil(DISCS).max(1);
        let last = self.nodes.len() - 1;
        let centres = (0..last).step_by(stride).chain([last]).map(|node| self.nodes[node]).collect();
        // Any point of the course is within half a stride of one of them, along the course.
        let step = self.nodes[0].distance(self.nodes[1]);
        (centres, self.settings.reach() + 0.5 * stride as f64 * step)
    }

    /// Number of the last node; the crevasse is closed at the first and at the last.
    pub(super) fn last(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Factor on the opening: 1 along most of the crevasse, 0 at its ends.
    fn taper(&self, node: usize) -> f64 {
        let t = 2.0 * node as f64 / self.last() as f64 - 1.0;
        1.0 - t * t * t * t
    }

    /// Largest distance of an edge from the course, metres.
    pub(super) fn max_half_width(&self) -> f64 {
        0.5 * self.settings.width
    }

    /// Place of a point on a wall or an edge, about the middle of the ground, metres. `side` is -1 for the right wall
    /// and 1 for the left; `down` runs from 0 at the edge to 1 at the floor.
    pub(super) fn wall(&self, node: usize, side: f64, down: f64) -> DVec2 {
        let taper = self.taper(node);
        let index = usize::from(side > 0.0);
        let edge = 0.5 * self.settings.width * taper * self.edge_shares[node][index];
        // Walls approach by a quarter towards the floor; between edge and floor they recede where they overhang, and
        // bulge a little in and out: a wave from edge to floor.
        let wave = 4.0 * down * (1.0 - down) * (1.0 - 2.0 * down);
        let under = self.settings.overhang * taper * 4.0 * down * (1.0 - down)
            + BULGE * edge * self.bulges[node][index] * wave;
        self.nodes[node] + self.left[node] * (side * (edge * (1.0 - 0.25 * down * down) + under))
    }

    /// Depth from the lower edge to the floor at a node, metres.
    pub(super) fn depth(&self, node: usize) -> f64 {
        // The depth varies along the crevasse, so that the floor is not level.
        let along = node as f64 * self.nodes[0].distance(self.nodes[1]);
        let uneven = 0.85 + 0.15 * libm::sin(2.3 * along + self.floor_phase);
        self.settings.depth * self.taper(node) * uneven
    }

    /// Whether a disc of that radius about a place would reach an edge or an overhang.
    pub(super) fn overlaps_disc(&self, place: DVec2, radius: f64) -> bool {
        let (discs, cover) = self.discs();
        let near = discs.iter().any(|disc| disc.distance(place) < cover + radius);
        let reach = self.settings.reach() + radius;
        near && self.nodes.windows(2).any(|ends| distance_to_segment(place, [ends[0], ends[1]]) < reach)
    }
}

/// Distance of a place from a line between two ends.
pub(super) fn distance_to_segment(place: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let along = to - from;
    let share = ((place - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    place.distance(from + along * share)
}

#[cfg(test)]
#[path = "../../tests/unit/mars/crevasses.rs"]
mod tests;
