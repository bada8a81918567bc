//! The referee's rulings on the cells that differ: which side is right.

use std::collections::BTreeMap;

use raypencil_judge::Class;
use raypencil_scene::Place;

/// Rulings on all channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Rulings {
    /// Channels of the scene with differing cells, by key.
    pub channels: BTreeMap<String, ChannelRuling>,
    /// Keys of the other channels with differing cells. The thresholds decide on them.
    pub not_ruled: Vec<String>,
}

/// Rulings on one channel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChannelRuling {
    /// Number of cells by the classes of A and B.
    pub by_class: BTreeMap<(Class, Class), u64>,
    /// Number of cells that could not be judged on one side. The thresholds decide on them.
    pub not_judged: u64,
    /// The first cells on which a side is wrong.
    pub wrong: Vec<RuledCell>,
}

/// A cell on which a side is wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct RuledCell {
    /// The ray.
    pub place: Place,
    /// The wrong sides: `A`, `B` or `A and B`.
    pub who: &'static str,
    /// Recorded value, true value and ruling, in words.
    pub what: String,
}

impl ChannelRuling {
    /// Number of cells on which a side is wrong, or which the referee could not decide.
    pub fn faults(&self) -> u64 {
        self.by_class.iter().filter(|((a, b), _)| *a.max(b) >= Class::Undecided).map(|(_, count)| count).sum()
    }
}
