//! What is asked of each ray, and the referee's answers.

use glam::DVec3;
use rayon::prelude::*;
use raypencil_referee::{CastHit, CastMeeting, DecidedBy, ExactCast, HitGroup, Margins, SidedFace};
use raypencil_scene::pattern::EchoLight;
use raypencil_scene::{CastRay, FaceId, Progress, Reading, Side, Sides, Triangles};
use raypencil_tracer::{TracedHit, TracerCast};

/// What is asked beside the first hit.
///
/// `any` and `all` ask where the ray meets the mesh between its ends, not what a sensor reads: they know of hits that are too
/// near for it, and of those behind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Questions {
    /// Whether anything is hit.
    pub any: bool,
    /// All hits, in exact order.
    pub all: bool,
    /// How far each ray may be moved sideways before its answer changes.
    pub margins: bool,
}

/// The first hit of a ray. Numbers are correctly rounded to `f64`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstHit {
    /// The face; of several at the same t, the lowest index.
    pub face: FaceId,
    /// The side that is met.
    pub side: Side,
    /// Number of faces that are met at exactly this t: 1 if there is no tie.
    pub ties: u32,
    /// The ray's parameter.
    pub t: f64,
    /// Distance from the ray's origin, in the mesh's unit.
    pub range: f64,
    /// The point.
    pub point: DVec3,
    /// The unit normal to the face's front.
    pub normal: DVec3,
    /// The weights of the face's corners.
    pub barycentric: [f64; 3],
    /// Cosine of the angle between the normal and the reversed ray: negative where the back is met.
    pub cos_incidence: f64,
}

impl FirstHit {
    /// The light of a small spot on a diffuse surface, relative: abs(cos psi) / R^2, and of it what surface and air leave.
    pub fn light(&self, echo: &EchoLight) -> f64 {
        self.cos_incidence.abs() / (self.range * self.range) * echo.left(self.range)
    }
}

/// All faces that a ray meets at exactly the same t.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupAtT {
    /// The ray's parameter, correctly rounded. Groups are apart even where their rounded t are the same.
    pub t: f64,
    /// The faces, in ascending order.
    pub faces: Vec<SidedFace>,
    /// How often the surface is crossed here to its inside, less how often to its outside.
    pub crossing: i32,
}

/// All hits of all rays, one after the other: the arrays `all.*` of files.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AllColumns {
    /// Where the hits of each ray begin, and one past the last of all.
    pub start: Vec<u64>,
    /// Index of the face of each hit.
    pub face: Vec<u32>,
    /// 1 front, -1 back.
    pub side: Vec<i8>,
    /// The ray's parameter.
    pub t: Vec<f64>,
    /// Which group of its ray the hit belongs to. Hits at exactly one t are a group.
    pub group: Vec<u32>,
    /// How often the surface is crossed at the group to its inside, less how often to its outside.
    pub crossing: Vec<i32>,
}

impl AllColumns {
    /// The groups of each ray, laid one after the other.
    pub fn of(all: &[Vec<GroupAtT>]) -> Self {
        let mut columns = Self { start: vec![0], ..Self::default() };
        for groups in all {
            for (index, group) in groups.iter().enumerate() {
                for met in &group.faces {
                    columns.face.push(met.face.0);
                    columns.side.push(side_number(met.side));
                    columns.t.push(group.t);
                    columns.group.push(index as u32);
                    columns.crossing.push(group.crossing);
                }
            }
            columns.start.push(columns.face.len() as u64);
        }
        columns
    }
}

/// Of how many rays each arithmetic decided the first hit.
///
/// Signs are told in plain `f64` with a proven bound where that is certain, else in intervals of `f64`, else exactly. A ray counts
/// where the slowest of its signs was told.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DecidedCounts {
    /// Rays of which every sign was certain in plain `f64`.
    pub filter: u64,
    /// Rays that needed intervals.
    pub intervals: u64,
    /// Rays that needed exact arithmetic.
    pub exact: u64,
}

impl DecidedCounts {
    pub(crate) fn add(&mut self, decided_by: DecidedBy) {
        match decided_by {
            DecidedBy::Filter => self.filter += 1,
            DecidedBy::Intervals => self.intervals += 1,
            DecidedBy::Exact => self.exact += 1,
        }
    }

    /// The counts of both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            filter: self.filter + other.filter,
            intervals: self.intervals + other.intervals,
            exact: self.exact + other.exact,
        }
    }
}

/// The answers to some rays, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Answers {
    /// The first hit of each ray, where there is one and it is not too near.
    pub first: Vec<Reading<FirstHit>>,
    /// Whether each ray hits anything, if that was asked.
    pub any: Option<Vec<bool>>,
    /// All hits of each ray, if they were asked for.
    pub all: Option<Vec<Vec<GroupAtT>>>,
    /// The margins of each ray, if they were asked for.
    pub margins: Option<Vec<Margins>>,
    /// What decided the first hits; `None` if they are not the referee's.
    pub decided: Option<DecidedCounts>,
}

/// A side as files have it: 1 front, -1 back.
pub(crate) fn side_number(side: Side) -> i8 {
    match side {
        Side::Front => 1,
        Side::Back => -1,
    }
}

impl Answers {
    /// First hits by the tracer, in `f64`; each is one face, the lowest of those at its t.
    pub fn by_tracer(mesh: &Triangles, rays: &[CastRay], sides: Sides) -> Self {
        Self::traced(&TracerCast::new(mesh), rays, sides)
    }

    /// The same with a tree that is there already.
    pub fn traced(tracer: &TracerCast, rays: &[CastRay], sides: Sides) -> Self {
        let of_part = |part: &[CastRay]| {
            let mut first = vec![Reading::Miss; part.len()];
            tracer.traverser().first_of_each(part, sides, |index, met| {
                let read = Reading::of(met, |met| part[index].is_too_near(met.t()));
                first[index] = read.map(|met| {
                    let TracedHit { face, side, t, range, point, normal, barycentric, cos_incidence } =
                        *met.hit();
                    FirstHit { face, side, ties: 1, t, range, point, normal, barycentric, cos_incidence }
                });
            });
            first
        };
        let first = rays.par_chunks(TRACED_RAYS_A_PART).flat_map_iter(of_part).collect();
        Self { first, any: None, all: None, margins: None, decided: None }
    }

    /// The first hits, of the rays that have one.
    pub fn hits(&self) -> impl Iterator<Item = &FirstHit> + Clone {
        self.first.iter().filter_map(Reading::hit)
    }

    /// Number of rays that hit something, and of these the number whose first hit is a tie.
    pub fn counts(&self) -> (usize, usize) {
        (self.hits().count(), self.hits().filter(|hit| hit.ties > 1).count())
    }

    /// Number of rays whose nearest hit is too near for their sensor.
    pub fn too_near(&self) -> usize {
        self.first.iter().filter(|read| matches!(read, Reading::TooNear)).count()
    }

    /// Number of rays that hit nothing.
    pub fn misses(&self) -> usize {
        self.first.iter().filter(|read| matches!(read, Reading::Miss)).count()
    }

    /// A distance along each ray as files have it (REP-117): -Inf where the nearest hit is too near, +Inf where nothing is hit.
    pub fn distances(&self, of: impl Fn(&FirstHit) -> f64) -> Vec<f64> {
        let distance = |read: &Reading<FirstHit>| match read {
            Reading::Hit(hit) => of(hit),
            Reading::TooNear => f64::NEG_INFINITY,
            Reading::Miss => f64::INFINITY,
        };
        self.first.iter().map(distance).collect()
    }

    /// Another value of each first hit; `none` where there is none, too near or not.
    pub fn values<T: Clone>(&self, of: impl Fn(&FirstHit) -> T, none: T) -> Vec<T> {
        self.first.iter().map(|read| read.hit().map_or_else(|| none.clone(), &of)).collect()
    }
}

/// Answers rays on a mesh exactly, on all threads.
///
/// All rays must be valid, as those of [`rays_from_bytes`](crate::rays_from_bytes) are.
pub fn cast(
    mesh: &Triangles,
    rays: &[CastRay],
    sides: Sides,
    questions: Questions,
    progress: &dyn Progress,
) -> Answers {
    progress.stage(&format!("building a tree of {} faces", mesh.faces().len()));
    cast_with(&ExactCast::new(mesh), rays, sides, questions, progress)
}

/// [`cast`] with a tree that is there already.
pub fn cast_with(
    exact: &ExactCast<'_>,
    rays: &[CastRay],
    sides: Sides,
    questions: Questions,
    progress: &dyn Progress,
) -> Answers {
    progress.stage(&format!("casting {} rays", rays.len()));
    let parts: Vec<_> = rays.par_chunks(RAYS_A_PART).map(|part| first_of(exact, part, sides)).collect();
    let (mut first, mut decided) = (Vec::with_capacity(rays.len()), DecidedCounts::default());
    for (of_part, counts) in parts {
        first.extend(of_part);
        decided = decided.and(counts);
    }
    let decided = Some(decided);
    Answers { first, decided, ..cast_beside_first(exact, rays, sides, questions, progress) }
}

/// What is asked beside first hits, which stay empty, with a tree that is there already. A few rays are answered on this thread.
pub fn cast_beside_first(
    exact: &ExactCast<'_>,
    rays: &[CastRay],
    sides: Sides,
    questions: Questions,
    progress: &dyn Progress,
) -> Answers {
    let any = questions.any.then(|| any_exactly(exact, rays, sides));
    let all = questions.all.then(|| {
        progress.stage(&format!("all hits of {} rays", rays.len()));
        all_exactly(exact, rays, sides)
    });
    let margins = questions.margins.then(|| {
        progress.stage(&format!("margins of {} rays", rays.len()));
        each(rays, |ray| exact.margins(ray, sides))
    });
    Answers { first: Vec::new(), any, all, margins, decided: None }
}

/// The same by the tracer, which knows no margins. Hits at the same `f64` t are one group; a group's `crossing` is unknown, and 0.
///
/// # Panics
/// If margins are asked for.
pub fn traced_beside_first(
    tracer: &TracerCast,
    rays: &[CastRay],
    sides: Sides,
    questions: Questions,
) -> Answers {
    assert!(!questions.margins, "the tracer has no margins");
    let any = questions.any.then(|| any_traced(tracer, rays, sides));
    let groups = |ray: &CastRay| {
        let hits = tracer.traverser().all(ray, sides);
        let group = |hits: &[TracedHit]| GroupAtT {
            t: hits[0].t,
            faces: hits.iter().map(|hit| SidedFace { face: hit.face, side: hit.side }).collect(),
            crossing: 0,
        };
        hits.chunk_by(|a, b| a.t == b.t).map(group).collect()
    };
    let all = questions.all.then(|| each(rays, groups));
    Answers { first: Vec::new(), any, all, margins: None, decided: None }
}

/// Rays for which it is not worth while to wake other threads.
const FEW_RAYS: usize = 16;

fn each<T: Send>(rays: &[CastRay], answer: impl Fn(&CastRay) -> T + Sync + Send) -> Vec<T> {
    match rays.len() {
        0..=FEW_RAYS => rays.iter().map(answer).collect(),
        _ => rays.par_iter().map(answer).collect(),
    }
}

/// Rays that one thread asks about by itself.
const RAYS_A_PART: usize = 256;

/// The same of the tracer, which learns from the first of them whether the others go quicker together.
pub(crate) const TRACED_RAYS_A_PART: usize = 2048;

fn any_exactly(exact: &ExactCast<'_>, rays: &[CastRay], sides: Sides) -> Vec<bool> {
    match rays.len() {
        0..=FEW_RAYS => exact.any_of(rays, sides),
        _ => rays.par_chunks(RAYS_A_PART).flat_map_iter(|part| exact.any_of(part, sides)).collect(),
    }
}

fn any_traced(tracer: &TracerCast, rays: &[CastRay], sides: Sides) -> Vec<bool> {
    let of_part = |part: &[CastRay]| tracer.traverser().any_of_each(part, sides);
    match rays.len() {
        0..=FEW_RAYS => of_part(rays),
        _ => rays.par_chunks(TRACED_RAYS_A_PART).flat_map_iter(of_part).collect(),
    }
}

fn first_of(
    exact: &ExactCast<'_>,
    rays: &[CastRay],
    sides: Sides,
) -> (Vec<Reading<FirstHit>>, DecidedCounts) {
    let (mut first, mut decided) = (vec![Reading::Miss; rays.len()], DecidedCounts::default());
    exact.first_meetings(rays, sides, |index, read, decided_by| {
        first[index] = match read {
            Reading::Hit((meeting, ties)) => Reading::Hit(first_hit(meeting, *ties)),
            Reading::TooNear => Reading::TooNear,
            Reading::Miss => Reading::Miss,
        };
        decided.add(decided_by);
    });
    (first, decided)
}

fn first_hit(meeting: &CastMeeting<'_>, ties: u32) -> FirstHit {
    let CastHit { face, side, t, range, point, normal, barycentric, cos_incidence } = meeting.hit();
    FirstHit {
        face,
        side,
        ties,
        t: t.double,
        range: range.double,
        point: DVec3::from_array(point.map(|part| part.double)),
        normal: DVec3::from_array(normal.map(|part| part.double)),
        barycentric: barycentric.map(|weight| weight.double),
        cos_incidence: cos_incidence.double,
    }
}

fn all_exactly(exact: &ExactCast<'_>, rays: &[CastRay], sides: Sides) -> Vec<Vec<GroupAtT>> {
    let with_t = |ray: &CastRay, group: HitGroup| {
        let t = exact.meeting(ray, group.faces.first()?.face)?.t().double;
        Some(GroupAtT { t, faces: group.faces, crossing: group.crossing })
    };
    let of_part = |part: &[CastRay]| {
        let mut all = vec![Vec::new(); part.len()];
        exact.all_of_each(part, sides, |index, groups| {
            all[index] = groups.into_iter().filter_map(|group| with_t(&part[index], group)).collect();
        });
        all
    };
    match rays.len() {
        0..=FEW_RAYS => of_part(rays),
        _ => rays.par_chunks(RAYS_A_PART).flat_map_iter(of_part).collect(),
    }
}
