//! A face in the frame of a ray: a triangle in the plane of a and b, with linear conditions.

use glam::DVec3;
use raypencil_scene::Side;

use super::frame::{FrameNumbers, Point};
use crate::numbers::number::Number;

/// The linear function c + x (D a) + y (D b) of a displacement.
#[derive(Debug, Clone)]
pub(super) struct Linear<T> {
    pub(super) c: T,
    pub(super) x: T,
    pub(super) y: T,
}

impl<T: Number> Linear<T> {
    pub(super) fn add(&self, other: &Self) -> Self {
        Self { c: self.c.add(&other.c), x: self.x.add(&other.x), y: self.y.add(&other.y) }
    }

    pub(super) fn sub(&self, other: &Self) -> Self {
        Self { c: self.c.sub(&other.c), x: self.x.sub(&other.x), y: self.y.sub(&other.y) }
    }

    pub(super) fn scaled(&self, by: &T) -> Self {
        Self { c: self.c.mul(by), x: self.x.mul(by), y: self.y.mul(by) }
    }

    pub(super) fn negated(&self) -> Self {
        self.scaled(&T::of(-1.0))
    }
}

/// A face in the frame. Its corners go counter-clockwise in the plane, whichever side the ray sees.
#[derive(Debug, Clone)]
pub(super) struct FlatFace<T> {
    pub(super) corners: [Point<T>; 3],
    /// Twice the area of the triangle in the plane: positive.
    pub(super) area: T,
    /// The vertices of the mesh at the corners.
    pub(super) vertices: [DVec3; 3],
}

/// The corner of the mesh's face that is corner k here: fronts are turned round, since their normal points against the
/// ray.
pub(super) fn corner_of(side: Side, k: usize) -> usize {
    match side {
        Side::Front => [0, 2, 1][k % 3],
        Side::Back => k % 3,
    }
}

impl<T: Number> FlatFace<T> {
    /// The face with these corners, whose `side` the ray sees. It must not be parallel to the ray.
    pub(super) fn new(frame: &FrameNumbers<T>, corners: &[DVec3; 3], side: Side) -> Self {
        let vertices = [0, 1, 2].map(|k| corners[corner_of(side, k)]);
        let corners = vertices.map(|vertex| frame.point(vertex));
        let edges = [0, 1, 2].map(|k| edge(&corners, k));
        // The sum of the three edges' functions is the same everywhere: twice the area.
        let area = edges[0].c.add(&edges[1].c).add(&edges[2].c);
        Self { corners, area, vertices }
    }

    /// Not negative inside the edge from corner k, and 0 on its line: the cross product of the corners as seen from the
    /// displaced ray, (P - p) x (Q - p).
    pub(super) fn edge(&self, k: usize) -> Linear<T> {
        edge(&self.corners, k)
    }

    /// D t of the face's plane, times the area: the corners' own t, weighted by the opposite edges.
    pub(super) fn height(&self) -> Linear<T> {
        let weighted = |k: usize| self.edge(k + 1).scaled(&self.corners[k].0[2]);
        weighted(0).add(&weighted(1)).add(&weighted(2))
    }

    /// Not negative where the face is met no earlier than D t = `from`.
    pub(super) fn not_before(&self, from: &T) -> Linear<T> {
        self.not_before_with(from, &self.height())
    }

    /// The same where the [`height`](Self::height) is known.
    pub(super) fn not_before_with(&self, from: &T, height: &Linear<T>) -> Linear<T> {
        let mut height = height.clone();
        height.c = height.c.sub(&self.area.mul(from));
        height
    }

    /// Not negative where the face is met no later than D t = `to`.
    pub(super) fn not_after(&self, to: &T) -> Linear<T> {
        self.not_before(to).negated()
    }

    /// Not negative where the face's plane is met at or before the other's.
    pub(super) fn at_or_before(&self, other: &Self) -> Linear<T> {
        at_or_before([&self.height(), &other.height()], [&self.area, &other.area])
    }

    /// The conditions under which the displaced ray meets the face: three edges, and both ends of the ray.
    pub(super) fn conditions(&self, frame: &FrameNumbers<T>) -> Vec<Linear<T>> {
        self.conditions_with(frame, &self.height())
    }

    /// The same where the [`height`](Self::height) is known.
    pub(super) fn conditions_with(&self, frame: &FrameNumbers<T>, height: &Linear<T>) -> Vec<Linear<T>> {
        let mut conditions = Vec::with_capacity(6);
        conditions.extend((0..3).map(|k| self.edge(k)));
        conditions.push(self.not_before_with(&frame.from, height));
        conditions.extend(frame.to.as_ref().map(|to| self.not_before_with(to, height).negated()));
        conditions
    }
}

/// Not negative where the first of two planes is met at or before the second, by their faces' heights and areas.
pub(super) fn at_or_before<T: Number>(
    [one, other]: [&Linear<T>; 2],
    [of_one, of_other]: [&T; 2],
) -> Linear<T> {
    other.scaled(of_one).sub(&one.scaled(of_other))
}

fn edge<T: Number>(corners: &[Point<T>; 3], k: usize) -> Linear<T> {
    let ([px, py, _], [qx, qy, _]) = (&corners[k % 3].0, &corners[(k + 1) % 3].0);
    Linear { c: px.mul(qy).sub(&py.mul(qx)), x: py.sub(qy), y: qx.sub(px) }
}
