//! What somebody recorded of a scene: maps for `check`, and what only another kind of renderer has.

use std::path::{Path, PathBuf};

use crate::estimate::{Estimate, WayImage};
use raypencil_files::{Channels, Values};
use raypencil_judge::{Recorded, RecordingError};
use raypencil_pack::{Provenance, ProvenanceError, note, precision_of};
use raypencil_scene::{Image, Precision, Scene, SensorId};

/// Why a candidate could not be held to a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CandidateError {
    /// The note of what made it; the message names the file.
    #[error(transparent)]
    Provenance(#[from] ProvenanceError),
    /// Its files; the message names the file, the channel and the cell.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

/// A recording by somebody else.
#[derive(Debug, Clone)]
pub struct Outsider {
    /// The program, or the name of the folder if nothing tells.
    pub name: String,
    /// Where it was read.
    pub folder: PathBuf,
    /// Its maps.
    pub recorded: Recorded,
    /// Its images by chance.
    pub images: Vec<WayImage>,
    /// Its radiance.
    pub radiance: Vec<RadianceMap>,
}

/// Radiance of one beam's light along rays of a sensor, W m^-2 sr^-1. Of the camera: along its rays. Of the beam: from
/// what each pencil hits towards the camera, NaN where it hits nothing.
#[derive(Debug, Clone)]
pub struct RadianceMap {
    /// Which rays.
    pub sensor: SensorId,
    /// Which beam's light.
    pub beam: usize,
    /// The radiance.
    pub image: Image<f64>,
}

impl Outsider {
    /// Reads what somebody recorded of a scene. How finely it computes its own note says; without one, double precision.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions; a recording of another scene.
    pub fn read(folder: &Path, scene: &Scene) -> Result<Self, CandidateError> {
        let note = note(folder, scene)?;
        let precision = note.as_ref().map_or(Precision::F64, |note| precision_of(note.arithmetic));
        let channels = Recorded::channels(folder, scene)?;
        let recorded = Recorded::of_folder(folder, scene, precision, &channels)?;
        let name = note.as_ref().map_or_else(|| recorded.name.clone(), |note| note.program.clone());
        let reader = Extras { folder, scene, channels: &channels };
        let images = reader.images(note.as_ref())?;
        let radiance = reader.radiance()?;
        Ok(Self { name, folder: folder.to_path_buf(), recorded, images, radiance })
    }
}

/// What is beside the maps.
struct Extras<'a> {
    folder: &'a Path,
    scene: &'a Scene,
    channels: &'a Channels,
}

impl Extras<'_> {
    fn images(&self, note: Option<&Provenance>) -> Result<Vec<WayImage>, CandidateError> {
        let mut images = Vec::new();
        let camera = SensorId::Camera.to_string();
        for key in self.channels.by_key.keys() {
            let Some((way, beam)) = key.strip_prefix(&format!("{camera}/")).and_then(|name| {
                let (way, beam) = name.split_once(".mean.beam")?;
                Some((way, beam.parse::<usize>().ok().filter(|beam| *beam < self.scene.beams().len())?))
            }) else {
                continue;
            };
            let mean = self.reals(SensorId::Camera, &format!("{way}.mean.beam{beam}"))?;
            let name = format!("{way}.error.beam{beam}");
            let (Some(mean), Some(error)) = (mean, self.reals(SensorId::Camera, &name)?) else {
                return Err(RecordingError::Part {
                    folder: self.folder.to_path_buf(),
                    channel: format!("{camera}/{name}"),
                    all: format!("{way}.mean.beam{beam} and {way}.error.beam{beam}"),
                }
                .into());
            };
            let totals = note.iter().flat_map(|note| &note.totals);
            let total = totals.clone().find(|total| total.way == way && total.beam == beam);
            let estimate = match total {
                Some(total) => Estimate { mean, error, total: total.mean, total_error: total.error },
                None => Estimate::of_independent_pixels(mean, error),
            };
            images.push(WayImage { way: way.to_string(), beam, estimate });
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

    /// A channel of real numbers of the sensor's size, if it is there.
    fn reals(&self, sensor: SensorId, name: &str) -> Result<Option<Image<f64>>, CandidateError> {
        let Some(channel) = self.channels.by_key.get(&format!("{sensor}/{name}")) else { return Ok(None) };
        let fault = |found: String, expected: String| {
            RecordingError::Channel {
                file: channel.file.clone(),
                channel: name.to_string(),
                cell: None,
                found,
                expected,
            }
            .into()
        };
        let Values::Reals(image) = &channel.values else {
            return Err(fault("whole numbers".into(), "floating-point numbers".into()));
        };
        let (width, height) = self.scene.size(sensor).expect("a sensor of this scene");
        if (image.width(), image.height()) != (width, height) {
            let found = format!("{} x {} cells", image.width(), image.height());
            return Err(fault(found, format!("{width} x {height}, as the scene's {sensor} has")));
        }
        Ok(Some(image.clone()))
    }
}
