//! Unit tests of `tile`: whole tiles against an exhaustive search, ray by ray, with wide lanes and without.

use std::f64::consts::PI;

use proptest::prelude::*;
use raypencil_scene::{FaceId, Mesh};
use raypencil_terrain::RandomGround;

use super::*;
use crate::closest_hit::{ClosestHitTraverser, update_closest};
use crate::hierarchy::Hierarchy;
use crate::lanes::{self, Instructions, Work};
use crate::triangle::widen;

/// The closest hits of a tile's rays, as face and bits of t.
struct Hits<'a, 'h> {
    traverser: &'a mut ClosestHitTraverser<'h>,
    tile: Tile,
    active: u64,
    max_range: f64,
}

impl Work for Hits<'_, '_> {
    type Output = Vec<Option<(i64, u64)>>;

    #[inline(always)]
    fn run(mut self) -> Self::Output {
        let mut nearest = [Nearest::NOTHING; BLOCKS];
        self.tile.prepare();
        self.traverser.closest_hits(&mut self.tile, self.active, self.max_range, &mut nearest);
        let hit = |lane: usize| {
            let (of_block, k) = (&nearest[lane / BLOCK], lane % BLOCK);
            (of_block.face[k] >= 0).then(|| (of_block.face[k], of_block.t[k].to_bits()))
        };
        (0..TILE).map(hit).collect()
    }
}

fn exhaustive(mesh: &Mesh, ray: &TracedRay, max_range: f64) -> Option<(i64, u64)> {
    let mut closest = None;
    for index in 0..mesh.faces().len() as u32 {
        update_closest(&mut closest, &Triangle::of(mesh, FaceId(index)), ray, max_range);
    }
    closest.map(|hit| (i64::from(hit.triangle.face.0), hit.t.to_bits()))
}

/// A point on a face. `kind` 0: a vertex; 1: on an edge; others: inside.
fn point_on(mesh: &Mesh, face: usize, kind: u8, u: f64, v: f64) -> DVec3 {
    let [a, b, c] = mesh.faces()[face].map(|v| widen(mesh.vertices()[v as usize]));
    match kind {
        0 => a,
        1 => a + (b - a) * u,
        _ if u + v <= 1.0 => a + (b - a) * u + (c - a) * v,
        _ => a + (b - a) * (1.0 - u) + (c - a) * (1.0 - v),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 100, ..ProptestConfig::default() })]

    // Tiles from anywhere on needles, duplicates and nested faces, also far from the scene's origin. Kind 0: rays that run
    // close to one another, as a camera's do; 1: rays at vertices and edges all over the ground, which run along several
    // axes; 2: both. Some lanes take no part.
    #[test]
    fn every_ray_of_a_tile_finds_what_an_exhaustive_search_finds(
        seed in any::<u64>(),
        faces in 2usize..1500,
        local_offset in prop_oneof![Just(0.0f32), Just(3e4), Just(1e6)],
        kind in 0u8..3,
        aims in prop::collection::vec((any::<prop::sample::Index>(), 0u8..3, 0.0f64..1.0, 0.0f64..1.0), TILE),
        (z, turn, distance) in (-1.0f64..1.0, 0.0f64..1.0, 0.1f64..15.0),
        width in prop_oneof![Just(1e-12), Just(1e-3), Just(0.5)],
        length in prop_oneof![Just(0.01), Just(0.7), Just(3.0)],
        active in any::<u64>(),
    ) {
        let mesh = RandomGround::nasty(seed, faces).build().into_mesh().unwrap();
        let moved = mesh.vertices().iter().map(|[x, y, z]| [x + local_offset, *y, *z]).collect();
        let (of_faces, materials) = (mesh.face_materials().to_vec(), mesh.materials().to_vec());
        let mesh = Mesh::new(mesh.origin(), moved, mesh.faces().to_vec(), of_faces, materials).unwrap();
        let max_range = 20.0;
        let hierarchy = Hierarchy::build(&mesh, max_range);

        let target = |k: usize| {
            let (face, on, u, v) = &aims[k];
            point_on(&mesh, face.index(mesh.faces().len()), *on, *u, *v)
        };
        let (sin, cos) = libm::sincos(2.0 * PI * turn);
        let r = (1.0 - z * z).sqrt();
        let origin = target(0) + DVec3::new(r * cos, r * sin, z) * distance;
        let mut tile = Tile::EMPTY;
        tile.origin = origin;
        for (lane, (_, _, u, v)) in aims.iter().enumerate() {
            let beside = DVec3::new(u - 0.5, v - 0.5, u * v - 0.25) * width;
            let towards = if kind == 0 || kind == 2 && lane % 2 == 0 { target(0) + beside } else { target(lane) };
            let direction = (towards - origin).normalize_or(DVec3::Z) * length;
            tile.set_direction(lane, direction);
        }
        let mut traverser = ClosestHitTraverser::new(&hierarchy);
        for instructions in [Instructions::Detected, Instructions::Baseline] {
            let work = Hits { traverser: &mut traverser, tile, active, max_range };
            for (lane, hit) in lanes::run(instructions, work).into_iter().enumerate() {
                let ray = TracedRay::new(origin, tile.q(lane));
                let is_active = active & (1 << lane) != 0;
                let expected = if is_active { exhaustive(&mesh, &ray, max_range) } else { None };
                prop_assert_eq!(hit, expected, "lane {} with {:?}", lane, instructions);
            }
        }
    }
}

#[test]
fn a_refused_face_is_met_by_no_ray_of_a_block_however_narrow_the_margin() {
    // Corners of a rectangle around rays that pass an edge on its very line: 16 rays through points of one edge.
    let (a, b, c) = ([0.1f32, 0.2, 1.0], [0.9, 0.7, 1.3], [0.2, 0.9, 1.1]);
    let triangle = Triangle::new([a, c, b], FaceId(0));
    let mut tile = Tile::EMPTY;
    for lane in 0..TILE {
        let along = (lane as f64 + 0.5) / TILE as f64;
        tile.set_direction(lane, widen(a) + (widen(b) - widen(a)) * along);
    }
    tile.prepare();
    assert_eq!(tile.begin(u64::MAX), u64::MAX);
    let face = SeenFace::new(triangle.corners(), &tile);
    assert!(!tile.misses_front(&face) && !tile.misses(&face));
    for block in 0..BLOCKS {
        assert!(!tile.block_misses_front(block, &face));
        let meets = |k: usize| {
            let ray = TracedRay::new(tile.origin, tile.q(block * BLOCK + k));
            u64::from(triangle.intersect_either_side(&ray).is_some()) << k
        };
        assert_eq!(tile.inside(block, &face), (0..BLOCK).fold(0, |mask, k| mask | meets(k)));
    }
    // A face beside all of them is refused for all at once.
    let beside = Triangle::new([a, c, b].map(|[x, y, z]| [x - 2.0, y + 2.0, z]), FaceId(0));
    let seen = SeenFace::new(beside.corners(), &tile);
    assert!(tile.misses_front(&seen) && tile.misses(&seen));
    assert!(
        (0..BLOCKS).all(|block| tile.block_misses_front(block, &seen) && tile.block_misses(block, &seen))
    );
}

#[test]
fn a_way_is_twice_its_longest_axis_and_one_more_backwards() {
    let mut tile = Tile::EMPTY;
    let ways = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    for (lane, way) in ways.into_iter().enumerate() {
        tile.set_direction(lane, way + DVec3::new(0.25, -0.25, 0.25));
    }
    tile.prepare();
    assert_eq!(tile.blocks[0].way[..6], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    // Those that go one way are let take part together.
    tile.set_direction(7, DVec3::new(0.3, -0.9, 0.2));
    tile.prepare();
    assert_eq!(tile.begin(0b1011_1000), 0b1000_1000);
}

#[test]
fn of_equal_parts_the_first_is_the_longest_for_a_tile_and_for_a_ray() {
    for (direction, longest) in [
        ([1.0, 1.0, 0.5], 0),
        ([1.0, 0.5, 1.0], 0),
        ([0.5, 1.0, 1.0], 1),
        ([1.0, 1.0, 1.0], 0),
        ([0.5, 1.0, 0.5], 1),
        ([0.5, 0.5, 1.0], 2),
    ] {
        for signs in 0..8_u32 {
            let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
            let q = DVec3::from_array([0, 1, 2].map(|k| sign(k) * direction[k]));
            let mut tile = Tile::EMPTY;
            tile.set_direction(0, q);
            tile.prepare();
            assert_eq!(tile.blocks[0].way[0], (2 * longest) as f64 + f64::from(signs >> longest & 1), "{q}");
            assert_eq!(TracedRay::axes_of(q)[2], longest, "{q}");
        }
    }
}

#[test]
fn a_tile_is_beside_an_edge_only_with_all_its_corners() {
    for corners in 0..16_u32 {
        // A corner at the bound is not beyond it.
        let edge = [0, 1, 2, 3].map(|k| if corners >> k & 1 == 1 { 2.0 } else { 1.0 });
        assert_eq!(is_above(&edge, 1.0), corners == 15, "{corners:04b}");
        assert_eq!(is_below(&edge.map(|part| -part), -1.0), corners == 15, "{corners:04b}");
    }
}

#[test]
fn the_margin_of_a_face_grows_with_the_square_of_its_distance() {
    let corners = [DVec3::new(-3.0, 1.0, 2.0), DVec3::new(1.0, 8.0, -2.0), DVec3::new(4.0, 0.0, -7.0)];
    for far in [0.25, 1.0, 32.0] {
        let face = SeenFace::new(corners.map(|corner| corner * far), &Tile::EMPTY);
        assert_eq!(face.margin, EDGE_MARGIN * (64.0 * far * far) + UNDERFLOW);
    }
}
