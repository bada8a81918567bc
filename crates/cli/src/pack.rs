//! `raypencil pack`: writes the reference pack of a scene, or a blind one, which has no answers, or the input pack.

use raypencil::Progress as _;
use raypencil::pack::{
    MIN_RAYS_PER_CLAUSE, Manifest, benched, blind_subject, input_faces, write_input, write_pack,
};
use raypencil::survey::warnings;

use crate::args::Pack;
use crate::console::{Spinner, say, warn};
use crate::subject::subject;
use crate::{Outcome, Trouble};

pub(crate) fn pack(command: &Pack, json: bool) -> Result<Outcome, Trouble> {
    let folder = command.output.display().to_string();
    if command.input {
        write_input(&command.output)?;
        say(&match json {
            true => format!("{:#}\n", serde_json::json!({ "pack": folder })),
            false => format!("{folder}: the input pack, {} faces\n", input_faces().len()),
        });
        return Ok(Outcome::Fine);
    }
    let spinner = Spinner::new();
    let (subject, warnings) = match command.blind {
        // This scene is ours: there is nobody to warn.
        Some(seed) => (blind_subject(seed)?, Vec::new()),
        None => {
            let subject = subject(&command.scene, "", &spinner)?;
            spinner.stage("looking at the scene");
            let warnings = warnings(&subject.scene, subject.vehicle.as_ref(), None);
            let is_plain = command.no_bench;
            (if is_plain { subject } else { benched(subject)? }, warnings)
        }
    };
    let manifest = write_pack(&subject, command.blind, &command.output, &spinner)?;
    drop(spinner);
    if json {
        let document = serde_json::json!({
            "pack": folder,
            "scene_sha256": manifest.scene.sha256,
            "clauses": manifest.clauses,
            "warnings": warnings,
        });
        say(&format!("{document:#}\n"));
    } else {
        warn(&warnings);
        say(&format!("{folder}: the pack of {}\n{}\n", subject.name, tested(&manifest)));
    }
    Ok(Outcome::Fine)
}

/// Which clauses of the contract the pack tests, in a sentence.
fn tested(manifest: &Manifest) -> String {
    if manifest.clauses.is_empty() {
        return "The scene is too large to count which clauses of the contract its rays decide.".into();
    }
    let (tested, untested): (Vec<_>, Vec<_>) =
        manifest.clauses.iter().partition(|one| one.rays >= MIN_RAYS_PER_CLAUSE);
    let all = manifest.clauses.len();
    let said = format!(
        "{} of {all} clauses of the contract decide {MIN_RAYS_PER_CLAUSE} or more of its rays each",
        tested.len()
    );
    if untested.is_empty() {
        return said + ".";
    }
    let names: Vec<String> = untested.iter().map(|one| format!("{} ({})", one.clause, one.rays)).collect();
    format!("{said}; fewer: {}.", names.join(", "))
}
