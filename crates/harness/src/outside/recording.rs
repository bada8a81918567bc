//! What somebody recorded of a scene: maps for `check`, and what only another kind of renderer has.

use std::path::{Path, PathBuf};

use raypencil_scene::{Image, Resolution, Scene, SensorId};
use raypencil_scene_io::{Arithmetic, Channels, Provenance, SceneIoError, Values, scene_sha256};

use super::chance::Estimate;
use crate::recorded::{Recorded, RecordingError};

/// Why a recording could not be held to a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutsideError {
    /// The note of what made it; the message names the file.
    #[error(transparent)]
    Note(#[from] SceneIoError),
    /// Its files; the message names the file, the channel and the cell.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// It answers another scene.
    #[error(
        "{}: its candidate.json is of the scene {theirs}; expected {ours}, the resolved scene that it is held to",
        folder.display()
    )]
    OtherScene {
        /// The recording.
        folder: PathBuf,
        /// The digest that it names.
        theirs: String,
        /// That of the scene at hand.
        ours: String,
    },
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

/// An image by chance: mean and standard error of independent ones.
#[derive(Debug, Clone)]
pub struct WayImage {
    /// How it was made: `direct` of `direct.mean.beam0`.
    pub way: String,
    /// Which beam's light.
    pub beam: usize,
    /// The image, W per pixel.
    pub estimate: Estimate,
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

/// The resolution of an arithmetic.
pub(crate) fn resolution_of(arithmetic: Arithmetic) -> Resolution {
    match arithmetic {
        Arithmetic::F32 => Resolution::F32,
        Arithmetic::F64 => Resolution::F64,
    }
}

/// The note of a recording, if it has one, which must be of this scene.
pub(crate) fn note(folder: &Path, scene: &Scene) -> Result<Option<Provenance>, OutsideError> {
    let note = Provenance::read(folder)?;
    let ours = scene_sha256(scene);
    match note {
        Some(note) if note.scene.sha256 != ours => {
            Err(OutsideError::OtherScene { folder: folder.to_path_buf(), theirs: note.scene.sha256, ours })
        }
        note => Ok(note),
    }
}

/// Whether a channel holds something that only another kind of renderer has.
pub(crate) fn is_of_outsiders(key: &str) -> bool {
    let Some((sensor, name)) = key.split_once('/') else { return false };
    let is_camera = sensor == SensorId::Camera.to_string();
    let parts: Vec<&str> = name.split('.').collect();
    match parts[..] {
        ["radiance", "V"] => !is_camera,
        ["radiance", beam] => is_camera && beam.starts_with("beam"),
        [_, "mean" | "error", beam] => is_camera && beam.starts_with("beam"),
        _ => false,
    }
}

impl Outsider {
    /// Reads what somebody recorded of a scene. How finely it computes its own note says; without one, double precision.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions; a recording of another scene.
    pub fn read(folder: &Path, scene: &Scene) -> Result<Self, OutsideError> {
        let note = note(folder, scene)?;
        let resolution = note.as_ref().map_or(Resolution::F64, |note| resolution_of(note.arithmetic));
        let channels = Recorded::channels(folder, scene)?;
        let recorded = Recorded::of_folder(folder, scene, resolution, &channels)?;
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
    fn images(&self, note: Option<&Provenance>) -> Result<Vec<WayImage>, OutsideError> {
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

    fn radiance(&self) -> Result<Vec<RadianceMap>, OutsideError> {
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
    fn reals(&self, sensor: SensorId, name: &str) -> Result<Option<Image<f64>>, OutsideError> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_images_and_radiance_are_known() {
        for (key, is_known) in [
            ("camera/direct.mean.beam0", true),
            ("camera/direct.error.beam1", true),
            ("camera/radiance.beam0", true),
            ("beam-1/radiance.V", true),
            ("beam-1/direct.mean.beam0", false),
            ("camera/radiance.V", false),
            ("camera/range.T", false),
            ("direct.mean.beam0", false),
        ] {
            assert_eq!(is_of_outsiders(key), is_known, "{key}");
        }
    }
}
