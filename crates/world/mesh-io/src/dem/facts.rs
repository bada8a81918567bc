//! What an elevation model says of itself: coordinate systems, units, unknown heights; and what stands out of it.

use serde_json::{Value, json};

use crate::dem::coordinate_system::{AxisSystem, UnitSource};
use crate::dem::model::Dem;

/// Maximum length of the name of a coordinate system, as people read it.
const MAX_NAME_CHARS: usize = 80;

/// What an elevation model says of itself, without its heights.
#[derive(Debug, Clone, PartialEq)]
pub struct DemFacts {
    /// Coordinate system of x and y in the file.
    pub map: AxisSystem,
    /// Coordinate system of the heights in the file.
    pub heights: AxisSystem,
    /// Sample that stands for "not known" by the file's word, beside NaN.
    pub nodata: Option<f64>,
    /// Samples that stand for it by the caller's word.
    pub given_nodata: Vec<f64>,
    /// Number of posts whose height is not known.
    pub unknown: usize,
    /// Posts that stand out by more than the rest of the model is high.
    pub spikes: Option<SpikeFacts>,
    /// Distance of neighbouring posts along x and y, metres, if either is below 1 cm.
    pub dense: Option<[f64; 2]>,
}

/// Distance of posts below which an elevation model is hardly one in metres: surveys of the ground have posts of centimetres at the
/// least. A degree that is taken as a metre gives less: a second of arc, the spacing of many models, is 0.0003 degrees.
pub const MIN_POST_SPACING_M: f64 = 0.01;

/// Posts that stand out of an elevation model.
#[derive(Debug, Clone, PartialEq)]
pub struct SpikeFacts {
    /// Their number.
    pub count: usize,
    /// The one that is farthest from the rest, in the global frame, metres.
    pub worst: [f64; 3],
    /// How far it is above the rest, metres; negative if it is below.
    pub stands_out: f64,
    /// Difference of the highest and the lowest of the rest, metres.
    pub rest: f64,
}

impl SpikeFacts {
    /// The facts as a sentence without its full stop.
    pub fn words(&self) -> String {
        let Self { count, worst: [x, y, _], stands_out, rest } = self;
        let side = if *stands_out < 0.0 { "below" } else { "above" };
        let stands_out = stands_out.abs();
        let stand = if *count == 1 { "stands" } else { "stand" };
        format!(
            "{count} of the posts {stand} out: the worst, at ({x}, {y}), is {stands_out:.1} m {side} all others, which span {rest:.1} m"
        )
    }
}

impl Dem {
    /// What the model says of itself.
    pub fn facts(&self) -> DemFacts {
        let spikes = self.spikes().map(|spikes| {
            let columns = self.posts.columns;
            // A model has at most 2^24 columns and rows.
            let [column, row] = [spikes.worst as u32 % columns, spikes.worst as u32 / columns];
            SpikeFacts {
                count: spikes.count,
                worst: self.posts.at(column, row).to_array(),
                stands_out: spikes.stands_out,
                rest: spikes.rest,
            }
        });
        DemFacts {
            map: self.map.clone(),
            heights: self.heights.clone(),
            nodata: self.nodata,
            given_nodata: self.given_nodata.clone(),
            unknown: self.unknown,
            spikes,
            dense: (self.posts.spacing.min_element() < MIN_POST_SPACING_M)
                .then(|| self.posts.spacing.to_array()),
        }
    }
}

impl DemFacts {
    /// The facts for programs.
    pub fn to_json(&self) -> Value {
        json!({
            "map": system(&self.map),
            "vertical": system(&self.heights),
            "unknown_posts": self.unknown,
            "nodata": self.nodata.filter(|nodata| nodata.is_finite()),
            "nodata_given": self.given_nodata,
            "spikes": self.spikes.as_ref().map(|spikes| json!({
                "count": spikes.count,
                "worst_m": spikes.worst,
                "stands_out_m": spikes.stands_out,
                "rest_m": spikes.rest,
            })),
        })
    }

    /// The facts for people: names of lines, and their words.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![
            ("map", name(&self.map)),
            ("unit", unit(&self.map)),
            ("vertical", name(&self.heights)),
            ("z unit", unit(&self.heights)),
            ("unknown posts", self.unknown_words()),
        ];
        lines.extend(self.spikes.as_ref().map(|spikes| ("warning", spikes.words())));
        lines.extend(self.dense_words().map(|words| ("warning", words + "?")));
        lines
    }

    /// That the posts lie very near each other, as a question without its mark; `None` if they do not.
    pub fn dense_words(&self) -> Option<String> {
        let [x, y] = self.dense?;
        Some(format!(
            "the posts are {x} x {y} m apart: are the coordinates degrees, which are taken as metres"
        ))
    }

    /// Name of the coordinate system of x and y, if the file has one.
    pub fn map_name(&self) -> Option<String> {
        is_named(&self.map).then(|| name(&self.map))
    }

    /// EPSG code of the coordinate system of x and y, if the file has one and it is in metres, as all places of a scene are.
    pub fn metric_map_code(&self) -> Option<u16> {
        self.map.metric_code()
    }

    /// The systems and units in one line.
    pub fn words(&self) -> String {
        let system = |of: &AxisSystem, what: &str| match is_named(of) {
            true => name(of),
            false => format!("the file names no system of {what}"),
        };
        let systems = match [&self.map, &self.heights].map(is_named) {
            [false, false] => "the file names no coordinate system".to_string(),
            _ => format!("{}; {}", system(&self.map, "the map"), system(&self.heights, "the heights")),
        };
        format!("map in {}, heights in {}; {systems}", unit(&self.map), unit(&self.heights))
    }

    /// How many posts are unknown, and what says so.
    fn unknown_words(&self) -> String {
        let of_file = self.nodata.filter(|nodata| nodata.is_finite());
        let of_file = of_file.map(|sample| format!("{sample} as the file says"));
        let given = self.given_nodata.iter().map(|sample| format!("{sample} as is given"));
        let samples: Vec<String> = of_file.into_iter().chain(given).collect();
        let samples =
            if samples.is_empty() { String::new() } else { format!(" (NaN; {})", samples.join("; ")) };
        format!("{}{samples}", self.unknown)
    }
}

fn system(system: &AxisSystem) -> Value {
    let unit = system.unit.unit;
    json!({
        "name": system.name,
        "epsg": system.code,
        "unit": unit.name,
        "unit_epsg": unit.code,
        "metres_per_unit": unit.metres(),
        "unit_from": system.source.word(),
        "is_depth": system.unit.is_depth,
    })
}

/// Whether the file says which coordinate system it is.
fn is_named(system: &AxisSystem) -> bool {
    system.name.is_some() || system.code.is_some()
}

fn name(system: &AxisSystem) -> String {
    let name = match (&system.name, system.code) {
        (Some(name), Some(code)) => format!("{name} (EPSG:{code})"),
        (Some(name), None) => name.clone(),
        (None, Some(code)) => format!("EPSG:{code}"),
        (None, None) => "the file does not say".to_string(),
    };
    // A name may be a text of many lines.
    name.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(MAX_NAME_CHARS).collect()
}

/// The unit of a coordinate system, and what says it.
fn unit(system: &AxisSystem) -> String {
    let unit = system.unit.unit;
    let code = unit.code.map_or(String::new(), |code| format!(" (EPSG:{code})"));
    let size = match unit.metres() {
        1.0 => String::new(),
        metres => format!(", {metres} m"),
    };
    let source = match system.source {
        UnitSource::Option => ", as is given",
        UnitSource::Default => ", by default: the file does not say",
        UnitSource::System | UnitSource::Key => "",
    };
    let depth = if system.unit.is_depth { "; depths, which became heights by their sign" } else { "" };
    format!("{}{code}{size}{source}{depth}", unit.name)
}
