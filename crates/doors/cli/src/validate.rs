//! `raypencil validate`: renders a scene, compares every ray and writes the report.

use std::path::{Path, PathBuf};

use raypencil::Progress as _;
use raypencil::harness::{one_screen, validate as run, whole_screen, write_validation};

use crate::args::{Validate, typed_renderers};
use crate::console::{Spinner, is_terminal, say};
use crate::memory::Rates;
use crate::overwriting::output_folder;
use crate::subject::{candidates, contenders, subject};
use crate::{Outcome, Registry, Trouble, memory};

pub(crate) fn validate(command: &Validate, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let contenders = contenders(&command.with, &command.switches, 2, registry)?;
    let words = typed_renderers(&command.with, &command.switches);
    let subject = subject(&command.scene, &words, &spinner)?;
    memory::ask(Rates::VALIDATE, &subject.scene)?;
    let folder: PathBuf = match &command.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(&subject.name),
    };
    let output = output_folder(&folder, "validate", &command.scene.scene, &[])?;
    // Candidates first, so that an error in their files is reported before the rendering.
    spinner.stage("reading candidates");
    let candidates = candidates(&command.candidates, &command.declared, &subject.scene)?;
    let mut validation = run(subject, &contenders, command.judge, &spinner);
    validation.allow_empty = command.allow_empty;
    if !candidates.is_empty() {
        validation.evaluate(candidates, &spinner);
        validation.candidates_may_fail = !command.candidates_must_pass;
    }
    write_validation(&validation, &folder, &spinner)?;
    output.finish()?;
    drop(spinner);
    if json {
        say(&validation.document().json());
    } else {
        let screen = if is_terminal() { one_screen } else { whole_screen };
        say(&screen(&validation, Some(&folder)));
    }
    Ok(if validation.passes() { Outcome::Fine } else { Outcome::Differs })
}
