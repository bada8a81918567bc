//! The vertical scan: when the vehicle stops to pan its beams, and through which angles. (Paper, §2 and §7)

use raypencil_scene::{SceneError, check_count, check_range};

use crate::elevation_map::Inconsistency;
use crate::rig::Pan;

/// Angles through which the beams and the camera are panned in a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// First angle, downwards from the mounted direction, radians. It gives the farthest stripe.
    pub from: f64,
    /// Last angle, radians.
    pub to: f64,
    /// Number of positions, both ends included; each gives one stripe per beam.
    pub steps: u32,
    /// Whether the camera is panned with the beams. In the paper it is: in the scan mode "tables must be regenerated at
    /// every camera and beam configuration" (§8).
    pub camera: bool,
    /// Time that each position takes, seconds. The vehicle stands meanwhile, and its clock goes on.
    pub step_time: f64,
}

impl Default for Sweep {
    /// CHOICE: from 10 degrees up to 40 degrees down in steps of half a degree. On level ground the stripes of the
    /// default rig then lie between 9.7 m and the front wheels. For a beam at height h, neighbouring stripes at
    /// distance d are (h^2 + d^2) / h times the angular step apart: 0.16 m at 6 m, 0.3 m at 8 m. Extrapolation from
    /// both sides closes these gaps. A scan takes no time, since the paper has no word of it.
    fn default() -> Self {
        Self {
            from: (-10.0_f64).to_radians(),
            to: 40.0_f64.to_radians(),
            steps: 101,
            camera: true,
            step_time: 0.0,
        }
    }
}

impl Sweep {
    /// The positions of the sweep, in order.
    pub fn pans(&self) -> impl Iterator<Item = Pan> + use<> {
        let sweep = *self;
        (0..sweep.steps).map(move |step| {
            let share = f64::from(step) / f64::from(sweep.steps.max(2) - 1);
            let angle = sweep.from + (sweep.to - sweep.from) * share;
            Pan { camera: if sweep.camera { angle } else { 0.0 }, beams: angle }
        })
    }

    /// Time of a whole scan, seconds: each position takes `step_time`.
    ///
    /// ```
    /// use raypencil_rover::Sweep;
    ///
    /// assert_eq!(Sweep { steps: 11, step_time: 0.5, ..Sweep::default() }.duration(), 5.5);
    /// ```
    pub fn duration(&self) -> f64 {
        f64::from(self.steps) * self.step_time
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.step_time"), self.step_time, 0.0, 1e4, "s")?;
        check_range(|| format!("{field}.from"), self.from, -3.2, 3.2, "rad")?;
        check_range(|| format!("{field}.to"), self.to, -3.2, 3.2, "rad")?;
        check_count(|| format!("{field}.steps"), self.steps.into(), 1, 100_000)
    }
}

/// Conditions under which the vehicle stops for a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanRule {
    /// Scan in the first frame.
    pub at_start: bool,
    /// Distance between scans, metres. `None`: no periodic scan. "The vehicle should stop periodically in order to
    /// perform a complete vertical scan of the terrain to obtain a fresh LTM." (§7)
    pub every: Option<f64>,
    /// Threshold of the mean difference between new and old elevations, metres. A larger one triggers a scan. `None`:
    /// differences trigger none. "Error accumulation can lead to inconsistency between points taken at different
    /// frames." (§7)
    pub inconsistency: Option<f64>,
    /// Minimum number of re-measured grid points for which `inconsistency` may trigger a scan.
    pub least_points: u32,
    /// Whether a scan clears the old map first.
    pub clear_map: bool,
}

impl Default for ScanRule {
    /// CHOICE: a scan at the start; one every 5 m, the distance of the far stripe, so that no cell ahead is older than
    /// the last scan; and one at a mean difference of 0.1 m on 20 grid points, a third of the step that the default
    /// vehicle's slope tests refuse.
    fn default() -> Self {
        Self { at_start: true, every: Some(5.0), inconsistency: Some(0.1), least_points: 20, clear_map: true }
    }
}

/// Reason for a scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScanReason {
    /// No scan was made yet.
    Start,
    /// The vehicle has driven [`ScanRule::every`] since the last scan.
    Distance,
    /// New elevations contradict old ones.
    Inconsistency,
}

impl ScanRule {
    /// Reason for a scan now; `None` if none is due. `driven` is the distance since the start and `last_scan` its value
    /// at the last scan (`None` before the first), metres. `last_frame` is the inconsistency of the last frame.
    ///
    /// ```
    /// use raypencil_rover::{Inconsistency, ScanReason, ScanRule};
    ///
    /// // By default a scan is due every 5 m.
    /// let rule = ScanRule::default();
    /// assert_eq!(rule.due(0.0, None, &Inconsistency::default()), Some(ScanReason::Start));
    /// assert_eq!(rule.due(4.9, Some(0.0), &Inconsistency::default()), None);
    /// assert_eq!(rule.due(5.0, Some(0.0), &Inconsistency::default()), Some(ScanReason::Distance));
    /// ```
    pub fn due(&self, driven: f64, last_scan: Option<f64>, last_frame: &Inconsistency) -> Option<ScanReason> {
        if self.at_start && last_scan.is_none() {
            return Some(ScanReason::Start);
        }
        let since = driven - last_scan.unwrap_or(0.0);
        if self.every.is_some_and(|every| since >= every) {
            return Some(ScanReason::Distance);
        }
        let contradicted =
            |threshold: f64| last_frame.count >= self.least_points && last_frame.mean > threshold;
        self.inconsistency.is_some_and(contradicted).then_some(ScanReason::Inconsistency)
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        if let Some(every) = self.every {
            check_range(|| format!("{field}.every"), every, 1e-3, 1e9, "m")?;
        }
        if let Some(inconsistency) = self.inconsistency {
            check_range(|| format!("{field}.inconsistency"), inconsistency, 0.0, 1e3, "m")?;
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
        // A larger mean than 0.1 m is needed.
        for mean in [0.09, 0.1] {
            assert_eq!(rule.due(6.0, Some(5.0), &Inconsistency { mean, ..found }), None);
        }
        let never = ScanRule { at_start: false, every: None, inconsistency: None, ..rule };
        assert_eq!(never.due(1e6, None, &found), None);
        assert!(rule.validate("scan").is_ok() && Sweep::default().validate("sweep").is_ok());
        // Angles of up to 3.2 rad either way.
        let reaches = |angle: f64| Sweep { from: angle, to: -angle, ..Sweep::default() }.validate("sweep");
        assert!([-3.2, 3.2].into_iter().all(|angle| reaches(angle).is_ok()));
        assert!([-3.21, 3.21].into_iter().all(|angle| reaches(angle).is_err()));
    }
}
