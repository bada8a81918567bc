//! The obstacle maps of a drive against what the vehicle itself can pass on the true ground.
//!
//! The truth is the vehicle's own: its wheels as discs and its belly as a surface, on the faces of the mesh (crate
//! `chassis`). It shares nothing with the rover's tests. Sector by sector, the rover's end is compared with the first
//! place at which the vehicle cannot stand, both as distances from the vehicle where it truly is.

use raypencil_chassis::{Chassis, GroundFaces, Obstruction, ObstructionKind, Passage, PassageLimits};
use raypencil_report::count;
use raypencil_rover::{
    DrivePlan, ElevationMap, GridPoint, Label, MapPoint, MapSize, MapWithShadows, Missing, MissingReason,
    SectorEnd, TrueLimits, Vehicle,
};
use raypencil_scene::Pose;
use raypencil_terrain::HeightIndex;

use crate::swept_ground::{Swept, SweptGround};
use crate::true_rules::TrueRules;

/// Why an obstacle was called clear.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NotFound {
    /// Stripes passed over it, but other ground hid it.
    pub hidden: u64,
    /// Stripes met its cell, but only lower down: on their way up they had not come to its top.
    pub in_part: u64,
    /// No stripe had come to it yet.
    pub not_swept: u64,
    /// It lies beside the stripes or outside the camera's view.
    pub outside: u64,
}

impl NotFound {
    /// Number of all.
    pub fn all(self) -> u64 {
        self.hidden + self.in_part + self.not_swept + self.outside
    }
}

/// Why an obstacle that stripes swept and nothing hid was called clear.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Missed {
    /// The rover's rules find it on true elevations of the same cells: errors of the measured points or of the pose.
    pub by_errors: u64,
    /// They find it only on true elevations four times as dense.
    pub by_spacing: u64,
    /// They do not find it even there.
    pub by_rule: u64,
}

impl Missed {
    /// Number of all.
    pub fn all(self) -> u64 {
        self.by_errors + self.by_spacing + self.by_rule
    }
}

/// What a sector of an obstacle map is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Judgement {
    /// Testing stopped at the true obstacle.
    Found,
    /// Called clear beyond the true obstacle.
    Passed,
    /// Called an obstacle before any true one.
    False,
    /// Ends unknown before any true obstacle.
    Unknown,
    /// Clear to its last radius, and truly so.
    Clear,
    /// The ground ends before the sector does.
    OffGround,
}

/// A sector against the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct JudgedSector {
    pub judgement: Judgement,
    /// First radius at which the vehicle cannot stand, metres. `None`: it can up to the last one, or the ground ends.
    pub true_radius: Option<f64>,
    /// The rule that stops it there.
    pub true_rule: Option<ObstructionKind>,
}

/// Counts of the sectors of obstacle maps against the truth. Each sector of each map counts once.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SectorTruth {
    /// Number of obstacle maps.
    pub maps: u64,
    /// Number of sectors.
    pub sectors: u64,
    /// Sectors with an obstacle within their last radius.
    pub with_obstacle: u64,
    /// The same by the rule that stops the vehicle there.
    pub true_rules: TrueRules,
    /// Of these: testing stopped at an obstacle, not more than one step before or two after the true one.
    pub found: u64,
    /// Of these: called clear beyond the true obstacle by more than one step, though stripes swept it and nothing hid it.
    pub missed: Missed,
    /// Of these: called clear beyond it likewise, but no stripe lit what stops the vehicle.
    pub not_found: NotFound,
    /// Sectors called an obstacle more than one step before any true one, or without any.
    pub false_obstacle: u64,
    /// Of the false ones: those before a true obstacle of the sector.
    pub false_before: u64,
    /// Sectors that end unknown before any true obstacle, by reason.
    pub unknown_not_measured: u64,
    /// Likewise: more may hide in a shadow than the vehicle can pass.
    pub unknown_may_hide: u64,
    /// Likewise: a slope is nearer to its limit than its errors.
    pub unknown_near_limit: u64,
    /// Likewise: the map ends.
    pub unknown_beyond_map: u64,
    /// Sectors that are clear to their last radius, and truly so.
    pub clear: u64,
    /// Sectors in which the true ground ends before the rover's end: not judged.
    pub off_ground: u64,
    /// Sum of the radii up to which sectors were truly clear and called so, millimetres. It is 0 for one that is not clear at its
    /// first radius.
    pub clear_mm: u64,
}

/// The true ground, ready to be asked.
pub(crate) struct TrueGround<'a> {
    pub heights: &'a HeightIndex,
    pub swept: &'a SweptGround,
}

/// The vehicle as it truly is.
fn chassis(vehicle: &Vehicle, truth: &TrueLimits) -> Chassis {
    let Vehicle { wheelbase, track, wheel_radius, wheel_width, .. } = *vehicle;
    let clearance = truth.clearance.unwrap_or(vehicle.clearance);
    Chassis { wheelbase, track, wheel_radius, wheel_width, clearance }
}

/// First obstacle of a sector on the true ground.
pub(crate) enum First {
    Obstacle {
        radius: f64,
        obstruction: Obstruction,
    },
    /// The ground ends there.
    Edge {
        radius: f64,
    },
    None,
}

impl SectorTruth {
    /// Adds an obstacle map that a vehicle with the true pose `global_from_vehicle` made of `map`, and judges its sectors.
    pub(crate) fn add(
        &mut self,
        sectors: &[SectorEnd],
        map: &ElevationMap,
        ground: &TrueGround,
        plan: &DrivePlan,
        global_from_vehicle: &Pose,
        firsts: &[First],
    ) -> Vec<JudgedSector> {
        self.maps += 1;
        let mut dense: Option<[ElevationMap; 2]> = None;
        let mut judged = Vec::with_capacity(sectors.len());
        for ((index, end), first) in sectors.iter().enumerate().zip(firsts) {
            self.sectors += 1;
            let finds = |maps: &mut Option<[ElevationMap; 2]>| {
                maps.get_or_insert_with(|| true_maps(map, ground.heights, global_from_vehicle)).clone()
            };
            let judgement =
                self.add_sector(index as u32, end, first, ground, plan, global_from_vehicle, &mut || {
                    finds(&mut dense)
                });
            let (true_radius, true_rule) = match first {
                First::Obstacle { radius, obstruction } => (Some(*radius), Some(obstruction.kind)),
                First::Edge { .. } | First::None => (None, None),
            };
            judged.push(JudgedSector { judgement, true_radius, true_rule });
        }
        judged
    }

    fn add_sector(
        &mut self,
        sector: u32,
        end: &SectorEnd,
        first: &First,
        ground: &TrueGround,
        plan: &DrivePlan,
        global_from_vehicle: &Pose,
        true_maps: &mut dyn FnMut() -> [ElevationMap; 2],
    ) -> Judgement {
        let step = plan.grid.step;
        // Radii are multiples of a step: half a step on either side of the limit keeps rounding out.
        let within = 1.5 * step;
        let last_clear = if end.label == Label::Visibility { end.radius } else { end.radius - step };
        let (radius, obstruction) = match first {
            First::Edge { radius } if last_clear > *radius - 0.5 * step => {
                self.off_ground += 1;
                return Judgement::OffGround;
            }
            First::Obstacle { radius, obstruction } => (*radius, Some(obstruction)),
            First::Edge { .. } | First::None => (f64::INFINITY, None),
        };
        self.with_obstacle += u64::from(obstruction.is_some());
        if let Some(obstruction) = obstruction {
            self.true_rules.add(obstruction.kind);
        }
        // Nearer than the first radius nothing is tested: a sector that ends there has no clear way at all.
        let clear_way = last_clear.min(radius - step);
        if clear_way > plan.grid.radius(0) - 0.5 * step {
            self.clear_mm += (1000.0 * clear_way).round() as u64;
        }
        if end.label == Label::Obstacle && end.radius < radius - within {
            self.false_obstacle += 1;
            self.false_before += u64::from(obstruction.is_some());
            Judgement::False
        } else if let Some(obstruction) = obstruction.filter(|_| last_clear > radius + within) {
            let swept = obstruction.points.iter().map(|&point| ground.swept.at(point)).max();
            match swept.unwrap_or(Swept::Never) {
                Swept::Never => self.not_found.not_swept += 1,
                Swept::Lower => self.not_found.in_part += 1,
                Swept::Outside => self.not_found.outside += 1,
                Swept::Hidden => self.not_found.hidden += 1,
                Swept::Seen => {
                    let [same, dense] = true_maps();
                    let finds = |map: &ElevationMap| {
                        let DrivePlan { vehicle, rules, grid, .. } = plan;
                        let map = &MapWithShadows::of(map);
                        let mut classes =
                            grid.classify_sector(sector, map, vehicle, rules, global_from_vehicle);
                        classes
                            .find(|(_, class)| *class != raypencil_rover::Traversability::Clear)
                            .is_some_and(|(at, _)| at - step <= radius + within)
                    };
                    let missed = &mut self.missed;
                    if finds(&same) {
                        missed.by_errors += 1;
                    } else if finds(&dense) {
                        missed.by_spacing += 1;
                    } else {
                        missed.by_rule += 1;
                    }
                }
            }
            Judgement::Passed
        } else {
            match (end.label, end.missing) {
                (Label::Obstacle, _) => {
                    self.found += 1;
                    return Judgement::Found;
                }
                (Label::Visibility, _) => {
                    self.clear += 1;
                    return Judgement::Clear;
                }
                (Label::Unknown, Some(Missing { reason: MissingReason::MayHide, .. })) => {
                    self.unknown_may_hide += 1;
                }
                (Label::Unknown, Some(Missing { reason: MissingReason::NearLimit, .. })) => {
                    self.unknown_near_limit += 1;
                }
                (Label::Unknown, Some(Missing { reason: MissingReason::BeyondMap, .. })) => {
                    self.unknown_beyond_map += 1;
                }
                (Label::Unknown, _) => self.unknown_not_measured += 1,
            }
            Judgement::Unknown
        }
    }

    /// Number of sectors that were called clear beyond a true obstacle, for whatever reason: a vehicle that believed them
    /// would have met it.
    pub fn passed(&self) -> u64 {
        self.missed.all() + self.not_found.all()
    }

    /// Share of the sectors with an obstacle that stripes swept and nothing hid in which it was missed, of 1.
    pub fn missed_share(&self) -> f64 {
        self.missed.all() as f64 / (self.found + self.missed.all()).max(1) as f64
    }

    /// Share of all sectors with a false obstacle, of 1.
    pub fn false_share(&self) -> f64 {
        self.false_obstacle as f64 / self.sectors.max(1) as f64
    }

    pub(crate) fn sentences(&self) -> Vec<String> {
        let Self { missed, not_found, .. } = self;
        let unknown = self.unknown_not_measured
            + self.unknown_may_hide
            + self.unknown_near_limit
            + self.unknown_beyond_map;
        let mut sentences = vec![
            format!(
                "of {} sectors {} end at a true obstacle, {} at a false one, {} unknown, {} are clear",
                count(self.sectors),
                count(self.found),
                count(self.false_obstacle),
                count(unknown),
                count(self.clear),
            ),
            format!(
                "{} pass a true obstacle: {} miss one that stripes swept, {} one measured in part, {} one that could \
                 not be seen",
                count(self.passed()),
                count(missed.all()),
                count(not_found.in_part),
                count(not_found.all() - not_found.in_part),
            ),
        ];
        if self.passed() > 0 {
            sentences.push(format!(
                "missed by errors {}, spacing {}, rule {}; measured in part {}; not seen: hidden {}, not swept {}, outside {}",
                count(missed.by_errors),
                count(missed.by_spacing),
                count(missed.by_rule),
                count(not_found.in_part),
                count(not_found.hidden),
                count(not_found.not_swept),
                count(not_found.outside),
            ));
        }
        sentences
    }

    /// The sentence of an upper bound: what exact eyes would have found.
    pub(crate) fn sentence_of_bound(&self) -> String {
        format!(
            "exact eyes would end {} at a true obstacle, {} at a false one, and pass {}; clear way {:.2} m",
            count(self.found),
            count(self.false_obstacle),
            count(self.passed()),
            self.mean_clear_way(),
        )
    }

    /// Mean distance up to which a sector was truly clear and called so, metres.
    pub fn mean_clear_way(&self) -> f64 {
        self.clear_mm as f64 / 1000.0 / self.sectors.max(1) as f64
    }
}

/// First place of each sector at which the vehicle cannot stand.
pub(crate) fn first_obstacles(
    faces: &GroundFaces,
    plan: &DrivePlan,
    global_from_vehicle: &Pose,
) -> Vec<First> {
    (0..plan.grid.sectors).map(|sector| first_obstacle(sector, faces, plan, global_from_vehicle)).collect()
}

/// First place of a sector at which the vehicle cannot stand.
fn first_obstacle(sector: u32, faces: &GroundFaces, plan: &DrivePlan, global_from_vehicle: &Pose) -> First {
    let DrivePlan { grid, vehicle, rules, truth, .. } = plan;
    let [front, rear, length] = truth.slopes(&rules.slopes);
    let step = truth.step.unwrap_or(f64::INFINITY);
    let limits = PassageLimits { front, rear, length, step, centre_of_mass: truth.centre_of_mass };
    let (chassis, (_, unit)) = (chassis(vehicle, truth), grid.direction(sector, global_from_vehicle));
    let centre = global_from_vehicle.position.truncate();
    for index in 0..grid.radii() {
        let radius = grid.radius(index);
        let front = centre + unit * radius;
        match chassis.passage(faces, front, unit, &limits) {
            // From the radius before, and to the first one as far.
            Passage::Clear if limits.step.is_finite() => {
                if let Some(obstruction) = chassis.step(faces, front, unit, grid.step, limits.step) {
                    return First::Obstacle { radius, obstruction };
                }
            }
            Passage::Clear => {}
            Passage::OffGround => return First::Edge { radius },
            Passage::Blocked(obstruction) => return First::Obstacle { radius, obstruction },
        }
    }
    First::None
}

/// Maps of the true elevations around a vehicle: one with the cells of `map`, and one of a quarter of its spacing.
fn true_maps(map: &ElevationMap, ground: &HeightIndex, global_from_vehicle: &Pose) -> [ElevationMap; 2] {
    let size = map.size();
    let dense = MapSize { spacing: 0.25 * size.spacing, points: (4 * (size.points / 2) + 1).min(801) };
    [size, dense].map(|size| {
        let mut truth = ElevationMap::new(size, global_from_vehicle.position.truncate());
        let points: Vec<GridPoint> = truth.points().collect();
        let elevations: Vec<MapPoint> = points
            .into_iter()
            .filter_map(|point| {
                let place = truth.place(point);
                let point = place.extend(ground.height_at(place.x, place.y)?);
                Some(MapPoint { point, standard_error: 0.0, sight: None })
            })
            .collect();
        truth.insert(elevations);
        truth
    })
}

#[cfg(test)]
#[path = "../tests/unit/sector_truth.rs"]
mod tests;
