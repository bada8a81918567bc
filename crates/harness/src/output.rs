//! The folder that a validation leaves behind, and the screen that a command prints. `docs/report.md`
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

mod junit;
mod light;
mod markdown;
mod outside;
pub(crate) mod picture;
pub(crate) mod plot;
mod report;
pub(crate) mod scale;
mod screen;
mod summary;
mod table;
pub(crate) mod text;
mod verdict;

#[cfg(test)]
pub(crate) mod fixtures;
#[cfg(test)]
pub(crate) mod schema;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, Instant};

use raypencil_scene::{Frame, Sampling, SensorId, SensorMap};
use raypencil_scene_io::{Attributes, ExrMap, SceneIoError, write_atomically, write_exr};

use crate::outside::write_misses;
use crate::pack::PackError;
use crate::run::{Progress, Rendered, Subject, Validation};

pub use screen::one_screen;
pub use summary::summary_json;
pub use text::{count, probe_command, quoted};

/// The version that wrote a folder.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

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

/// Why a folder could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The folder itself, or one in it.
    #[error("{}: cannot create the folder: {source}", path.display())]
    Folder {
        /// Which folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The `summary.json` of an earlier run, which would mark the folder as complete.
    #[error("{}: cannot remove what an earlier run left: {source}", path.display())]
    Earlier {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// One of the files; the message names it.
    #[error(transparent)]
    File(#[from] SceneIoError),
    /// The reproducer of an outsider's miss.
    #[error(transparent)]
    Miss(Box<PackError>),
    /// A renderer's name that cannot be the name of a folder of its own.
    #[error("renderer name `{name}` {problem}: its maps need a folder of their own")]
    Name {
        /// The name.
        name: String,
        /// What is wrong with it.
        problem: &'static str,
    },
}

impl From<PackError> for OutputError {
    fn from(error: PackError) -> Self {
        Self::Miss(Box::new(error))
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
) -> Result<Written, OutputError> {
    let start = Instant::now();
    check_names(&validation.rendered)?;
    begin(folder, "summary.json")?;

    let mut maps = Vec::new();
    for rendered in &validation.rendered {
        progress.stage(&format!("{}: writing maps", rendered.name));
        let folder = folder.join(&rendered.name);
        maps.extend(write_maps(
            &rendered.frame,
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
    let write = |name: &str, contents: String| -> Result<PathBuf, OutputError> {
        let path = folder.join(name);
        write_atomically(&path, |file| file.write_all(contents.as_bytes()))?;
        Ok(path)
    };
    // A template or a document that fails is reported with the file that it was to become.
    let made = |name: &str, contents: Result<String, io::Error>| match contents {
        Ok(contents) => write(name, contents),
        Err(source) => Err(SceneIoError::Io { path: folder.join(name), action: "write", source }.into()),
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
    frame: &Frame,
    renderer: &str,
    subject: &Subject,
    sampling: Sampling,
    folder: &Path,
) -> Result<Vec<PathBuf>, OutputError> {
    create(folder)?;
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
                for (beam, image) in frame.flux.iter().enumerate() {
                    exr.insert_flux(beam, image, model);
                }
            }
            SensorId::Beam(index) => {
                if let Sampling::Jittered { seed } = sampling {
                    let rule =
                        format!("cell (i, j) is a ray drawn within pencil (i, j), seed {seed}; row 0 on top");
                    exr.attributes.insert("pixelRule".into(), rule);
                }
                if let Some(returns) = frame.returns.get(index) {
                    exr.insert_returns(returns, model);
                }
            }
        }
        write_exr(&path, &exr)?;
        Ok(path)
    };
    frame.maps().map(write).collect()
}

/// Where a renderer's map of a sensor goes, from the folder of the validation.
fn map_file(rendered: &Rendered, sensor: SensorId) -> String {
    format!("{}/{sensor}.exr", rendered.name)
}

/// Makes the folder of a run, and takes away the file of an earlier one that would mark the folder as complete. Its
/// place is returned: it is to be written last.
pub(crate) fn begin(folder: &Path, last: &str) -> Result<PathBuf, OutputError> {
    create(folder)?;
    let last = folder.join(last);
    match std::fs::remove_file(&last) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => {
            Err(OutputError::Earlier { path: last, source })
        }
        _ => Ok(last),
    }
}

/// Makes a folder, and those that it lies in, unless it is there.
///
/// # Errors
/// What the file system says, with the folder.
pub fn create(folder: &Path) -> Result<(), OutputError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| OutputError::Folder { path: folder.to_path_buf(), source })
}

/// Refuses names that would lead out of the folder or into one another's.
fn check_names(rendered: &[Rendered]) -> Result<(), OutputError> {
    let mut names = BTreeSet::new();
    for Rendered { name, .. } in rendered {
        let refuse = |problem| Err(OutputError::Name { name: name.clone(), problem });
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
