//! The nearest hit with its ties, what a sensor reads of it, and whether anything is hit.

use std::cmp::Ordering;
use std::iter::Enumerate;
use std::slice;

use raypencil_scene::{CastRay, FaceId, Reading, Side, Sides};

use super::query_ray::{DecidedBy, QueryRay};
use super::triangle::{Met, Triangle};
use super::values::CastMeeting;
use super::wide_tree::{FrameRay, Next, Rays, TOGETHER, how_many_together};
use super::{ExactCast, bundle, moved_bundle, walk_bundle};

impl ExactCast<'_> {
    /// The faces met at the smallest t, in ascending order: several if they are met at exactly the same t, none if the
    /// ray meets nothing. They may be too near for a sensor: [`reading`](Self::reading) tells.
    pub fn first(&self, ray: &CastRay, sides: Sides) -> Vec<FaceId> {
        self.nearest(ray, sides).iter().map(|face| face.id).collect()
    }

    /// What the ray's sensor reads: the faces of [`first`](Self::first), unless they are met before [`CastRay::t_blind`],
    /// exactly.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Reading, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let cast = ExactCast::new(&triangle);
    /// // Met at t = 1: a sensor that measures from there on sees it, one that is blind a step of f64 farther does not.
    /// let read = |t_blind: f64| {
    ///     let ray = CastRay { t_blind, ..CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z) };
    ///     cast.reading(&ray, Sides::Both)
    /// };
    /// assert_eq!(read(1.0), Reading::Hit(vec![FaceId(0)]));
    /// assert_eq!(read(1.0_f64.next_up()), Reading::TooNear);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn reading(&self, ray: &CastRay, sides: Sides) -> Reading<Vec<FaceId>> {
        self.read(ray, &self.nearest(ray, sides)).map(|faces| faces.iter().map(|face| face.id).collect())
    }

    /// The first hit as the ray's sensor reads it, whose values are formed when they are asked for, and the number of faces at
    /// its t. Of several faces it is on the lowest.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::new(0.0, 0.0, -2.0));
    /// let cast = ExactCast::new(&triangle);
    /// let read = cast.first_meeting(&ray, Sides::Both);
    /// let (meeting, ties) = read.hit().unwrap();
    /// assert_eq!((meeting.face(), *ties, meeting.t().double), (FaceId(0), 1, 0.5));
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn first_meeting<'r>(&self, ray: &'r CastRay, sides: Sides) -> Reading<(CastMeeting<'r>, u32)> {
        let query = QueryRay::new(ray);
        let mut nearest = Nearest::new(sides);
        self.walk(ray, |face| nearest.see(face, &query));
        nearest.meeting(ray, &query).0
    }

    /// [`first_meeting`](Self::first_meeting) of many rays, which is quicker than one after the other: `each` gets the index of every
    /// ray, in no particular order, what it reads, and which arithmetic decided that.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::{DecidedBy, ExactCast};
    /// use raypencil_scene::{CastRay, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let ray = |x: f64| CastRay::new(DVec3::new(x, 0.25, 1.0), DVec3::NEG_Z);
    /// let mut hits = Vec::new();
    /// let rays = [ray(0.25), ray(2.0), ray(0.75)];
    /// ExactCast::new(&triangle).first_meetings(&rays, Sides::Both, |k, read, decided_by| {
    ///     hits.extend(read.hit().map(|(meeting, _)| (k, meeting.t().double, decided_by)));
    /// });
    /// hits.sort_by_key(|hit| hit.0);
    /// // The last one passes the edge itself.
    /// assert_eq!(hits, [(0, 1.0, DecidedBy::Filter), (2, 1.0, DecidedBy::Exact)]);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn first_meetings<'r>(
        &self,
        rays: &'r [CastRay],
        sides: Sides,
        mut each: impl FnMut(usize, &Reading<(CastMeeting<'r>, u32)>, DecidedBy),
    ) {
        self.walk_to_first(rays, sides, &mut each);
    }

    /// [`first_meetings`](Self::first_meetings), compiled once, with this crate's optimisation.
    #[inline(never)]
    fn walk_to_first<'r>(&self, rays: &'r [CastRay], sides: Sides, each: &mut EachMeeting<'_, 'r>) {
        let mut walks = FirstWalks {
            cast: self,
            sides,
            rays: rays.iter().enumerate(),
            places: [const { None }; TOGETHER],
            each: |index, query: &QueryRay<'r>, nearest: &Nearest| {
                let (read, decided_by) = nearest.meeting(&rays[index], query);
                each(index, &read, decided_by);
            },
        };
        self.tree.wide.walk_together(self.mesh.vertices(), &mut walks, how_many_together(rays));
    }

    /// What the ray's sensor reads of the nearest faces.
    pub(super) fn read<'f>(&self, ray: &CastRay, nearest: &'f [Triangle]) -> Reading<&'f [Triangle]> {
        let met = (!nearest.is_empty()).then_some(nearest);
        // Most rays have no shortest range; the faces of a tie are all at one t.
        let is_too_near =
            |met: &&[Triangle]| ray.t_blind > 0.0 && met[0].is_before(ray.t_blind, &QueryRay::new(ray));
        Reading::of(met, is_too_near)
    }

    /// The faces that [`first`](Self::first) would give for the ray moved sideways, parallel to itself: its origin is
    /// exactly o + a u + b v, with `by` = \[a, b\] and u, v of [`CastRay::across`].
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_referee::ExactCast;
    /// use raypencil_scene::{CastRay, FaceId, Sides, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let triangle = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    /// // Across this ray, u is y and v is x. On the border the triangle is met, one step of f64 farther it is not.
    /// let cast = ExactCast::new(&triangle);
    /// assert_eq!(cast.first_moved(&ray, Sides::Both, [0.5, 0.0]), [FaceId(0)]);
    /// assert!(cast.first_moved(&ray, Sides::Both, [0.5_f64.next_up(), 0.0]).is_empty());
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn first_moved(&self, ray: &CastRay, sides: Sides, by: [f64; 2]) -> Vec<FaceId> {
        let query = QueryRay::moved(ray, by);
        let mut nearest = Nearest::new(sides);
        walk_bundle(self.bvh(), &moved_bundle(ray, by), ray, |face| nearest.see(face, &query));
        nearest.sorted().iter().map(|face| face.id).collect()
    }

    /// Whether the ray meets anything.
    pub fn any(&self, ray: &CastRay, sides: Sides) -> bool {
        let query = QueryRay::new(ray);
        let mut is_met = false;
        self.walk(ray, |face| {
            is_met = is_met || face.met_side(&query, sides).is_some();
            if is_met { Next::Stop } else { Next::On }
        });
        is_met
    }

    /// [`any`](Self::any) of many rays, in their order, which is quicker than one after the other.
    pub fn any_of(&self, rays: &[CastRay], sides: Sides) -> Vec<bool> {
        let mut is_met = vec![false; rays.len()];
        let mut walks = AnyWalks {
            cast: self,
            sides,
            rays: rays.iter().enumerate(),
            places: [const { None }; TOGETHER],
            is_met: &mut is_met,
        };
        self.tree.wide.walk_together(self.mesh.vertices(), &mut walks, how_many_together(rays));
        is_met
    }

    /// The nearest faces, in ascending order.
    pub(super) fn nearest(&self, ray: &CastRay, sides: Sides) -> Vec<Triangle> {
        let query = QueryRay::new(ray);
        let mut nearest = Nearest::new(sides);
        self.walk(ray, |face| nearest.see(face, &query));
        nearest.sorted()
    }
}

/// Gets the index of a ray, what it reads, and what decided that.
type EachMeeting<'e, 'r> = dyn FnMut(usize, &Reading<(CastMeeting<'r>, u32)>, DecidedBy) + 'e;

/// Many rays on their way to their nearest faces; `each` gets the index of every ray whose way is over.
struct FirstWalks<'c, 'r, E> {
    cast: &'c ExactCast<'c>,
    sides: Sides,
    rays: Enumerate<slice::Iter<'r, CastRay>>,
    places: [Option<(usize, QueryRay<'r>, Nearest)>; TOGETHER],
    each: E,
}

impl<'r, E: FnMut(usize, &QueryRay<'r>, &Nearest)> Rays for FirstWalks<'_, 'r, E> {
    #[inline]
    fn begin(&mut self, place: usize) -> Option<FrameRay> {
        loop {
            let (index, ray) = self.rays.next()?;
            let (query, mut nearest) = (QueryRay::new(ray), Nearest::new(self.sides));
            match self.cast.tree.wide.ray(ray) {
                Some(in_frame) => {
                    self.places[place] = Some((index, query, nearest));
                    return Some(in_frame);
                }
                None => {
                    walk_bundle(self.cast.bvh(), &bundle(ray), ray, |face| nearest.see(face, &query));
                    (self.each)(index, &query, &nearest);
                }
            }
        }
    }

    #[inline]
    fn see(&mut self, place: usize, face: &Triangle) -> Next {
        let Some((_, query, nearest)) = &mut self.places[place] else { return Next::Stop };
        nearest.see(face, query)
    }

    #[inline]
    fn end(&mut self, place: usize) {
        if let Some((index, query, nearest)) = &self.places[place] {
            (self.each)(*index, query, nearest);
        }
    }
}

/// Many rays on their way to any face.
struct AnyWalks<'c, 'r> {
    cast: &'c ExactCast<'c>,
    sides: Sides,
    rays: Enumerate<slice::Iter<'r, CastRay>>,
    places: [Option<(usize, QueryRay<'r>)>; TOGETHER],
    is_met: &'c mut [bool],
}

impl Rays for AnyWalks<'_, '_> {
    #[inline]
    fn begin(&mut self, place: usize) -> Option<FrameRay> {
        loop {
            let (index, ray) = self.rays.next()?;
            match self.cast.tree.wide.ray(ray) {
                Some(in_frame) => {
                    self.places[place] = Some((index, QueryRay::new(ray)));
                    return Some(in_frame);
                }
                None => self.is_met[index] = self.cast.any(ray, self.sides),
            }
        }
    }

    #[inline]
    fn see(&mut self, place: usize, face: &Triangle) -> Next {
        let Some((index, query)) = &self.places[place] else { return Next::Stop };
        self.is_met[*index] = face.met_side(query, self.sides).is_some();
        if self.is_met[*index] { Next::Stop } else { Next::On }
    }

    #[inline]
    fn end(&mut self, _: usize) {}
}

/// The nearest of the faces that a ray meets.
struct Nearest {
    sides: Sides,
    /// One of them, and how it is met.
    first: Option<(Triangle, Met)>,
    /// The others at exactly its t.
    others: Vec<(Triangle, Side)>,
}

impl Nearest {
    fn new(sides: Sides) -> Self {
        Self { sides, first: None, others: Vec::new() }
    }

    /// Looks at a face, in any order.
    #[inline]
    fn see(&mut self, face: &Triangle, query: &QueryRay<'_>) -> Next {
        let Some(met) = face.met(query, self.sides) else { return Next::On };
        // By the intervals of t where these are apart, else exactly.
        let order = match &self.first {
            None => Ordering::Less,
            Some((_, kept)) if met.t.low > kept.t.high => Ordering::Greater,
            Some((_, kept)) if met.t.high < kept.t.low => Ordering::Less,
            Some((kept, _)) => face.compare(kept, query),
        };
        match order {
            Ordering::Less => {
                self.others.clear();
                self.first = Some((*face, met));
                // From here on only faces up to the nearest matter.
                return Next::UpTo(met.t.high);
            }
            Ordering::Equal => self.others.push((*face, met.side)),
            Ordering::Greater => {}
        }
        Next::On
    }

    /// What the ray's sensor reads of them, and what decided it.
    #[inline]
    fn meeting<'r>(
        &self,
        ray: &'r CastRay,
        query: &QueryRay<'r>,
    ) -> (Reading<(CastMeeting<'r>, u32)>, DecidedBy) {
        let lowest = self.lowest();
        let is_too_near =
            lowest.is_some_and(|(face, _)| ray.t_blind > 0.0 && face.is_before(ray.t_blind, query));
        let decided_by = query.decided_by();
        let read = match lowest {
            None => Reading::Miss,
            Some(_) if is_too_near => Reading::TooNear,
            Some((face, side)) => Reading::Hit((CastMeeting::new(ray, face, side), self.count() as u32)),
        };
        (read, decided_by)
    }

    fn count(&self) -> usize {
        usize::from(self.first.is_some()) + self.others.len()
    }

    /// The face of the lowest index, and the side of it that is met.
    fn lowest(&self) -> Option<(Triangle, Side)> {
        let (face, met) = self.first?;
        let lower = |a: (Triangle, Side), b: (Triangle, Side)| if b.0.id < a.0.id { b } else { a };
        Some(self.others.iter().copied().fold((face, met.side), lower))
    }

    /// All of them, in ascending order.
    fn sorted(&self) -> Vec<Triangle> {
        let others = self.others.iter().map(|(face, _)| *face);
        let mut faces: Vec<Triangle> = self.first.iter().map(|(face, _)| *face).chain(others).collect();
        faces.sort_by_key(|face| face.id);
        faces
    }
}
