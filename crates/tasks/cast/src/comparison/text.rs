//! A comparison on a screen and for programs.

use std::fmt::Write as _;

use raypencil_report::{Align, Table, count, counted};
use raypencil_scene::{FaceId, Reading};
use serde_json::{Value, json};

use super::verdict::{Comparison, Wrong};

/// Wrong rays that are listed, at most.
const MAX_LISTED: usize = 5;

/// The result in one sentence.
pub fn comparison_headline(comparison: &Comparison) -> String {
    let counts = comparison.counts();
    let all = counted(comparison.verdicts.len() as u64, "ray", "rays");
    if comparison.met == 0 {
        return format!("Nothing is hit: {all} compared, and all miss the mesh.");
    }
    match counts.wrong {
        0 if comparison.verdicts.len() == 1 => "The one ray agrees.".into(),
        0 => format!("All {all} agree."),
        1 => format!("1 of {all} is wrong."),
        wrong => format!("{} of {all} are wrong.", count(wrong)),
    }
}

/// The result in lines: counts, values with their worst errors, the first wrong rays. `ray_command` gives the command that
/// shows everything about the ray with an index.
pub fn comparison_text(name: &str, comparison: &Comparison, ray_command: impl Fn(usize) -> String) -> String {
    let counts = comparison.counts();
    let mut text = format!(
        "{name}: {} the same ({} at ties), {} rounding, {} wrong\n",
        count(counts.same),
        count(counts.ties),
        count(counts.rounding),
        count(counts.wrong)
    );
    if !comparison.values.is_empty() {
        let mut table = Table::new([Align::Left, Align::Right, Align::Right, Align::Right]);
        table.row(["", "compared", "worst error / bound", "at ray"]);
        for tally in &comparison.values {
            let (worst, at) = tally.worst.map_or(("-".to_string(), "-".to_string()), |(worst, at)| {
                (format!("{worst:.3}"), at.to_string())
            });
            table.row([tally.value.name().to_string(), count(tally.compared), worst, at]);
        }
        let _ = write!(text, "{table}");
        let not_compared = comparison.values.iter().map(|tally| tally.not_compared).sum();
        if not_compared > 0 {
            let values = counted(not_compared, "value was", "values were");
            let _ =
                writeln!(text, "{values} not compared: rounding may make anything of them on faces so thin.");
        }
    }
    for (index, wrong) in comparison.wrong().take(MAX_LISTED) {
        let _ = writeln!(text, "ray {index}: {}\n    {}", wrong_text(&wrong), ray_command(index));
    }
    let _ = writeln!(text, "{}", comparison_headline(comparison));
    text
}

fn face_text(read: Reading<FaceId>) -> String {
    match read {
        Reading::Hit(face) => format!("face {}", face.0),
        Reading::TooNear => "too near".into(),
        Reading::Miss => "no hit".into(),
    }
}

/// The exact answer where it is that what is hit is too near.
const TOO_NEAR: &str = "what is hit is too near: its surface stands before the sensor's shortest range";

/// What is wrong with a ray, in words.
pub(crate) fn wrong_text(wrong: &Wrong) -> String {
    match wrong {
        Wrong::Hit { stated, exact: Reading::TooNear } => {
            format!("{}; exactly {TOO_NEAR}", face_text(*stated))
        }
        Wrong::Hit { stated, exact } => {
            format!("{}; exactly it is {}", face_text(*stated), face_text(*exact))
        }
        Wrong::Distance { stated, exact } => match exact {
            Reading::Hit(exact) => format!("a hit at {stated}; exactly it is {exact}"),
            Reading::TooNear => format!("a hit at {stated}; exactly {TOO_NEAR}"),
            Reading::Miss => format!("a hit at {stated}; exactly nothing is hit"),
        },
        Wrong::Something { exact: Reading::TooNear } => format!("a hit; exactly {TOO_NEAR}"),
        Wrong::Something { .. } => "a hit; exactly nothing is hit".into(),
        Wrong::Contradiction => "one of t and range is -Inf, too near, and the other is not".into(),
        Wrong::Disagreement { by, is_hit: true, of, number } => {
            format!("{by} says that something is hit, and {of} is {number}")
        }
        Wrong::Disagreement { by, is_hit: false, of, number } => {
            format!("{by} says that nothing is hit, and {of} is {number}")
        }
        Wrong::Value { value, error, bound } => {
            format!("{} is off by {error:.3e}; rounding explains {bound:.3e}", value.name())
        }
    }
}

/// The result for programs.
pub fn comparison_json(name: &str, comparison: &Comparison) -> Value {
    let counts = comparison.counts();
    let values: Vec<Value> = comparison
        .values
        .iter()
        .map(|tally| {
            // JSON has no infinity: a value that is not a number is beyond all bounds.
            let worst =
                tally.worst.map(|(worst, ray)| json!({ "errorPerBound": worst.min(f64::MAX), "ray": ray }));
            json!({ "value": tally.value.name(), "compared": tally.compared, "worst": worst })
        })
        .collect();
    let wrong: Vec<Value> = comparison
        .wrong()
        .take(MAX_LISTED)
        .map(|(ray, wrong)| json!({ "ray": ray, "what": wrong_text(&wrong) }))
        .collect();
    json!({
        "name": name,
        "passes": comparison.passes(),
        "unitRoundoff": comparison.precision.unit_roundoff,
        "counts": {
            "same": counts.same, "ties": counts.ties, "rounding": counts.rounding, "wrong": counts.wrong,
        },
        "values": values,
        "wrong": wrong,
    })
}
