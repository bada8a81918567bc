//! All that defines the rover's algorithms, without the ground.

use raypencil_rover::{
    Detection, ExposureMode, KnownDrift, OnVehicle, PointLookup, Rule, StartRule, StripeLocation,
};
use raypencil_scene::Pose;
use serde_json::{Value, json};

use crate::job::DriveJob;
use crate::recording::poses::numbers;

/// Version of the recording's format.
const FORMAT_VERSION: u32 = 1;

/// `setup.json`. `start_elevation` is the global z of the vehicle's origin in the first frame, metres.
pub(super) fn setup_json(job: &DriveJob, start_elevation: f64) -> String {
    let plan = &job.plan;
    let camera = &plan.rig.camera.sensor;
    let beams: Vec<Value> = plan
        .rig
        .beams
        .iter()
        .map(|OnVehicle { vehicle_from_sensor, sensor }| {
            json!({
                "thickness": sensor.thickness,
                "grid_distance": sensor.grid_distance,
                "half_width": sensor.half_width,
                "max_range": sensor.max_range,
                "vehicle_from_sensor": pose(vehicle_from_sensor),
            })
        })
        .collect();
    let (detection, threshold) = match plan.extraction.detection {
        Detection::Fixed(level) => ("fixed", Some(level)),
        Detection::Share(share) => ("share", Some(share)),
        Detection::Otsu => ("otsu", None),
        Detection::Gradient(least) => ("gradient", Some(least)),
    };
    let place = match plan.extraction.place {
        StripeLocation::Pixel => "pixel",
        StripeLocation::SubPixel => "sub_pixel",
        StripeLocation::Centroid => "centroid",
    };
    let exposures = match plan.exposures {
        ExposureMode::InTurn => "in_turn",
        ExposureMode::Together => "together",
    };
    let lookup = match plan.lookup {
        PointLookup::Computed => "computed",
        PointLookup::Table => "table",
    };
    let start = match plan.map_rules.start {
        StartRule::Origin => "origin",
        StartRule::Footprint => "footprint",
        StartRule::Circle => "circle",
    };
    let rule = |rule: Rule| match rule {
        Rule::Paper => "paper",
        Rule::Mended => "mended",
    };
    let (vehicle, rules, tests) = (&plan.vehicle, &plan.map_rules, &plan.rules);
    let scan = plan.scans.map(|scans| {
        json!({
            "from": plan.sweep.from,
            "to": plan.sweep.to,
            "steps": plan.sweep.steps,
            "camera": plan.sweep.camera,
            "step_time": plan.sweep.step_time,
            "clear_map": scans.clear_map,
        })
    });
    let drift = KnownDrift::of(&plan.errors, plan.route.frame_rate);
    let setup = json!({
        "format_version": FORMAT_VERSION,
        "frame_rate": plan.route.frame_rate,
        "camera": {
            "width": camera.width,
            "height": camera.height,
            "pixel_pitch": camera.pixel_pitch,
            "focal_length": camera.focal_length,
            "principal_point": camera.principal_point,
            "max_range": camera.max_range,
            "vehicle_from_sensor": pose(&plan.rig.camera.vehicle_from_sensor),
        },
        "beams": beams,
        "images": { "unit": if job.is_flux_only() { "W/m" } else { "DN" } },
        "extraction": {
            "detection": detection,
            "threshold": threshold,
            "place": place,
            "least_rows": plan.extraction.least_rows,
            "exposures": exposures,
            "lookup": lookup,
        },
        "vehicle": {
            "wheelbase": vehicle.wheelbase,
            "track": vehicle.track,
            "wheel_radius": vehicle.wheel_radius,
            "wheel_width": vehicle.wheel_width,
            "clearance": vehicle.clearance,
        },
        "known_noise": {
            "attitude": plan.errors.attitude_noise,
            "proximity": plan.errors.proximity_noise,
            "position_drift": drift.position,
            "position_walk": drift.walk,
            "heading_drift": drift.heading,
            "fixes": drift.fixes.map(|fixes| json!({ "every_frames": fixes.every_frames, "noise": fixes.noise })),
        },
        "map": { "spacing": plan.map.spacing, "points": plan.map.points },
        "rules": {
            "start": start,
            "elevation": rule(rules.elevation),
            "extrapolate": rule(rules.extrapolate),
            "several": rule(rules.several),
            "inconsistency": rule(rules.inconsistency),
            "gap": rule(if tests.gaps.is_some() { Rule::Mended } else { Rule::Paper }),
            "tests": rule(tests.tests),
        },
        "tests": {
            "slopes": {
                "front": tests.slopes.front,
                "rear": tests.slopes.rear,
                "length": tests.slopes.length,
                "closer": tests.slopes.closer,
            },
            "closer_share": tests.closer_share,
            "obstacle_margin": tests.margins.obstacle,
            "clear_margin": tests.margins.clear,
            "rear_needed": tests.rear_needed,
            "max_gap_width": tests.gaps.map(|gaps| gaps.max_width),
        },
        "grid": {
            "sectors": plan.grid.sectors,
            "half_angle": plan.grid.half_angle,
            "first": plan.grid.first,
            "step": plan.grid.step,
            "last": plan.grid.last,
        },
        "vectors": { "large": plan.vectors.large, "small": plan.vectors.small },
        "obstacles_every": plan.obstacles_every,
        "scan": scan,
        "start_elevation": start_elevation,
    });
    format!("{setup:#}\n")
}

fn pose(pose: &Pose) -> Value {
    let [x, y, z, qx, qy, qz, qw] = numbers(pose);
    json!({ "position": [x, y, z], "quaternion": [qx, qy, qz, qw] })
}
