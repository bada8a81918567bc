//! Warnings about a drive: beams that the camera cannot tell apart, a threshold that does not fit the light, sensors
//! that do not see the ground at the start, nothing measured.

use glam::DVec3;
use raypencil_rover::{DrivePlan, ExposureMode, OnVehicle, StripeExtractor};
use raypencil_scene::{Mesh, Pose, Scene, SceneError};
use raypencil_survey::{TerrainShape, Warning, WarningCode, lies_on_its_side, warnings};

use crate::maps::obstacle_grid::tested_within;

/// Warns if beams are lit together and a beam is not steeper than the next one. Stripes of one image are told apart by
/// their order: the lowest is taken for that of beam 0, the steepest.
pub(crate) fn beams_out_of_order(plan: &DrivePlan) -> Option<Warning> {
    let down = |beam: &OnVehicle<_>| -beam.vehicle_from_sensor.rotate(DVec3::Z).z;
    let steeper = plan.rig.beams.windows(2).position(|pair| down(&pair[0]) <= down(&pair[1]))?;
    (plan.exposures == ExposureMode::Together).then(|| {
        let sentence = format!(
            "beam {steeper} is not steeper than beam {}: with both in one image, the lowest stripe counts as beam 0's.",
            steeper + 1
        );
        Warning::of_scene(WarningCode::BeamsOutOfOrder, sentence)
    })
}

/// Warns if tested places are so far apart that ground between them meets no wheel: neighbouring sectors at their last radius,
/// or two radii of a sector.
pub(crate) fn sectors_far_apart(plan: &DrivePlan) -> Option<Warning> {
    let (grid, [ahead, aside]) = (&plan.grid, tested_within(&plan.vehicle).map(|half| 2.0 * half));
    let between = 2.0 * grid.half_angle / f64::from(grid.sectors.max(2) - 1);
    let last = grid.radius(grid.radii() - 1);
    // Half a turn apart or more they could not be farther.
    let apart = 2.0 * last * libm::sin(0.5 * between.min(std::f64::consts::PI));
    let what = if grid.sectors > 1 && apart > aside {
        format!(
            "neighbouring sectors are {apart:.2} m apart at {last:.2} m, and a wheel is {aside:.2} m wide"
        )
    } else if grid.radii() > 1 && grid.step > ahead {
        format!("the radii of a sector are {:.2} m apart, and a wheel is {ahead:.2} m long", grid.step)
    } else {
        return None;
    };
    let sentence = format!(
        "{what}: nothing is tested between. The map for Nav2 has it unknown, but the vectors of the navigator map cross it."
    );
    Some(Warning::of_scene(WarningCode::SectorsFarApart, sentence))
}

/// Largest distance of a square grid's points, metres, at which a rectangle of these sides has one of them on it or in it, wherever it
/// lies and however it is turned: at which a wheel, seen from above, cannot stand between them.
///
/// Let the shorter side be a and the longer b. Between two rows of points, s apart, is no point: so s is at most a. With s <= a, go
/// along the rectangle, which is turned against the rows by t up to 45 degrees, from a point of the grid on it to the next. A step
/// from row to row leads s cos t across it and s sin t along; one in the row, s sin t back across and s cos t along. The first, the
/// second, or both together stay on it, and lead along by s (sin t + cos t) at most, up to sqrt(2) s at 45 degrees: so s is at
/// most b / sqrt(2).
fn largest_spacing([a, b]: [f64; 2]) -> f64 {
    a.min(b).min(a.max(b) / std::f64::consts::SQRT_2)
}

/// Warns if the points of the map are so far apart that a wheel may stand between them: then what stands beside a point, and was
/// measured, is missed.
pub(crate) fn map_coarser_than_wheel(plan: &DrivePlan) -> Option<Warning> {
    let (spacing, wheel) = (plan.map.spacing, [plan.vehicle.wheel_width, 2.0 * plan.vehicle.wheel_radius]);
    let most = largest_spacing(wheel);
    (spacing > most).then(|| {
        let [wide, long] = wheel;
        let sentence = format!(
            "the points of the map are {spacing} m apart, and a wheel is {wide:.2} m wide and {long:.2} m long: it may roll between \
             them, over what was measured. Give map_spacing_m {} or less.",
            (most * 1e3).floor() / 1e3
        );
        Warning::of_scene(WarningCode::MapCoarserThanWheel, sentence)
    })
}

/// Warns that the default threshold does not account for `ignored`: light or electronics that the file changes.
///
/// With an unlit image subtracted, the sun's light is gone but its noise is not: the warning is given there, too.
pub(crate) fn blind_threshold(ignored: &str) -> Warning {
    let sentence =
        format!("the default threshold is for the preset alone, without {ignored}: give threshold_dn.");
    Warning::of_scene(WarningCode::BlindThreshold, sentence)
}

/// Warnings about the scene of the first frame. The vehicle stands on its wheels there, whatever the scene file says.
pub(crate) fn at_the_start(scene: &Scene) -> Vec<Warning> {
    warnings(scene, None, None)
}

/// How steep a vehicle stands: rise over distance of its own axes, along and across.
fn steepness(stance: &Pose) -> [f64; 2] {
    [DVec3::X, DVec3::Y].map(|axis| {
        let along = stance.rotate(axis);
        along.z.abs() / along.truncate().length().max(f64::MIN_POSITIVE)
    })
}

/// What the vehicle's own obstacle tests allow of it.
fn allowed(plan: &DrivePlan) -> [f64; 2] {
    let limits = plan.rules.slopes;
    [limits.length, limits.front.min(limits.rear)]
}

/// "25 degrees along its length and 0 across, where its own tests allow 16 and 19".
fn steep_words(plan: &DrivePlan, steepness: [f64; 2]) -> String {
    let degrees = |slope: f64| libm::atan(slope).to_degrees();
    let ([along, across], [most_along, most_across]) = (steepness.map(degrees), allowed(plan).map(degrees));
    // Whole degrees, but where the one that is too steep is less than one beyond its limit.
    let is_near = |slope: f64, most: f64| (0.0..1.0).contains(&(slope - most));
    let places = usize::from(is_near(along, most_along) || is_near(across, most_across));
    format!(
        "{along:.places$} degrees along its length and {across:.places$} across, where its own tests allow \
         {most_along:.places$} and {most_across:.places$}"
    )
}

fn is_too_steep(plan: &DrivePlan, [along, across]: [f64; 2]) -> bool {
    let [most_along, most_across] = allowed(plan);
    along > most_along || across > most_across
}

/// Warns if the vehicle stands steeper at the start, with the pose `stance`, than its own obstacle tests let it.
pub(crate) fn start_too_steep(plan: &DrivePlan, stance: &Pose) -> Option<Warning> {
    let steepness = steepness(stance);
    is_too_steep(plan, steepness).then(|| {
        let sentence = format!("the vehicle starts on too steep ground: {}.", steep_words(plan, steepness));
        Warning::of_scene(WarningCode::StartTooSteep, sentence)
    })
}

/// Warns if the vehicle stands steeper on its way than its own obstacle tests let it: a drive follows its waypoints, whatever
/// the rover thinks of the ground. `stances` are those of all frames; the first is the start.
pub(crate) fn way_too_steep(plan: &DrivePlan, stances: &[Pose]) -> Option<Warning> {
    let steep = || {
        let stances = stances.iter().enumerate().skip(1).map(|(frame, pose)| (frame, pose, steepness(pose)));
        stances.filter(|(.., steepness)| is_too_steep(plan, *steepness))
    };
    // How much of its limits it takes; of equal ones the first.
    let share = |[along, across]: [f64; 2]| {
        let [most_along, most_across] = allowed(plan);
        (along / most_along).max(across / most_across)
    };
    let worst = steep().reduce(|a, b| if share(b.2) > share(a.2) { b } else { a });
    worst.map(|(frame, pose, steepness)| {
        let count = steep().count();
        let place = pose.position;
        let sentence = format!(
            "the way leads over too steep ground: in {count} of {} frames, worst in frame {frame} at {:.2}, {:.2} m, with {}.",
            stances.len(),
            place.x,
            place.y,
            steep_words(plan, steepness)
        );
        Warning::of_scene(WarningCode::WayTooSteep, sentence)
    })
}

/// The error of a route without ground, with what to do if the ground lies on its side, since its file has another axis up.
pub(crate) fn with_hint(error: SceneError, mesh: &Mesh) -> SceneError {
    let on_its_side = || TerrainShape::of(mesh).is_some_and(|shape| lies_on_its_side(&shape));
    if !error.field.starts_with("drive.route") || !on_its_side() {
        return error;
    }
    let hint = "the terrain stands upright, flat along y: does its file have another axis up? Then set terrain.up=y (or z)";
    SceneError { expected: format!("{} ({hint})", error.expected), ..error }
}

/// Warns if a whole drive found no edge of a stripe: then its maps know nothing.
pub(crate) fn nothing_measured(edge_points: u64) -> Option<Warning> {
    let sentence = "no image gave an edge of a stripe, so no point of the ground was measured.";
    (edge_points == 0).then(|| Warning::of_scene(WarningCode::NothingMeasured, sentence))
}

/// Warns of stripes that were given for images that the drive did not take: those of another drive, or counted otherwise.
pub(crate) fn stripes_left_over(extractor: Option<&dyn StripeExtractor>) -> Option<Warning> {
    let sentence = extractor?.left_over()?;
    Some(Warning::of_scene(WarningCode::StripesLeftOver, sentence))
}

#[cfg(test)]
mod tests {
    use raypencil_rover::Attitude;

    use super::*;
    use crate::common::{FLAT, SHORT, job};

    #[test]
    fn sectors_and_radii_too_far_apart_for_a_wheel_are_told() {
        let plan = job(FLAT, SHORT).plan;
        let said = |sectors, half_angle: f64, step| {
            let grid = raypencil_rover::RadialGrid { sectors, half_angle, step, ..plan.grid };
            let plan = DrivePlan { grid, ..plan.clone() };
            sectors_far_apart(&plan).map(|warning| warning.to_string())
        };
        let half = 30.0_f64.to_radians();
        assert_eq!((said(31, half, 0.1), said(1, half, 0.1)), (None, None));
        // 4.8 m * 2 sin 15 degrees = 2.485 m; 0.25 m is met between 21 and 22 sectors (0.251 and 0.239 m).
        let far = said(3, half, 0.1).unwrap();
        assert!(far.contains("are 2.48 m apart at 4.80 m, and a wheel is 0.25 m wide: nothing"), "{far}");
        assert_eq!([21, 22].map(|sectors| said(sectors, half, 0.1).is_some()), [true, false]);
        // Two sectors to the left and right of the way back are apart by what lies ahead.
        assert!(said(2, 3.0, 0.1).unwrap().contains("are 9.60 m apart"));
        // Radii: 0.7 m is as long as a wheel.
        assert_eq!(said(31, half, 0.7), None);
        let steps = said(31, half, 0.75).unwrap();
        assert!(steps.contains("radii of a sector are 0.75 m apart, and a wheel is 0.70 m long"), "{steps}");
    }

    #[test]
    fn a_map_with_points_farther_apart_than_a_wheel_is_told() {
        let plan = job(FLAT, SHORT).plan;
        let said = |spacing, wheel_width, wheel_radius| {
            let vehicle = raypencil_rover::Vehicle { wheel_width, wheel_radius, ..plan.vehicle };
            let map = raypencil_rover::MapSize { spacing, ..plan.map };
            let plan = DrivePlan { vehicle, map, ..plan.clone() };
            map_coarser_than_wheel(&plan).map(|warning| warning.to_string())
        };
        assert_eq!((said(0.1, 0.25, 0.35), said(0.25, 0.25, 0.35)), (None, None));
        let coarse = said(1.25, 0.25, 0.35).unwrap();
        assert!(coarse.contains("1.25 m apart, and a wheel is 0.25 m wide and 0.70 m long"), "{coarse}");
        assert!(coarse.contains("map_spacing_m 0.25 or less"), "{coarse}");
        // A wheel as wide as it is long: 0.4 m / sqrt 2 = 0.2828 m.
        assert_eq!(said(0.282, 0.4, 0.2), None);
        assert!(said(0.283, 0.4, 0.2).unwrap().contains("map_spacing_m 0.282 or less"));
    }

    #[test]
    fn a_rectangle_has_a_point_of_a_grid_up_to_the_largest_spacing_alone() {
        // The farthest that a place in a rectangle of these sides, turned by `turn`, can be moved without a point of the grid of
        // spacing 1 on it, by trial of its places: whether each of them has a point.
        let always_has_one = |[a, b]: [f64; 2], turn: f64| {
            let (sin, cos) = (libm::sin(turn), libm::cos(turn));
            let has_one = |x: f64, y: f64| {
                (-4..=4).flat_map(|i| (-4..=4).map(move |j| (f64::from(i) - x, f64::from(j) - y))).any(
                    |(i, j)| {
                        (cos * i + sin * j).abs() <= 0.5 * a + 1e-9
                            && (cos * j - sin * i).abs() <= 0.5 * b + 1e-9
                    },
                )
            };
            (0..40)
                .all(|i| (0..40).all(|j| has_one(f64::from(i) / 40.0 + 0.0125, f64::from(j) / 40.0 + 0.0125)))
        };
        let turns: Vec<f64> = (0..=45).map(|degrees| f64::from(degrees).to_radians()).collect();
        for sides in [[1.0, 1.415], [1.0, 3.0], [1.2, 1.415], [1.415, 1.415]] {
            assert!(largest_spacing(sides) >= 1.0);
            assert!(turns.iter().all(|&turn| always_has_one(sides, turn)), "{sides:?}");
        }
        // Narrower than a row, or too short at 45 degrees.
        for sides in [[0.94, 3.0], [1.0, 1.33], [1.2, 1.33]] {
            assert!(largest_spacing(sides) < 1.0);
            assert!(!turns.iter().all(|&turn| always_has_one(sides, turn)), "{sides:?}");
        }
    }

    #[test]
    fn a_start_steeper_than_the_vehicle_may_stand_is_told() {
        let plan = job(FLAT, SHORT).plan;
        let said = |pitch_down: f64, roll_right: f64| {
            let attitude = Attitude { heading: 0.7, pitch_down, roll_right };
            start_too_steep(&plan, &attitude.at(DVec3::ZERO)).map(|warning| warning.to_string())
        };
        // The limits are 0.35 / 1.2 along, 16.3 degrees, and 0.35 across, 19.3 degrees.
        assert_eq!((said(0.28, 0.0), said(0.0, -0.33)), (None, None));
        let along = said(-0.29, 0.0).unwrap();
        assert!(
            along.contains("16.6 degrees along its length and 0.0 across") && along.contains("16.3 and 19.3"),
            "{along}"
        );
        assert!(said(0.0, 0.96).unwrap().contains("0 degrees along its length and 55 across"));
    }

    #[test]
    fn a_ground_on_its_side_is_told_with_its_remedy() {
        // Level ground of 8 m: as it is, and as a file with y up that is read as one with z up.
        let corners = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)];
        let lying = corners.map(|(x, y)| DVec3::new(x, y, 0.0));
        let upright = corners.map(|(x, y)| DVec3::new(x, 0.0, -y));
        let faces = || vec![[0, 1, 2], [0, 2, 3]];
        let error =
            || SceneError::new("drive.route.start", "(0, 0)", "a place with ground under every wheel");
        let [lying, upright] = [lying, upright].map(|corners| crate::common::mesh(&corners, faces()));
        assert_eq!(with_hint(error(), &lying).to_string(), error().to_string());
        let told = with_hint(error(), &upright).to_string();
        assert!(
            told.contains("under every wheel (the terrain stands upright") && told.contains("terrain.up=y"),
            "{told}"
        );
        let other = SceneError::new("drive.grid.last", 1, "more");
        assert_eq!(with_hint(other.clone(), &upright), other);
    }

    #[test]
    fn the_steepest_place_of_a_way_is_told() {
        let plan = job(FLAT, SHORT).plan;
        let at = |x: f64, pitch_down: f64, roll_right: f64| {
            Attitude { heading: 0.0, pitch_down, roll_right }.at(DVec3::new(x, 2.0, 0.0))
        };
        // The start has a warning of its own; 0.28 and 0.33 are below the limits.
        assert_eq!(way_too_steep(&plan, &[at(0.0, 0.9, 0.0), at(1.0, 0.28, 0.0), at(2.0, 0.0, -0.33)]), None);
        let way = [at(0.0, 0.0, 0.0), at(1.0, 0.3, 0.0), at(2.0, -0.98, 0.0), at(3.0, 0.0, 0.36)];
        let said = way_too_steep(&plan, &way).unwrap().to_string();
        assert!(said.contains("in 3 of 4 frames, worst in frame 2 at 2.00, 2.00 m"), "{said}");
        assert!(
            said.contains("56 degrees along its length and 0 across") && said.contains("16 and 19"),
            "{said}"
        );
    }
}
