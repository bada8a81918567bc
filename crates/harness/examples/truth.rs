//! What the rover finds of the obstacles that are there, and which errors matter: the tables of `docs/results.md` below
//! its mark, as Markdown on standard output.
//!
//! ```sh
//! cargo run --release -p raypencil-harness --example truth
//! ```

use glam::DVec2;
use raypencil_harness::{
    DriveJob, NoiseLevel, Silent, TRUTH_HEAD, TruthMatrix, contender, drive, pointing_table,
};
use raypencil_rover::PassableRules;
use raypencil_scene_io::{Overrides, load};

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
        println!("{}", truth(&printed)?.row(name, "as printed"));
        let mut crossing = printed;
        crossing.plan.rules = PassableRules::crossing_gaps(crossing.plan.rules, &crossing.plan.vehicle);
        println!("{}", truth(&crossing)?.row(name, "gaps crossed"));
    }
    let renderer = contender("scanline").ok_or("a renderer of this house")?.renderer;
    // The slopes of facets put edges anywhere within a pixel.
    println!("\n{}", pointing_table(&jobs[1].1, renderer.as_ref())?.trim_end());
    Ok(())
}

/// Drives with `scanline`, which `tracer` equals to the last label (`docs/drive.md`).
fn truth(job: &DriveJob) -> Result<TruthMatrix, Failure> {
    let renderer = contender("scanline").ok_or("a renderer of this house")?.renderer;
    Ok(drive(job, &[renderer.as_ref()], &Silent)?.truth)
}
