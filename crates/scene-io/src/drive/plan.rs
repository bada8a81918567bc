//! The rover's plan of a drive: its own defaults, but for what the scene file says.

use glam::DVec2;

use crate::drive::settings::{DetectionWord, DriveSettings, PlaceWord, SensorWord};
use raypencil_rover::{
    Attitude, Detection, DrivePlan, ExposureMode, Extraction, LocalisationErrors, MapSize, PositionFixes,
    RadialGrid, Rig, Route, ScanRule, SlopeLimits, StripeLocation, Sweep, TraversabilityRules, VectorRules,
    Vehicle,
};
use raypencil_sensor::preset;

/// The level that tells light from dark where the file names none, digital numbers.
///
/// CHOICE: about a fiftieth of a stripe of the default rig (24,000, 84 and 1620 DN, docs/theory/sensor.md) above the bias, so that
/// a stripe 10 m away still passes; several times what noise reaches.
pub fn threshold(sensor: SensorWord) -> f64 {
    match sensor {
        SensorWord::Ideal => 400.0,
        SensorWord::Ccd1989 => 4.0,
        SensorWord::Cmos => 100.0,
    }
}

/// The rover's plan: its own defaults, but for what the file says.
pub fn plan(settings: &DriveSettings, rig: Rig, start: DVec2, heading: f64, sensor: SensorWord) -> DrivePlan {
    let usual = Vehicle::default();
    let vehicle = Vehicle {
        wheelbase: settings.wheelbase.unwrap_or(usual.wheelbase),
        track: settings.track.unwrap_or(usual.track),
        wheel_radius: settings.wheel_radius.unwrap_or(usual.wheel_radius),
        wheel_width: settings.wheel_width.unwrap_or(usual.wheel_width),
        clearance: settings.clearance.unwrap_or(usual.clearance),
        ..usual
    };
    let waypoints = settings.waypoints.iter().map(|&waypoint| DVec2::from_array(waypoint)).collect();
    let mut route = Route { heading, ..Route::through(start, waypoints) };
    route.speed = settings.speed.unwrap_or(route.speed);
    route.turn_rate = settings.turn_rate.unwrap_or(route.turn_rate);
    route.frame_rate = settings.frame_rate.unwrap_or(route.frame_rate);

    let level = settings.threshold.unwrap_or_else(|| {
        // An unlit image takes the bias along.
        let bias = preset(sensor.word()).map_or(0.0, |(_, sensor)| sensor.bias);
        threshold(sensor) - if settings.subtract_unlit == Some(true) { bias } else { 0.0 }
    });
    let mut extraction = Extraction::thresholding(level);
    extraction.detection = match settings.detection.unwrap_or(DetectionWord::Fixed) {
        DetectionWord::Fixed => Detection::Fixed(level),
        DetectionWord::Otsu => Detection::Otsu,
        DetectionWord::Gradient => Detection::Gradient(level),
    };
    extraction.place = match settings.place.unwrap_or(PlaceWord::Pixel) {
        PlaceWord::Pixel => StripeLocation::Pixel,
        PlaceWord::SubPixel => StripeLocation::SubPixel,
        PlaceWord::Centroid => StripeLocation::Centroid,
    };
    extraction.least_rows = settings.least_rows.unwrap_or(extraction.least_rows);

    let mut plan = DrivePlan::new(rig, route, extraction);
    let rules = TraversabilityRules::for_vehicle(&vehicle);
    plan.rules = if settings.cross_gaps == Some(true) { rules.crossing_gaps(&vehicle) } else { rules };
    let ([front, rear, length, closer], usual) = (settings.slopes, plan.rules.slopes);
    plan.rules.slopes = SlopeLimits {
        front: front.unwrap_or(usual.front),
        rear: rear.unwrap_or(usual.rear),
        length: length.unwrap_or(usual.length),
        closer: closer.unwrap_or(usual.closer),
    };
    let ([first, last, step], usual) = (settings.grid_radii, RadialGrid::for_vehicle(&vehicle));
    plan.grid = RadialGrid {
        sectors: settings.grid_sectors.unwrap_or(usual.sectors),
        half_angle: settings.grid_half_angle.unwrap_or(usual.half_angle),
        first: first.unwrap_or(usual.first),
        step: step.unwrap_or(usual.step),
        last: last.unwrap_or(usual.last),
    };
    let usual = VectorRules::for_vehicle(&vehicle);
    plan.vectors = VectorRules {
        large: settings.vector_large.unwrap_or(usual.large),
        small: settings.vector_small.unwrap_or(usual.small),
    };
    plan.vehicle = vehicle;
    plan.seed = settings.seed.unwrap_or(plan.seed);
    if settings.lit_together == Some(true) {
        plan.exposures = ExposureMode::Together;
    }
    plan.map = MapSize {
        spacing: settings.map_spacing.unwrap_or(plan.map.spacing),
        points: settings.map_points.unwrap_or(plan.map.points),
    };
    plan.obstacles_every = settings.obstacles_every.unwrap_or(plan.obstacles_every);
    plan.scans = match settings.scans {
        Some(false) => None,
        _ => {
            let rule = ScanRule::default();
            Some(ScanRule {
                every: settings.scan_every.or(rule.every),
                inconsistency: settings.scan_inconsistency.or(rule.inconsistency),
                least_points: settings.scan_least_points.unwrap_or(rule.least_points),
                ..rule
            })
        }
    };
    let ([from, to], usual) = (settings.scan_angles, plan.sweep);
    plan.sweep = Sweep {
        from: from.unwrap_or(usual.from),
        to: to.unwrap_or(usual.to),
        steps: settings.scan_steps.unwrap_or(usual.steps),
        ..usual
    };
    let [heading, pitch_down, roll_right] = settings.attitude_bias.map(|bias| bias.unwrap_or(0.0));
    plan.errors = LocalisationErrors {
        position_drift: settings.position_drift.map_or(DVec2::ZERO, DVec2::from_array),
        position_walk: settings.position_walk.unwrap_or(0.0),
        attitude_bias: Attitude { heading, pitch_down, roll_right },
        heading_drift: settings.heading_drift.unwrap_or(0.0),
        attitude_noise: settings.attitude_noise.unwrap_or(0.0),
        proximity_noise: settings.proximity_noise.unwrap_or(0.0),
        fixes: settings
            .fix_every
            .map(|every_frames| PositionFixes { every_frames, noise: settings.fix_noise.unwrap_or(0.0) }),
    };
    plan
}
