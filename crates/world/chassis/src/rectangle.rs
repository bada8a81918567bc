//! A turned rectangle in plan, and the part of a triangle that lies over it.

use glam::{DVec2, DVec3};

/// Margin around the bounding box of a rectangle, metres: more than the rounding of a coordinate of 1e7 m (2e-9 m).
/// The box only chooses the faces that are looked at; the clipping decides.
const PADDING_M: f64 = 1e-6;

/// A closed rectangle in plan. Its local coordinates are (a, b, z): a along `forward` and b to the left of it, both
/// from the rectangle's middle, and z the height above the mesh's origin. All metres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rectangle {
    /// A place near the middle, from the mesh's origin.
    pub(crate) place: DVec2,
    /// The middle, from `place`. It is kept apart, since the sum of both would round to the spacing of numbers of the
    /// size of `place`.
    pub(crate) offset: DVec2,
    /// Direction of a, a unit vector.
    pub(crate) forward: DVec2,
    /// Largest |a|.
    pub(crate) half_length: f64,
    /// Largest |b|.
    pub(crate) half_width: f64,
}

impl Rectangle {
    /// Whether all its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.place.is_finite() && self.offset.is_finite() && self.forward.is_finite()
    }

    /// Lowest and highest plan coordinates, from the mesh's origin, with a margin.
    pub(crate) fn bounds(&self) -> [DVec2; 2] {
        let middle = self.place + self.offset;
        let half = self.forward.abs() * self.half_length + self.forward.perp().abs() * self.half_width;
        [middle - half - PADDING_M, middle + half + PADDING_M]
    }

    /// Local coordinates of a vertex.
    pub(crate) fn local(&self, [x, y, z]: [f32; 3]) -> DVec3 {
        let plan = (DVec2::new(f64::from(x), f64::from(y)) - self.place) - self.offset;
        DVec3::new(plan.dot(self.forward), plan.dot(self.forward.perp()), f64::from(z))
    }

    /// A local point in the frame of the mesh's origin.
    pub(crate) fn scene(&self, point: DVec3) -> DVec3 {
        let plan = self.offset + self.forward * point.x + self.forward.perp() * point.y;
        (self.place + plan).extend(point.z)
    }

    /// Whether something from the corner `low` to the corner `high` of its box, in local coordinates, may lie over this
    /// rectangle in plan.
    pub(crate) fn may_overlap(&self, low: DVec3, high: DVec3) -> bool {
        low.x <= self.half_length
            && high.x >= -self.half_length
            && low.y <= self.half_width
            && high.y >= -self.half_width
    }

    /// The part of a triangle, in local coordinates, that lies over this rectangle.
    pub(crate) fn clip(&self, corners: [DVec3; 3]) -> Polygon {
        let mut polygon = Polygon::of(corners);
        for (axis, limit) in [(0, self.half_length), (1, self.half_width)] {
            for side in [1.0, -1.0] {
                polygon.cut(axis, side, limit);
            }
        }
        polygon
    }
}

/// A convex polygon in space. It may be vertical: its plan is a line then, and all that follows holds too.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Polygon {
    corners: [DVec3; Polygon::MAX_CORNERS],
    count: usize,
}

impl Polygon {
    /// A triangle has three corners, and each of the four cuts adds one: seven. Rounding may leave a polygon that is
    /// not convex in the last digit, where a cut adds two; the rest is for these.
    const MAX_CORNERS: usize = 16;

    fn of(corners: [DVec3; 3]) -> Self {
        let mut polygon = Self { corners: [DVec3::ZERO; Self::MAX_CORNERS], count: 0 };
        corners.into_iter().for_each(|corner| polygon.push(corner));
        polygon
    }

    fn push(&mut self, corner: DVec3) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    /// The corners, in their order around the polygon.
    pub(crate) fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// The edges, each by its two ends.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let corners = self.corners();
        corners.iter().enumerate().map(|(i, &from)| [from, corners[(i + 1) % corners.len()]])
    }

    /// Keeps the part with `side` times coordinate `axis` at most `limit`.
    fn cut(&mut self, axis: usize, side: f64, limit: f64) {
        let inside = |point: &DVec3| limit - side * point[axis];
        if self.corners().iter().all(|corner| inside(corner) >= 0.0) {
            return;
        }
        let before = *self;
        self.count = 0;
        for [from, to] in before.edges() {
            let (room_from, room_to) = (inside(&from), inside(&to));
            if room_from >= 0.0 {
                self.push(from);
            }
            if (room_from >= 0.0) != (room_to >= 0.0) {
                // From the inner end outward: the neighbour face, which has the edge in the other sense, finds the
                // same bits.
                let (inner, outer, share) = if room_from >= 0.0 {
                    (from, to, room_from / (room_from - room_to))
                } else {
                    (to, from, room_to / (room_to - room_from))
                };
                let mut on_side = inner + (outer - inner) * share;
                on_side[axis] = side * limit;
                self.push(on_side);
            }
        }
    }

    /// The part of the line b = 0 in this polygon: its two ends. `None` if the polygon lies on one side of it, or has
    /// an edge on it.
    pub(crate) fn chord(&self) -> Option<[DVec3; 2]> {
        // A corner on the line counts as right of it, so that each crossing is found once.
        let mut ends = self.edges().filter(|[from, to]| (from.y > 0.0) != (to.y > 0.0)).map(|[from, to]| {
            let mut end = from + (to - from) * (from.y / (from.y - to.y));
            end.y = 0.0;
            end
        });
        Some([ends.next()?, ends.next()?])
    }
}
