//! What a candidate may do otherwise: each mistake is undone on its own numbers, or in the question, and judged again.

use glam::{DVec3, Vec3Swizzles};
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, FaceId, Pose, Precision, Side, Sides, Triangles};

use crate::comparison::{Stated, compare_with};

/// Rays on which mistakes are tried, at most.
const MAX_TRIED: usize = 2000;

/// Rays that are judged first: a mistake that explains nothing is given up after them.
const FIRST_RAYS: usize = 64;

/// Rays that are judged at a time after them.
const NEXT_RAYS: usize = 4096;

/// What explains why a candidate is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// The mistake, or the two, in words.
    pub mistakes: Vec<String>,
    /// Rays that are not wrong once it is undone, of those that were tried.
    pub agree: usize,
    /// Rays that were tried.
    pub tried: usize,
}

impl Explanation {
    /// One sentence.
    pub fn sentence(&self) -> String {
        let share = 100.0 * self.agree as f64 / self.tried as f64;
        format!("{share:.4} % agree if {}", self.mistakes.join(", and "))
    }
}

/// A question and its stated answers.
#[derive(Clone)]
pub(super) struct Trial {
    pub(super) rays: Vec<CastRay>,
    sides: Sides,
    pub(super) stated: Stated,
    pub(super) precision: Precision,
    /// Half of it is what a mistake adds to the bounds of points that follow it, in the mesh's unit; 0 without such a mistake.
    pub(super) allowance: f64,
    /// The index in the pack of each ray.
    pub(super) indices: Vec<usize>,
    /// The points of a cloud, from which t and point of `stated` follow.
    pub(super) cloud: Option<CloudPart>,
}

/// The points of a cloud, one for each ray.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct CloudPart {
    /// As the file has them, in its own frame; NaN where there is none.
    pub(super) raw: Vec<DVec3>,
    /// How far storing may have moved each.
    pub(super) error: Vec<f64>,
    /// The pose of the file's frame in the mesh's; `None`: it is the mesh's.
    pub(super) pose: Vec<Option<Pose>>,
}

impl CloudPart {
    /// The points of the rays with these indices.
    pub(super) fn some_of(&self, indices: &[usize]) -> Self {
        Self {
            raw: indices.iter().map(|&index| self.raw[index]).collect(),
            error: indices.iter().map(|&index| self.error[index]).collect(),
            pose: indices.iter().map(|&index| self.pose[index]).collect(),
        }
    }

    /// A point in the mesh's frame, and how far rounding may have moved it.
    pub(super) fn point(&self, k: usize) -> (DVec3, f64) {
        match self.pose[k] {
            None => (self.raw[k], self.error[k]),
            Some(pose) => {
                // A pose rounds each part at most 16 times, by the unit roundoff of what it adds; the program's and this one.
                let size = self.raw[k].length() + pose.position.length();
                (pose * self.raw[k], self.error[k] + 32.0 * Precision::F64.unit_roundoff * size)
            }
        }
    }

    /// Puts t and point of these rays in their place.
    pub(super) fn state(&self, rays: &[CastRay], stated: &mut Stated) {
        let points: Vec<(DVec3, f64)> = (0..rays.len()).map(|k| self.point(k)).collect();
        let t = |(ray, (point, _)): (&CastRay, &(DVec3, f64))| {
            (*point - ray.origin).dot(ray.direction) / ray.direction.length_squared()
        };
        stated.t = Some(rays.iter().zip(&points).map(t).collect());
        stated.point = Some(points.iter().map(|(point, _)| *point).collect());
        let lengths = rays.iter().map(|ray| ray.direction.length());
        stated.stored.t = Some(lengths.zip(&points).map(|(length, (_, error))| error / length).collect());
        stated.stored.point = Some(points.iter().map(|(_, error)| *error).collect());
    }
}

/// A mistake that one kind of pack alone has.
pub(super) struct Extra<'a> {
    /// In words.
    pub(super) words: String,
    /// What undoes it.
    pub(super) undo: Box<dyn Fn(&mut Trial) + 'a>,
    /// Whether it is tried together with another one.
    pub(super) is_common: bool,
    pub(super) group: Group,
}

/// Which mistakes take back what others do: two of one group are no pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    /// Of lengths by a factor.
    Factors,
    /// Of the numbers of faces.
    Numbers,
    /// All others: any two are a pair.
    Others,
}

/// A cloud in place of arrays: its points, and the mistakes of clouds.
pub(super) struct OfCloud<'a> {
    /// The points of all rays.
    pub(super) part: &'a CloudPart,
    /// Mistakes without numbers.
    pub(super) extras: Vec<Extra<'a>>,
    /// Mistakes with a number, which is estimated from a trial.
    #[allow(clippy::type_complexity, reason = "one function, which borrows the same cloud")]
    pub(super) estimated: Box<dyn Fn(&Trial) -> Vec<Extra<'a>> + 'a>,
    /// Whether the ends of its rays are those of a sensor: if not, what ignores them is no mistake.
    pub(super) has_ends: bool,
}

/// A mistake in words, and what undoes it.
struct Mistake {
    words: &'static str,
    undo: fn(&mut Trial),
}

fn each<T>(array: &mut Option<Vec<T>>, change: impl Fn(usize, &mut T)) {
    if let Some(array) = array {
        array.iter_mut().enumerate().for_each(|(index, value)| change(index, value));
    }
}

fn scale(trial: &mut Trial, by: f64) {
    each(&mut trial.stated.t, |_, t| *t *= by);
    each(&mut trial.stated.range, |_, range| *range *= by);
    each(&mut trial.stated.point, |_, point| *point *= by);
    let stored = &mut trial.stated.stored;
    for errors in [&mut stored.t, &mut stored.range, &mut stored.point] {
        each(errors, |_, error| *error *= by);
    }
}

fn axes(trial: &mut Trial, change: fn(DVec3) -> DVec3) {
    each(&mut trial.stated.point, |_, point| *point = change(*point));
    each(&mut trial.stated.normal, |_, normal| *normal = change(*normal));
}

fn weights(trial: &mut Trial, change: fn(DVec3) -> DVec3) {
    each(&mut trial.stated.barycentric, |_, weights| *weights = change(*weights));
}

fn renumber(trial: &mut Trial, by: i64) {
    each(&mut trial.stated.face, |_, face| {
        *face = face.and_then(|face| u32::try_from(i64::from(face.0) + by).ok().map(FaceId));
    });
}

/// Puts another number that is not finite in the place of one that stands for no hit.
fn misses_at(trial: &mut Trial, number: f64, other: f64) {
    let miss = |_: usize, distance: &mut f64| {
        if *distance == number {
            *distance = other;
        }
    };
    each(&mut trial.stated.t, miss);
    each(&mut trial.stated.range, miss);
}

/// Conventions of the numbers of faces.
const OF_NUMBERS: &[Mistake] = &[
    Mistake { words: "face indices are 1 too large: the first face is 0", undo: |trial| renumber(trial, -1) },
    Mistake { words: "face indices are 1 too small: the first face is 0", undo: |trial| renumber(trial, 1) },
];

/// Units of lengths.
const OF_UNITS: &[Mistake] = &[
    Mistake { words: "lengths are in thousandths of the mesh's unit", undo: |trial| scale(trial, 1e-3) },
    Mistake { words: "lengths are in hundredths of the mesh's unit", undo: |trial| scale(trial, 1e-2) },
    Mistake { words: "lengths are in thousands of the mesh's unit", undo: |trial| scale(trial, 1e3) },
    Mistake { words: "lengths are in feet", undo: |trial| scale(trial, 0.3048) },
];

/// Conventions of arrays.
const OF_ARRAYS: &[Mistake] = &[
    Mistake {
        words: "t.npy holds the range: t is the range over |d|",
        undo: |trial| {
            let lengths: Vec<f64> = trial.rays.iter().map(|ray| ray.direction.length()).collect();
            each(&mut trial.stated.t, |index, t| *t /= lengths[index]);
            each(&mut trial.stated.stored.t, |index, error| *error /= lengths[index]);
        },
    },
    Mistake {
        words: "range.npy holds t: the range is t |d|",
        undo: |trial| {
            let lengths: Vec<f64> = trial.rays.iter().map(|ray| ray.direction.length()).collect();
            each(&mut trial.stated.range, |index, range| *range *= lengths[index]);
            each(&mut trial.stated.stored.range, |index, error| *error *= lengths[index]);
        },
    },
    Mistake {
        words: "points and normals are (x, -z, y) of the mesh's (x, y, z)",
        undo: |trial| axes(trial, |v| DVec3::new(v.x, v.z, -v.y)),
    },
    Mistake {
        words: "points and normals are (x, z, -y) of the mesh's (x, y, z)",
        undo: |trial| axes(trial, |v| DVec3::new(v.x, -v.z, v.y)),
    },
    Mistake { words: "y and z of points and normals are swapped", undo: |trial| axes(trial, |v| v.xzy()) },
    Mistake { words: "x and y of points and normals are swapped", undo: |trial| axes(trial, |v| v.yxz()) },
    Mistake {
        words: "normals point inward",
        undo: |trial| each(&mut trial.stated.normal, |_, normal| *normal = -*normal),
    },
    Mistake {
        words: "normals are turned to the ray: they point to the face's front",
        undo: |trial| {
            let sides = trial.stated.side.clone();
            let is_back = |index: usize, cos: Option<f64>| match &sides {
                Some(sides) => sides[index] == Some(Side::Back),
                None => cos.is_some_and(|cos| cos < 0.0),
            };
            let cosines = trial.stated.cos_incidence.clone();
            each(&mut trial.stated.normal, |index, normal| {
                if is_back(index, cosines.as_ref().map(|cosines| cosines[index])) {
                    *normal = -*normal;
                }
            });
        },
    },
    Mistake {
        words: "normals are not 1 long",
        undo: |trial| {
            // Storing moves each of three parts, and so the length that they are divided by.
            if let (Some(normals), Some(errors)) = (&trial.stated.normal, &mut trial.stated.stored.normal) {
                let pairs = normals.iter().zip(errors).filter(|(normal, _)| **normal != DVec3::ZERO);
                pairs.for_each(|(normal, error)| *error *= 3.0 / normal.length());
            }
            each(&mut trial.stated.normal, |_, normal| *normal = normal.normalize_or_zero());
        },
    },
    Mistake {
        words: "cosines of incidence have the other sign: a front has a positive one",
        undo: |trial| each(&mut trial.stated.cos_incidence, |_, cos| *cos = -*cos),
    },
    Mistake {
        words: "cosines of incidence are without sign: a back has a negative one",
        undo: |trial| {
            let sides = trial.stated.side.clone();
            each(&mut trial.stated.cos_incidence, |index, cos| {
                if sides.as_ref().is_some_and(|sides| sides[index] == Some(Side::Back)) {
                    *cos = -cos.abs();
                }
            });
        },
    },
    Mistake {
        words: "angles in radians stand in place of their cosines",
        undo: |trial| each(&mut trial.stated.cos_incidence, |_, cos| *cos = libm::cos(*cos)),
    },
    Mistake {
        words: "angles in degrees stand in place of their cosines",
        undo: |trial| {
            each(&mut trial.stated.cos_incidence, |_, cos| *cos = libm::cos(cos.to_radians()));
            each(&mut trial.stated.stored.cos_incidence, |_, error| *error = error.to_radians());
        },
    },
    Mistake {
        words: "fronts and backs are taken for each other",
        undo: |trial| {
            each(&mut trial.stated.side, |_, side| {
                *side = side.map(|side| if side == Side::Front { Side::Back } else { Side::Front });
            });
        },
    },
    Mistake {
        words: "barycentric weights are in the order (b, c, a): they are those of a, b, c",
        undo: |trial| weights(trial, |w| w.zxy()),
    },
    Mistake {
        words: "barycentric weights are in the order (c, a, b): they are those of a, b, c",
        undo: |trial| weights(trial, |w| w.yzx()),
    },
    Mistake {
        words: "the first two barycentric weights are swapped: they are those of a, b, c",
        undo: |trial| weights(trial, |w| w.yxz()),
    },
    Mistake {
        words: "the last two barycentric weights are swapped: they are those of a, b, c",
        undo: |trial| weights(trial, |w| w.xzy()),
    },
];

/// Rules of rays.
const OF_RULES: &[Mistake] = &[
    Mistake {
        words: "rays hit the backs of faces: only fronts are asked for",
        undo: |trial| trial.sides = Sides::Both,
    },
    Mistake {
        words: "rays pass through the backs of faces: both sides are asked for",
        undo: |trial| trial.sides = Sides::Fronts,
    },
    Mistake {
        words: "t_min is ignored",
        undo: |trial| trial.rays.iter_mut().for_each(|ray| ray.t_min = 0.0),
    },
    Mistake {
        words: "t_max is ignored",
        undo: |trial| trial.rays.iter_mut().for_each(|ray| ray.t_max = f64::INFINITY),
    },
    Mistake {
        words: "t_min and t_max are taken for ranges: they are values of t",
        undo: |trial| {
            for ray in &mut trial.rays {
                let length = ray.direction.length();
                (ray.t_min, ray.t_max) = (ray.t_min / length, ray.t_max / length);
            }
        },
    },
];

/// Numbers that mean no hit.
const OF_MISSES: &[Mistake] = &[
    Mistake {
        words: "0 means no hit: declare --miss 0",
        undo: |trial| {
            misses_at(trial, 0.0, f64::INFINITY);
            each(&mut trial.stated.face, |_, face| *face = face.filter(|face| face.0 != 0));
        },
    },
    Mistake {
        words: "-1 means no hit: declare --miss -1",
        undo: |trial| misses_at(trial, -1.0, f64::INFINITY),
    },
];

/// Mistakes about what is too near for a sensor.
const ABOUT_SENSORS: &[Mistake] = &[
    Mistake {
        words: "rays pass through what is nearer than the sensor's shortest range: the nearest surface decides",
        undo: |trial| {
            for ray in &mut trial.rays {
                (ray.t_min, ray.t_blind) = (ray.t_min.max(ray.t_blind), 0.0);
            }
        },
    },
    Mistake {
        words: "the sensor's shortest range is ignored: what is nearer is too near, -Inf",
        undo: |trial| trial.rays.iter_mut().for_each(|ray| ray.t_blind = 0.0),
    },
    Mistake {
        words: "what is too near is not told from a miss: it is -Inf, a miss is +Inf",
        // NaN says neither.
        undo: |trial| misses_at(trial, f64::INFINITY, f64::NAN),
    },
    Mistake {
        words: "-Inf means no hit: declare --miss -inf",
        undo: |trial| misses_at(trial, f64::NEG_INFINITY, f64::INFINITY),
    },
];

/// Single precision excuses much: it is not half of an explanation.
const PRECISION: Mistake = Mistake {
    words: "arithmetic is of single precision: declare --arithmetic f32",
    undo: |trial| trial.precision = Precision::F32,
};

/// A mistake of any kind.
struct Named<'a> {
    words: &'a str,
    undo: &'a dyn Fn(&mut Trial),
    is_common: bool,
    group: Group,
}

impl<'a> Named<'a> {
    fn of(mistake: &'a Mistake, group: Group) -> Self {
        Self { words: mistake.words, undo: &mistake.undo, is_common: true, group }
    }

    fn extra(extra: &'a Extra<'_>) -> Self {
        Self { words: &extra.words, undo: &*extra.undo, is_common: extra.is_common, group: extra.group }
    }

    /// Whether it may be one of two with another.
    fn pairs_with(&self, other: &Self) -> bool {
        self.group == Group::Others || self.group != other.group
    }
}

impl Trial {
    /// The trial without a mistake; `None` if that changes nothing.
    fn without(&self, mistake: &Named<'_>) -> Option<Self> {
        let mut trial = self.clone();
        (mistake.undo)(&mut trial);
        if let Some(cloud) = &trial.cloud {
            cloud.state(&trial.rays, &mut trial.stated);
        }
        (!trial.has_the_bits_of(self)).then_some(trial)
    }

    /// Whether every number is the same, NaN included.
    fn has_the_bits_of(&self, other: &Self) -> bool {
        let numbers = |a: &Option<Vec<f64>>, b: &Option<Vec<f64>>| match (a, b) {
            (Some(a), Some(b)) => a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()),
            (a, b) => a.is_none() && b.is_none(),
        };
        let bits = |v: &DVec3| v.to_array().map(f64::to_bits);
        let vectors = |a: &Option<Vec<DVec3>>, b: &Option<Vec<DVec3>>| match (a, b) {
            (Some(a), Some(b)) => a.iter().zip(b).all(|(a, b)| bits(a) == bits(b)),
            (a, b) => a.is_none() && b.is_none(),
        };
        let (a, b) = (&self.stated, &other.stated);
        self.sides == other.sides
            && self.precision == other.precision
            && self.allowance == other.allowance
            && self.rays == other.rays
            && a.face == b.face
            && a.side == b.side
            && numbers(&a.t, &b.t)
            && numbers(&a.range, &b.range)
            && numbers(&a.cos_incidence, &b.cos_incidence)
            && vectors(&a.point, &b.point)
            && vectors(&a.normal, &b.normal)
            && vectors(&a.barycentric, &b.barycentric)
    }

    /// Number of wrong rays, or `None` as soon as there are more than `most`.
    fn wrong(&self, exact: &ExactCast<'_>, mesh: &Triangles, most: usize) -> Option<usize> {
        let (mut wrong, mut judged) = (0, 0);
        while judged < self.rays.len() {
            let end = judged + if judged == 0 { FIRST_RAYS } else { NEXT_RAYS };
            let chunk: Vec<usize> = (judged..end.min(self.rays.len())).collect();
            let rays = &self.rays[judged..judged + chunk.len()];
            let stated = self.stated.some_of(&chunk);
            wrong +=
                compare_with(exact, mesh, rays, self.sides, &stated, self.precision).counts().wrong as usize;
            if wrong > most {
                return None;
            }
            judged += chunk.len();
        }
        Some(wrong)
    }

    /// Whether a ray is one of a sensor with a shortest range, or an answer says that it is.
    fn is_about_sensors(&self) -> bool {
        let says = |distances: &Option<Vec<f64>>| distances.iter().flatten().any(|t| *t == f64::NEG_INFINITY);
        self.rays.iter().any(|ray| ray.t_blind > 0.0) || says(&self.stated.t) || says(&self.stated.range)
    }
}

/// Looks for the mistake, or the two, without which hardly any ray is wrong. `lengths` finds numbers of arrays, and
/// `wrong` are the indices of wrong rays.
pub(super) fn explain(
    exact: &ExactCast<'_>,
    mesh: &Triangles,
    (rays, sides): (&[CastRay], Sides),
    (stated, of_cloud): (&Stated, Option<&OfCloud<'_>>),
    lengths: &dyn Fn(&Trial) -> Vec<Extra<'static>>,
    precision: Precision,
    wrong: &[usize],
) -> Option<Explanation> {
    // Wrong rays, and as many others: what is undone must not make these wrong.
    let mut indices: Vec<usize> = sample(wrong.len()).map(|k| wrong[k]).chain(sample(rays.len())).collect();
    indices.sort_unstable();
    indices.dedup();
    // Wrong rays first: a mistake that does not explain them is given up after a few.
    indices.sort_by_key(|index| wrong.binary_search(index).is_err());
    let trial_of = |indices: Vec<usize>| Trial {
        rays: indices.iter().map(|&index| rays[index]).collect(),
        sides,
        stated: stated.some_of(&indices),
        precision,
        allowance: 0.0,
        cloud: of_cloud.map(|of_cloud| of_cloud.part.some_of(&indices)),
        indices,
    };
    let trial = trial_of(indices);
    // What explains the sample has to explain all: a few right rays may say otherwise.
    let explains_all = |mistakes: &[&Named<'_>]| {
        let all = || trial_of((0..rays.len()).collect());
        let without = |trial: Trial, mistake: &&Named<'_>| trial.without(mistake);
        trial.indices.len() == rays.len()
            || mistakes
                .iter()
                .try_fold(all(), without)
                .is_some_and(|trial| trial.wrong(exact, mesh, wrong.len() / 100).is_some())
    };
    let before = trial.wrong(exact, mesh, usize::MAX)?;
    // An explanation leaves at most one in a hundred of them wrong.
    let most = before / 100;
    let tried = trial.indices.len();
    let explanation =
        |mistakes: Vec<String>, left: usize| Explanation { mistakes, agree: tried - left, tried };
    let about_sensors: &[Mistake] = if trial.is_about_sensors() { ABOUT_SENSORS } else { &[] };
    // The points of a cloud are no arrays: their conventions are its own.
    let lists: &[(&[Mistake], Group)] = match of_cloud {
        None => &[
            (OF_NUMBERS, Group::Numbers),
            (OF_UNITS, Group::Factors),
            (OF_ARRAYS, Group::Others),
            (OF_RULES, Group::Others),
            (OF_MISSES, Group::Others),
        ],
        Some(of_cloud) if !of_cloud.has_ends => &[],
        Some(_) => &[(OF_RULES, Group::Others)],
    };
    let lists = lists.iter().copied().chain([(about_sensors, Group::Others)]);
    let extras = of_cloud.iter().flat_map(|of_cloud| &of_cloud.extras).map(Named::extra);
    let of_lists = lists.flat_map(|(list, group)| list.iter().map(move |mistake| Named::of(mistake, group)));
    let mistakes: Vec<Named<'_>> = extras.chain(of_lists).collect();
    let estimated_of = |trial: &Trial| match of_cloud {
        Some(of_cloud) => (of_cloud.estimated)(trial),
        None => lengths(trial),
    };
    let estimated = estimated_of(&trial);
    let precision = Named::of(&PRECISION, Group::Others);
    let single = |mistake| {
        let left = trial.without(&mistake)?.wrong(exact, mesh, most)?;
        Some((mistake, left))
    };
    // Single precision excuses much: it comes last.
    let common = mistakes.iter().map(|mistake| Named { ..*mistake });
    let singles = common.chain(estimated.iter().map(Named::extra)).chain([precision]);
    let mut singles: Vec<(Named<'_>, usize)> = singles.filter_map(single).collect();
    // All rays are asked of the best one first: mostly it holds, and no other is asked.
    singles.sort_by_key(|(_, left)| *left);
    if let Some((mistake, left)) = singles.into_iter().find(|(mistake, _)| explains_all(&[mistake])) {
        return Some(explanation(vec![mistake.words.to_string()], left));
    }
    // Both of a pair change something: else the pair is a single mistake.
    let mut best: Option<(Vec<String>, usize)> = None;
    for (k, first) in mistakes.iter().enumerate().filter(|(_, first)| first.is_common) {
        let Some(once) = trial.without(first) else { continue };
        let estimated = estimated_of(&once);
        let others = mistakes.iter().skip(k + 1).filter(|second| second.is_common);
        let others = others.map(|second| Named { ..*second }).chain(estimated.iter().map(Named::extra));
        for second in others.filter(|second| first.pairs_with(second)) {
            let most = match best {
                Some((_, 0)) => return best.map(|(mistakes, left)| explanation(mistakes, left)),
                Some((_, kept)) => kept - 1,
                None => most,
            };
            if let Some(left) = once.without(&second).and_then(|twice| twice.wrong(exact, mesh, most))
                && explains_all(&[first, &second])
            {
                best = Some((vec![first.words.to_string(), second.words.to_string()], left));
            }
        }
    }
    best.map(|(mistakes, left)| explanation(mistakes, left))
}

/// Half of [`MAX_TRIED`] of so many, or all: one of each of as many equal parts. Which one is drawn, for parts of the length of a
/// firing sequence would have the same channel each.
fn sample(all: usize) -> impl Iterator<Item = usize> {
    let every = all.div_ceil(MAX_TRIED / 2).max(1);
    (0..all).step_by(every).map(move |start| {
        let drawn = split_mix(start as u64) % every as u64;
        (start + drawn as usize).min(all - 1)
    })
}

/// The first number of the generator with this seed. (S. Vigna, splitmix64.c)
fn split_mix(seed: u64) -> u64 {
    let mut mixed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}
