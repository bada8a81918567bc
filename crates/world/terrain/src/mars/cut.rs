//! Ground about the crevasses: the strip of soil between the cells and the edges, the walls and the floors.
//!
//! All cells that an opening touches form a corridor. Its soil is a constrained Delaunay triangulation of what bounds
//! it: the posts of the cells beside it, and the edges of the openings. Walls and floor of a crevasse are a ladder: at
//! each node of the course a row of points from the right edge down, across the floor and up to the left edge.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::corridor::Corridor;
use super::crevasses::Crevasse;
use super::relief::Relief;
use super::sheet_posts::{SheetMaterials, SheetPosts, Side, cells_of};
use crate::Ground;

/// Points on a wall below its edge, down to the floor and including it.
pub(super) const POINTS_PER_WALL: u32 = 5;

/// Faces of walls and floor, and of soil beside them, for each node of a crevasse: an upper bound.
pub(super) fn faces_per_node() -> f64 {
    // A ladder of 2 walls and a floor, two faces a square; each point of an edge adds two faces of soil.
    f64::from(2 * (2 * POINTS_PER_WALL + 1) + 4)
}

/// Place of a vertex about the middle of the ground.
fn local(relief: &Relief, vertex: DVec3) -> DVec2 {
    vertex.truncate() - relief.middle
}

/// Adds the ground of the corridors.
pub(super) fn add(
    ground: &mut Ground,
    relief: &Relief,
    crevasses: &[Crevasse],
    corridor: &Corridor,
    posts: &mut SheetPosts<'_>,
    materials: &SheetMaterials,
) {
    let mut soil = Soil::default();
    for cell in corridor.cells() {
        for corner in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            if let Some(vertex) = posts.coarse([cell[0] + corner[0], cell[1] + corner[1]]) {
                soil.add(vertex, local(relief, ground.vertices[vertex as usize]));
            }
        }
        for side in Side::ALL {
            if side.neighbour(cell, cells_of(relief)).is_some_and(|other| corridor.has_cell(other)) {
                continue;
            }
            let mut line = posts.side(ground, cell, side);
            line.push(posts.end(ground, cell, side));
            for vertex in &line {
                soil.add(*vertex, local(relief, ground.vertices[*vertex as usize]));
            }
            line.windows(2).for_each(|pair| soil.bound(pair[0], pair[1]));
        }
    }
    let mut ladders = Vec::new();
    for crevasse in crevasses {
        let rungs = add_rungs(ground, relief, crevasse);
        for edge in [0, rungs[0].len() - 1] {
            for rung in &rungs {
                soil.add(rung[edge], local(relief, ground.vertices[rung[edge] as usize]));
            }
            rungs.windows(2).for_each(|pair| soil.edge(pair[0][edge], pair[1][edge]));
        }
        ladders.push(rungs);
    }
    soil.add_faces(ground, materials.soil);
    for rungs in ladders {
        for pair in rungs.windows(2) {
            for k in 0..pair[0].len() - 1 {
                // The square's corners, counter-clockwise from above where the floor is.
                let [a, b, c, d] = [pair[0][k], pair[1][k], pair[1][k + 1], pair[0][k + 1]];
                for half in [[a, b, c], [a, c, d]] {
                    // At the ends a row is one vertex.
                    if half[0] != half[1] && half[1] != half[2] && half[2] != half[0] {
                        ground.add_face(half, materials.wall);
                    }
                }
            }
        }
    }
}

/// Adds the points of a crevasse. Each row runs from the right edge down, and up to the left edge; at the ends all points
/// of a row are one vertex.
fn add_rungs(ground: &mut Ground, relief: &Relief, crevasse: &Crevasse) -> Vec<Vec<u32>> {
    // From the right edge down, then up to the left edge.
    let down = (0..=POINTS_PER_WALL).map(|point| (-1.0, point));
    let up = (0..=POINTS_PER_WALL).rev().map(|point| (1.0, point));
    let profile: Vec<(f64, u32)> = down.chain(up).collect();
    let mut rungs = Vec::with_capacity(crevasse.nodes.len());
    for node in 0..=crevasse.last() {
        let surface = |place: DVec2| relief.height(relief.middle + place);
        if node == 0 || node == crevasse.last() {
            let place = crevasse.nodes[node];
            let end = ground.add_vertex((relief.middle + place).extend(surface(place)));
            rungs.push(vec![end; profile.len()]);
            continue;
        }
        let [right, left] = [-1.0, 1.0].map(|side| surface(crevasse.wall(node, side, 0.0)));
        let floor = right.min(left) - crevasse.depth(node);
        let point = |&(side, point): &(f64, u32)| {
            let share = f64::from(point) / f64::from(POINTS_PER_WALL);
            let top = if side < 0.0 { right } else { left };
            let place = relief.middle + crevasse.wall(node, side, share);
            ground.add_vertex(place.extend(top + (floor - top) * share))
        };
        rungs.push(profile.iter().map(point).collect());
    }
    rungs
}

/// Soil of the corridors under construction.
#[derive(Default)]
struct Soil {
    triangulation: ConstrainedDelaunayTriangulation<Point2<f64>>,
    /// Vertex of the ground for each vertex of the triangulation, and the reverse.
    vertices: Vec<u32>,
    handles: BTreeMap<u32, FixedVertexHandle>,
    /// Edges with the soil of a corridor on their left.
    bounds: Vec<[u32; 2]>,
}

impl Soil {
    fn add(&mut self, vertex: u32, place: DVec2) {
        if self.handles.contains_key(&vertex) {
            return;
        }
        let place = spade::mitigate_underflow(Point2::new(place.x, place.y));
        let handle = self.triangulation.insert(place).expect("coordinates are finite and within 1e12 m");
        assert_eq!(handle.index(), self.vertices.len(), "no two vertices have one place");
        self.vertices.push(vertex);
        self.handles.insert(vertex, handle);
    }

    /// Adds an edge that no face of soil crosses.
    fn edge(&mut self, from: u32, to: u32) {
        let [from, to] = [from, to].map(|vertex| self.handles[&vertex]);
        assert!(
            self.triangulation.can_add_constraint(from, to),
            "bounds of a corridor and edges do not meet"
        );
        self.triangulation.add_constraint(from, to);
    }

    /// Adds an edge of the corridor's border; the corridor is on its left.
    fn bound(&mut self, from: u32, to: u32) {
        self.edge(from, to);
        self.bounds.push([from, to]);
    }

    /// Adds the faces that can be reached from the borders without crossing an edge: those between the borders and the
    /// openings.
    fn add_faces(&self, ground: &mut Ground, material: u16) {
        let triangulation = &self.triangulation;
        let mut open: Vec<_> = self
            .bounds
            .iter()
            .filter_map(|&[from, to]| {
                let [from, to] = [from, to].map(|vertex| self.handles[&vertex]);
                let edge = triangulation.get_edge_from_neighbors(from, to).expect("an edge that was added");
                edge.face().as_inner()
            })
            .collect();
        let mut taken = vec![false; triangulation.num_all_faces()];
        while let Some(face) = open.pop() {
            let index = face.fix().index();
            if std::mem::replace(&mut taken[index], true) {
                continue;
            }
            let crossed = face.adjacent_edges().into_iter().filter(|edge| !edge.is_constraint_edge());
            open.extend(crossed.filter_map(|edge| edge.rev().face().as_inner()));
        }
        let mut faces: Vec<[u32; 3]> = triangulation
            .inner_faces()
            .filter(|face| taken[face.fix().index()])
            .map(|face| {
                let mut corners = face.vertices().map(|vertex| self.vertices[vertex.fix().index()]);
                let least = (0..3).min_by_key(|&k| corners[k]).expect("three corners");
                corners.rotate_left(least);
                corners
            })
            .collect();
        // In an order of their own, so that the triangulation's does not matter.
        faces.sort_unstable();
        faces.into_iter().for_each(|face| ground.add_face(face, material));
    }
}
