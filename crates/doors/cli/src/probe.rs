//! `raypencil probe`: prints every renderer's answer to one ray.

use raypencil::Progress as _;
use raypencil::harness::probe as ask;
use raypencil::{Place, SensorId};

use crate::args::{Probe, typed_renderers};
use crate::console::{Spinner, say};
use crate::memory::Rates;
use crate::subject::{candidates, contenders, subject};
use crate::{Outcome, Registry, Trouble, memory};

pub(crate) fn probe(command: &Probe, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let place = match (command.pixel, command.beam, command.pencil) {
        (Some([i, j]), None, None) => Place { sensor: SensorId::Camera, i, j },
        (None, Some(beam), Some([i, j])) => Place { sensor: SensorId::Beam(beam), i, j },
        _ => return Err(Trouble::Usage("expected either --pixel I,J or --beam N --pencil I,J".into())),
    };
    let spinner = Spinner::new();
    let contenders = contenders(&command.with, &command.switches, 1, registry)?;
    let words = typed_renderers(&command.with, &command.switches);
    let subject = subject(&command.scene, &words, &spinner)?;
    memory::ask(Rates::PROBE, &subject.scene)?;
    // Candidates first, so that an error in their files is reported before the rendering.
    spinner.stage("reading candidates");
    let candidates = candidates(&command.candidates, &command.declared, &subject.scene)?;
    let mut probe = ask(&subject, place, &contenders, &spinner)?;
    spinner.stage("judging candidates");
    probe.ask(&subject, &candidates);
    drop(spinner);
    say(&if json { format!("{:#}\n", probe.to_json()) } else { probe.to_string() });
    Ok(Outcome::Fine)
}
