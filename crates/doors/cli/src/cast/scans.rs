//! `raypencil cast --scans`: the scans of a spinning head, one after the other.

use std::path::Path;
use std::time::Instant;

use raypencil::cast::{BagForm, CastSource, SetOfScans, write_scans};
use raypencil::{Sides, Triangles};
use serde_json::json;

use crate::args::Cast;
use crate::console::{Spinner, say};
use crate::{Outcome, Trouble};

/// Casts and writes the scans of each set.
pub(super) fn cast_scans(
    command: &Cast,
    (mesh, sets): (&Triangles, &[SetOfScans<'_>]),
    sequences: u64,
    folder: &Path,
    source: &CastSource,
    (spinner, json): (&Spinner, bool),
) -> Result<Outcome, Trouble> {
    let bag = command.bag.map(|fields| BagForm { fields, is_dense: command.bag_dense });
    let form = (bag, command.pcd.unwrap_or_default());
    let mut text = String::new();
    let mut documents = Vec::new();
    let mut hits = 0;
    for &set in sets {
        let sides = if command.fronts_only { Sides::Fronts } else { set.sides() };
        let folder = if sets.len() == 1 { folder.to_path_buf() } else { folder.join(set.name()) };
        let begin = Instant::now();
        let written = write_scans(&folder, (mesh, set, sides), sequences, form, source, spinner)?;
        let seconds = begin.elapsed().as_secs_f64();
        hits += written.hits;
        text += &format!(
            "{}: {} of {} in {seconds:.1} s, {:.0} rays/s with writing; {} hit, {} too near\n{}\n",
            set.name(),
            raypencil::report::counted(written.scans as u64, "scan", "scans"),
            raypencil::report::counted(written.rays as u64, "ray", "rays"),
            written.rays as f64 / seconds,
            raypencil::report::count(written.hits as u64),
            raypencil::report::count(written.too_near as u64),
            written.summary.display()
        );
        documents.push(json!({
            "set": set.name(),
            "scans": written.scans,
            "rays": written.rays,
            "hits": written.hits,
            "tooNear": written.too_near,
            "seconds": seconds,
            "summary": written.summary.display().to_string(),
        }));
    }
    match json {
        true => say(&format!("{:#}\n", json!({ "sets": documents }))),
        false => say(&text),
    }
    Ok(if hits == 0 && !command.allow_empty { Outcome::Differs } else { Outcome::Fine })
}
