//! One run: the scene with its settings, rendered, compared or driven over.

use std::path::Path;

use raypencil_drive::{DriveExtras, DriveJob, DriveProgress, drive_json, drive_with};
use raypencil_harness::{Contender, Validator, write_maps};
use raypencil_judge::JudgeShare;
use raypencil_scene::{Request, Sampling, Silent};
use raypencil_scene_io::{Grounds, LoadedScene, Overrides, Setting, load_sharing, quoted};

use crate::error::SweepError;
use crate::plan::{Sweep, Task};
use crate::record::Outcome;
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
        frames: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Outcome, SweepError> {
        let settings = self.sweep.settings(number)?;
        let overrides = Overrides { settings: settings.clone(), ..Overrides::default() };
        let loaded = match load_sharing(&self.sweep.scene, &overrides, &self.grounds) {
            Ok(loaded) => loaded,
            Err(error) => return Ok(Outcome::refused(&error.to_string())),
        };
        let arguments = arguments(&self.sweep.scene, &settings);
        match self.sweep.task {
            Task::Validate => Ok(Outcome::Results(self.validate(loaded, arguments))),
            Task::Render => {
                let maps = folder.join("maps").join(format!("{number:06}"));
                Ok(Outcome::Results(self.render(loaded, arguments, &maps)?))
            }
            Task::Drive => Ok(self.drive(&loaded, arguments, frames)),
        }
    }

    fn validate(&mut self, loaded: LoadedScene, arguments: String) -> Vec<Named> {
        let subject = loaded.into_subject(arguments);
        validation_results(&self.validator.validate(subject, self.contenders, JudgeShare::Sample, &Silent))
    }

    fn render(&self, loaded: LoadedScene, arguments: String, maps: &Path) -> Result<Vec<Named>, SweepError> {
        let subject = loaded.into_subject(arguments);
        let renderer = &self.contenders[0].renderer;
        let output = renderer.render(&subject.scene, &Request::EVERYTHING);
        write_maps(&output, renderer.name(), &subject, Sampling::Centres, maps)?;
        Ok(light_results(&output, subject.scene.flux_model()))
    }

    fn drive(&self, loaded: &LoadedScene, arguments: String, frames: &(dyn Fn(u64, u64) + Sync)) -> Outcome {
        let driven = || {
            let mut job = DriveJob::new(loaded, None, arguments)?;
            if self.sweep.as_printed {
                job = job.as_printed()?;
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
