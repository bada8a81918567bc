//! Command `raypencil drive`: drives the rover over a ground, with one renderer or with two.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use indicatif::ProgressBar;
use raypencil::Progress;
use raypencil::drive::{
    self, DriveExtras, DriveJob, DriveProgress, RecordContents, StripeFile, drive_document, drive_renderer,
    write_drive,
};
use raypencil::io::{DriveSetup, Overrides, Setting, WaypointFrame, load};

use crate::args::{self, typed_renderers};
use crate::console::{Spinner, progress_bar, say};
use crate::overwriting::output_folder;
use crate::subject::contenders;
use crate::{Outcome, Registry, Trouble, memory};

/// Progress bar: frames done and time left. Hidden if standard error is no terminal.
struct FrameBar(ProgressBar);

impl FrameBar {
    fn new() -> Self {
        let bar = progress_bar(0, "{bar:30} {pos}/{len} frames{msg}  {elapsed} elapsed, {eta} left");
        Self(bar)
    }
}

impl DriveProgress for FrameBar {
    fn frames(&self, done: u64, planned: u64) {
        self.0.set_length(planned);
        self.0.set_position(done);
        self.0.set_message("");
    }

    fn scan(&self, done: u64, planned: u64) {
        self.0.set_message(format!(", scan: {done}/{planned}"));
    }
}

impl Drop for FrameBar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Runs the command.
///
/// # Errors
/// Renderers, scenes, drives and folders that are refused.
pub(crate) fn drive(command: &args::Drive, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let default = drive_renderer(command.as_printed);
    let names: Vec<String> = match command.both {
        true => ["scanline", "tracer"].map(String::from).to_vec(),
        false => vec![command.with.clone().unwrap_or_else(|| default.to_string())],
    };
    let contenders = contenders(&names, &command.switches, 1, registry)?;
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: loading", command.scene.scene));
    let overrides = Overrides { for_drive: true, ..command.scene.overrides() };
    let mut loaded = load(&command.scene.scene, &overrides)?;
    memory::ask_drive(&loaded.scene, loaded.drive.as_ref().map_or(1, |drive| drive.optics.oversampling))?;
    let mut arguments = command.scene.typed();
    if !command.to.is_empty() {
        let rig = loaded.rig();
        let new = || DriveSetup::new(rig, Vec::new(), WaypointFrame::Vehicle);
        let drive = loaded.drive.get_or_insert_with(new);
        drive.waypoints = command.to.iter().map(|&to| to.into()).collect();
        drive.waypoint_frame = if command.to_global { WaypointFrame::Global } else { WaypointFrame::Vehicle };
    }
    for [x, y] in &command.to {
        arguments.push_str(&format!(" --to {x},{y}"));
    }
    for (flag, is_set) in [(" --to-global", command.to_global), (" --as-printed", command.as_printed)] {
        arguments.push_str(if is_set { flag } else { "" });
    }
    for (name, word) in &command.rules {
        arguments.push_str(&format!(" --rule {name}={word}"));
    }
    for (index, (name, _)) in command.rules.iter().enumerate() {
        if command.rules[..index].iter().any(|(other, _)| other == name) {
            return Err(Trouble::Usage(format!("--rule {name} is given twice; expected different rules")));
        }
    }
    refuse_settings_beside_options(command, &overrides.settings)?;
    if !command.record.is_empty() {
        arguments.push_str(&format!(" --record {}", command.record.join(",")));
    }
    if let Some(folder) = &command.stripes {
        arguments.push_str(&format!(" --stripes {}", folder.display()));
    }
    if command.both {
        arguments.push_str(" --both");
    }
    // The default renderer and `--both` need no `--with`.
    let is_default = command.both || names == [default];
    let typed = if is_default { args::DEFAULT_WITH.map(String::from).to_vec() } else { names.clone() };
    arguments.push_str(&typed_renderers(&typed, &command.switches));
    let trouble = |error| Trouble::Drive { scene: command.scene.scene.clone(), error };
    let mut job = DriveJob::new(&loaded, command.scene.at, arguments).map_err(trouble)?;
    if command.as_printed {
        job = job.as_printed(&names.join(",")).map_err(trouble)?;
    }
    for (name, word) in &command.rules {
        job.plan.set_rule(name, word).expect("checked when it was parsed");
    }
    let folder: PathBuf = match &command.output {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(format!("{}-drive", job.name)),
    };
    let output = Arc::new(output_folder(
        &folder,
        "drive",
        &command.scene.scene,
        command.stripes.as_deref().as_slice(),
    )?);
    let stripes = command
        .stripes
        .as_deref()
        .map(|folder| StripeFile::read(folder, job.plan.rig.beams.len()))
        .transpose()?;
    let mut contents = RecordContents::default();
    for word in &command.record {
        contents.add(word).expect("checked when it was parsed");
    }
    let extras = DriveExtras {
        extractor: stripes.map(|file| Arc::new(file) as _),
        record: Some((folder.clone(), contents)),
        output: Some(Arc::clone(&output)),
    };
    drop(spinner);

    let renderers: Vec<_> = contenders.iter().map(|contender| contender.renderer.as_ref()).collect();
    let run = drive::drive_with(&job, &renderers, extras, &FrameBar::new()).map_err(trouble)?;
    let spinner = Spinner::new();
    write_drive(&job, &run, &folder, &spinner)?;
    Arc::into_inner(output).expect("the drive has let go of it").finish()?;
    drop(spinner);
    let document = drive_document(&job, &run);
    say(&if json { document.json() } else { document.screen() });
    if !json {
        let beside = "figures, drive.png, maps (npy, tif, ply, geojson, csv, nav2), junit.xml, summary.md, summary.json";
        say(&format!("  {}\n  beside it: {beside}\n", folder.join("report.html").display()));
    }
    Ok(if run.passes() { Outcome::Fine } else { Outcome::Differs })
}

/// Refuses a setting of what an option of the drive gives, too: one of the two would count, without a word.
fn refuse_settings_beside_options(command: &args::Drive, settings: &[Setting]) -> Result<(), Trouble> {
    let rules = command
        .rules
        .iter()
        .map(|(name, word)| (format!("drive.rules.{name}"), format!("--rule {name}={word}")));
    let to = command.to.first().map(|[x, y]| ("drive.waypoints_m".to_string(), format!("--to {x},{y}")));
    for (key, option) in rules.chain(to) {
        let own = Setting::new(&key, "")?;
        if let Some(setting) = settings.iter().find(|setting| setting.overlaps(&own)) {
            return Err(Trouble::Usage(format!(
                "--set {setting}: {option} sets the same; expected one of the two"
            )));
        }
    }
    Ok(())
}
