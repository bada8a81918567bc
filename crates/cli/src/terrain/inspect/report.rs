//! The result of an inspection.

use std::path::Path;

use raypencil::io::PolygonFacts;
use raypencil::terrain::{Inspection, Repairs};
use serde_json::Value;

/// What a file says about its units and axes.
#[derive(Default)]
pub(super) struct Facts {
    /// For programs; null for a scene.
    pub(super) of_file: Value,
    /// For people.
    pub(super) lines: Vec<(&'static str, String)>,
}

/// The result of `terrain inspect`.
pub(super) struct Report<'a> {
    /// The mesh as the command line names it.
    pub(super) mesh: &'a str,
    /// What its file says.
    pub(super) facts: Facts,
    /// The inspection of that mesh.
    pub(super) found: Inspection,
    /// What was found out about the polygons of its file.
    pub(super) polygons: PolygonFacts,
    /// The repair; `None` without `--repair`.
    pub(super) repaired: Option<Repaired<'a>>,
}

/// A repaired mesh.
pub(super) struct Repaired<'a> {
    /// Its file.
    pub(super) file: &'a Path,
    /// The repairs.
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
        self.last().fault_kinds() + usize::from(self.polygons.crossing.is_some())
    }

    /// The inspection of the repaired mesh, or, without one, of the given mesh.
    pub(super) fn last(&self) -> &Inspection {
        self.repaired.as_ref().map_or(&self.found, |repaired| &repaired.left)
    }
}
