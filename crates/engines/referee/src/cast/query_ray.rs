//! One ray in three numbers: plain f64 with a bound for the sides of edges, intervals of f64, and exactly where these are in
//! doubt.

use std::cell::{Cell, OnceCell};
use std::cmp::Ordering;

use glam::DVec3;
use raypencil_scene::CastRay;

use crate::hits::edge_filter::EdgeFilter;
use crate::numbers::number::{Dyadic, Interval, Number};
use crate::numbers::vector::Vector;
use crate::rays::ray::ScaledRay;

/// Origin o and direction d of a ray.
#[derive(Debug, Clone)]
pub(super) struct RayNumbers<T> {
    pub(super) origin: Vector<T>,
    pub(super) direction: Vector<T>,
}

impl<T: Number> RayNumbers<T> {
    pub(super) fn of(ray: &CastRay) -> Self {
        Self { origin: Vector::of(ray.origin), direction: Vector::of(ray.direction) }
    }

    /// The ray moved sideways by `by`, along the two vectors of [`CastRay::across`].
    pub(super) fn moved(ray: &CastRay, by: [T; 2]) -> Self {
        let [u, v] = ray.across().map(Vector::of);
        let origin = Vector::of(ray.origin).add(&u.scaled(&by[0])).add(&v.scaled(&by[1]));
        Self { origin, direction: Vector::of(ray.direction) }
    }

    /// The ray moved sideways so that it passes exactly through a place, which it reaches at `t`.
    fn through(ray: &CastRay, place: DVec3, t: f64) -> Self {
        let direction = Vector::of(ray.direction);
        Self { origin: Vector::of(place).sub(&direction.scaled(&T::of(t))), direction }
    }
}

/// How a ray lies beside the one that was asked.
#[derive(Debug, Clone, Copy)]
enum Moved {
    /// It is that one.
    Not,
    /// Moved sideways by this.
    By([f64; 2]),
    /// Moved sideways so that it passes exactly through a place, which it reaches at this t.
    Through(DVec3, f64),
}

impl Moved {
    fn numbers<T: Number>(self, ray: &CastRay) -> RayNumbers<T> {
        match self {
            Self::Not => RayNumbers::of(ray),
            Self::By(by) => RayNumbers::moved(ray, by.map(T::of)),
            Self::Through(place, t) => RayNumbers::through(ray, place, t),
        }
    }
}

/// A polynomial of a ray, of which only the sign matters.
pub(super) trait Polynomial {
    fn value<T: Number>(&self, ray: &RayNumbers<T>) -> T;
}

/// One ray; its intervals and its exact numbers are formed when they are first needed.
pub(super) struct QueryRay<'r> {
    ray: &'r CastRay,
    moved: Moved,
    filter: EdgeFilter,
    /// Apart, for they are large and rare.
    fast: OnceCell<Box<RayNumbers<Interval>>>,
    exact: OnceCell<Box<RayNumbers<Dyadic>>>,
    /// What has decided its signs so far.
    decided: Cell<DecidedBy>,
}

impl<'r> QueryRay<'r> {
    #[inline]
    pub(super) fn new(ray: &'r CastRay) -> Self {
        let filter = EdgeFilter::exactly(ray.origin, ray.direction);
        Self {
            ray,
            moved: Moved::Not,
            filter,
            fast: OnceCell::new(),
            exact: OnceCell::new(),
            decided: Cell::default(),
        }
    }

    /// The ray moved sideways by `by`, along the two vectors of [`CastRay::across`].
    pub(super) fn moved(ray: &'r CastRay, by: [f64; 2]) -> Self {
        Self::beside(ray, Moved::By(by))
    }

    /// The ray moved sideways so that it passes exactly through a place, which no displacement in f64 may reach.
    pub(super) fn through(ray: &'r CastRay, place: DVec3) -> Self {
        let t = (place - ray.origin).dot(ray.direction) / ray.direction.length_squared();
        Self::beside(ray, Moved::Through(place, t))
    }

    fn beside(ray: &'r CastRay, moved: Moved) -> Self {
        let fast = moved.numbers::<Interval>(ray);
        let RayNumbers { origin, direction } = fast.clone();
        let one = Interval::of(1.0);
        let filter =
            EdgeFilter::new(&ScaledRay { origin, origin_scale: one, direction, direction_scale: one });
        let fast = OnceCell::from(Box::new(fast));
        Self { ray, moved, filter, fast, exact: OnceCell::new(), decided: Cell::default() }
    }

    /// |d|, to a few roundings.
    pub(super) fn length(ray: &CastRay) -> f64 {
        let largest = ray.direction.abs().max_element();
        (ray.direction / largest).length() * largest
    }

    /// The coordinate in which the direction is largest.
    pub(super) fn largest_part(&self) -> usize {
        self.ray.direction.abs().max_position()
    }

    pub(super) fn t_min(&self) -> f64 {
        self.ray.t_min
    }

    pub(super) fn t_max(&self) -> f64 {
        self.ray.t_max
    }

    /// The ray in intervals.
    pub(super) fn fast(&self) -> &RayNumbers<Interval> {
        // That of a moved ray stands there already.
        self.fast.get_or_init(|| Box::new(RayNumbers::of(self.ray)))
    }

    /// The ray without rounding.
    pub(super) fn exact(&self) -> &RayNumbers<Dyadic> {
        self.exact.get_or_init(|| Box::new(self.moved.numbers(self.ray)))
    }

    /// On which side of the edge from corner `k` of a triangle the ray passes, in plain f64; `None` if that is not certain.
    #[inline]
    pub(super) fn certain_side(&self, corners: [DVec3; 3], k: usize) -> Option<Ordering> {
        let side = self.filter.sign(corners, k);
        if side.is_some() {
            self.took(Path::Filter);
        }
        side
    }

    /// What contains the t at which the plane of a triangle is met, in plain f64; `None` if too little is certain.
    #[inline]
    pub(super) fn t_of_plane(&self, corners: [DVec3; 3]) -> Option<Interval> {
        self.filter.t_of_plane(corners)
    }

    /// What has decided all signs so far.
    pub(super) fn decided_by(&self) -> DecidedBy {
        self.decided.get()
    }

    /// Takes note of the path of a sign.
    #[inline]
    pub(super) fn took(&self, path: Path) {
        match path {
            Path::Filter | Path::Plane => {}
            Path::Interval => self.decided.set(self.decided.get().max(DecidedBy::Intervals)),
            Path::Exact => self.decided.set(DecidedBy::Exact),
        }
        #[cfg(test)]
        PATHS.with(|paths| {
            let mut counts = paths.get();
            counts[path as usize] += 1;
            paths.set(counts);
        });
    }

    /// The exact sign: by the interval if that is certain, else by exact arithmetic.
    #[inline]
    pub(super) fn sign(&self, polynomial: &impl Polynomial) -> Ordering {
        self.sign_or(polynomial.value(self.fast()), polynomial)
    }

    /// The exact sign of a polynomial of which the interval is known.
    #[inline]
    pub(super) fn sign_or(&self, fast: Interval, polynomial: &impl Polynomial) -> Ordering {
        match fast.sign() {
            Some(sign) => {
                self.took(Path::Interval);
                sign
            }
            None => self.exact_sign(polynomial),
        }
    }

    #[cold]
    fn exact_sign(&self, polynomial: &impl Polynomial) -> Ordering {
        self.took(Path::Exact);
        polynomial.value(self.exact()).sign().unwrap_or(Ordering::Equal)
    }
}

/// What decided a question about a ray: the slowest arithmetic that one of its signs needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum DecidedBy {
    /// Plain `f64`, with a proven bound.
    #[default]
    Filter,
    /// Intervals of `f64`.
    Intervals,
    /// Exact arithmetic.
    Exact,
}

/// How a sign was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Path {
    /// In plain f64, on the side of an edge.
    Filter,
    /// In plain f64, at an end of the ray.
    Plane,
    /// In intervals.
    Interval,
    /// In exact arithmetic.
    Exact,
}

#[cfg(test)]
thread_local! {
    /// Signs that this thread found on each [`Path`].
    pub(super) static PATHS: Cell<[u64; 4]> = const { Cell::new([0; 4]) };
}
