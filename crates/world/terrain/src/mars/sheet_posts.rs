//! Vertices of the sheet's posts, and the sides of its cells.

use super::corridor::Corridor;
use super::relief::{LEVELS, Relief};
use crate::Ground;

/// Posts of the finest level from one post of level 0 to the next.
pub(super) const FINE_STEPS: u32 = 1 << (LEVELS - 1);

pub(super) struct SheetMaterials {
    pub soil: u16,
    pub wall: u16,
}

/// Cells of level 0 along x and y.
pub(super) fn cells_of(relief: &Relief) -> [u32; 2] {
    [relief.posts.columns - 1, relief.posts.rows - 1]
}

/// Side of a cell; counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Near,
    Right,
    Far,
    Left,
}

impl Side {
    pub(super) const ALL: [Self; 4] = [Self::Near, Self::Right, Self::Far, Self::Left];

    /// The corner of a cell from which the side starts, counted in posts of the finest level.
    pub(super) fn start(self, [column, row]: [u32; 2]) -> [u32; 2] {
        let [right, far] = match self {
            Self::Near => [0, 0],
            Self::Right => [1, 0],
            Self::Far => [1, 1],
            Self::Left => [0, 1],
        };
        [(column + right) * FINE_STEPS, (row + far) * FINE_STEPS]
    }

    /// Direction from its start to its end.
    fn direction(self) -> [i32; 2] {
        match self {
            Self::Near => [1, 0],
            Self::Right => [0, 1],
            Self::Far => [-1, 0],
            Self::Left => [0, -1],
        }
    }

    /// The cell on the other side; `None` on the border of the ground.
    pub(super) fn neighbour(self, cell: [u32; 2], cells: [u32; 2]) -> Option<[u32; 2]> {
        let [x, y] = match self {
            Self::Near => [0, -1],
            Self::Right => [1, 0],
            Self::Far => [0, 1],
            Self::Left => [-1, 0],
        };
        let other = [cell[0].checked_add_signed(x)?, cell[1].checked_add_signed(y)?];
        (other[0] < cells[0] && other[1] < cells[1]).then_some(other)
    }
}

/// Vertex numbers of the posts of a sheet. Posts of the fine levels become vertices when they are first asked for.
pub(super) struct SheetPosts<'a> {
    relief: &'a Relief,
    corridor: &'a Corridor,
    /// Vertex of each post of level 0; [`NO_VERTEX`] for those in a corridor.
    coarse: Vec<u32>,
    /// Vertices of the other posts, in the window of the fine levels.
    fine: Vec<u32>,
    /// First post and number of posts of the window, counted in posts of the finest level.
    window: [[u32; 2]; 2],
}

const NO_VERTEX: u32 = u32::MAX;

impl<'a> SheetPosts<'a> {
    /// Adds the vertices of level 0.
    pub(super) fn new(ground: &mut Ground, relief: &'a Relief, corridor: &'a Corridor) -> Self {
        let posts = &relief.posts;
        let mut coarse = Vec::with_capacity(posts.heights.len());
        for row in 0..posts.rows {
            for column in 0..posts.columns {
                coarse.push(match corridor.has_post([column, row]) {
                    true => NO_VERTEX,
                    false => ground.add_vertex(posts.at(column, row)),
                });
            }
        }
        let window = relief.fine_window();
        let fine = vec![NO_VERTEX; window[1][0] as usize * window[1][1] as usize];
        Self { relief, corridor, coarse, fine, window }
    }

    /// Vertex of a post, counted in posts of the finest level.
    pub(super) fn number(&mut self, ground: &mut Ground, post: [u32; 2]) -> u32 {
        if post.iter().all(|index| index.is_multiple_of(FINE_STEPS)) {
            let [column, row] = post.map(|index| index / FINE_STEPS);
            return self.coarse[row as usize * self.relief.posts.columns as usize + column as usize];
        }
        let [first, size] = self.window;
        let [i, j] = [0, 1].map(|axis| (post[axis] - first[axis]) as usize);
        let slot = &mut self.fine[j * size[0] as usize + i];
        if *slot == NO_VERTEX {
            *slot = ground.add_vertex(self.relief.at(post));
        }
        *slot
    }

    /// Vertex of a post of level 0; `None` in a corridor.
    pub(super) fn coarse(&self, [column, row]: [u32; 2]) -> Option<u32> {
        let number = self.coarse[row as usize * self.relief.posts.columns as usize + column as usize];
        (number != NO_VERTEX).then_some(number)
    }

    /// Level of the posts along a side of a cell: that of the finer cell beside it. Cells of a corridor do not count.
    pub(super) fn side_level(&self, cell: [u32; 2], side: Side) -> usize {
        let neighbour = side.neighbour(cell, cells_of(self.relief));
        let both = [Some(cell), neighbour].into_iter().flatten();
        both.filter(|&cell| !self.corridor.has_cell(cell))
            .map(|cell| self.relief.level(cell))
            .max()
            .unwrap_or(0)
    }

    /// Vertex at the end of a side of a cell.
    pub(super) fn end(&mut self, ground: &mut Ground, cell: [u32; 2], side: Side) -> u32 {
        let [start, direction] = [side.start(cell).map(u32::cast_signed), side.direction()];
        let end = [0, 1].map(|axis| start[axis] + direction[axis] * FINE_STEPS.cast_signed());
        self.number(ground, end.map(i32::cast_unsigned))
    }

    /// Vertices along a side of a cell, from its start on, without its end.
    pub(super) fn side(&mut self, ground: &mut Ground, cell: [u32; 2], side: Side) -> Vec<u32> {
        let level = self.side_level(cell, side);
        let start = side.start(cell);
        let step = (FINE_STEPS >> level) as i32;
        let at = |k: i32| {
            let [x, y] = side.direction();
            [start[0].wrapping_add_signed(k * step * x), start[1].wrapping_add_signed(k * step * y)]
        };
        (0..1 << level).map(|k| self.number(ground, at(k))).collect()
    }
}
