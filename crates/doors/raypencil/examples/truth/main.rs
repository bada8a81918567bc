//! Obstacle maps of the rover against what the vehicle can truly pass, by rules and by noise level, and the table of
//! pointing errors: the tables of `docs/evidence/results.md` below its mark, as Markdown on standard output.
//! `tests/tests/it/truth_tables` tests its modules.
//!
//! ```sh
//! cargo run --release -p raypencil --features examples --example truth            # all tables
//! cargo run --release -p raypencil --features examples --example truth rules      # one: rules, noise, pointing
//! cargo run --release -p raypencil --features examples --example truth rules facets "as printed"      # one row
//! ```
//!
//! Rows are kept in `out/truth` as long as this program stays the same: an interrupted run goes on, and rows may be made in any
//! order. With `KEPT=1` the rows that are there already are printed, and no other.

mod kept_rows;
mod noise_level;
mod pointing;
mod sector_table;
mod sensitivity;

use glam::DVec2;
use raypencil::Silent;
use raypencil::drive::{DriveJob, SectorTruth, drive};
use raypencil::harness::contender;
use raypencil::io::{Overrides, load};
use raypencil::rover::{DrivePlan, MapRules, MapSize, Rule, ScanRule, StartRule, TraversabilityRules};

use kept_rows::KeptRows;
use noise_level::NoiseLevel;
use pointing::pointing_table;

/// Drives: name in the table, scene, and a further waypoint. (The route of `rocky-drive` ends before the first
/// obstacle.)
const DRIVES: [(&str, &str, Option<[f64; 2]>); 3] = [
    ("pyramids", "pyramids", None),
    ("facets", "facets", None),
    ("rocky-drive, on to (5, 3)", "data/scenes/rocky-drive.toml", Some([5.0, 3.0])),
];

type Failure = Box<dyn std::error::Error>;

type Change = fn(&mut DrivePlan);

/// All rules as printed.
fn printed(plan: &mut DrivePlan) {
    plan.map_rules = MapRules::AS_PRINTED;
    plan.rules = TraversabilityRules::as_printed(&plan.vehicle);
}

/// One mended rule put back at a time.
const PUT_BACK: [(&str, Change); 9] = [
    ("elevation as printed", |plan| plan.map_rules.elevation = Rule::Paper),
    ("extrapolate as printed", |plan| plan.map_rules.extrapolate = Rule::Paper),
    ("several as printed", |plan| plan.map_rules.several = Rule::Paper),
    ("inconsistency as printed", |plan| plan.map_rules.inconsistency = Rule::Paper),
    ("gap as printed", |plan| plan.rules.gaps = None),
    ("settle as printed", |plan| plan.map_rules.settle = Rule::Paper),
    ("tests as printed", |plan| plan.rules.tests = Rule::Paper),
    ("start by the footprint", |plan| plan.map_rules.start = StartRule::Footprint),
    ("start on levelled ground", |plan| plan.map_rules.start = StartRule::Circle),
];

/// Other settings, each alone.
const SETTINGS: [(&str, Change); 2] = [
    ("scans: at the start and each 5 m", |plan| plan.scans = Some(ScanRule::default())),
    ("map of 401 points 0.05 m apart", |plan| plan.map = MapSize { spacing: 0.05, points: 401 }),
];

fn main() -> Result<(), Failure> {
    let asked = std::env::args().nth(1);
    let only = std::env::args().nth(2);
    let only_row = std::env::args().nth(3);
    let wants = |table: &str| asked.as_deref().is_none_or(|asked| asked == table);
    let kept = KeptRows::of_this_program()?;
    let mut jobs = Vec::new();
    for (name, scene, on_to) in DRIVES {
        if only.as_deref().is_some_and(|only| only != scene && only != name) {
            continue;
        }
        let loaded = load(scene, &Overrides::default())?;
        let mut job = DriveJob::new(&loaded, None, scene.into())?;
        job.plan.route.waypoints.extend(on_to.map(DVec2::from_array));
        jobs.push((name, NoiseLevel::None.applied(job)));
    }
    let row = |name: &str, settings: &str, job: &DriveJob, change: Change| -> Result<(), Failure> {
        if only_row.as_deref().is_some_and(|only| only != settings) {
            return Ok(());
        }
        let made = kept.row(&format!("{name}, {settings}"), || {
            let mut job = job.clone();
            change(&mut job.plan);
            let (truth, bound) = truth(&job)?;
            Ok(sector_table::row(&truth, &bound, name, settings))
        })?;
        if let Some(made) = made {
            println!("{made}");
        }
        Ok(())
    };
    if wants("rules") {
        println!("{}", sector_table::HEAD);
        for (name, job) in &jobs {
            row(name, "mended", job, |_| {})?;
            row(name, "as printed", job, printed)?;
            for (settings, change) in PUT_BACK.into_iter().chain(SETTINGS) {
                row(name, settings, job, change)?;
            }
        }
    }
    if wants("noise") {
        println!("\n{}", sector_table::HEAD);
        for (name, job) in &jobs {
            for level in [NoiseLevel::Modest, NoiseLevel::Coarse] {
                let job = level.applied(job.clone());
                row(name, &format!("{}, mended", level.word()), &job, |_| {})?;
                row(name, &format!("{}, as printed", level.word()), &job, printed)?;
            }
        }
    }
    if wants("pointing") {
        let renderer = contender("scanline").ok_or("there is no renderer scanline")?.renderer;
        // On the slopes of `facets`, edges lie anywhere within a pixel.
        let loaded = load("facets", &Overrides::default())?;
        let facets = DriveJob::new(&loaded, None, "facets".into())?;
        println!("\n{}", pointing_table(&facets, renderer.as_ref())?.trim_end());
    }
    Ok(())
}

/// Truth of a drive with `scanline`, and its upper bound. `tracer` gives the same labels (`docs/guide/drive.md`).
fn truth(job: &DriveJob) -> Result<(SectorTruth, SectorTruth), Failure> {
    let renderer = contender("scanline").ok_or("there is no renderer scanline")?.renderer;
    let run = drive(job, &[renderer.as_ref()], &Silent)?;
    Ok((run.truth, run.upper_bound))
}
