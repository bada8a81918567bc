//! The renderer whose answers are explained, and the judge that is asked about them.

use raypencil_scene::{Precision, RenderOutput, Request, Switches};

use crate::judge::Judge;

/// Renders the judge's scene as the paper's renderer does with these switches.
///
/// The judge knows no renderer: the caller passes the one whose answers are explained.
pub type Rerender<'a> = dyn Fn(Switches, Request) -> RenderOutput + Sync + 'a;

/// The renderer whose answers are explained, and the judge that is asked about them.
#[derive(Clone, Copy)]
pub(super) struct AttributionContext<'a> {
    pub(super) judge: &'a Judge<'a>,
    pub(super) switches: Switches,
    pub(super) precision: Precision,
    pub(super) rerender: &'a Rerender<'a>,
}

impl AttributionContext<'_> {
    /// Renders the scene as the renderer would with these switches.
    pub(super) fn render(&self, switches: Switches, request: Request) -> RenderOutput {
        (self.rerender)(switches, request)
    }
}

/// The non-empty sets of some switches, from the smallest to the largest.
pub(super) fn sets_of(switches: Switches) -> Vec<Switches> {
    let mut sets: Vec<Switches> =
        Switches::subsets().filter(|set| *set != Switches::EXACT && switches.contains(*set)).collect();
    sets.sort_by_key(|set| set.count());
    sets
}
