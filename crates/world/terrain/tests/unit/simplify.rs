//! Bound, borders and cracks of simplified grounds, by evaluations independent of the algorithm.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::ground::tests::normal;
use crate::height_at;
use crate::height_grid::tests::plain;

/// Posts 1 m apart with these heights.
fn posts(columns: u32, rows: u32, height: impl Fn(u32, u32) -> f64) -> HeightGrid {
    let heights = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let heights = heights.map(|(column, row)| height(column, row)).collect();
    HeightGrid { columns, rows, corner: DVec2::ZERO, spacing: DVec2::ONE, heights }
}

#[test]
fn a_plane_is_two_faces() {
    // 9 x 9 posts are one square of 8 x 8 cells; two faces meet z = x / 4 - y exactly.
    let plane = posts(9, 9, |column, row| 0.25 * f64::from(column) - f64::from(row));
    let ground = simplify(&plane, 1e-6, plain());
    assert_eq!((ground.faces.len(), ground.vertices.len()), (2, 4));
    assert!(ground.faces.iter().all(|&face| normal(&ground, face).z > 0.0));
    // The bound is strict: below the rounding of the plane every cell stays.
    assert_eq!(simplify(&plane, 1e-16, plain()).faces.len(), 128);
}

#[test]
fn a_bump_is_kept_where_it_exceeds_the_bound() {
    // A single post of 0.1 m on a plane of 8 x 8 cells.
    let bump = posts(9, 9, |column, row| if (column, row) == (3, 5) { 0.1 } else { 0.0 });
    assert_eq!(simplify(&bump, 0.11, plain()).faces.len(), 2);
    let kept = simplify(&bump, 0.09, plain());
    assert!((8..64).contains(&kept.faces.len()), "{}", kept.faces.len());
    let mesh = kept.into_mesh().unwrap();
    assert_eq!(height_at(&mesh, 3.0, 5.0), Some(f64::from(0.1_f32)));
    assert_eq!(height_at(&mesh, 0.0, 8.0), Some(0.0));
}

#[test]
fn grids_of_any_shape() {
    for (columns, rows) in [(2, 2), (2, 9), (700, 3), (5, 4), (1, 7), (3, 1), (258, 300)] {
        let flat = posts(columns, rows, |_, _| 1.5);
        let ground = simplify(&flat, 0.01, plain());
        let area: f64 = ground.faces.iter().map(|&face| normal(&ground, face).z / 2.0).sum();
        assert_eq!(area, f64::from((columns - 1) * (rows - 1)), "{columns} x {rows}");
    }
}

#[test]
fn a_strip_of_a_row_of_cells_cannot_be_simplified() {
    // The only squares of one row of cells are the cells.
    assert_eq!(simplify(&posts(2, 9, |_, _| 0.0), 1.0, plain()).faces.len(), 16);
}

/// Distance between the surface of a mesh and that of its ground at a post, at most, metres. Each vertex is
/// rounded to f32 offsets by half an ulp, 2^-24 of the coordinate. This moves the surface up or down by the
/// rounding of z and, along its slope, of x and y. The last term covers the evaluation of the height in f64.
fn f32_allowance(ground: &Ground, mesh_origin: DVec3) -> f64 {
    let half_ulp = 0.5_f64 / 8_388_608.0;
    let reach = ground.vertices.iter().fold(DVec3::ZERO, |most, v| most.max((*v - mesh_origin).abs()));
    let slope = ground.faces.iter().fold(0.0_f64, |most, &face| {
        let n = normal(ground, face);
        most.max((n.x.abs() + n.y.abs()) / n.z)
    });
    1.001 * half_ulp * (reach.z + slope * reach.x.max(reach.y)) + 1e-12
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 160, failure_persistence: None, ..Default::default() })]

    #[test]
    fn the_bound_the_holes_and_no_cracks(
        columns in 2_u32..40,
        rows in 2_u32..40,
        seed: u64,
        waves in 0.0..4.0,
        rough in prop_oneof![Just(0.0), 0.0..0.5],
        unknown in prop_oneof![Just(0_u64), 1_u64..200],
        max_error in prop_oneof![0.001..0.05, 0.05..2.0],
        offset in prop_oneof![Just(0.0), Just(1e3), Just(1e6)],
        spacing in 0.1..3.0,
    ) {
        // Mixed bits: any numbers will do. (Vigna, splitmix64)
        let draw = |index: u64| {
            let mut z = (seed ^ index).wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        };
        let mut posts = posts(columns, rows, |column, row| {
            let index = u64::from(row * columns + column);
            if draw(index) % 1000 < unknown {
                return f64::NAN;
            }
            let (x, y) = (f64::from(column) / 7.0, f64::from(row) / 5.0);
            waves * (libm::sin(x) + libm::cos(y)) + rough * (draw(index + 10_000) % 1000) as f64 / 1000.0
        });
        posts.corner = DVec2::new(offset, -0.3 * offset);
        posts.spacing = DVec2::new(spacing, 1.25 * spacing);
        let ground = simplify(&posts, max_error, plain());
        let whole = posts.ground(plain());
        prop_assert!(ground.faces.len() <= whole.faces.len());
        prop_assert!(ground.vertices.iter().all(|v| whole.vertices.contains(v)), "vertices are posts");
        prop_assert!(ground.faces.iter().all(|&face| normal(&ground, face).z > 0.0));
        prop_assert_eq!(&simplify(&posts, max_error, plain()), &ground);

        // No cracks: each edge belongs to two faces, one in each direction, or to one face and the border of the
        // ground. The cells on both sides tell which edges are inside the ground.
        let mut edges = BTreeMap::new();
        for &[a, b, c] in &ground.faces {
            for edge in [[a, b], [b, c], [c, a]] {
                prop_assert!(edges.insert(edge, ()).is_none(), "an edge twice the same way");
            }
        }
        let cell_size = posts.spacing.x * posts.spacing.y;
        let cells = (whole.faces.len() / 2) as f64;
        let area: f64 = ground.faces.iter().map(|&face| normal(&ground, face).z / 2.0).sum();
        prop_assert!((area - cells * cell_size).abs() <= 1e-6 * (1.0 + cells * cell_size), "{area}");
        let border: f64 = edges
            .keys()
            .filter(|[a, b]| !edges.contains_key(&[*b, *a]))
            .map(|[a, b]| (ground.vertices[*a as usize] - ground.vertices[*b as usize]).truncate().length())
            .sum();
        let mut whole_edges = BTreeMap::new();
        for &[a, b, c] in &whole.faces {
            whole_edges.extend([([a, b], ()), ([b, c], ()), ([c, a], ())]);
        }
        let whole_border: f64 = whole_edges
            .keys()
            .filter(|[a, b]| !whole_edges.contains_key(&[*b, *a]))
            .map(|[a, b]| (whole.vertices[*a as usize] - whole.vertices[*b as usize]).truncate().length())
            .sum();
        // A crack would be border, too: equal lengths mean that there is none.
        prop_assert!((border - whole_border).abs() <= 1e-6 * (1.0 + border), "{border} and {whole_border}");

        // The bound, by the height of the finished mesh at each post; and the same holes.
        if ground.faces.is_empty() {
            return Ok(());
        }
        let allowance = f32_allowance(&ground, raypencil_scene::Mesh::origin_for(&ground.vertices));
        let inner = |v: &DVec3| {
            // Just inside the border, which rounding to f32 may have moved.
            let middle = posts.corner + posts.spacing * DVec2::new(f64::from(columns - 1), f64::from(rows - 1)) / 2.0;
            v.truncate() + (middle - v.truncate()) * 1e-12
        };
        let mesh = ground.into_mesh().unwrap();
        for vertex in &whole.vertices {
            let place = inner(vertex);
            // On a border, f32 rounding may leave no ground below the post.
            let Some(z) = height_at(&mesh, place.x, place.y) else { continue };
            let far = (z - vertex.z).abs();
            prop_assert!(far <= max_error + allowance, "{far} at {vertex}, allowed {max_error} + {allowance}");
        }
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let cell = DVec2::new(f64::from(column) + 0.4, f64::from(row) + 0.3);
                let place = posts.corner + posts.spacing * cell;
                let is_there = height_at(&mesh, place.x, place.y).is_some();
                prop_assert_eq!(is_there, posts.is_complete(column, row), "cell {} {}", column, row);
            }
        }
    }
}
