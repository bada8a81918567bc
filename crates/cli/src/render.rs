//! `raypencil render`: one renderer's maps.

use raypencil_harness::{Progress, write_maps};
use raypencil_scene::Request;

use crate::args::Render;
use crate::console::{Spinner, say};
use crate::subject::{renderers, subject};
use crate::{Outcome, Registry, Trouble};

pub(crate) fn render(command: &Render, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let renderers = renderers(std::slice::from_ref(&command.with), 1, registry)?;
    let subject = subject(&command.scene, &spinner)?;
    spinner.stage(&format!("{}: rendering", command.with));
    let frame = renderers[0].render(&subject.scene, &Request::EVERYTHING);
    spinner.stage(&format!("{}: writing", command.output.display()));
    let files = write_maps(&frame, &command.with, &subject, &command.output)?;
    drop(spinner);
    let files: Vec<String> = files.iter().map(|path| path.display().to_string()).collect();
    if json {
        say(&format!("{:#}\n", serde_json::json!({ "renderer": command.with, "files": files })));
    } else {
        say(&format!("{}\n", files.join("\n")));
    }
    Ok(Outcome::Fine)
}
