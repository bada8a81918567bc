//! The search for a reason, of one sensor or of several together: single mistakes first, then pairs. The judge has the last
//! word on each.

use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::correction::{Correction, corrected};
use crate::cuts::cuts;
use crate::fit::{fitted, fixed};
use crate::judged::{Asked, judge};
use crate::mistake::Mistake;
use crate::rays::{ByRays, CastTrial};
use crate::rules::Rules;
use crate::sample::{WrongRays, key, some_of, spread_over};
use crate::tally::{MIN_CONFIRMING_RAYS, MIN_WRONG_RAYS, Tally};
use crate::trial::{Plan, Single, Trial};
use raypencil_files::Storage;
use raypencil_judge::Quantity;
use raypencil_scene::{Place, Precision};

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

/// Relative errors of values that look as computed in single precision: 2^-28 to 2^-21, at three of four.
/// Tuned: the unit roundoff is 2^-24, that of double precision 2^-53. The judge excuses more where a ray grazes a face.
const SINGLE_ERRORS: std::ops::RangeInclusive<f64> = 1.0 / (1 << 28) as f64..=1.0 / (1 << 21) as f64;

/// Share of the numbers that have no more digits than single precision, at least, if the arithmetic is of that. Tuned: a
/// length in single precision may be scaled in double.
const MIN_SHARE_OF_SINGLE: f64 = 0.5;

/// Share of the errors that have each sign, at least. Tuned: roundings go both ways, and a factor or an offset does not.
const MIN_SHARE_OF_SIGN: f64 = 0.125;

/// A reason that was found.
#[derive(Debug, Clone)]
pub(crate) struct Finding {
    pub(crate) mistakes: Vec<Mistake>,
    /// What undoes those of the numbers.
    pub(crate) corrections: Vec<Correction>,
    /// By what rules those of the rays are cast.
    pub(crate) rules: Option<Rules>,
    pub(crate) tally: Tally,
}

/// One search: the recording, its wrong rays, and the rays on which mistakes are tried.
pub(crate) struct Search<'t> {
    case: Case<'t>,
    wrong: &'t WrongRays,
    asked: Asked,
    /// Rays of all, wrong or not.
    spread: Vec<Place>,
    /// The part of the tried rays from which axes and factors are found.
    fitted: Vec<Place>,
    trial: Trial<'t>,
}

impl<'t> Search<'t> {
    pub(crate) fn new(case: Case<'t>, wrong: &'t WrongRays) -> Self {
        let scene = case.truth.scene();
        let asked = Asked::of(case, wrong);
        let mut places = some_of(&wrong.all, SAMPLED_RAYS as usize);
        let is_new = |place: &Place| !wrong.all.contains(&key(*place));
        let spread = spread_over(scene, case.sensors, SAMPLED_RAYS);
        places.extend(spread.iter().copied().filter(is_new));
        let step = places.len().div_ceil(FITTED_RAYS).max(1);
        let fitted = places.iter().copied().step_by(step).collect();
        let trial = Trial::new(case, &places);
        Self { case, wrong, asked, spread, fitted, trial }
    }

    /// The plainest reason that explains the wrong rays.
    pub(crate) fn find(&self) -> Option<Finding> {
        if (self.wrong.all.len() as u64) < MIN_WRONG_RAYS {
            return None;
        }
        let mut corrections = fixed(self.case);
        corrections.extend(fitted(self.case, &self.fitted, None));
        corrections.extend(cuts(self.case, self.wrong));
        let singles: Vec<Single> = corrections.iter().map(|one| self.trial.single(one)).collect();
        let cast = CastTrial::new(self.case, self.wrong);

        // One mistake. Without any correction there is the precision.
        let none = Plan { corrections: Vec::new(), applied: Vec::new(), off: Default::default() };
        let plans =
            corrections.iter().zip(&singles).filter_map(|(one, single)| self.trial.plan_of_one(one, single));
        let plans = self.promising(plans.collect(), MAX_JUDGED_SINGLES);
        let mut found = self.judge_in_order(&plans);
        if found.iter().all(|one| one.tally.off() > 0) {
            found.extend(cast.explain(None).into_iter().map(Finding::from));
        }
        // Single precision excuses much: every other reason goes before it.
        if found.is_empty() {
            found.extend(self.judge_as_single(&none));
        }
        if let Some(best) = best(found) {
            return Some(best);
        }

        // Two.
        let mut found: Vec<Finding> = plans.iter().filter_map(|plan| self.judge_as_single(plan)).collect();
        let pairs = self.promising(self.pairs(&corrections, &singles), MAX_JUDGED_PAIRS);
        found.extend(self.judge_in_order(&pairs));
        for one in &corrections {
            let with = |by_rays: ByRays| Finding { corrections: vec![one.clone()], ..by_rays.into() };
            found.extend(cast.explain(Some(one)).into_iter().map(with));
        }
        found.extend(cast.explain_by_two().into_iter().map(Finding::from));
        best(found)
    }

    /// Whether the recording looks as computed in single precision, and does not say so.
    pub(crate) fn is_secretly_single(&self) -> bool {
        let none = Plan { corrections: Vec::new(), applied: Vec::new(), off: Default::default() };
        self.case.recorded.precision == Precision::F64 && self.looks_single(&none)
    }

    /// The same reason for these sensors, if it explains their wrong rays.
    pub(crate) fn confirm(&self, found: &Finding) -> Option<Finding> {
        let is_single = found.mistakes.contains(&Mistake::SinglePrecision);
        // The arithmetic is the program's, not a sensor's: it needs no proof of many rays, if it leaves none.
        let is_arithmetic = is_single && found.corrections.is_empty();
        let least = if is_arithmetic { 1 } else { MIN_CONFIRMING_RAYS };
        if (self.wrong.all.len() as u64) < least || found.rules.is_some() {
            return None;
        }
        // A cut was found in the other sensor's rays.
        if found.mistakes.iter().any(|one| matches!(one, Mistake::Cut { .. })) {
            return None;
        }
        let plan = match found.corrections.as_slice() {
            [] if is_arithmetic => {
                Plan { corrections: Vec::new(), applied: Vec::new(), off: Default::default() }
            }
            [one] => self.trial.plan_of_one(one, &self.trial.single(one))?,
            [a, b] => self.trial.plan_of_two([a, b], [&self.trial.single(a), &self.trial.single(b)])?,
            _ => return None,
        };
        let precision = if is_single { Precision::F32 } else { self.case.recorded.precision };
        let tally = self.judged(&plan, precision, least)?;
        let is_told = !is_arithmetic || tally.off() == 0;
        is_told.then(|| Finding { tally, ..found.clone() })
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
            plan.off.held <= before.saturating_sub(plan.off.lost) / LEFT_OFF_ONE_IN
                && 2 * plan.off.lost <= before
                && (!has_order || self.has_values() && f64::from(plan.off.held) <= most_off)
        });
        // What is said of all channels, and true of some, is less plain than what is said of these alone.
        let idle = |plan: &Plan| {
            let of_channel = |(channel, subset): &(Channel, usize)| {
                let touching = plan.corrections.iter().enumerate().filter(|(_, one)| one.touches(*channel));
                touching.filter(|(bit, _)| subset >> bit & 1 == 0).count()
            };
            plan.applied.iter().map(of_channel).sum::<usize>()
        };
        plans.sort_by_key(|plan| (plan.off.held, idle(plan)));
        plans.truncate(most);
        plans
    }

    /// Whether a length or a point is there, beside faces.
    fn has_values(&self) -> bool {
        let of_point = |quantity| matches!(quantity, Quantity::Range | Quantity::Depth | Quantity::Point);
        self.trial.channels.iter().any(|channel| of_point(channel.item.quantity))
    }

    /// What a plan explains, if the judge finds that it is enough.
    fn judged(&self, plan: &Plan, precision: Precision, least: u64) -> Option<Tally> {
        let tally = judge(self.case, plan, &self.asked, self.wrong, precision);
        let all = [self.wrong.all.len() as u64, self.wrong.right()];
        tally.is_enough(least, all).then_some(tally)
    }

    fn judge(&self, plan: &Plan, precision: Precision) -> Option<Finding> {
        Some(Finding {
            mistakes: plan.corrections.iter().map(|one| one.mistake).collect(),
            corrections: plan.corrections.clone(),
            rules: None,
            tally: self.judged(plan, precision, MIN_WRONG_RAYS)?,
        })
    }

    /// What plans explain, up to one that leaves nothing: none is better.
    fn judge_in_order(&self, plans: &[Plan]) -> Vec<Finding> {
        let mut found = Vec::new();
        for plan in plans {
            found.extend(self.judge(plan, self.case.recorded.precision));
            if found.last().is_some_and(|one: &Finding| one.tally.off() == 0) {
                break;
            }
        }
        found
    }

    /// The same, if the recording looks as computed in single precision: that is one mistake more.
    fn judge_as_single(&self, plan: &Plan) -> Option<Finding> {
        if self.case.recorded.precision != Precision::F64 || !self.looks_single(plan) {
            return None;
        }
        let mut found = self.judge(plan, Precision::F32)?;
        found.mistakes.push(Mistake::SinglePrecision);
        Some(found)
    }

    /// Whether three of four numbers that are not right have an error of single precision, and half no more digits than that.
    fn looks_single(&self, plan: &Plan) -> bool {
        // What a file of single precision rounds away grows or shrinks when numbers are changed: that is no arithmetic.
        let changes = |one: &Correction| {
            matches!(
                one.mistake,
                Mistake::Affine { .. }
                    | Mistake::Rounded { .. }
                    | Mistake::PointsRounded(_)
                    | Mistake::HalfPrecision(_)
                    | Mistake::FromPlane(_)
                    | Mistake::FluxFactor(_)
                    | Mistake::AngleForCosine(_)
            )
        };
        let is_double = |(channel, _): &(Channel, usize)| {
            self.case.recorded.storage.get(&(channel.sensor, channel.item)) == Some(&Storage::F64)
        };
        if plan.corrections.iter().any(changes) && !plan.applied.iter().all(is_double) {
            return false;
        }
        let (mut numbers, mut off, mut short, mut signs) = (0_usize, 0_usize, 0_usize, [0_usize; 2]);
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
                    let Value::Number(own) = channel.at(&self.case.recorded.answers, *place) else {
                        continue;
                    };
                    // What the file rounds away is no error of arithmetic.
                    let storage = self.case.recorded.storage.get(&(channel.sensor, channel.item));
                    let ulp = storage.map_or(0.0, |storage| storage.ulp(own));
                    if error <= 0.51 * (ulp / own).abs() {
                        continue;
                    }
                    numbers += 1;
                    off += usize::from(SINGLE_ERRORS.contains(&error));
                    signs[0] += usize::from(stated > exact);
                    signs[1] += usize::from(stated < exact);
                    short += usize::from(own == f64::from(own as f32));
                }
            }
        }
        let is_of_both_signs = signs.iter().all(|sign| *sign as f64 >= MIN_SHARE_OF_SIGN * off as f64);
        let is_short = short as f64 >= MIN_SHARE_OF_SINGLE * numbers as f64;
        numbers > 0 && 4 * off >= 3 * numbers && is_short && is_of_both_signs
    }
}

impl From<ByRays> for Finding {
    fn from(found: ByRays) -> Self {
        let ByRays { mistakes, rules, tally } = found;
        Self { mistakes, corrections: Vec::new(), rules: Some(rules), tally }
    }
}

/// The finding that leaves the smallest share of rays on the wrong side; among equals the first, which is the plainest.
fn best(found: Vec<Finding>) -> Option<Finding> {
    let left = |found: &Finding| found.tally.off() as f64 / found.tally.wrong.max(1) as f64;
    found.into_iter().reduce(|best, other| if left(&other) < left(&best) { other } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_findings_that_leave_as_much_the_first_is_told() {
        let finding = |mistake, explained, broken| Finding {
            mistakes: vec![mistake],
            corrections: Vec::new(),
            rules: None,
            tally: Tally { wrong: 100, explained, broken, right: 100 },
        };
        let told = |found: Vec<Finding>| best(found).expect("one").mistakes;
        let [rows, columns, backs] = [Mistake::RowsReversed, Mistake::ColumnsReversed, Mistake::BacksHit];
        assert_eq!(told(vec![finding(rows, 99, 0), finding(columns, 100, 1), finding(backs, 99, 0)]), [rows]);
        assert_eq!(told(vec![finding(rows, 99, 0), finding(columns, 100, 0)]), [columns]);
        // A right ray that breaks counts as a wrong one that stays.
        assert_eq!(told(vec![finding(rows, 100, 2), finding(columns, 99, 0)]), [columns]);
    }
}
