//! The returns of beams with a width: what a sensor tells of the rays of a footprint.

use rayon::prelude::*;
use raypencil_report::{count, counted};
use raypencil_scene::pattern::{EchoLight, Keep, Returns};
use raypencil_scene::{NamedRaySet, Reading};
use serde_json::{Value, json};

use crate::answers::{Answers, FirstHit};

/// A return: rays of one footprint that meet the mesh at ranges without a gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamReturn {
    /// Its number among all returns of its beam, by range: the nearest is 1.
    pub number: u32,
    /// Its *leading ray*, an index of the set: of its rays that nearest to the beam's middle, of equals the first. Its point, range and
    /// face are those of the return.
    pub ray: usize,
    /// Range of the leading ray, correctly rounded.
    pub range: f64,
    /// Mean of the ranges of its rays, weighted by their light.
    pub mean_range: f64,
    /// Light: the sum of w r abs(cos psi) / R^2 e^(-2 sigma R) over its rays in their order, w being a ray's share of the beam's power, r and
    /// sigma those of the set. Relative.
    pub strength: f64,
    /// Number of its rays.
    pub rays: u32,
}

/// What became of the rays of a footprint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Footprint {
    /// Number of returns, told or not.
    pub returns: u32,
    /// Rays that hit: those of all returns.
    pub hits: u32,
    /// Rays whose nearest hit is too near for the sensor.
    pub too_near: u32,
}

impl Footprint {
    /// Whether it meets more than one surface: whether there are several returns.
    pub fn is_mixed(&self) -> bool {
        self.returns > 1
    }
}

/// The returns of all beams of a set.
///
/// Everything here follows from the answers to single rays. A ray's range is the double nearest to its exact range. Gaps between two
/// such numbers are compared with the separation exactly, not rounded.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamReturns {
    wanted: Returns,
    /// Rays of a footprint.
    rays_of_beam: usize,
    /// Of each beam as many places as returns are told at most: those that are, by range, and then nothing.
    told: Vec<Option<BeamReturn>>,
    footprints: Vec<Footprint>,
    /// Number of the return that each ray is part of; 0 for none.
    of_rays: Vec<u32>,
}

impl BeamReturns {
    /// The returns of a set; `None` if it asks for none.
    pub fn of(answers: &Answers, set: &NamedRaySet) -> Option<Self> {
        Some(Self::of_first(&answers.first, set.returns?, (set.weights.as_ref()?, &set.echo)))
    }

    /// The same from what is read by each ray; beams have as many rays as there are weights. Ranges and cosines alone decide.
    pub fn of_first(
        first: &[Reading<FirstHit>],
        wanted: Returns,
        (weights, echo): (&[f64], &EchoLight),
    ) -> Self {
        let rays_of_beam = weights.len();
        let beams: Vec<Beam> = first
            .par_chunks(rays_of_beam)
            .enumerate()
            .map(|(index, reads)| Beam::of(reads, index * rays_of_beam, (weights, echo), &wanted))
            .collect();
        let most = wanted.most() as usize;
        let mut all = Self {
            wanted,
            rays_of_beam,
            told: Vec::with_capacity(beams.len() * most),
            footprints: Vec::with_capacity(beams.len()),
            of_rays: Vec::with_capacity(first.len()),
        };
        for Beam { told, footprint, of_rays } in beams {
            let none = most - told.len();
            all.told.extend(told.into_iter().map(Some).chain(std::iter::repeat_n(None, none)));
            all.footprints.push(footprint);
            all.of_rays.extend(of_rays);
        }
        all
    }

    /// Places for returns of a beam: how many are told at most.
    pub fn most(&self) -> usize {
        self.wanted.most() as usize
    }

    /// Rays of a footprint.
    pub fn rays_of_beam(&self) -> usize {
        self.rays_of_beam
    }

    /// The returns that are told: of each beam [`most`](Self::most) places, by range; `None` where there is no such return.
    pub fn told(&self) -> &[Option<BeamReturn>] {
        &self.told
    }

    /// The footprints, beam by beam.
    pub fn footprints(&self) -> &[Footprint] {
        &self.footprints
    }

    /// Number of the return that each ray is part of; 0 for rays that hit nothing, or what is too near.
    pub fn of_rays(&self) -> &[u32] {
        &self.of_rays
    }

    /// The share of a footprint that so many of its rays are.
    pub fn share(&self, rays: u32) -> f64 {
        f64::from(rays) / self.rays_of_beam as f64
    }

    /// Share of the rays of a beam that hit nothing.
    pub fn missed(&self, footprint: &Footprint) -> f64 {
        self.share(self.rays_of_beam as u32 - footprint.hits - footprint.too_near)
    }

    /// Beams, those with a return, those that are mixed, and returns that are told.
    fn counts(&self) -> [u64; 4] {
        let beams =
            |of: fn(&Footprint) -> bool| self.footprints.iter().filter(|beam| of(beam)).count() as u64;
        let told = self.told.iter().flatten().count() as u64;
        [self.footprints.len() as u64, beams(|beam| beam.returns > 0), beams(Footprint::is_mixed), told]
    }

    /// The counts as one line.
    pub fn text(&self) -> String {
        let [beams, with_one, mixed, told] = self.counts();
        format!(
            "{}: {} have a return, {} are mixed; {} told",
            counted(beams, "footprint", "footprints"),
            count(with_one),
            count(mixed),
            counted(told, "return", "returns")
        )
    }

    /// What was asked, and the counts.
    pub fn json(&self) -> Value {
        let [beams, with_one, mixed, told] = self.counts();
        json!({
            "keep": keep_json(self.wanted.keep),
            "separationM": self.wanted.separation_m,
            "raysOfFootprint": self.rays_of_beam,
            "footprints": beams,
            "withReturn": with_one,
            "mixed": mixed,
            "told": told,
        })
    }
}

/// Which returns are told, as in a file of rays.
pub(crate) fn keep_json(keep: Keep) -> Value {
    match keep {
        Keep::First => json!("first"),
        Keep::Strongest => json!("strongest"),
        Keep::Last => json!("last"),
        Keep::UpTo(most) => json!(most),
    }
}

/// The same from a file; `None`: it is no such rule.
pub(crate) fn keep_of_json(value: &Value) -> Option<Keep> {
    match (value.as_str(), value.as_u64()) {
        (Some("first"), _) => Some(Keep::First),
        (Some("strongest"), _) => Some(Keep::Strongest),
        (Some("last"), _) => Some(Keep::Last),
        (None, Some(most)) => Some(Keep::UpTo(most)),
        _ => None,
    }
}

/// What surfaces and air leave of the light, as files have it.
pub(crate) fn echo_json(echo: &EchoLight) -> Value {
    json!({ "reflectivity": echo.reflectivity, "extinctionPerM": echo.extinction_per_m })
}

/// The returns of one beam.
struct Beam {
    told: Vec<BeamReturn>,
    footprint: Footprint,
    of_rays: Vec<u32>,
}

impl Beam {
    fn of(
        reads: &[Reading<FirstHit>],
        first_ray: usize,
        light: (&[f64], &EchoLight),
        wanted: &Returns,
    ) -> Self {
        let mut hits: Vec<(usize, &FirstHit)> =
            reads.iter().enumerate().filter_map(|(ray, read)| Some((ray, read.hit()?))).collect();
        // Of equal ranges the ray that comes first: the order is the same whatever sorts.
        hits.sort_by(|(a, one), (b, other)| one.range.total_cmp(&other.range).then(a.cmp(b)));
        let mut of_rays = vec![0; reads.len()];
        let mut all = Vec::new();
        let groups =
            hits.chunk_by_mut(|(_, near), (_, far)| !is_apart(near.range, far.range, wanted.separation_m));
        for (group, number) in groups.zip(1..) {
            // Rays of a cone run from its middle outwards, ring by ring.
            group.sort_by_key(|(ray, _)| *ray);
            group.iter().for_each(|(ray, _)| of_rays[*ray] = number);
            all.push(one_return(group, number, first_ray, light));
        }
        let too_near = reads.iter().filter(|read| matches!(read, Reading::TooNear)).count() as u32;
        let footprint = Footprint { returns: all.len() as u32, hits: hits.len() as u32, too_near };
        Self { told: told(all, wanted.keep), footprint, of_rays }
    }
}

fn one_return(
    group: &[(usize, &FirstHit)],
    number: u32,
    first_ray: usize,
    (weights, echo): (&[f64], &EchoLight),
) -> BeamReturn {
    let (leading, hit) = group[0];
    let (mut strength, mut times_range) = (0.0, 0.0);
    for (ray, hit) in group {
        let light = weights[*ray] * hit.light(echo);
        strength += light;
        times_range += light * hit.range;
    }
    // Light of a range of 0 is infinite, and far away it is 0 beyond the smallest double.
    let mean = times_range / strength;
    let mean_range = if mean.is_finite() { mean } else { hit.range };
    let rays = group.len() as u32;
    BeamReturn { number, ray: first_ray + leading, range: hit.range, mean_range, strength, rays }
}

/// Those of all returns, which are in the order of range, that a sensor tells, in this order.
fn told(mut all: Vec<BeamReturn>, keep: Keep) -> Vec<BeamReturn> {
    // Of equal strength the nearer: the sort is stable.
    let strongest = |all: &mut Vec<BeamReturn>, most: usize| {
        all.sort_by(|a, b| b.strength.total_cmp(&a.strength));
        all.truncate(most);
        all.sort_by_key(|told| told.number);
    };
    match keep {
        Keep::First => all.truncate(1),
        Keep::Last => drop(all.drain(..all.len().saturating_sub(1))),
        Keep::Strongest => strongest(&mut all, 1),
        Keep::UpTo(most) => strongest(&mut all, most as usize),
    }
    all
}

/// Whether `far` - `near`, without rounding, is above the separation. `far` is not below `near`.
fn is_apart(near: f64, far: f64, separation: f64) -> bool {
    let gap = far - near;
    // What rounding took from the gap. (Knuth, The Art of Computer Programming 2, 4.2.2, theorem B)
    let part = gap - far;
    let error = (far - (gap - part)) - (near + part);
    gap > separation || (gap == separation && error > 0.0)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use raypencil_scene::{FaceId, Side};

    use super::*;

    /// The returns of one beam by the ranges and weights of its rays, which all meet a face at a right angle.
    fn told(rays: &[(f64, f64)], keep: Keep) -> Vec<BeamReturn> {
        let hit = |&(range, _): &(f64, f64)| {
            Reading::Hit(FirstHit {
                face: FaceId(0),
                side: Side::Front,
                ties: 1,
                t: range,
                range,
                point: DVec3::ZERO,
                normal: DVec3::X,
                barycentric: [1.0, 0.0, 0.0],
                cos_incidence: 1.0,
            })
        };
        let first: Vec<Reading<FirstHit>> = rays.iter().map(hit).collect();
        let weights: Vec<f64> = rays.iter().map(|(_, weight)| *weight).collect();
        let light = (weights.as_slice(), &EchoLight::default());
        let returns = BeamReturns::of_first(&first, Returns { keep, separation_m: 0.5 }, light);
        returns.told().iter().flatten().copied().collect()
    }

    #[test]
    fn of_equal_strengths_the_nearer_is_told() {
        // 4 / 2^2 = 1 / 1^2, and again 16 / 4^2.
        let rays = [(2.0, 4.0), (1.0, 1.0), (4.0, 16.0)];
        for (keep, expected) in
            [(Keep::Strongest, vec![1]), (Keep::UpTo(1), vec![1]), (Keep::UpTo(2), vec![1, 2])]
        {
            let numbers: Vec<u32> = told(&rays, keep).iter().map(|one| one.number).collect();
            assert_eq!(numbers, expected, "{keep:?}");
        }
    }

    #[test]
    fn a_range_without_a_finite_light_is_its_own_mean() {
        // Infinite light at 0, and none where its square is beyond the largest double.
        for range in [0.0, 1e200] {
            let [only] = told(&[(range, 1.0), (range, 1.0)], Keep::First)[..] else { panic!("one return") };
            assert_eq!((only.mean_range, only.rays), (range, 2));
        }
        // 2 m of the light 3 / 4, 2.25 m of the light 1 / 5.0625.
        let [both] = told(&[(2.0, 3.0), (2.25, 1.0)], Keep::First)[..] else { panic!("one return") };
        let light = 0.75 + 1.0 / 5.0625;
        assert_eq!((both.strength, both.mean_range), (light, (1.5 + 2.25 / 5.0625) / light));
    }

    #[test]
    fn gaps_are_compared_without_rounding() {
        let ulp = f64::EPSILON;
        assert!(is_apart(1.0, 2.5, 1.0) && !is_apart(1.0, 2.0, 1.0) && !is_apart(3.0, 3.0, 1e-6));
        // 1 + 2^-52 - 2^-60 rounds to 1 + 2^-52: below it without rounding.
        let small = 1.0 / (1_u64 << 60) as f64;
        assert_eq!(1.0 + ulp - small, 1.0 + ulp);
        assert!(!is_apart(small, 1.0 + ulp, 1.0 + ulp));
        // 1 - 2^-60 rounds to 1, and is below it.
        assert!(!is_apart(small, 1.0, 1.0) && is_apart(small, 1.0, 1.0 - ulp / 2.0));
        // Exactly 3 - 1.5 ulp, which rounds to 3 - 2 ulp and is above it.
        let (near, far) = (1.0 - ulp / 2.0, 4.0 - 2.0 * ulp);
        assert_eq!(far - near, 3.0 - 2.0 * ulp);
        assert!(is_apart(near, far, 3.0 - 2.0 * ulp));
    }
}
