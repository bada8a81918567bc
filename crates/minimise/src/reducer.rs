//! The plainest draft so far, and what replaces it: every draft of which the predicate still holds.

use crate::draft::Draft;
use raypencil_scene::Place;
use raypencil_scene::{Progress, Scene};

/// The predicate does not hold for the scene that is to be minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the scene does not show it as it is: there is nothing to minimise")]
pub struct NotShown;

/// A search under way.
pub(crate) struct Trials<'a> {
    best: Draft,
    scene: Scene,
    shows: &'a dyn Fn(&Scene, Option<Place>) -> bool,
    calls: u64,
    budget: u64,
    /// Whether a question could not be asked any more.
    is_spent: bool,
    progress: &'a dyn Progress,
}

impl<'a> Trials<'a> {
    /// Begins with a draft of which the predicate must hold.
    pub(super) fn begin(
        first: Draft,
        shows: &'a dyn Fn(&Scene, Option<Place>) -> bool,
        budget: u64,
        progress: &'a dyn Progress,
    ) -> Result<Self, NotShown> {
        let scene = first.scene().expect("the parts of a scene make it again");
        if !shows(&scene, first.place) {
            return Err(NotShown);
        }
        Ok(Self { best: first, scene, shows, calls: 1, budget, is_spent: false, progress })
    }

    /// The plainest draft so far.
    pub(super) fn best(&self) -> &Draft {
        &self.best
    }

    /// How often the predicate was asked.
    pub(super) fn calls(&self) -> u64 {
        self.calls
    }

    /// Whether the budget did not suffice.
    pub(super) fn is_spent(&self) -> bool {
        self.is_spent
    }

    /// The scene of the plainest draft.
    pub(super) fn into_scene(self) -> Scene {
        self.scene
    }

    /// Says what is being done.
    pub(super) fn stage(&self, what: &str) {
        let (faces, calls) = (self.best.mesh.faces().len(), self.calls);
        self.progress.stage(&format!("minimising, {faces} faces after {calls} trials: {what}"));
    }

    /// Whether `draft` shows it, too; then it is the plainest from now on. What is no scene, or none other, is not
    /// asked about.
    pub(super) fn keep(&mut self, draft: Draft) -> bool {
        if self.is_spent || draft == self.best {
            return false;
        }
        let Ok(scene) = draft.scene() else { return false };
        if self.calls >= self.budget {
            self.is_spent = true;
            return false;
        }
        self.calls += 1;
        if !(self.shows)(&scene, draft.place) {
            return false;
        }
        (self.best, self.scene) = (draft, scene);
        true
    }

    /// The same for a change of the plainest draft.
    pub(super) fn change(&mut self, change: impl FnOnce(&mut Draft)) -> bool {
        let mut draft = self.best.clone();
        change(&mut draft);
        self.keep(draft)
    }

    /// Tries changes from the plainest to the least plain, and stops at the first that is kept or changes nothing.
    pub(super) fn plainest_of<T>(
        &mut self,
        changes: impl IntoIterator<Item = T>,
        make: impl Fn(&Draft, T) -> Option<Draft>,
    ) {
        for change in changes {
            let Some(draft) = make(&self.best, change) else { continue };
            // As plain as that it is already.
            if draft == self.best || self.keep(draft) || self.is_spent {
                return;
            }
        }
    }
}
