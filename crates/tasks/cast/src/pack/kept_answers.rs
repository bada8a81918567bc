//! Whether the answers that a pack keeps are the exact ones: anyone can change an answer and write its digest anew.

use std::path::Path;

use rayon::prelude::*;
use raypencil_files::{Fault, FileError, Limits, Numbers, RayArray, read_npy_numbers};
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Progress, Sides};

use crate::answers::{AllColumns, Answers, FirstHit, Questions, cast_beside_first, side_number};

/// Most rays of a pack whose backs, limits and lengths are counted again, and all hits computed. Tuned: a second or two on two cores.
pub(super) const MAX_COUNTED: usize = 200_000;

/// Rays whose margins are computed again, at most, one of so many each. Tuned: a part of what the rays themselves take.
const MAX_MARGINS: usize = 40;

/// What stands for no face.
const NO_FACE: f64 = u32::MAX as f64;

/// The arrays that a pack keeps, beside what they have to be.
struct Kept<'a> {
    pack: &'a Path,
    rays: &'a RayArray,
}

/// Refuses a pack of which a kept answer is another than the exact one. `exact` are the first hits.
///
/// All hits and crossings are computed again for up to [`MAX_COUNTED`] rays, margins for up to [`MAX_MARGINS`] of them. A margin is an
/// interval, and another version may know a narrower one: it is refused if it has no number in common with the one of today.
pub(super) fn refuse_other_answers(
    pack: &Path,
    rays: &RayArray,
    exact: &Answers,
    (tree, sides): (&ExactCast<'_>, Sides),
    progress: &dyn Progress,
) -> Result<(), FileError> {
    let kept = Kept { pack, rays };
    let number = |of: fn(&FirstHit) -> f64, none: f64| move || exact.values(of, none);
    let three = |of: fn(&FirstHit) -> [f64; 3]| move || exact.values(of, [f64::NAN; 3]).concat();
    kept.refuse("face", 1, number(|hit| f64::from(hit.face.0), NO_FACE))?;
    kept.refuse("side", 1, number(|hit| f64::from(side_number(hit.side)), 0.0))?;
    kept.refuse("ties", 1, number(|hit| f64::from(hit.ties), 0.0))?;
    kept.refuse("t", 1, || exact.distances(|hit| hit.t))?;
    kept.refuse("range", 1, || exact.distances(|hit| hit.range))?;
    kept.refuse("cos_incidence", 1, number(|hit| hit.cos_incidence, f64::NAN))?;
    kept.refuse("point", 3, three(|hit| hit.point.to_array()))?;
    kept.refuse("normal", 3, three(|hit| hit.normal.to_array()))?;
    kept.refuse("barycentric", 3, three(|hit| hit.barycentric))?;
    kept.refuse("across", 6, || {
        rays.rays.iter().flat_map(CastRay::across).flat_map(|vector| vector.to_array()).collect()
    })?;
    if rays.rays.len() <= MAX_COUNTED {
        let questions = Questions { any: true, all: true, margins: false };
        let beside = cast_beside_first(tree, &rays.rays, sides, questions, progress);
        kept.refuse("any", 1, || {
            beside.any.iter().flatten().map(|is_hit| f64::from(u8::from(*is_hit))).collect()
        })?;
        kept.refuse_all(&AllColumns::of(beside.all.as_deref().unwrap_or_default()))?;
    }
    kept.refuse_margins((tree, sides))
}

impl Kept<'_> {
    /// The numbers of an array; `None`: the pack has no such array.
    fn read(&self, name: &str) -> Result<Option<Numbers>, FileError> {
        let path = self.pack.join(format!("{name}.npy"));
        path.is_file().then(|| read_npy_numbers(&path, &Limits::default())).transpose()
    }

    fn fault(&self, name: &str, place: String, found: impl Into<String>) -> FileError {
        let expected = "the answers that `raypencil pack --rays` writes: make the pack again";
        FileError::Array(Fault::new(place, found, expected).in_file(&self.pack.join(format!("{name}.npy"))))
    }

    /// Refuses an array with another number than the exact one; each ray has so many.
    fn refuse(&self, name: &str, of_ray: usize, exact: impl Fn() -> Vec<f64>) -> Result<(), FileError> {
        self.refuse_at(name, exact, |at| format!("ray {}", at / of_ray))
    }

    /// The same of an array whose numbers belong to `place`.
    fn refuse_at(
        &self,
        name: &str,
        exact: impl Fn() -> Vec<f64>,
        place: impl Fn(usize) -> String,
    ) -> Result<(), FileError> {
        let Some(kept) = self.read(name)? else { return Ok(()) };
        let exact = exact();
        if kept.values.len() != exact.len() {
            let found = format!("{} numbers, where the exact answers are {}", kept.values.len(), exact.len());
            return Err(self.fault(name, "shape".into(), found));
        }
        let is_other = |(kept, exact): (&f64, &f64)| {
            kept.to_bits() != exact.to_bits() && !(kept.is_nan() && exact.is_nan())
        };
        match kept.values.iter().zip(&exact).position(is_other) {
            None => Ok(()),
            Some(at) => Err(self.fault(name, place(at), "another answer than the exact one")),
        }
    }

    /// Refuses other hits along rays.
    fn refuse_all(&self, exact: &AllColumns) -> Result<(), FileError> {
        fn numbers<T: Copy + Into<f64>>(numbers: &[T]) -> Vec<f64> {
            numbers.iter().map(|&number| number.into()).collect()
        }
        // Where hits begin decides which ray a hit belongs to.
        self.refuse("all.start", 1, || exact.start.iter().map(|&start| start as f64).collect())?;
        let ray = |at: usize| format!("ray {}", exact.start.partition_point(|&start| start <= at as u64) - 1);
        self.refuse_at("all.face", || numbers(&exact.face), ray)?;
        self.refuse_at("all.side", || numbers(&exact.side), ray)?;
        self.refuse_at("all.t", || exact.t.clone(), ray)?;
        self.refuse_at("all.group", || numbers(&exact.group), ray)?;
        self.refuse_at("all.crossing", || numbers(&exact.crossing), ray)
    }

    /// Refuses margins that cannot be true.
    fn refuse_margins(&self, (tree, sides): (&ExactCast<'_>, Sides)) -> Result<(), FileError> {
        let (Some(face), Some(surface)) = (self.read("margin.face")?, self.read("margin.surface")?) else {
            return Ok(());
        };
        let rays = &self.rays.rays;
        for (name, kept) in [("margin.face", &face), ("margin.surface", &surface)] {
            if kept.values.len() != 2 * rays.len() {
                return Err(self.fault(name, "shape".into(), format!("{} numbers", kept.values.len())));
            }
        }
        let step = rays.len().div_ceil(MAX_MARGINS).max(1);
        let looked: Vec<usize> = (0..rays.len()).step_by(step).collect();
        let wrong = looked.par_iter().find_map_first(|&ray| {
            let exact = tree.margins(&rays[ray], sides);
            let meets = |kept: &Numbers, lo: f64, hi: f64| {
                kept.values[2 * ray] <= hi && lo <= kept.values[2 * ray + 1]
            };
            if !meets(&face, exact.face.lo, exact.face.hi) {
                return Some(("margin.face", ray));
            }
            (!meets(&surface, exact.surface.lo, exact.surface.hi)).then_some(("margin.surface", ray))
        });
        match wrong {
            None => Ok(()),
            Some((name, ray)) => {
                Err(self.fault(name, format!("ray {ray}"), "an interval without the exact margin"))
            }
        }
    }
}
