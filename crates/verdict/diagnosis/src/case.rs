//! What a reason is looked for in.

use raypencil_judge::{GroundTruth, Recorded};
use raypencil_scene::SensorId;

use crate::channel::{Channel, channels_of};

/// The truth, the recording that is held to it, and the sensors that a reason is looked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case<'t> {
    pub(crate) truth: &'t GroundTruth<'t>,
    pub(crate) recorded: &'t Recorded,
    pub(crate) sensors: &'t [SensorId],
    /// Relative difference of values that count as equal while corrections are tried.
    pub(crate) tolerance: f64,
}

impl Case<'_> {
    /// The channels that the recording has of these sensors.
    pub(crate) fn channels(self) -> Vec<Channel> {
        channels_of(self.recorded, self.sensors)
    }
}
