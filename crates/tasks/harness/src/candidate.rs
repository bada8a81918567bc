//! Candidates: recordings that other people's renderers made of a scene. Maps are judged as by `check`; Monte Carlo
//! images and radiance are what only another kind of renderer has.

use std::path::{Path, PathBuf};

use raypencil_cast::{CandidateConventions, Stated, read_stated};
use raypencil_files::{Channels, Fault, FileError, Storage, Values, harmless_line, has_maps};
use raypencil_judge::{Recorded, RecordingError};
use raypencil_pack::{Declarations, Provenance, ProvenanceError, note};
use raypencil_scene::{Image, NamedRaySet, Scene, SensorId};

use crate::estimate::{Estimate, MonteCarloImage};

/// Why a candidate could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CandidateError {
    /// Its `candidate.json`; the message names the file.
    #[error(transparent)]
    Provenance(#[from] ProvenanceError),
    /// Its files; the message names the file, the channel and the cell.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// Its answers to a set of rays; the message names the file.
    #[error(transparent)]
    Rays(#[from] FileError),
}

impl CandidateError {
    /// What to declare so that the candidate is understood, if that may help.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Recording(error) => error.help(),
            Self::Provenance(_) | Self::Rays(_) => None,
        }
    }
}

/// A recording of a scene by another program.
///
/// [`Candidate::read`] reads one from a folder.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Name of the program as `candidate.json` gives it; without that file, the folder's name.
    pub name: String,
    /// The folder that it was read from.
    pub folder: PathBuf,
    /// What was declared about it beside its `candidate.json`.
    pub declared: Declarations,
    /// The maps.
    pub recorded: Recorded,
    /// The Monte Carlo images of the camera.
    pub images: Vec<MonteCarloImage>,
    /// The radiance maps.
    pub radiance: Vec<RadianceMap>,
    /// Its answers to sets of rays: one for each set of the scene of which it has a folder `rays/NAME`.
    pub ray_sets: Vec<StatedRaySet>,
}

/// What a candidate states of a set of rays.
#[derive(Debug, Clone)]
pub struct StatedRaySet {
    /// Index of the set in the scene.
    pub index: usize,
    /// Name of the set.
    pub name: String,
    /// What is stated.
    pub stated: Stated,
}

/// Radiance of one beam's light along the rays of a sensor, W m^-2 sr^-1.
///
/// A camera's map has the radiance along its own rays. A beam's map has the radiance from each pencil's hit point
/// towards the camera, NaN where the pencil hits nothing.
#[derive(Debug, Clone)]
pub struct RadianceMap {
    /// The sensor whose rays these are.
    pub sensor: SensorId,
    /// Index of the beam whose light it is.
    pub beam: usize,
    /// The radiance, one value per cell of the sensor.
    pub image: Image<f64>,
}

impl Candidate {
    /// Reads a recording of `scene` from a folder. `candidate.json` in it states the precision; without that file it is
    /// double precision.
    ///
    /// # Errors
    /// A file, channel or cell that breaks the conventions (the message names it), or a recording of another scene.
    ///
    /// ```
    /// # use std::path::Path;
    /// use raypencil_harness::Candidate;
    /// # use raypencil_scene::Precision;
    /// use raypencil_scene_io::{Overrides, load};
    ///
    /// # let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data");
    /// let scene = data.join("packs/pyramids/scene.toml");
    /// let scene = load(&scene.to_string_lossy(), &Overrides::default())?.scene;
    /// let embree = Candidate::read(&data.join("candidates/embree/pyramids"), &scene)?;
    /// // Its candidate.json says "Embree 4" and "f32". Embree answers rays and has no integrator, so no images.
    /// assert_eq!((embree.name.as_str(), embree.recorded.precision), ("Embree 4", Precision::F32));
    /// assert!(embree.images.is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn read(folder: &Path, scene: &Scene) -> Result<Self, CandidateError> {
        Self::read_as(folder, scene, &Declarations::default())
    }

    /// The same for a recording about which more is declared than its `candidate.json` says.
    ///
    /// # Errors
    /// As [`Candidate::read`]; something declared that is not so.
    pub fn read_as(
        folder: &Path,
        scene: &Scene,
        declarations: &Declarations,
    ) -> Result<Self, CandidateError> {
        let note = note(folder, scene)?;
        let declared = declarations.clone().with_note(note.as_ref());
        let ray_sets = stated_ray_sets(folder, scene, &declared)?;
        let (channels, recorded) = match ray_sets.is_empty() || has_maps(folder)? {
            true => {
                let channels = Recorded::channels(folder, scene, &declared.declared())?;
                let (precision, conventions) = (declared.precision(), declared.conventions());
                let recorded = Recorded::of_folder(folder, scene, precision, &channels, conventions)?;
                (channels, recorded)
            }
            // It answers nothing but sets of rays.
            false => (Channels::default(), Recorded::without_maps(folder, scene, declared.precision())),
        };
        let name =
            note.as_ref().and_then(|note| note.program.clone()).unwrap_or_else(|| recorded.name.clone());
        // Reports name the program, not its folder. A line break in it would look like a line of the report's own.
        let name = harmless_line(&name);
        let recorded = Recorded { name: name.clone(), ..recorded };
        let reader = ExtraChannels { folder, scene, channels: &channels };
        let images = reader.images(note.as_ref())?;
        let radiance = reader.radiance()?;
        let declared = declarations.clone();
        Ok(Self { name, folder: folder.to_path_buf(), declared, recorded, images, radiance, ray_sets })
    }
}

/// Reads what a folder states of the sets of rays of a scene.
fn stated_ray_sets(
    folder: &Path,
    scene: &Scene,
    declared: &Declarations,
) -> Result<Vec<StatedRaySet>, FileError> {
    let conventions = CandidateConventions {
        miss: declared.miss,
        ignores_faces: declared.ignores_faces,
        ..CandidateConventions::default()
    };
    refuse_other_sets(folder, scene.ray_sets().iter().map(|set| set.name.as_str()))?;
    let given = |(index, set): (usize, &NamedRaySet)| {
        let of_set = folder.join("rays").join(&set.name);
        let stated = of_set.is_dir().then(|| read_stated(&of_set, &set.shape, conventions));
        Some(stated?.map(|stated| StatedRaySet { index, name: set.name.clone(), stated }))
    };
    scene.ray_sets().iter().enumerate().filter_map(given).collect()
}

/// Whether a folder has arrays.
fn has_arrays(folder: &Path) -> bool {
    let is_array = |path: PathBuf| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npy"));
    std::fs::read_dir(folder).is_ok_and(|entries| entries.flatten().any(|entry| is_array(entry.path())))
}

/// Refuses answers to a set of rays that is not asked for: nobody would judge them.
pub(crate) fn refuse_other_sets<'n>(
    folder: &Path,
    asked: impl Iterator<Item = &'n str> + Clone,
) -> Result<(), FileError> {
    let of_sets = folder.join("rays");
    if !of_sets.is_dir() {
        return Ok(());
    }
    let failed = |error| FileError::io(&of_sets, "read", error);
    let mut sets: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(&of_sets).map_err(failed)? {
        sets.push(entry.map_err(failed)?.path());
    }
    sets.sort();
    for set in sets.iter().filter(|set| has_arrays(set)) {
        let name = set.file_name().unwrap_or_default().to_string_lossy();
        if !asked.clone().any(|asked| asked == name) {
            let names: Vec<&str> = asked.clone().collect();
            let expected = match names.as_slice() {
                [] => "no sets of rays: this scene asks for none (those of a pack are judged by `raypencil check PACK CANDIDATE`)".into(),
                names => format!("answers to {}", names.join(", ")),
            };
            let fault = Fault::new("rays", format!("answers to a set `{name}`"), expected);
            return Err(FileError::Recording(fault.in_file(set)));
        }
    }
    Ok(())
}

/// Reads what a recording has beside the maps.
struct ExtraChannels<'a> {
    folder: &'a Path,
    scene: &'a Scene,
    channels: &'a Channels,
}

impl ExtraChannels<'_> {
    fn images(&self, note: Option<&Provenance>) -> Result<Vec<MonteCarloImage>, CandidateError> {
        let mut images = Vec::new();
        let camera = SensorId::Camera.to_string();
        for key in self.channels.by_key.keys() {
            let Some((integrator, beam)) = key.strip_prefix(&format!("{camera}/")).and_then(|name| {
                let (integrator, beam) = name.split_once(".mean.beam")?;
                Some((
                    integrator,
                    beam.parse::<usize>().ok().filter(|beam| *beam < self.scene.beams().len())?,
                ))
            }) else {
                continue;
            };
            let mean = self.reals(SensorId::Camera, &format!("{integrator}.mean.beam{beam}"))?;
            let name = format!("{integrator}.error.beam{beam}");
            let (Some(mean), Some(error)) = (mean, self.reals(SensorId::Camera, &name)?) else {
                return Err(RecordingError::Part {
                    folder: self.folder.to_path_buf(),
                    channel: format!("{camera}/{name}"),
                    all: format!("{integrator}.mean.beam{beam} and {integrator}.error.beam{beam}"),
                }
                .into());
            };
            let totals = note.iter().flat_map(|note| &note.totals);
            let total = totals.clone().find(|total| total.integrator == integrator && total.beam == beam);
            let estimate = match total {
                Some(total) => Estimate { mean, error, total: total.mean, total_error: total.error },
                None => Estimate::of_independent_pixels(mean, error),
            };
            images.push(MonteCarloImage { integrator: integrator.to_string(), beam, estimate });
        }
        Ok(images)
    }

    fn radiance(&self) -> Result<Vec<RadianceMap>, CandidateError> {
        let mut maps = Vec::new();
        for beam in 0..self.scene.beams().len() {
            let own = SensorId::Beam(beam);
            for (sensor, name) in
                [(SensorId::Camera, format!("radiance.beam{beam}")), (own, "radiance.V".into())]
            {
                if let Some(image) = self.reals(sensor, &name)? {
                    maps.push(RadianceMap { sensor, beam, image });
                }
            }
        }
        Ok(maps)
    }

    /// A channel of floating-point numbers with the sensor's size; `None` if it is absent.
    fn reals(&self, sensor: SensorId, name: &str) -> Result<Option<Image<f64>>, CandidateError> {
        let Some(channel) = self.channels.by_key.get(&format!("{sensor}/{name}")) else { return Ok(None) };
        let fault = |found: String, expected: String| {
            RecordingError::Channel {
                file: channel.file.clone(),
                channel: name.to_string(),
                cell: None,
                found,
                expected,
                help: None,
            }
            .into()
        };
        let Values::Reals(image) = &channel.values else {
            return Err(fault("whole numbers".into(), "floating-point numbers".into()));
        };
        if channel.storage == Storage::F16 {
            // Watts per pixel vanish in half precision, and its digits are fewer than the limits of both tests ask for.
            let expected = "single or double precision: half precision cannot hold these numbers";
            return Err(fault("half precision".into(), expected.into()));
        }
        let (width, height) = self.scene.size(sensor).expect("a sensor of this scene");
        if (image.width(), image.height()) != (width, height) {
            let found = format!("{} x {} cells", image.width(), image.height());
            return Err(fault(found, format!("{width} x {height}, as the scene's {sensor} has")));
        }
        Ok(Some(image.clone()))
    }
}
