//! The search: single mistakes first, then pairs. The judge has the last word on each.

use crate::agree::TRIAL_TOLERANCE;
use crate::channel::Value;
use crate::correction::{Case, Correction, corrected};
use crate::diagnosis::Diagnosis;
use crate::fit::{fitted, fixed};
use crate::judged::{Asked, judge};
use crate::mistake::Mistake;
use crate::rays::CastTrial;
use crate::sample::{WrongRays, key, some_of, spread_over};
use crate::trial::{Plan, Single, Trial};
use raypencil_judge::{Check, Class, GroundTruth, Quantity, Recorded};
use raypencil_scene::{Place, Precision};

/// A candidate fails widely if more than one in so many compared rays is wrong, or more than one in so many values of
/// one quantity of one sensor. Tuned: a rare fault has no mistaken convention as its cause.
const WIDE_ONE_IN: u64 = 100;

/// Wrong rays, at least, of a candidate that fails widely. Tuned: fewer fit too many explanations.
const MIN_WRONG_RAYS: u64 = 12;

/// An explanation leaves at most one in so many of the wrong rays wrong. Tuned: rays near an edge may differ twice.
const LEFT_WRONG_ONE_IN: u64 = 50;

/// A trial that leaves at most one in so many of the sampled values off is judged. Tuned: looser than the judge.
const LEFT_OFF_ONE_IN: u32 = 10;

/// Sampled rays that are wrong, and sampled rays of all.
const SAMPLED_RAYS: u64 = 768;

/// Sampled rays from which a change of axes is found, at most.
const FITTED_RAYS: usize = 96;

/// Plans that the judge is asked about, at most, among single mistakes and among pairs.
const MAX_JUDGED_SINGLES: usize = 8;
const MAX_JUDGED_PAIRS: usize = 8;

/// Share of a plan's sampled values that may be off if an order of faces was found. Tuned: such an order fits faces
/// alone, so the ranges must prove that the rays are right.
const MAX_OFF_BESIDE_ORDER: f64 = 0.02;

/// Relative error of a value that looks as computed in single precision: 2^-28 and more, at half of the values.
/// Tuned: the unit roundoff is 2^-24, that of double precision 2^-53.
const LEAST_SINGLE_ERROR: f64 = 1.0 / (1 << 28) as f64;

/// Looks for the mistake that explains why a recording is wrong nearly everywhere, or for two.
///
/// `check` is the judge's result for the same recording. `None`: the recording does not fail widely, or no mistake
/// that is known here explains it. The same arguments give the same answer.
pub fn diagnose(truth: &GroundTruth<'_>, recorded: &Recorded, check: &Check) -> Option<Diagnosis> {
    if !fails_widely(check) {
        return None;
    }
    let case = Case { truth, recorded };
    let wrong = WrongRays::of(check);
    Search::new(case, &wrong).find()
}

/// Whether so many rays are wrong that one mistake may be behind all of them.
fn fails_widely(check: &Check) -> bool {
    let is_wide =
        |wrong: u64, compared: u64| wrong >= MIN_WRONG_RAYS && wrong.saturating_mul(WIDE_ONE_IN) > compared;
    let mut tallies = check.sensors.iter().flat_map(|sensor| sensor.items.iter());
    is_wide(check.of(Class::Defect) + check.of(Class::Undecided), check.compared())
        || tallies
            .any(|(_, tally)| is_wide(tally.of(Class::Defect) + tally.of(Class::Undecided), tally.compared()))
}

/// One search: the recording, its wrong rays, and the rays on which mistakes are tried.
struct Search<'t> {
    case: Case<'t>,
    wrong: &'t WrongRays,
    asked: Asked,
    /// Wrong rays among those that the judge is asked about.
    wrong_asked: u64,
    /// Rays of all, wrong or not.
    spread: Vec<Place>,
    /// The part of the tried rays from which axes and factors are found.
    fitted: Vec<Place>,
    trial: Trial<'t>,
}

impl<'t> Search<'t> {
    fn new(case: Case<'t>, wrong: &'t WrongRays) -> Self {
        let scene = case.truth.scene();
        let asked = Asked::of(scene);
        let wrong_asked = wrong.all.iter().filter(|ray| asked.is_asked(**ray)).count() as u64;
        let mut places = some_of(&wrong.all, SAMPLED_RAYS as usize);
        let is_new = |place: &Place| !wrong.all.contains(&key(*place));
        let spread = spread_over(scene, SAMPLED_RAYS);
        places.extend(spread.iter().copied().filter(is_new));
        let step = places.len().div_ceil(FITTED_RAYS).max(1);
        let fitted = places.iter().copied().step_by(step).collect();
        let trial = Trial::new(case, &places);
        Self { case, wrong, asked, wrong_asked, spread, fitted, trial }
    }

    fn find(&self) -> Option<Diagnosis> {
        let mut corrections = fixed(self.case);
        corrections.extend(fitted(self.case, &self.fitted, None));
        let singles: Vec<Single> = corrections.iter().map(|one| self.trial.single(one)).collect();
        let cast = CastTrial::new(self.case, self.wrong);

        // One mistake. Without any correction there is the precision.
        let none = Plan { corrections: Vec::new(), applied: Vec::new(), off: 0 };
        let mut found: Vec<Diagnosis> = self.judge_as_single(&none).into_iter().collect();
        let plans =
            corrections.iter().zip(&singles).filter_map(|(one, single)| self.trial.plan_of_one(one, single));
        let plans = self.promising(plans.collect(), MAX_JUDGED_SINGLES);
        found.extend(plans.iter().filter_map(|plan| self.judge(plan, self.case.recorded.precision)));
        found.extend(cast.explain(None));
        if let Some(best) = best(found) {
            return Some(best);
        }

        // Two.
        let mut found: Vec<Diagnosis> = plans.iter().filter_map(|plan| self.judge_as_single(plan)).collect();
        let pairs = self.promising(self.pairs(&corrections, &singles), MAX_JUDGED_PAIRS);
        found.extend(pairs.iter().filter_map(|plan| self.judge(plan, self.case.recorded.precision)));
        found.extend(corrections.iter().filter_map(|one| cast.explain(Some(one))));
        found.extend(cast.explain_by_two());
        best(found)
    }

    /// All pairs of which each part helps.
    fn pairs(&self, corrections: &[Correction], singles: &[Single]) -> Vec<Plan> {
        let mut plans = Vec::new();
        for (a, of_a) in corrections.iter().zip(singles) {
            let later = corrections.iter().zip(singles).skip_while(|(b, _)| !std::ptr::eq(*b, a)).skip(1);
            for (b, of_b) in later.filter(|(b, _)| !a.excludes(b)) {
                plans.extend(self.trial.plan_of_two([a, b], [of_a, of_b]));
            }
            // Numbers that are found only after the first mistake is undone.
            for b in fitted(self.case, &self.fitted, Some(a)).iter().filter(|b| !a.excludes(b)) {
                plans.extend(self.trial.plan_of_two([a, b], [of_a, &self.trial.single(b)]));
            }
        }
        plans
    }

    /// The plans that leave few values off, the best first; among equals in their order.
    fn promising(&self, mut plans: Vec<Plan>, most: usize) -> Vec<Plan> {
        let before = self.trial.off_uncorrected();
        let most_off = MAX_OFF_BESIDE_ORDER * self.trial.sampled() as f64;
        plans.retain(|plan| {
            let has_order = plan.corrections.iter().any(|one| one.mistake == Mistake::FacesReordered);
            plan.off <= before / LEFT_OFF_ONE_IN
                && (!has_order || self.has_values() && f64::from(plan.off) <= most_off)
        });
        plans.sort_by_key(|plan| plan.off);
        plans.truncate(most);
        plans
    }

    /// Whether a length or a point is there, beside faces.
    fn has_values(&self) -> bool {
        let of_point = |quantity| matches!(quantity, Quantity::Range | Quantity::Depth | Quantity::Point);
        self.trial.channels.iter().any(|channel| of_point(channel.item.quantity))
    }

    /// The diagnosis of a plan, if the judge finds that it explains the wrong rays.
    fn judge(&self, plan: &Plan, precision: Precision) -> Option<Diagnosis> {
        let judged = judge(self.case, plan, &self.asked, precision);
        let is_explained = judged.wrong.saturating_mul(LEFT_WRONG_ONE_IN) <= self.wrong_asked;
        is_explained.then(|| Diagnosis {
            mistakes: plan.corrections.iter().map(|one| one.mistake).collect(),
            agree: judged.right,
            tried: judged.right + judged.wrong,
        })
    }

    /// The same, if the recording looks as computed in single precision: that is one mistake more.
    fn judge_as_single(&self, plan: &Plan) -> Option<Diagnosis> {
        if self.case.recorded.precision != Precision::F64 || !self.looks_single(plan) {
            return None;
        }
        let mut found = self.judge(plan, Precision::F32)?;
        found.mistakes.push(Mistake::SinglePrecision);
        Some(found)
    }

    /// Whether half of the numbers have an error of single precision, and nearly all no larger one.
    fn looks_single(&self, plan: &Plan) -> bool {
        let (mut numbers, mut off) = (0_usize, 0_usize);
        for channel in &self.trial.channels {
            let subset = plan.applied.iter().find(|(of, _)| of == channel).map_or(0, |(_, subset)| *subset);
            let all = plan.corrections.iter().enumerate();
            let own: Vec<&Correction> =
                all.filter(|(index, _)| subset >> index & 1 == 1).map(|(_, one)| one).collect();
            for place in self.spread.iter().filter(|place| place.sensor == channel.sensor) {
                let exact = channel.at(self.case.truth.answers(), *place);
                if let (Some(Value::Number(stated)), Value::Number(exact)) =
                    (corrected(self.case, *channel, *place, &own), exact)
                    && exact != 0.0
                {
                    let error = ((stated - exact) / exact).abs();
                    numbers += 1;
                    off += usize::from((LEAST_SINGLE_ERROR..=TRIAL_TOLERANCE).contains(&error));
                }
            }
        }
        numbers > 0 && 2 * off >= numbers
    }
}

/// The diagnosis with the largest share; among equals the first.
fn best(found: Vec<Diagnosis>) -> Option<Diagnosis> {
    found.into_iter().reduce(|best, other| if other.share() > best.share() { other } else { best })
}
