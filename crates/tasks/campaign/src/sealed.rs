//! Files of a campaign with a digest of their content, so that a damaged file is noticed.

use std::path::Path;

use raypencil_files::{FileError, bytes, hex_digits, sha256, shortened, write_atomically};
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;
use crate::plan::Campaign;

const FORMAT: u32 = 2;

/// Content of a file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sealed<T> {
    format: u32,
    campaign: Campaign,
    /// SHA-256 of the compact JSON of `(format, campaign, contents)`.
    sha256: String,
    contents: T,
}

/// The digest of a file's content.
fn digest<T: Serialize>(campaign: &Campaign, contents: &T) -> String {
    let text = serde_json::to_string(&(FORMAT, campaign, contents)).expect("JSON of numbers and texts");
    hex_digits(&sha256(text.as_bytes()))
}

/// Writes a file of `campaign`.
pub(crate) fn write_sealed<T: Serialize>(
    path: &Path,
    campaign: &Campaign,
    contents: &T,
) -> Result<(), FileError> {
    let text = sealed(campaign, contents);
    write_atomically(path, |file| file.write_all(text.as_bytes()))
}

/// The text of a file of `campaign`.
pub(crate) fn sealed<T: Serialize>(campaign: &Campaign, contents: &T) -> String {
    let sealed = serde_json::json!({
        "format": FORMAT,
        "campaign": campaign,
        "sha256": digest(campaign, contents),
        "contents": contents,
    });
    format!("{sealed}\n")
}

/// The text with the digest that its contents have, whatever it stated. `None`: it is no file of a campaign.
pub(crate) fn sealed_anew<T: Serialize + for<'de> Deserialize<'de>>(text: &[u8]) -> Option<String> {
    let read: Sealed<T> = serde_json::from_slice(text).ok()?;
    Some(sealed(&read.campaign, &read.contents))
}

/// Reads a file of at most `max_bytes` bytes: its campaign and its contents, neither of which is checked further.
///
/// # Errors
/// A file that cannot be read, that is no regular file, that is larger, or that is not as it was written.
pub(crate) fn read_sealed<T: Serialize + for<'de> Deserialize<'de>>(
    path: &Path,
    max_bytes: u64,
) -> Result<(Campaign, T), CampaignError> {
    let text = bytes::read_file(path, max_bytes).map_err(|error| FileError::io(path, "read", error))?;
    unsealed(&text, path)
}

/// The campaign and the contents of a file's bytes; `path` is its name in messages.
///
/// # Errors
/// Bytes that are not as they were written.
pub(crate) fn unsealed<T: Serialize + for<'de> Deserialize<'de>>(
    text: &[u8],
    path: &Path,
) -> Result<(Campaign, T), CampaignError> {
    let refuse = |found: String, expected: &str| refused(path, found, expected.into());
    let sealed: Sealed<T> = serde_json::from_slice(text)
        .map_err(|error| refuse(error.to_string(), "a result file of a campaign"))?;
    if sealed.format != FORMAT {
        return Err(refuse(format!("format {}", sealed.format), &format!("format {FORMAT}")));
    }
    if digest(&sealed.campaign, &sealed.contents) != sealed.sha256 {
        return Err(refuse("its contents do not have the stated digest".into(), "an unchanged file"));
    }
    Ok((sealed.campaign, sealed.contents))
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
