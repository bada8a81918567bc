//! What is injected into the renderer.

use crate::fault::Fault;
use crate::slack::Slack;

/// A fault, or a slack with its size, or neither.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Injected {
    pub(crate) fault: Option<Fault>,
    pub(crate) slack: Option<(Slack, f64)>,
}

impl Injected {
    /// Whether it is this fault.
    #[inline]
    pub(crate) fn has(self, fault: Fault) -> bool {
        self.fault == Some(fault)
    }

    /// The size of this slack; 0 if it is not there.
    #[inline]
    pub(crate) fn size(self, slack: Slack) -> f64 {
        match self.slack {
            Some((own, size)) if own == slack => size,
            _ => 0.0,
        }
    }

    /// How far the rays that decide faces are shifted, in cells to the right and down.
    #[inline]
    pub(crate) fn shift(self) -> Option<[f64; 2]> {
        let (slack, size) = self.slack?;
        Some((slack.shift()? * size).to_array())
    }
}
