//! What the rover finds of the obstacles that are there, and which errors matter: the tables of `docs/evidence/results.md` below
//! its mark, as Markdown on standard output.
//!
//! ```sh
//! cargo run --release -p raypencil-harness --example truth
//! ```

use glam::DVec2;

use raypencil::Silent;
use raypencil::drive::{DriveJob, NoiseLevel, TRUTH_HEAD, TruthMatrix, drive, pointing_table};
use raypencil::harness::contender;
use raypencil::io::{Overrides, load};
use raypencil::rover::{DrivePlan, MapSize, ScanRule};

/// Drives by the name in the table, what is loaded, and where they go on to: `rocky-drive` ends before the first obstacle.
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
    println!("{TRUTH_HEAD}");
    for (name, job) in &jobs {
        for level in NoiseLevel::ALL {
            println!("{}", truth(&level.applied(job.clone()))?.row(name, level.word()));
        }
    }
    println!("\n{TRUTH_HEAD}");
    for (name, job) in &jobs {
        let printed = NoiseLevel::None.applied(job.clone());
        let coarse = NoiseLevel::Coarse.applied(job.clone()).plan.errors;
        let row = |what: &str, change: &dyn Fn(&mut DrivePlan)| -> Result<(), Failure> {
            let mut job = printed.clone();
            change(&mut job.plan);
            println!("{}", truth(&job)?.row(name, what));
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
    let renderer = contender("scanline").ok_or("a renderer of this house")?.renderer;
    // The slopes of facets put edges anywhere within a pixel.
    println!("\n{}", pointing_table(&jobs[1].1, renderer.as_ref())?.trim_end());
    Ok(())
}

/// Drives with `scanline`, which `tracer` equals to the last label (`docs/guide/drive.md`).
fn truth(job: &DriveJob) -> Result<TruthMatrix, Failure> {
    let renderer = contender("scanline").ok_or("a renderer of this house")?.renderer;
    Ok(drive(job, &[renderer.as_ref()], &Silent)?.truth)
}
