//! The plan of a campaign: its terrains, and the shards that they are divided into.
//!
//! A terrain depends only on the campaign's seed and its own number, so a shard can run anywhere and at any time.

use std::time::Duration;

use raypencil_files::command_files;
use raypencil_pack::Arithmetic;
use raypencil_scene_io::{InputFile, quoted};
use serde::{Deserialize, Serialize};

use crate::cases::fingerprint;
use crate::error::CampaignError;
use crate::own_scenes::OwnScenes;
use crate::record::PartName;

/// Maximum number of terrains of a campaign.
pub const MAX_TERRAINS: u64 = 1_000_000;

/// Maximum number of shards of a campaign.
pub const MAX_SHARDS: u64 = MAX_TERRAINS;

/// Most time of a candidate for one scene, unless another is given.
const DEFAULT_TIME: Duration = Duration::from_secs(1800);

/// A campaign. Equal campaigns give equal results, byte for byte.
///
/// ```
/// use raypencil_campaign::{Campaign, Shard};
///
/// let campaign = Campaign::new(5, 10);
/// // Shard k of n has the terrains whose number is k modulo n.
/// let second_of_four = Shard { index: 1, count: 4 };
/// assert_eq!(second_of_four.terrains(&campaign).collect::<Vec<_>>(), [1, 5, 9]);
/// assert_eq!(Shard::WHOLE.terrains(&campaign).count(), 10);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of terrains.
    pub terrains: u64,
    /// Version of raypencil. Another version may make other terrains.
    pub version: String,
    /// Commit that the program was built from, where it is known. Another commit may render otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// SHA-256 of sample scenes, in hexadecimal digits. It tells two builds apart that draw other scenes and do not know
    /// their commits.
    pub cases: String,
    /// Scenes in place of random ones.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scenes: Option<OwnScenes>,
    /// Command of a program whose answers are checked, in place of the two renderers; see [`Campaign::hunting`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub candidate: Option<String>,
    /// The files that its words name: the program and its arguments.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub candidate_files: Vec<InputFile>,
    /// Most time that it has for one scene, milliseconds; `None`: half an hour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub candidate_ms: Option<u64>,
    /// Whether it may leave out what decides: which face a ray meets, and how far.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub partial: bool,
    /// The arithmetic that it computes in; `None`: as its `candidate.json` says, else f64.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arithmetic: Option<Arithmetic>,
    /// The scenes of each terrain; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartName>,
    /// Most faces of a ground whose scenes are run. A lattice, which has few faces of its own, is run beside any ground.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_faces: Option<u64>,
}

impl Campaign {
    /// A campaign run by this version.
    pub fn new(seed: u64, terrains: u64) -> Self {
        Self {
            seed,
            terrains,
            version: env!("CARGO_PKG_VERSION").into(),
            commit: None,
            cases: fingerprint().into(),
            scenes: None,
            candidate: None,
            candidate_files: Vec::new(),
            candidate_ms: None,
            partial: false,
            arithmetic: None,
            parts: Vec::new(),
            max_faces: None,
        }
    }

    /// The same, by a program built from this commit.
    pub fn of_commit(self, commit: Option<&str>) -> Self {
        Self { commit: commit.map(String::from), ..self }
    }

    /// A campaign from a file, if this program could have made it.
    ///
    /// # Errors
    /// What it has, and what was expected: 1 to [`MAX_TERRAINS`] terrains, one for each scene of one's own; the version of
    /// this program, its commit, and its scenes.
    pub(crate) fn checked(self, commit: Option<&str>) -> Result<Self, (String, String)> {
        if !(1..=MAX_TERRAINS).contains(&self.terrains) {
            return Err((format!("{} terrains", self.terrains), format!("1 to {MAX_TERRAINS}")));
        }
        if let Some(scenes) = self.scenes.as_ref().filter(|scenes| scenes.len() as u64 != self.terrains) {
            let found = format!("{} terrains of {} scenes", self.terrains, scenes.len());
            return Err((found, "one terrain of each scene".into()));
        }
        let this = Self::new(self.seed, self.terrains).of_commit(commit);
        if self.build() != this.build() {
            let expected =
                format!("one of this program, {}: merge with the program that made it", this.build());
            return Err((format!("a record of {}", self.build()), expected));
        }
        Ok(self)
    }

    /// The program that it is made by: version, commit and the start of the digest of its scenes.
    pub(crate) fn build(&self) -> String {
        let commit = self.commit.as_ref().map_or(String::new(), |commit| format!(", commit {commit}"));
        let digits: String = self.cases.chars().take(8).collect();
        format!("version {}{commit}, scenes {digits}", self.version)
    }

    /// Words after `raypencil probe` that give a scene, once it is written by `campaign replay`.
    pub(crate) fn arguments(&self, terrain: u64, part: PartName) -> String {
        match (&self.scenes, part) {
            (Some(scenes), PartName::Own) => scenes.arguments(terrain),
            _ => "scene.toml".into(),
        }
    }

    /// The command that runs it again.
    pub(crate) fn command(&self) -> String {
        let Self { seed, terrains, scenes, candidate, .. } = self;
        let what = match scenes {
            Some(scenes) => scenes.options(),
            None => format!("--terrains {terrains}"),
        };
        let mut candidate = candidate
            .as_ref()
            .map_or(String::new(), |command| format!(" --candidate-command {}", quoted(command)));
        candidate += &self.candidate_ms.map_or(String::new(), |ms| format!(" --timeout {}", ms as f64 / 1e3));
        candidate += if self.partial { " --partial" } else { "" };
        candidate += &self.arithmetic.map_or(String::new(), |one| format!(" --arithmetic {}", one.word()));
        format!("raypencil campaign {what}{} --seed {seed}{candidate} -o DIR", self.bounds())
    }

    /// The options that bound it, each with a blank before it.
    fn bounds(&self) -> String {
        let parts: Vec<&str> = self.parts.iter().map(|part| part.word()).collect();
        let parts = if parts.is_empty() { String::new() } else { format!(" --parts {}", parts.join(",")) };
        parts + &self.max_faces.map_or(String::new(), |most| format!(" --max-faces {most}"))
    }

    /// The scenes of a terrain whose ground has so many faces, in the order of reports.
    pub(crate) fn parts_of(&self, faces: u64) -> impl Iterator<Item = PartName> {
        let is_small = self.max_faces.is_none_or(|most| faces <= most);
        let is_run = move |part: &PartName| {
            (self.parts.is_empty() || self.parts.contains(part))
                && self.can_have(*part).is_ok()
                && (is_small || *part == PartName::Lattice)
        };
        PartName::ALL.into_iter().filter(is_run)
    }

    /// Whether the terrains of this campaign can have such a scene; why not.
    fn can_have(&self, part: PartName) -> Result<(), &'static str> {
        match part {
            PartName::Paper if self.candidate.is_some() => {
                Err("the paper's approximations are of scanline alone")
            }
            PartName::Lattice if self.scenes.is_some() => Err("scenes of one's own have no lattice"),
            _ => Ok(()),
        }
    }

    /// The same with these scenes of each terrain alone. To be called once the candidate and one's own scenes are known.
    ///
    /// # Errors
    /// A scene that the terrains of this campaign do not have.
    pub fn with_parts(self, parts: &[PartName]) -> Result<Self, CampaignError> {
        for part in parts {
            self.can_have(*part).map_err(|why| CampaignError::Part { part: part.word(), why })?;
        }
        let parts = PartName::ALL.into_iter().filter(|part| parts.contains(part)).collect();
        Ok(Self { parts, ..self })
    }

    /// Whether another campaign asks the same: it may find other bytes in the files of its scenes and of its candidate.
    pub(crate) fn is_planned_as(&self, other: &Self) -> bool {
        let plan = |campaign: &Self| Self {
            scenes: campaign.scenes.as_ref().map(OwnScenes::without_bytes),
            candidate_files: Vec::new(),
            candidate_ms: None,
            partial: false,
            arithmetic: None,
            ..campaign.clone()
        };
        plan(self) == plan(other)
    }

    /// Whether another campaign finds the same bytes in all files that decide a terrain, and gives a candidate as much time and
    /// room.
    pub(crate) fn has_same_files(&self, other: &Self, terrain: u64) -> bool {
        let scene =
            |campaign: &Self| campaign.scenes.as_ref().map(|scenes| scenes.sha256(terrain).to_string());
        let candidate = |campaign: &Self| {
            (
                campaign.candidate_files.clone(),
                campaign.candidate_time(),
                campaign.partial,
                campaign.arithmetic,
            )
        };
        scene(self) == scene(other) && candidate(self) == candidate(other)
    }

    /// Most time that a candidate has for one scene.
    pub(crate) fn candidate_time(&self) -> Duration {
        self.candidate_ms.map_or(DEFAULT_TIME, Duration::from_millis)
    }

    /// What tells one campaign from another, in words.
    pub(crate) fn words(&self) -> String {
        let Self { seed, terrains, scenes, candidate, .. } = self;
        let own = if scenes.is_some() { "own " } else { "" };
        let candidate =
            candidate.as_ref().map_or(String::new(), |command| format!(", candidate `{command}`"));
        let bounds = self.bounds().replace(" --", ", --");
        format!("{terrains} {own}terrains, seed {seed}, {}{candidate}{bounds}", self.build())
    }

    /// The same over one's own scenes: each is a terrain.
    pub fn over(self, scenes: OwnScenes) -> Self {
        Self { terrains: scenes.len() as u64, scenes: Some(scenes), ..self }
    }

    /// The same with another program under test. For each scene the shell runs `command`, in which `{pack}` is the folder of
    /// a pack without answers, and `{out}` an empty folder for the answers, as `raypencil check` takes them. A file that the
    /// command names, a program on the path too, decides with its bytes.
    ///
    /// # Errors
    /// A command that lacks one of the two.
    pub fn hunting(self, command: &str) -> Result<Self, CampaignError> {
        for place in ["{pack}", "{out}"] {
            if !command.contains(place) {
                return Err(CampaignError::Candidate {
                    command: command.into(),
                    found: format!("it has no {place}"),
                    expected: "{pack} where the folder of the pack stands, and {out} for that of the answers"
                        .into(),
                });
            }
        }
        let input = |(name, sha256): (String, String)| InputFile { name, sha256 };
        let candidate_files = command_files(command).into_iter().map(input).collect();
        Ok(Self { candidate: Some(command.into()), candidate_files, ..self })
    }
}

/// Part of a campaign: the terrains k with k mod `count` = `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// Index of the shard, from 0.
    pub index: u64,
    /// Number of shards.
    pub count: u64,
}

impl Shard {
    /// The whole campaign as one shard.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// A shard from a file.
    ///
    /// # Errors
    /// What it has, and what was expected: 1 to [`MAX_SHARDS`] shards, and one of them.
    pub(crate) fn checked(self) -> Result<Self, (String, String)> {
        if (1..=MAX_SHARDS).contains(&self.count) && self.index < self.count {
            return Ok(self);
        }
        Err((
            format!("shard of index {} among {}", self.index, self.count),
            format!("1 to {MAX_SHARDS} shards, and an index below their number"),
        ))
    }

    /// Numbers of the shard's terrains, ascending.
    pub fn terrains(self, campaign: &Campaign) -> impl Iterator<Item = u64> {
        (self.index..campaign.terrains).step_by(usize::try_from(self.count).unwrap_or(usize::MAX))
    }
}
