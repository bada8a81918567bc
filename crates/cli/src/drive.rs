//! `raypencil drive`: a rover's way over a ground, with one renderer or two.

use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use raypencil::Progress;
use raypencil::drive::{DriveJob, DriveProgress, drive as run, drive_json, drive_screen, write_drive};
use raypencil::io::{DriveSetup, load};

use crate::args::{self, DRIVE_WITH, typed_renderers};
use crate::console::{Spinner, say};
use crate::subject::contenders;
use crate::{Outcome, Registry, Trouble};

/// Frames done, and the time that is left. Hidden where standard error is no terminal.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::new(0);
        if let Ok(style) =
            ProgressStyle::with_template("{bar:30} {pos}/{len} frames  {elapsed} elapsed, {eta} left")
        {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }
}

impl DriveProgress for Bar {
    fn frames(&self, done: u64, of: u64) {
        self.0.set_length(of);
        self.0.set_position(done);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

pub(crate) fn drive(command: &args::Drive, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let names: Vec<String> = match command.both {
        true => ["scanline", "tracer"].map(String::from).to_vec(),
        false => vec![command.with.clone()],
    };
    let contenders = contenders(&names, &command.switches, 1, registry)?;
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: loading", command.scene.scene));
    let mut loaded = load(&command.scene.scene, &command.scene.overrides())?;
    let mut words = command.scene.typed();
    if !command.to.is_empty() {
        let rig = loaded.rig();
        let drive = loaded.drive.get_or_insert_with(|| DriveSetup::new(rig, Vec::new()));
        drive.plan.route.waypoints = command.to.iter().map(|&to| to.into()).collect();
    }
    for [x, y] in &command.to {
        words.push_str(&format!(" --to {x},{y}"));
    }
    if command.both {
        words.push_str(" --both");
    }
    // What says nothing of renderers: the default one, or both.
    let unsaid = command.both || command.with == DRIVE_WITH;
    let said = if unsaid { args::DEFAULT_WITH.map(String::from).to_vec() } else { names };
    words.push_str(&typed_renderers(&said, &command.switches));
    let trouble = |error| Trouble::Drive { scene: command.scene.scene.clone(), error };
    let job = DriveJob::new(&loaded, command.scene.at, words).map_err(trouble)?;
    let folder: PathBuf = match &command.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(format!("{}-drive", job.name)),
    };
    drop(spinner);

    let renderers: Vec<_> = contenders.iter().map(|contender| contender.renderer.as_ref()).collect();
    let found = run(&job, &renderers, &Bar::new()).map_err(trouble)?;
    let spinner = Spinner::new();
    write_drive(&job, &found, &folder, &spinner)?;
    drop(spinner);
    say(&if json { drive_json(&job, &found) } else { drive_screen(&job, &found, Some(&folder)) });
    Ok(if found.passes() { Outcome::Fine } else { Outcome::Differs })
}
