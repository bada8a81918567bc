//! The notes of GDAL in a GeoTIFF: scale, offset and unit of the one band. (GDAL, GTiff driver: GDAL_METADATA)

use std::io::{Read, Seek};

use raypencil_files::Fault;

use crate::dem::tags::{Tags, tag_name};
use crate::dem::unit::LengthUnit;

const METADATA: u16 = 42112;

/// The text of the tag; empty without it.
pub(super) struct GdalMetadata(String);

impl GdalMetadata {
    /// Reads the tag, and refuses heights that GDAL would scale or shift.
    pub fn read(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<Self, Fault> {
        let metadata = Self(tags.text(file, METADATA)?.unwrap_or_default());
        for (role, one, neutral) in [("scale", "a scale", 1.0), ("offset", "an offset", 0.0)] {
            if let Some(value) = metadata.item(role).filter(|value| value.parse() != Ok(neutral)) {
                let expected = format!("{neutral}: apply it first (gdal_translate -unscale)");
                return Err(Fault::new(tag_name(METADATA), format!("{one} of {value:?}"), expected));
            }
        }
        Ok(metadata)
    }

    /// `<Item name="SCALE" sample="0" role="scale">0.1</Item>`: at most one item of a role for the one band.
    fn item(&self, role: &str) -> Option<String> {
        let (_, after) = self.0.split_once(&format!("role=\"{role}\""))?;
        let (_, value) = after.split_once('>')?;
        Some(value.split('<').next().unwrap_or(value).trim().to_string())
    }

    /// The unit of the heights with the place that states it. `option` is the remedy in messages.
    pub fn height_unit(&self, option: &str) -> Result<Option<(LengthUnit, String)>, Fault> {
        let Some(word) = self.item("unittype").filter(|word| !word.is_empty()) else { return Ok(None) };
        match LengthUnit::of_word(&word) {
            Some(unit) => Ok(Some((unit, tag_name(METADATA)))),
            None => {
                let expected = format!("metres, \"ft\" (0.3048 m), \"US survey foot\", or {option}");
                Err(Fault::new(tag_name(METADATA), format!("heights in {word:?}"), expected))
            }
        }
    }
}
