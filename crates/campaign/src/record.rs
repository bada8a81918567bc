//! What is kept of a terrain: counts, worst errors, wrong rays. No times, so that the same terrain gives the same bytes.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::Path;

use crate::campaign::{Campaign, CampaignError};
use raypencil_files::{FileError, write_atomically};
use raypencil_judge::{Class, ItemTally, Largest, Quantity, SensorResult};

/// The number of the form of these files.
pub(super) const FORMAT: u32 = 1;

/// Which scene of a terrain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PartName {
    /// A random rig's own sensors, both renderers exact.
    Own,
    /// The same with the paper's approximations.
    Paper,
    /// Narrow sensors at what is hard, every ray judged.
    Aimed,
    /// A lattice whose vertices lie exactly on rays, every ray judged.
    Lattice,
}

impl PartName {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Own, Self::Paper, Self::Aimed, Self::Lattice];

    /// As in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Paper => "paper",
            Self::Aimed => "aimed",
            Self::Lattice => "lattice",
        }
    }
}

/// One terrain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TerrainRecord {
    /// Its number.
    pub terrain: u64,
    /// Triangles of the ground.
    pub faces: u64,
    /// Its scenes.
    pub parts: Vec<PartRecord>,
}

/// One scene of a terrain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartRecord {
    /// Which.
    pub part: PartName,
    /// Rays compared.
    pub compared: u64,
    /// By class, in the order of [`Class`].
    pub by_class: [u64; 6],
    /// Rays that one side does not have.
    pub not_compared: u64,
    /// Rays that the referee ruled on.
    pub judged: u64,
    /// Each quantity that was compared.
    pub quantities: Vec<QuantityRecord>,
    /// The first wrong rays.
    pub wrong: Vec<WrongRay>,
}

/// One quantity of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuantityRecord {
    /// Which.
    pub quantity: Quantity,
    /// Rays by class, in the order of [`Class`].
    pub by_class: [u64; 6],
    /// Rays of which one side does not say it.
    pub not_compared: u64,
    /// The largest difference.
    pub worst_error: Option<WorstRecord>,
    /// The largest ratio of a difference to its bound.
    pub worst_ratio: Option<WorstRecord>,
}

/// The largest of something, and where.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorstRecord {
    /// The value; `None` if it is no finite number.
    pub value: Option<f64>,
    /// `camera`, `beam-0`, ...
    pub sensor: String,
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
}

/// A ray that is a defect, or undecided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WrongRay {
    /// `camera`, `beam-0`, ...
    pub sensor: String,
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
    /// The quantity that is worst.
    pub quantity: Quantity,
    /// What each side says, in words.
    pub what: String,
}

/// How many wrong rays of a scene are described; all are counted.
const DESCRIBED: usize = 10;

impl PartRecord {
    /// What a comparison found.
    pub(super) fn of(part: PartName, sensors: &[SensorResult]) -> Self {
        let mut record = Self {
            part,
            compared: 0,
            by_class: [0; 6],
            not_compared: 0,
            judged: 0,
            quantities: Vec::new(),
            wrong: Vec::new(),
        };
        let mut totals = Quantity::ALL.map(|quantity| (quantity, ItemTally::default()));
        for sensor in sensors {
            record.compared += sensor.compared();
            record.not_compared += sensor.not_compared;
            record.judged += sensor.judged;
            for (mine, theirs) in record.by_class.iter_mut().zip(sensor.by_class) {
                *mine += theirs;
            }
            for (item, tally) in &sensor.items {
                totals[item.quantity as usize].1.add(tally);
            }
            let room = DESCRIBED.saturating_sub(record.wrong.len());
            record.wrong.extend(sensor.defects.iter().take(room).map(|defect| WrongRay {
                sensor: defect.place.sensor.to_string(),
                i: defect.place.i,
                j: defect.place.j,
                quantity: defect.item.quantity,
                what: defect.what.clone(),
            }));
        }
        let said = |(_, tally): &(Quantity, ItemTally)| {
            tally.not_compared > 0 || tally.by_class.iter().any(|count| *count > 0)
        };
        record.quantities = totals
            .into_iter()
            .filter(said)
            .map(|(quantity, tally)| QuantityRecord {
                quantity,
                by_class: tally.by_class,
                not_compared: tally.not_compared,
                worst_error: tally.worst_error.map(worst),
                worst_ratio: tally.worst_ratio.map(worst),
            })
            .collect();
        record
    }

    /// Rays in a class.
    pub fn of_class(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }
}

fn worst(Largest { value, place, .. }: Largest) -> WorstRecord {
    WorstRecord {
        value: value.is_finite().then_some(value),
        sensor: place.sensor.to_string(),
        i: place.i,
        j: place.j,
    }
}

impl WorstRecord {
    /// The words of `raypencil probe` that name the ray.
    pub(super) fn cell(&self) -> String {
        probe_words(&self.sensor, self.i, self.j)
    }
}

/// The words of `raypencil probe` that name a ray.
pub(crate) fn probe_words(sensor: &str, i: u32, j: u32) -> String {
    match sensor.strip_prefix("beam-") {
        Some(beam) => format!("--beam {beam} --pencil {i},{j}"),
        None => format!("--pixel {i},{j}"),
    }
}

/// A file of a campaign: what it holds, of which campaign, and the digest of both.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sealed<T> {
    format: u32,
    campaign: Campaign,
    /// Of the compact JSON of `(format, campaign, contents)`.
    sha256: String,
    contents: T,
}

fn digest<T: Serialize>(campaign: &Campaign, contents: &T) -> String {
    let text = serde_json::to_string(&(FORMAT, campaign, contents)).expect("JSON of numbers and texts");
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Writes a file that proves to be whole when it is read.
pub(crate) fn write_sealed<T: Serialize>(
    path: &Path,
    campaign: &Campaign,
    contents: &T,
) -> Result<(), FileError> {
    let sealed = serde_json::json!({
        "format": FORMAT,
        "campaign": campaign,
        "sha256": digest(campaign, contents),
        "contents": contents,
    });
    let text = format!("{sealed}\n");
    write_atomically(path, |file| file.write_all(text.as_bytes()))
}

/// Reads it back: the campaign and the contents.
pub(crate) fn read_sealed<T: Serialize + for<'de> Deserialize<'de>>(
    path: &Path,
) -> Result<(Campaign, T), CampaignError> {
    let file = path.display().to_string();
    let refuse = |found: String, expected: &str| CampaignError::Record {
        file: file.clone(),
        found,
        expected: expected.into(),
    };
    let text = std::fs::read_to_string(path).map_err(|source| FileError::Io {
        path: path.to_path_buf(),
        action: "read",
        source,
    })?;
    let sealed: Sealed<T> =
        serde_json::from_str(&text).map_err(|error| refuse(error.to_string(), "a result of a campaign"))?;
    if sealed.format != FORMAT {
        return Err(refuse(format!("format {}", sealed.format), &format!("format {FORMAT}")));
    }
    if digest(&sealed.campaign, &sealed.contents) != sealed.sha256 {
        return Err(refuse("the digest of its contents is another".into(), "a file as it was written"));
    }
    Ok((sealed.campaign, sealed.contents))
}
