//! Scenes from names, files and texts.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use raypencil::io::{LoadedScene, Overrides, SceneIoError, Setting, Subject, load, load_text_with, quoted};
use raypencil::pattern::{Keep, Returns};
use raypencil::{Mounted, Pose};

use crate::array::Array;
use crate::failure::Failure;
use crate::mesh::MeshCore;
use crate::rays::set_arrays;
use crate::watch::watched;

/// A scene that was loaded, and what it was loaded from.
#[pyclass(frozen, module = "raypencil._raypencil")]
#[derive(Debug, Clone)]
pub(crate) struct SceneCore {
    pub(crate) loaded: Arc<LoadedScene>,
    /// The words that name it on a command line.
    words: String,
    /// What results are of: name or path of the scene, or that it is a text.
    of: String,
}

impl SceneCore {
    /// The scene as it is tested. `renderers` are the words that choose its renderers.
    pub(crate) fn subject(&self, renderers: &str) -> Subject {
        let LoadedScene { scene, name, source_sha256, .. } = self.loaded.as_ref();
        Subject {
            vehicle: self.loaded.standing_vehicle(),
            scene: scene.clone(),
            name: name.clone(),
            arguments: self.words.clone() + renderers,
            sha256: source_sha256.clone(),
            file_facts: self.loaded.file_facts.clone(),
        }
    }

    /// What results in an output folder are of.
    pub(crate) fn of(&self) -> &str {
        &self.of
    }

    /// The words that name it on a command line.
    pub(crate) fn words(&self) -> &str {
        &self.words
    }
}

/// Position and rotation: (3), and a unit quaternion x, y, z, w.
pub(crate) fn pose_dict<'py>(py: Python<'py>, pose: &Pose) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("position", Array::new(&[3], pose.position.to_array().to_vec()).into_numpy(py)?)?;
    dict.set_item("quaternion", Array::new(&[4], pose.rotation.to_array().to_vec()).into_numpy(py)?)?;
    Ok(dict)
}

/// What camera and beams have in common.
fn mounted_dict<'py, S>(py: Python<'py>, mounted: &Mounted<S>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("scene_from_sensor", pose_dict(py, &mounted.scene_from_sensor)?)?;
    Ok(dict)
}

#[pymethods]
impl SceneCore {
    /// `source`: a built-in name or a path; or, with `is_text`, the text of a scene file, which messages call `name`.toml. Of two
    /// settings that contradict one another the later holds.
    #[new]
    #[pyo3(signature = (source, is_text, name, settings, on_stage=None))]
    fn new(
        py: Python<'_>,
        source: String,
        is_text: bool,
        name: String,
        settings: Vec<(String, String)>,
        on_stage: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        watched(py, on_stage, move |_| {
            let settings = settings
                .iter()
                .map(|(key, value)| Ok(Setting::new(key, value)?.replacing()))
                .collect::<Result<Vec<_>, SceneIoError>>()?;
            let settings = Setting::last_of(settings);
            let of_settings: Vec<String> =
                settings.iter().map(|setting| format!(" --set {}", quoted(&setting.to_string()))).collect();
            let overrides = Overrides { settings, ..Overrides::default() };
            let (loaded, words) = match is_text {
                true => (load_text_with(&source, &name, &overrides)?, quoted(&format!("{name}.toml"))),
                false => (load(&source, &overrides)?, quoted(&source)),
            };
            let of = if is_text { format!("the text {name}") } else { source };
            Ok(Self { loaded: Arc::new(loaded), words: words + &of_settings.concat(), of })
        })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.loaded.name
    }

    /// SHA-256 of the files or the text that define the scene.
    #[getter]
    fn source_sha256(&self) -> &str {
        &self.loaded.source_sha256
    }

    /// SHA-256 of the numbers of the scene.
    #[getter]
    fn sha256(&self) -> &str {
        &self.loaded.scene_sha256
    }

    #[getter]
    fn arguments(&self) -> &str {
        &self.words
    }

    #[getter]
    fn has_drive(&self) -> bool {
        self.loaded.drive.is_some()
    }

    /// The unit of a flux.
    #[getter]
    fn flux_unit(&self) -> &str {
        match self.loaded.scene.flux_model() {
            raypencil::FluxModel::Radiometric => "W",
            raypencil::FluxModel::Eq1 => "W/m",
        }
    }

    /// Global position of the origin of the scene frame, metres.
    #[getter]
    fn origin<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Array::new(&[3], self.loaded.scene.mesh().origin().to_array().to_vec()).into_numpy(py)
    }

    /// Pose of the vehicle, `global_from_vehicle`, if there is one.
    #[getter]
    fn vehicle<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.loaded.standing_vehicle().map(|pose| pose_dict(py, &pose)).transpose()
    }

    /// The terrain, in the scene frame.
    fn mesh(&self, py: Python<'_>) -> MeshCore {
        py.detach(|| MeshCore::of_scene(&self.loaded.scene))
    }

    /// Reflectivity of each face.
    fn reflectivity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mesh = self.loaded.scene.mesh();
        let of = |&material: &u16| mesh.materials()[usize::from(material)].reflectivity;
        let all: Vec<f64> = mesh.face_materials().iter().map(of).collect();
        Array::new(&[all.len()], all).into_numpy(py)
    }

    #[getter]
    fn camera<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mounted = self.loaded.scene.camera();
        let (camera, dict) = (&mounted.sensor, mounted_dict(py, mounted)?);
        dict.set_item("width", camera.width)?;
        dict.set_item("height", camera.height)?;
        dict.set_item("pixel_pitch", (camera.pixel_pitch[0], camera.pixel_pitch[1]))?;
        dict.set_item("focal_length", camera.focal_length)?;
        dict.set_item("principal_point", (camera.principal_point[0], camera.principal_point[1]))?;
        dict.set_item("aperture", camera.aperture)?;
        dict.set_item("transmission", camera.lens.transmission)?;
        dict.set_item("max_range", camera.max_range)?;
        Ok(dict)
    }

    #[getter]
    fn beams<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for mounted in self.loaded.scene.beams() {
            let (beam, dict) = (&mounted.sensor, mounted_dict(py, mounted)?);
            dict.set_item("columns", beam.columns)?;
            dict.set_item("rows", beam.rows)?;
            dict.set_item("thickness", beam.thickness)?;
            dict.set_item("grid_distance", beam.grid_distance)?;
            dict.set_item("half_width", beam.half_width)?;
            dict.set_item("max_range", beam.max_range)?;
            dict.set_item("power", beam.power)?;
            dict.set_item("wavelength", beam.wavelength)?;
            list.append(dict)?;
        }
        Ok(list)
    }

    /// The sets of rays in the scene frame, by name.
    #[getter]
    fn ray_sets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for set in self.loaded.scene.ray_sets() {
            let arrays = set_arrays(set).into_dict(py)?;
            arrays.set_item("fronts_only", set.set.sides() == raypencil::Sides::Fronts)?;
            if let Some(Returns { keep, separation_m }) = set.returns {
                match keep {
                    Keep::First => arrays.set_item("keep", "first")?,
                    Keep::Strongest => arrays.set_item("keep", "strongest")?,
                    Keep::Last => arrays.set_item("keep", "last")?,
                    Keep::UpTo(most) => arrays.set_item("keep", most)?,
                }
                arrays.set_item("separation_m", separation_m)?;
            }
            arrays.set_item("reflectivity", set.echo.reflectivity)?;
            arrays.set_item("extinction_per_m", set.echo.extinction_per_m)?;
            dict.set_item(&set.name, arrays)?;
        }
        Ok(dict)
    }
}

/// A failure of arguments.
pub(crate) fn usage(py: Python<'_>, text: String) -> PyErr {
    Failure::new(text).into_exception(py)
}

/// Refuses settings given together of which one overwrites another, or that describe one thing in two ways.
#[pyfunction]
pub(crate) fn refuse_contradictions(py: Python<'_>, settings: Vec<(String, String)>) -> PyResult<()> {
    let parsed: Result<Vec<Setting>, SceneIoError> =
        settings.iter().map(|(key, value)| Setting::new(key, value)).collect();
    let checked = parsed.and_then(|settings| raypencil::io::refuse_contradictions(&settings));
    checked.map_err(|error| Failure::from(error).into_exception(py))
}
