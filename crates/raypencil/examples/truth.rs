//! Confusion matrices of the rover's obstacle maps, by noise level and by setting, and the table of pointing errors:
//! the tables of `docs/evidence/results.md` below its mark, as Markdown on standard output.
//!
//! ```sh
//! cargo run --release -p raypencil --example truth
//! ```

use glam::DVec2;
use raypencil::Silent;
use raypencil::drive::{ConfusionMatrix, DriveJob, NoiseLevel, drive, pointing_table};
use raypencil::harness::contender;
use raypencil::io::{Overrides, load};
use raypencil::rover::{DrivePlan, MapSize, ScanRule};

/// Drives: name in the table, scene, and a further waypoint. (The route of `rocky-drive` ends before the first
/// obstacle.)
const DRIVES: [(&str, &str, Option<DVec2>); 3] = [
    ("pyramids", "pyramids", None),
    ("facets", "facets", None),
    ("rocky-drive, on to (5, 3)", "data/scenes/rocky-drive.toml", Some(DVec2::new(5.0, 3.0))),
];

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let mut jobs = Vec::new();
    for (name, scene, on_to) in DRIVES {
        let loaded = load(scene, &Overrides::default())?;
        let mut job = DriveJob::new(&loaded, None, scene.into())?;
        job.plan.route.waypoints.extend(on_to);
        jobs.push((name, job));
    }
    println!("{}", ConfusionMatrix::table_header());
    for (name, job) in &jobs {
        for level in NoiseLevel::ALL {
            println!("{}", confusion(&level.applied(job.clone()))?.table_row(name, level.word()));
        }
    }
    println!("\n{}", ConfusionMatrix::table_header());
    for (name, job) in &jobs {
        let printed = NoiseLevel::None.applied(job.clone());
        let coarse = NoiseLevel::Coarse.applied(job.clone()).plan.errors;
        let row = |settings: &str, change: &dyn Fn(&mut DrivePlan)| -> Result<(), Failure> {
            let mut job = printed.clone();
            change(&mut job.plan);
            println!("{}", confusion(&job)?.table_row(name, settings));
            Ok(())
        };
        row("as printed", &|_| {})?;
        row("gaps crossed", &|plan| plan.rules = plan.rules.crossing_gaps(&plan.vehicle))?;
        if job.plan.scans.is_some() {
            continue;
        }
        row("scans: at the start and each 5 m", &|plan| plan.scans = Some(ScanRule::default()))?;
        row("map of 401 points 0.05 m apart", &|plan| plan.map = MapSize { spacing: 0.05, points: 401 })?;
        row("coarse drift of the position alone", &|plan| {
            plan.errors.position_drift = coarse.position_drift
        })?;
        row("all coarse errors, `ideal` sensor", &|plan| plan.errors = coarse)?;
    }
    let renderer = contender("scanline").ok_or("there is no renderer scanline")?.renderer;
    // On the slopes of `facets`, edges lie anywhere within a pixel.
    println!("\n{}", pointing_table(&jobs[1].1, renderer.as_ref())?.trim_end());
    Ok(())
}

/// Confusion matrix of a drive with `scanline`. `tracer` gives the same labels (`docs/guide/drive.md`).
fn confusion(job: &DriveJob) -> Result<ConfusionMatrix, Failure> {
    let renderer = contender("scanline").ok_or("there is no renderer scanline")?.renderer;
    Ok(drive(job, &[renderer.as_ref()], &Silent)?.confusion)
}
