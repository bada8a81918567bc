//! Causes of answers that the contract does not give.

use std::collections::HashMap;

use raypencil_referee::{Explained, ExplainedVisibility};
use raypencil_scene::{Place, SensorId, Switches};

/// The cause of a wrong hit.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The smallest set of switches that restores an exact answer and is confirmed.
    pub switches: Switches,
    /// The faces that are hit or missed against the contract, and why.
    pub explained: Vec<Explained>,
    /// The same for answers that are still wrong with only these switches exact, where they are needed to find a reason
    /// for each switch.
    pub explained_without: Vec<(Switches, Vec<Explained>)>,
    /// Range of the restored answer, metres; `None` if it misses.
    pub restored_range: Option<f64>,
}

/// The causes of all answers of one output that the contract does not give.
#[derive(Debug, Clone, Default)]
pub struct Attributions {
    pub(super) of_hit: HashMap<(SensorId, u32, u32), Cause>,
    pub(super) of_visibility: HashMap<(SensorId, u32, u32), VisibilityCause>,
}

/// The cause of a wrong visibility.
#[derive(Debug, Clone, PartialEq)]
pub struct VisibilityCause {
    /// The smallest set of switches that restores an exact answer and is confirmed.
    pub switches: Switches,
    /// The faces that hide the point, or fail to, against the contract, and why.
    pub explained: Vec<ExplainedVisibility>,
    /// The same for answers that are still wrong with only these switches exact.
    pub explained_without: Vec<(Switches, Vec<ExplainedVisibility>)>,
}

impl Attributions {
    /// The cause of a pencil's visibility, if it is wrong for one.
    pub fn visibility_cause(&self, Place { sensor, i, j }: Place) -> Option<&VisibilityCause> {
        self.of_visibility.get(&(sensor, i, j))
    }

    /// The cause of a ray's hit, if it is wrong for one.
    pub fn cause(&self, Place { sensor, i, j }: Place) -> Option<&Cause> {
        self.of_hit.get(&(sensor, i, j))
    }
}
