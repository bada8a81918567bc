//! Each limit of a setting from both sides: what is exactly at it is taken, and the next number beyond it is refused by name.

use std::f64::consts::PI;

use glam::DVec2;
use raypencil_rover::{
    Attitude, Detection, ErrorMargins, ExposureTimes, Extraction, GapRule, LocalisationErrors,
    MAX_BLUR_SAMPLES, MapSize, PositionFixes, RadialGrid, Route, ScanRule, SlopeLimits, Sweep,
    TraversabilityRules, TrueLimits, VectorRules, Vehicle,
};
use raypencil_scene::SceneError;

/// The number at each end is taken; the next one beyond is refused, and the message begins with the field's path.
#[track_caller]
fn holds(path: &str, [low, high]: [f64; 2], validated: impl Fn(f64) -> Result<(), SceneError>) {
    for (limit, beyond) in [(low, low.next_down()), (high, high.next_up())] {
        assert!(validated(limit).is_ok(), "{path} = {limit}: {:?}", validated(limit));
        let refused = validated(beyond).expect_err(path).to_string();
        assert!(refused.starts_with(&format!("{path} is ")), "{beyond}: {refused}");
    }
    assert!(validated(f64::NAN).is_err(), "{path} = NaN");
}

/// The same for whole numbers.
#[track_caller]
fn counts(path: &str, [low, high]: [u32; 2], validated: impl Fn(u32) -> Result<(), SceneError>) {
    for (limit, beyond) in [(low, low - 1), (high, high + 1)] {
        assert!(validated(limit).is_ok(), "{path} = {limit}: {:?}", validated(limit));
        let refused = validated(beyond).expect_err(path).to_string();
        assert!(refused.starts_with(&format!("{path} is ")), "{beyond}: {refused}");
    }
}

#[test]
fn of_a_vehicle() {
    // Large enough for each number alone.
    let large = Vehicle { wheelbase: 100.0, track: 100.0, ..Vehicle::default() };
    let is = |vehicle: Vehicle| vehicle.validate("vehicle");
    // The smallest wheels need a wheelbase of 2 cm.
    let wheelbase = |wheelbase: f64| is(Vehicle { wheelbase, wheel_radius: 0.01, ..large }).is_ok();
    assert!(wheelbase(0.02) && !wheelbase(0.02_f64.next_down()));
    assert!(wheelbase(100.0) && !wheelbase(100.0_f64.next_up()));
    holds("vehicle.track", [0.01, 100.0], |track| is(Vehicle { track, wheel_width: 0.01, ..large }));
    holds("vehicle.wheel_radius", [0.01, 50.0], |wheel_radius| is(Vehicle { wheel_radius, ..large }));
    holds("vehicle.wheel_width", [0.01, 100.0], |wheel_width| is(Vehicle { wheel_width, ..large }));
    holds("vehicle.clearance", [0.01, 100.0], |clearance| is(Vehicle { clearance, ..large }));
    // Wheels fit between the axles, and beside one another.
    let small = Vehicle { wheelbase: 2.0, track: 0.5, ..Vehicle::default() };
    holds("vehicle.wheel_radius", [0.01, 1.0], |wheel_radius| is(Vehicle { wheel_radius, ..small }));
    holds("vehicle.wheel_width", [0.01, 0.5], |wheel_width| is(Vehicle { wheel_width, ..small }));
    counts("vehicle.rim_points", [1, 1001], |rim_points| is(Vehicle { rim_points, ..small }));
}

#[test]
fn of_what_a_vehicle_can_truly_do() {
    let vehicle = Vehicle { wheelbase: 3.0, track: 2.0, ..Vehicle::default() };
    let is = |limits: TrueLimits| limits.validate("truth", &vehicle);
    let none = TrueLimits::default();
    assert!(is(none).is_ok());
    holds("truth.front", [0.0, 1e3], |front| is(TrueLimits { front: Some(front), ..none }));
    holds("truth.rear", [0.0, 1e3], |rear| is(TrueLimits { rear: Some(rear), ..none }));
    holds("truth.length", [0.0, 1e3], |length| is(TrueLimits { length: Some(length), ..none }));
    holds("truth.clearance", [1e-2, 1e2], |height| is(TrueLimits { clearance: Some(height), ..none }));
    holds("truth.step", [1e-3, 1e2], |step| is(TrueLimits { step: Some(step), ..none }));
    // Half the wheelbase along, half the track across.
    for (axis, most) in [("x", 1.5), ("y", 1.0), ("z", 100.0)] {
        holds(&format!("truth.centre_of_mass.{axis}"), [-most, most], |place| {
            let mut mass = glam::DVec3::ZERO;
            match axis {
                "x" => mass.x = place,
                "y" => mass.y = place,
                _ => mass.z = place,
            }
            is(TrueLimits { centre_of_mass: Some(mass), ..none })
        });
    }
}

#[test]
fn of_the_rules_of_traversability() {
    let rules = TraversabilityRules::as_printed(&Vehicle::default());
    let is = |rules: TraversabilityRules| rules.validate("rules");
    let slopes = |change: &dyn Fn(&mut SlopeLimits)| {
        let mut slopes = rules.slopes;
        change(&mut slopes);
        is(TraversabilityRules { slopes, ..rules })
    };
    holds("rules.slopes.front", [0.0, 1e3], |slope| slopes(&|all| all.front = slope));
    holds("rules.slopes.rear", [0.0, 1e3], |slope| slopes(&|all| all.rear = slope));
    holds("rules.slopes.length", [0.0, 1e3], |slope| slopes(&|all| all.length = slope));
    holds("rules.slopes.closer", [0.0, 1e3], |slope| slopes(&|all| all.closer = slope));
    holds("rules.closer_share", [1e-3, 1.0], |closer_share| {
        is(TraversabilityRules { closer_share, ..rules })
    });
    holds("rules.margins.obstacle", [0.0, 1e2], |obstacle| {
        is(TraversabilityRules { margins: ErrorMargins { obstacle, ..rules.margins }, ..rules })
    });
    holds("rules.margins.clear", [0.0, 1e2], |clear| {
        is(TraversabilityRules { margins: ErrorMargins { clear, ..rules.margins }, ..rules })
    });
    holds("rules.gaps.max_width", [0.0, 1e2], |max_width| {
        is(TraversabilityRules { gaps: Some(GapRule { max_width }), ..rules })
    });
}

#[test]
fn of_maps() {
    let grid = RadialGrid { sectors: 1, half_angle: 0.5, first: 1.0, step: 1.0, last: 2.0 };
    let is = |grid: RadialGrid| grid.validate("grid");
    counts("grid.sectors", [1, 100_000], |sectors| is(RadialGrid { sectors, ..grid }));
    holds("grid.half_angle", [0.0, PI], |half_angle| is(RadialGrid { half_angle, ..grid }));
    // With more than one sector none of the two ends.
    let several = RadialGrid { sectors: 2, ..grid };
    let between = [f64::from_bits(1), PI.next_down()];
    holds("grid.half_angle", between, |half_angle| is(RadialGrid { half_angle, ..several }));
    holds("grid.first", [0.0, 1e3], |first| is(RadialGrid { first, last: 1e3, ..grid }));
    holds("grid.step", [1e-3, 1e3], |step| is(RadialGrid { step, ..grid }));
    holds("grid.last", [1.0, 1e3], |last| is(RadialGrid { last, ..grid }));

    let size = |size: MapSize| size.validate("map");
    holds("map.spacing", [1e-4, 1e3], |spacing| size(MapSize { spacing, ..MapSize::default() }));
    for (points, is_taken) in [(1, false), (2, false), (3, true), (4, false), (4095, true), (4097, false)] {
        assert_eq!(size(MapSize { points, ..MapSize::default() }).is_ok(), is_taken, "{points}");
    }

    let vectors = |large: f64, small: f64| VectorRules { large, small }.validate("vectors");
    holds("vectors.large", [0.25, 1e3], |large| vectors(large, 0.25));
    holds("vectors.small", [0.0, 1e3], |small| vectors(1e3, small));
}

#[test]
fn of_what_the_vehicle_knows_of_its_place() {
    let none = LocalisationErrors::default();
    let is = |errors: LocalisationErrors| errors.validate("errors");
    for axis in [0, 1] {
        let name = format!("errors.position_drift.{}", ["x", "y"][axis]);
        holds(&name, [-1e3, 1e3], |drift| {
            let mut position_drift = DVec2::ZERO;
            position_drift[axis] = drift;
            is(LocalisationErrors { position_drift, ..none })
        });
    }
    let bias = |change: &dyn Fn(&mut Attitude)| {
        let mut errors = none;
        change(&mut errors.attitude_bias);
        is(errors)
    };
    holds("errors.attitude_bias.heading", [-10.0, 10.0], |angle| bias(&|of| of.heading = angle));
    holds("errors.attitude_bias.pitch_down", [-10.0, 10.0], |angle| bias(&|of| of.pitch_down = angle));
    holds("errors.attitude_bias.roll_right", [-10.0, 10.0], |angle| bias(&|of| of.roll_right = angle));
    holds("errors.heading_drift", [-10.0, 10.0], |heading_drift| {
        is(LocalisationErrors { heading_drift, ..none })
    });
    holds("errors.position_walk", [0.0, 1e3], |position_walk| {
        is(LocalisationErrors { position_walk, ..none })
    });
    holds("errors.attitude_noise", [0.0, 10.0], |attitude_noise| {
        is(LocalisationErrors { attitude_noise, ..none })
    });
    holds("errors.proximity_noise", [0.0, 1e2], |proximity_noise| {
        is(LocalisationErrors { proximity_noise, ..none })
    });
    let fixes = |every_frames: u64, noise: f64| {
        is(LocalisationErrors { fixes: Some(PositionFixes { every_frames, noise }), ..none })
    };
    holds("errors.fixes.noise", [0.0, 1e3], |noise| fixes(1, noise));
    assert!(fixes(0, 0.0).is_err() && fixes(1, 0.0).is_ok() && fixes(u64::MAX, 0.0).is_ok());
}

#[test]
fn of_a_drive_and_its_scans() {
    let route = Route {
        start: DVec2::ZERO,
        heading: 0.0,
        waypoints: vec![DVec2::X, DVec2::Y],
        speed: 1.0,
        turn_rate: 1.0,
        frame_rate: 1.0,
    };
    let with = |change: &dyn Fn(&mut Route)| {
        let mut other = route.clone();
        change(&mut other);
        other.validate("route")
    };
    holds("route.heading", [-1e3, 1e3], |heading| with(&|route| route.heading = heading));
    holds("route.speed", [1e-4, 1e2], |speed| with(&|route| route.speed = speed));
    holds("route.turn_rate", [1e-4, 1e2], |rate| with(&|route| route.turn_rate = rate));
    holds("route.frame_rate", [1e-3, 1e4], |rate| with(&|route| route.frame_rate = rate));
    for axis in [0, 1] {
        holds("route.start", [-1e12, 1e12], |place| with(&|route| route.start[axis] = place));
        holds("route.waypoints[1]", [-1e12, 1e12], |place| with(&|route| route.waypoints[1][axis] = place));
    }
    let twice = with(&|route| route.waypoints[1] = DVec2::X).expect_err("one place twice").to_string();
    assert!(twice.starts_with("route.waypoints[1] is ") && twice.contains("another place"), "{twice}");

    let sweep = Sweep::default();
    let is = |sweep: Sweep| sweep.validate("sweep");
    holds("sweep.step_time", [0.0, 1e4], |step_time| is(Sweep { step_time, ..sweep }));
    holds("sweep.from", [-3.2, 3.2], |from| is(Sweep { from, ..sweep }));
    holds("sweep.to", [-3.2, 3.2], |to| is(Sweep { to, ..sweep }));
    counts("sweep.steps", [1, 100_000], |steps| is(Sweep { steps, ..sweep }));
    let rule = |rule: ScanRule| rule.validate("scans");
    holds("scans.every", [1e-3, 1e9], |every| rule(ScanRule { every: Some(every), ..ScanRule::default() }));
    holds("scans.inconsistency", [0.0, 1e3], |by| {
        rule(ScanRule { inconsistency: Some(by), ..ScanRule::default() })
    });
}

#[test]
fn of_stripes_and_exposures() {
    let of =
        |detection: Detection| Extraction { detection, ..Extraction::thresholding(1.0) }.validate("stripes");
    holds("stripes.level", [-1e30, 1e30], |level| of(Detection::Fixed(level)));
    holds("stripes.gradient", [1e-300, 1e30], |level| of(Detection::Gradient(level)));
    holds("stripes.share", [1e-9, 1.0], |share| of(Detection::Share(share)));
    counts("stripes.least_rows", [1, 1_000_000], |least_rows| {
        Extraction { least_rows, ..Extraction::thresholding(1.0) }.validate("stripes")
    });

    // One beam in frames so long that nothing else is a limit.
    let times = |times: ExposureTimes| times.validate("times", 1, 1e9, 1);
    let one = ExposureTimes::default();
    holds("times.interval", [0.0, 1e3], |interval| times(ExposureTimes { interval, ..one }));
    holds("times.duration", [0.0, 1e5], |duration| times(ExposureTimes { duration, interval: 0.0, ..one }));
    counts("times.samples", [1, MAX_BLUR_SAMPLES], |samples| times(ExposureTimes { samples, ..one }));
    holds("times.row_time", [0.0, 1e3], |row_time| times(ExposureTimes { row_time, ..one }));
    // Rows in bands share the samples.
    let rolling = |bands: u32| times(ExposureTimes { row_time: 1e-3, samples: 2, bands, ..one });
    counts("times.bands", [1, MAX_BLUR_SAMPLES / 2], rolling);
}
