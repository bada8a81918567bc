//! Reference packs.

use std::path::{Path, PathBuf};

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use raypencil::cast::{CastSource, write_ray_pack, write_scan_pack};
use raypencil::harness::write_pack_with_ray_sets;
use raypencil::io::{LoadedRaySets, OutputFolder, read_ray_sets};
use raypencil::pack::{PackLabel, benched};
use raypencil::{Progress, Sides};
use raypencil_cli::overwriting::{self, PackOf, ask_pack, ask_pack_inputs};

use crate::failure::Failure;
use crate::folder::failure;
use crate::mesh::MeshCore;
use crate::rays::{rays_of, shaped, sides};
use crate::scene::{SceneCore, usage};
use crate::watch::watched;

/// What a mesh or rays of arrays are called.
const ARRAYS: &str = "arrays";

/// Writes packs into a folder that is a pack's or becomes one: no other pack and no other results are replaced unasked.
fn into_pack<T>(
    folder: &Path,
    force: bool,
    inputs: &[&Path],
    packs: &[(&Path, PackOf<'_>)],
    write: impl FnOnce() -> Result<T, Failure>,
) -> Result<T, Failure> {
    overwriting::begin(force);
    let is_of_rays = packs.iter().any(|(_, of)| matches!(of, PackOf::Mesh(_)));
    ask_pack_inputs(folder, is_of_rays, inputs).map_err(failure)?;
    let begun = OutputFolder::begin_any(folder).map_err(failure)?;
    for (folder, of) in packs {
        ask_pack(folder, *of).map_err(failure)?;
    }
    let written = write()?;
    begun.finish_unlisted().map_err(failure)?;
    Ok(written)
}

/// Writes the pack of a scene. `bench`: with rays at the limits of the contract.
#[pyfunction]
#[pyo3(signature = (scene, output, bench, version=None, licence=None, force=false, on_stage=None))]
pub(crate) fn pack_scene(
    py: Python<'_>,
    scene: &SceneCore,
    output: PathBuf,
    bench: bool,
    version: Option<String>,
    licence: Option<String>,
    force: bool,
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
        let inputs = [Path::new(scene.of())];
        into_pack(
            &output,
            force,
            &inputs,
            &[(&output, PackOf::Scene(&subject.name, label.version.as_deref()))],
            || {
                write_pack_with_ray_sets(&subject, None, &label, &output, watch)?;
                Ok(())
            },
        )
    })
}

/// Writes a pack of rays on a mesh. Returns what none of the rays tests.
#[pyfunction]
#[pyo3(signature = (mesh, rays, shape, output, fronts_only, force=false, on_stage=None))]
pub(crate) fn pack_rays<'py>(
    py: Python<'py>,
    mesh: &MeshCore,
    rays: PyReadonlyArray2<'py, f64>,
    shape: Vec<u64>,
    output: PathBuf,
    fronts_only: bool,
    force: bool,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<&'static str>> {
    let sides = sides(fronts_only);
    let set = rays_of(&rays, sides).map_err(|failure| failure.into_exception(py))?;
    if shape.iter().product::<u64>() != set.rays().len() as u64 {
        return Err(usage(py, format!("{} rays of shape {shape:?}", set.rays().len())));
    }
    let (mesh, array) = (mesh.clone(), shaped(set, &shape));
    watched(py, on_stage, move |watch| {
        let source = CastSource { mesh: ARRAYS.into(), rays: ARRAYS.into(), ..CastSource::default() };
        into_pack(&output, force, &[], &[(&output, PackOf::Mesh(ARRAYS))], || {
            let counts = write_ray_pack(&output, (&mesh.triangles, &array, sides), &source, watch)?;
            Ok(counts.untested())
        })
    })
}

/// Writes a pack for each set of a file of patterns, as the command does: of several sets in folders of their names. Returns what none of all
/// rays tests.
#[pyfunction]
#[pyo3(signature = (mesh, rays, output, fronts_only, force=false, on_stage=None))]
pub(crate) fn pack_ray_sets<'py>(
    py: Python<'py>,
    mesh: &MeshCore,
    rays: PathBuf,
    output: PathBuf,
    fronts_only: bool,
    force: bool,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<&'static str>> {
    let mesh = mesh.clone();
    watched(py, on_stage, move |watch| {
        let LoadedRaySets { sets, sha256 } = read_ray_sets(&rays)?;
        let source = CastSource {
            mesh: ARRAYS.into(),
            rays: rays.display().to_string(),
            rays_sha256: Some(sha256),
            ..CastSource::default()
        };
        let folder_of = |name: &str| if sets.len() == 1 { output.clone() } else { output.join(name) };
        let folders: Vec<PathBuf> = sets.iter().map(|set| folder_of(&set.name)).collect();
        let packs: Vec<_> = folders.iter().map(|folder| (folder.as_path(), PackOf::Mesh(ARRAYS))).collect();
        into_pack(&output, force, &[&rays], &packs, || {
            let mut untested: Option<Vec<&'static str>> = None;
            for (set, folder) in sets.iter().zip(&folders) {
                let sides = if fronts_only { Sides::Fronts } else { set.set.sides() };
                let counts = write_scan_pack(folder, (&mesh.triangles, set, sides), &source, watch)?;
                let of_set = counts.untested();
                untested = Some(match untested {
                    None => of_set,
                    Some(earlier) => earlier.into_iter().filter(|words| of_set.contains(words)).collect(),
                });
            }
            Ok(untested.unwrap_or_default())
        })
    })
}
