//! Fingerprint of a drive: three small ones, by the mended rules without noise and with it, and by the printed rules.

use raypencil::Silent;
use raypencil::drive::{DriveJob, DriveRun, Missed, NotFound, SectorTruth, drive};
use raypencil::harness::contender;
use raypencil::io::load_text;
use raypencil::rover::{
    DrivePlan, ElevationMap, ElevationSource, ErrorMargins, LocalisationErrors, MapRules, MapSize,
    MapWithShadows, MissingReason, RadialGrid, ScanRule, SlopeLimits, Sweep, Traversability,
    TraversabilityRules, TrueLimits, Vehicle,
};

use super::Fingerprint;

/// Stones and slopes under noisy sensors, with a scan: what decides between clear, unknown and an obstacle is all in it.
const NOISY: &str = "version = 1
    vehicle = { position_m = [-4, 0] }
    camera = { width_px = 128, height_px = 128, pixel_pitch_um = 72 }
    beam = [{ columns = 128, rows = 2 }, { columns = 128, rows = 2 }]
    terrain = { generate = { preset = 'worst', seed = 4, extent_m = 18, post_spacing_m = 0.25, rock_smallest_m = 0.3 } }
    [drive]
    waypoints_m = [[3, 0]]
    frames_per_s = 1
    obstacles_every_frames = 5
    scan_steps = 21
    sensor = 'cmos'
    optics = { oversampling = 1 }
    attitude_noise_deg = 0.05
    position_drift_m_per_s = [0.001, 0.0005]
    rules = { start = 'circle' }";

/// The paper's own ground, with perfect sensors.
const PERFECT: &str = "version = 1
    vehicle = { position_m = [-0.6, 0] }
    camera = { width_px = 96, height_px = 96, pixel_pitch_um = 96 }
    beam = [{ rows = 2 }, { rows = 2 }]
    terrain = { builtin = 'pyramids' }
    drive = { waypoints_m = [[3, 0]], frames_per_s = 2, scans = false }";

/// Fingerprint of the rover's rules, and of what they are held to.
pub(super) fn fingerprint() -> String {
    let renderer = contender("scanline").expect("its own renderer").renderer;
    let mut digest = Fingerprint::default();
    let job = |text: &str| {
        let loaded = load_text(text, "small").expect("a scene");
        DriveJob::new(&loaded, None, "small.toml".into()).expect("a drive")
    };
    let printed = job(PERFECT);
    let printed = DriveJob { plan: printed.plan.clone().as_printed(), ..printed };
    for job in [job(NOISY), job(PERFECT), printed] {
        add_plan(&mut digest, &job.plan);
        let run = drive(&job, &[renderer.as_ref()], &Silent).expect("a drive");
        add_run(&mut digest, &job.plan, &run);
    }
    digest.letters()
}

/// The settings that a plan has if nobody gives another. A new one does not compile until it stands here.
fn add_plan(digest: &mut Fingerprint, plan: &DrivePlan) {
    let Vehicle { wheelbase, track, wheel_radius, wheel_width, clearance, rim_points } = plan.vehicle;
    let SlopeLimits { front, rear, length, closer } = plan.rules.slopes;
    let TraversabilityRules { closer_share, rear_needed, gaps, margins, .. } = plan.rules;
    let ErrorMargins { obstacle, clear } = margins;
    let RadialGrid { sectors, half_angle, first, step, last } = plan.grid;
    let MapSize { spacing, points } = plan.map;
    // A scan takes no time by default, which changes nothing that is found.
    let Sweep { from, to, steps, camera, step_time: _ } = plan.sweep;
    let LocalisationErrors { position_walk, heading_drift, attitude_noise, proximity_noise, .. } =
        plan.errors;
    let MapRules { start, elevation, extrapolate, several, inconsistency, settle } = plan.map_rules;
    digest.numbers([wheelbase, track, wheel_radius, wheel_width, clearance, f64::from(rim_points)]);
    // By default the vehicle has no limit that its rover has not, which changes nothing that is found.
    if plan.truth != TrueLimits::default() {
        let TrueLimits { front, rear, length, clearance, step, centre_of_mass } = plan.truth;
        digest.numbers([front, rear, length, clearance, step].map(|limit| limit.unwrap_or(-1.0)));
        digest.point(centre_of_mass.unwrap_or_default());
    }
    digest.numbers([front, rear, length, closer, closer_share, gaps.map_or(-1.0, |gaps| gaps.max_width)]);
    digest.numbers([
        obstacle,
        clear,
        f64::from(sectors),
        half_angle,
        first,
        step,
        last,
        spacing,
        f64::from(points),
    ]);
    digest.numbers([
        from,
        to,
        f64::from(steps),
        position_walk,
        heading_drift,
        attitude_noise,
        proximity_noise,
    ]);
    digest.counts([rear_needed, camera].map(u64::from));
    let rules = [elevation, extrapolate, several, inconsistency, settle].map(|rule| rule as u64);
    digest.counts(rules.into_iter().chain([start as u64, plan.rules.tests as u64, plan.obstacles_every]));
    if let Some(ScanRule { at_start, every, inconsistency, least_points, clear_map }) = plan.scans {
        digest.counts([u64::from(at_start), u64::from(least_points), u64::from(clear_map)]);
        digest.numbers([every, inconsistency].map(|limit| limit.unwrap_or(-1.0)));
    }
}

/// What a drive found, and what is true of it.
fn add_run(digest: &mut Fingerprint, plan: &DrivePlan, run: &DriveRun) {
    digest.counts([run.frames.len() as u64, run.edge_points]);
    for point in &run.points {
        digest.point(point.point);
    }
    add_map(digest, &run.map);
    let (rules, vehicle) = (&plan.rules, &plan.vehicle);
    let shadows = MapWithShadows::of(&run.map);
    for frame in &run.frames {
        digest.point(frame.believed.position);
        digest.point(frame.stance.position);
    }
    // The last map seen from each place that a map was made at: more ground under the imaginary vehicle than one place has.
    for frame in run.frames.iter().filter(|frame| frame.index % plan.obstacles_every == 0) {
        for sector in 0..plan.grid.sectors {
            for (_, class) in plan.grid.classify_sector(sector, &shadows, vehicle, rules, &frame.believed) {
                digest.counts([number(&class)]);
            }
        }
    }
    if let Some((_, map, vectors)) = &run.obstacles {
        for end in &map.sectors {
            digest.numbers([end.radius]);
            digest.counts([end.label as u64]);
        }
        digest.counts(vectors.iter().map(|vector| vector.label as u64));
    }
    add_truth(digest, &run.truth);
    add_truth(digest, &run.upper_bound);
}

fn add_map(digest: &mut Fingerprint, map: &ElevationMap) {
    for point in map.points() {
        let source = map.source(point);
        if source == ElevationSource::Unknown {
            continue;
        }
        digest.counts([point.i as u64, point.j as u64, source as u64]);
        if let Some(sample) = map.sample(point) {
            digest.point(sample);
        }
        if let Some(estimate) = map.estimate(point) {
            digest.numbers([estimate.elevation, estimate.standard_error.unwrap_or(-1.0)]);
        }
    }
}

/// A class as a number.
fn number(class: &Traversability) -> u64 {
    match class {
        Traversability::Clear => 0,
        Traversability::Obstacle(test) => 100 + *test as u64,
        Traversability::Unknown(missing) => {
            200 + match missing.reason {
                MissingReason::NotMeasured => 0,
                MissingReason::BeyondMap => 1,
                MissingReason::MayHide => 2,
                MissingReason::NearLimit => 3,
            }
        }
    }
}

fn add_truth(digest: &mut Fingerprint, truth: &SectorTruth) {
    let SectorTruth {
        maps,
        sectors,
        with_obstacle,
        found,
        missed,
        not_found,
        false_obstacle,
        false_before,
        ..
    } = *truth;
    let SectorTruth {
        unknown_not_measured, unknown_may_hide, unknown_near_limit, unknown_beyond_map, ..
    } = *truth;
    let SectorTruth { clear, off_ground, clear_mm, .. } = *truth;
    let Missed { by_errors, by_spacing, by_rule } = missed;
    let NotFound { hidden, in_part, not_swept, outside } = not_found;
    digest.counts([maps, sectors, with_obstacle, found, by_errors, by_spacing, by_rule]);
    digest.counts([hidden, not_swept + in_part, outside, false_obstacle, false_before]);
    digest.counts([unknown_not_measured, unknown_may_hide, unknown_near_limit, unknown_beyond_map]);
    digest.counts([clear, off_ground, clear_mm]);
}
