//! The vertical scan mode: when to stop and pan the beams, and through which angles. (Paper, §2 and §7)

use raypencil_scene::SceneError;

use crate::check::{check_count, check_range};
use crate::elevation_map::Inconsistency;
use crate::rig::Pan;

/// Through which angles the sensors are panned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// The first turn of the beams, downwards from where they are mounted, radians; the farthest stripe.
    pub from: f64,
    /// The last one.
    pub to: f64,
    /// How many stripes of each beam, ends included.
    pub steps: u32,
    /// Whether the camera is panned along. "Tables must be regenerated at every camera and beam configuration" of
    /// the scan mode (§8): the paper's is.
    pub camera: bool,
}

impl Default for Sweep {
    /// CHOICE: from 10 degrees up to 40 degrees down in steps of half a degree. On level ground the default rig's
    /// stripes then run from 9.7 m to the front wheels. Those of a beam h up are (h^2 + d^2) / h times the step apart
    /// at distance d: 0.16 m at 6 m, 0.3 m at 8 m, which the extrapolation to both sides still closes.
    fn default() -> Self {
        Self { from: (-10.0_f64).to_radians(), to: 40.0_f64.to_radians(), steps: 101, camera: true }
    }
}

impl Sweep {
    /// The positions, in order.
    pub fn pans(&self) -> impl Iterator<Item = Pan> + use<> {
        let sweep = *self;
        (0..sweep.steps).map(move |step| {
            let share = f64::from(step) / f64::from(sweep.steps.max(2) - 1);
            let angle = sweep.from + (sweep.to - sweep.from) * share;
            Pan { camera: if sweep.camera { angle } else { 0.0 }, beams: angle }
        })
    }

    /// Refuses angles that are none, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(field, "from", self.from, -3.2, 3.2, "rad")?;
        check_range(field, "to", self.to, -3.2, 3.2, "rad")?;
        check_count(field, "steps", self.steps.into(), 1, 100_000)
    }
}

/// When the vehicle stops for a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanRule {
    /// Before the first frame.
    pub at_start: bool,
    /// Whenever so many metres were driven since the last one. "The vehicle should stop periodically in order to
    /// perform a complete vertical scan of the terrain to obtain a fresh LTM." (§7)
    pub every: Option<f64>,
    /// When new points contradict old ones by more than this on average, metres. "Error accumulation can lead to
    /// inconsistency between points taken at different frames." (§7)
    pub inconsistency: Option<f64>,
    /// On fewer grid points than this an inconsistency says nothing.
    pub least_points: u32,
    /// Whether a scan forgets the old map.
    pub forget: bool,
}

impl Default for ScanRule {
    /// CHOICE: at the start; every 5 m, the way to the far stripe, so that no cell ahead is older than a scan; and at
    /// 0.1 m, a third of what the default vehicle's slope tests refuse, on 20 grid points.
    fn default() -> Self {
        Self { at_start: true, every: Some(5.0), inconsistency: Some(0.1), least_points: 20, forget: true }
    }
}

/// Why a scan is due.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScanReason {
    /// There was none yet.
    Start,
    /// The way driven since the last one.
    Distance,
    /// New points contradict old ones.
    Inconsistency,
}

impl ScanRule {
    /// Whether a scan is due: by the way driven in all and at the last scan (`None` before the first), metres, and by
    /// what the last frame contradicted.
    pub fn due(&self, driven: f64, last_scan: Option<f64>, found: &Inconsistency) -> Option<ScanReason> {
        if self.at_start && last_scan.is_none() {
            return Some(ScanReason::Start);
        }
        let since = driven - last_scan.unwrap_or(0.0);
        if self.every.is_some_and(|every| since >= every) {
            return Some(ScanReason::Distance);
        }
        let contradicted = |most: f64| found.count >= self.least_points && found.mean > most;
        self.inconsistency.is_some_and(contradicted).then_some(ScanReason::Inconsistency)
    }

    /// Refuses thresholds that are none, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        if let Some(every) = self.every {
            check_range(field, "every", every, 1e-3, 1e9, "m")?;
        }
        if let Some(inconsistency) = self.inconsistency {
            check_range(field, "inconsistency", inconsistency, 0.0, 1e3, "m")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_has_both_ends_and_even_steps() {
        let pans: Vec<Pan> = Sweep::default().pans().collect();
        assert_eq!(pans.len(), 101);
        assert_eq!(pans[0].beams, (-10.0_f64).to_radians());
        assert!((pans[20].beams).abs() < 1e-15 && (pans[100].beams - 40.0_f64.to_radians()).abs() < 1e-15);
        assert!(pans.iter().all(|pan| pan.camera == pan.beams));
        let fixed = Sweep { camera: false, steps: 1, ..Sweep::default() };
        assert_eq!(fixed.pans().collect::<Vec<_>>(), [Pan { camera: 0.0, beams: fixed.from }]);
    }

    #[test]
    fn scans_are_due_at_the_start_by_distance_and_by_inconsistency() {
        let rule = ScanRule::default();
        let none = Inconsistency::default();
        assert_eq!(rule.due(0.0, None, &none), Some(ScanReason::Start));
        assert_eq!(rule.due(4.9, Some(0.0), &none), None);
        assert_eq!(rule.due(5.0, Some(0.0), &none), Some(ScanReason::Distance));
        assert_eq!(rule.due(9.9, Some(5.0), &none), None);
        let found = Inconsistency { count: 20, mean: 0.11, largest: 0.5 };
        assert_eq!(rule.due(6.0, Some(5.0), &found), Some(ScanReason::Inconsistency));
        let few = Inconsistency { count: 19, ..found };
        assert_eq!(rule.due(6.0, Some(5.0), &few), None);
        let small = Inconsistency { mean: 0.09, ..found };
        assert_eq!(rule.due(6.0, Some(5.0), &small), None);
        let never = ScanRule { at_start: false, every: None, inconsistency: None, ..rule };
        assert_eq!(never.due(1e6, None, &found), None);
        assert!(rule.validate("scan").is_ok() && Sweep::default().validate("sweep").is_ok());
    }
}
