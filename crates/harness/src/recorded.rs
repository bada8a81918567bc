//! What another program recorded in files, as answers: names, sizes and conventions are checked, and nothing is
//! guessed. The conventions are those of `docs/files.md`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec3;
use raypencil_scene::{
    FaceId, FluxModel, Frame, Image, Maybe, Pixel, Renderer, Request, Resolution, Sample, Scene, SensorId,
};
use raypencil_scene_io::{Channel, Channels, Limits, SceneIoError, Storage, Values, read_channels};

use crate::answers::{Answers, other};
use crate::compare::Quantity;
use crate::outside::is_of_outsiders;

/// Why a recording cannot be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// A file; the message names it.
    #[error(transparent)]
    File(#[from] SceneIoError),
    /// A cell that breaks the conventions, or a channel that does not fit the scene.
    #[error("{}: `{channel}`{}: {found}; expected {expected}", file.display(), at(cell))]
    Channel {
        /// The file.
        file: PathBuf,
        /// The channel.
        channel: String,
        /// Column and row of the cell, if it is one.
        cell: Option<(u32, u32)>,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A channel of which there is a part only.
    #[error("{}: `{channel}` is absent; expected all of {all}", folder.display())]
    Part {
        /// The recording.
        folder: PathBuf,
        /// The absent part.
        channel: String,
        /// All parts.
        all: String,
    },
    /// A folder of several recordings.
    #[error("{}: holds {found}; expected one recording: name one of them", folder.display())]
    Several {
        /// The folder.
        folder: PathBuf,
        /// What it holds, by name.
        found: String,
    },
    /// Nothing in it is known.
    #[error("{}: holds no channel of this scene; expected files such as camera.exr or beam-0/range.T.npy with the names of docs/files.md{}", folder.display(), there(unknown))]
    Nothing {
        /// The folder.
        folder: PathBuf,
        /// The names that it does hold.
        unknown: Vec<String>,
    },
}

fn at(cell: &Option<(u32, u32)>) -> String {
    cell.map_or(String::new(), |(i, j)| format!(" at {i},{j}"))
}

fn there(unknown: &[String]) -> String {
    match unknown {
        [] => String::new(),
        some => format!(" (found {})", some[..some.len().min(8)].join(", ")),
    }
}

/// A quantity; a flux by the scene's model or by the other one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Item {
    /// The quantity.
    pub quantity: Quantity,
    /// Of a flux on the image, which beam's.
    pub beam: Option<u32>,
    /// Whether it is a flux by the model that is not the scene's.
    pub is_other_model: bool,
}

impl From<Quantity> for Item {
    fn from(quantity: Quantity) -> Self {
        Self { quantity, beam: None, is_other_model: false }
    }
}

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
    pub resolution: Resolution,
}

impl Renderer for Recorded {
    fn name(&self) -> &str {
        &self.name
    }

    fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// What was recorded, of whatever scene: the caller sees to it that it is this one.
    fn render(&self, _: &Scene, _: &Request) -> Frame {
        self.answers.to_frame()
    }
}

/// What a channel is called.
mod names {
    pub(super) const RANGE: &str = "range.T";
    pub(super) const DEPTH: &str = "depth.Z";
    pub(super) const FACE: &str = "face.I";
    pub(super) const POINT: [&str; 3] = ["P.X", "P.Y", "P.Z"];
    pub(super) const NORMAL: [&str; 3] = ["N.X", "N.Y", "N.Z"];
    pub(super) const INCIDENCE: &str = "incidence.V";
    pub(super) const VISIBLE: &str = "visible.V";
    pub(super) const PIXEL: [&str; 2] = ["pixel.I", "pixel.J"];
    pub(super) const VIEW: &str = "view.Z";
    pub(super) const OFF_AXIS: &str = "offAxis.V";
    pub(super) const EMISSION: &str = "emission.V";
    pub(super) const FLUX: &str = "flux.V";
}

/// `flux.V`, or `flux.eq1.V` for the model that is not the scene's.
pub(crate) fn flux_channel(model: Option<FluxModel>) -> String {
    match model {
        None => names::FLUX.into(),
        Some(model) => format!("flux.{}.V", word(model)),
    }
}

/// `flux.beam0`, or `flux.eq1.beam0`.
pub(crate) fn image_channel(beam: usize, model: Option<FluxModel>) -> String {
    match model {
        None => format!("flux.beam{beam}"),
        Some(model) => format!("flux.{}.beam{beam}", word(model)),
    }
}

/// What a channel of a sensor holds, if its name means anything.
pub(crate) fn item_of_channel(scene: &Scene, sensor: SensorId, name: &str) -> Option<Item> {
    let second = other(scene.flux_model());
    let of_flux = |item: Item, own: &str, others: &str| {
        let is_other_model = name == others;
        (name == own || is_other_model).then_some(Item { is_other_model, ..item })
    };
    if sensor == SensorId::Camera {
        let image = (0..scene.beams().len()).find_map(|beam| {
            of_flux(Item::of_image(beam), &image_channel(beam, None), &image_channel(beam, Some(second)))
        });
        if image.is_some() {
            return image;
        }
    } else if let flux @ Some(_) =
        of_flux(Quantity::PencilFlux.into(), &flux_channel(None), &flux_channel(Some(second)))
    {
        return flux;
    }
    let quantity = match name {
        names::RANGE => Quantity::Range,
        names::DEPTH => Quantity::Depth,
        names::FACE => Quantity::Face,
        name if names::POINT.contains(&name) => Quantity::Point,
        name if names::NORMAL.contains(&name) => Quantity::Normal,
        names::INCIDENCE => Quantity::Incidence,
        names::VISIBLE => Quantity::Visible,
        name if names::PIXEL.contains(&name) => Quantity::Pixel,
        names::VIEW => Quantity::CameraDepth,
        names::OFF_AXIS => Quantity::OffAxis,
        names::EMISSION => Quantity::Emission,
        _ => return None,
    };
    quantity.is_of(sensor).then(|| quantity.into())
}

/// A model as files name it.
pub(crate) fn word(model: FluxModel) -> &'static str {
    match model {
        FluxModel::Radiometric => "radiometric",
        FluxModel::Eq1 => "eq1",
    }
}

/// How much a recording of a scene may ask for: a small file can hold a map of 2^26 zeros, which is no sensor's.
fn limits(scene: &Scene) -> Limits {
    let sizes = scene.sensors().filter_map(|sensor| scene.size(sensor));
    let all: u64 = sizes.map(|(columns, rows)| u64::from(columns) * u64::from(rows)).sum();
    let most = Limits::default();
    // CHOICE: a map of a million cells is little, and is refused by its size and its sensor later; a thousand channels of
    // doubles are more than a recording has.
    Limits {
        cells: all.max(1 << 20).min(most.cells),
        bytes: ((1 << 26) + (all << 13)).min(most.bytes),
        size: None,
    }
}

impl Recorded {
    /// Reads the recording of a scene's sensors from a folder.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions.
    pub fn read(folder: &Path, scene: &Scene, resolution: Resolution) -> Result<Self, RecordingError> {
        Self::of_folder(folder, scene, resolution, &Self::channels(folder, scene)?)
    }

    /// The channels of a folder that holds one recording of a scene.
    pub(crate) fn channels(folder: &Path, scene: &Scene) -> Result<Channels, RecordingError> {
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
    pub(crate) fn of_folder(
        folder: &Path,
        scene: &Scene,
        resolution: Resolution,
        channels: &Channels,
    ) -> Result<Self, RecordingError> {
        let name = folder.file_name().map_or("candidate".into(), |name| name.to_string_lossy().into_owned());
        Self::of_channels(name, folder, scene, resolution, channels)
    }

    /// What a renderer of this house says, as it computed it.
    pub fn of_frame(name: &str, scene: &Scene, frame: &Frame, resolution: Resolution) -> Self {
        let answers = Answers::of_frame(scene, frame);
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
            store(Quantity::Incidence, map.incidence.is_some(), Storage::F64);
            if let SensorId::Beam(beam) = sensor {
                let light = &answers.light[beam];
                let returns = &light.returns;
                store(Quantity::Visible, returns.visible.is_some(), Storage::Whole);
                store(Quantity::Pixel, returns.pixel.is_some(), Storage::Whole);
                store(Quantity::CameraDepth, returns.depth.is_some(), Storage::F64);
                store(Quantity::OffAxis, returns.off_axis.is_some(), Storage::F64);
                store(Quantity::Emission, returns.emission.is_some(), Storage::F64);
                store(Quantity::PencilFlux, returns.flux.is_some(), Storage::F64);
            }
        }
        for (beam, _) in answers.light.iter().enumerate().filter(|(_, light)| light.image.is_some()) {
            storage.insert((SensorId::Camera, Item::of_image(beam)), Storage::F64);
        }
        Self { name: name.into(), answers, storage, unknown: Vec::new(), resolution }
    }

    pub(crate) fn of_channels(
        name: String,
        folder: &Path,
        scene: &Scene,
        resolution: Resolution,
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
        Ok(Self { name, answers, storage, unknown, resolution })
    }
}

/// Names of folders in a folder that each hold maps, if it holds none itself.
fn recordings_in(folder: &Path) -> Vec<String> {
    let is_map = |path: &Path| {
        let stem = path.file_stem().is_some_and(|stem| {
            let stem = stem.to_string_lossy();
            stem == "camera" || stem.starts_with("beam-")
        });
        stem && (path.is_dir() || path.extension().is_some_and(|ending| ending == "exr"))
    };
    let entries = |folder: &Path| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten();
        let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        paths.sort();
        paths
    };
    let own = entries(folder);
    if own.iter().any(|path| is_map(path)) {
        return Vec::new();
    }
    let holds_maps = |path: &&PathBuf| path.is_dir() && entries(path).iter().any(|path| is_map(path));
    let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    own.iter().filter(holds_maps).filter_map(name).collect()
}

struct Reader<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    channels: &'a Channels,
    answers: Answers,
    storage: BTreeMap<(SensorId, Item), Storage>,
    used: Vec<String>,
    /// Of each sensor, what says which rays hit, and which.
    hits: Vec<Option<(String, Vec<bool>)>>,
}

/// Real numbers of a channel, and where they come from.
#[derive(Clone, Copy)]
struct Reals<'a> {
    /// The channel's name, also where the file gives it none.
    name: &'a str,
    channel: &'a Channel,
    image: &'a Image<f64>,
}

impl<'a> Reader<'a> {
    fn fault(
        (name, channel): (&str, &Channel),
        cell: Option<(u32, u32)>,
        found: String,
        expected: &str,
    ) -> RecordingError {
        RecordingError::Channel {
            file: channel.file.clone(),
            channel: name.to_string(),
            cell,
            found,
            expected: expected.into(),
        }
    }

    /// A channel of a sensor, of the right size, and its name.
    fn channel(
        &mut self,
        sensor: SensorId,
        name: &str,
    ) -> Result<Option<(&'a str, &'a Channel)>, RecordingError> {
        let key = format!("{sensor}/{name}");
        let Some((key_there, channel)) = self.channels.by_key.get_key_value(&key) else { return Ok(None) };
        let name = key_there.split_once('/').map_or(key_there.as_str(), |(_, name)| name);
        let (width, height) = self.scene.size(sensor).expect("a sensor of this scene");
        let size = match &channel.values {
            Values::Reals(image) => (image.width(), image.height()),
            Values::Wholes(image) => (image.width(), image.height()),
        };
        if size != (width, height) {
            let found = format!("{} x {} cells", size.0, size.1);
            let expected = format!("{width} x {height}, as the scene's {sensor} has");
            return Err(Self::fault((name, channel), None, found, &expected));
        }
        self.used.push(key);
        Ok(Some((name, channel)))
    }

    fn reals(&mut self, sensor: SensorId, name: &str) -> Result<Option<Reals<'a>>, RecordingError> {
        match self.channel(sensor, name)? {
            None => Ok(None),
            Some((name, channel)) => match &channel.values {
                Values::Reals(image) => Ok(Some(Reals { name, channel, image })),
                Values::Wholes(_) => {
                    Err(Self::fault((name, channel), None, "whole numbers".into(), "floating-point numbers"))
                }
            },
        }
    }

    /// Whole numbers, also if they are stored as floating-point ones; what is not finite or -1 is "none".
    fn wholes(&mut self, sensor: SensorId, name: &str) -> Result<Option<Image<u32>>, RecordingError> {
        let Some((name, channel)) = self.channel(sensor, name)? else { return Ok(None) };
        let image = match &channel.values {
            Values::Wholes(image) => return Ok(Some(image.clone())),
            Values::Reals(image) => image,
        };
        let mut cells = Vec::with_capacity(image.cells().len());
        for (index, &value) in image.cells().iter().enumerate() {
            // Singles hold whole numbers up to 2^24 only; the one for "none" is 2^32 there.
            let none = !value.is_finite() || value == -1.0 || value >= f64::from(u32::MAX);
            if !none && (value < 0.0 || value != value.trunc()) {
                let cell = Some(cell(image, index));
                return Err(Self::fault(
                    (name, channel),
                    cell,
                    value.to_string(),
                    "a whole number, or 4294967295 for none",
                ));
            }
            cells.push(if none { u32::MAX } else { value as u32 });
        }
        Ok(Some(Image::from_cells(image.width(), image.height(), cells)))
    }

    fn store(&mut self, sensor: SensorId, item: impl Into<Item>, storage: Storage) {
        self.storage.insert((sensor, item.into()), storage);
    }

    /// What each ray of a sensor meets.
    fn geometry(&mut self, index: usize, sensor: SensorId) -> Result<(), RecordingError> {
        let faces = self.wholes(sensor, names::FACE)?;
        let (range, depth) = (self.reals(sensor, names::RANGE)?, self.reals(sensor, names::DEPTH)?);
        let incidence = self.reals(sensor, names::INCIDENCE)?;
        let (point, normal) = (self.vector(sensor, names::POINT)?, self.vector(sensor, names::NORMAL)?);

        // Whether each ray hits: the first of these that is there says so, and the others must agree.
        let hits: Option<(String, Vec<bool>)> = if let Some(faces) = &faces {
            Some((names::FACE.into(), faces.cells().iter().map(|face| *face != u32::MAX).collect()))
        } else {
            let speaker = range.or(depth).or(point.map(|p| p[0])).or(normal.map(|n| n[0])).or(incidence);
            speaker.map(|reals| {
                (reals.name.to_string(), reals.image.cells().iter().map(|x| x.is_finite()).collect())
            })
        };
        let Some((speaker, hits)) = hits else { return Ok(()) };
        self.hits[index] = Some((speaker.clone(), hits.clone()));
        let (width, height) = self.scene.size(sensor).expect("a sensor of this scene");
        if let Some(faces) = faces {
            let face = |index: &u32| Some(FaceId(*index)).filter(|face| !face.is_nothing()).into();
            let cells = faces.cells().iter().map(face).collect();
            self.answers.maps[index].face = Some(Image::from_cells(width, height, cells));
            self.store(sensor, Quantity::Face, Storage::Whole);
        }
        let scalars = [
            (range, Quantity::Range, true),
            (depth, Quantity::Depth, true),
            (incidence, Quantity::Incidence, false),
        ];
        for (reals, quantity, is_length) in scalars {
            let Some(reals) = reals else { continue };
            let image = maybe(reals, &hits, &speaker, is_length)?;
            self.store(sensor, quantity, reals.channel.storage);
            let map = &mut self.answers.maps[index];
            match quantity {
                Quantity::Range => map.range = Some(image),
                Quantity::Depth => map.depth = Some(image),
                _ => map.incidence = Some(image),
            }
        }
        for (parts, quantity) in [(point, Quantity::Point), (normal, Quantity::Normal)] {
            let Some(parts) = parts else { continue };
            let mut images = Vec::new();
            for part in parts {
                images.push(maybe(part, &hits, &speaker, false)?);
            }
            let cells = (0..hits.len()).map(|at| {
                let part = |k: usize| images[k].cells()[at].get();
                let vector = part(0).zip(part(1)).zip(part(2)).map(|((x, y), z)| DVec3::new(x, y, z));
                Maybe::from(vector)
            });
            let image = Image::from_cells(width, height, cells.collect());
            self.store(
                sensor,
                quantity,
                parts.map(|part| part.channel.storage).into_iter().min().unwrap_or(Storage::F64),
            );
            let map = &mut self.answers.maps[index];
            if quantity == Quantity::Point { map.point = Some(image) } else { map.normal = Some(image) }
        }
        Ok(())
    }

    fn vector(
        &mut self,
        sensor: SensorId,
        names: [&str; 3],
    ) -> Result<Option<[Reals<'a>; 3]>, RecordingError> {
        let mut parts = Vec::new();
        let mut absent = None;
        for name in names {
            match self.reals(sensor, name)? {
                Some(part) => parts.push(part),
                None => absent = Some(name),
            }
        }
        match (<[Reals<'a>; 3]>::try_from(parts), absent) {
            (Ok(parts), _) => Ok(Some(parts)),
            (Err(parts), Some(absent)) if !parts.is_empty() => Err(RecordingError::Part {
                folder: self.folder.to_path_buf(),
                channel: format!("{sensor}/{absent}"),
                all: names.join(", "),
            }),
            _ => Ok(None),
        }
    }

    /// What comes back of a beam.
    fn light(&mut self, beam: usize) -> Result<(), RecordingError> {
        let sensor = SensorId::Beam(beam);
        let (width, height) = self.scene.size(sensor).expect("a sensor of this scene");
        // Whether each pencil hits, as far as the geometry says.
        let hits = self.hits[beam + 1].clone();

        if let Some((name, channel)) = self.channel(sensor, names::VISIBLE)? {
            let mut cells = Vec::new();
            let at = |index: usize| (index as u32 % width, index as u32 / width);
            let mut take = |index: usize, value: f64| {
                if value != 0.0 && value != 1.0 {
                    return Err(Self::fault((name, channel), Some(at(index)), value.to_string(), "0 or 1"));
                }
                cells.push(value == 1.0);
                Ok(())
            };
            match &channel.values {
                Values::Reals(image) => {
                    image.cells().iter().enumerate().try_for_each(|(index, value)| take(index, *value))?;
                }
                Values::Wholes(image) => {
                    let cells = image.cells().iter().enumerate();
                    cells.into_iter().try_for_each(|(index, value)| take(index, f64::from(*value)))?;
                }
            }
            self.answers.light[beam].returns.visible = Some(Image::from_cells(width, height, cells));
            self.store(sensor, Quantity::Visible, Storage::Whole);
        }

        let [columns, rows] = [self.wholes(sensor, names::PIXEL[0])?, self.wholes(sensor, names::PIXEL[1])?];
        match [columns, rows] {
            [Some(columns), Some(rows)] => {
                let camera = &self.scene.camera().sensor;
                let mut cells = Vec::new();
                for (index, (&i, &j)) in columns.cells().iter().zip(rows.cells()).enumerate() {
                    let is_none = i == u32::MAX && j == u32::MAX;
                    if !is_none && (i >= camera.width || j >= camera.height) {
                        let key = format!("{sensor}/{}", names::PIXEL[0]);
                        let at = Some(cell(&columns, index));
                        let expected = format!(
                            "a pixel of the camera's {} x {}, or 4294967295,4294967295 for none",
                            camera.width, camera.height
                        );
                        let found = format!("pixel {i},{j}");
                        let channel = (names::PIXEL[0], &self.channels.by_key[&key]);
                        return Err(Self::fault(channel, at, found, &expected));
                    }
                    cells.push(Maybe::from((!is_none).then_some(Pixel { i, j })));
                }
                self.answers.light[beam].returns.pixel = Some(Image::from_cells(width, height, cells));
                self.store(sensor, Quantity::Pixel, Storage::Whole);
            }
            [None, None] => {}
            [columns, _] => {
                let absent = names::PIXEL[usize::from(columns.is_some())];
                return Err(RecordingError::Part {
                    folder: self.folder.to_path_buf(),
                    channel: format!("{sensor}/{absent}"),
                    all: names::PIXEL.join(", "),
                });
            }
        }

        let scalars = [
            (names::VIEW, Quantity::CameraDepth, true),
            (names::OFF_AXIS, Quantity::OffAxis, false),
            (names::EMISSION, Quantity::Emission, false),
        ];
        for (name, quantity, is_length) in scalars {
            let Some(reals) = self.reals(sensor, name)? else { continue };
            let image = match &hits {
                Some((speaker, hits)) => maybe_signed(reals, hits, speaker, is_length)?,
                None => {
                    // Nothing else says what is hit: the truth will.
                    let own: Vec<bool> = reals.image.cells().iter().map(|x| x.is_finite()).collect();
                    maybe_signed(reals, &own, name, is_length)?
                }
            };
            self.store(sensor, quantity, reals.channel.storage);
            let returns = &mut self.answers.light[beam].returns;
            match quantity {
                Quantity::CameraDepth => returns.depth = Some(image),
                Quantity::OffAxis => returns.off_axis = Some(image),
                _ => returns.emission = Some(image),
            }
        }

        let second = other(self.scene.flux_model());
        for model in [None, Some(second)] {
            if let Some(reals) = self.reals(sensor, &flux_channel(model))? {
                let image = flux(reals)?;
                let item = Item { is_other_model: model.is_some(), ..Quantity::PencilFlux.into() };
                self.store(sensor, item, reals.channel.storage);
                let light = &mut self.answers.light[beam];
                if model.is_none() {
                    light.returns.flux = Some(image)
                } else {
                    light.other_flux = Some(image)
                }
            }
            if let Some(reals) = self.reals(SensorId::Camera, &image_channel(beam, model))? {
                let image = flux(reals)?;
                let item = Item { is_other_model: model.is_some(), ..Item::of_image(beam) };
                self.store(SensorId::Camera, item, reals.channel.storage);
                let light = &mut self.answers.light[beam];
                if model.is_none() { light.image = Some(image) } else { light.other_image = Some(image) }
            }
        }
        Ok(())
    }
}

/// Column and row of the cell of that index.
fn cell<T: Copy>(image: &Image<T>, index: usize) -> (u32, u32) {
    (index as u32 % image.width(), index as u32 / image.width())
}

/// Numbers where there are hits and none elsewhere; lengths are not negative, and +Inf where nothing is hit.
fn maybe(
    reals: Reals<'_>,
    hits: &[bool],
    speaker: &str,
    is_length: bool,
) -> Result<Image<Maybe<f64>>, RecordingError> {
    let image = maybe_signed(reals, hits, speaker, is_length)?;
    if is_length && let Some(index) = image.cells().iter().position(|x| x.get().is_some_and(|x| x < 0.0)) {
        let found = reals.image.cells()[index].to_string();
        return Err(Reader::fault(
            (reals.name, reals.channel),
            Some(cell(reals.image, index)),
            found,
            "no negative length",
        ));
    }
    Ok(image)
}

/// The same, of any sign: a point may lie behind the camera.
fn maybe_signed(
    Reals { name, channel, image }: Reals<'_>,
    hits: &[bool],
    speaker: &str,
    is_length: bool,
) -> Result<Image<Maybe<f64>>, RecordingError> {
    let mut cells = Vec::with_capacity(hits.len());
    for (index, (&value, &hit)) in image.cells().iter().zip(hits).enumerate() {
        let wrong = |expected: String| {
            Err(Reader::fault((name, channel), Some(cell(image, index)), value.to_string(), &expected))
        };
        let nothing = if is_length { "+Inf" } else { "NaN" };
        if hit && !value.is_finite() {
            return wrong(format!("a number, as {speaker} says that something is hit"));
        }
        let is_nothing = if is_length { value == f64::INFINITY } else { value.is_nan() };
        if !hit && !is_nothing {
            return wrong(if name == speaker {
                format!("a number, or {nothing} where nothing is hit")
            } else {
                format!("{nothing}, as {speaker} says that nothing is hit")
            });
        }
        cells.push(Maybe::from(hit.then_some(value)));
    }
    Ok(Image::from_cells(image.width(), image.height(), cells))
}

/// Flux: never negative, never infinite, 0 where there is none.
fn flux(Reals { name, channel, image }: Reals<'_>) -> Result<Image<f64>, RecordingError> {
    if let Some(index) = image.cells().iter().position(|flux| !(*flux >= 0.0 && flux.is_finite())) {
        let found = image.cells()[index].to_string();
        let expected = "a flux that is not negative, and 0 where there is none";
        return Err(Reader::fault((name, channel), Some(cell(image, index)), found, expected));
    }
    Ok(image.clone())
}
