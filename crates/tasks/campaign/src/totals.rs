//! Totals of a campaign over all terrains.

use std::collections::BTreeMap;

use raypencil_judge::{Class, Quantity};
use raypencil_scene::SensorId;
use raypencil_survey::{SensorHits, Warning, few_hits, no_hits};

use crate::merge::Merged;
use crate::record::{PartName, PartRecord, TerrainRecord, WorstRecord, WrongRay};

/// Counts and worst errors of some or all scenes of each terrain.
#[derive(Debug, Default)]
pub(crate) struct CampaignTotal<'a> {
    pub(crate) compared: u64,
    pub(crate) hits: u64,
    pub(crate) by_class: [u64; 6],
    pub(crate) not_compared: u64,
    pub(crate) judged: u64,
    pub(crate) quantities: BTreeMap<Quantity, QuantityTotal<'a>>,
}

/// Counts and worst errors of a quantity.
#[derive(Debug, Default)]
pub(crate) struct QuantityTotal<'a> {
    pub(crate) by_class: [u64; 6],
    pub(crate) not_compared: u64,
    pub(crate) worst_error: Option<WorstRay<'a>>,
    pub(crate) worst_ratio: Option<WorstRay<'a>>,
}

/// A largest value, its ray and its scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WorstRay<'a> {
    pub(crate) record: &'a WorstRecord,
    pub(crate) terrain: u64,
    pub(crate) part: PartName,
}

impl<'a> CampaignTotal<'a> {
    /// The total over the scenes `part`, or over all scenes.
    pub(crate) fn of(merged: &'a Merged, part: Option<PartName>) -> Self {
        let mut total = Self::default();
        for TerrainRecord { terrain, parts, .. } in &merged.terrains {
            for record in parts.iter().filter(|record| part.is_none_or(|part| record.part == part)) {
                total.add(*terrain, record);
            }
        }
        total
    }

    fn add(&mut self, terrain: u64, record: &'a PartRecord) {
        self.compared += record.compared;
        self.hits += record.hits;
        self.not_compared += record.not_compared;
        self.judged += record.judged;
        for (mine, theirs) in self.by_class.iter_mut().zip(record.by_class) {
            *mine += theirs;
        }
        for quantity in &record.quantities {
            let mine = self.quantities.entry(quantity.quantity).or_default();
            for (mine, theirs) in mine.by_class.iter_mut().zip(quantity.by_class) {
                *mine += theirs;
            }
            mine.not_compared += quantity.not_compared;
            for (slot, worst) in [
                (&mut mine.worst_error, &quantity.worst_error),
                (&mut mine.worst_ratio, &quantity.worst_ratio),
            ] {
                let Some(worst) = worst else { continue };
                // A value that is not finite is the worst of all. Of equal values the first one stays.
                let size = |worst: &WorstRecord| worst.value.unwrap_or(f64::INFINITY);
                if slot.is_none_or(|earlier| size(worst) > size(earlier.record)) {
                    *slot = Some(WorstRay { record: worst, terrain, part: record.part });
                }
            }
        }
    }
}

impl Merged {
    /// Whether no ray is a defect or undecided, at least one ray was compared, and at least one hits the terrain.
    pub fn passes(&self) -> bool {
        let total = CampaignTotal::of(self, None);
        total.compared > 0
            && total.hits > 0
            && total.by_class[Class::Defect as usize] == 0
            && total.by_class[Class::Undecided as usize] == 0
            && self.failures().next().is_none()
    }

    /// Warnings about scenes whose rays, over all terrains, hit nothing or nearly nothing: such an agreement proves
    /// little.
    pub fn warnings(&self) -> Vec<(PartName, Warning)> {
        let of_part = |part: PartName| {
            let CampaignTotal { compared, hits, .. } = CampaignTotal::of(self, Some(part));
            // Random rigs look anywhere: sensor by sensor a miss is no surprise, over a whole part it is.
            let of = SensorHits { sensor: SensorId::Camera, rays: compared, hits };
            let warning = no_hits(of).or_else(|| few_hits(of)).filter(|_| compared > 0)?;
            Some((part, Warning { sensor: None, ..warning }))
        };
        PartName::ALL.into_iter().filter_map(of_part).collect()
    }

    /// Number of rays compared.
    pub fn compared(&self) -> u64 {
        CampaignTotal::of(self, None).compared
    }

    /// The commands that show a ray again. `cell` is its `raypencil probe` arguments.
    pub(crate) fn replay_commands(&self, terrain: u64, part: PartName, cell: &str) -> String {
        match (&self.campaign.scenes, part) {
            (Some(scenes), PartName::Own | PartName::Paper) => {
                format!("raypencil probe {} {cell}", scenes.arguments(terrain))
            }
            _ => {
                format!("{}, then raypencil probe DIR/scene.toml {cell}", self.replay_command(terrain, part))
            }
        }
    }

    /// The command that writes a scene again. Without one's own scenes and their rig it would be another, random one.
    pub(crate) fn replay_command(&self, terrain: u64, part: PartName) -> String {
        let scenes = self.campaign.scenes.as_ref().map_or(String::new(), |own| own.options() + " ");
        let seed = self.campaign.seed;
        format!(
            "raypencil campaign replay {scenes}--seed {seed} --terrain {terrain} --part {} -o DIR",
            part.word()
        )
    }

    /// Scenes for which the program under test gave no answer, with the reason.
    pub fn failures(&self) -> impl Iterator<Item = (u64, PartName, &str)> {
        let parts =
            self.terrains.iter().flat_map(|record| record.parts.iter().map(|part| (record.terrain, part)));
        parts.filter_map(|(terrain, part)| Some((terrain, part.part, part.failed.as_deref()?)))
    }
}

/// The wrong rays that are described, each with its terrain and scene.
pub(crate) fn wrong_rays(merged: &Merged) -> impl Iterator<Item = (u64, PartName, &WrongRay)> {
    let parts =
        merged.terrains.iter().flat_map(|record| record.parts.iter().map(|part| (record.terrain, part)));
    parts.flat_map(|(terrain, part)| part.wrong.iter().map(move |ray| (terrain, part.part, ray)))
}
