//! The part of the drive's page that answers when asked: the way, the map as it grew, and every sector with its reason.

use raypencil_explorer::{Change, ExplorerPage};
use raypencil_rover::{Missing, MissingReason, SectorEnd, TraversabilityTest, Vehicle, VehiclePart};
use raypencil_scene::{Pose, Scene};
use serde_json::{Value, json};

use crate::job::DriveJob;
use crate::labels::label_word;
use crate::run::DriveRun;
use crate::sector_truth::JudgedSector;
use crate::true_rules::rule_words;

/// The elements of the page that the explorer needs, with all that it shows.
pub(crate) fn explorer(job: &DriveJob, run: &DriveRun) -> String {
    let scene = &run.scene_at_start;
    let mut page = ExplorerPage::new("drive", scene, &job.name, "");
    let start = run.history.frames.first().map(|frame| frame.stance);
    if let Some(start) = start {
        page.set_vehicle(&in_scene(scene, &start));
    }
    for sensor in scene.sensors() {
        page.add_sensor(sensor, &[], &[], None);
    }
    let model = drive_model(&mut page, scene, job, run);
    page.insert("drive", model);
    page.html()
}

/// A global pose in the scene frame.
fn in_scene(scene: &Scene, pose: &Pose) -> Pose {
    Pose { position: pose.position - scene.mesh().origin(), ..*pose }
}

fn drive_model(page: &mut ExplorerPage<'_>, scene: &Scene, job: &DriveJob, run: &DriveRun) -> Value {
    let history = &run.history;
    let origin = scene.mesh().origin();
    let numbers = |pose: &Pose| {
        let Pose { position, rotation } = in_scene(scene, pose);
        [position.x, position.y, position.z, rotation.x, rotation.y, rotation.z, rotation.w]
            .map(|number| number as f32)
    };
    let frames: Vec<u32> = history.frames.iter().map(|frame| frame.index as u32).collect();
    let stances: Vec<f32> = history.frames.iter().flat_map(|frame| numbers(&frame.stance)).collect();
    let believed: Vec<f32> = history.frames.iter().flat_map(|frame| numbers(&frame.believed)).collect();
    let mut first: Vec<u32> = history.frames.iter().map(|frame| frame.first_change as u32).collect();
    first.push(history.changes.len() as u32);
    let change =
        |of: fn(&crate::history::CellChange) -> i32| history.changes.iter().map(of).collect::<Vec<i32>>();
    let (i, j) = (change(|change| change.point.i as i32), change(|change| change.point.j as i32));
    // Elevations of the scene frame, as all other points of the page.
    let elevation: Vec<f32> =
        history.changes.iter().map(|change| (f64::from(change.elevation) - origin.z) as f32).collect();
    let source: Vec<u8> = history.changes.iter().map(|change| change.source).collect();
    let obstacles: Vec<Value> = history
        .frames
        .iter()
        .enumerate()
        .filter_map(|(index, frame)| {
            let (centre, sectors) = frame.obstacles.as_ref()?;
            let centre = [centre.x - origin.x, centre.y - origin.y];
            let sectors: Vec<Value> =
                sectors.iter().map(|(end, judged)| sector(end, *judged, scene)).collect();
            Some(json!({ "frame": index, "centre": centre, "sectors": sectors }))
        })
        .collect();
    let obstacles = json!(obstacles).to_string();
    let waypoints: Vec<[f64; 2]> = std::iter::once(&job.plan.route.start)
        .chain(&job.plan.route.waypoints)
        .map(|place| [place.x - origin.x, place.y - origin.y])
        .collect();
    let scans: Vec<usize> = history
        .frames
        .iter()
        .enumerate()
        .filter(|(_, frame)| frame.has_scan)
        .map(|(index, _)| index)
        .collect();
    let Vehicle { wheelbase, track, wheel_radius, wheel_width, clearance, .. } = job.plan.vehicle;
    let arrays = page.arrays();
    json!({
        "vehicle": {
            "wheelbase": wheelbase, "track": track, "wheel_radius": wheel_radius, "wheel_width": wheel_width,
            "clearance": clearance,
        },
        "scans": scans,
        "frame_rate": job.plan.route.frame_rate,
        "frames": arrays.u32(&frames, Change::Delta).reference,
        "stance": arrays.f32(&stances, Change::None).reference,
        "believed": arrays.f32(&believed, Change::None).reference,
        "map": {
            "origin": [history.origin.x - origin.x, history.origin.y - origin.y],
            "spacing": history.spacing,
            "is_cut": history.is_cut,
            "first": arrays.u32(&first, Change::Delta).reference,
            "i": arrays.i32(&i, Change::Delta).reference,
            "j": arrays.i32(&j, Change::Delta).reference,
            "elevation": arrays.f32(&elevation, Change::None).reference,
            "source": arrays.u8(&source),
        },
        "obstacles": arrays.u8(obstacles.as_bytes()),
        "waypoints": waypoints,
    })
}

/// A sector's end: direction (radians), radius (metres), point, label, and the reason in words, with what is true.
fn sector(end: &SectorEnd, judged: Option<JudgedSector>, scene: &Scene) -> Value {
    let origin = scene.mesh().origin();
    let point = [end.point.x - origin.x, end.point.y - origin.y];
    let missing = end.missing.map(|missing| [missing.place.x - origin.x, missing.place.y - origin.y]);
    json!({
        "direction": end.direction, "radius": end.radius, "point": point,
        "label": label_word(end.label), "reason": reason(end) + &truth(judged), "missing": missing,
    })
}

/// What truly stops the vehicle, as a sentence that follows another; empty if nothing does.
fn truth(judged: Option<JudgedSector>) -> String {
    let Some(JudgedSector { true_radius: Some(radius), true_rule: Some(rule), .. }) = judged else {
        return String::new();
    };
    format!(" In truth the vehicle cannot stand {radius:.2} m ahead: {}.", rule_words(rule))
}

/// Why testing stopped, as a sentence.
fn reason(end: &SectorEnd) -> String {
    if let Some(test) = end.failed {
        let words = match test {
            TraversabilityTest::Front => {
                "The front wheels would stand too aslant, one higher than the other."
            }
            TraversabilityTest::Rear => "The rear wheels would stand too aslant, one higher than the other.",
            TraversabilityTest::Length => {
                "The vehicle would stand too steep from its front to its rear wheels."
            }
            TraversabilityTest::Closer => {
                "The ground between the front wheels and the vehicle's middle is too steep; the rear wheels would stand on \
                 unknown ground."
            }
            TraversabilityTest::Belly => "The ground would touch the belly.",
        };
        return words.into();
    }
    let Some(Missing { part, place, reason }) = end.missing else {
        return "Nothing stops the vehicle up to the end of the grid.".into();
    };
    let part = match part {
        VehiclePart::FrontWheel => "a front wheel",
        VehiclePart::RearWheel => "a rear wheel",
        VehiclePart::CentreLine => "the centre line",
        VehiclePart::Belly => "the belly",
    };
    let place = format!("({:.2}, {:.2}) m", place.x, place.y);
    match reason {
        MissingReason::NotMeasured => format!("The ground under {part} at {place} was never measured."),
        MissingReason::BeyondMap => format!("The map ends before the ground under {part} at {place}."),
        MissingReason::NearLimit => {
            "A slope of the vehicle would be too near its limit: the errors of the points decide.".into()
        }
        MissingReason::MayHide => {
            format!("In the shadow under {part} at {place} something may hide that the vehicle cannot pass.")
        }
    }
}
