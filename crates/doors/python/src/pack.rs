//! Reference packs.

use std::path::PathBuf;

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use raypencil::Progress;
use raypencil::cast::{CastSource, write_ray_pack};
use raypencil::harness::write_pack_with_ray_sets;
use raypencil::pack::{PackLabel, benched};

use crate::mesh::MeshCore;
use crate::rays::{rays_of, shaped, sides};
use crate::scene::{SceneCore, usage};
use crate::watch::watched;

/// Writes the pack of a scene. `bench`: with rays at the limits of the contract.
#[pyfunction]
#[pyo3(signature = (scene, output, bench, version=None, licence=None, on_stage=None))]
pub(crate) fn pack_scene(
    py: Python<'_>,
    scene: &SceneCore,
    output: PathBuf,
    bench: bool,
    version: Option<String>,
    licence: Option<String>,
    on_stage: Option<&Bound<'_, PyAny>>,
) -> PyResult<()> {
    let label = PackLabel { version, licence };
    if let Err(fault) = label.check() {
        return Err(usage(py, fault.to_string()));
    }
    let scene = scene.clone();
    watched(py, on_stage, move |watch| {
        watch.stage("packing");
        let subject = scene.subject("");
        let subject = if bench { benched(subject)? } else { subject };
        write_pack_with_ray_sets(&subject, None, &label, &output, watch)?;
        Ok(())
    })
}

/// Writes a pack of rays on a mesh. Returns what none of the rays tests.
#[pyfunction]
#[pyo3(signature = (mesh, rays, shape, output, fronts_only, on_stage=None))]
pub(crate) fn pack_rays<'py>(
    py: Python<'py>,
    mesh: &MeshCore,
    rays: PyReadonlyArray2<'py, f64>,
    shape: Vec<u64>,
    output: PathBuf,
    fronts_only: bool,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<&'static str>> {
    let sides = sides(fronts_only);
    let set = rays_of(&rays, sides).map_err(|failure| failure.into_exception(py))?;
    if shape.iter().product::<u64>() != set.rays().len() as u64 {
        return Err(usage(py, format!("{} rays of shape {shape:?}", set.rays().len())));
    }
    let (mesh, array) = (mesh.clone(), shaped(set, &shape));
    watched(py, on_stage, move |watch| {
        let source = CastSource { mesh: "arrays".into(), rays: "arrays".into(), ..CastSource::default() };
        let counts = write_ray_pack(&output, (&mesh.triangles, &array, sides), &source, watch)?;
        Ok(counts.untested())
    })
}
