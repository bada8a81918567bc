//! Why a program under test is wrong: the mistakes that explain it in scenes, gathered over the campaign.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::merge::Merged;
use crate::record::{PartName, PartRecord, ReasonRecord};

/// The same mistakes in one or many scenes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct CampaignReason {
    /// Names of the mistakes for programs.
    pub(crate) mistakes: Vec<String>,
    /// The clause of the first scene.
    pub(crate) clause: String,
    /// Whether other scenes have other numbers in it.
    pub(crate) numbers_differ: bool,
    /// Terrain of the first scene.
    pub(crate) terrain: u64,
    /// Which of its scenes.
    pub(crate) part: PartName,
    /// Scenes with these mistakes.
    pub(crate) scenes: u64,
    pub(crate) wrong: u64,
    pub(crate) explained: u64,
    pub(crate) right: u64,
    pub(crate) broken: u64,
}

impl CampaignReason {
    /// The reason as one sentence; `of` is the number of scenes with wrong rays.
    pub(crate) fn sentence(&self, of: u64) -> String {
        let Self { clause, terrain, part, scenes, wrong, explained, right, broken, .. } = self;
        // Rounded down: only all of them are 100 %.
        let share = match explained.saturating_mul(10_000) / (*wrong).max(1) {
            10_000 => "100".into(),
            hundredths => format!("{}.{:02}", hundredths / 100, hundredths % 100),
        };
        let broken = match broken {
            0 => "no right ray breaks".into(),
            1 => format!("1 of {right} right rays breaks"),
            many => format!("{many} of {right} right rays break"),
        };
        let where_ = match of {
            1 => format!("terrain {terrain} {}, the only scene with wrong rays", part.word()),
            _ => format!("{scenes} of {of} scenes with wrong rays"),
        };
        let numbers = match self.numbers_differ {
            true => format!(
                " (the numbers are those of terrain {terrain} {}; other scenes have others)",
                part.word()
            ),
            false => String::new(),
        };
        format!("Why: in {where_}, {share} % of them agree if {clause}{numbers}, and {broken}.")
    }
}

/// Scenes in which a ray is wrong or undecided.
pub(crate) fn scenes_with_wrong_rays(merged: &Merged) -> u64 {
    parts(merged).filter(|(_, record)| !record.wrong.is_empty()).count() as u64
}

/// The reasons over all scenes, those of the most scenes first.
pub(crate) fn campaign_reasons(merged: &Merged) -> Vec<CampaignReason> {
    let mut found: BTreeMap<&[String], CampaignReason> = BTreeMap::new();
    for (terrain, record) in parts(merged) {
        let mut of_scene: BTreeMap<&[String], u64> = BTreeMap::new();
        for reason in &record.reasons {
            let ReasonRecord { mistakes, clause, wrong, explained, right, broken } = reason;
            let total = found.entry(mistakes).or_insert_with(|| CampaignReason {
                mistakes: mistakes.clone(),
                clause: clause.clone(),
                numbers_differ: false,
                terrain,
                part: record.part,
                scenes: 0,
                wrong: 0,
                explained: 0,
                right: 0,
                broken: 0,
            });
            let again = of_scene.entry(mistakes).or_default();
            total.scenes += u64::from(*again == 0);
            *again += 1;
            total.numbers_differ |= total.clause != *clause;
            total.wrong += wrong;
            total.explained += explained;
            total.right += right;
            total.broken += broken;
        }
    }
    let mut reasons: Vec<CampaignReason> = found.into_values().collect();
    // Stable: of equals the first by name stays first.
    reasons.sort_by_key(|reason| std::cmp::Reverse([reason.scenes, reason.explained]));
    reasons
}

/// All scenes, each with the number of its terrain.
fn parts(merged: &Merged) -> impl Iterator<Item = (u64, &PartRecord)> {
    merged.terrains.iter().flat_map(|record| record.parts.iter().map(|part| (record.terrain, part)))
}
