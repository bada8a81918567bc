//! Parsers of option values. Their messages say what was expected.

use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::{PossibleValue, PossibleValuesParser, StringValueParser, TypedValueParser};
use raypencil::campaign::{MAX_SHARDS, PartName, Shard};
use raypencil::cast::{BagFields, CloudFrame, PcdData, rays_from_bytes};
use raypencil::drive::RecordContents;
use raypencil::harness::MapFormat;
use raypencil::io::{DeclaredChannel, HeightUnit, LengthUnit, NoData, SceneIoError, Setting, UpAxis};
use raypencil::judge::{Class, JudgeShare};
use raypencil::pack::{Arithmetic, PackLabel};
use raypencil::rover::RULE_NAMES;
use raypencil::sweep::{Axis, Chart, SweepError, Task};
use raypencil::{CastRay, Fidelity, FluxModel, Precision};

/// A value that an option accepts: its name, its line of help, and what it stands for.
type Named<T> = (&'static str, &'static str, T);

/// The classes that `--class` accepts.
const CLASSES: [Named<Class>; 5] = [
    ("defect", "One of them is wrong", Class::Defect),
    ("undecided", "The referee could not decide", Class::Undecided),
    ("approximation", "An approximation of the paper", Class::Approximation),
    ("rounding", "An exact answer to a ray displaced within the renderer's precision", Class::Rounding),
    ("tie", "Several faces at exactly the same point", Class::Tie),
];

/// Parses one of some named values.
fn one_of<T, const N: usize>(values: [Named<T>; N]) -> impl TypedValueParser<Value = T>
where
    T: Clone + Send + Sync + 'static,
{
    let names = values.iter().map(|(name, help, _)| PossibleValue::new(*name).help(*help));
    PossibleValuesParser::new(names.collect::<Vec<_>>()).map(move |given| {
        let found = values.iter().find(|(name, _, _)| *name == given);
        found.expect("clap accepts these names alone").2.clone()
    })
}

/// `--flux`.
pub(crate) fn flux_model() -> impl TypedValueParser<Value = FluxModel> {
    one_of([
        (FluxModel::Radiometric.word(), "Radiometric, in watts", FluxModel::Radiometric),
        (FluxModel::Eq1.word(), "Equation (1) of the paper as printed, in W/m", FluxModel::Eq1),
    ])
}

/// `--up`.
pub(crate) fn up_axis() -> impl TypedValueParser<Value = UpAxis> {
    one_of([
        (UpAxis::Y.word(), "(x, y, z) of the file is (x, -z, y) of the terrain", UpAxis::Y),
        (UpAxis::Z.word(), "The axes of the file are those of the terrain", UpAxis::Z),
    ])
}

/// A mesh or another ground. Its name stands in reports, in records and in commands to be copied, so it is text, as that of a scene.
pub(crate) fn named_file() -> impl TypedValueParser<Value = PathBuf> {
    StringValueParser::new().map(PathBuf::from)
}

/// `--bag`.
pub(crate) fn bag_fields() -> impl TypedValueParser<Value = BagFields> {
    one_of([
        (
            BagFields::Velodyne.option(),
            "x y z intensity ring time, of velodyne_pointcloud",
            BagFields::Velodyne,
        ),
        (
            BagFields::Ouster.option(),
            "x y z intensity t reflectivity ring ambient range, of ouster_ros",
            BagFields::Ouster,
        ),
        (
            BagFields::Livox.option(),
            "x y z intensity tag line timestamp, of livox_ros_driver2; always dense",
            BagFields::Livox,
        ),
    ])
}

/// `--frame`.
pub(crate) fn cloud_frame() -> impl TypedValueParser<Value = CloudFrame> {
    one_of([
        (CloudFrame::Mesh.option(), "That of the mesh", CloudFrame::Mesh),
        (CloudFrame::Sensor.option(), "The sensor's own at the time of each ray", CloudFrame::Sensor),
        (
            CloudFrame::SensorAtStart.option(),
            "The sensor's own at the time of the first ray",
            CloudFrame::SensorAtStart,
        ),
        (
            CloudFrame::SensorAtEnd.option(),
            "The sensor's own at the time of the last ray",
            CloudFrame::SensorAtEnd,
        ),
    ])
}

/// `--pcd`.
pub(crate) fn pcd_data() -> impl TypedValueParser<Value = PcdData> {
    one_of([
        (PcdData::Binary.word(), "Point by point", PcdData::Binary),
        (PcdData::BinaryCompressed.word(), "Field by field, compressed by LZF", PcdData::BinaryCompressed),
    ])
}

/// `--nodata`.
pub(crate) fn nodata(text: &str) -> Result<NoData, String> {
    NoData::parse(text)
}

/// `--unit`.
pub(crate) fn length_unit(text: &str) -> Result<LengthUnit, String> {
    LengthUnit::parse(text)
}

/// `--z-unit`.
pub(crate) fn height_unit(text: &str) -> Result<HeightUnit, String> {
    HeightUnit::parse(text)
}

/// `--do`.
pub(crate) fn task() -> impl TypedValueParser<Value = Task> {
    one_of([
        ("validate", "Two renderers render it, and every ray is compared", Task::Validate),
        ("render", "One renderer renders it, and its maps are written", Task::Render),
        ("drive", "The rover drives over it", Task::Drive),
    ])
}

/// `KEY=VALUES` of a sweep.
pub(crate) fn axis(text: &str) -> Result<Axis, String> {
    Axis::parse(text).map_err(|error| without_text(&error, text))
}

/// `RESULT,KEY` or `RESULT,KEY,KEY`.
pub(crate) fn chart(text: &str) -> Result<Chart, String> {
    Chart::parse(text).map_err(|error| without_text(&error, text))
}

/// The message without the text that the parser of arguments names itself.
fn without_text(error: &SweepError, text: &str) -> String {
    match error {
        SweepError::Axis { message, .. } => message.clone(),
        error => error.to_string().replace(&format!("{text}: "), ""),
    }
}

/// `--format`.
pub(crate) fn map_format() -> impl TypedValueParser<Value = MapFormat> {
    one_of([
        (
            "exr",
            "An OpenEXR file for each sensor, a channel for each quantity, single precision",
            MapFormat::Exr,
        ),
        ("exr-each", "An OpenEXR file for each quantity, as viewers and OpenCV open it", MapFormat::ExrEach),
        ("npy", "A NumPy file for each quantity, double precision", MapFormat::Npy),
        ("npz", "A NumPy archive for each sensor, double precision", MapFormat::Npz),
        ("zarr", "A Zarr store with a group for each sensor, double precision", MapFormat::Zarr),
    ])
}

pub(crate) fn pack_version(text: &str) -> Result<String, String> {
    let label = PackLabel { version: Some(text.into()), licence: None };
    label.check().map(|()| text.into()).map_err(|fault| fault.to_string())
}

pub(crate) fn licence(text: &str) -> Result<String, String> {
    let label = PackLabel { version: None, licence: Some(text.into()) };
    label.check().map(|()| text.into()).map_err(|fault| fault.to_string())
}

/// `--judge`.
pub(crate) fn judge_share() -> impl TypedValueParser<Value = JudgeShare> {
    one_of([
        ("sample", "At least one in a hundred", JudgeShare::Sample),
        ("all", "Every ray", JudgeShare::All),
    ])
}

/// `--arithmetic`.
pub(crate) fn precision() -> impl TypedValueParser<Value = Precision> {
    one_of([("f64", "Double precision", Precision::F64), ("f32", "Single precision", Precision::F32)])
}

/// `--arithmetic` of a program that writes a `candidate.json`, or none.
pub(crate) fn arithmetic() -> impl TypedValueParser<Value = Arithmetic> {
    one_of([("f64", "Double precision", Arithmetic::F64), ("f32", "Single precision", Arithmetic::F32)])
}

/// `--part`.
pub(crate) fn part_name() -> impl TypedValueParser<Value = PartName> {
    one_of([
        ("own", "The sensors of a random rig", PartName::Own),
        ("paper", "The same, with the paper's approximations", PartName::Paper),
        ("aimed", "Narrow sensors aimed at difficult places", PartName::Aimed),
        ("lattice", "A lattice whose vertices lie exactly on rays", PartName::Lattice),
    ])
}

/// `--class`.
pub(crate) fn class() -> impl TypedValueParser<Value = Class> {
    one_of(CLASSES)
}

/// The name of a class as `--class` accepts it; `agree` for the class that it does not accept.
pub(crate) fn class_name(class: Class) -> &'static str {
    CLASSES.iter().find(|(_, _, one)| *one == class).map_or("agree", |(name, _, _)| name)
}

/// `I/N`, counted from 1.
pub(crate) fn shard(text: &str) -> Result<Shard, String> {
    let wrong = || "expected a part and the number of parts, such as 2/4".to_string();
    let (index, count) = text.split_once('/').ok_or_else(wrong)?;
    let one = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong());
    match (one(index)?, one(count)?) {
        (index, count) if count <= MAX_SHARDS && (1..=count).contains(&index) => {
            Ok(Shard { index: index - 1, count })
        }
        _ => Err(wrong()),
    }
}

/// A time in seconds, as milliseconds.
pub(crate) fn seconds(text: &str) -> Result<u64, String> {
    match number(text)? {
        seconds if (0.001..=1e9).contains(&seconds) => Ok((seconds * 1e3).round() as u64),
        _ => Err("expected 0.001 to 1e9 seconds".into()),
    }
}

/// A number without its unit: the option's name in brackets has that.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    if let Ok(number) = text.trim().parse::<f64>() {
        return Ok(number);
    }
    let unit = text.trim_start_matches(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
    let digits = &text[..text.len() - unit.len()];
    Err(match digits.parse::<f64>() {
        Ok(_) => format!("expected a number alone, without a unit: {digits}"),
        Err(_) => "expected a number, such as 1.5".into(),
    })
}

/// `--reflectivity`: a share.
pub(crate) fn reflectivity(text: &str) -> Result<f64, String> {
    let share = number(text)?;
    (0.0..=1.0).contains(&share).then_some(share).ok_or_else(|| "expected 0 to 1".into())
}

/// `MAP=CHANNEL` of a recording.
pub(crate) fn declared_channel(text: &str) -> Result<DeclaredChannel, String> {
    text.parse()
}

/// A length in metres that is positive.
pub(crate) fn metres(text: &str) -> Result<f64, String> {
    match number(text)? {
        metres if metres > 0.0 && metres.is_finite() => Ok(metres),
        _ => Err("expected a positive number of metres, such as 0.001".into()),
    }
}

/// A difference that is allowed: finite and not negative.
pub(crate) fn threshold(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a number of at least 0, such as 1e-6".into()),
    }
}

/// A percentage of all cells.
pub(crate) fn percent(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (0.0..=100.0).contains(&number) => Ok(number),
        _ => Err("expected a percentage from 0 to 100".into()),
    }
}

/// `KEY=VALUE`, a key of the scene file. Whether there is such a key is checked when the scene is read.
pub(crate) fn setting(text: &str) -> Result<Setting, String> {
    Setting::parse(text).map_err(|error| match error {
        SceneIoError::Setting { message, .. } => message,
        error => error.to_string(),
    })
}

/// `NAME=paper` or `NAME=exact`. Whether the switch exists is checked with the renderer.
pub(crate) fn switch(text: &str) -> Result<(String, Fidelity), String> {
    let (name, fidelity) = text.split_once('=').unwrap_or((text, ""));
    match fidelity {
        "paper" => Ok((name.into(), Fidelity::Paper)),
        "exact" => Ok((name.into(), Fidelity::Exact)),
        _ => Err("expected a switch and its setting, such as beam-edges=paper or skip-rules=exact".into()),
    }
}

/// `NAME=paper` or `NAME=mended`, a rule of the rover's maps; `start=footprint` and `start=circle` as well.
pub(crate) fn rule(text: &str) -> Result<(String, String), String> {
    let (name, word) = text.split_once('=').unwrap_or((text, ""));
    if !RULE_NAMES.contains(&name) {
        return Err(format!("expected one of {}", RULE_NAMES.join(", ")));
    }
    match (name, word) {
        (_, "paper" | "mended") | ("start", "footprint" | "circle") => Ok((name.into(), word.into())),
        ("start", _) => Err("expected start=paper, start=mended, start=footprint or start=circle".into()),
        _ => Err(format!("expected {name}=paper or {name}=mended")),
    }
}

/// A word of `--record`.
pub(crate) fn record(text: &str) -> Result<String, String> {
    let checked = RecordContents::default().add(text);
    checked.map(|()| text.to_string()).map_err(|words| format!("expected {words}"))
}

/// `N` numbers separated by commas.
pub(crate) fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let all: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    all.ok()
        .and_then(|all| all.try_into().ok())
        .ok_or_else(|| format!("expected {N} numbers separated by commas"))
}

/// Two numbers separated by a comma.
pub(crate) fn pair<T: FromStr>(text: &str) -> Result<[T; 2], String> {
    let wrong = || "expected two numbers separated by a comma, such as 3,4".to_string();
    let (a, b) = text.split_once(',').ok_or_else(wrong)?;
    let one = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok([one(a)?, one(b)?])
}

/// `--window`: x and y of a lower left corner, width and height.
pub(crate) fn window(text: &str) -> Result<[f64; 4], String> {
    let numbers: Result<Vec<f64>, String> = text.split(',').map(number).collect();
    let wrong = || "expected x, y, width and height, such as 1200,3400,24,24".to_string();
    let window: [f64; 4] = numbers?.try_into().map_err(|_| wrong())?;
    let is_fit = window.iter().all(|number| number.is_finite()) && window[2] > 0.0 && window[3] > 0.0;
    is_fit.then_some(window).ok_or_else(wrong)
}

/// `--ray`: 6, 8 or 9 numbers, as a row of a CSV file.
pub(crate) fn ray(text: &str) -> Result<CastRay, String> {
    let rays = rays_from_bytes(text.as_bytes(), "--ray".as_ref()).map_err(|error| {
        // One row: its line says nothing.
        error.to_string().replace("--ray: ", "").replace("line 1: ", "").replace("ray 0.", "")
    })?;
    match rays.rays.as_slice() {
        [ray] => Ok(*ray),
        rays => Err(format!("{} rays; expected one", rays.len())),
    }
}

#[cfg(test)]
#[path = "../tests/unit/parsers.rs"]
mod tests;
