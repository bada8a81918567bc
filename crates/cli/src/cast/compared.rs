//! `raypencil cast --with`: a renderer's first hits beside the exact ones.

use std::path::Path;

use raypencil::cast::{Comparison, Stated, compare, comparison_json, comparison_text, write_comparison};
use raypencil::io::{FolderError, create_folder, quoted};
use raypencil::{CastRay, Precision, Progress, Sides, Triangles};
use serde_json::Value;

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

    pub(super) fn passes(&self) -> bool {
        self.comparison.passes()
    }

    pub(super) fn json(&self) -> Value {
        comparison_json(self.name, &self.comparison)
    }

    pub(super) fn text(&self, rays: &[CastRay]) -> String {
        comparison_text(self.name, &self.comparison, |index| self.ray_command(&rays[index]))
    }

    /// Writes the arrays of the comparison into the folder of the answers.
    pub(super) fn write(&self, folder: &Path, shape: &[u64]) -> Result<(), FolderError> {
        create_folder(folder)?;
        write_comparison(folder, self.name, shape, &self.stated, &self.comparison)?;
        Ok(())
    }

    /// The command that shows everything about a ray.
    fn ray_command(&self, ray: &CastRay) -> String {
        let [ox, oy, oz] = ray.origin.to_array();
        let [dx, dy, dz] = ray.direction.to_array();
        let mut numbers = format!("{ox},{oy},{oz},{dx},{dy},{dz}");
        if ray.t_min > 0.0 || ray.t_max < f64::INFINITY {
            numbers += &format!(",{},{}", ray.t_min, ray.t_max);
        }
        let mesh = quoted(&self.command.mesh.display().to_string());
        let fronts = if self.command.fronts_only { " --fronts-only" } else { "" };
        format!("raypencil cast {mesh} --ray={numbers}{fronts} --all --margins")
    }
}
