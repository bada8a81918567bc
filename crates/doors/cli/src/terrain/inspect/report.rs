//! The result of an inspection.

use std::path::Path;

use raypencil::io::FileFacts;
use raypencil::terrain::{Inspection, Repairs};

/// The result of `terrain inspect`.
pub(super) struct Report<'a> {
    /// The mesh as the command line names it.
    pub(super) mesh: &'a str,
    /// What its file says.
    pub(super) facts: FileFacts,
    /// The inspection of that mesh.
    pub(super) found: Inspection,
    /// The repair; `None` without `--repair`.
    pub(super) repaired: Option<Repaired<'a>>,
}

/// A repaired mesh.
pub(super) struct Repaired<'a> {
    pub(super) file: &'a Path,
    pub(super) repairs: Repairs,
    /// The inspection of the repaired mesh.
    pub(super) left: Inspection,
}

impl Report<'_> {
    /// Whether the last inspection found no faults. A repair does not know what a polygon that crosses itself should be.
    pub(super) fn passes(&self) -> bool {
        self.fault_kinds() == 0
    }

    /// Number of kinds of faults that are left.
    pub(super) fn fault_kinds(&self) -> usize {
        self.last().fault_kinds() + usize::from(self.facts.polygons.crossing.is_some())
    }

    /// The inspection of the repaired mesh, or, without one, of the given mesh.
    pub(super) fn last(&self) -> &Inspection {
        self.repaired.as_ref().map_or(&self.found, |repaired| &repaired.left)
    }
}
