//! `raypencil pack`: writes the reference pack of a scene, or a blind one, which has no answers.

use raypencil::Progress as _;
use raypencil::io::scene_sha256;
use raypencil::pack::{blind_subject, write_pack};
use raypencil::survey::warnings;

use crate::args::Pack;
use crate::console::{Spinner, say, warn};
use crate::subject::subject;
use crate::{Outcome, Trouble};

pub(crate) fn pack(command: &Pack, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let subject = match command.blind {
        Some(seed) => blind_subject(seed)?,
        None => subject(&command.scene, "", &spinner)?,
    };
    write_pack(&subject, command.blind, &command.output, &spinner)?;
    spinner.stage("looking at the scene");
    let warnings = warnings(&subject.scene, subject.vehicle.as_ref(), None);
    drop(spinner);
    let folder = command.output.display().to_string();
    if json {
        let document = serde_json::json!({
            "pack": folder,
            "scene_sha256": scene_sha256(&subject.scene),
            "warnings": warnings,
        });
        say(&format!("{document:#}\n"));
    } else {
        warn(&warnings);
        say(&format!("{folder}: the pack of {}\n", subject.name));
    }
    Ok(Outcome::Fine)
}
