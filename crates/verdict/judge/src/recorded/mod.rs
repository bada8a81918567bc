//! Recordings: answers of another program, read from files by the conventions of `docs/formats/files.md`.
//!
//! Names, sizes and conventions are checked, and nothing is guessed.

pub(crate) mod conventions;
pub(crate) mod error;
pub(crate) mod names;
mod reader;

use crate::quantity::{Item, Quantity};
use crate::recorded::conventions::Conventions;
use crate::recorded::error::RecordingError;
use crate::recorded::names::{is_path_tracer_channel, maps_of};
use crate::recorded::reader::{Reader, limits, recordings_in};
use crate::scene_answers::Answers;
use raypencil_files::{
    Channels, Declared, DeclaredChannel, Storage, harmless_line, read_channels_as, shortened,
};
use raypencil_scene::{HitQuantity, Precision, RenderOutput, Renderer, Request, Scene, SensorId};
use std::collections::BTreeMap;
use std::path::Path;

/// A recording of answers about one scene.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// Name of the recording's folder.
    pub name: String,
    /// The answers.
    pub answers: Answers,
    /// The number format of each quantity that it has.
    pub storage: BTreeMap<(SensorId, Item), Storage>,
    /// Channels whose names are not known.
    pub unknown: Vec<String>,
    /// Declared precision of the program's arithmetic.
    pub precision: Precision,
}

impl Renderer for Recorded {
    fn name(&self) -> &str {
        &self.name
    }

    fn precision(&self) -> Precision {
        self.precision
    }

    /// The recorded answers, whatever the scene is: the caller passes the scene that was recorded.
    fn render(&self, _: &Scene, _: &Request) -> RenderOutput {
        self.answers.to_output()
    }
}

impl Recorded {
    /// Reads the recording of a scene's sensors from a folder.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # use glam::DVec3;
    /// # use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene};
    /// # let corners = vec![[0.125, -40.0, 2.0], [-90.0, 0.0, 2.0], [0.125, 40.0, 2.0]];
    /// # let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
    /// # let wall = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], vec![plaster])?;
    /// # let camera = Camera {
    /// #     width: 9, height: 9, pixel_pitch: [0.0625; 2], focal_length: 0.5, principal_point: [4.5; 2],
    /// #     aperture: 0.01, lens: Lens::CLEAR, max_range: 20.0,
    /// # };
    /// # let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    /// # let air = Atmosphere { attenuation: 0.0 };
    /// # let scene = Scene::new(Arc::new(wall), camera, vec![], air, FluxModel::Radiometric)?;
    /// // A wall at z = 2 m that ends at x = 1/8 m, before a camera of 9 x 9 pixels at the origin that looks along z.
    /// use raypencil_files::write_npy;
    /// use raypencil_judge::Recorded;
    /// use raypencil_scene::{Image, Precision};
    ///
    /// let folder = tempfile::tempdir()?;
    /// std::fs::create_dir(folder.path().join("camera"))?;
    /// let ranges = Image::from_cells(9, 9, vec![f32::INFINITY; 81]);
    /// write_npy(folder.path().join("camera/range.T.npy"), &[&ranges])?;
    ///
    /// // +Inf is the range of a ray that hits nothing.
    /// let recorded = Recorded::read(folder.path(), &scene, Precision::F32)?;
    /// let range = recorded.answers.maps[0].range.as_ref().unwrap();
    /// assert!(range.cells().iter().all(|range| range.get().is_none()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions.
    pub fn read(folder: &Path, scene: &Scene, precision: Precision) -> Result<Self, RecordingError> {
        Self::read_by(folder, scene, precision, Conventions::STANDARD)
    }

    /// The same for a recording whose conventions are declared.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions.
    pub fn read_by(
        folder: &Path,
        scene: &Scene,
        precision: Precision,
        conventions: Conventions,
    ) -> Result<Self, RecordingError> {
        let channels = Self::channels(folder, scene, &Declared::default())?;
        Self::of_folder(folder, scene, precision, &channels, conventions)
    }

    /// Reads the channels of a folder that holds one recording of a scene. Of its pictures those are read that have the name of
    /// a map, or are declared to be one.
    ///
    /// # Errors
    /// Names the file that cannot be read, the several recordings that the folder holds, or what is declared and is not so.
    pub fn channels(folder: &Path, scene: &Scene, declared: &Declared) -> Result<Channels, RecordingError> {
        let several = recordings_in(folder);
        if !several.is_empty() {
            let found = match several.as_slice() {
                [one] => format!("another folder, {one}, and no maps itself"),
                _ => format!("{} recordings, {}", several.len(), several.join(", ")),
            };
            return Err(RecordingError::Several { folder: folder.to_path_buf(), found });
        }
        let maps = scene.sensors().flat_map(|sensor| maps_of(scene, sensor));
        // A vector is one array: P of P.X.
        let names: Vec<String> = maps
            .flat_map(|map| [map.split_once(".X").map_or(map.as_str(), |(start, _)| start).to_string(), map])
            .collect();
        let channels = read_channels_as(folder, &limits(scene), declared, Some(&names))?;
        // Of two recordings that are compared, one may lack what is declared.
        for one in declared.channels.iter().filter(|one| channels.used.maps.contains(&one.map)) {
            check_declared(one, folder, scene, &channels)?;
        }
        Ok(channels)
    }

    /// A recording that has no maps, of a program that answers sets of rays alone.
    pub fn without_maps(folder: &Path, scene: &Scene, precision: Precision) -> Self {
        Self {
            name: name_of_folder(folder),
            answers: Answers::none(scene),
            storage: BTreeMap::new(),
            unknown: Vec::new(),
            precision,
        }
    }

    /// Takes the channels of a folder as a recording, which has the folder's name.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions.
    pub fn of_folder(
        folder: &Path,
        scene: &Scene,
        precision: Precision,
        channels: &Channels,
        conventions: Conventions,
    ) -> Result<Self, RecordingError> {
        Self::of_channels_by(name_of_folder(folder), folder, scene, precision, channels, conventions)
    }

    /// The output of a renderer of this project, as computed, as a recording in f64.
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
            for quantity in HitQuantity::ALL {
                store(quantity.into(), map.raster(quantity).is_some(), Storage::F64);
            }
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

    /// How an item is stored: the coarsest type of all sensors that have it; `None` if none has.
    pub fn storage_of_item(&self, item: Item) -> Option<Storage> {
        let stored = self.storage.iter().filter(|((_, of), _)| *of == item);
        stored.map(|(_, storage)| *storage).min()
    }

    /// Items that are stored more coarsely than in single precision for at least one sensor, by their storage: none of them
    /// agrees exactly.
    pub fn coarse_items(&self) -> BTreeMap<Storage, Vec<Item>> {
        let mut items: BTreeMap<Storage, Vec<Item>> = BTreeMap::new();
        for ((_, item), how) in self.storage.iter().filter(|(_, how)| how.coarse_words().is_some()) {
            items.entry(*how).or_default().push(*item);
        }
        for of_storage in items.values_mut() {
            of_storage.sort();
            of_storage.dedup();
        }
        items
    }

    /// How coarsely the coarsest are stored, in words: `half precision`, `steps of 0.001 m`; `None` if all are finer.
    pub fn coarseness(&self) -> Option<String> {
        let words: Vec<String> =
            self.coarse_items().keys().rev().filter_map(|how| how.coarse_words()).collect();
        (!words.is_empty()).then(|| words.join(" and "))
    }

    /// Takes channels as a recording of this name; `folder` is for messages.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions.
    pub fn of_channels(
        name: String,
        folder: &Path,
        scene: &Scene,
        precision: Precision,
        channels: &Channels,
    ) -> Result<Self, RecordingError> {
        Self::of_channels_by(name, folder, scene, precision, channels, Conventions::STANDARD)
    }

    fn of_channels_by(
        name: String,
        folder: &Path,
        scene: &Scene,
        precision: Precision,
        channels: &Channels,
        conventions: Conventions,
    ) -> Result<Self, RecordingError> {
        let mut reader = Reader {
            conventions,
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
        // Packs also hold margins and rays. Estimates and radiance are judged elsewhere.
        let is_known = |key: &str| {
            key.split_once('/').is_some_and(|(_, name)| name.starts_with("margin."))
                || key.starts_with("rays-")
                || is_path_tracer_channel(key)
        };
        let unknown: Vec<String> =
            channels.by_key.keys().filter(|key| !used.contains(*key) && !is_known(key)).cloned().collect();
        if storage.is_empty() {
            let names: Vec<&str> =
                channels.by_key.iter().map(|(key, channel)| channel.name_in_file(key)).collect();
            // Only an example of what can be typed; the channel of a likely name, if there is one.
            let is_likely =
                |name: &&&str| ["depth", "range"].iter().any(|word| name.to_lowercase().contains(word));
            let example = names.iter().find(is_likely).or(names.first()).unwrap_or(&"CHANNEL").to_string();
            let there = shortened(channels.inventory(folder));
            return Err(RecordingError::Nothing { folder: folder.to_path_buf(), there, example });
        }
        Ok(Self { name, answers, storage, unknown, precision })
    }
}

/// Refuses a declared map that no sensor of the scene has, and a channel whose file does not say of which sensor it is.
fn check_declared(
    DeclaredChannel { map, channel }: &DeclaredChannel,
    folder: &Path,
    scene: &Scene,
    channels: &Channels,
) -> Result<(), RecordingError> {
    let refuse = |found: String, expected: String| {
        let (folder, channel, map) = (folder.to_path_buf(), channel.clone(), map.clone());
        Err(RecordingError::Declared {
            folder,
            channel: channel.into(),
            map: map.into(),
            found,
            expected: shortened(expected),
        })
    };
    let (sensor, name) = match map.split_once('/') {
        Some((sensor, name)) => (Some(sensor), name),
        None => (None, map.as_str()),
    };
    let mut of_scene = scene.sensors().map(|sensor| sensor.to_string());
    if let Some(sensor) = sensor.filter(|sensor| !of_scene.any(|one| one == *sensor)) {
        let sensors: Vec<String> = scene.sensors().map(|sensor| sensor.to_string()).collect();
        return refuse(format!("the scene has no sensor {sensor}"), sensors.join(", "));
    }
    let has = |one: SensorId| {
        sensor.is_none_or(|sensor| one.to_string() == sensor)
            && (names::item_of_channel(scene, one, name).is_some()
                || is_path_tracer_channel(&format!("{one}/{name}")))
    };
    let having: Vec<SensorId> = scene.sensors().filter(|one| has(*one)).collect();
    if having.is_empty() {
        let all = scene.sensors().filter(|one| sensor.is_none_or(|sensor| one.to_string() == sensor));
        let mut maps: Vec<String> = all.flat_map(|one| maps_of(scene, one)).collect();
        maps.dedup();
        return refuse("there is no such map".into(), format!("one of {}", maps.join(", ")));
    }
    if !having.iter().any(|one| channels.by_key.contains_key(&format!("{one}/{name}"))) {
        let sensors: Vec<String> = having.iter().map(|one| format!("{one}/{name}")).collect();
        return refuse("its file says of no sensor that it belongs to it".into(), sensors.join(" or "));
    }
    Ok(())
}

/// A recording has the name of its folder.
fn name_of_folder(folder: &Path) -> String {
    folder.file_name().map_or("candidate".into(), |name| harmless_line(&name.to_string_lossy()))
}
