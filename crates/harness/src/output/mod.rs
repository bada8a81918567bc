//! The folder that a validation leaves behind, and the screen that a command prints. `docs/guide/report.md`
//! describes both.
//!
//! ```text
//! DIR/<renderer>/camera.exr, beam-N.exr    the maps
//! DIR/report.html                          for people: one file, pictures inside
//! DIR/summary.md                           for a comment on a change
//! DIR/misses/NAME-K/                     a miss of an outsider as a pack of its one ray
//! DIR/junit.xml                            for CI
//! DIR/summary.json                         for programs; written last, it marks a complete folder
//! ```

pub(crate) mod junit;
pub(crate) mod light;
pub(crate) mod markdown;
pub(crate) mod panel;
pub(crate) mod plots;
pub(crate) mod report;
pub(crate) mod screen;
pub(crate) mod summary;
pub(crate) mod table;
pub(crate) mod verdict;

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, Instant};

use crate::misses::write_misses;
use crate::rendered::Rendered;
use crate::validation::Validation;
use raypencil_files::{
    Attributes, ExrMap, FileError, FolderError, begin_output_folder, create_folder, write_atomically,
    write_exr,
};
use raypencil_pack::PackError;
use raypencil_scene::{Progress, RenderOutput, Sampling, SensorId, SensorMap};
use raypencil_scene_io::Subject;

pub use crate::output::summary::summary_json;

/// The version that wrote a folder.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What [`write_validation`] wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The maps of every renderer.
    pub maps: Vec<PathBuf>,
    /// `report.html`.
    pub report: PathBuf,
    /// `summary.md`.
    pub markdown: PathBuf,
    /// `junit.xml`.
    pub junit: PathBuf,
    /// `summary.json`.
    pub summary: PathBuf,
    /// Wall-clock time of it all.
    pub time: Duration,
}

/// Why the folder of a validation could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HarnessError {
    /// The folder or one of its files; the message names it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The pack of one ray that a candidate misses.
    #[error(transparent)]
    Miss(#[from] PackError),
    /// A renderer's name that cannot be the name of a folder of its own.
    #[error("renderer name `{name}` {problem}: its maps need a folder of their own")]
    Name {
        /// The name.
        name: String,
        /// What is wrong with it.
        problem: &'static str,
    },
}

impl From<FileError> for HarnessError {
    fn from(error: FileError) -> Self {
        Self::Folder(error.into())
    }
}

/// Writes the maps of every renderer, `report.html`, `summary.md`, `junit.xml`, and last `summary.json`.
///
/// Each file is written beside its place and renamed. The `summary.json` of an earlier run is removed before
/// anything else is written, so that the file marks a complete folder whatever happens in between. Other
/// files of the folder are left alone.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_validation(
    validation: &Validation,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Written, HarnessError> {
    let start = Instant::now();
    check_names(&validation.rendered)?;
    begin_output_folder(folder, "summary.json")?;

    let mut maps = Vec::new();
    for rendered in &validation.rendered {
        progress.stage(&format!("{}: writing maps", rendered.name));
        let folder = folder.join(&rendered.name);
        maps.extend(write_maps(
            &rendered.output,
            &rendered.name,
            &validation.subject,
            Sampling::Centres,
            &folder,
        )?);
    }

    for held in validation.panel.iter().flat_map(|panel| &panel.outsiders) {
        write_misses(&validation.subject, held, &folder.join("misses"), progress)?;
    }

    progress.stage("writing the report");
    let write = |name: &str, contents: String| -> Result<PathBuf, HarnessError> {
        let path = folder.join(name);
        write_atomically(&path, |file| file.write_all(contents.as_bytes()))?;
        Ok(path)
    };
    // A template or a document that fails is reported with the file that it was to become.
    let made = |name: &str, contents: Result<String, io::Error>| match contents {
        Ok(contents) => write(name, contents),
        Err(source) => Err(FileError::Io { path: folder.join(name), action: "write", source }.into()),
    };
    let report = made("report.html", report::html(validation).map_err(io::Error::other))?;
    let markdown = made("summary.md", markdown::markdown(validation).map_err(io::Error::other))?;
    let junit = made("junit.xml", junit::junit(validation).map_err(io::Error::other))?;
    let summary = write("summary.json", summary_json(validation))?;
    Ok(Written { maps, report, markdown, junit, summary, time: start.elapsed() })
}

/// Writes one renderer's maps of every sensor, `camera.exr`, `beam-0.exr` ..., into `folder`. `sampling` is what the
/// frame was rendered with.
///
/// # Errors
/// Names the file or folder that could not be written, and why.
pub fn write_maps(
    output: &RenderOutput,
    renderer: &str,
    subject: &Subject,
    sampling: Sampling,
    folder: &Path,
) -> Result<Vec<PathBuf>, HarnessError> {
    create_folder(folder)?;
    let attributes = Attributes {
        renderer: renderer.to_string(),
        scene_sha256: subject.sha256.clone(),
        extra: Vec::new(),
    };
    let model = subject.scene.flux_model();
    let write = |map: &SensorMap| {
        let path = folder.join(format!("{}.exr", map.sensor));
        let mut exr = ExrMap::from_sensor_map(map, &attributes);
        match map.sensor {
            SensorId::Camera => {
                for (beam, image) in output.flux.iter().enumerate() {
                    exr.insert_flux(beam, image, model);
                }
            }
            SensorId::Beam(index) => {
                if let Sampling::Jittered { seed } = sampling {
                    let rule =
                        format!("cell (i, j) is a ray drawn within pencil (i, j), seed {seed}; row 0 on top");
                    exr.attributes.insert("pixelRule".into(), rule);
                }
                if let Some(returns) = output.returns.get(index) {
                    exr.insert_returns(returns, model);
                }
            }
        }
        write_exr(&path, &exr)?;
        Ok(path)
    };
    output.maps().map(write).collect()
}

/// Where a renderer's map of a sensor goes, from the folder of the validation.
pub(crate) fn map_file(rendered: &Rendered, sensor: SensorId) -> String {
    format!("{}/{sensor}.exr", rendered.name)
}

/// Refuses names that would lead out of the folder or into one another's.
fn check_names(rendered: &[Rendered]) -> Result<(), HarnessError> {
    let mut names = BTreeSet::new();
    for Rendered { name, .. } in rendered {
        let refuse = |problem| Err(HarnessError::Name { name: name.clone(), problem });
        let mut components = Path::new(name).components();
        let only = (components.next(), components.next());
        if !matches!(only, (Some(Component::Normal(part)), None) if part == OsStr::new(name)) {
            return refuse("is fit for no folder");
        }
        if !names.insert(name) {
            return refuse("is there twice");
        }
    }
    Ok(())
}
