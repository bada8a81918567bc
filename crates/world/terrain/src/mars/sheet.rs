//! Sheet of faces over the posts: cells of three sizes, cut open at the crevasses.
//!
//! A cell of level n has 2^n x 2^n squares of two faces. Where a cell meets a finer one, its side has the posts of the
//! finer one, and its faces become a fan about its middle: so there is no gap between the levels. About a crevasse the
//! cells are left out, and [`super::cut`] fills the ground between them and the edges.

use super::corridor::Corridor;
use super::crevasses::Crevasse;
use super::cut;
use super::relief::Relief;
use super::sheet_posts::{FINE_STEPS, SheetMaterials, SheetPosts, Side, cells_of};
use crate::Ground;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Adds the sheet to a ground without faces.
pub(super) fn add(
    ground: &mut Ground,
    relief: &Relief,
    crevasses: &[Crevasse],
    materials: &SheetMaterials,
    seed: u64,
) {
    let corridor = Corridor::new(relief, crevasses);
    let mut posts = SheetPosts::new(ground, relief, &corridor);
    let mut diagonals = RandomStream::new(seed, StreamPurpose::Diagonals);
    let mut fine_diagonals = RandomStream::new(seed, StreamPurpose::FineDiagonals);
    let cells = cells_of(relief);
    for row in 0..cells[1] {
        for column in 0..cells[0] {
            let cell = [column, row];
            // Drawn for every cell, so that a crevasse or a fine cell leaves the others as they are.
            let falling = diagonals.coin();
            if corridor.has_cell(cell) {
                continue;
            }
            let level = relief.level(cell);
            let is_fine = level > 0 || Side::ALL.iter().any(|&side| posts.side_level(cell, side) > level);
            if !is_fine {
                let corners = Side::ALL.map(|side| posts.number(ground, side.start(cell)));
                add_square(ground, corners, falling, materials.soil);
            } else if Side::ALL.iter().all(|&side| posts.side_level(cell, side) == level) {
                let step = FINE_STEPS >> level;
                let first = cell.map(|index| index * FINE_STEPS);
                for j in 0..1 << level {
                    for i in 0..1 << level {
                        let [x, y] = [first[0] + i * step, first[1] + j * step];
                        let corners = [[x, y], [x + step, y], [x + step, y + step], [x, y + step]];
                        let corners = corners.map(|post| posts.number(ground, post));
                        add_square(ground, corners, fine_diagonals.coin(), materials.soil);
                    }
                }
            } else {
                let around: Vec<u32> =
                    Side::ALL.iter().flat_map(|&side| posts.side(ground, cell, side)).collect();
                let middle = cell.map(|index| index * FINE_STEPS + FINE_STEPS / 2);
                let middle = posts.number(ground, middle);
                for k in 0..around.len() {
                    ground.add_face([middle, around[k], around[(k + 1) % around.len()]], materials.soil);
                }
            }
        }
    }
    cut::add(ground, relief, crevasses, &corridor, &mut posts, materials);
}

/// Adds the two faces of a square: its corners counter-clockwise from the near left one. A falling diagonal runs from
/// the far left to the near right corner.
fn add_square(ground: &mut Ground, [a, b, c, d]: [u32; 4], falling: bool, material: u16) {
    let halves = if falling { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
    halves.into_iter().for_each(|half| ground.add_face(half, material));
}
