//! Beams with a width: the returns that a cloud should have, a ray for each, and where rounding may change them.

use rayon::prelude::*;
use raypencil_files::RayArray;
use raypencil_referee::ExactCast;
use raypencil_scene::pattern::{EchoLight, Keep, Returns};
use raypencil_scene::{CastRay, Precision, Reading, Sides, Triangles};

use crate::answers::FirstHit;
use crate::comparison::{Comparison, RayVerdict, Stated, compare_with, normal_error};
use crate::pack::scan::{Scan, ScanReturns};
use crate::pack::trial::CloudPart;
use crate::returns::{BeamReturn, BeamReturns};

/// Roundings of a strength beside those of its cosines and ranges: a product, two quotients and a sum for each of its rays. An exponential, and its
/// products with what there is, are as many more.
const ROUNDINGS_OF_LIGHT: f64 = 4.0;
const ROUNDINGS_OF_AIR: f64 = 4.0;

/// The returns of the beams of a pack.
///
/// The question to a cloud has a ray for each return that may be told, its *leading ray*: the point of the return is that of this ray, and
/// so it is judged as any ray is. A place without a return has a ray without a length, which meets nothing.
pub(in crate::pack) struct Beams {
    wanted: Returns,
    weights: Vec<f64>,
    echo: EchoLight,
    /// All rays of the pack, and what is read by each.
    rays: Vec<CastRay>,
    first: Vec<Reading<FirstHit>>,
    returns: BeamReturns,
    /// Number of the return of each place; 0 for none.
    numbers: Vec<u32>,
    /// What sensors tell in place of what is asked, in words.
    others: Vec<OtherReturns>,
}

/// Returns that are told by another rule than the one that is asked for.
pub(in crate::pack) struct OtherReturns {
    /// In words.
    pub(in crate::pack) words: String,
    /// Of each beam, by range.
    told: Vec<Vec<BeamReturn>>,
}

/// The question to a cloud.
pub(in crate::pack) struct BeamQuestion {
    pub(in crate::pack) beams: Beams,
    pub(in crate::pack) rays: RayArray,
    pub(in crate::pack) scan: Scan,
}

impl BeamQuestion {
    /// The returns of the beams of a pack, from what is read by each of its rays.
    pub(in crate::pack) fn of(
        rays: &RayArray,
        (scan, returns): (&Scan, &ScanReturns),
        first: Vec<Reading<FirstHit>>,
    ) -> Self {
        let ScanReturns { wanted, weights, echo } = returns;
        let told_by =
            |keep: Keep| BeamReturns::of_first(&first, Returns { keep, ..*wanted }, (weights, echo));
        let returns = told_by(wanted.keep);
        let numbers = returns.told().iter().map(|told| told.map_or(0, |told| told.number)).collect();
        let others = others(wanted.keep, weights.len(), &told_by);
        let beams = Beams {
            wanted: *wanted,
            weights: weights.clone(),
            echo: *echo,
            rays: rays.rays.clone(),
            first,
            returns,
            numbers,
            others,
        };
        let places = beams.places();
        let asked =
            (0..beams.numbers.len()).map(|place| beams.ray_of(place, beams.returns.told()[place].as_ref()));
        let mut shape = rays.shape[..rays.shape.len() - 1].to_vec();
        if places > 1 {
            shape.push(places as u64);
        }
        let rays = RayArray { shape, rays: asked.collect() };
        // All rays of a beam are fired at once.
        let time_of = |place: usize, times: &Vec<f64>| times[place / places * beams.weights.len()];
        let times = scan
            .times
            .as_ref()
            .map(|times| (0..rays.rays.len()).map(|place| time_of(place, times)).collect());
        let scan = Scan { times, returns: None, ..scan.clone() };
        Self { beams, rays, scan }
    }
}

/// The rules by which sensors tell returns, but the one that is asked for. Beams have so many rays, and not more returns.
fn others(keep: Keep, rays: usize, told_by: &dyn Fn(Keep) -> BeamReturns) -> Vec<OtherReturns> {
    let of = |keep: Keep| -> Vec<Vec<BeamReturn>> {
        let returns = told_by(keep);
        returns.told().chunks(returns.most()).map(|told| told.iter().flatten().copied().collect()).collect()
    };
    let both = |a: &[Vec<BeamReturn>], b: &[Vec<BeamReturn>]| -> Vec<Vec<BeamReturn>> {
        let of_beam = |(a, b): (&Vec<BeamReturn>, &Vec<BeamReturn>)| {
            let mut told: Vec<BeamReturn> = a.iter().chain(b).copied().collect();
            told.sort_by_key(|told| told.number);
            told.dedup_by_key(|told| told.number);
            told
        };
        a.iter().zip(b).map(of_beam).collect()
    };
    let singles = [("first", Keep::First), ("strongest", Keep::Strongest), ("last", Keep::Last)];
    let name = |keep: Keep| singles.iter().find(|(_, other)| *other == keep).map(|(name, _)| *name);
    if let Some(asked) = name(keep) {
        let others = singles.iter().filter(|(_, other)| *other != keep);
        return others
            .map(|(name, other)| OtherReturns {
                words: format!("points are the {name} returns: the {asked} ones are asked for"),
                told: of(*other),
            })
            .collect();
    }
    let Keep::UpTo(most) = keep else { return Vec::new() };
    let asked = match most {
        1 => "the strongest one is asked for".to_string(),
        most => format!("the {most} strongest ones are asked for"),
    };
    let mut list: Vec<OtherReturns> = singles
        .iter()
        .map(|(name, keep)| OtherReturns {
            words: format!("each beam has its {name} return alone: {asked}"),
            told: of(*keep),
        })
        .collect();
    if most > 1 {
        for (a, b) in [(0, 2), (1, 2), (0, 1)] {
            let words =
                format!("each beam has its {} and its {} return: {asked}", singles[a].0, singles[b].0);
            let told = both(&list[a].told, &list[b].told);
            list.push(OtherReturns { words, told });
        }
    }
    if most > 1 {
        let all = of(Keep::UpTo(rays as u64));
        let count = |told: &[BeamReturn]| told.len().min(most as usize);
        let first = all.iter().map(|told| told[..count(told)].to_vec()).collect();
        let last = all.iter().map(|told| told[told.len() - count(told)..].to_vec()).collect();
        for (which, told) in [("first", first), ("last", last)] {
            let words = format!("each beam has its {most} {which} returns: {asked}");
            list.push(OtherReturns { words, told });
        }
    }
    for fewer in 2..most {
        let words = format!("each beam has its {fewer} strongest returns: {asked}");
        list.push(OtherReturns { words, told: of(Keep::UpTo(fewer)) });
    }
    list
}

/// A ray that meets nothing, in the place of another.
fn empty(ray: &CastRay) -> CastRay {
    CastRay { t_min: 0.0, t_max: 0.0, t_blind: 0.0, ..*ray }
}

impl Beams {
    /// Places of each beam: how many returns may be told.
    pub(in crate::pack) fn places(&self) -> usize {
        self.returns.most()
    }

    /// Number of the return of each place; 0 for none.
    pub(in crate::pack) fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// The same, but NaN for none.
    pub(in crate::pack) fn told_numbers(&self) -> Vec<f64> {
        self.numbers.iter().map(|&number| if number == 0 { f64::NAN } else { f64::from(number) }).collect()
    }

    /// Number of returns of a beam, told or not.
    pub(in crate::pack) fn returns_of(&self, beam: usize) -> u32 {
        self.returns.footprints()[beam].returns
    }

    /// What sensors tell in place of what is asked.
    pub(in crate::pack) fn others(&self) -> &[OtherReturns] {
        &self.others
    }

    /// The return of a place, if it has one.
    pub(in crate::pack) fn told(&self, place: usize) -> Option<&BeamReturn> {
        self.returns.told()[place].as_ref()
    }

    /// The middle of the beam of a place.
    pub(in crate::pack) fn middle(&self, place: usize) -> &CastRay {
        &self.rays[place / self.places() * self.weights.len()]
    }

    /// Number of returns of the beam of a place that are told, and which of them has this place.
    pub(in crate::pack) fn told_of_beam(&self, place: usize) -> (usize, usize) {
        let first = place / self.places() * self.places();
        let told = &self.returns.told()[first..first + self.places()];
        (told.iter().flatten().count(), place - first)
    }

    /// The ray of a place by another rule: that of the return with the number of the place, or in its turn. Returns whose number no
    /// place has take the places that are left.
    pub(in crate::pack) fn ray_by(&self, place: usize, other: &OtherReturns, by_number: bool) -> CastRay {
        let told = &other.told[place / self.places()];
        let first = place / self.places() * self.places();
        let numbers = &self.numbers[first..first + self.places()];
        let of_number = |place: usize| {
            let number = self.numbers[place];
            told.iter().find(|told| by_number && told.number == number)
        };
        let left = (first..place).filter(|&place| of_number(place).is_none()).count();
        let is_left = |told: &&BeamReturn| !by_number || !numbers.contains(&told.number);
        let found = of_number(place).or_else(|| told.iter().filter(is_left).nth(left));
        self.ray_of(place, found)
    }

    /// The leading ray of a return; without one a ray that meets nothing, or in the first place one that is too near, if there is one.
    fn ray_of(&self, place: usize, told: Option<&BeamReturn>) -> CastRay {
        if let Some(told) = told {
            return self.rays[told.ray];
        }
        let rays = self.rays_at(place / self.places());
        let is_first = place.is_multiple_of(self.places());
        let too_near = rays.clone().find(|&ray| is_first && matches!(self.first[ray], Reading::TooNear));
        let none = rays.clone().all(|ray| self.first[ray].hit().is_none());
        match too_near.filter(|_| none) {
            Some(ray) => self.rays[ray],
            None => empty(&self.rays[rays.start]),
        }
    }

    fn rays_at(&self, beam: usize) -> std::ops::Range<usize> {
        beam * self.weights.len()..(beam + 1) * self.weights.len()
    }

    /// The question with what rounding excuses: where it may change the returns of a beam, a point may be that of any ray of the
    /// beam, and none need be there.
    pub(in crate::pack) fn excused(
        &self,
        (rays, part): (&[CastRay], &CloudPart),
        (stated, comparison): (&Stated, &Comparison),
        (exact, mesh, sides): (&ExactCast<'_>, &Triangles, Sides),
        precision: Precision,
    ) -> Vec<CastRay> {
        let mut asked = rays.to_vec();
        let places = self.places();
        let mut beams: Vec<usize> = comparison.wrong().map(|(place, _)| place / places).collect();
        beams.dedup();
        beams.retain(|&beam| self.is_open(beam, (exact, mesh, sides), precision));
        for place in beams.into_iter().flat_map(|beam| beam * places..(beam + 1) * places) {
            if !part.raw[place].is_finite() {
                asked[place] = empty(&asked[place]);
                continue;
            }
            let is_right = |ray: &CastRay| {
                let mut alone = stated.some_of(&[place]);
                part.some_of(&[place]).state(&[*ray], &mut alone);
                let judged = compare_with(exact, mesh, &[*ray], sides, &alone, precision);
                !matches!(judged.verdicts[0], RayVerdict::Wrong(_))
            };
            let rays = &self.rays[self.rays_at(place / places)];
            if !is_right(&asked[place])
                && let Some(ray) = rays.iter().find(|ray| is_right(ray))
            {
                asked[place] = *ray;
            }
        }
        asked
    }

    /// Those of these places whose beams have the same returns whatever rounding does.
    pub(in crate::pack) fn closed(
        &self,
        places: &[usize],
        ground: (&ExactCast<'_>, &Triangles, Sides),
        precision: Precision,
    ) -> Vec<usize> {
        let is_closed = |place: &&usize| !self.is_open(*place / self.places(), ground, precision);
        places.par_iter().filter(is_closed).copied().collect()
    }

    /// Whether rounding may change the returns of a beam: the answer to one of its rays, a gap between two of them, or the order of
    /// the strengths.
    fn is_open(
        &self,
        beam: usize,
        (exact, mesh, sides): (&ExactCast<'_>, &Triangles, Sides),
        precision: Precision,
    ) -> bool {
        let mut hits: Vec<(usize, &FirstHit)> =
            self.rays_at(beam).filter_map(|ray| Some((ray, self.first[ray].hit()?))).collect();
        hits.sort_by(|(a, one), (b, other)| one.range.total_cmp(&other.range).then(a.cmp(b)));
        let error =
            |(ray, hit): &(usize, &FirstHit)| exact.range_error(&self.rays[*ray], hit.face, precision);
        let separation = self.wanted.separation_m;
        let may_split = |pair: &[(usize, &FirstHit)]| {
            (pair[1].1.range - pair[0].1.range - separation).abs() <= error(&pair[0]) + error(&pair[1])
        };
        let may_change = |ray: usize| {
            let asked = &self.rays[ray];
            let endless = CastRay { t_max: f64::INFINITY, t_blind: 0.0, ..*asked };
            let nearest = exact.first(&endless, sides).first().copied();
            let is_at_an_end = nearest.and_then(|face| exact.meeting(&endless, face)).is_some_and(|hit| {
                let (range, error) = (hit.range().double, exact.range_error(asked, hit.face(), precision));
                let is_at = |t: f64| (range - t * asked.direction.length()).abs() <= error;
                is_at(asked.t_max) || is_at(asked.t_blind)
            });
            let most = exact.lateral_error(asked, precision);
            // Margins are asked for the few rays of which the quick answer says nothing.
            let may_hit_another =
                || !exact.is_steady(asked, sides, most) && exact.margins(asked, sides).surface.lo <= most;
            is_at_an_end || may_hit_another()
        };
        hits.windows(2).any(may_split)
            || self.rays_at(beam).any(may_change)
            || self.may_reorder(beam, (exact, mesh), precision)
    }

    /// Whether rounding may change which returns of a beam are the strongest.
    fn may_reorder(
        &self,
        beam: usize,
        (exact, mesh): (&ExactCast<'_>, &Triangles),
        precision: Precision,
    ) -> bool {
        let most = match self.wanted.keep {
            Keep::First | Keep::Last => return false,
            Keep::Strongest => 1,
            Keep::UpTo(most) => most as usize,
        };
        let more = Returns { keep: Keep::UpTo(most as u64 + 1), ..self.wanted };
        let light = (self.weights.as_slice(), &self.echo);
        let found = BeamReturns::of_first(&self.first[self.rays_at(beam)], more, light);
        let mut strengths: Vec<f64> = found.told().iter().flatten().map(|told| told.strength).collect();
        strengths.sort_by(|a, b| b.total_cmp(a));
        let [.., weakest, next] = strengths[..] else { return false };
        if strengths.len() <= most {
            return false;
        }
        let of_ray = |(ray, hit): (usize, &FirstHit)| {
            let asked = &self.rays[ray];
            let of_cosine = normal_error(exact, mesh, asked, hit.face, precision) / hit.cos_incidence.abs();
            let error = exact.range_error(asked, hit.face, precision);
            // The exponent 2 sigma R is off by its range and by a rounding of its own.
            let exponent = 2.0 * self.echo.extinction_per_m;
            let of_air = exponent * (error + precision.unit_roundoff * hit.range);
            of_cosine + 2.0 * error / hit.range + of_air
        };
        let rays = self.rays_at(beam).filter_map(|ray| Some((ray, self.first[ray].hit()?)));
        let is_plain = self.echo == EchoLight::default();
        let roundings = if is_plain { ROUNDINGS_OF_LIGHT } else { ROUNDINGS_OF_LIGHT + ROUNDINGS_OF_AIR };
        let largest = rays.map(of_ray).fold(0.0, f64::max)
            + roundings * self.weights.len() as f64 * precision.unit_roundoff;
        weakest - next <= largest * (weakest + next)
    }
}
