//! `raypencil pack`: writes the reference pack of a scene, or a blind one, which has no answers, or the input pack.

use std::path::Path;

use raypencil::cast::{CastSource, RayPackCounts, read_rays, write_ray_pack};
use raypencil::io::{FileError, file_sha256_hex, hex_digits, read_triangles};
use raypencil::pack::{
    MIN_RAYS_PER_CLAUSE, Manifest, benched, blind_subject, input_faces, write_input, write_pack,
};
use raypencil::survey::warnings;
use raypencil::{Progress as _, Sides};

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
    if let Some(rays) = &command.rays {
        return pack_rays(command, rays, json);
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

/// A pack of rays on a mesh.
fn pack_rays(command: &Pack, rays: &Path, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let file = &command.scene.scene;
    spinner.stage(&format!("{file}: loading"));
    let mesh = read_triangles(file.as_ref())?;
    let array = read_rays(rays)?;
    let source = CastSource {
        mesh: file.clone(),
        mesh_sha256: mesh.digests.iter().map(hex_digits).collect(),
        rays: rays.display().to_string(),
        rays_sha256: Some(file_sha256_hex(rays).map_err(|error| FileError::io(rays, "read", error))?.1),
    };
    let sides = if command.fronts_only { Sides::Fronts } else { Sides::Both };
    let counts = write_ray_pack(&command.output, (&mesh.triangles, &array, sides), &source, &spinner)?;
    drop(spinner);
    let folder = command.output.display();
    let untested = counts.untested();
    say(&match json {
        true => format!("{:#}\n", serde_json::json!({ "pack": folder.to_string(), "untested": untested })),
        false => {
            let nothing = if untested.is_empty() { "nothing".to_string() } else { untested.join(", ") };
            let RayPackCounts { rays, hits, misses, ties, .. } = counts;
            format!(
                "{folder}: the pack of {rays} rays; {hits} hit, {ties} of them at a tie, {misses} miss\n\
                 Not tested by any of its rays: {nothing}.\n"
            )
        }
    });
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
