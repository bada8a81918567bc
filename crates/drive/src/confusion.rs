//! Confusion matrix of obstacle maps: each point of the radial grid on the rover's map against the same point on the
//! true ground. (Paper, §7) `docs/evidence/results.md` has the table.

use raypencil_report::count;
use raypencil_rover::{DrivePlan, ElevationMap, Traversability};
use raypencil_scene::Pose;
use raypencil_terrain::HeightIndex;

/// Predictions of the rover's map, for points of one true class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Predicted {
    /// Number of points predicted as obstacles.
    pub obstacle: u64,
    /// Number of points predicted as unknown.
    pub unknown: u64,
    /// Number of points predicted as clear.
    pub clear: u64,
}

impl Predicted {
    /// Number of all points.
    pub fn points(self) -> u64 {
        self.obstacle + self.unknown + self.clear
    }

    fn add(&mut self, predicted: Traversability) {
        *match predicted {
            Traversability::Obstacle(_) => &mut self.obstacle,
            Traversability::Unknown => &mut self.unknown,
            Traversability::Clear => &mut self.clear,
        } += 1;
    }
}

/// Confusion matrix of obstacle maps: numbers of points by true and predicted class, and of sectors that miss an
/// obstacle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ConfusionMatrix {
    /// Number of obstacle maps.
    pub maps: u64,
    /// Points that are obstacles on the true ground. Those predicted as clear are missed (false negatives): the
    /// dangerous ones.
    pub obstacle: Predicted,
    /// Points that are clear on the true ground. Those predicted as obstacles are false positives.
    pub clear: Predicted,
    /// Number of points without a true class, because the ground ends there.
    pub off_ground: u64,
    /// Number of sectors.
    pub sectors: u64,
    /// Number of sectors reported free more than one grid step beyond a true obstacle.
    pub free_past_obstacle: u64,
}

impl ConfusionMatrix {
    /// Adds the obstacle map that a vehicle with the estimated pose `global_from_vehicle` makes of `map`.
    ///
    /// Map and ground are compared at the same global coordinates. If the estimated pose is wrong, the map lies beside
    /// the ground; this counts as the map's error. Every point is classified on its own, even if testing of its sector
    /// had stopped before it.
    pub(crate) fn add(
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
            let classes = |map| grid.classify_sector(sector, map, vehicle, rules, global_from_vehicle);
            let (mut first_obstacle, mut last_free) = (None, None);
            let mut stopped = false;
            for (index, ((_, predicted), (_, actual))) in classes(map).zip(classes(&truth)).enumerate() {
                match actual {
                    Traversability::Obstacle(_) => self.obstacle.add(predicted),
                    Traversability::Clear => self.clear.add(predicted),
                    Traversability::Unknown => self.off_ground += 1,
                }
                if matches!(actual, Traversability::Obstacle(_)) {
                    first_obstacle = first_obstacle.or(Some(index));
                }
                stopped |= predicted != Traversability::Clear;
                if !stopped {
                    last_free = Some(index);
                }
            }
            self.sectors += 1;
            if let (Some(free), Some(obstacle)) = (last_free, first_obstacle) {
                self.free_past_obstacle += u64::from(free > obstacle + 1);
            }
        }
    }

    /// Sentences for a screen: one for the true obstacle points, one for the true clear points.
    pub(crate) fn sentences(&self) -> [String; 2] {
        let Self { obstacle, clear, .. } = self;
        let of = |part, all: &Predicted| percent(part, all.points());
        [
            format!(
                "of {} obstacle points {} found, {} unknown, {} missed; {} of {} sectors free past one",
                count(obstacle.points()),
                of(obstacle.obstacle, obstacle),
                of(obstacle.unknown, obstacle),
                of(obstacle.clear, obstacle),
                count(self.free_past_obstacle),
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

    /// Header of a Markdown table of [`ConfusionMatrix::table_row`]s.
    pub const fn table_header() -> &'static str {
        "\
| drive | | obstacle points | found | unknown | missed | clear points | false obstacle | unknown | sectors free past an obstacle |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    }

    /// Row of a Markdown table: the drive, the settings that were changed, and the matrix.
    pub fn table_row(&self, drive: &str, settings: &str) -> String {
        let Self { obstacle, clear, .. } = self;
        let of = |part, all: &Predicted| percent(part, all.points());
        format!(
            "| {drive} | {settings} | {} | {} | {} | {} | {} | {} | {} | {} of {} |",
            count(obstacle.points()),
            of(obstacle.obstacle, obstacle),
            of(obstacle.unknown, obstacle),
            of(obstacle.clear, obstacle),
            count(clear.points()),
            of(clear.obstacle, clear),
            of(clear.unknown, clear),
            count(self.free_past_obstacle),
            count(self.sectors),
        )
    }
}

/// Percentage of a part, with a tenth of a percent below 9.95 %. "0 %" and "100 %" mean exactly none and exactly all.
fn percent(part: u64, all: u64) -> String {
    let share = 100.0 * part as f64 / all.max(1) as f64;
    match share {
        _ if part == 0 => "0 %".into(),
        ..0.05 => "< 0.1 %".into(),
        ..9.95 => format!("{share:.1} %"),
        // A part that is not all is never 100 %.
        99.5.. if part < all => format!("{:.1} %", share.min(99.9)),
        _ => format!("{share:.0} %"),
    }
}

/// Map of the same size and position with the true elevation of every grid point that has ground.
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

#[cfg(test)]
#[path = "../tests/unit/confusion.rs"]
mod tests;
