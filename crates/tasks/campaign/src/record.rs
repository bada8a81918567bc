//! The record of a terrain: counts, worst errors, wrong rays. It has no times, so the same terrain gives the same
//! bytes.

use raypencil_judge::{Class, ItemTally, Largest, Quantity, SensorResult};
use serde::{Deserialize, Serialize};

/// Maximum number of wrong rays per scene that are described; all are counted.
pub(crate) const MAX_DESCRIBED_RAYS: usize = 10;

/// One of the scenes of a terrain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PartName {
    /// A random rig; both renderers are exact.
    Own,
    /// The same scene; scanline renders it with the paper's approximations.
    Paper,
    /// Narrow beams aimed at vertices, edges, silhouettes and grazing faces. The referee rules on every ray.
    Aimed,
    /// A lattice whose vertices lie exactly on rays. The referee rules on every ray.
    Lattice,
}

impl PartName {
    /// All scenes, in the order of reports.
    pub const ALL: [Self; 4] = [Self::Own, Self::Paper, Self::Aimed, Self::Lattice];

    /// The name in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Paper => "paper",
            Self::Aimed => "aimed",
            Self::Lattice => "lattice",
        }
    }
}

/// Record of a terrain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TerrainRecord {
    /// Number of the terrain.
    pub terrain: u64,
    /// Number of triangles of the ground.
    pub faces: u64,
    /// Records of its scenes.
    pub parts: Vec<PartRecord>,
}

/// Record of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartRecord {
    /// The scene.
    pub part: PartName,
    /// Number of rays compared.
    pub compared: u64,
    /// Number of rays that hit the terrain, by the tracer.
    pub hits: u64,
    /// Number of rays by class, in the order of [`Class`].
    pub by_class: [u64; 6],
    /// Number of rays that one side lacks.
    pub not_compared: u64,
    /// Number of rays that the referee ruled on.
    pub judged: u64,
    /// Records of the quantities that were compared.
    pub quantities: Vec<QuantityRecord>,
    /// The first wrong rays.
    pub wrong: Vec<WrongRay>,
    /// Why rays of the program under test are wrong, where mistakes explain it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reasons: Vec<ReasonRecord>,
    /// Name of the program under test, if it answered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub candidate: Option<String>,
    /// Why the program under test did not answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
}

/// Record of a quantity of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuantityRecord {
    /// The quantity.
    pub quantity: Quantity,
    /// Number of rays by class, in the order of [`Class`].
    pub by_class: [u64; 6],
    /// Number of rays for which one side lacks the quantity.
    pub not_compared: u64,
    /// Largest difference, in the quantity's unit.
    pub worst_error: Option<WorstRecord>,
    /// Largest ratio of a difference to its bound.
    pub worst_ratio: Option<WorstRecord>,
}

/// A largest value and its ray.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorstRecord {
    /// The value; `None` if it is not finite.
    pub value: Option<f64>,
    /// Name of the sensor: `camera`, `beam-0`, ...
    pub sensor: String,
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
}

/// A ray that is a defect or undecided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WrongRay {
    /// Name of the sensor: `camera`, `beam-0`, ...
    pub sensor: String,
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
    /// The quantity of the worst class.
    pub quantity: Quantity,
    /// The values of both sides and the ruling, in words.
    pub what: String,
}

/// A reason why rays of a scene are wrong: the mistakes and what they explain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReasonRecord {
    /// Names of the mistakes for programs, one or two.
    pub mistakes: Vec<String>,
    /// What would make the rays right, as a clause that follows "if".
    pub clause: String,
    /// Wrong rays on which the mistakes were tried.
    pub wrong: u64,
    /// Those that they explain.
    pub explained: u64,
    /// Right rays on which the mistakes were tried.
    pub right: u64,
    /// Those that become wrong.
    pub broken: u64,
}

impl PartRecord {
    /// The record of a comparison of all sensors; `hits` of their rays hit the terrain.
    pub(crate) fn of(part: PartName, hits: u64, sensors: &[SensorResult]) -> Self {
        let mut record = Self {
            part,
            compared: 0,
            hits,
            by_class: [0; 6],
            not_compared: 0,
            judged: 0,
            quantities: Vec::new(),
            wrong: Vec::new(),
            reasons: Vec::new(),
            candidate: None,
            failed: None,
        };
        let mut totals = Quantity::ALL.map(|quantity| (quantity, ItemTally::default()));
        for sensor in sensors {
            record.compared += sensor.compared();
            record.not_compared += sensor.not_compared;
            record.judged += sensor.judged;
            for (mine, theirs) in record.by_class.iter_mut().zip(sensor.by_class) {
                *mine += theirs;
            }
            for (item, tally) in sensor.items.iter() {
                totals[item.quantity as usize].1.add(tally);
            }
            let room = MAX_DESCRIBED_RAYS.saturating_sub(record.wrong.len());
            record.wrong.extend(sensor.defects.iter().take(room).map(|defect| WrongRay {
                sensor: defect.place.sensor.to_string(),
                i: defect.place.i,
                j: defect.place.j,
                quantity: defect.item.quantity,
                what: defect.what.clone(),
            }));
        }
        let is_present = |(_, tally): &(Quantity, ItemTally)| {
            tally.not_compared > 0 || tally.by_class.iter().any(|count| *count > 0)
        };
        record.quantities = totals
            .into_iter()
            .filter(is_present)
            .map(|(quantity, tally)| QuantityRecord {
                quantity,
                by_class: tally.by_class,
                not_compared: tally.not_compared,
                worst_error: tally.worst_error.map(worst_record),
                worst_ratio: tally.worst_ratio.map(worst_record),
            })
            .collect();
        record
    }

    /// Number of rays of a class.
    pub fn of_class(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }
}

fn worst_record(Largest { value, place, .. }: Largest) -> WorstRecord {
    WorstRecord {
        value: value.is_finite().then_some(value),
        sensor: place.sensor.to_string(),
        i: place.i,
        j: place.j,
    }
}

impl WorstRecord {
    /// The arguments of `raypencil probe` that select the ray.
    pub(crate) fn probe_arguments(&self) -> String {
        probe_arguments(&self.sensor, self.i, self.j)
    }
}

/// The arguments of `raypencil probe` that select a ray.
pub(crate) fn probe_arguments(sensor: &str, i: u32, j: u32) -> String {
    match sensor.strip_prefix("beam-") {
        Some(beam) => format!("--beam {beam} --pencil {i},{j}"),
        None => format!("--pixel {i},{j}"),
    }
}
