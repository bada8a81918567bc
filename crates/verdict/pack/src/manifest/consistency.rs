//! Refuses a manifest that contradicts itself. The files that it lists are not read here.

use std::collections::{BTreeMap, BTreeSet};

use raypencil_files::Fault;

use crate::manifest::document::{
    FileType, MANIFEST_FORMAT, Manifest, ManifestFile, ManifestSensor, PackKind,
};
use crate::manifest::path::{PATH_RULE, check_relative};
use crate::published::PackLabel;

/// Maximum columns and rows of a sensor.
const MAX_SENSOR_SIDE_CELLS: u32 = 1 << 20;

/// Characters of a path or digest that messages show.
const MAX_SHOWN_CHARS: usize = 80;

impl Manifest {
    /// Checks format, kind, digests, sensors, paths and shapes against each other.
    pub(crate) fn check_consistency(&self) -> Result<(), Fault> {
        if self.format != MANIFEST_FORMAT {
            return Err(Fault::new("format", self.format.to_string(), MANIFEST_FORMAT.to_string()));
        }
        match (self.kind, self.blind_seed) {
            (PackKind::Blind, None) => {
                return Err(Fault::new("blindSeed", "absent", "a seed: the pack is blind"));
            }
            (PackKind::Answers, Some(seed)) => {
                let found = seed.to_string();
                return Err(Fault::new("blindSeed", found, "none: the answers are in the pack"));
            }
            (PackKind::Questions, Some(seed)) => {
                let found = seed.to_string();
                return Err(Fault::new("blindSeed", found, "none: the scene is of no seed"));
            }
            _ => {}
        }
        self.label().check()?;
        check_digest("scene.sha256", &self.scene.sha256)?;
        self.check_sensors()?;
        // A map, since a manifest may list thousands of sensors and files.
        let sensors = self.sensors.iter().map(|sensor| (sensor.name.as_str(), sensor)).collect();
        let mut paths = BTreeSet::new();
        for (index, file) in self.files.iter().enumerate() {
            let place =
                format!("files[{index}] {:?}", file.path.chars().take(MAX_SHOWN_CHARS).collect::<String>());
            check_relative(&file.path).map_err(|why| Fault::new(&place, why, PATH_RULE))?;
            if !paths.insert(&file.path) {
                return Err(Fault::new(place, "there twice", "each file once"));
            }
            check_digest(&format!("{place}: sha256"), &file.sha256)?;
            check_shape(&place, file, &sensors)?;
        }
        Ok(())
    }

    /// Version and licence of the pack.
    pub fn label(&self) -> PackLabel {
        PackLabel { version: self.version.clone(), licence: self.licence.clone() }
    }

    /// Checks that the sensors are the camera, then beam-0, beam-1 and so on, each with cells.
    fn check_sensors(&self) -> Result<(), Fault> {
        if self.sensors.is_empty() {
            return Err(Fault::new("sensors", "none", "the camera at least"));
        }
        for (index, sensor) in self.sensors.iter().enumerate() {
            let expected = match index {
                0 => "camera".to_string(),
                beam => format!("beam-{}", beam - 1),
            };
            let place = format!("sensors[{index}]");
            if sensor.name != expected {
                return Err(Fault::new(place, format!("{:?}", sensor.name), format!("{expected:?}")));
            }
            let sides = 1..=MAX_SENSOR_SIDE_CELLS;
            if !sides.contains(&sensor.columns) || !sides.contains(&sensor.rows) {
                let found = format!("{expected} of {} x {} cells", sensor.columns, sensor.rows);
                let expected = format!("1 to {MAX_SENSOR_SIDE_CELLS} columns and rows");
                return Err(Fault::new(place, found, expected));
            }
        }
        Ok(())
    }
}

/// Checks that a map has the size of its sensor. The sensor is that of the folder, or of the file name.
fn check_shape(
    place: &str,
    file: &ManifestFile,
    sensors: &BTreeMap<&str, &ManifestSensor>,
) -> Result<(), Fault> {
    let (kind, shape) = match (file.kind, &file.shape) {
        (None, None) => return Ok(()),
        (Some(kind), Some(shape)) => (kind, shape),
        _ => return Err(Fault::new(place, "one of type and shape", "both or neither")),
    };
    let lengths = if kind == FileType::Exr { 2..=2 } else { 2..=3 };
    if !lengths.contains(&shape.len()) {
        let found = format!("a shape of {} numbers", shape.len());
        return Err(Fault::new(place, found, "rows and columns, and components of an array"));
    }
    let (folder, _) = file.path.split_once('/').unwrap_or((file.path.trim_end_matches(".exr"), ""));
    match sensors.get(folder) {
        Some(sensor) if shape[..2] != [sensor.rows, sensor.columns] => {
            let expected = format!("{} rows of {} columns, as {folder} has", sensor.rows, sensor.columns);
            Err(Fault::new(place, format!("{} rows of {} columns", shape[0], shape[1]), expected))
        }
        _ => Ok(()),
    }
}

/// Checks that a text is a SHA-256 as manifests write it.
fn check_digest(place: &str, sha256: &str) -> Result<(), Fault> {
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    match sha256.len() == 64 && sha256.bytes().all(is_digit) {
        true => Ok(()),
        false => {
            let found = format!("{:?}", sha256.chars().take(MAX_SHOWN_CHARS).collect::<String>());
            Err(Fault::new(place, found, "64 hexadecimal digits in lower case"))
        }
    }
}
