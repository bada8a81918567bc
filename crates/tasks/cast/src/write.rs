//! Answers as NPY arrays, and their summary.

use std::path::{Path, PathBuf};

use raypencil_files::{
    FileError, FolderError, RayArray, begin_output_folder, write_atomically, write_npy_numbers,
};
use raypencil_mesh_io::{DemFacts, FileFacts, FileFrame, FileUnits, UpAxis};
use raypencil_referee::Margin;
use raypencil_report::VERSION;
use raypencil_scene::pattern::EchoLight;
use raypencil_scene::{CastRay, NamedRaySet, Sides, Triangles};
use serde_json::{Value, json};

use crate::answers::{AllColumns, Answers, FirstHit, GroupAtT, side_number};
use crate::cloud::{CloudFrame, CloudMap, write_pcd, write_ply};
use crate::pcd_data::PcdData;
use crate::range_picture::{range_picture, top_picture};
use crate::returns::{BeamReturn, BeamReturns, echo_json};
use crate::warnings::{MeshHome, cast_warnings};

/// Where mesh and rays come from, for the summary.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CastSource {
    /// The mesh as it was given.
    pub mesh: String,
    /// SHA-256 of the files of the mesh, in hexadecimal: the file itself, then those that it names.
    pub mesh_sha256: Vec<String>,
    /// The rays as they were given.
    pub rays: String,
    /// SHA-256 of the bytes of the rays, in hexadecimal; `None` if they were given one by one.
    pub rays_sha256: Option<String>,
    /// The axes and the unit that were given for the mesh's file.
    pub frame: FileFrame,
    /// What was found out about the mesh's file.
    pub facts: FileFacts,
    /// Where the origin of the mesh's frame lies in the map of the mesh's file, metres: 0 where the coordinates are those of the file.
    pub origin: [f64; 3],
    /// Whether the mesh is the terrain of a scene file.
    pub is_scene: bool,
}

impl CastSource {
    /// What warnings name of where the mesh comes from.
    pub fn home(&self) -> MeshHome {
        MeshHome { is_scene: self.is_scene, origin: self.origin }
    }

    /// The map in which the mesh's frame lies, as clouds name it.
    pub fn map(&self) -> CloudMap {
        CloudMap { origin: self.origin, system: self.facts.dem().and_then(DemFacts::map_name) }
    }
}

/// What stands for no face.
const NO_FACE: u32 = u32::MAX;

/// Writes a folder: an array for each value, of the rays' own shape, and last `summary.json`. Returns its path.
///
/// | array | type and shape | where nothing is hit, or what is hit is too near |
/// | --- | --- | --- |
/// | `face` | u4 | 4294967295 |
/// | `side` | i1: 1 front, -1 back | 0 |
/// | `ties` | u4: number of faces at this t | 0 |
/// | `t`, `range` | f8 | +Inf; -Inf for what is too near |
/// | `cos_incidence` | f8 | NaN |
/// | `point`, `normal`, `barycentric` | f8, (..., 3) | NaN |
/// | `any`, if it was asked | u1: 0 or 1 | 0; 1 for what is too near |
/// | `all.start`, if all hits were asked for | u8, (rays + 1): the hits of ray k are `start[k]..start[k + 1]` | |
/// | `margin.face`, `margin.surface`, if they were asked for | f8, (..., 2): lo and hi, in the mesh's unit | as for hits |
/// | `across`, with the margins | f8, (..., 2, 3): the vectors along which a ray is moved | as for hits |
/// | `all.face`, `all.side`, `all.t`, `all.group`, `all.crossing` | one entry per hit; hits at one t are one group | |
///
/// # Errors
/// The folder or a file cannot be written; the message names it.
pub fn write_answers(
    folder: &Path,
    answers: &Answers,
    (mesh, rays, sides): (&Triangles, &RayArray, Sides),
    source: &CastSource,
) -> Result<PathBuf, FolderError> {
    let summary = begin_output_folder(folder, "summary.json")?;
    let (arrays, document) =
        write_arrays(folder, answers, (mesh, &rays.shape, &rays.rays, sides), None, source)?;
    finish(summary, arrays, document)
}

/// As [`write_answers`], for a named set: its name is in `summary.json`, and there are more files.
///
/// | file | content |
/// | --- | --- |
/// | `origin.npy`, `direction.npy` | f8, (..., 3): each ray as it is fired, in the mesh's frame |
/// | `time.npy`, if the set has times | f8: time at which each ray is fired, seconds |
/// | `weight.npy`, if rays are parts of beams | f8, (k): shares of a beam's power along the last dimension |
/// | `return.*.npy`, if the set asks for returns | the returns of its beams, as `docs/guide/lidar.md` lists them |
/// | `cloud.ply`, `cloud.pcd` | the points: [`write_ply`], [`write_pcd`] |
/// | `cloud-sensor.pcd`, `cloud-start.pcd`, `cloud-end.pcd` | the same in frames of the sensor: [`CloudFrame`] |
/// | `range.png`, for two dimensions, and `top.png` | pictures, if anything is hit: [`range_picture`], [`top_picture`] |
///
/// # Errors
/// As [`write_answers`].
pub fn write_set(
    folder: &Path,
    answers: &Answers,
    (mesh, set, sides): (&Triangles, &NamedRaySet, Sides),
    source: &CastSource,
    pcd: PcdData,
) -> Result<PathBuf, FolderError> {
    let summary = begin_output_folder(folder, "summary.json")?;
    let rays = set.set.rays();
    let (mut arrays, mut document) =
        write_arrays(folder, answers, (mesh, &set.shape, rays, sides), Some(set), source)?;
    let mut more = ArrayFolder { folder, arrays: &mut arrays };
    let with_three: Vec<u64> = set.shape.iter().copied().chain([3]).collect();
    let vectors = |of: fn(&CastRay) -> glam::DVec3| -> Vec<f64> {
        rays.iter().flat_map(|ray| of(ray).to_array()).collect()
    };
    more.write("origin", &with_three, &vectors(|ray| ray.origin))?;
    more.write("direction", &with_three, &vectors(|ray| ray.direction))?;
    if let Some(times) = &set.times {
        more.write("time", &set.shape, times)?;
    }
    if let Some(weights) = &set.weights {
        more.write("weight", &[weights.len() as u64], weights)?;
    }
    let returns = BeamReturns::of(answers, set);
    if let Some(returns) = &returns {
        write_returns(&mut more, returns, &set.shape)?;
        document["returns"] = returns.json();
    }
    let map = source.map();
    write_ply(folder.join("cloud.ply"), answers, returns.as_ref(), &map)?;
    let mut clouds = vec!["cloud.ply"];
    for frame in CloudFrame::of(&set.mounting) {
        write_pcd(folder.join(frame.file()), answers, (set, returns.as_ref()), (*frame, pcd), &map)?;
        clouds.push(frame.file());
    }
    let mut pictures = Vec::new();
    let drawings = [("range.png", range_picture(answers, set)), ("top.png", top_picture(answers, set))];
    for (name, drawing) in drawings {
        let Some(drawing) = drawing else { continue };
        write_atomically(folder.join(name), |file| file.write_all(&drawing.png()))?;
        pictures.push(name);
    }
    document["rays"]["name"] = json!(set.name);
    if set.echo != EchoLight::default() {
        document["rays"]["light"] = echo_json(&set.echo);
    }
    document["clouds"] = json!(clouds);
    document["pictures"] = json!(pictures);
    finish(summary, arrays, document)
}

/// Writes `summary.json`, which lists the arrays.
fn finish(summary: PathBuf, arrays: Vec<String>, mut document: Value) -> Result<PathBuf, FolderError> {
    document["arrays"] = json!(arrays);
    write_atomically(&summary, |file| file.write_all(format!("{document:#}\n").as_bytes()))?;
    Ok(summary)
}

/// Writes the arrays. Returns their names, and the summary without them.
fn write_arrays(
    folder: &Path,
    answers: &Answers,
    (mesh, shape, rays, sides): (&Triangles, &[u64], &[CastRay], Sides),
    set: Option<&NamedRaySet>,
    source: &CastSource,
) -> Result<(Vec<String>, Value), FileError> {
    let mut arrays = Vec::new();
    let mut folder = ArrayFolder { folder, arrays: &mut arrays };
    let vectors =
        |value: fn(&FirstHit) -> [f64; 3]| -> Vec<f64> { answers.values(value, [f64::NAN; 3]).concat() };
    let with_three: Vec<u64> = shape.iter().copied().chain([3]).collect();
    folder.write("face", shape, &answers.values(|hit| hit.face.0, NO_FACE))?;
    folder.write("side", shape, &answers.values(|hit| side_number(hit.side), 0))?;
    folder.write("ties", shape, &answers.values(|hit| hit.ties, 0))?;
    folder.write("t", shape, &answers.distances(|hit| hit.t))?;
    folder.write("range", shape, &answers.distances(|hit| hit.range))?;
    folder.write("cos_incidence", shape, &answers.values(|hit| hit.cos_incidence, f64::NAN))?;
    folder.write("point", &with_three, &vectors(|hit| hit.point.to_array()))?;
    folder.write("normal", &with_three, &vectors(|hit| hit.normal.to_array()))?;
    folder.write("barycentric", &with_three, &vectors(|hit| hit.barycentric))?;
    if let Some(any) = &answers.any {
        folder.write("any", shape, &any.iter().map(|&is_hit| u8::from(is_hit)).collect::<Vec<_>>())?;
    }
    if let Some(all) = &answers.all {
        write_all(&mut folder, all)?;
    }
    if let Some(margins) = &answers.margins {
        let with = |last: &[u64]| -> Vec<u64> { shape.iter().chain(last).copied().collect() };
        let both = |margin: &Margin| [margin.lo, margin.hi];
        let faces: Vec<f64> = margins.iter().flat_map(|margins| both(&margins.face)).collect();
        let surfaces: Vec<f64> = margins.iter().flat_map(|margins| both(&margins.surface)).collect();
        let across: Vec<f64> =
            rays.iter().flat_map(CastRay::across).flat_map(|vector| vector.to_array()).collect();
        folder.write("margin.face", &with(&[2]), &faces)?;
        folder.write("margin.surface", &with(&[2]), &surfaces)?;
        folder.write("across", &with(&[2, 3]), &across)?;
    }
    let (hits, ties) = answers.counts();
    let document = json!({
        "format": 1,
        "kind": "cast",
        "raypencilVersion": VERSION,
        "mesh": {
            "file": source.mesh,
            "sha256": source.mesh_sha256,
            "vertices": mesh.vertices().len(),
            "faces": mesh.faces().len(),
            "zeroAreaFaces": mesh.zero_area_faces(),
            "up": source.frame.up.map(UpAxis::word),
            "scale": source.frame.scale,
            "originM": source.origin,
            "units": source.facts.units.as_ref().map(FileUnits::to_json),
            "polygons": source.facts.polygons,
        },
        "rays": { "file": source.rays, "sha256": source.rays_sha256, "shape": shape, "count": answers.first.len() },
        "sides": if sides == Sides::Both { "both" } else { "fronts" },
        "warnings": cast_warnings((mesh, source.home()), rays, sides, set, answers),
        "counts": { "hits": hits, "tooNear": answers.too_near(), "misses": answers.misses(), "ties": ties },
    });
    Ok((arrays, document))
}

/// All hits of all rays, one after the other.
fn write_all(folder: &mut ArrayFolder<'_>, all: &[Vec<GroupAtT>]) -> Result<(), FileError> {
    let AllColumns { start, face, side, t, group, crossing } = AllColumns::of(all);
    let count = [face.len() as u64];
    folder.write("all.start", &[start.len() as u64], &start)?;
    folder.write("all.face", &count, &face)?;
    folder.write("all.side", &count, &side)?;
    folder.write("all.t", &count, &t)?;
    folder.write("all.group", &count, &group)?;
    folder.write("all.crossing", &count, &crossing)
}

/// The returns of all beams: arrays of the rays' shape, of that of the beams, and of as many places for each beam as may be told.
fn write_returns(
    folder: &mut ArrayFolder<'_>,
    returns: &BeamReturns,
    shape: &[u64],
) -> Result<(), FileError> {
    let beams = shape.split_last().map_or(&[][..], |(_, beams)| beams);
    let places: Vec<u64> = beams.iter().copied().chain([returns.most() as u64]).collect();
    let footprints = returns.footprints();
    folder.write("return.of_ray", shape, returns.of_rays())?;
    folder.write("return.count", beams, &footprints.iter().map(|beam| beam.returns).collect::<Vec<_>>())?;
    let mixed: Vec<u8> = footprints.iter().map(|beam| beam.is_mixed().into()).collect();
    folder.write("return.mixed", beams, &mixed)?;
    let missed: Vec<f64> = footprints.iter().map(|beam| returns.missed(beam)).collect();
    folder.write("return.share_missed", beams, &missed)?;
    let wholes = |of: &dyn Fn(&BeamReturn) -> u32, none: u32| -> Vec<u32> {
        returns.told().iter().map(|told| told.as_ref().map_or(none, of)).collect()
    };
    let reals = |of: &dyn Fn(&BeamReturn) -> f64, none: f64| -> Vec<f64> {
        returns.told().iter().map(|told| told.as_ref().map_or(none, of)).collect()
    };
    folder.write("return.number", &places, &wholes(&|told| told.number, 0))?;
    // Its index within the footprint fits: a cone has some ten thousand rays at most.
    let rays = returns.rays_of_beam();
    folder.write("return.ray", &places, &wholes(&|told| (told.ray % rays) as u32, u32::MAX))?;
    folder.write("return.range", &places, &reals(&|told| told.range, f64::INFINITY))?;
    folder.write("return.mean_range", &places, &reals(&|told| told.mean_range, f64::INFINITY))?;
    folder.write("return.strength", &places, &reals(&|told| told.strength, 0.0))?;
    folder.write("return.share", &places, &reals(&|told| returns.share(told.rays), 0.0))?;
    let other = returns.told().iter().enumerate().map(|(place, told)| {
        let rays = told.as_ref().map_or(0, |told| told.rays);
        returns.share(footprints[place / returns.most()].hits - rays)
    });
    folder.write("return.share_other", &places, &other.collect::<Vec<_>>())
}

/// The same into a folder, for a pack; their names.
pub(crate) fn write_beam_returns(
    folder: &Path,
    returns: &BeamReturns,
    shape: &[u64],
) -> Result<Vec<String>, FileError> {
    let mut arrays = Vec::new();
    write_returns(&mut ArrayFolder { folder, arrays: &mut arrays }, returns, shape)?;
    Ok(arrays)
}

/// The folder and the names of the arrays written to it.
struct ArrayFolder<'a> {
    folder: &'a Path,
    arrays: &'a mut Vec<String>,
}

impl ArrayFolder<'_> {
    fn write<T: raypencil_files::ArrayNumber>(
        &mut self,
        name: &str,
        shape: &[u64],
        numbers: &[T],
    ) -> Result<(), FileError> {
        let file = format!("{name}.npy");
        write_npy_numbers(self.folder.join(&file), shape, numbers)?;
        self.arrays.push(file);
        Ok(())
    }
}
