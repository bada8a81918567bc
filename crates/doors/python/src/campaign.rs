//! Campaigns: shards of one, made anywhere, and their results joined.

use std::path::PathBuf;

use pyo3::prelude::*;
use raypencil::Progress;
use raypencil::campaign::{
    Campaign, CampaignProgress, OwnScenes, PartName, Shard, campaign_document, has_result, merge, run_shard,
    write_campaign,
};
use raypencil::pack::Arithmetic;

use crate::failure::Failure;
use crate::watch::{Watch, watched};

/// A campaign, whose shards may be made in any process.
#[pyclass(frozen, module = "raypencil._raypencil")]
pub(crate) struct CampaignCore(Campaign);

/// Reports each terrain as a stage.
struct Terrains<'a>(&'a Watch);

impl CampaignProgress for Terrains<'_> {
    fn done(&self, terrains: u64, of: u64, _rays: u64) {
        self.0.stage(&format!("{terrains} of {of} terrains"));
    }
}

/// A time in seconds as milliseconds.
fn milliseconds(seconds: f64) -> Result<u64, Failure> {
    match (0.001..=1e9).contains(&seconds) {
        true => Ok((seconds * 1e3).round() as u64),
        false => Err(Failure::new(format!("timeout is {seconds}; expected 0.001 to 1e9 seconds"))),
    }
}

fn arithmetic_named(name: &str) -> Result<Arithmetic, Failure> {
    let found = [Arithmetic::F32, Arithmetic::F64].into_iter().find(|one| one.word() == name);
    found.ok_or_else(|| Failure::new(format!("arithmetic is {name:?}; expected \"f64\" or \"f32\"")))
}

fn part_named(name: &str) -> Result<PartName, Failure> {
    let found = PartName::ALL.into_iter().find(|part| part.word() == name);
    let names = || PartName::ALL.map(|part| format!("{:?}", part.word())).join(", ");
    found.ok_or_else(|| Failure::new(format!("parts has {name:?}; expected some of {}", names())))
}

#[pymethods]
impl CampaignCore {
    #[new]
    #[allow(clippy::too_many_arguments, reason = "the arguments of a Python function by their names")]
    #[pyo3(signature = (terrains, seed, scenes=None, rig=None, candidate_command=None, timeout=None, partial=false, arithmetic=None, parts=None, max_faces=None))]
    fn new(
        py: Python<'_>,
        terrains: u64,
        seed: u64,
        scenes: Option<PathBuf>,
        rig: Option<PathBuf>,
        candidate_command: Option<String>,
        timeout: Option<f64>,
        partial: bool,
        arithmetic: Option<String>,
        parts: Option<Vec<String>>,
        max_faces: Option<u64>,
    ) -> PyResult<Self> {
        let made = py.detach(|| -> Result<Campaign, Failure> {
            let mut campaign = Campaign::new(seed, terrains).of_commit(raypencil_cli::commit());
            if let Some(folder) = &scenes {
                campaign = campaign.over(OwnScenes::read(folder, rig.as_deref())?);
            }
            if let Some(command) = &candidate_command {
                campaign = campaign.hunting(command)?;
                campaign.candidate_ms = timeout.map(milliseconds).transpose()?;
                campaign.partial = partial;
                campaign.arithmetic = arithmetic.as_deref().map(arithmetic_named).transpose()?;
            }
            campaign.max_faces = max_faces;
            let parts: Result<Vec<PartName>, Failure> =
                parts.iter().flatten().map(|name| part_named(name)).collect();
            Ok(campaign.with_parts(&parts?)?)
        });
        made.map(Self).map_err(|failure| failure.into_exception(py))
    }

    /// Number of terrains.
    #[getter]
    fn terrains(&self) -> u64 {
        self.0.terrains
    }

    /// Makes a shard in `folder`, and returns the path of its result.
    #[pyo3(signature = (index, count, folder, on_stage=None))]
    fn shard(
        &self,
        py: Python<'_>,
        index: u64,
        count: u64,
        folder: PathBuf,
        on_stage: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PathBuf> {
        let campaign = self.0.clone();
        watched(py, on_stage, move |watch| {
            Ok(run_shard(&campaign, Shard { index, count }, &folder, &Terrains(watch))?)
        })
    }

    /// Whether the result of a shard is there, whole, and of this campaign.
    fn has_result(&self, py: Python<'_>, index: u64, count: u64, folder: PathBuf) -> bool {
        py.detach(|| has_result(&self.0, Shard { index, count }, &folder))
    }

    /// Joins the results of all shards, writes the report into `output`, and tells whether it passes, its screen and its
    /// `summary.json`.
    #[pyo3(signature = (folders, output=None))]
    fn merge(
        &self,
        py: Python<'_>,
        folders: Vec<PathBuf>,
        output: Option<PathBuf>,
    ) -> PyResult<(bool, String, String)> {
        let merged = py.detach(|| -> Result<_, Failure> {
            let mut merged = merge(&folders, raypencil_cli::commit())?;
            if merged.campaign != self.0 {
                return Err(Failure::new(
                    "the shards are of another campaign; give each one a folder of its own",
                ));
            }
            // The same campaign, which knows where its scenes lie.
            merged.campaign = self.0.clone();
            if let Some(folder) = &output {
                write_campaign(&merged, folder)?;
            }
            let document = campaign_document(&merged, |_| false);
            Ok((merged.passes(), document.screen(), document.json()))
        });
        merged.map_err(|failure| failure.into_exception(py))
    }
}
