//! What a pass means: how large a tolerance of the candidate would have been noticed.
//!
//! The sizes are those of the pack, for the candidate's arithmetic. A size is only told where the candidate gives what it is noticed
//! by, on every beam of the bench: who gives no visibility is not told of shadows.

use raypencil_files::Storage;
use raypencil_judge::{Quantity, SensorResult};
use raypencil_naive::{Clause, ClauseKind, Slack};
use raypencil_report::{Block, Column, Grid, counted};
use raypencil_scene::{Precision, SensorId};
use serde_json::{Value, json};

use crate::bench::BENCH_BEAMS;
use crate::check::Checked;

/// Sizes that the sentence tells; a page has all.
const MAX_TOLD: usize = 3;

/// A slack, and from which size on it would have been noticed.
pub(super) struct Told {
    slack: Slack,
    /// `None`: not even the largest.
    noticed: Option<f64>,
}

/// What holds for a candidate, the largest size first.
pub(super) fn told(checked: &Checked) -> Vec<Told> {
    let precision = checked.recorded.precision;
    let size = |slack: &str| {
        let entry = checked.sharpness.iter().find(|entry| entry.slack == slack)?;
        match precision {
            Precision::F64 => Some(entry.f64),
            Precision::F32 => Some(entry.f32),
            _ => None,
        }
    };
    let mut told: Vec<Told> = Slack::ALL
        .iter()
        .filter(|slack| noticed_by(**slack).iter().all(|quantity| is_given(checked, *quantity)))
        .filter_map(|slack| Some(Told { slack: *slack, noticed: size(slack.key())? }))
        .collect();
    let largeness = |told: &Told| told.noticed.unwrap_or(f64::INFINITY);
    told.sort_by(|a, b| largeness(b).total_cmp(&largeness(a)));
    told
}

/// The quantities by which a slack is noticed.
fn noticed_by(slack: Slack) -> &'static [Quantity] {
    match slack {
        Slack::RangeScaled => &[Quantity::Range],
        Slack::DepthScaled => &[Quantity::Depth],
        Slack::PointMoved => &[Quantity::Point],
        Slack::NormalTurned => &[Quantity::Normal],
        Slack::IncidenceScaled => &[Quantity::CosIncidence],
        Slack::LandsRight | Slack::LandsLeft | Slack::LandsBelow | Slack::LandsAbove => &[Quantity::Pixel],
        Slack::ImageWider | Slack::ImageNarrower => &[Quantity::Pixel, Quantity::Visible],
        Slack::FluxScaled => &[Quantity::PencilFlux],
        _ => match slack.clause().kind() {
            ClauseKind::Rays | ClauseKind::Hits => &[Quantity::Face, Quantity::Range],
            ClauseKind::Visibility | ClauseKind::Flux(_) => &[Quantity::Face, Quantity::Visible],
        },
    }
}

/// Whether a quantity was compared on every beam of the bench, and is stored as finely as the candidate computes.
fn is_given(checked: &Checked, quantity: Quantity) -> bool {
    let beams = checked.subject.scene.beams().len();
    let of_bench = |result: &&SensorResult| match result.sensor {
        SensorId::Beam(beam) => beam + BENCH_BEAMS >= beams,
        SensorId::Camera => false,
    };
    let is_compared = |result: &SensorResult| {
        let storage = checked.recorded.storage.get(&(result.sensor, quantity.into()));
        let is_fine = match storage {
            Some(Storage::F64 | Storage::Whole) => true,
            Some(Storage::F32) => checked.recorded.precision == Precision::F32,
            _ => false,
        };
        is_fine && result.items.get(quantity.into()).is_some_and(|tally| tally.compared() > 0)
    };
    beams >= BENCH_BEAMS && checked.check.sensors.iter().filter(of_bench).all(is_compared)
}

/// The sentence of a pass: the commonest mistakes of ray tracers, if the candidate could have shown them, and the bluntest of all.
pub(super) fn sentence(told: &[Told], is_published: bool) -> Option<String> {
    let size = |told: &Told| told.noticed.map_or("any size".into(), |size| format!("{size:e}"));
    let of = |wanted: Slack| told.iter().find(|told| told.slack == wanted && told.noticed.is_some());
    // The eight directions of a shift: the bluntest stands for all.
    let shift = told.iter().find(|told| told.slack.clause() == Clause::CellCentres && told.noticed.is_some());
    let shift = shift.map(|told| format!("rays that are {} of a cell off", size(told)));
    let bias = of(Slack::ShadowStartsAway).map(|told| format!("a shadow bias of {} of the way", size(told)));
    let common: Vec<String> = shift.into_iter().chain(bias).collect();
    let in_words = |told: &Told| match told.noticed {
        None => format!("{}, any size", name(told.slack)),
        Some(_) => format!("{}, {} {}", name(told.slack), size(told), told.slack.unit().words()),
    };
    let listed =
        |some: &[&Told]| some.iter().take(MAX_TOLD).map(|told| in_words(told)).collect::<Vec<_>>().join("; ");
    let source = if is_published { "" } else { " (by the pack's own word; --verify measures it)" };
    let all: Vec<&Told> = told.iter().collect();
    let noticed: Vec<&Told> = told.iter().filter(|told| told.noticed.is_some()).collect();
    let largest = "these are the largest before they are noticed";
    Some(match (common.as_slice(), noticed.len()) {
        (_, 0) => return None,
        // A candidate that gives a few channels: what would have been noticed in these.
        ([], 1) => {
            format!(
                "A mistake of one kind would have been noticed{source}, from this size on: {}.",
                listed(&noticed)
            )
        }
        ([], 2..=MAX_TOLD) => {
            format!(
                "Mistakes of {} kinds would have been noticed{source}, from these sizes on: {}.",
                noticed.len(),
                listed(&noticed)
            )
        }
        ([], kinds) => {
            format!(
                "Mistakes of {kinds} kinds would have been noticed{source}. Of them {largest}: {}.",
                listed(&noticed)
            )
        }
        (some, _) => {
            let kinds = counted(told.len() as u64, "kind", "kinds");
            format!(
                "Mistakes such as {} would have been noticed{source}. Of {kinds} of tolerance {largest}: {}.",
                some.join(" or "),
                listed(&all)
            )
        }
    })
}

/// The name of a slack for people.
fn name(slack: Slack) -> String {
    slack.key().replace('-', " ")
}

/// All sizes, for a page.
pub(super) fn block(told: &[Told]) -> Option<Block> {
    let mut grid = Grid::new([
        Column::text(""),
        Column::number("noticed from x ="),
        Column::text("unit"),
        Column::text("a renderer that is wrong by x"),
    ]);
    for Told { slack, noticed } in told {
        let size = noticed.map_or("not noticed".into(), |size| format!("{size:e}"));
        grid.row([name(*slack), size, slack.unit().words().into(), slack.what().into()], false);
    }
    (!told.is_empty()).then_some(Block::Folded { title: "How large a mistake would have been noticed", grid })
}

/// All sizes, for programs.
pub(super) fn to_json(told: &[Told]) -> Value {
    told.iter()
        .map(|Told { slack, noticed }| json!({ "slack": slack.key(), "unit": slack.unit().words(), "noticed": noticed }))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_names_what_would_have_been_noticed_by_what_is_given() {
        let of = |slack, noticed| Told { slack, noticed };
        let depth = || of(Slack::DepthScaled, Some(2e-14));
        let said = |told: &[Told]| sentence(told, true);
        // One channel, as depth.Z alone.
        assert_eq!(
            said(&[depth()]).as_deref(),
            Some(
                "A mistake of one kind would have been noticed, from this size on: depth scaled, 2e-14 as a share."
            )
        );
        assert_eq!(
            said(&[of(Slack::RangeScaled, Some(1e-12)), depth()]).as_deref(),
            Some(
                "Mistakes of 2 kinds would have been noticed, from these sizes on: range scaled, 1e-12 as a share; \
                 depth scaled, 2e-14 as a share."
            )
        );
        // What is not noticed at all is none of them.
        assert_eq!(said(&[of(Slack::RangeScaled, None), depth()]), said(&[depth()]));
        assert_eq!((said(&[of(Slack::RangeScaled, None)]), said(&[])), (None, None));
        // Pixels alone.
        let lands = [Slack::LandsRight, Slack::LandsLeft, Slack::LandsBelow, Slack::LandsAbove];
        assert_eq!(
            sentence(&lands.map(|slack| of(slack, Some(1e-9))), false).as_deref(),
            Some(
                "Mistakes of 4 kinds would have been noticed (by the pack's own word; --verify measures it). Of them \
                 these are the largest before they are noticed: lands right, 1e-9 of a pixel; lands left, 1e-9 of a \
                 pixel; lands below, 1e-9 of a pixel."
            )
        );
        // Faces and ranges show shifted rays, and name them first.
        let told = said(&[of(Slack::ShiftRight, Some(1e-8)), depth()]).expect("a sentence");
        assert!(
            told.starts_with(
                "Mistakes such as rays that are 1e-8 of a cell off would have been noticed. Of 2 kinds "
            ),
            "{told}"
        );
    }
}
