//! Sizes of reports, and the time from the opening of a page to its first picture, as a Markdown table on standard output.
//! Needs Chromium with its driver. The table of `docs/evidence/page-times.md` was made so.
//!
//! ```sh
//! cargo run --release -p raypencil-tests --features examples --example page_times
//! ```

#[path = "../tests/it/report_page/browser.rs"]
#[allow(dead_code, reason = "tests ask for more than this program")]
mod browser;

use std::error::Error;

use raypencil::Silent;
use raypencil::harness::{contender, validate, write_validation};
use raypencil::io::{Overrides, load, load_text};
use raypencil::judge::JudgeShare;
use raypencil::report::count;

/// How often each page is opened, each time by a new browser.
const ROUNDS: usize = 7;

/// The browser's mark when the first picture was made, milliseconds after the page was asked for.
const FIRST_PICTURE: &str = "performance.getEntriesByName('first-picture')[0]?.startTime ?? null";

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = Overrides { thickness_mm: Some(80.0), ..Overrides::default() };
    let plain = "version = 1\nterrain = { generate = { kind = 'plain', seed = 1, faces = 500000 } }";
    let viking = "version = 1\nterrain = { generate = { preset = 'viking1', seed = 7, extent_m = 24 } }";
    let pages = [
        ("pyramids", load("pyramids", &Overrides::default())?, ["scanline", "tracer"]),
        ("pyramids, sheets of 80 mm", load("pyramids", &sheet)?, ["scanline-paper", "tracer"]),
        ("500,000 faces", load_text(plain, "plain")?, ["scanline", "tracer"]),
        ("viking1, 24 m", load_text(viking, "viking1")?, ["scanline", "tracer"]),
    ];
    println!(
        "| scene | faces | rays | renderers | `report.html` | first picture: median, slowest of {ROUNDS} |"
    );
    println!("| --- | ---: | ---: | --- | ---: | ---: |");
    for (name, loaded, renderers) in pages {
        let faces = loaded.scene.mesh().faces().len() as u64;
        let arguments = loaded.name.clone();
        let subject = loaded.into_subject(arguments);
        let contenders = renderers.map(|name| contender(name).expect("a renderer"));
        let validation = validate(subject, &contenders, JudgeShare::Sample, &Silent);
        let folder = tempfile::tempdir()?;
        write_validation(&validation, folder.path(), &Silent)?;
        let page = folder.path().join("report.html");
        let mut times = Vec::new();
        for _ in 0..ROUNDS {
            let Some(opened) = browser::open(&page, "", (1280, 1000)) else { return Ok(()) };
            opened.wait(&format!("({FIRST_PICTURE}) !== null"));
            times.push(opened.number(FIRST_PICTURE) / 1000.0);
        }
        times.sort_by(f64::total_cmp);
        println!(
            "| {name} | {} | {} | {} | {:.1} MB | {:.2} s, {:.2} s |",
            count(faces),
            count(validation.counts().compared),
            renderers.join(", "),
            std::fs::metadata(&page)?.len() as f64 / 1e6,
            times[ROUNDS / 2],
            times[ROUNDS - 1],
        );
    }
    Ok(())
}
