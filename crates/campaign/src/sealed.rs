//! Files of a campaign with a digest of their content, so that a damaged file is noticed.

use std::path::Path;

use raypencil_files::{FileError, write_atomically};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::CampaignError;
use crate::plan::Campaign;

/// Number of the format.
const FORMAT: u32 = 1;

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
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Writes a file of `campaign`.
pub(crate) fn write_sealed<T: Serialize>(
    path: &Path,
    campaign: &Campaign,
    contents: &T,
) -> Result<(), FileError> {
    let sealed = serde_json::json!({
        "format": FORMAT,
        "campaign": campaign,
        "sha256": digest(campaign, contents),
        "contents": contents,
    });
    let text = format!("{sealed}\n");
    write_atomically(path, |file| file.write_all(text.as_bytes()))
}

/// Reads a file: its campaign and its contents.
pub(crate) fn read_sealed<T: Serialize + for<'de> Deserialize<'de>>(
    path: &Path,
) -> Result<(Campaign, T), CampaignError> {
    let file = path.display().to_string();
    let refuse = |found: String, expected: &str| CampaignError::Record {
        file: file.clone(),
        found,
        expected: expected.into(),
    };
    let text = std::fs::read_to_string(path).map_err(|source| FileError::Io {
        path: path.to_path_buf(),
        action: "read",
        source,
    })?;
    let sealed: Sealed<T> = serde_json::from_str(&text)
        .map_err(|error| refuse(error.to_string(), "a result file of a campaign"))?;
    if sealed.format != FORMAT {
        return Err(refuse(format!("format {}", sealed.format), &format!("format {FORMAT}")));
    }
    if digest(&sealed.campaign, &sealed.contents) != sealed.sha256 {
        return Err(refuse("its contents do not have the stated digest".into(), "an unchanged file"));
    }
    Ok((sealed.campaign, sealed.contents))
}
