//! The geo keys of a GeoTIFF: numbers and texts by key. (OGC 19-008r4, GeoTIFF 1.1, section 7.1)

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use raypencil_files::Fault;

use crate::dem::registration::Registration;
use crate::dem::tags::{Tags, tag_name};

/// Tag numbers.
const GEO_KEYS: u16 = 34735;

const DOUBLES: u16 = 34736;

const TEXTS: u16 = 34737;

/// Value of a key that the file defines by other keys.
pub(super) const USER_DEFINED: u16 = 32767;

/// The keys that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key(pub u16);

impl Key {
    pub const MODEL_TYPE: Self = Self(1024);
    pub const RASTER_TYPE: Self = Self(1025);
    pub const CITATION: Self = Self(1026);
    pub const GEODETIC: Self = Self(2048);
    pub const GEODETIC_CITATION: Self = Self(2049);
    pub const GEODETIC_UNIT: Self = Self(2052);
    pub const PROJECTED: Self = Self(3072);
    pub const PROJECTION: Self = Self(3074);
    pub const TRANSFORM: Self = Self(3075);
    pub const PROJECTED_CITATION: Self = Self(3073);
    pub const PROJECTED_UNIT: Self = Self(3076);
    pub const PROJECTED_UNIT_SIZE: Self = Self(3077);
    pub const VERTICAL: Self = Self(4096);
    pub const VERTICAL_CITATION: Self = Self(4097);
    pub const VERTICAL_UNIT: Self = Self(4099);

    /// Its number and name. The names are those of GeoTIFF 1.0, which programs print.
    pub fn name(self) -> String {
        let name = match self {
            Self::MODEL_TYPE => "GTModelTypeGeoKey",
            Self::RASTER_TYPE => "GTRasterTypeGeoKey",
            Self::CITATION => "GTCitationGeoKey",
            Self::GEODETIC => "GeographicTypeGeoKey",
            Self::GEODETIC_CITATION => "GeogCitationGeoKey",
            Self::GEODETIC_UNIT => "GeogLinearUnitsGeoKey",
            Self::PROJECTED => "ProjectedCSTypeGeoKey",
            Self::PROJECTION => "ProjectionGeoKey",
            Self::TRANSFORM => "ProjCoordTransGeoKey",
            Self::PROJECTED_CITATION => "PCSCitationGeoKey",
            Self::PROJECTED_UNIT => "ProjLinearUnitsGeoKey",
            Self::PROJECTED_UNIT_SIZE => "ProjLinearUnitSizeGeoKey",
            Self::VERTICAL => "VerticalCSTypeGeoKey",
            Self::VERTICAL_CITATION => "VerticalCitationGeoKey",
            Self::VERTICAL_UNIT => "VerticalUnitsGeoKey",
            Self(_) => "of another kind",
        };
        format!("key {} {name}", self.0)
    }

    /// A fault of its value.
    pub fn fault(self, found: impl Into<String>, expected: impl Into<String>) -> Fault {
        Fault::new(format!("{}, {}", tag_name(GEO_KEYS), self.name()), found, expected)
    }
}

#[derive(Debug, Default)]
pub(super) struct GeoKeys {
    shorts: BTreeMap<Key, u16>,
    doubles: BTreeMap<Key, f64>,
    texts: BTreeMap<Key, String>,
}

impl GeoKeys {
    pub fn read(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<Self, Fault> {
        let mut keys = Self::default();
        let Some(values) = tags.integers(file, GEO_KEYS)? else { return Ok(keys) };
        let values: Vec<u16> = values.iter().map(|&value| u16::try_from(value).unwrap_or(u16::MAX)).collect();
        let unfit = |found: String| {
            let expected = "version 1, its revision, and four numbers for each of as many keys as it says";
            Fault::new(tag_name(GEO_KEYS), found, expected)
        };
        let (head, rest) = values.split_at_checked(4).ok_or_else(|| unfit(format!("{values:?}")))?;
        let count = usize::from(head[3]);
        if head[0] != 1 || rest.len() < 4 * count {
            return Err(unfit(format!("{head:?} and {} more numbers", rest.len())));
        }
        let doubles = tags.reals(file, DOUBLES)?.unwrap_or_default();
        let texts = tags.text(file, TEXTS)?.unwrap_or_default();
        // A key that is there twice has two meanings: a program may take the first value or the last.
        let mut seen: BTreeMap<Key, String> = BTreeMap::new();
        for entry in rest.chunks_exact(4).take(count) {
            let &[key, tag, length, at] = entry else { continue };
            let (key, length, first) = (Key(key), usize::from(length), usize::from(at));
            let value = match tag {
                // The value is in this tag.
                0 => {
                    keys.shorts.insert(key, at);
                    at.to_string()
                }
                DOUBLES => {
                    let value = doubles.get(first);
                    keys.doubles.extend(value.map(|&value| (key, value)));
                    value.map_or("no number".into(), f64::to_string)
                }
                // Texts are only shown and searched for words: one that is cut off is no fault. Each ends in a bar.
                TEXTS => {
                    let text: String = texts.chars().skip(first).take(length).collect();
                    let text = text.trim_end_matches('|').trim().to_string();
                    let value = format!("{text:?}");
                    keys.texts.insert(key, text);
                    value
                }
                _ => format!("{length} numbers of {}", tag_name(tag)),
            };
            if let Some(earlier) = seen.get(&key) {
                return Err(key.fault(format!("{earlier} and {value}"), "the key once"));
            }
            seen.insert(key, value);
        }
        Ok(keys)
    }

    /// A number, if the key is there and not 0, which stands for undefined.
    pub fn short(&self, key: Key) -> Option<u16> {
        self.shorts.get(&key).copied().filter(|value| *value != 0)
    }

    pub fn double(&self, key: Key) -> Option<f64> {
        self.doubles.get(&key).copied()
    }

    /// A text with some content.
    pub fn text(&self, key: Key) -> Option<&str> {
        self.texts.get(&key).map(String::as_str).filter(|text| !text.is_empty())
    }

    /// Meaning of a pixel. CHOICE: an area if the file states nothing, as in GeoTIFF 1.0 and GDAL.
    pub fn registration(&self) -> Result<Registration, Fault> {
        match self.shorts.get(&Key::RASTER_TYPE) {
            None => Ok(Registration::AreaByDefault),
            Some(1) => Ok(Registration::Area),
            Some(2) => Ok(Registration::Point),
            Some(other) => {
                Err(Key::RASTER_TYPE.fault(other.to_string(), "1 (PixelIsArea) or 2 (PixelIsPoint)"))
            }
        }
    }
}
