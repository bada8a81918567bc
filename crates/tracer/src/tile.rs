//! Rays that start in one point, tested together: in lanes of four `f64` where the processor has them.
//!
//! Every lane computes what `triangle` computes for a single ray, operation by operation, without fused multiplication and
//! addition: so the bits are the same, whatever the number of lanes. What is added here only refuses faces that no ray of
//! a block can meet.
//!
//! # Refusing a face for a whole block
//!
//! Along the longest axis k of all rays, with `v` a vertex seen from the origin, the edge function of vertices a and b is
//! `q_k (m . q)` for a vector m that depends on the face alone: linear in q but for a factor of one sign. So where it is
//! negative for the four rays through the corners of a rectangle around all `q / |q_k|`, it is negative for all. As
//! computed, with u = 2^-53 and |.| the largest component, an edge function is off by at most
//!
//! ```text
//! each product of a projected coordinate    2 |v| |q| u each, and as much for their difference:   4 |v| |q| u
//! a product of two coordinates of 2 |v| |q|   (2 * 2 * 4 + 4) |a| |b| |q|^2 u                    20 |a| |b| |q|^2 u
//! the difference of two such products         2 * 20 + 8                                         48 |a| |b| |q|^2 u
//! ```
//!
//! and so is the one of a corner, with the corner's own |q| = 1. The corners' coordinates are quotients, each off by u, which
//! moves m . q by at most 6 |a| |b| u. Together less than 2^7 u: [`EDGE_MARGIN`] is eight times that.

use glam::{DVec3, Vec3A};

use crate::rays::TracedRay;
use crate::triangle::{Triangle, widen};
use crate::wide_tree::Bundle;

/// Rays of a block.
pub(crate) const BLOCK: usize = 16;

/// Blocks of a tile.
pub(crate) const BLOCKS: usize = 4;

/// Rays of a tile.
pub(crate) const TILE: usize = BLOCK * BLOCKS;

/// Relative to the lengths of two vertices' offsets from the origin: 2^-43, derived above.
const EDGE_MARGIN: f64 = 1.0 / (1u64 << 43) as f64;

/// A number for each ray of a block.
pub(crate) type Lanes = [f64; BLOCK];

/// Sixteen rays of a tile, component by component.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Block {
    /// The rays' directions along x, y, z.
    pub(crate) direction: [Lanes; 3],
    /// Metres per unit of t. Of a ray that does not take part, whatever.
    pub(crate) metres_per_t: Lanes,
    corners: Corners,
}

/// Four rays around others: their coordinates along the two shorter axes; the longest coordinate is 1 or -1.
#[derive(Debug, Clone, Copy)]
struct Corners {
    x: [f64; 4],
    y: [f64; 4],
}

/// Up to 64 rays from one point that run the same way along the same longest axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tile {
    pub(crate) origin: DVec3,
    pub(crate) axes: [usize; 3],
    /// The sign of the longest axis.
    forward: f64,
    pub(crate) blocks: [Block; BLOCKS],
    corners: Corners,
    /// Least and greatest components of the unit directions.
    least: DVec3,
    greatest: DVec3,
}

/// The directions of up to [`TILE`] rays, by component, before they are sorted by their longest axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Directions {
    pub(crate) components: [[Lanes; 3]; BLOCKS],
    /// Which lanes have a ray; the others have any direction but 0.
    pub(crate) active: u64,
}

impl Directions {
    pub(crate) const NONE: Self = Self { components: [[[1.0; BLOCK]; 3]; BLOCKS], active: 0 };

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, direction: DVec3) {
        for k in 0..3 {
            self.components[lane / BLOCK][k][lane % BLOCK] = direction[k];
        }
        self.active |= 1 << lane;
    }

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| self.components[lane / BLOCK][k][lane % BLOCK]))
    }

    /// Calls `visit` with the tiles of these rays, and the lanes of each: one tile, but where the longest axis changes.
    #[inline(always)]
    pub(crate) fn tiles(&self, origin: DVec3, mut visit: impl FnMut(&Tile, u64)) {
        let mut left = self.active;
        while left != 0 {
            let lead = left.trailing_zeros() as usize;
            let axes = TracedRay::axes_of(self.get(lead));
            let mut lanes = 0;
            for lane in 0..TILE {
                let same = TracedRay::axes_of(self.get(lane)) == axes;
                lanes |= u64::from(same) << lane;
            }
            lanes &= left;
            left &= !lanes;
            visit(&Tile::new(origin, axes, self, lanes, lead), lanes);
        }
    }
}

impl Corners {
    /// Around those rays whose coordinates, divided by the longest, are within these bounds.
    #[inline(always)]
    fn of([x_min, x_max, y_min, y_max]: [f64; 4]) -> Self {
        Self { x: [x_min, x_max, x_min, x_max], y: [y_min, y_min, y_max, y_max] }
    }

    /// The edge functions of a face as the corners see it.
    #[inline(always)]
    fn edges(&self, forward: f64, face: &[[f64; 3]; 3]) -> [[f64; 4]; 3] {
        edge_functions(&self.x, &self.y, &[forward; 4], face)
    }

    /// Whether no ray between the corners meets the front of a face.
    #[inline(always)]
    fn miss_front(&self, forward: f64, face: &[[f64; 3]; 3], margin: f64) -> bool {
        self.edges(forward, face).iter().any(|edge| is_below(edge, -margin))
    }

    /// Whether no ray between the corners meets a face.
    #[inline(always)]
    fn miss(&self, forward: f64, face: &[[f64; 3]; 3], margin: f64) -> bool {
        let edges = self.edges(forward, face);
        edges.iter().any(|edge| is_below(edge, -margin)) && edges.iter().any(|edge| is_above(edge, margin))
    }
}

#[inline(always)]
fn is_below(edge: &[f64; 4], bound: f64) -> bool {
    (edge[0] < bound) & (edge[1] < bound) & (edge[2] < bound) & (edge[3] < bound)
}

#[inline(always)]
fn is_above(edge: &[f64; 4], bound: f64) -> bool {
    (edge[0] > bound) & (edge[1] > bound) & (edge[2] > bound) & (edge[3] > bound)
}

/// The three edge functions of a face along rays: `triangle::intersect`, ray by ray. `face` holds its vertices as seen from
/// the rays' origin, in the order of the rays' axes.
#[inline(always)]
fn edge_functions<const N: usize>(
    qx: &[f64; N],
    qy: &[f64; N],
    qz: &[f64; N],
    [a, b, c]: &[[f64; 3]; 3],
) -> [[f64; N]; 3] {
    let mut edges = [[0.0; N]; 3];
    for k in 0..N {
        let project = |v: &[f64; 3]| (v[0] * qz[k] - v[2] * qx[k], v[1] * qz[k] - v[2] * qy[k]);
        let ((ax, ay), (bx, by), (cx, cy)) = (project(a), project(b), project(c));
        edges[0][k] = ax * by - ay * bx;
        edges[1][k] = bx * cy - by * cx;
        edges[2][k] = cx * ay - cy * ax;
    }
    edges
}

/// A face as a tile sees it.
pub(crate) struct SeenFace {
    /// Vertices from the rays' origin, in the order of the rays' axes.
    seen: [[f64; 3]; 3],
    /// How far below 0 an edge function must be to refuse the face for all rays between corners.
    margin: f64,
    /// The first vertex from the rays' origin, along x, y, z.
    offset: DVec3,
}

impl SeenFace {
    #[inline(always)]
    pub(crate) fn new(triangle: &Triangle, tile: &Tile) -> Self {
        let [kx, ky, kz] = tile.axes;
        let offsets = triangle.vertices.map(|v| widen(v) - tile.origin);
        let size = offsets.map(|v| v.abs()).iter().fold(DVec3::ZERO, |size, v| size.max(*v)).max_element();
        Self {
            seen: offsets.map(|v| [v[kx], v[ky], v[kz]]),
            margin: EDGE_MARGIN * (size * size),
            offset: offsets[0],
        }
    }
}

impl Tile {
    /// The rays in `lanes`, which have these `axes`; the others are as the one in lane `lead`, and take no part.
    #[inline(always)]
    fn new(origin: DVec3, axes: [usize; 3], directions: &Directions, lanes: u64, lead: usize) -> Self {
        let [kx, ky, kz] = axes;
        let stand_in = directions.get(lead);
        let forward = if stand_in[kz] < 0.0 { -1.0 } else { 1.0 };
        let no_bounds = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
        let no_block = Block {
            direction: [[1.0; BLOCK]; 3],
            metres_per_t: [1.0; BLOCK],
            corners: Corners::of([0.0; 4]),
        };
        let mut tile = Self {
            origin,
            axes,
            forward,
            blocks: [no_block; BLOCKS],
            corners: Corners::of([0.0; 4]),
            least: DVec3::INFINITY,
            greatest: DVec3::NEG_INFINITY,
        };
        let mut of_tile = no_bounds;
        for b in 0..BLOCKS {
            let mask = (lanes >> (b * BLOCK)) & ((1 << BLOCK) - 1);
            let Block { direction, metres_per_t, corners } = &mut tile.blocks[b];
            *direction = directions.components[b];
            if mask != (1 << BLOCK) - 1 {
                for lane in 0..BLOCK {
                    if mask & (1 << lane) == 0 {
                        for k in 0..3 {
                            direction[k][lane] = stand_in[k];
                        }
                    }
                }
            }
            let [dx, dy, dz] = &*direction;
            let mut units = [[0.0; BLOCK]; 3];
            let mut x = [0.0; BLOCK];
            let mut y = [0.0; BLOCK];
            let (qx, qy, qz) = (&direction[kx], &direction[ky], &direction[kz]);
            for lane in 0..BLOCK {
                let direction = DVec3::new(dx[lane], dy[lane], dz[lane]);
                metres_per_t[lane] = direction.length();
                let unit = direction / metres_per_t[lane];
                units[0][lane] = unit.x;
                units[1][lane] = unit.y;
                units[2][lane] = unit.z;
                x[lane] = qx[lane] / qz[lane].abs();
                y[lane] = qy[lane] / qz[lane].abs();
            }
            let bounds = [least_of(&x), greatest_of(&x), least_of(&y), greatest_of(&y)];
            *corners = Corners::of(bounds);
            tile.least = tile.least.min(DVec3::from_array([0, 1, 2].map(|k| least_of(&units[k]))));
            tile.greatest = tile.greatest.max(DVec3::from_array([0, 1, 2].map(|k| greatest_of(&units[k]))));
            of_tile = [
                of_tile[0].min(bounds[0]),
                of_tile[1].max(bounds[1]),
                of_tile[2].min(bounds[2]),
                of_tile[3].max(bounds[3]),
            ];
        }
        tile.corners = Corners::of(of_tile);
        tile
    }

    /// The rays for the boxes, of which the longest is `far` metres long.
    #[inline(always)]
    pub(crate) fn bundle(&self, far: f32) -> Bundle {
        // Narrowing is monotonic too.
        let narrow = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
        Bundle::new(narrow(self.origin), narrow(self.least), narrow(self.greatest), far)
    }

    /// Whether no ray of the tile meets the front of a face.
    #[inline(always)]
    pub(crate) fn misses_front(&self, face: &SeenFace) -> bool {
        self.corners.miss_front(self.forward, &face.seen, face.margin)
    }

    /// Whether no ray of the tile meets a face.
    #[inline(always)]
    pub(crate) fn misses(&self, face: &SeenFace) -> bool {
        self.corners.miss(self.forward, &face.seen, face.margin)
    }

    /// Whether no ray of a block meets the front of a face.
    #[inline(always)]
    pub(crate) fn block_misses_front(&self, block: usize, face: &SeenFace) -> bool {
        self.blocks[block].corners.miss_front(self.forward, &face.seen, face.margin)
    }

    /// The rays of a block that pass inside all three edges of a face, or on them, whichever side it shows.
    #[inline(always)]
    pub(crate) fn inside(&self, block: usize, face: &SeenFace) -> u64 {
        let rays = &self.blocks[block];
        if rays.corners.miss(self.forward, &face.seen, face.margin) {
            return 0;
        }
        let [ab, bc, ca] = self.block_edges(rays, face);
        let mut inside = [0_u64; BLOCK];
        for k in 0..BLOCK {
            let as_front = (ab[k] >= 0.0) & (bc[k] >= 0.0) & (ca[k] >= 0.0);
            let as_back = (ab[k] <= 0.0) & (bc[k] <= 0.0) & (ca[k] <= 0.0);
            inside[k] = u64::from(as_front | as_back);
        }
        (0..BLOCK).fold(0, |mask, k| mask | inside[k] << k)
    }

    #[inline(always)]
    fn block_edges(&self, rays: &Block, face: &SeenFace) -> [Lanes; 3] {
        let [kx, ky, kz] = self.axes;
        edge_functions(&rays.direction[kx], &rays.direction[ky], &rays.direction[kz], &face.seen)
    }

    /// Intersects the rays of a block with the front of a face and keeps the nearest hits: `triangle::intersect_front` and
    /// `closest_hit::update_closest`, ray by ray. Returns whether any changed.
    #[inline(always)]
    pub(crate) fn update_closest(
        &self,
        block: usize,
        face: &SeenFace,
        triangle: &Triangle,
        nearest: &mut Nearest,
    ) -> bool {
        let rays = &self.blocks[block];
        let [ab, bc, ca] = self.block_edges(rays, face);
        let mut inside = [false; BLOCK];
        let mut any = false;
        for k in 0..BLOCK {
            let all_on_edges = (ab[k] == 0.0) & (bc[k] == 0.0) & (ca[k] == 0.0);
            inside[k] = (ab[k] >= 0.0) & (bc[k] >= 0.0) & (ca[k] >= 0.0) & !all_on_edges;
            any |= inside[k];
        }
        if !any {
            return false;
        }
        let normal = triangle.normal();
        let n_dot_offset = normal.dot(face.offset);
        let id = i64::from(triangle.face.0);
        let [dx, dy, dz] = &rays.direction;
        let mut changed = false;
        for k in 0..BLOCK {
            let n_dot_q = normal.dot(DVec3::new(dx[k], dy[k], dz[k]));
            let t = n_dot_offset / n_dot_q;
            let counts =
                inside[k] & (n_dot_q < 0.0) & (t >= 1.0) & (t * rays.metres_per_t[k] <= nearest.limit[k]);
            let is_nearer = (t < nearest.t[k]) | ((t == nearest.t[k]) & (id < nearest.face[k]));
            let is_new = counts & is_nearer;
            nearest.t[k] = if is_new { t } else { nearest.t[k] };
            nearest.face[k] = if is_new { id } else { nearest.face[k] };
            changed |= is_new;
        }
        changed
    }
}

/// The nearest hits so far of the rays of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    /// Infinite where nothing is hit yet.
    pub(crate) t: Lanes,
    /// -1 where nothing is hit yet.
    pub(crate) face: [i64; BLOCK],
    /// Maximum range, metres; negative for rays that take no part.
    pub(crate) limit: Lanes,
    /// Of the ray.
    pub(crate) metres_per_t: Lanes,
}

impl Nearest {
    pub(crate) const NOTHING: Self = Self {
        t: [f64::INFINITY; BLOCK],
        face: [-1; BLOCK],
        limit: [-1.0; BLOCK],
        metres_per_t: [1.0; BLOCK],
    };

    /// The largest range at which a hit would still count, metres.
    #[inline(always)]
    pub(crate) fn far(&self, rays: &Block) -> f64 {
        let mut far = [0.0; BLOCK];
        for k in 0..BLOCK {
            let range = self.t[k] * rays.metres_per_t[k];
            far[k] = if range < self.limit[k] { range } else { self.limit[k] };
        }
        greatest_of(&far)
    }
}

#[inline(always)]
fn least_of(of: &Lanes) -> f64 {
    let mut least = [f64::INFINITY; 4];
    for part in of.as_chunks::<4>().0 {
        for k in 0..4 {
            least[k] = if part[k] < least[k] { part[k] } else { least[k] };
        }
    }
    least[0].min(least[1]).min(least[2].min(least[3]))
}

#[inline(always)]
fn greatest_of(of: &Lanes) -> f64 {
    let mut greatest = [f64::NEG_INFINITY; 4];
    for part in of.as_chunks::<4>().0 {
        for k in 0..4 {
            greatest[k] = if part[k] > greatest[k] { part[k] } else { greatest[k] };
        }
    }
    greatest[0].max(greatest[1]).max(greatest[2].max(greatest[3]))
}
