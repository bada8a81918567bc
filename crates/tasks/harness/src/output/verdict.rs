//! The verdict on a validation in words, which claim no more than was shown.

use raypencil_judge::{Class, Largest, ListedDefect, Quantity, listed_defects, name_of};
use raypencil_report::{Outcome, count, counted, list, number};

use crate::scoreboard::CandidateReport;
use crate::validation::{Counts, Validation};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Rays were compared, and none is a defect.
    Agree,
    /// At least one ray is a defect.
    Defects,
    /// The renderers agree, and a candidate is wrong.
    CandidatesWrong,
    /// Rays were compared and agree that no ray hits: that proves nothing.
    NothingHit,
    /// No ray was compared.
    NothingCompared,
}

/// The limits of a pass: what was checked, and what was not.
pub(crate) const CAVEAT: &str = "Which face is hit, and whether the camera sees it, was checked in exact \
    arithmetic on every ray whose answers differ and on a sample of the others; the values of these rays were compared \
    with a third computation. A value error that both renderers share, on rays that were not sampled, would go unnoticed.";

/// A validation with what every report says of it: counted, ruled and told once.
pub(super) struct Ruled<'a> {
    pub(super) validation: &'a Validation,
    /// Numbers of rays by class.
    pub(super) counts: Counts,
    pub(super) verdict: Verdict,
    /// The verdict as a headline: that on the candidates first if one is wrong.
    pub(super) headline: String,
    /// The reasons for the verdict, in one or two sentences.
    pub(super) explanation: String,
}

impl<'a> Ruled<'a> {
    pub(super) fn of(validation: &'a Validation) -> Self {
        let counts = validation.counts();
        let verdict = Verdict::of(validation, &counts);
        let headline = headlines(validation, &counts).join("; ");
        let explanation = explanation(validation, &counts, verdict);
        Self { validation, counts, verdict, headline, explanation }
    }
}

impl Verdict {
    fn of(validation: &Validation, counts: &Counts) -> Self {
        if counts.defects > 0 {
            Self::Defects
        } else if validation.candidates().iter().any(|report| !report.passes()) {
            Self::CandidatesWrong
        } else if counts.compared == 0 {
            Self::NothingCompared
        } else if validation.hits_something() {
            Self::Agree
        } else {
            Self::NothingHit
        }
    }

    /// What became of the validation.
    pub(super) fn outcome(self) -> Outcome {
        match self {
            Self::Agree => Outcome::Agrees,
            Self::Defects | Self::CandidatesWrong => Outcome::Fails,
            Self::NothingHit | Self::NothingCompared => Outcome::Open,
        }
    }

    /// The same for programs.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Agree => "agree",
            Self::Defects => "defects",
            Self::CandidatesWrong => "candidates_wrong",
            Self::NothingHit => "nothing_hit",
            Self::NothingCompared => "nothing_compared",
        }
    }
}

/// A number of compared rays, in words; with several pairs a ray is compared more than once.
pub(crate) fn rays(validation: &Validation, how_many: u64) -> String {
    match validation.pairs.len() {
        0 | 1 => counted(how_many, "ray", "rays"),
        _ => counted(how_many, "comparison of a ray", "comparisons of rays"),
    }
}

/// The headline in its parts, one on the candidates if there are any, and one on the renderers.
fn headlines(validation: &Validation, counts: &Counts) -> Vec<String> {
    let own = renderers_headline(validation, counts);
    let Some(theirs) = candidates_headline(validation.candidates()) else { return vec![own] };
    if validation.candidates().iter().all(CandidateReport::passes) {
        return vec![own, theirs];
    }
    let may = if validation.candidates_may_fail { ", and may be" } else { "" };
    let names: Vec<&str> = validation.rendered.iter().map(|rendered| rendered.name.as_str()).collect();
    vec![format!("{theirs}{may}"), format!("{}: {}", list(&names), lower_first(&own))]
}

fn lower_first(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

/// The headline on our own renderers.
fn renderers_headline(validation: &Validation, counts: &Counts) -> String {
    let compared = rays(validation, counts.compared);
    match (counts.compared, counts.defects) {
        (0, _) => "Nothing was compared".into(),
        (_, 1) => format!("1 of {compared} differs"),
        (_, 2..) => format!("{} of {compared} differ", count(counts.defects)),
        _ if !validation.hits_something() => format!("Nothing is hit: all {compared} miss the terrain"),
        (1, 0) => format!("The only {} agrees", &compared[2..]),
        (_, 0) if counts.approximation > 0 => format!(
            "All {compared} agree, except {} with an error of the paper's approximations",
            count(counts.approximation)
        ),
        (_, 0) => format!("All {compared} agree"),
    }
}

/// The headline on the candidates; `None` if there are none.
fn candidates_headline(candidates: &[CandidateReport]) -> Option<String> {
    let wrong: Vec<&CandidateReport> = candidates.iter().filter(|report| !report.passes()).collect();
    let name = |report: &CandidateReport| report.candidate.name.clone();
    Some(match (candidates, wrong.as_slice()) {
        ([], _) => return None,
        ([one], []) => {
            let coarse = one.candidate.recorded.coarseness();
            let coarse = coarse.map_or(String::new(), |coarse| format!(" at {coarse}"));
            let rays = counted(one.compared(), "ray", "rays");
            format!("candidate {} agrees on {rays}{coarse}", name(one))
        }
        (all, []) => format!("{} candidates agree", all.len()),
        ([_], [one]) => format!("Candidate {} is wrong on {}", name(one), wrong_parts(one)),
        (all, wrong) => {
            let each: Vec<String> =
                wrong.iter().map(|one| format!("{} on {}", name(one), wrong_parts(one))).collect();
            let verb = if wrong.len() == 1 { "is" } else { "are" };
            format!("{} of {} candidates {verb} wrong: {}", wrong.len(), all.len(), each.join("; "))
        }
    })
}

/// What a candidate is wrong on, in words.
fn wrong_parts(report: &CandidateReport) -> String {
    if report.compared() == 0 {
        return "everything: nothing of it could be compared".into();
    }
    let mut parts = Vec::new();
    if report.wrong_rays() > 0 {
        let compared = counted(report.compared(), "ray", "rays");
        parts.push(format!("{} of {compared}", count(report.wrong_rays())));
    }
    for (wrong, all, one, many) in [
        (report.wrong_images(), report.images.len(), "image", "images"),
        (report.wrong_radiance(), report.radiance.len(), "radiance map", "radiance maps"),
    ] {
        if wrong > 0 {
            parts.push(format!("{wrong} of {}", counted(all as u64, one, many)));
        }
    }
    // That the candidate is right about them proves nothing, by the rule of `check`.
    parts.extend(report.idle_sets().map(|name| format!("rays {name}, of which none hits anything")));
    parts.join(", ")
}

/// The reasons for the verdict, in one or two sentences.
fn explanation(validation: &Validation, counts: &Counts, verdict: Verdict) -> String {
    let names: Vec<&str> = validation.rendered.iter().map(|rendered| rendered.name.as_str()).collect();
    let who = list(&names);
    let verdict = match (verdict, counts.compared) {
        // What the renderers show is told first.
        (Verdict::CandidatesWrong, 0) => Verdict::NothingCompared,
        (Verdict::CandidatesWrong, _) => Verdict::Agree,
        (verdict, _) => verdict,
    };
    let mut text = match verdict {
        Verdict::NothingCompared => match names.len() {
            0 | 1 => "A comparison needs two renderers.".into(),
            _ => format!("No sensor has maps of {who} that both state which rays hit."),
        },
        Verdict::NothingHit => format!(
            "{who} agree that no ray of any sensor hits the terrain. Such an agreement proves nothing: is the \
             terrain where the sensors look?"
        ),
        Verdict::Defects => {
            let mut text = format!(
                "{who} differ in the face that is hit, or by more than their rounding errors explain."
            );
            if let Some(defect) = defects(validation).first() {
                text.push_str(&format!(" The worst: {}.", told(defect)));
            }
            text
        }
        Verdict::Agree | Verdict::CandidatesWrong => {
            let faces = match (counts.tie, counts.rounding) {
                (0, 0) => "the same faces",
                (_, 0) => "the same faces, or faces at the same point",
                _ => "the same faces, except on rays within rounding of an edge",
            };
            let faces = match counts.approximation {
                0 => faces.to_string(),
                some => format!(
                    "{faces}, except on {} where a confirmed approximation of the paper causes the error",
                    rays(validation, some)
                ),
            };
            let largest = worst_ratio(validation);
            let largest = largest.map_or(String::new(), |(quantity, worst)| {
                let percent = number(100.0 * worst.value);
                format!(" The largest error is {percent} % of its bound, in {quantity} at {}.", worst.place)
            });
            format!(
                "{who} hit {faces}, and no value differs by more than their rounding errors explain.{largest}"
            )
        }
    };
    if counts.not_compared > 0 && counts.compared > 0 {
        text.push_str(&format!(
            " {} could not be compared: one side has no maps for them.",
            rays(validation, counts.not_compared)
        ));
    }
    for report in validation.candidates().iter().filter(|report| !report.passes()) {
        text.push_str(&format!(" Candidate {} is wrong on {}", report.candidate.name, wrong_parts(report)));
        match report.misses().next().map(told).or_else(|| told_of_sets(report)) {
            Some(worst) => text.push_str(&format!("; the worst: {worst}.")),
            None => text.push('.'),
        }
    }
    text
}

/// A defect in one sentence.
pub(crate) fn told(defect: &ListedDefect) -> String {
    format!("{}, {}: {}", defect.place, name_of(defect.item), defect.words())
}

/// The first wrong ray of a set in one sentence, if one is.
fn told_of_sets(report: &CandidateReport) -> Option<String> {
    let listed = report.ray_sets.iter().flat_map(|set| set.bundle().listed);
    listed.map(|wrong| format!("{}, {}: {}", wrong.line.place, wrong.line.quantity, wrong.line.words)).next()
}

/// The listed defects of the renderers, pair by pair.
pub(crate) fn defects(validation: &Validation) -> Vec<&ListedDefect> {
    validation.pairs.iter().flat_map(|pair| listed_defects(&pair.sensors)).collect()
}

/// The largest ratio of an error to its bound, and its quantity; `None` if no error is above 0.
fn worst_ratio(validation: &Validation) -> Option<(Quantity, &Largest)> {
    let tallies =
        validation.pairs.iter().flat_map(|pair| &pair.sensors).flat_map(|sensor| sensor.items.iter());
    tallies
        .filter(|(_, tally)| tally.of(Class::Agree) > 0)
        .filter_map(|(item, tally)| tally.worst_ratio.as_ref().map(|worst| (item.quantity, worst)))
        .filter(|(_, worst)| worst.value > 0.0)
        .fold(None, |best, next| match best {
            Some((_, worst)) if worst.value >= next.1.value => best,
            _ => Some(next),
        })
}
