//! The flux of one pencil on both sides.

use crate::class::Class;
use raypencil_scene::{Pixel, Switches};

/// The flux of one pencil on both sides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FluxPair {
    /// The worst class of the pencil's quantities.
    pub(super) class: Class,
    /// The switches that are its cause, if that class is an approximation.
    pub(super) causes: Switches,
    /// Pixel and flux of each side, watts (`eq1`: W/m); `None` if the pencil delivers nothing.
    pub(super) delivered: [Option<(Pixel, f64)>; 2],
    /// How far the two fluxes may differ, watts (`eq1`: W/m).
    pub(super) bound: f64,
}

impl FluxPair {
    /// A pencil that delivers nothing on either side.
    pub(super) const NOTHING: Self =
        Self { class: Class::Agree, causes: Switches::EXACT, delivered: [None; 2], bound: 0.0 };

    /// This, if either side delivers anything.
    pub(super) fn if_any(self) -> Option<Self> {
        self.delivered.iter().any(Option::is_some).then_some(self)
    }

    /// Absolute difference of the two fluxes, watts (`eq1`: W/m).
    pub(super) fn difference(&self) -> f64 {
        let [a, b] = self.delivered.map(|delivered| delivered.map_or(0.0, |(_, flux)| flux));
        (a - b).abs()
    }
}
