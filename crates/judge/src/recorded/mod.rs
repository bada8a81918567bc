//! What another program recorded in files, as answers: names, sizes and conventions are checked, and nothing is
//! guessed. The conventions are those of `docs/formats/files.md`.

pub(crate) mod error;
pub(crate) mod names;
mod reader;

use crate::answers::Answers;
use crate::class::{Item, Quantity};
use crate::recorded::error::RecordingError;
use crate::recorded::names::is_of_outsiders;
use crate::recorded::reader::{Reader, limits, recordings_in};
use raypencil_files::{Channels, Storage, read_channels};
use raypencil_scene::{Precision, RenderOutput, Renderer, Request, Scene, SensorId};
use std::collections::BTreeMap;
use std::path::Path;

/// A recording of answers about one scene.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// Its folder's name.
    pub name: String,
    /// What it says.
    pub answers: Answers,
    /// How it stores each quantity that it has.
    pub storage: BTreeMap<(SensorId, Item), Storage>,
    /// Channels whose names mean nothing here.
    pub unknown: Vec<String>,
    /// How finely it computes, as declared.
    pub precision: Precision,
}

impl Renderer for Recorded {
    fn name(&self) -> &str {
        &self.name
    }

    fn precision(&self) -> Precision {
        self.precision
    }

    /// What was recorded, of whatever scene: the caller sees to it that it is this one.
    fn render(&self, _: &Scene, _: &Request) -> RenderOutput {
        self.answers.to_output()
    }
}

impl Recorded {
    /// Reads the recording of a scene's sensors from a folder.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions.
    pub fn read(folder: &Path, scene: &Scene, precision: Precision) -> Result<Self, RecordingError> {
        Self::of_folder(folder, scene, precision, &Self::channels(folder, scene)?)
    }

    /// The channels of a folder that holds one recording of a scene.
    pub fn channels(folder: &Path, scene: &Scene) -> Result<Channels, RecordingError> {
        let several = recordings_in(folder);
        if !several.is_empty() {
            let found = match several.as_slice() {
                [one] => format!("another folder, {one}, and no maps itself"),
                _ => format!("{} recordings, {}", several.len(), several.join(", ")),
            };
            return Err(RecordingError::Several { folder: folder.to_path_buf(), found });
        }
        Ok(read_channels(folder, &limits(scene))?)
    }

    /// What the channels of a folder say of a scene's sensors.
    pub fn of_folder(
        folder: &Path,
        scene: &Scene,
        precision: Precision,
        channels: &Channels,
    ) -> Result<Self, RecordingError> {
        let name = folder.file_name().map_or("candidate".into(), |name| name.to_string_lossy().into_owned());
        Self::of_channels(name, folder, scene, precision, channels)
    }

    /// What a renderer of this house says, as it computed it.
    pub fn of_output(name: &str, scene: &Scene, output: &RenderOutput, precision: Precision) -> Self {
        let answers = Answers::of_output(scene, output);
        let mut storage = BTreeMap::new();
        for (sensor, map) in scene.sensors().zip(&answers.maps) {
            let mut store = |quantity: Quantity, is_there: bool, how: Storage| {
                if is_there {
                    storage.insert((sensor, quantity.into()), how);
                }
            };
            store(Quantity::Face, map.face.is_some(), Storage::Whole);
            store(Quantity::Range, map.range.is_some(), Storage::F64);
            store(Quantity::Depth, map.depth.is_some(), Storage::F64);
            store(Quantity::Point, map.point.is_some(), Storage::F64);
            store(Quantity::Normal, map.normal.is_some(), Storage::F64);
            store(Quantity::CosIncidence, map.cos_incidence.is_some(), Storage::F64);
            if let SensorId::Beam(beam) = sensor {
                let light = &answers.light[beam];
                let returns = &light.returns;
                store(Quantity::Visible, returns.visible.is_some(), Storage::Whole);
                store(Quantity::Pixel, returns.pixel.is_some(), Storage::Whole);
                store(Quantity::CameraDepth, returns.depth.is_some(), Storage::F64);
                store(Quantity::CosOffAxis, returns.cos_off_axis.is_some(), Storage::F64);
                store(Quantity::CosView, returns.cos_view.is_some(), Storage::F64);
                store(Quantity::PencilFlux, returns.flux.is_some(), Storage::F64);
            }
        }
        for (beam, _) in answers.light.iter().enumerate().filter(|(_, light)| light.image.is_some()) {
            storage.insert((SensorId::Camera, Item::of_image(beam)), Storage::F64);
        }
        Self { name: name.into(), answers, storage, unknown: Vec::new(), precision }
    }

    pub fn of_channels(
        name: String,
        folder: &Path,
        scene: &Scene,
        precision: Precision,
        channels: &Channels,
    ) -> Result<Self, RecordingError> {
        let mut reader = Reader {
            scene,
            folder,
            channels,
            answers: Answers::none(scene),
            storage: BTreeMap::new(),
            used: Vec::new(),
            hits: vec![None; 1 + scene.beams().len()],
        };
        for (index, sensor) in scene.sensors().enumerate() {
            reader.geometry(index, sensor)?;
        }
        for beam in 0..scene.beams().len() {
            reader.light(beam)?;
        }
        let Reader { answers, storage, used, .. } = reader;
        // Of packs: what no candidate has to say. And what is judged by chance, or not by pencils.
        let is_known = |key: &str| {
            key.split_once('/').is_some_and(|(_, name)| name.starts_with("margin."))
                || key.starts_with("rays-")
                || is_of_outsiders(key)
        };
        let unknown: Vec<String> =
            channels.by_key.keys().filter(|key| !used.contains(*key) && !is_known(key)).cloned().collect();
        if storage.is_empty() {
            return Err(RecordingError::Nothing { folder: folder.to_path_buf(), unknown });
        }
        Ok(Self { name, answers, storage, unknown, precision })
    }
}
