//! `raypencil cast --with`: a renderer's first hits beside the exact ones.

use std::path::Path;

use raypencil::cast::{
    ComparedHits, Comparison, Stated, compare, comparison_json, comparison_text, write_comparison,
};
use raypencil::io::FileError;
use raypencil::{CastRay, Precision, Progress, Sides, Triangles};
use serde_json::Value;

use super::ray_command::ray_command;
use crate::args::Cast;

/// A renderer's first hits, and what became of them.
pub(super) struct Compared<'a> {
    command: &'a Cast,
    name: &'a str,
    stated: Stated,
    comparison: Comparison,
}

impl<'a> Compared<'a> {
    /// The first hits of the renderer that the command names; `None` if it names none.
    pub(super) fn of(
        command: &'a Cast,
        mesh: &Triangles,
        rays: &[CastRay],
        sides: Sides,
        progress: &dyn Progress,
    ) -> Option<Self> {
        // The command line accepts no other name.
        let name = command.with.as_deref()?;
        progress.stage(&format!("{name}: tracing {} rays", rays.len()));
        let stated = Stated::by_tracer(mesh, rays, sides);
        let comparison = compare(mesh, rays, sides, &stated, Precision::F64, progress);
        Some(Self { command, name, stated, comparison })
    }

    /// Whether no ray is wrong, and some ray hits or none has to.
    pub(super) fn passes(&self, allow_empty: bool) -> bool {
        self.comparison.passes() || (allow_empty && self.comparison.counts().wrong == 0)
    }

    pub(super) fn json(&self) -> Value {
        comparison_json(self.name, &self.comparison)
    }

    pub(super) fn text(&self, rays: &[CastRay]) -> String {
        comparison_text(self.name, &self.comparison, |index| ray_command(self.command, &rays[index]))
    }

    /// The comparison as a page shows it.
    pub(super) fn hits<'p>(&'p self, ray_command: &'p dyn Fn(usize) -> String) -> ComparedHits<'p> {
        let Self { name, stated, comparison, .. } = self;
        ComparedHits { name, stated, comparison, ray_command }
    }

    /// Writes the arrays of the comparison into the folder of the answers.
    pub(super) fn write(&self, folder: &Path, shape: &[u64]) -> Result<(), FileError> {
        write_comparison(folder, self.name, shape, &self.stated, &self.comparison)?;
        Ok(())
    }
}
