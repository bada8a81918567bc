//! Stamps in pages: which command made their tables and figures, and what these stand on.

use std::fmt;
use std::path::Path;

use serde::Deserialize;

use super::{digest_of_files, fingerprint};

/// How a stamp begins in a page. It is a comment of Markdown, in which TOML stands.
const BEGINS: &str = "<!-- stands on\n";

/// How it ends.
const ENDS: &str = "-->";

/// What decides the numbers of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// The rover's rules, its sensors, the renderer, and the truth to which they are held.
    Drive,
    /// Generated ground.
    Ground,
    /// Both renderers.
    Renderers,
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Drive => "drive",
            Self::Ground => "ground",
            Self::Renderers => "renderers",
        })
    }
}

/// Stamp of a page: a table or figure, or several that one command makes.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stamp {
    /// Command that makes it.
    pub made_by: String,
    /// Fingerprints of the rules when it was made.
    pub drive: Option<String>,
    /// Likewise.
    pub ground: Option<String>,
    /// Likewise.
    pub renderers: Option<String>,
    /// Files that the command reads, from the root of the project.
    #[serde(default)]
    pub inputs: Vec<String>,
    /// Digest of these files when it was made.
    pub inputs_digest: Option<String>,
    /// Other files that the command makes, from the root of the project.
    #[serde(default)]
    pub shows: Vec<String>,
    /// What it stands on where that is no rule of this project: times of a machine, or other people's programs.
    pub measured: Option<String>,
}

impl Stamp {
    /// The digests as written, each with its key in the page.
    fn written(&self) -> [(Rule, Option<&String>); 3] {
        [
            (Rule::Drive, self.drive.as_ref()),
            (Rule::Ground, self.ground.as_ref()),
            (Rule::Renderers, self.renderers.as_ref()),
        ]
    }

    /// What is newer than the table: each with the digest as written and as it is now. Empty: the table is up to date.
    ///
    /// # Errors
    /// A stamp that stands on nothing, and an input that cannot be read.
    pub fn stale(&self, root: &Path) -> Result<Vec<String>, String> {
        let rules = self.written().into_iter().filter_map(|(rule, written)| Some((rule, written?)));
        let mut found = Vec::new();
        // Inputs that a test holds to the rules, such as packs, are enough.
        let mut stands = self.measured.is_some() || !self.inputs.is_empty();
        for (rule, written) in rules {
            stands = true;
            let now = fingerprint(rule);
            if *written != now {
                found.push(format!("{rule} {written}, now {now}"));
            }
        }
        match (&self.inputs_digest, self.inputs.is_empty()) {
            (Some(written), false) => {
                let now = digest_of_files(root, &self.inputs)?;
                if *written != now {
                    found.push(format!("inputs_digest {written}, now {now}"));
                }
            }
            (None, true) => {}
            _ => return Err("`inputs` and `inputs_digest` belong together".into()),
        }
        if stands { Ok(found) } else { Err("it stands on nothing".into()) }
    }
}

/// All stamps of a page.
///
/// # Errors
/// What is wrong with the first that cannot be read.
///
/// ```
/// use raypencil_tests::stands_on::stamps;
///
/// let page = "A table.\n\n<!-- stands on\nmade_by = \"just truth\"\ndrive = \"00\"\n-->\n";
/// assert_eq!(stamps(page).unwrap()[0].made_by, "just truth");
/// assert!(stamps("<!-- stands on\nmade_by = 3\n-->").is_err());
/// ```
pub fn stamps(page: &str) -> Result<Vec<Stamp>, String> {
    let blocks = page.split(BEGINS).skip(1);
    blocks
        .map(|rest| {
            let (block, _) = rest.split_once(ENDS).ok_or("a stamp without its end")?;
            toml::from_str(block).map_err(|error| error.message().to_string())
        })
        .collect()
}

/// The page with the digests of now in each stamp of the command `made_by`, and whether there is one.
///
/// # Errors
/// As [`stamps`], and an input that cannot be read.
pub fn with_new_digests(page: &str, made_by: &str, root: &Path) -> Result<(String, bool), String> {
    let mut parts = page.split(BEGINS);
    let mut out = parts.next().unwrap_or_default().to_string();
    let mut found = false;
    for (part, stamp) in parts.zip(stamps(page)?) {
        let (block, rest) = part.split_once(ENDS).ok_or("a stamp without its end")?;
        let mut block = block.to_string();
        if stamp.made_by == made_by {
            found = true;
            let rules = stamp
                .written()
                .into_iter()
                .filter_map(|(rule, written)| Some((rule.to_string(), written?, fingerprint(rule))));
            let mut new: Vec<_> = rules.map(|(key, written, now)| (key, written.clone(), now)).collect();
            if let Some(written) = &stamp.inputs_digest {
                new.push(("inputs_digest".into(), written.clone(), digest_of_files(root, &stamp.inputs)?));
            }
            for (key, written, now) in new {
                block = block.replace(&format!("{key} = \"{written}\""), &format!("{key} = \"{now}\""));
            }
        }
        out += &[BEGINS, &block, ENDS, rest].concat();
    }
    Ok((out, found))
}
