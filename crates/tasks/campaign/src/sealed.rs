//! Files of a campaign with a digest of their content, so that a damaged file is noticed.

use std::path::Path;

use raypencil_files::{FileError, bytes, hex_digits, sha256, shortened, write_atomically};
use raypencil_scene_io::InputFile;
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;
use crate::plan::Campaign;

const FORMAT: u32 = 3;

/// What a terrain was made by, and what it left beside its record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Made {
    /// SHA-256 of the program that made it.
    pub program: String,
    /// Files below the campaign's folder, with their digests.
    pub left: Vec<InputFile>,
}

/// Content of a file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sealed<T> {
    format: u32,
    campaign: Campaign,
    /// SHA-256 of the compact JSON of `(format, campaign, contents, made)`.
    sha256: String,
    contents: T,
    /// Only of a terrain: a result of a shard goes to other machines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    made: Option<Made>,
}

/// The digest of a file's content.
fn digest<T: Serialize>(campaign: &Campaign, contents: &T, made: Option<&Made>) -> String {
    let text = serde_json::to_string(&(FORMAT, campaign, contents, made)).expect("JSON of numbers and texts");
    hex_digits(&sha256(text.as_bytes()))
}

/// Writes a file of `campaign`.
pub(crate) fn write_sealed<T: Serialize>(
    path: &Path,
    campaign: &Campaign,
    contents: &T,
    made: Option<&Made>,
) -> Result<(), FileError> {
    let text = sealed(campaign, contents, made);
    write_atomically(path, |file| file.write_all(text.as_bytes()))
}

/// The text of a file of `campaign`.
pub(crate) fn sealed<T: Serialize>(campaign: &Campaign, contents: &T, made: Option<&Made>) -> String {
    let mut sealed = serde_json::json!({
        "format": FORMAT,
        "campaign": campaign,
        "sha256": digest(campaign, contents, made),
        "contents": contents,
    });
    if let Some(made) = made {
        sealed["made"] = serde_json::json!(made);
    }
    format!("{sealed}\n")
}

/// The text with the digest that its contents have, whatever it stated. `None`: it is no file of a campaign.
pub(crate) fn sealed_anew<T: Serialize + for<'de> Deserialize<'de>>(text: &[u8]) -> Option<String> {
    let read: Sealed<T> = serde_json::from_slice(text).ok()?;
    Some(sealed(&read.campaign, &read.contents, read.made.as_ref()))
}

/// Reads a file of at most `max_bytes` bytes: its campaign, its contents and what it was made by, none of which is checked
/// further.
///
/// # Errors
/// A file that cannot be read, that is no regular file, that is larger, or that is not as it was written.
pub(crate) fn read_sealed<T: Serialize + for<'de> Deserialize<'de>>(
    path: &Path,
    max_bytes: u64,
) -> Result<(Campaign, T, Option<Made>), CampaignError> {
    let text = bytes::read_file(path, max_bytes).map_err(|error| FileError::io(path, "read", error))?;
    unsealed(&text, path)
}

/// What [`read_sealed`] gives, from a file's bytes; `path` is its name in messages.
///
/// # Errors
/// Bytes that are not as they were written.
pub(crate) fn unsealed<T: Serialize + for<'de> Deserialize<'de>>(
    text: &[u8],
    path: &Path,
) -> Result<(Campaign, T, Option<Made>), CampaignError> {
    let refuse = |found: String, expected: &str| refused(path, found, expected.into());
    let sealed: Sealed<T> = serde_json::from_slice(text)
        .map_err(|error| refuse(error.to_string(), "a result file of a campaign"))?;
    if sealed.format != FORMAT {
        return Err(refuse(format!("format {}", sealed.format), &format!("format {FORMAT}")));
    }
    if digest(&sealed.campaign, &sealed.contents, sealed.made.as_ref()) != sealed.sha256 {
        return Err(refuse("its contents do not have the stated digest".into(), "an unchanged file"));
    }
    Ok((sealed.campaign, sealed.contents, sealed.made))
}

/// The error of a file that is damaged, or that no campaign can have written.
pub(crate) fn refused(path: &Path, found: String, expected: String) -> CampaignError {
    // Texts of the file may be long.
    CampaignError::Record {
        file: path.display().to_string(),
        found: shortened(found),
        expected: shortened(expected),
    }
}
