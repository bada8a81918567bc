//! Reference packs.

use std::path::PathBuf;

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use raypencil::cast::{CastSource, write_ray_pack, write_scan_pack};
use raypencil::harness::write_pack_with_ray_sets;
use raypencil::io::{LoadedRaySets, read_ray_sets};
use raypencil::pack::{PackLabel, benched};
use raypencil::{Progress, Sides};

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

/// Writes a pack for each set of a file of patterns, as the command does: of several sets in folders of their names. Returns what none of all
/// rays tests.
#[pyfunction]
#[pyo3(signature = (mesh, rays, output, fronts_only, on_stage=None))]
pub(crate) fn pack_ray_sets<'py>(
    py: Python<'py>,
    mesh: &MeshCore,
    rays: PathBuf,
    output: PathBuf,
    fronts_only: bool,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<&'static str>> {
    let mesh = mesh.clone();
    watched(py, on_stage, move |watch| {
        let LoadedRaySets { sets, sha256 } = read_ray_sets(&rays)?;
        let source = CastSource {
            mesh: "arrays".into(),
            rays: rays.display().to_string(),
            rays_sha256: Some(sha256),
            ..CastSource::default()
        };
        let mut untested: Option<Vec<&'static str>> = None;
        for set in &sets {
            let folder = if sets.len() == 1 { output.clone() } else { output.join(&set.name) };
            let sides = if fronts_only { Sides::Fronts } else { set.set.sides() };
            let counts = write_scan_pack(&folder, (&mesh.triangles, set, sides), &source, watch)?;
            let of_set = counts.untested();
            untested = Some(match untested {
                None => of_set,
                Some(earlier) => earlier.into_iter().filter(|words| of_set.contains(words)).collect(),
            });
        }
        Ok(untested.unwrap_or_default())
    })
}
