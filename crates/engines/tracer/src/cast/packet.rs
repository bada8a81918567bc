//! Many rays from one point, which go through the tree together.
//!
//! Every lane computes what [`CastFace::crossing`] computes for a single ray, operation by operation: so the bits of a crossing are
//! the same, and a test holds that. A ray of a packet may be shown a face whose box it passes beside; but what it would meet
//! there lies in that box (`in_box`).

use std::ops::Range;

use glam::DVec3;
use raypencil_scene::{CastRay, Sides};

use super::frame::way_to;
use super::in_box::{doubtful_below, moved_into_box};
use super::traced::{CastFace, FirstMet};
use super::tree::CastTree;
use crate::lanes::{self, Instructions, Work};
use crate::tile::{BLOCK, BLOCKS, Block, Lanes, SeenFace, TILE, Tile, greatest_of};
use crate::wide_tree::{Next, Visitor, Waiting};

/// Most rays of a packet.
const PACKET: usize = TILE;

/// Fewer rays are quicker in turns. Tuned.
const FEWEST: usize = 8;

/// Rays whose unit directions differ by more than this in a component are no packet: together they would meet too many
/// boxes. Tuned.
const WIDEST: f64 = 0.15;

/// The place of no face.
const NOTHING: i64 = -1;

/// Neighbours whose directions differ by more than this share of the longest component do not go together. Tuned.
const LARGEST_TURN: f64 = 1.0 / 16.0;

/// How many of the first rays start in one point and turn little from one to the next: [`PACKET`] at most, and 0 if too few do.
pub(super) fn how_many_together(rays: &[CastRay]) -> usize {
    let goes_with = |pair: &&[CastRay]| {
        let [a, b] = [&pair[0], &pair[1]];
        let turn = (b.direction - a.direction).abs().max_element();
        a.origin == b.origin && turn <= LARGEST_TURN * a.direction.abs().max_element()
    };
    let count = 1 + rays.windows(2).take(PACKET - 1).take_while(goes_with).count();
    if count < FEWEST { 0 } else { count }
}

/// What is known of the rays of a block beside their directions.
#[derive(Debug, Clone, Copy)]
struct OfBlock {
    t_min: Lanes,
    t_max: Lanes,
    /// t of the given ray per t of the scaled one.
    t_per_t: Lanes,
    /// [`t_max`](Self::t_max), or -1 for rays that take no part now.
    limit: Lanes,
    /// The nearest t so far, of the given ray; infinite without a hit.
    t: Lanes,
    /// How far a hit would still count, scaled.
    way: Lanes,
    /// The face of that hit.
    face: [i64; BLOCK],
    /// Its place in the order of the tree, or [`NOTHING`].
    place: [i64; BLOCK],
}

const NO_RAYS: OfBlock = OfBlock {
    t_min: [0.0; BLOCK],
    t_max: [0.0; BLOCK],
    t_per_t: [1.0; BLOCK],
    limit: [-1.0; BLOCK],
    t: [f64::INFINITY; BLOCK],
    way: [0.0; BLOCK],
    face: [NOTHING; BLOCK],
    place: [NOTHING; BLOCK],
};

impl OfBlock {
    /// Puts a ray into a lane, whose scaled direction is `metres_per_t` long.
    fn put(&mut self, k: usize, ray: &CastRay, t_per_t: f64) {
        (self.t_min[k], self.t_max[k], self.t_per_t[k]) = (ray.t_min, ray.t_max, t_per_t);
        (self.t[k], self.face[k], self.place[k]) = (f64::INFINITY, NOTHING, NOTHING);
    }

    /// Lets the rays in the first 16 of `lanes` take part, and no others.
    #[inline(always)]
    fn begin(&mut self, rays: &Block, lanes: u64) {
        for k in 0..BLOCK {
            let takes_part = (lanes >> k) & 1 == 1;
            self.limit[k] = if takes_part { self.t_max[k] } else { -1.0 };
            let way = self.t_max[k] / self.t_per_t[k] * rays.metres_per_t[k];
            self.way[k] = if takes_part { way } else { 0.0 };
        }
    }

    /// Intersects the rays with a face and keeps the nearest hits. Returns whether any changed.
    #[inline(always)]
    fn update_closest(
        &mut self,
        [ab, bc, ca]: &[Lanes; 3],
        (rays, origin): (&Block, DVec3),
        (face, seen, place): (&CastFace, &SeenFace, i64),
        sides: Sides,
    ) -> bool {
        let both = sides == Sides::Both;
        let mut inside = [false; BLOCK];
        let mut any = false;
        for k in 0..BLOCK {
            let all_on_edges = (ab[k] == 0.0) & (bc[k] == 0.0) & (ca[k] == 0.0);
            let as_front = (ab[k] >= 0.0) & (bc[k] >= 0.0) & (ca[k] >= 0.0);
            let as_back = (ab[k] <= 0.0) & (bc[k] <= 0.0) & (ca[k] <= 0.0);
            inside[k] = (as_front | as_back) & !all_on_edges;
            any |= inside[k];
        }
        if !any {
            return false;
        }
        let [a, b, c] = face.corners;
        let normal = (b - a).cross(c - a);
        let n_dot_offset = normal.dot(seen.offset);
        let id = i64::from(face.id.0);
        let [dx, dy, dz] = &rays.direction;
        let doubtful = doubtful_below(face.corners, seen.offset);
        let (mut n_dot_q, mut scaled_t) = ([0.0; BLOCK], [0.0; BLOCK]);
        let mut any_doubtful = false;
        for k in 0..BLOCK {
            n_dot_q[k] = normal.dot(DVec3::new(dx[k], dy[k], dz[k]));
            scaled_t[k] = n_dot_offset / n_dot_q[k];
            any_doubtful |= inside[k] & (n_dot_q[k].abs() <= doubtful * rays.metres_per_t[k]);
        }
        if any_doubtful {
            for k in 0..BLOCK {
                if n_dot_q[k].abs() <= doubtful * rays.metres_per_t[k] {
                    let direction = DVec3::new(dx[k], dy[k], dz[k]);
                    scaled_t[k] = moved_into_box(scaled_t[k], face.corners, origin, direction);
                }
            }
        }
        let mut changed = false;
        for k in 0..BLOCK {
            let (n_dot_q, scaled_t) = (n_dot_q[k], scaled_t[k] + 0.0);
            let t = scaled_t * self.t_per_t[k];
            let counts = inside[k]
                & ((n_dot_q < 0.0) | both & (n_dot_q > 0.0))
                & (t >= self.t_min[k])
                & (t <= self.limit[k]);
            let is_nearer = (t < self.t[k]) | ((t == self.t[k]) & (id < self.face[k]));
            let is_new = counts & is_nearer;
            self.t[k] = if is_new { t } else { self.t[k] };
            self.way[k] = if is_new { scaled_t * rays.metres_per_t[k] } else { self.way[k] };
            self.face[k] = if is_new { id } else { self.face[k] };
            self.place[k] = if is_new { place } else { self.place[k] };
            changed |= is_new;
        }
        changed
    }
}

/// Up to [`PACKET`] rays from one point.
pub(super) struct Packet {
    tile: Tile,
    blocks: [OfBlock; BLOCKS],
    /// The point, where the boxes are.
    start: DVec3,
    /// Rays.
    count: usize,
    sides: Sides,
}

impl Packet {
    pub(super) const EMPTY: Self = Self {
        tile: Tile::EMPTY,
        blocks: [NO_RAYS; BLOCKS],
        start: DVec3::ZERO,
        count: 0,
        sides: Sides::Both,
    };

    /// Seeks the nearest hits of rays from one point. Says whether it could: they are too far away, or go too far apart.
    pub(super) fn seek(
        &mut self,
        tree: &CastTree,
        stack: &mut Vec<Waiting>,
        rays: &[CastRay],
        sides: Sides,
    ) -> bool {
        let Some(start) = tree.frame.start(rays[0].origin) else { return false };
        (self.start, self.count, self.sides) = (start, rays.len(), sides);
        self.tile.origin = rays[0].origin * tree.frame.scale;
        for (lane, ray) in rays.iter().enumerate() {
            let (direction, t_per_t) = tree.frame.scaled_direction(ray);
            self.tile.set_direction(lane, direction);
            self.blocks[lane / BLOCK].put(lane % BLOCK, ray, t_per_t);
        }
        lanes::run(Instructions::Detected, PacketWalk { packet: self, tree, stack })
    }

    /// The face of this tree that a ray meets first.
    pub(super) fn nearest<'t>(&self, lane: usize, tree: &'t CastTree) -> Option<FirstMet<'t>> {
        let of = &self.blocks[lane / BLOCK];
        let face = &tree.faces[usize::try_from(of.place[lane % BLOCK]).ok()?];
        Some(FirstMet { face, t: of.t[lane % BLOCK], side: face.side_towards(self.tile.q(lane)) })
    }

    /// Whether so few faces are met that a packet was quicker than its rays would have been in turns. Tuned.
    pub(super) fn was_worth_it(&self) -> bool {
        let place = |lane: usize| self.blocks[lane / BLOCK].place[lane % BLOCK];
        let changes = (1..self.count).filter(|&lane| place(lane) != place(lane - 1)).count();
        8 * changes <= 3 * self.count
    }

    /// Whether the directions of the rays that take part are too different.
    #[inline(always)]
    fn is_too_wide(&self) -> bool {
        (self.tile.greatest - self.tile.least).max_element() > WIDEST
    }

    /// How far any hit would still count.
    #[inline(always)]
    fn far(&self) -> f32 {
        let far = |k: usize| greatest_of(&self.blocks[k].way);
        way_to(far(0).max(far(1)).max(far(2).max(far(3))), 0.0)
    }
}

/// The walk of a packet.
struct PacketWalk<'a> {
    packet: &'a mut Packet,
    tree: &'a CastTree,
    stack: &'a mut Vec<Waiting>,
}

impl Work for PacketWalk<'_> {
    /// Whether the rays are near enough to each other.
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let Self { packet, tree, stack } = self;
        packet.tile.prepare();
        let mut left = u64::MAX >> (PACKET - packet.count);
        while left != 0 {
            let lanes = packet.tile.begin(left);
            if packet.is_too_wide() {
                return false;
            }
            left &= !lanes;
            for (k, of) in packet.blocks.iter_mut().enumerate() {
                of.begin(&packet.tile.blocks[k], lanes >> (k * BLOCK));
            }
            let mut bundle = packet.tile.bundle_from(packet.start, packet.far());
            tree.boxes.walk(stack, &mut bundle, &mut Seeker { packet, tree });
        }
        true
    }
}

/// Seeks the nearest hits in leaves.
struct Seeker<'a> {
    packet: &'a mut Packet,
    tree: &'a CastTree,
}

impl Visitor for Seeker<'_> {
    #[inline(always)]
    fn leaf(&mut self, entries: Range<usize>, bundle_far: &mut f32) -> Next {
        let Self { packet, tree } = self;
        for place in tree.places(entries) {
            let face = &tree.faces[place];
            let seen = SeenFace::new(face.corners, &packet.tile);
            if packet.tile.misses(&seen) {
                continue;
            }
            let mut changed = false;
            for k in 0..BLOCKS {
                if packet.tile.block_misses(k, &seen) {
                    continue;
                }
                let edges = packet.tile.block_edges(k, &seen);
                let rays = (&packet.tile.blocks[k], packet.tile.origin);
                let seen = (face, &seen, place as i64);
                changed |= packet.blocks[k].update_closest(&edges, rays, seen, packet.sides);
            }
            if changed {
                *bundle_far = packet.far();
            }
        }
        Next::On
    }
}
