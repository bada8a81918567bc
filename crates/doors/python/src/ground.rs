//! Generated terrain.

use std::path::PathBuf;

use pyo3::prelude::*;
use raypencil::io::read_dem;
use raypencil::terrain::{Ground, MarsGround, PRESET_NAMES};
use raypencil::{Progress, Triangles};

use crate::failure::Failure;
use crate::mesh::MeshCore;
use crate::watch::watched;

/// A Mars-like ground, in the global frame.
#[pyfunction]
#[pyo3(signature = (
    preset, seed, extent=None, post_spacing=None, fine_radius=None, rock_coverage=None, rock_smallest=None,
    crevasses=None, coarse=None, on_stage=None
))]
pub(crate) fn generate_ground(
    py: Python<'_>,
    preset: String,
    seed: u64,
    extent: Option<f64>,
    post_spacing: Option<f64>,
    fine_radius: Option<f64>,
    rock_coverage: Option<f64>,
    rock_smallest: Option<f64>,
    crevasses: Option<u32>,
    coarse: Option<PathBuf>,
    on_stage: Option<&Bound<'_, PyAny>>,
) -> PyResult<MeshCore> {
    watched(py, on_stage, move |watch| {
        let mut ground = MarsGround::preset(&preset, seed).ok_or_else(|| {
            let known = PRESET_NAMES.join(", ");
            Failure::new(format!("preset {preset}: there is no such preset; expected one of {known}"))
        })?;
        let given = [
            (extent, &mut ground.extent),
            (post_spacing, &mut ground.post_spacing),
            (fine_radius, &mut ground.fine_radius),
            (rock_coverage, &mut ground.rocks.coverage),
            (rock_smallest, &mut ground.rocks.smallest),
        ];
        for (value, slot) in given {
            *slot = value.unwrap_or(*slot);
        }
        ground.crevasses.count = crevasses.unwrap_or(ground.crevasses.count);
        if let Some(coarse) = &coarse {
            watch.stage(&format!("{}: reading", coarse.display()));
            ground.coarse = Some(read_dem(coarse, None)?.posts);
        }
        watch.stage(&format!("{preset}, seed {seed}: making faces"));
        let mesh = ground.build().and_then(Ground::into_mesh)?;
        let origin = mesh.origin();
        // Offsets are single, the origin is whole metres: the sum is that of the file's reader.
        let vertices = mesh.vertices().iter().map(|offset| {
            let [x, y, z] = offset.map(f64::from);
            [origin.x + x, origin.y + y, origin.z + z]
        });
        Ok(MeshCore::from_triangles(Triangles::new(vertices.collect(), mesh.faces().to_vec())?))
    })
}
