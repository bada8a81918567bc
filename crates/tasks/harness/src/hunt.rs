//! One candidate of one scene, checked without rendering anything.

use std::path::Path;

use raypencil_pack::PackError;
use raypencil_scene::{Progress, SensorId};
use raypencil_scene_io::Subject;
use raypencil_survey::SensorHits;

use crate::candidate::Candidate;
use crate::misses::write_misses;
use crate::scoreboard::{CandidateReport, evaluate};

/// A candidate, checked, and how many rays of the scene truly hit.
#[derive(Debug)]
pub struct JudgedCandidate {
    /// The check.
    pub report: CandidateReport,
    /// Rays of all sensors that hit the terrain, by the exact answers.
    pub hits: u64,
}

/// Checks a candidate against the exact answer to every ray of a scene. The worst misses, at most as many as given, are written
/// to the folder as packs of single rays.
///
/// # Errors
/// A pack that cannot be written; the message names it.
pub fn judge_candidate(
    subject: &Subject,
    candidate: Candidate,
    misses: Option<(&Path, usize)>,
    progress: &dyn Progress,
) -> Result<JudgedCandidate, PackError> {
    let mut scoreboard = evaluate(subject, &[], vec![candidate], progress);
    let report = scoreboard.candidates.remove(0);
    let beams = (0..subject.scene.beams().len()).map(SensorId::Beam);
    let sensors = std::iter::once(SensorId::Camera).chain(beams);
    let hits = sensors.filter_map(|sensor| SensorHits::of_map(scoreboard.exact.map(sensor)));
    let hits = hits.map(|of| of.hits).sum();
    if let Some(misses) = misses {
        write_misses(subject, &report, misses, progress)?;
    }
    Ok(JudgedCandidate { report, hits })
}
