//! The maps of one renderer.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::harness::{Contender, RENDERER_NAMES, contender, write_maps, write_ray_sets};
use raypencil::{Fidelity, Progress, Request, Sampling};

use crate::failure::Failure;
use crate::folder::{Output, end};
use crate::maps::{into_dict, sensor_arrays};
use crate::scene::SceneCore;
use crate::watch::watched;

/// Renderers by their names, with the switches of the scanline renderer set: each with `paper` or `exact`.
pub(crate) fn contenders(names: &[String], switches: &[(String, String)]) -> Result<Vec<Contender>, Failure> {
    let mut found = Vec::new();
    for (at, name) in names.iter().enumerate() {
        if names[..at].contains(name) {
            return Err(Failure::new(format!("with_: {name} is named twice; expected different renderers")));
        }
        let known = RENDERER_NAMES.join(", ");
        let mut renderer = contender(name).ok_or_else(|| {
            Failure::new(format!("with_: there is no renderer {name:?}; expected one of {known}"))
        })?;
        for (switch, word) in switches {
            let fidelity = match word.as_str() {
                "paper" => Fidelity::Paper,
                "exact" => Fidelity::Exact,
                _ => {
                    return Err(Failure::new(format!(
                        "switch {switch} is {word:?}; expected \"paper\" or \"exact\""
                    )));
                }
            };
            renderer = renderer
                .with_switch(switch, fidelity)
                .map_err(|error| Failure::new(format!("switch {switch}={word}: {error}")))?;
        }
        found.push(renderer);
    }
    if let Some((switch, word)) = switches.first()
        && found.iter().all(|renderer| renderer.switches.is_none())
    {
        let names = names.join(", ");
        return Err(Failure::new(format!(
            "switch {switch}={word}: {names} has no switches; expected scanline or scanline-paper among the renderers"
        )));
    }
    Ok(found)
}

/// The words that choose renderers on a command line; none for the default.
pub(crate) fn renderer_words(names: &[String], switches: &[(String, String)], default: &[&str]) -> String {
    let mut words = String::new();
    if names != default {
        words += &format!(" --with {}", names.join(","));
    }
    for (switch, word) in switches {
        words += &format!(" --switch {switch}={word}");
    }
    words
}

/// Renders a scene: the arrays of each sensor. With `output` the files of the command are written, too.
#[pyfunction]
#[pyo3(signature = (scene, name, switches, jitter=None, output=None, force=false, on_stage=None))]
pub(crate) fn render<'py>(
    py: Python<'py>,
    scene: &SceneCore,
    name: String,
    switches: Vec<(String, String)>,
    jitter: Option<u64>,
    output: Option<PathBuf>,
    force: bool,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let scene = scene.clone();
    let output = Output { folder: output, force };
    let sensors = watched(py, on_stage, move |watch| {
        let contenders = contenders(std::slice::from_ref(&name), &switches)?;
        let renderer = &contenders[0].renderer;
        let begun = output.begin("render", scene.of(), &[])?;
        watch.stage(&format!("{}: rendering", renderer.name()));
        let sampling = jitter.map_or(Sampling::Centres, |seed| Sampling::Jittered { seed });
        let rendered = renderer.render(&scene.loaded.scene, &Request { sampling, ..Request::EVERYTHING });
        if let Some(seed) = jitter
            && rendered.beams.iter().any(|map| map.range.is_none())
        {
            return Err(Failure::new(format!(
                "jitter={seed}: {} cannot trace random rays; expected tracer or referee",
                renderer.name()
            )));
        }
        if let Some(folder) = &output.folder {
            watch.stage(&format!("{}: writing", folder.display()));
            let subject = scene.subject("");
            write_maps(&rendered, renderer.name(), &subject, sampling, folder)?;
            write_ray_sets(&subject, renderer.name(), folder, watch)?;
        }
        end(begun)?;
        watch.stage("making arrays");
        Ok(sensor_arrays(&rendered))
    })?;
    into_dict(py, sensors)
}
