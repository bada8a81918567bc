use crate::class::Class;
use raypencil_scene::{Pixel, Switches};

/// What a pencil delivers on each side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PencilLight {
    /// The worst class of the pencil's quantities.
    pub(super) class: Class,
    /// The switches that are its cause, if that is an approximation.
    pub(super) causes: Switches,
    /// Where, and how much.
    pub(super) delivered: [Option<(Pixel, f64)>; 2],
    /// How far the two amounts may differ.
    pub(super) bound: f64,
}

impl PencilLight {
    /// This, if either side delivers anything.
    pub(super) fn if_any(self) -> Option<Self> {
        self.delivered.iter().any(Option::is_some).then_some(self)
    }

    /// By how much the two amounts differ.
    pub(super) fn difference(&self) -> f64 {
        let [a, b] = self.delivered.map(|delivered| delivered.map_or(0.0, |(_, flux)| flux));
        (a - b).abs()
    }
}
