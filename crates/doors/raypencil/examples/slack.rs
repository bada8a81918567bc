//! How large a mistake passes: the page `docs/evidence/slack.md`, to standard output.
//!
//! ```text
//! cargo run --release -p raypencil --features examples --example slack -- SEEDS
//! ```

use std::fmt::Write as _;

use raypencil::naive::Slack;
use raypencil::pack::{Sharpness, blind_scene, sharpness, with_bench};
use raypencil::{Overrides, Precision, Scene, Silent, load};

/// The scenes of the packs that are published.
const PUBLISHED: [&str; 3] = ["hard", "pyramids", "facets"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(50), |text| text.parse())?;
    let mut page = format!(
        "# How large a mistake passes\n\n\
         <!-- stands on\n\
         made_by = \"just slack {seeds}\"\n\
         inputs = [\"data/packs/facets/manifest.json\", \"data/packs/hard/manifest.json\", \"data/packs/pyramids/manifest.json\"]\n\
         inputs_digest = \"0000000000000000\"\n\
         -->\n\n\
         A renderer may keep a clause of the contract with a tolerance: a bias of its shadow rays, edges a little too wide, a far plane \
         a little too far. Here are the smallest such tolerances that a pack notices, for each of {} ways. Each was found with a renderer \
         in double precision that has this one tolerance and is else honest: it answered the pencils of the pack's bench, and was \
         checked as every candidate is. The size was found by halving among 1, 2 and 5 times the powers of ten: it is noticed, and the next \
         smaller one is not.\n\n\
         `*`: the next smaller size changed answers as well, each so little that rounding excuses it. Without it no ray of the \
         bench passes the limit closer.\n\n\
         Made by `just slack`. The figures of a pack also stand in its `manifest.json`, and a check that passes tells them \
         ([the guide](../guide/for-implementers.md)).\n",
        Slack::ALL.len()
    );
    for (precision, words) in [(Precision::F64, "double"), (Precision::F32, "single")] {
        let measure = |scene: &Scene| sharpness(scene, precision, &Silent);
        let mut columns = Vec::new();
        for name in PUBLISHED {
            let file = format!("data/scenes/packs/{name}.toml");
            columns.push(measure(&with_bench(&load(&file, &Overrides::default())?.scene)?)?);
        }
        let mut blind = Vec::new();
        for seed in 0..seeds {
            eprintln!("{words}: seed {seed}");
            blind.push(measure(&blind_scene(seed)?)?);
        }
        let too_blunt = blind.iter().filter(|one| !one.iter().all(Sharpness::suffices)).count();
        writeln!(page, "\n## A candidate that computes in {words} precision\n")?;
        writeln!(
            page,
            "| | unit | {} | blind packs: best | worst of {seeds} | a renderer that is wrong by x |\n| --- | --- | {}---: | ---: | --- |",
            PUBLISHED.join(" | "),
            "---: | ".repeat(PUBLISHED.len())
        )?;
        for (row, slack) in Slack::ALL.iter().enumerate() {
            let mut of_seeds: Vec<&Sharpness> = blind.iter().map(|one| &one[row]).collect();
            let size = |one: &&Sharpness| one.noticed.unwrap_or(f64::INFINITY);
            of_seeds.sort_by(|a, b| size(a).total_cmp(&size(b)));
            let own = columns.iter().map(|one| &one[row]);
            let cells: Vec<String> =
                own.chain(of_seeds.first().copied()).chain(of_seeds.last().copied()).map(shown).collect();
            writeln!(
                page,
                "| {} | {} | {} | {} |",
                slack.key().replace('-', " "),
                slack.unit().words(),
                cells.join(" | "),
                slack.what()
            )?;
        }
        if precision == Precision::F64 {
            writeln!(
                page,
                "\nOf {seeds} seeds {too_blunt} made a blind pack that is refused, because a tolerance beyond the limits of \
                 `crates/verdict/pack/src/sharpness.rs` passes: 1e-7 of a cell or pixel, 1e-6 as a share or a cosine, 1e-9 of the way for the \
                 two ends of shadow rays."
            )?;
        }
    }
    print!("{page}");
    Ok(())
}

fn shown(one: &Sharpness) -> String {
    let mark = if one.excused { "*" } else { "" };
    one.noticed.map_or("not noticed".into(), |size| format!("{size:e}{mark}"))
}
