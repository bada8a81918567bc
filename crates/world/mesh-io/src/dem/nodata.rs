//! Samples that stand for unknown heights: those that the file declares, and those that the caller names.

use std::io::{Read, Seek};

use raypencil_files::Fault;

use crate::dem::tags::{Tags, tag_name};

const NODATA: u16 = 42113;

/// Samples that stand for unknown heights beside NaN and the one that the file declares.
///
/// ```
/// use raypencil_mesh_io::NoData;
///
/// assert_eq!(NoData::parse("-9999")?, NoData { values: vec![-9999.0], is_complete: false });
/// // Whatever stands out beside -9999 is a height.
/// assert_eq!(NoData::parse("-9999,none")?, NoData { values: vec![-9999.0], is_complete: true });
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NoData {
    /// The samples, as numbers of the file.
    pub values: Vec<f64>,
    /// Whether no other sample stands for an unknown height, however far it lies from all others.
    pub is_complete: bool,
}

impl NoData {
    /// Numbers and the word `none`, separated by commas. `none` stands for a complete list.
    ///
    /// # Errors
    /// What is expected, if it is anything else.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut nodata = Self::default();
        for word in text.split(',').map(str::trim) {
            match word.parse() {
                Ok(value) => nodata.values.push(value),
                Err(_) if word == "none" => nodata.is_complete = true,
                Err(_) => {
                    return Err("expected the samples of unknown heights, such as -9999, or none".to_string());
                }
            }
        }
        Ok(nodata)
    }
}

/// Sample that stands for "not known" by the file's own word; `None` if it names none.
pub(super) fn declared(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<Option<f64>, Fault> {
    let Some(text) = tags.text(file, NODATA)? else { return Ok(None) };
    match text.trim().parse() {
        Ok(value) => Ok(Some(value)),
        Err(_) => Err(Fault::new(tag_name(NODATA), format!("{text:?}"), "a number, such as -9999 or nan")),
    }
}
