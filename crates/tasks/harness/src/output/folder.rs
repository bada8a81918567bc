//! Writes the folder of a validation:
//!
//! ```text
//! DIR/<renderer>/camera.exr, beam-N.exr    the maps
//! DIR/rays/NAME/                           a set of rays, answered exactly, as `cast` writes it
//! DIR/misses/NAME-K/                       a candidate's miss, as a pack of that ray
//! DIR/report.html                          for people: one file, pictures inside
//! DIR/summary.md                           for a comment on a pull request
//! DIR/junit.xml                            for CI
//! DIR/summary.json                         for programs; written last, it marks a complete folder
//! ```

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, Instant};

use raypencil_files::{
    Attributes, ExrMap, FileError, FolderError, begin_output_folder, create_folder, write_atomically,
    write_exr,
};
use raypencil_pack::PackError;
use raypencil_scene::{Progress, RenderOutput, Sampling, SensorId, SensorMap, Triangles};
use raypencil_scene_io::{Subject, scene_sha256};

use crate::misses::{MAX_MISSES, write_misses};
use crate::ray_sets::write_ray_set;
use crate::rendered::Rendered;
use crate::validation::Validation;

/// The files that [`write_validation`] wrote.
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
    /// Wall-clock time of the writing.
    pub time: Duration,
}

/// Why the folder of a validation could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HarnessError {
    /// The folder or one of its files; the message names it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The pack of a candidate's miss.
    #[error(transparent)]
    Miss(#[from] PackError),
    /// A renderer's name that cannot be the name of its folder.
    #[error("renderer name `{name}` {problem}: its maps need a folder of their own")]
    Name {
        /// The name.
        name: String,
        /// The problem with it.
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
/// Each file is written under a temporary name and then renamed. The `summary.json` of an earlier run is removed first,
/// so that the file marks a complete folder even after an interruption. Other files of the folder are not touched.
///
/// # Errors
/// A file or folder that could not be written; the message names it and the reason.
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

    for report in validation.scoreboard.iter().flat_map(|scoreboard| &scoreboard.candidates) {
        write_misses(&validation.subject, report, (&folder.join("misses"), MAX_MISSES), progress)?;
    }

    let subject = &validation.subject;
    if !validation.ray_sets.is_empty() {
        progress.stage("writing sets of rays");
        let mesh = Triangles::from(subject.scene.mesh().as_ref());
        for result in &validation.ray_sets {
            let set = &subject.scene.ray_sets()[result.index];
            write_ray_set(subject, set, &mesh, &result.answers, folder)?;
        }
    }

    progress.stage("writing the report");
    let write = |name: &str, contents: &str| -> Result<PathBuf, HarnessError> {
        let path = folder.join(name);
        write_atomically(&path, |file| file.write_all(contents.as_bytes()))?;
        Ok(path)
    };
    // A failed template is reported with the file that it was for.
    let failed = |name: &str, source| FileError::Io { path: folder.join(name), action: "write", source };
    let document = validation.document_with_pictures();
    let document = document.map_err(|error| failed("report.html", io::Error::other(error)))?;
    let files = document.files("summary.json").map_err(|(name, error)| failed(name, error))?;
    let paths = files.iter().map(|(name, contents)| write(name, contents)).collect::<Result<Vec<_>, _>>()?;
    let [report, junit, markdown, summary] = <[PathBuf; 4]>::try_from(paths).expect("four files");
    Ok(Written { maps, report, markdown, junit, summary, time: start.elapsed() })
}

/// Writes one renderer's maps of every sensor, `camera.exr`, `beam-0.exr`, ..., into `folder` and returns their paths.
/// `sampling` is that of the request that `output` was rendered for.
///
/// # Errors
/// A file or folder that could not be written; the message names it and the reason.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// use raypencil_harness::{contender, write_maps};
/// use raypencil_scene::{Request, Sampling};
/// # use raypencil_scene::{Atmosphere, FluxModel, Scene, rig};
/// # use raypencil_scene_io::Subject;
///
/// # let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
/// # let subject = Subject {
/// #     scene,
/// #     name: "small".into(),
/// #     arguments: "small.toml".into(),
/// #     sha256: "0".repeat(64),
/// #     vehicle: None,
/// #     file_facts: Default::default(),
/// # };
/// # let folder = tempfile::tempdir()?;
/// let tracer = contender("tracer").expect("a renderer's name").renderer;
/// let output = tracer.render(&subject.scene, &Request::EVERYTHING);
/// let files = write_maps(&output, "tracer", &subject, Sampling::Centres, folder.path())?;
/// // The scene has the default rig: a camera and two beams.
/// let names: Vec<_> = files.iter().filter_map(|file| file.file_name()?.to_str()).collect();
/// assert_eq!(names, ["camera.exr", "beam-0.exr", "beam-1.exr"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
        scene_sha256: scene_sha256(&subject.scene),
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

/// Refuses names of renderers that are not the name of one folder, or that two renderers share.
fn check_names(rendered: &[Rendered]) -> Result<(), HarnessError> {
    let mut names = BTreeSet::new();
    for Rendered { name, .. } in rendered {
        let refuse = |problem| Err(HarnessError::Name { name: name.clone(), problem });
        let mut components = Path::new(name).components();
        let only = (components.next(), components.next());
        if !matches!(only, (Some(Component::Normal(part)), None) if part == OsStr::new(name)) {
            return refuse("cannot be the name of a folder");
        }
        if !names.insert(name) {
            return refuse("is used twice");
        }
    }
    Ok(())
}
