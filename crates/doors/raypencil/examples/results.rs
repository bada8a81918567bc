//! Accuracy of each renderer: its largest error in ulp against correctly rounded values, for each quantity, over every
//! ray of the given scenes, with both flux models. Prints the first half of `docs/evidence/results.md`, above its mark;
//! the example `truth` prints the tables below it.
//!
//! ```sh
//! cargo run --release -p raypencil --features examples --example results -- pyramids facets marsyard2021.glb
//! ```

use std::path::Path;

use raypencil::harness::contender;
use raypencil::io::{Overrides, load};
use raypencil::judge::{Check, Class, GroundTruth, Quantity, Recorded, check};
use raypencil::{FluxModel, Progress, Request};

/// Prints progress messages to standard error.
struct StandardError;

impl Progress for StandardError {
    fn stage(&self, what: &str) {
        eprintln!("{what}");
    }
}

const RENDERERS: [&str; 2] = ["scanline", "tracer"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenes: Vec<String> = std::env::args().skip(1).collect();
    if scenes.is_empty() {
        return Err("expected scenes: built-in names, .toml or .glb files".into());
    }
    let names: Vec<String> = scenes.iter().map(|scene| name(scene)).collect();
    println!("# How exact the renderers are\n");
    println!(
        "Every ray of each scene under the default rig is computed by each renderer in double precision and\n\
         compared with the referee's correctly rounded values. The tables give the largest error in units of the\n\
         last place (ulp) of the correctly rounded value, and where it occurs. An error of 0 would be correctly\n\
         rounded throughout. The error of a vector is that of a component, in ulp of the largest component. The\n\
         large errors of ranges belong to rays that graze a face, where a bound grows as 1 / cos(psi)\n\
         (`bounds.rs`). Which face is hit, which pixel, and what is visible are judged exactly.\n"
    );
    println!(
        "The tables are made by\n\
         `cargo run --release -p raypencil --features examples --example results -- {}`.\n\
         The last scene is the Mars yard of half a million triangles, which is not part of this repository. The\n\
         numbers are the same on any machine.\n",
        names.join(" ")
    );
    // `just stamp docs/evidence/results.md COMMAND` fills it in.
    let last = names.last().map_or("", String::as_str);
    println!("<!-- stands on\nmade_by = \"just results {last}\"\nrenderers = \"\"\n-->\n");
    for (scene, name) in scenes.iter().zip(&names) {
        page(scene, name)?;
    }
    Ok(())
}

/// The name of a scene: its file without the folder.
fn name(scene: &str) -> String {
    Path::new(scene).file_name().map_or(scene.into(), |name| name.to_string_lossy().into_owned())
}

/// Prints the tables of one scene.
fn page(scene: &str, name: &str) -> Result<(), Box<dyn std::error::Error>> {
    println!("## {name}\n");
    let mut columns: Vec<(String, Check)> = Vec::new();
    for flux_model in [FluxModel::Radiometric, FluxModel::Eq1] {
        let overrides = Overrides { flux_model: Some(flux_model), ..Overrides::default() };
        let loaded = load(scene, &overrides)?;
        let truth = GroundTruth::certified(&loaded.scene, &StandardError);
        for renderer in RENDERERS {
            let contender = contender(renderer).ok_or("a renderer's name")?;
            let output = contender.renderer.render(&loaded.scene, &Request::EVERYTHING);
            let precision = contender.renderer.precision();
            let recorded = Recorded::of_output(renderer, &loaded.scene, &output, precision);
            let model = flux_model.word();
            columns.push((format!("{renderer} {model}"), check(&truth, &recorded, &StandardError)));
        }
    }

    println!("| | compared | agree | tie | rounding | defect |\n| --- | ---: | ---: | ---: | ---: | ---: |");
    for (title, found) in &columns {
        let of = |class| found.of(class);
        println!(
            "| {title} | {} | {} | {} | {} | {} |",
            found.compared(),
            of(Class::Agree),
            of(Class::Tie),
            of(Class::Rounding),
            of(Class::Defect)
        );
    }
    println!("\n| largest error, ulp | values | scanline | tracer |\n| --- | ---: | --- | --- |");
    let valued = Quantity::ALL.into_iter().filter(|quantity| {
        !matches!(quantity, Quantity::Hit | Quantity::Face | Quantity::Visible | Quantity::Pixel)
    });
    for quantity in valued {
        let is_flux = matches!(quantity, Quantity::PencilFlux | Quantity::PixelFlux);
        // The flux model does not change the geometry.
        for pair in columns.chunks(RENDERERS.len()).take(if is_flux { 2 } else { 1 }) {
            let model = pair[0].0.split_once(' ').map_or("", |(_, model)| model);
            let title = if is_flux { format!("{quantity}, {model}") } else { quantity.to_string() };
            let cells = pair.iter().map(|(_, found)| {
                let totals = found.totals();
                let of_quantity = totals.iter().filter(|(item, _)| item.quantity == quantity);
                let largest = of_quantity.filter_map(|(_, tally)| tally.worst_ulps.clone());
                let largest = largest.max_by(|a, b| a.value.total_cmp(&b.value));
                largest.map_or("none".into(), |one| format!("{:.0}, {}", one.value, one.place))
            });
            let totals = pair[0].1.totals();
            let of_quantity = totals.iter().filter(|(item, _)| item.quantity == quantity);
            let values: u64 = of_quantity.map(|(_, tally)| tally.compared()).sum();
            println!("| {title} | {values} | {} |", cells.collect::<Vec<_>>().join(" | "));
        }
    }
    println!();
    Ok(())
}
