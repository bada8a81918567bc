//! What the rover finds of the obstacles that are there, and which errors matter: the tables of `docs/results.md` below
//! its mark, as Markdown on standard output.
//!
//! ```sh
//! cargo run --release -p raypencil-harness --example truth
//! ```

use raypencil_harness::{DriveJob, NoiseLevel, Silent, TRUTH_HEAD, TruthMatrix, contender, drive};
use raypencil_rover::PassableRules;
use raypencil_scene_io::{Overrides, load};

/// Drives by the name in the table and what is loaded.
const DRIVES: [(&str, &str); 3] =
    [("pyramids", "pyramids"), ("facets", "facets"), ("rocky-drive", "data/scenes/rocky-drive.toml")];

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let mut jobs = Vec::new();
    for (name, scene) in DRIVES {
        let loaded = load(scene, &Overrides::default())?;
        jobs.push((name, DriveJob::new(&loaded, None, scene.into())?));
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
    Ok(())
}

/// Drives with `scanline`, which `tracer` equals to the last label (`docs/drive.md`).
fn truth(job: &DriveJob) -> Result<TruthMatrix, Failure> {
    let renderer = contender("scanline").ok_or("a renderer of this house")?.renderer;
    Ok(drive(job, &[renderer.as_ref()], &Silent)?.truth)
}
