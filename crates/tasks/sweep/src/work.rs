//! One run: the scene with its settings, rendered, compared or driven over.

use std::path::{Path, PathBuf};

use raypencil_drive::{DriveExtras, DriveJob, DriveProgress, drive_json, drive_with};
use raypencil_files::{OutputFolder, program_sha256};
use raypencil_harness::{Contender, Validator, write_maps};
use raypencil_judge::JudgeShare;
use raypencil_scene::{Request, Sampling, Silent};
use raypencil_scene_io::{
    Grounds, InputFile, LoadedScene, Overrides, SceneInputs, Setting, load_sharing, quoted,
};

use crate::error::SweepError;
use crate::plan::{Sweep, Task};
use crate::record::{Outcome, Record, maps_folder};
use crate::results::{Named, drive_results, light_results, validation_results};

/// Number of grounds that are kept: one for the run, and one for a scene that goes back and forth.
const KEPT_GROUNDS: usize = 2;

/// Receives the frames of a drive.
pub(crate) struct Frames<'a>(pub(crate) &'a (dyn Fn(u64, u64) + Sync));

impl DriveProgress for Frames<'_> {
    fn frames(&self, done: u64, planned: u64) {
        (self.0)(done, planned);
    }

    fn scan(&self, _done: u64, _planned: u64) {}
}

/// Makes run after run. Grounds, and what renderers and referee have made of them, are kept from one to the next.
pub(crate) struct Worker<'a> {
    sweep: &'a Sweep,
    contenders: &'a [Contender],
    grounds: Grounds,
    validator: Validator,
}

impl<'a> Worker<'a> {
    pub(crate) fn new(sweep: &'a Sweep, contenders: &'a [Contender]) -> Self {
        Self { sweep, contenders, grounds: Grounds::new(KEPT_GROUNDS), validator: Validator::default() }
    }

    /// Makes a run. A scene or a drive that is refused is an outcome; a file that cannot be written is an error.
    pub(crate) fn run(
        &mut self,
        number: u64,
        folder: &Path,
        inputs: &SceneInputs,
        frames: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Record, SweepError> {
        let settings = self.sweep.settings(number)?;
        // Before they are read: a file that changes meanwhile is then another one the next time.
        let inputs = inputs.of(&self.sweep.scene, &settings).unwrap_or_default();
        let record = Record {
            program: program_sha256().to_string(),
            inputs,
            left: Vec::new(),
            outcome: Outcome::Results(Vec::new()),
        };
        let overrides = Overrides { settings: settings.clone(), ..Overrides::default() };
        let loaded = match load_sharing(&self.sweep.scene, &overrides, &self.grounds) {
            Ok(loaded) => loaded,
            Err(error) => return Ok(Record { outcome: Outcome::refused(&error.to_string()), ..record }),
        };
        let arguments = arguments(&self.sweep.scene, &settings);
        let outcome = match self.sweep.task {
            Task::Validate => Outcome::Results(self.validate(loaded, arguments)),
            Task::Render => {
                let (results, left) = self.render(loaded, arguments, folder, &maps_folder(number))?;
                return Ok(Record { outcome: Outcome::Results(results), left, ..record });
            }
            Task::Drive => self.drive(&loaded, arguments, frames),
        };
        Ok(Record { outcome, ..record })
    }

    fn validate(&mut self, loaded: LoadedScene, arguments: String) -> Vec<Named> {
        let subject = loaded.into_subject(arguments);
        validation_results(&self.validator.validate(subject, self.contenders, JudgeShare::Sample, &Silent))
    }

    /// Renders, and writes the maps in place of those of an earlier run of that number. They are returned as files of `folder`.
    fn render(
        &self,
        loaded: LoadedScene,
        arguments: String,
        folder: &Path,
        maps: &str,
    ) -> Result<(Vec<Named>, Vec<InputFile>), SweepError> {
        let subject = loaded.into_subject(arguments);
        let renderer = &self.contenders[0].renderer;
        let output = renderer.render(&subject.scene, &Request::EVERYTHING);
        let written = OutputFolder::begin(&folder.join(maps))?;
        write_maps(&output, renderer.name(), &subject, Sampling::Centres, &folder.join(maps))?;
        let file = |(name, sha256): (PathBuf, String)| InputFile {
            name: format!("{maps}/{}", name.display()),
            sha256,
        };
        let left = written.written().into_iter().map(file).collect();
        written.finish()?;
        Ok((light_results(&output, subject.scene.flux_model()), left))
    }

    fn drive(&self, loaded: &LoadedScene, arguments: String, frames: &(dyn Fn(u64, u64) + Sync)) -> Outcome {
        let driven = || {
            let mut job = DriveJob::new(loaded, None, arguments)?;
            if self.sweep.as_printed {
                job = job.as_printed(&self.sweep.renderers.join(","))?;
            }
            let renderers: Vec<_> =
                self.contenders.iter().map(|contender| contender.renderer.as_ref()).collect();
            let run = drive_with(&job, &renderers, DriveExtras::default(), &Frames(frames))?;
            Ok::<_, raypencil_drive::DriveError>(drive_json(&job, &run))
        };
        match driven() {
            Ok(summary) => {
                let summary = serde_json::from_str(&summary).expect("JSON that was just written");
                Outcome::Results(drive_results(&summary))
            }
            Err(error) => Outcome::refused(&error.to_string()),
        }
    }
}

/// Words after `raypencil validate` that give the scene of a run.
pub(crate) fn arguments(scene: &str, settings: &[Setting]) -> String {
    let settings = settings.iter().map(|setting| format!(" --set {}", quoted(&setting.to_string())));
    quoted(scene) + &settings.collect::<String>()
}
