//! What a candidate may do otherwise, in words, and what undoes it on its own numbers or in the question.

use glam::{DVec3, Vec3Swizzles};
use raypencil_scene::{FaceId, Precision, Side, Sides};

use super::trial::{CloudPart, Trial};

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

/// The mistakes of arrays that follow from their numbers or their shape.
pub(super) struct OfArrays<'a> {
    /// Mistakes with a number, which is found from a trial.
    pub(super) numbers: &'a dyn Fn(&Trial) -> Vec<Extra<'static>>,
    /// Orders of the answers: the first of two mistakes, for others change the answers of a ray.
    pub(super) orders: &'a [Extra<'a>],
    /// Mistakes that are no half of two, unless the other one is single precision.
    pub(super) alone: &'a [Extra<'a>],
}

/// A cloud in place of arrays: its points, and the mistakes of clouds.
pub(super) struct OfCloud<'a> {
    /// The points of all rays.
    pub(super) part: &'a CloudPart,
    /// Mistakes without numbers.
    pub(super) extras: Vec<Extra<'a>>,
    /// Those of them, in words, that lay points on other rays.
    pub(super) laid: Vec<String>,
    /// Mistakes with a number, which is estimated from a trial.
    #[allow(clippy::type_complexity, reason = "one function, which borrows the same cloud")]
    pub(super) estimated: Box<dyn Fn(&Trial) -> Vec<Extra<'a>> + 'a>,
    /// Whether the ends of its rays are those of a sensor: if not, what ignores them is no mistake.
    pub(super) has_ends: bool,
}

/// A mistake in words, and what undoes it.
pub(super) struct Mistake {
    words: &'static str,
    undo: fn(&mut Trial),
}

/// A mistake of any kind.
#[derive(Clone, Copy)]
pub(super) struct Named<'a> {
    pub(super) words: &'a str,
    pub(super) undo: &'a dyn Fn(&mut Trial),
    pub(super) is_common: bool,
    group: Group,
}

impl<'a> Named<'a> {
    pub(super) fn of(mistake: &'a Mistake, group: Group) -> Self {
        Self { words: mistake.words, undo: &mistake.undo, is_common: true, group }
    }

    pub(super) fn extra(extra: &'a Extra<'_>) -> Self {
        Self { words: &extra.words, undo: &*extra.undo, is_common: extra.is_common, group: extra.group }
    }

    /// Whether it may be one of two with another.
    pub(super) fn pairs_with(&self, other: &Self) -> bool {
        self.group == Group::Others || self.group != other.group
    }
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

/// Puts another number that is not finite in the place of one that stands for no hit, where nothing else says that the ray hits.
pub(super) fn misses_at(trial: &mut Trial, number: f64, other: f64) {
    let is_none = |part: f64, _: f64| part == number;
    let hits: Vec<bool> = (0..trial.rays.len()).map(|index| trial.stated.hits_but(index, is_none)).collect();
    let miss = |index: usize, distance: &mut f64| {
        if *distance == number && !hits[index] {
            *distance = other;
        }
    };
    each(&mut trial.stated.t, miss);
    each(&mut trial.stated.range, miss);
    if !other.is_finite() && number.is_finite() {
        trial.stated.without_values(|part, error| (part - number).abs() <= error);
    }
}

/// Takes a number that stands for no hit away, as the declaration of it does.
pub(super) fn declare_miss(trial: &mut Trial, number: f64) {
    let is_none = |part: f64, _: f64| part == number;
    // Where something else says that the ray hits, the number is a face.
    let hits: Vec<bool> =
        (0..trial.rays.len()).map(|index| trial.stated.hits_beside_face(index, is_none)).collect();
    each(&mut trial.stated.face, |index, face| {
        *face = face.filter(|face| f64::from(face.0) != number || hits[index]);
    });
    misses_at(trial, number, f64::INFINITY);
}

/// Conventions of the numbers of faces.
pub(super) const OF_NUMBERS: &[Mistake] = &[
    Mistake { words: "face indices are 1 too large: the first face is 0", undo: |trial| renumber(trial, -1) },
    Mistake { words: "face indices are 1 too small: the first face is 0", undo: |trial| renumber(trial, 1) },
];

/// Units of lengths.
pub(super) const OF_UNITS: &[Mistake] = &[
    Mistake { words: "lengths are in thousandths of the mesh's unit", undo: |trial| scale(trial, 1e-3) },
    Mistake { words: "lengths are in hundredths of the mesh's unit", undo: |trial| scale(trial, 1e-2) },
    Mistake { words: "lengths are in thousands of the mesh's unit", undo: |trial| scale(trial, 1e3) },
    Mistake { words: "lengths are in feet", undo: |trial| scale(trial, 0.3048) },
];

/// Conventions of arrays.
pub(super) const OF_ARRAYS: &[Mistake] = &[
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
pub(super) const OF_RULES: &[Mistake] = &[
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

/// What is taken for the numbers of a ray.
pub(super) const OF_ARGUMENTS: &[Mistake] = &[
    Mistake {
        words: "the direction of a ray is taken for a point that it goes to: rays are o + t d",
        undo: |trial| {
            for ray in trial.rays.iter_mut().filter(|ray| ray.direction != ray.origin) {
                ray.direction -= ray.origin;
            }
        },
    },
    Mistake {
        words: "the origin and the direction of a ray are taken for each other: the first three numbers are the origin",
        undo: |trial| {
            for ray in trial.rays.iter_mut().filter(|ray| ray.origin != DVec3::ZERO) {
                (ray.origin, ray.direction) = (ray.direction, ray.origin);
            }
        },
    },
];

/// Numbers that mean no hit.
pub(super) const OF_MISSES: &[Mistake] = &[
    Mistake { words: "0 means no hit: declare --miss 0", undo: |trial| declare_miss(trial, 0.0) },
    Mistake { words: "-1 means no hit: declare --miss -1", undo: |trial| declare_miss(trial, -1.0) },
];

/// Mistakes about what is too near for a sensor.
pub(super) const ABOUT_SENSORS: &[Mistake] = &[
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
        // A program has one number for its misses: one that says +Inf has this one.
        undo: |trial| {
            let lengths = [&trial.stated.t, &trial.stated.range].into_iter().flatten();
            if !lengths.flatten().any(|length| *length == f64::INFINITY) {
                misses_at(trial, f64::NEG_INFINITY, f64::INFINITY);
            }
        },
    },
];

/// Single precision excuses much: it is told of values that look like it, and where nothing else explains them.
pub(super) const PRECISION: Mistake = Mistake {
    words: "arithmetic is of single precision: declare --arithmetic f32",
    undo: |trial| trial.precision = Precision::F32,
};
