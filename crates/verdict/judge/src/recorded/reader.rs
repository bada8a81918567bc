//! Reader of a recording's channels: checks their names, sizes and conventions, and fills in answers.

use crate::quantity::{Item, Quantity};
use crate::recorded::conventions::Conventions;
use crate::recorded::error::{Help, RecordingError};
use crate::recorded::names::{self, flux_channel, image_channel};
use crate::scene_answers::Answers;
use glam::DVec3;
use raypencil_files::{Channel, Channels, Limits, Storage, Values};
use raypencil_scene::{FaceId, HitQuantity, HitRasterMut, Image, Maybe, Pixel, Sample, Scene, SensorId};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Limits on the size of a scene's recording: a small file can hold a map of 2^26 zeros, which fits no sensor.
pub(super) fn limits(scene: &Scene) -> Limits {
    let sizes = scene.sensors().filter_map(|sensor| scene.size(sensor));
    let all: u64 = sizes.map(|(columns, rows)| u64::from(columns) * u64::from(rows)).sum();
    let most = Limits::default();
    // CHOICE: a map of up to a million cells is read, and refused later by a message that names its size and its
    // sensor. A recording has less than a thousand channels of doubles.
    Limits {
        cells: all.max(1 << 20).min(most.cells),
        bytes: ((1 << 26) + (all << 13)).min(most.bytes),
        size: None,
    }
}

/// Names of the subfolders that hold maps, if the folder holds none itself.
pub(super) fn recordings_in(folder: &Path) -> Vec<String> {
    let is_map = |path: &Path| {
        let stem = path.file_stem().is_some_and(|stem| {
            let stem = stem.to_string_lossy();
            stem == "camera" || stem.starts_with("beam-")
        });
        let ending = path.extension().and_then(|ending| ending.to_str());
        stem && (path.is_dir() || matches!(ending, Some("exr" | "npz"))) || ending == Some("zarr")
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

/// A recording while it is read.
pub(super) struct Reader<'a> {
    pub(super) conventions: Conventions,
    pub(super) scene: &'a Scene,
    pub(super) folder: &'a Path,
    pub(super) channels: &'a Channels,
    pub(super) answers: Answers,
    pub(super) storage: BTreeMap<(SensorId, Item), Storage>,
    /// Channels that were read.
    pub(super) used: Vec<String>,
    /// For each sensor, the channel that tells which rays hit, and whether each does.
    pub(super) hits: Vec<Option<(String, Vec<bool>)>>,
}

/// Which rays of a sensor hit, and the channel that says so.
#[derive(Clone, Copy)]
struct Hits<'a> {
    hits: &'a [bool],
    speaker: &'a str,
    /// Its numbers, if it has one in a cell.
    said: Option<&'a Image<f64>>,
    conventions: Conventions,
}

/// The real numbers of a channel.
#[derive(Clone, Copy)]
struct Reals<'a> {
    /// Name of the channel; of a file without channel names, that of the file.
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
            help: None,
        }
    }

    fn with_help(error: RecordingError, words: Option<String>) -> RecordingError {
        let help = words.map(|words| Box::new(Help { words }));
        match error {
            RecordingError::Channel { file, channel, cell, found, expected, .. } => {
                RecordingError::Channel { file, channel, cell, found, expected, help }
            }
            other => other,
        }
    }

    /// A channel of a sensor and its name, if it is there. Its size is checked.
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
            let is_turned = size == (height, width);
            let help = is_turned.then(|| "an array is (rows, columns): transpose it".to_string());
            return Err(Self::with_help(Self::fault((name, channel), None, found, &expected), help));
        }
        self.used.push(key);
        Ok(Some((name, channel)))
    }

    /// Real numbers of a channel, if it is there.
    fn reals(&mut self, sensor: SensorId, name: &str) -> Result<Option<Reals<'a>>, RecordingError> {
        match self.channel(sensor, name)? {
            None => Ok(None),
            Some((name, channel)) => match &channel.values {
                Values::Reals(image) => Ok(Some(Reals { name, channel, image })),
                Values::Wholes(_) => {
                    let fault =
                        Self::fault((name, channel), None, "whole numbers".into(), "floating-point numbers");
                    let help = names::MAYBE_WHOLE.contains(&name).then(|| {
                        "if they count units of a length, as depth images of 16 bits do, declare the metres of a unit: --scale \
                         0.001 for millimetres. 0 then means \"no hit\""
                            .to_string()
                    });
                    Err(Self::with_help(fault, help))
                }
            },
        }
    }

    /// Columns and rows of the pixels that all beams name: one beam may land on a corner of the image alone.
    fn pixels(&mut self) -> Vec<[u32; 2]> {
        let mut pixels = Vec::new();
        for sensor in (0..self.scene.beams().len()).map(SensorId::Beam) {
            let [columns, rows] = names::PIXEL.map(|name| self.wholes(sensor, name).ok().flatten());
            if let (Some(columns), Some(rows)) = (columns, rows) {
                pixels.extend(columns.cells().iter().zip(rows.cells()).map(|(i, j)| [*i, *j]));
            }
        }
        pixels.retain(|pair| *pair != [u32::MAX; 2]);
        pixels
    }

    /// Whole numbers, also if they are stored as floating-point ones; -1 and numbers that are not finite mean "none".
    fn wholes(&mut self, sensor: SensorId, name: &str) -> Result<Option<Image<u32>>, RecordingError> {
        let Some((name, channel)) = self.channel(sensor, name)? else { return Ok(None) };
        let image = match &channel.values {
            Values::Wholes(image) => return Ok(Some(image.clone())),
            Values::Reals(image) => image,
        };
        let mut cells = Vec::with_capacity(image.cells().len());
        for (index, &value) in image.cells().iter().enumerate() {
            // f32 holds whole numbers up to 2^24 only; 4294967295 for "none" is 2^32 there.
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
            // An index that another one may be rounded to is no index: 2049 is 2048 in half precision.
            if let Some(first) =
                channel.storage.first_ambiguous_whole().filter(|first| value >= f64::from(*first))
                && !none
            {
                let found = format!("{value} in {} precision", channel.storage);
                let expected = format!("whole numbers below {first}, or a type that holds each of them");
                return Err(Self::fault((name, channel), Some(cell(image, index)), found, &expected));
            }
            cells.push(if none { u32::MAX } else { value as u32 });
        }
        Ok(Some(Image::from_cells(image.width(), image.height(), cells)))
    }

    fn store(&mut self, sensor: SensorId, item: impl Into<Item>, storage: Storage) {
        self.storage.insert((sensor, item.into()), storage);
    }

    /// Reads the hits of a sensor.
    pub(super) fn geometry(&mut self, index: usize, sensor: SensorId) -> Result<(), RecordingError> {
        let faces = if self.conventions.ignores_faces {
            // The channel is known, and left out.
            self.used.push(format!("{sensor}/{}", names::FACE));
            None
        } else {
            self.wholes(sensor, names::FACE)?
        };
        let mut values = Vec::new();
        for quantity in HitQuantity::ALL {
            if let Some(parts) = self.components(sensor, quantity.channels())? {
                values.push((quantity, parts));
            }
        }

        // The first channel that is there tells which rays hit; the others must agree with it.
        let hits: Option<(String, Vec<bool>)> = if let Some(faces) = &faces {
            Some((names::FACE.into(), faces.cells().iter().map(|face| *face != u32::MAX).collect()))
        } else {
            values.first().map(|(_, parts)| {
                let of = |part: &Reals<'_>| self.conventions.of_storage(part.channel.storage);
                let means_miss =
                    |at: usize| parts.iter().all(|part| of(part).means_miss(part.image.cells()[at]));
                let cells = parts[0].image.cells().iter().enumerate();
                let hits = cells.map(|(at, x)| x.is_finite() && !means_miss(at)).collect();
                (parts[0].name.to_string(), hits)
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
        let said = values.first().filter(|(_, parts)| parts.len() == 1 && parts[0].name == speaker);
        let said = said.map(|(_, parts)| parts[0].image);
        for (quantity, parts) in values {
            let mut images = Vec::new();
            for part in &parts {
                // A range beyond the largest number is stored as infinity, which would mean "no hit".
                let (most, storage) = (self.scene.max_range(sensor).unwrap_or(0.0), part.channel.storage);
                if quantity.is_length() && most > storage.max() {
                    let found = format!("{storage} precision, which ends at {}", storage.max());
                    let expected = format!("a type that holds ranges up to the sensor's {most} m");
                    return Err(Self::fault((part.name, part.channel), None, found, &expected));
                }
                let conventions = self.conventions.of_storage(storage);
                let hits = Hits { hits: &hits, speaker: &speaker, said, conventions };
                images.push(maybe(*part, hits, quantity.is_length())?);
            }
            let storage = parts.iter().map(|part| part.channel.storage).min().unwrap_or(Storage::F64);
            self.store(sensor, Quantity::from(quantity), storage);
            match self.answers.maps[index].raster_mut(quantity) {
                HitRasterMut::Scalar(raster) => *raster = images.pop(),
                HitRasterMut::Vector(raster) => {
                    let cells = (0..hits.len()).map(|at| {
                        let part = |k: usize| images[k].cells()[at].get();
                        let vector = part(0).zip(part(1)).zip(part(2)).map(|((x, y), z)| DVec3::new(x, y, z));
                        Maybe::from(vector)
                    });
                    *raster = Some(Image::from_cells(width, height, cells.collect()));
                }
            }
        }
        Ok(())
    }

    /// The channels of a quantity, if they are there; a part of them is an error.
    fn components(
        &mut self,
        sensor: SensorId,
        names: &[&str],
    ) -> Result<Option<Vec<Reals<'a>>>, RecordingError> {
        let mut parts = Vec::new();
        let mut absent = None;
        for name in names {
            match self.reals(sensor, name)? {
                Some(part) => parts.push(part),
                None => absent = Some(name),
            }
        }
        match absent {
            None => Ok(Some(parts)),
            Some(_) if parts.is_empty() => Ok(None),
            Some(absent) => Err(RecordingError::Part {
                folder: self.folder.to_path_buf(),
                channel: format!("{sensor}/{absent}"),
                all: names.join(", "),
            }),
        }
    }

    /// Reads the returns of a beam.
    pub(super) fn light(&mut self, beam: usize) -> Result<(), RecordingError> {
        let sensor = SensorId::Beam(beam);
        let (width, height) = self.scene.size(sensor).expect("a sensor of this scene");
        // Which pencils hit, if a channel of hits is there.
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
                        let help = pixels_otherwise(&self.pixels(), [camera.width, camera.height]);
                        let channel = (names::PIXEL[0], &self.channels.by_key[&key]);
                        return Err(Self::with_help(Self::fault(channel, at, found, &expected), help));
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
            (names::OFF_AXIS, Quantity::CosOffAxis, false),
            (names::EMISSION, Quantity::CosView, false),
        ];
        for (name, quantity, is_length) in scalars {
            let Some(reals) = self.reals(sensor, name)? else { continue };
            let conventions = self.conventions.of_storage(reals.channel.storage);
            let image = match &hits {
                Some((speaker, hits)) => {
                    let hits = Hits { hits, speaker, said: None, conventions };
                    maybe_signed(reals, hits, is_length)?
                }
                None => {
                    // No other channel tells which pencils hit; `check` takes that from the truth.
                    let says_hit = |x: &f64| x.is_finite() && !conventions.means_miss(*x);
                    let own: Vec<bool> = reals.image.cells().iter().map(says_hit).collect();
                    maybe_signed(
                        reals,
                        Hits { hits: &own, speaker: name, said: None, conventions },
                        is_length,
                    )?
                }
            };
            self.store(sensor, quantity, reals.channel.storage);
            let returns = &mut self.answers.light[beam].returns;
            match quantity {
                Quantity::CameraDepth => returns.depth = Some(image),
                Quantity::CosOffAxis => returns.cos_off_axis = Some(image),
                _ => returns.cos_view = Some(image),
            }
        }

        let second = self.scene.flux_model().other();
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

/// Column and row of the cell with this index.
fn cell<T: Copy>(image: &Image<T>, index: usize) -> (u32, u32) {
    (index as u32 % image.width(), index as u32 / image.width())
}

/// A map with numbers where rays hit and none elsewhere. Lengths are not negative.
fn maybe(reals: Reals<'_>, hits: Hits<'_>, is_length: bool) -> Result<Image<Maybe<f64>>, RecordingError> {
    let image = maybe_signed(reals, hits, is_length)?;
    if is_length && let Some(index) = image.cells().iter().position(|x| x.get().is_some_and(|x| x < 0.0)) {
        let found = reals.image.cells()[index].to_string();
        let help = negative_lengths(reals, &image, reals.image.cells()[index]);
        let place = (reals.name, reals.channel);
        let fault = Reader::fault(place, Some(cell(reals.image, index)), found, "no negative length");
        return Err(Reader::with_help(fault, Some(help)));
    }
    Ok(image)
}

/// A line of help for pixels outside the image: what would bring all of them into it. One wrong pixel shows no rule, and so nothing is
/// said of it.
fn pixels_otherwise(pixels: &[[u32; 2]], size: [u32; 2]) -> Option<String> {
    let pairs = || pixels.iter().copied();
    let outside = |axis: usize| -> Vec<u32> {
        pairs().map(|pair| pair[axis]).filter(|one| *one >= size[axis]).collect()
    };
    let outside = [outside(0), outside(1)];
    // From 1 on, all that lies outside has one number, the last; no cell has 0, and some have the first.
    let is_from_1 = |axis: usize| {
        let first = pairs().map(|pair| pair[axis]).min();
        outside[axis].len() > 1 && outside[axis].iter().all(|one| *one == size[axis]) && first == Some(1)
    };
    let is_inside = |axis: usize| outside[axis].is_empty();
    let names = match [0, 1].map(is_from_1) {
        [true, true] => Some("columns and rows"),
        [true, false] if is_inside(1) => Some("columns"),
        [false, true] if is_inside(0) => Some("rows"),
        _ => None,
    };
    if let Some(names) = names {
        return Some(format!("{names} count from 0, and not from 1"));
    }
    // Exchanged, they reach farther than that.
    let reaches_farther = outside.iter().any(|outside| outside.iter().any(|one| *one != outside[0]));
    (reaches_farther && pairs().all(|[i, j]| j < size[0] && i < size[1]))
        .then(|| "pixel.I is the column and pixel.J the row: they are exchanged".into())
}

/// A line of help for a map of lengths with negative ones: many of one number may mean "no hit", many numbers are lengths.
fn negative_lengths(reals: Reals<'_>, lengths: &Image<Maybe<f64>>, first: f64) -> String {
    let is_other = |cell: &Maybe<f64>| cell.get().is_some_and(|length| length < 0.0 && length != first);
    if lengths.cells().iter().any(is_other) {
        let is_positive = |cell: &Maybe<f64>| cell.get().is_some_and(|length| length > 0.0);
        let looks = "lengths are positive in the direction in which the sensor looks";
        match lengths.cells().iter().any(is_positive) {
            true => format!("{looks}; numbers of a z-buffer, from -1 to 1, are no depths"),
            false => format!("{looks}: a camera that looks along -z writes -z"),
        }
    } else {
        declare_miss(first, reals.channel.storage)
    }
}

/// A line of help for a finite number that may mean "no hit": any other means that by itself.
fn declare_miss(value: f64, storage: Storage) -> String {
    // As people write it, and as the file has it.
    let value = match storage {
        Storage::Steps(step) => libm::round(value / step.get()),
        _ => value,
    };
    // Not every command that reads recordings has the option.
    format!(
        "if {value} means \"no hit\" in this recording, declare --miss {value} to check, or \"miss\": {value} in its candidate.json"
    )
}

/// The same, with numbers of any sign: a point may lie behind the camera.
fn maybe_signed(
    Reals { name, channel, image }: Reals<'_>,
    Hits { hits, speaker, said, conventions }: Hits<'_>,
    is_length: bool,
) -> Result<Image<Maybe<f64>>, RecordingError> {
    let mut cells = Vec::with_capacity(hits.len());
    for (index, (&value, &hit)) in image.cells().iter().zip(hits).enumerate() {
        let wrong = |expected: String, help: Option<String>| {
            let fault =
                Reader::fault((name, channel), Some(cell(image, index)), value.to_string(), &expected);
            Err(Reader::with_help(fault, help))
        };
        if hit && !value.is_finite() {
            let help = match said {
                _ if speaker == names::FACE => Some(format!(
                    "if {speaker} does not say which rays hit, declare --no-faces to check, or \"no_faces\": true in its candidate.json: it is \
                     then left out"
                )),
                // A map that says "hit" by a number that others write for "no hit".
                Some(said) => Some(declare_miss(said.cells()[index], channel.storage)),
                None => None,
            };
            return wrong(format!("a number, as {speaker} says that something is hit"), help);
        }
        // On reading, any value that is not finite means no hit. (docs/formats/files.md)
        let is_nothing = !value.is_finite() || conventions.means_miss(value);
        if !hit && !is_nothing {
            let nothing = if is_length { "+Inf" } else { "NaN" };
            let expected = format!("{nothing}, as {speaker} says that nothing is hit");
            // To declare this number in place of the other would make that one wrong again.
            let help = match conventions.miss {
                None => declare_miss(value, channel.storage),
                Some(miss) => format!(
                    "write {nothing} where nothing is hit: one number alone can be declared to mean that, and {miss} is"
                ),
            };
            return wrong(expected, Some(help));
        }
        cells.push(Maybe::from(hit.then_some(value)));
    }
    Ok(Image::from_cells(image.width(), image.height(), cells))
}

/// A map of flux: never negative, never infinite, 0 where there is none.
fn flux(Reals { name, channel, image }: Reals<'_>) -> Result<Image<f64>, RecordingError> {
    if let Some(index) = image.cells().iter().position(|flux| !(*flux >= 0.0 && flux.is_finite())) {
        let found = image.cells()[index].to_string();
        let expected = "a flux that is not negative, and 0 where there is none";
        return Err(Reader::fault((name, channel), Some(cell(image, index)), found, expected));
    }
    Ok(image.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of pixels of an image of 4 x 3.
    fn said(pixels: &[[u32; 2]]) -> Option<String> {
        pixels_otherwise(pixels, [4, 3])
    }

    #[test]
    fn pixels_outside_the_image_are_told_what_all_of_them_show() {
        let all: Vec<[u32; 2]> = (0..4).flat_map(|i| (0..3).map(move |j| [i, j])).collect();
        let with = |change: fn([u32; 2]) -> [u32; 2]| {
            let changed: Vec<[u32; 2]> = all.iter().map(|pair| change(*pair)).collect();
            said(&changed)
        };
        let exchanged = Some("pixel.I is the column and pixel.J the row: they are exchanged".to_string());
        let from_1 = |names: &str| Some(format!("{names} count from 0, and not from 1"));
        assert_eq!(with(|[i, j]| [i + 1, j + 1]), from_1("columns and rows"));
        assert_eq!(with(|[i, j]| [i + 1, j]), from_1("columns"));
        assert_eq!(with(|[i, j]| [i, j + 1]), from_1("rows"));
        assert_eq!(with(|[i, j]| [i + 9, j]), None);
        // Only the first three columns are met: rows from 1 would be in the image if they were exchanged.
        let left: Vec<[u32; 2]> = all.iter().copied().filter(|[i, _]| *i < 3).collect();
        let from_below: Vec<[u32; 2]> = left.iter().map(|[i, j]| [*i, j + 1]).collect();
        assert_eq!(said(&from_below), from_1("rows"));
        // One cell that is wrong, as 2 changed to 3: neither is exchanged, nor do the others count from 1.
        let mut one = left;
        one.last_mut().expect("a cell")[1] = 3;
        assert_eq!(said(&one), None);
        // An image of 7 x 3, of which the pixels are exchanged.
        let wide: Vec<[u32; 2]> = (0..7).flat_map(|i| (0..3).map(move |j| [j, i])).collect();
        let of_wide = |pixels: &[[u32; 2]]| pixels_otherwise(pixels, [7, 3]);
        assert_eq!(of_wide(&wide), exchanged);
        // All but one: that is no exchange.
        let mut but_one = wide;
        but_one[0] = [4, 0];
        assert_eq!(of_wide(&but_one), None);
    }
}
