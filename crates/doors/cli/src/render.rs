//! `raypencil render`: writes the maps of one renderer.

use raypencil::harness::{write_maps_as, write_ray_sets};
use raypencil::report::counted;
use raypencil::survey::{SensorHits, warnings};
use raypencil::{Progress, Request, Sampling};

use crate::args::Render;
use crate::console::{Spinner, say, warn};
use crate::memory::Rates;
use crate::overwriting::output_folder;
use crate::subject::{contenders, subject};
use crate::{Outcome, Registry, Trouble, memory};

pub(crate) fn render(command: &Render, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let with = std::slice::from_ref(&command.with);
    let contenders = contenders(with, &command.switches, 1, registry)?;
    let renderer = &contenders[0].renderer;
    let subject = subject(&command.scene, "", &spinner)?;
    memory::ask(Rates::RENDER, &subject.scene)?;
    let folder = output_folder(&command.output, "render", &command.scene.scene, &[])?;
    spinner.stage(&format!("{}: rendering", renderer.name()));
    let sampling = command.jitter.map_or(Sampling::Centres, |seed| Sampling::Jittered { seed });
    let output = renderer.render(&subject.scene, &Request { sampling, ..Request::EVERYTHING });
    if let Some(seed) = command.jitter
        && output.beams.iter().any(|map| map.range.is_none())
    {
        return Err(Trouble::Usage(format!(
            "--jitter {seed}: {} cannot trace random rays; expected tracer or referee",
            renderer.name()
        )));
    }
    spinner.stage(&format!("{}: writing", command.output.display()));
    let files = write_maps_as(command.format, &output, renderer.name(), &subject, sampling, &command.output)?;
    let sets = write_ray_sets(&subject, renderer.name(), &command.output, &spinner)?;
    folder.finish()?;
    spinner.stage("looking at the scene");
    let hits: Vec<SensorHits> = output.maps().filter_map(SensorHits::of_map).collect();
    let mut warned = subject.file_warnings();
    warned.extend(warnings(&subject.scene, subject.vehicle.as_ref(), Some(&hits)));
    drop(spinner);
    let files: Vec<String> =
        files.iter().chain(sets.iter().flatten()).map(|path| path.display().to_string()).collect();
    if json {
        let document = serde_json::json!({
            "renderer": renderer.name(),
            "files": files,
            "warnings": warned,
        });
        say(&format!("{document:#}\n"));
    } else {
        warn(&warned);
        if sets.is_none() {
            let count = counted(subject.scene.ray_sets().len() as u64, "set of rays", "sets of rays");
            say(&format!(
                "{} answers rays of cameras and beams only; not answered: {count}\n",
                renderer.name()
            ));
        }
        say(&format!("{}\n", files.join("\n")));
    }
    Ok(Outcome::Fine)
}
