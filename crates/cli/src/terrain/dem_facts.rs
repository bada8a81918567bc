//! What an elevation model says about itself: coordinate systems, units, unknown heights; and what stands out of it.

use raypencil::io::{AxisSystem, Dem, UnitSource};
use serde_json::{Value, json};

/// Maximum length of a name.
const MAX_NAME_CHARS: usize = 80;

/// Adds the keys of one report to another.
pub(super) fn extend(report: &mut Value, more: Value) {
    if let (Value::Object(report), Value::Object(more)) = (report, more) {
        report.extend(more);
    }
}

/// The facts for programs.
pub(super) fn dem_facts(dem: &Dem) -> Value {
    json!({
        "map": system(&dem.map),
        "vertical": system(&dem.heights),
        "unknown_posts": dem.unknown,
        "nodata": dem.nodata.filter(|nodata| nodata.is_finite()),
        "nodata_given": dem.given_nodata,
        "spikes": dem.spikes().map(|spikes| {
            let columns = dem.posts.columns;
            // A model has at most 2^24 columns and rows.
            let [column, row] = [spikes.worst as u32 % columns, spikes.worst as u32 / columns];
            json!({
                "count": spikes.count,
                "worst_m": dem.posts.at(column, row).to_array(),
                "stands_out_m": spikes.stands_out,
                "rest_m": spikes.rest,
            })
        }),
    })
}

/// A coordinate system.
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

/// The facts for people, from those for programs.
pub(super) fn dem_lines(report: &Value) -> Vec<(&'static str, String)> {
    let mut lines = vec![
        ("map", name(&report["map"])),
        ("unit", unit(&report["map"], "--unit")),
        ("vertical", name(&report["vertical"])),
        ("z unit", unit(&report["vertical"], "--z-unit")),
        ("unknown posts", unknown(report)),
    ];
    let spikes = &report["spikes"];
    if let Some(count) = spikes["count"].as_u64() {
        let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
        let distance = number(&spikes["stands_out_m"]);
        let place = &spikes["worst_m"];
        lines.push((
            "warning",
            format!(
                "{count} of the posts stand out: the worst, at ({}, {}), is {:.1} m {} all others, which span {:.1} m",
                place[0],
                place[1],
                distance.abs(),
                if distance < 0.0 { "below" } else { "above" },
                number(&spikes["rest_m"]),
            ),
        ));
    }
    lines
}

/// The name of a coordinate system.
fn name(system: &Value) -> String {
    let name = match (system["name"].as_str(), system["epsg"].as_u64()) {
        (Some(name), Some(code)) => format!("{name} (EPSG:{code})"),
        (Some(name), None) => name.to_string(),
        (None, Some(code)) => format!("EPSG:{code}"),
        (None, None) => "the file does not say".to_string(),
    };
    // A name may be a text of many lines.
    name.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(MAX_NAME_CHARS).collect()
}

/// The unit of a coordinate system, and what says it: the file, this option, or nothing.
fn unit(system: &Value, option: &str) -> String {
    let unit = system["unit"].as_str().unwrap_or_default();
    let code = system["unit_epsg"].as_u64().map_or(String::new(), |code| format!(" (EPSG:{code})"));
    let size = match system["metres_per_unit"].as_f64() {
        Some(1.0) | None => String::new(),
        Some(metres) => format!(", {metres} m"),
    };
    let source = match system["unit_from"].as_str() {
        Some(word) if word == UnitSource::Option.word() => format!(", as {option} says"),
        Some(word) if word == UnitSource::Default.word() => ", by default: the file does not say".to_string(),
        _ => String::new(),
    };
    let depth = if system["is_depth"] == true { "; depths, which became heights by their sign" } else { "" };
    format!("{unit}{code}{size}{source}{depth}")
}

/// How many posts are unknown, and what says so.
fn unknown(report: &Value) -> String {
    let mut samples: Vec<String> = Vec::new();
    samples.extend(report["nodata"].as_f64().map(|sample| format!("{sample} as the file says")));
    let given = report["nodata_given"].as_array().into_iter().flatten();
    let given = given.filter_map(Value::as_f64);
    samples.extend(given.map(|sample| format!("{sample} as --nodata says")));
    let samples = if samples.is_empty() { String::new() } else { format!(" (NaN; {})", samples.join("; ")) };
    format!("{}{samples}", report["unknown_posts"])
}
