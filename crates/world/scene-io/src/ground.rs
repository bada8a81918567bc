//! The mesh of a plan's terrain: read from files, or generated.

use std::ops::Range;
use std::path::{Path, PathBuf};

use raypencil_mesh_io::{DEFAULT_REFLECTIVITY, TerrainFile, dem, read_dem_terrain, read_terrain};
use raypencil_scene::{Mesh, SceneError};
use raypencil_terrain::{BUILTIN_NAMES, MarsGround, RandomGround, builtin};

use crate::parse::source::Source;
use crate::plan::{DemPart, MeshPart, ScenePlan, Terrain};
use crate::scene_error::SceneIoError;
use crate::scene_source::MESH_ENDINGS;

/// Side of a plain random ground without `extent_m`, metres: the default sensors see 20 m to every side.
const PLAIN_EXTENT_M: f64 = 40.0;

/// Mesh of a terrain that needs files; `None`: the terrain needs none.
pub(crate) fn read_ground(source: &Source, plan: &ScenePlan) -> Result<Option<TerrainFile>, SceneIoError> {
    let reflectivity = plan.reflectivity.unwrap_or(DEFAULT_REFLECTIVITY);
    match &plan.terrain {
        Terrain::File(MeshPart { file, frame }) => {
            let terrain = terrain_file(source, "file", &MESH_ENDINGS, file, &plan.terrain_span)?;
            Ok(Some(read_terrain(&terrain, reflectivity, frame)?))
        }
        Terrain::Dem(DemPart { file, options, max_error }) => {
            let terrain = terrain_file(source, "dem", &["tif", "tiff"], file, &plan.terrain_span)?;
            Ok(Some(read_dem_terrain(&terrain, options, *max_error, reflectivity)?))
        }
        Terrain::Mars { ground, coarse: Some((file, span)) } => {
            let coarse = terrain_file(source, "generate.coarse", &["tif", "tiff"], file, span)?;
            let (posts, facts, sha) = dem::read_posts(&coarse)?;
            let ground = MarsGround { coarse: Some(posts), ..(**ground).clone() };
            let mesh = mars_mesh(&ground, plan.reflectivity).map_err(|error| {
                let SceneError { field, value, expected } = error;
                let message = format!("`terrain.generate.{field}` is {value}; expected {expected}");
                source.error(span.clone(), message)
            })?;
            Ok(Some(TerrainFile { mesh, digests: vec![sha], facts: facts.into() }))
        }
        Terrain::Builtin(_) | Terrain::Generate { .. } | Terrain::Mars { coarse: None, .. } => Ok(None),
    }
}

/// Path of the terrain's file, which the key `terrain.<key>` names, if it exists and ends in one of `ends`.
pub(crate) fn terrain_file(
    source: &Source,
    key: &str,
    ends: &[&str],
    file: &Path,
    span: &Range<usize>,
) -> Result<PathBuf, SceneIoError> {
    let terrain = source.file.parent().unwrap_or(Path::new("")).join(file);
    let known = |end: &&str| terrain.extension().is_some_and(|given| given.eq_ignore_ascii_case(end));
    if !ends.iter().any(known) {
        let (last, others) = ends.split_last().expect("at least one ending");
        let ends = format!(".{} or .{last}", others.join(", ."));
        let message =
            format!("`terrain.{key}` is \"{}\"; expected a file that ends in {ends}", file.display());
        return Err(source.error(span.clone(), message));
    }
    if !terrain.is_file() {
        let message = format!(
            "`terrain.{key}`: there is no file \"{}\"; expected a path relative to the scene file",
            terrain.display()
        );
        return Err(source.error(span.clone(), message));
    }
    Ok(terrain)
}

/// Mesh of a terrain that needs no files.
pub(crate) fn make_ground(plan: &ScenePlan) -> Result<Mesh, SceneError> {
    match &plan.terrain {
        Terrain::Builtin(name) => builtin(name, plan.reflectivity.unwrap_or(DEFAULT_REFLECTIVITY))
            .ok_or_else(|| SceneError::new("terrain.builtin", name, BUILTIN_NAMES.join(", ")))?
            .into_mesh(),
        &Terrain::Generate { nasty, seed, faces, extent, offset } => {
            let mut random = match nasty {
                true => RandomGround::nasty(seed, faces),
                false => RandomGround::plain(seed, faces, extent.unwrap_or(PLAIN_EXTENT_M)),
            };
            random.offset = offset;
            random.extent = extent.unwrap_or(random.extent);
            let mut ground = random.build();
            // A reflectivity in the file holds for the whole ground; else each kind of rock and soil keeps its own.
            if let Some(reflectivity) = plan.reflectivity {
                ground.materials.iter_mut().for_each(|kind| kind.reflectivity = reflectivity);
            }
            ground.into_mesh()
        }
        Terrain::Mars { ground, coarse: None } => mars_mesh(ground, plan.reflectivity),
        Terrain::Mars { coarse: Some((path, _)), .. } => {
            Err(SceneError::new("terrain.generate.coarse", path.display(), "posts that are loaded already"))
        }
        Terrain::File(MeshPart { file: path, .. }) | Terrain::Dem(DemPart { file: path, .. }) => {
            Err(SceneError::new("terrain.file", path.display(), "a terrain that is loaded already"))
        }
    }
}

/// Mesh of a Mars-like ground. A reflectivity in the file holds for the whole ground.
fn mars_mesh(ground: &MarsGround, reflectivity: Option<f64>) -> Result<Mesh, SceneError> {
    let mut ground = ground.build()?;
    if let Some(reflectivity) = reflectivity {
        ground.materials.iter_mut().for_each(|kind| kind.reflectivity = reflectivity);
    }
    ground.into_mesh()
}
