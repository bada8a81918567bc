//! `raypencil probe`: one ray.

use raypencil_harness::{Place, probe as ask};
use raypencil_scene::SensorId;

use crate::args::Probe;
use crate::console::{Spinner, say};
use crate::subject::{renderers, subject};
use crate::{Outcome, Registry, Trouble};

pub(crate) fn probe(command: &Probe, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let place = match (command.pixel, command.beam, command.pencil) {
        (Some([i, j]), None, None) => Place { sensor: SensorId::Camera, i, j },
        (None, Some(beam), Some([i, j])) => Place { sensor: SensorId::Beam(beam), i, j },
        _ => return Err(Trouble::Usage("expected either --pixel I,J or --beam N --pencil I,J".into())),
    };
    let spinner = Spinner::new();
    let renderers = renderers(&command.with, 1, registry)?;
    let subject = subject(&command.scene, &spinner)?;
    let renderers: Vec<_> = renderers.iter().map(AsRef::as_ref).collect();
    let probe = ask(&subject, place, &renderers)?;
    drop(spinner);
    say(&if json { format!("{:#}\n", probe.to_json()) } else { probe.to_string() });
    Ok(Outcome::Fine)
}
