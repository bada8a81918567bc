//! The verdict on a validation in words, which claim no more than was shown.

use raypencil_judge::{Class, Defect, Largest, Quantity};
use raypencil_report::{count, counted, list, number};
use serde::Serialize;

use crate::validation::Validation;

/// The verdict on a validation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Verdict {
    /// Rays were compared, and none is a defect.
    Agree,
    /// At least one ray is a defect.
    Defects,
    /// Rays were compared and agree that no ray hits: that proves nothing.
    NothingHit,
    /// No ray was compared.
    NothingCompared,
}

/// The limits of a pass: what was checked, and what was not.
pub(crate) const CAVEAT: &str = "Which face is hit, and whether the camera sees it, was checked in exact \
    arithmetic on every ray whose answers differ and on a sample of the others; the values of these rays were compared \
    with a third computation. A value error that both renderers share, on rays that were not sampled, would go unnoticed.";

impl Verdict {
    pub(crate) fn of(validation: &Validation) -> Self {
        let counts = validation.counts();
        if counts.defects > 0 {
            Self::Defects
        } else if counts.compared == 0 {
            Self::NothingCompared
        } else if validation.hits_something() {
            Self::Agree
        } else {
            Self::NothingHit
        }
    }

    /// A sign that does not depend on colour.
    pub(crate) fn sign(self) -> &'static str {
        match self {
            Self::Agree => "✓",
            Self::Defects => "✗",
            Self::NothingHit | Self::NothingCompared => "?",
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

/// The verdict as a headline.
pub(crate) fn headline(validation: &Validation) -> String {
    let counts = validation.counts();
    let compared = rays(validation, counts.compared);
    match Verdict::of(validation) {
        Verdict::NothingCompared => "Nothing was compared".into(),
        Verdict::NothingHit => format!("Nothing is hit: all {compared} miss the terrain"),
        Verdict::Defects if counts.defects == 1 => format!("1 of {compared} differs"),
        Verdict::Defects => format!("{} of {compared} differ", count(counts.defects)),
        Verdict::Agree if counts.compared == 1 => format!("The only {} agrees", &compared[2..]),
        Verdict::Agree if counts.approximation > 0 => format!(
            "All {compared} agree, except {} with an error of the paper's approximations",
            count(counts.approximation)
        ),
        Verdict::Agree => format!("All {compared} agree"),
    }
}

/// The reasons for the verdict, in one or two sentences.
pub(crate) fn explanation(validation: &Validation) -> String {
    let counts = validation.counts();
    let names: Vec<&str> = validation.rendered.iter().map(|rendered| rendered.name.as_str()).collect();
    let who = list(&names);
    let mut text = match Verdict::of(validation) {
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
            if let Some(defect) = defects(validation).next() {
                let Defect { place, item, what } = defect;
                let quantity = item.quantity;
                text.push_str(&format!(" The first: {place}, {quantity}. {what}."));
            }
            text
        }
        Verdict::Agree => {
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
    text
}

/// The described defects, pair by pair and sensor by sensor.
pub(crate) fn defects(validation: &Validation) -> impl Iterator<Item = &Defect> {
    validation.pairs.iter().flat_map(|pair| &pair.sensors).flat_map(|sensor| &sensor.defects)
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
