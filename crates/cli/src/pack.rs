//! `raypencil pack`: writes the reference pack of a scene, or a blind one, which has no answers.

use raypencil::pack::{blind_subject, write_pack};

use crate::args::Pack;
use crate::console::{Spinner, say};
use crate::subject::subject;
use crate::{Outcome, Trouble};

pub(crate) fn pack(command: &Pack, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let subject = match command.blind {
        Some(seed) => blind_subject(seed)?,
        None => subject(&command.scene, "", &spinner)?,
    };
    write_pack(&subject, command.blind, &command.output, &spinner)?;
    drop(spinner);
    let folder = command.output.display().to_string();
    if json {
        say(&format!("{:#}\n", serde_json::json!({ "pack": folder, "scene_sha256": subject.sha256 })));
    } else {
        say(&format!("{folder}: the pack of {}\n", subject.name));
    }
    Ok(Outcome::Fine)
}
