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

use crate::traced_ray::TracedRay;
use crate::triangle::Triangle;
use crate::wide_tree::Bundle;

/// Rays of a block.
pub(crate) const BLOCK: usize = 16;

/// Blocks of a tile.
pub(crate) const BLOCKS: usize = 4;

/// Rays of a tile.
pub(crate) const TILE: usize = BLOCK * BLOCKS;

/// Relative to the lengths of two vertices' offsets from the origin: 2^-43, derived above.
const EDGE_MARGIN: f64 = 1.0 / (1u64 << 43) as f64;

/// 2^-900: more than products lose that are too small for f64.
pub(crate) const UNDERFLOW: f64 = f64::MIN_POSITIVE * (1_u128 << 122) as f64;

/// A number for each ray of a block.
pub(crate) type Lanes = [f64; BLOCK];

/// Sixteen rays of a tile, component by component.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Block {
    /// The rays' directions along x, y, z. Of a cell without a ray any direction but 0.
    pub(crate) direction: [Lanes; 3],
    /// Metres per unit of t.
    pub(crate) metres_per_t: Lanes,
    /// Which axis is the longest, and the way along it: 2 k, or 2 k + 1 for the negative way.
    way: Lanes,
    corners: Corners,
}

/// Four rays around others: their coordinates along the two shorter axes; the longest coordinate is 1 or -1.
#[derive(Debug, Clone, Copy)]
struct Corners {
    x: [f64; 4],
    y: [f64; 4],
}

/// Up to 64 rays from one point. Those that [take part](Tile::begin) run the same way along the same longest axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tile {
    pub(crate) origin: DVec3,
    pub(crate) blocks: [Block; BLOCKS],
    /// Rays that take part now, lane by lane.
    lanes: u64,
    /// Their [way](Block::way), and the axes that belong to it.
    way: f64,
    axes: [usize; 3],
    /// The sign of the longest axis.
    forward: f64,
    corners: Corners,
    /// Least and greatest components of their unit directions.
    pub(crate) least: DVec3,
    pub(crate) greatest: DVec3,
}

impl Tile {
    /// A tile of no rays.
    pub(crate) const EMPTY: Self = Self {
        origin: DVec3::ZERO,
        blocks: [Block {
            direction: [[1.0; BLOCK]; 3],
            metres_per_t: [1.0; BLOCK],
            way: [0.0; BLOCK],
            corners: Corners::of([0.0; 4]),
        }; BLOCKS],
        lanes: 0,
        way: 0.0,
        axes: [0, 1, 2],
        forward: 1.0,
        corners: Corners::of([0.0; 4]),
        least: DVec3::ZERO,
        greatest: DVec3::ZERO,
    };

    /// The direction of one ray: from its origin to the SPP, or to a point.
    #[inline(always)]
    pub(crate) fn q(&self, lane: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| self.blocks[lane / BLOCK].direction[k][lane % BLOCK]))
    }

    #[inline(always)]
    pub(crate) fn set_direction(&mut self, lane: usize, direction: DVec3) {
        for k in 0..3 {
            self.blocks[lane / BLOCK].direction[k][lane % BLOCK] = direction[k];
        }
    }

    /// Computes what else is known of the rays, once their directions are set.
    #[inline(always)]
    pub(crate) fn prepare(&mut self) {
        for Block { direction: [dx, dy, dz], metres_per_t, way, .. } in &mut self.blocks {
            for k in 0..BLOCK {
                let (x, y, z) = (dx[k], dy[k], dz[k]);
                metres_per_t[k] = DVec3::new(x, y, z).length();
                // As `TracedRay::axes_of` chooses.
                let of = |k: f64, component: f64| if component < 0.0 { 2.0 * k + 1.0 } else { 2.0 * k };
                let is_x = (x.abs() >= y.abs()) & (x.abs() >= z.abs());
                let is_y = y.abs() >= z.abs();
                way[k] = if is_x {
                    of(0.0, x)
                } else if is_y {
                    of(1.0, y)
                } else {
                    of(2.0, z)
                };
            }
        }
    }

    /// Lets those of the rays in `left` take part that run the way of the first of them: nearly always all. Returns their
    /// lanes.
    #[inline(always)]
    pub(crate) fn begin(&mut self, left: u64) -> u64 {
        let lead = left.trailing_zeros() as usize;
        let stand_in = self.q(lead);
        self.way = self.blocks[lead / BLOCK].way[lead % BLOCK];
        self.axes = TracedRay::axes_of(stand_in);
        let [kx, ky, kz] = self.axes;
        self.forward = if stand_in[kz] < 0.0 { -1.0 } else { 1.0 };
        self.lanes = 0;
        // Whatever does not take part counts as the first ray.
        let lead_unit = stand_in / stand_in.length();
        let lead_x = stand_in[kx] / stand_in[kz].abs();
        let lead_y = stand_in[ky] / stand_in[kz].abs();
        let mut bounds = [lead_x, lead_x, lead_y, lead_y];
        (self.least, self.greatest) = (lead_unit, lead_unit);
        for b in 0..BLOCKS {
            let of_left = (left >> (b * BLOCK)) & ((1 << BLOCK) - 1);
            let Block { direction, metres_per_t, way, corners } = &mut self.blocks[b];
            let mut part = [0_u64; BLOCK];
            for k in 0..BLOCK {
                part[k] = u64::from(way[k] == self.way) & (of_left >> k);
            }
            let mask = (0..BLOCK).fold(0, |mask, k| mask | (part[k] & 1) << k);
            self.lanes |= mask << (b * BLOCK);
            let mut units = [[0.0; BLOCK]; 3];
            let mut x = [0.0; BLOCK];
            let mut y = [0.0; BLOCK];
            for k in 0..BLOCK {
                let takes_part = part[k] & 1 == 1;
                for axis in 0..3 {
                    let unit = direction[axis][k] / metres_per_t[k];
                    units[axis][k] = if takes_part { unit } else { lead_unit[axis] };
                }
                let longest = direction[kz][k].abs();
                x[k] = if takes_part { direction[kx][k] / longest } else { lead_x };
                y[k] = if takes_part { direction[ky][k] / longest } else { lead_y };
            }
            let of_block = [least_of(&x), greatest_of(&x), least_of(&y), greatest_of(&y)];
            *corners = Corners::of(of_block);
            for axis in 0..3 {
                self.least[axis] = self.least[axis].min(least_of(&units[axis]));
                self.greatest[axis] = self.greatest[axis].max(greatest_of(&units[axis]));
            }
            bounds = [
                bounds[0].min(of_block[0]),
                bounds[1].max(of_block[1]),
                bounds[2].min(of_block[2]),
                bounds[3].max(of_block[3]),
            ];
        }
        self.corners = Corners::of(bounds);
        self.lanes
    }
}

impl Corners {
    /// Around those rays whose coordinates, divided by the longest, are within these bounds.
    #[inline(always)]
    const fn of([x_min, x_max, y_min, y_max]: [f64; 4]) -> Self {
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
    pub(crate) offset: DVec3,
}

impl SeenFace {
    #[inline(always)]
    pub(crate) fn new(vertices: [DVec3; 3], tile: &Tile) -> Self {
        let [kx, ky, kz] = tile.axes;
        let offsets = vertices.map(|v| v - tile.origin);
        let size = offsets.map(|v| v.abs()).iter().fold(DVec3::ZERO, |size, v| size.max(*v)).max_element();
        Self {
            seen: offsets.map(|v| [v[kx], v[ky], v[kz]]),
            margin: EDGE_MARGIN * (size * size) + UNDERFLOW,
            offset: offsets[0],
        }
    }
}

impl Tile {
    /// The rays for the boxes, of which the longest is `far` metres long.
    #[inline(always)]
    pub(crate) fn bundle(&self, far: f32) -> Bundle {
        self.bundle_from(self.origin, far)
    }

    /// The same where the boxes are moved, so that the rays start there.
    #[inline(always)]
    pub(crate) fn bundle_from(&self, start: DVec3, far: f32) -> Bundle {
        // Narrowing is monotonic too.
        let narrow = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
        Bundle::new(narrow(start), narrow(self.least), narrow(self.greatest), far)
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

    /// Whether no ray of a block meets a face.
    #[inline(always)]
    pub(crate) fn block_misses(&self, block: usize, face: &SeenFace) -> bool {
        self.blocks[block].corners.miss(self.forward, &face.seen, face.margin)
    }

    /// The rays of a block that pass inside all three edges of a face, or on them, whichever side it shows.
    #[inline(always)]
    pub(crate) fn inside(&self, block: usize, face: &SeenFace) -> u64 {
        if self.block_misses(block, face) {
            return 0;
        }
        let [ab, bc, ca] = self.block_edges(block, face);
        let mut inside = [0_u64; BLOCK];
        for k in 0..BLOCK {
            let as_front = (ab[k] >= 0.0) & (bc[k] >= 0.0) & (ca[k] >= 0.0);
            let as_back = (ab[k] <= 0.0) & (bc[k] <= 0.0) & (ca[k] <= 0.0);
            inside[k] = u64::from(as_front | as_back);
        }
        (0..BLOCK).fold(0, |mask, k| mask | inside[k] << k)
    }

    #[inline(always)]
    pub(crate) fn block_edges(&self, block: usize, face: &SeenFace) -> [Lanes; 3] {
        let rays = &self.blocks[block];
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
        let [ab, bc, ca] = self.block_edges(block, face);
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
}

impl Nearest {
    pub(crate) const NOTHING: Self =
        Self { t: [f64::INFINITY; BLOCK], face: [-1; BLOCK], limit: [-1.0; BLOCK] };

    /// Sets the limits of the rays in the first 16 of `lanes`; the others take no part from now on.
    #[inline(always)]
    pub(crate) fn begin(&mut self, lanes: u64, max_range: f64) {
        for k in 0..BLOCK {
            self.limit[k] = if (lanes >> k) & 1 == 1 { max_range } else { -1.0 };
        }
    }

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
pub(crate) fn greatest_of(of: &Lanes) -> f64 {
    let mut greatest = [f64::NEG_INFINITY; 4];
    for part in of.as_chunks::<4>().0 {
        for k in 0..4 {
            greatest[k] = if part[k] > greatest[k] { part[k] } else { greatest[k] };
        }
    }
    greatest[0].max(greatest[1]).max(greatest[2].max(greatest[3]))
}

#[cfg(test)]
#[path = "../tests/unit/tile.rs"]
mod tests;
