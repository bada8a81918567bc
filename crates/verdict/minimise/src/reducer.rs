//! A search under way: the simplest scene so far, and the interestingness test that each simpler one must pass.

use raypencil_scene::{Place, Progress, Scene};

use crate::reduction::Reduction;

/// Decides whether a scene is interesting, that is, whether it still shows what the search must keep. It is told where
/// the ray in question is in that scene.
pub type InterestingnessTest<'a> = dyn Fn(&Scene, Option<Place>) -> bool + 'a;

/// The scene to be minimised does not pass the interestingness test.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the scene does not pass the interestingness test as it is; expected a scene that does")]
pub struct NotInteresting;

/// State of a search.
pub(crate) struct Reducer<'a> {
    /// The simplest interesting reduction so far.
    best: Reduction,
    /// The scene of `best`.
    scene: Scene,
    is_interesting: &'a InterestingnessTest<'a>,
    /// Calls of the test so far.
    calls: u64,
    /// Maximum number of calls.
    budget: u64,
    /// Whether the budget prevented a call.
    is_spent: bool,
    progress: &'a dyn Progress,
}

impl<'a> Reducer<'a> {
    /// Begins with a reduction that must be interesting.
    pub(super) fn begin(
        first: Reduction,
        is_interesting: &'a InterestingnessTest<'a>,
        budget: u64,
        progress: &'a dyn Progress,
    ) -> Result<Self, NotInteresting> {
        let scene = first.scene().expect("the parts of a scene make it again");
        if !is_interesting(&scene, first.place) {
            return Err(NotInteresting);
        }
        Ok(Self { best: first, scene, is_interesting, calls: 1, budget, is_spent: false, progress })
    }

    /// The simplest interesting reduction so far.
    pub(super) fn best(&self) -> &Reduction {
        &self.best
    }

    /// Number of calls of the test.
    pub(super) fn calls(&self) -> u64 {
        self.calls
    }

    /// Whether the search stopped because its budget was spent.
    pub(super) fn is_spent(&self) -> bool {
        self.is_spent
    }

    /// The scene of the simplest reduction.
    pub(super) fn into_scene(self) -> Scene {
        self.scene
    }

    /// Reports a stage of the search.
    pub(super) fn stage(&self, what: &str) {
        let (faces, calls) = (self.best.mesh.faces().len(), self.calls);
        self.progress.stage(&format!("minimising, {faces} faces after {calls} trials: {what}"));
    }

    /// Takes `variant` as the simplest reduction if it is interesting, and returns whether it is. An invalid scene and
    /// an unchanged one are refused without a call of the test.
    pub(super) fn try_variant(&mut self, variant: Reduction) -> bool {
        if self.is_spent || variant == self.best {
            return false;
        }
        let Ok(scene) = variant.scene() else { return false };
        if self.calls >= self.budget {
            self.is_spent = true;
            return false;
        }
        self.calls += 1;
        if !(self.is_interesting)(&scene, variant.place) {
            return false;
        }
        (self.best, self.scene) = (variant, scene);
        true
    }

    /// Tries the simplest reduction with a change.
    pub(super) fn try_change(&mut self, change: impl FnOnce(&mut Reduction)) -> bool {
        let mut variant = self.best.clone();
        change(&mut variant);
        self.try_variant(variant)
    }

    /// Tries changes in the order given, the simplest first. Stops at the first that is accepted or changes nothing.
    pub(super) fn accept_simplest<T>(
        &mut self,
        changes: impl IntoIterator<Item = T>,
        make: impl Fn(&Reduction, T) -> Option<Reduction>,
    ) {
        for change in changes {
            let Some(variant) = make(&self.best, change) else { continue };
            // An equal variant: the reduction is already as simple as this change makes it.
            if variant == self.best || self.try_variant(variant) || self.is_spent {
                return;
            }
        }
    }
}
