//! Sheet of faces over the posts: a grid, cut open at the crevasses.

use glam::{DVec2, DVec3};

use super::crevasses::Crevasse;
use crate::random_stream::{RandomStream, StreamPurpose};
use crate::{Ground, HeightGrid};

/// Points on a wall below its edge, down to the floor and including it.
const POINTS_PER_WALL: u32 = 5;

/// Height of the posts' surface at a place, bilinear between the four posts around it; outside, the height at the
/// nearest border.
pub(super) fn height(posts: &HeightGrid, place: DVec2) -> f64 {
    let locate = |offset: f64, count: u32| {
        let at = offset.clamp(0.0, f64::from(count - 1));
        let cell = (at as u32).min(count.saturating_sub(2));
        (cell, at - f64::from(cell))
    };
    let offset = (place - posts.corner) / posts.spacing;
    let ((i, s), (j, t)) = (locate(offset.x, posts.columns), locate(offset.y, posts.rows));
    let post = |i: u32, j: u32| posts.at(i, j).z;
    // At a post the result is the post's own height, even if its neighbours are unknown.
    let between = |a: f64, b: f64, share: f64| if share == 0.0 { a } else { a + (b - a) * share };
    let line = |j: u32| if s == 0.0 { post(i, j) } else { between(post(i, j), post(i + 1, j), s) };
    if t == 0.0 { line(j) } else { between(line(j), line(j + 1), t) }
}

/// Material indices of the sheet.
pub(super) struct SheetMaterials {
    pub soil: u16,
    pub wall: u16,
}

/// Adds the sheet to a ground without faces.
pub(super) fn add(
    ground: &mut Ground,
    posts: &HeightGrid,
    crevasses: &[Crevasse],
    materials: &SheetMaterials,
    seed: u64,
) {
    let mut diagonals = RandomStream::new(seed, StreamPurpose::Diagonals);
    let mut before: Option<VertexRow> = None;
    for row in 0..posts.rows {
        for line in vertex_rows(ground, posts, crevasses, row, materials) {
            if let Some(before) = &before {
                join_rows(ground, before, &line, &mut diagonals);
            }
            before = Some(line);
        }
    }
}

/// Vertices of a row from left to right, and the material of the cells between this row and the one before.
struct VertexRow {
    vertices: Vec<u32>,
    material: u16,
}

/// Vertex rows for one grid row: one, or those of a crevasse from the near edge to the far edge.
fn vertex_rows(
    ground: &mut Ground,
    posts: &HeightGrid,
    crevasses: &[Crevasse],
    row: u32,
    materials: &SheetMaterials,
) -> Vec<VertexRow> {
    let opened = crevasses.iter().find(|crevasse| crevasse.row == row);
    let middle = posts.corner
        + 0.5 * posts.spacing * DVec2::new(f64::from(posts.columns - 1), f64::from(posts.rows - 1));
    let plain = |ground: &mut Ground, column: u32| {
        let post = posts.at(column, row);
        // Crevasses are generated about the origin.
        let local = post.truncate() - middle;
        let shift: f64 = crevasses.iter().map(|crevasse| crevasse.shift(local.x, local.y)).sum();
        if shift == 0.0 {
            return ground.add_vertex(post);
        }
        let place = post.truncate() + DVec2::new(0.0, shift);
        ground.add_vertex(place.extend(height(posts, place)))
    };
    let Some(crevasse) = opened else {
        let vertices = (0..posts.columns).map(|column| plain(ground, column)).collect();
        return vec![VertexRow { vertices, material: materials.soil }];
    };
    // From the near edge down, then up to the far edge.
    let down = (0..=POINTS_PER_WALL).map(|point| (-1.0, point));
    let up = (0..=POINTS_PER_WALL).rev().map(|point| (1.0, point));
    let profile: Vec<(f64, u32)> = down.chain(up).collect();
    let mut columns = Vec::with_capacity(posts.columns as usize);
    for column in 0..posts.columns {
        if column <= crevasse.columns.start || column >= crevasse.columns.end {
            columns.push(vec![plain(ground, column); profile.len()]);
            continue;
        }
        let x = posts.at(column, row).x - middle.x;
        let edge = |side: f64| {
            let place = middle + DVec2::new(x, crevasse.wall_y(column, x, side, 0.0));
            height(posts, place)
        };
        let (near, far) = (edge(-1.0), edge(1.0));
        let floor = near.min(far) - crevasse.depth(x);
        let point = |&(side, point): &(f64, u32)| {
            let share = f64::from(point) / f64::from(POINTS_PER_WALL);
            let top = if side < 0.0 { near } else { far };
            let y = middle.y + crevasse.wall_y(column, x, side, share);
            ground.add_vertex(DVec3::new(middle.x + x, y, top + (floor - top) * share))
        };
        columns.push(profile.iter().map(point).collect());
    }
    let line = |k: usize| VertexRow {
        vertices: columns.iter().map(|column| column[k]).collect(),
        material: if k == 0 { materials.soil } else { materials.wall },
    };
    (0..profile.len()).map(line).collect()
}

/// Adds the cells between two rows: two faces each, fewer where corners share a vertex.
fn join_rows(ground: &mut Ground, near: &VertexRow, far: &VertexRow, diagonals: &mut RandomStream) {
    for (near, far_pair) in near.vertices.windows(2).zip(far.vertices.windows(2)) {
        // Corners of the cell, counter-clockwise from the near left one.
        let (a, b, c, d) = (near[0], near[1], far_pair[1], far_pair[0]);
        let halves = if diagonals.coin() { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
        for half in halves {
            if half[0] != half[1] && half[1] != half[2] && half[2] != half[0] {
                ground.add_face(half, far.material);
            }
        }
    }
}
