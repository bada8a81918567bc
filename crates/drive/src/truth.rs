//! What a drive's obstacle maps say, against the same tests on the true ground: point by point of the radial grid.
//! (Paper, §7) `docs/evidence/results.md` has the table.

use glam::DVec2;

use crate::job::DriveJob;
use raypencil_report::count;
use raypencil_rover::{
    DrivePlan, ElevationMap, LocalisationErrors, PositionFixes, Traversability, TraversabilityRules,
};
use raypencil_scene::Pose;
use raypencil_scene_io::default_threshold;
use raypencil_sensor::preset;
use raypencil_terrain::HeightIndex;

/// What the rover says of points that are all the same in truth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Said {
    /// Obstacle.
    pub obstacle: u64,
    /// Unknown.
    pub unknown: u64,
    /// Clear.
    pub clear: u64,
}

impl Said {
    /// All of them.
    pub fn points(self) -> u64 {
        self.obstacle + self.unknown + self.clear
    }

    fn add(&mut self, verdict: Traversability) {
        *match verdict {
            Traversability::Obstacle(_) => &mut self.obstacle,
            Traversability::Unknown => &mut self.unknown,
            Traversability::Clear => &mut self.clear,
        } += 1;
    }
}

/// The points and sectors of obstacle maps, by truth and by what the rover says.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TruthMatrix {
    /// Obstacle maps.
    pub maps: u64,
    /// Points that are obstacle points on the true ground. Those called clear are missed: the dangerous ones.
    pub obstacle: Said,
    /// Points that are clear on the true ground.
    pub clear: Said,
    /// Points that the ground ends at, of which there is no truth.
    pub beyond: u64,
    /// Sectors.
    pub sectors: u64,
    /// Of them those declared free past a true obstacle point, and on by more than a step.
    pub past: u64,
}

impl TruthMatrix {
    /// Adds the obstacle map that `map` gives to a vehicle that believes itself at `global_from_vehicle`.
    ///
    /// The truth is that of the same global coordinates: where the vehicle is not where it believes to be, the map lies
    /// beside the ground, and that counts as the map's error. Every point is judged by itself, also where testing of its
    /// sector had stopped before.
    pub fn add(
        &mut self,
        map: &ElevationMap,
        ground: &HeightIndex,
        plan: &DrivePlan,
        global_from_vehicle: &Pose,
    ) {
        let DrivePlan { vehicle, rules, grid, .. } = plan;
        let truth = true_map(map, ground);
        self.maps += 1;
        for sector in 0..grid.sectors {
            let verdicts = |map| grid.classify_sector(sector, map, vehicle, rules, global_from_vehicle);
            let (mut first_obstacle, mut free) = (None, None);
            let mut stopped = false;
            for (index, ((_, said), (_, is))) in verdicts(map).zip(verdicts(&truth)).enumerate() {
                match is {
                    Traversability::Obstacle(_) => self.obstacle.add(said),
                    Traversability::Clear => self.clear.add(said),
                    Traversability::Unknown => self.beyond += 1,
                }
                if matches!(is, Traversability::Obstacle(_)) {
                    first_obstacle = first_obstacle.or(Some(index));
                }
                stopped |= said != Traversability::Clear;
                if !stopped {
                    free = Some(index);
                }
            }
            self.sectors += 1;
            if let (Some(free), Some(obstacle)) = (free, first_obstacle) {
                self.past += u64::from(free > obstacle + 1);
            }
        }
    }

    /// The matrix in words: of what is an obstacle, and of what is none.
    pub(super) fn words(&self) -> [String; 2] {
        let Self { obstacle, clear, .. } = self;
        let of = |part, all: &Said| percent(part, all.points());
        [
            format!(
                "of {} obstacle points {} found, {} unknown, {} missed; {} of {} sectors free past one",
                count(obstacle.points()),
                of(obstacle.obstacle, obstacle),
                of(obstacle.unknown, obstacle),
                of(obstacle.clear, obstacle),
                count(self.past),
                count(self.sectors),
            ),
            format!(
                "of {} clear points {} false obstacles, {} unknown",
                count(clear.points()),
                of(clear.obstacle, clear),
                of(clear.unknown, clear),
            ),
        ]
    }

    /// A row of [`TRUTH_HEAD`].
    pub fn row(&self, drive: &str, what: &str) -> String {
        let Self { obstacle, clear, .. } = self;
        let of = |part, all: &Said| percent(part, all.points());
        format!(
            "| {drive} | {what} | {} | {} | {} | {} | {} | {} | {} | {} of {} |",
            count(obstacle.points()),
            of(obstacle.obstacle, obstacle),
            of(obstacle.unknown, obstacle),
            of(obstacle.clear, obstacle),
            count(clear.points()),
            of(clear.obstacle, clear),
            of(clear.unknown, clear),
            count(self.past),
            count(self.sectors),
        )
    }
}

/// The head of a table of [`TruthMatrix::row`]s, in Markdown.
pub const TRUTH_HEAD: &str = "\
| drive | | obstacle points | found | unknown | missed | clear points | false obstacle | unknown | sectors free past an obstacle |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |";

/// A share, in tenths of a percent where it is small; never 0 for one that is not.
fn percent(part: u64, all: u64) -> String {
    let share = 100.0 * part as f64 / all.max(1) as f64;
    match share {
        _ if part == 0 => "0 %".into(),
        ..0.05 => "< 0.1 %".into(),
        ..9.95 => format!("{share:.1} %"),
        // Nor all for one that is not.
        99.5.. if part < all => format!("{:.1} %", share.min(99.9)),
        _ => format!("{share:.0} %"),
    }
}

/// A map of the same size and at the same place that knows the true elevation of every grid point with ground.
fn true_map(map: &ElevationMap, ground: &HeightIndex) -> ElevationMap {
    let mut truth = map.clone();
    truth.clear();
    for point in truth.points() {
        let place = truth.place(point);
        if let Some(z) = ground.height_at(place.x, place.y) {
            truth.set_proximity(point, z);
        }
    }
    truth
}

/// How well a rover of the truth table sees and knows where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoiseLevel {
    /// The `ideal` sensor; places and angles as they are.
    None,
    /// `cmos`, and good inertial sensors.
    Modest,
    /// `ccd_1989`, and bad ones.
    Coarse,
}

impl NoiseLevel {
    /// From the least.
    pub const ALL: [Self; 3] = [Self::None, Self::Modest, Self::Coarse];

    /// Its name in the table.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Modest => "modest",
            Self::Coarse => "coarse",
        }
    }

    /// Name of the sensor preset.
    fn preset(self) -> &'static str {
        match self {
            Self::None => "ideal",
            Self::Modest => "cmos",
            Self::Coarse => "ccd_1989",
        }
    }

    /// The errors of where the rover is, for one that drives at `speed`, metres per second.
    ///
    /// CHOICE, all of it: the paper gives no figures. The drift is 1 % and 4 % of the way, forward and to the left of the
    /// global axes like 4 to 3; beacons are seen every 10 s at the built-in drives' 3 frames a second, or never.
    fn errors(self, speed: f64) -> LocalisationErrors {
        let drift = |share: f64| DVec2::new(0.8, 0.6) * (share * speed);
        match self {
            Self::None => LocalisationErrors::default(),
            Self::Modest => LocalisationErrors {
                position_drift: drift(0.01),
                position_walk: 0.005,
                heading_drift: 0.002_f64.to_radians(),
                attitude_noise: 0.1_f64.to_radians(),
                proximity_noise: 0.01,
                fixes: Some(PositionFixes { every_frames: 30, noise: 0.05 }),
                ..LocalisationErrors::default()
            },
            Self::Coarse => LocalisationErrors {
                position_drift: drift(0.04),
                position_walk: 0.02,
                heading_drift: 0.02_f64.to_radians(),
                attitude_noise: 0.5_f64.to_radians(),
                proximity_noise: 0.03,
                fixes: None,
                ..LocalisationErrors::default()
            },
        }
    }

    /// The drive with these errors in place of its own, seeds 0, and the rules as the paper prints them: no gap is crossed.
    #[must_use]
    pub fn applied(self, mut job: DriveJob) -> DriveJob {
        let wavelength = job.sensor.wavelength;
        job.preset = self.preset();
        let (optics, sensor) = preset(job.preset).expect("the name of a preset");
        job.optics = optics;
        job.sensor = raypencil_sensor::ImageSensor { wavelength, seed: 0, ..sensor };
        job.plan.extraction.detection = raypencil_rover::Detection::Fixed(default_threshold(job.preset));
        job.plan.errors = self.errors(job.plan.route.speed);
        job.plan.seed = 0;
        job.plan.rules = TraversabilityRules::for_vehicle(&job.plan.vehicle);
        job
    }
}

#[cfg(test)]
#[path = "../tests/unit/truth.rs"]
mod tests;
