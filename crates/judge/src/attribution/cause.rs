//! What explains an answer that the contract does not give.

use std::collections::HashMap;

use raypencil_referee::{Explained, ExplainedVisibility};
use raypencil_scene::Place;
use raypencil_scene::{SensorId, Switches};

/// What explains one answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The smallest set of switches that restores an exact answer and is confirmed.
    pub switches: Switches,
    /// The faces that are seen or not seen against the contract, and why.
    pub explained: Vec<Explained>,
    /// The same of the answers that are still wrong with only these switches exact, if it takes them to
    /// find a reason for each switch.
    pub explained_without: Vec<(Switches, Vec<Explained>)>,
    /// The range of the restored answer, metres; `None` if that is a miss.
    pub restored_range: Option<f64>,
}

/// The causes of all answers of one frame that the contract does not give.
#[derive(Debug, Clone, Default)]
pub struct Attributions {
    pub(super) by_ray: HashMap<(SensorId, u32, u32), Cause>,
    pub(super) of_visibility: HashMap<(SensorId, u32, u32), VisibilityCause>,
}

/// What explains one answer about what the camera sees.
#[derive(Debug, Clone, PartialEq)]
pub struct VisibilityCause {
    /// The smallest set of switches that restores an exact answer and is confirmed.
    pub switches: Switches,
    /// The faces that hide the point, or do not, against the contract, and why.
    pub explained: Vec<ExplainedVisibility>,
    /// The same of the answers that are still wrong with only these switches exact.
    pub explained_without: Vec<(Switches, Vec<ExplainedVisibility>)>,
}

impl Attributions {
    /// The cause of the answer about what the camera sees of one pencil's hit, if it has one.
    pub fn visibility_cause(&self, Place { sensor, i, j }: Place) -> Option<&VisibilityCause> {
        self.of_visibility.get(&(sensor, i, j))
    }

    /// The cause of the answer to one ray, if it has one.
    pub fn cause(&self, Place { sensor, i, j }: Place) -> Option<&Cause> {
        self.by_ray.get(&(sensor, i, j))
    }
}
