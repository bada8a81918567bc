//! Writes a pack of rays.

use std::path::Path;

use rayon::prelude::*;
use raypencil_files::{
    FileError, FolderError, RayArray, begin_output_folder, file_sha256_hex, ray_rows, write_atomically,
    write_npy_numbers,
};
use raypencil_referee::ExactCast;
use raypencil_report::VERSION;
use raypencil_scene::pattern::EchoLight;
use raypencil_scene::{CastRay, FaceId, NamedRaySet, Progress, Reading, Side, Sides, Triangles};
use serde_json::{Map, json};

use super::scan::{Scan, ScanReturns};
use super::{PACK_FORMAT, PACK_NAME};
use crate::answers::{FirstHit, Questions, cast};
use crate::returns::{BeamReturns, echo_json, keep_json};
use crate::write::{CastSource, write_answers, write_beam_returns};

/// How many rays of a pack test what. A program that gets it wrong passes a pack whose number is 0.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RayPackCounts {
    /// All rays.
    pub rays: u64,
    /// Rays that hit.
    pub hits: u64,
    /// Rays of a sensor that has a shortest range.
    pub blind: u64,
    /// Rays whose nearest hit is too near for their sensor: they answer otherwise if its shortest range is ignored.
    pub too_near: u64,
    /// Rays that hit nothing.
    pub misses: u64,
    /// Rays on which several faces are nearest.
    pub ties: u64,
    /// Rays that answer otherwise if the other rule for backs is followed.
    pub backs: u64,
    /// Rays that answer otherwise if `t_min` is ignored.
    pub t_min: u64,
    /// Rays that answer otherwise if `t_max` is ignored.
    pub t_max: u64,
    /// Rays whose t is not their range, for their direction is not 1 long.
    pub lengths: u64,
}

impl RayPackCounts {
    /// Number of counts.
    pub(super) const KEYS: usize = 9;
    /// Number of those that follow from the first hits alone; they come first.
    pub(super) const KEYS_OF_FIRST: usize = 5;

    pub(super) fn of(exact: &ExactCast<'_>, rays: &[CastRay], sides: Sides) -> Self {
        let other = if sides == Sides::Both { Sides::Fronts } else { Sides::Both };
        let count = |ray: &CastRay| {
            let read = exact.reading(ray, sides);
            let differs = |ray: CastRay, sides| u64::from(exact.reading(&ray, sides) != read);
            let first: &[FaceId] = read.hit().map_or(&[], |faces| faces);
            let hit = first.first().and_then(|face| exact.meeting(ray, *face));
            Self {
                rays: 1,
                hits: u64::from(hit.is_some()),
                blind: u64::from(ray.t_blind > 0.0),
                too_near: u64::from(read == Reading::TooNear),
                misses: u64::from(read == Reading::Miss),
                ties: u64::from(first.len() > 1),
                backs: match (sides, &hit) {
                    // A program that hits fronts only is told apart by its first hit on a back.
                    (Sides::Both, Some(hit)) => u64::from(hit.side() == Side::Back),
                    _ => differs(*ray, other),
                },
                t_min: differs(CastRay { t_min: 0.0, ..*ray }, sides),
                t_max: differs(CastRay { t_max: f64::INFINITY, ..*ray }, sides),
                lengths: u64::from(hit.is_some_and(|hit| hit.t().double != hit.range().double)),
            }
        };
        rays.par_iter().map(count).reduce(Self::default, |a, b| Self {
            rays: a.rays + b.rays,
            hits: a.hits + b.hits,
            blind: a.blind + b.blind,
            too_near: a.too_near + b.too_near,
            misses: a.misses + b.misses,
            ties: a.ties + b.ties,
            backs: a.backs + b.backs,
            t_min: a.t_min + b.t_min,
            t_max: a.t_max + b.t_max,
            lengths: a.lengths + b.lengths,
        })
    }

    /// The counts by their keys in `raypack.json`, those first that follow from the first hits alone.
    pub(super) fn by_key(&self) -> [(&'static str, u64); Self::KEYS] {
        [
            ("rays", self.rays),
            ("hits", self.hits),
            ("tooNear", self.too_near),
            ("misses", self.misses),
            ("ties", self.ties),
            ("backs", self.backs),
            ("tMin", self.t_min),
            ("tMax", self.t_max),
            ("lengths", self.lengths),
        ]
    }

    /// What follows from the first hits: of rays, hits, what is too near, misses and ties; the rest is 0.
    pub(super) fn of_first(first: &[Reading<FirstHit>]) -> Self {
        let mut counts = Self { rays: first.len() as u64, ..Self::default() };
        for reading in first {
            match reading {
                Reading::Hit(hit) => {
                    counts.hits += 1;
                    counts.ties += u64::from(hit.ties > 1);
                }
                Reading::TooNear => counts.too_near += 1,
                Reading::Miss => counts.misses += 1,
            }
        }
        counts
    }

    /// What the rays of the pack do not test, in words.
    pub fn untested(&self) -> Vec<&'static str> {
        let tested = [
            (self.hits, "hits"),
            (self.misses, "misses"),
            (self.ties, "ties"),
            (self.backs, "backs of faces"),
            (self.t_min, "t_min"),
            (self.t_max, "t_max"),
            (self.lengths, "directions that are not 1 long"),
        ];
        // Only a sensor's shortest range asks for it.
        let of_sensors = [(self.too_near, "what is too near")].into_iter().filter(|_| self.blind > 0);
        tested.into_iter().chain(of_sensors).filter(|(count, _)| *count == 0).map(|(_, name)| name).collect()
    }
}

/// Writes a pack: `vertices.npy`, `faces.npy` and `rays.npy` (..., 8), or (..., 9) with `t_blind`, which say the question; every answer as `cast` writes
/// it, margins included; and last `raypack.json`, with the SHA-256 of each file.
///
/// # Errors
/// The folder or a file cannot be written; the message names it.
pub fn write_ray_pack(
    folder: &Path,
    (mesh, rays, sides): (&Triangles, &RayArray, Sides),
    source: &CastSource,
    progress: &dyn Progress,
) -> Result<RayPackCounts, FolderError> {
    write_pack_of(folder, (mesh, rays, sides), None, source, progress)
}

/// The same of a sensor's scan, to which point clouds can be held: beside the rays it has `time.npy` (the rays' shape, seconds), if
/// they have times, `elevation.npy` (channels, degrees) of a spinning head, and `pose.npy` (poses, 8) with the time, position and
/// quaternion, its scalar last, of the sensor in the mesh's frame. A set that asks for returns has `weight.npy` (rays of a beam) too, and the
/// returns, `return.*.npy`. `sides` may differ from those of the set.
///
/// # Errors
/// The folder or a file cannot be written; the message names it.
pub fn write_scan_pack(
    folder: &Path,
    (mesh, set, sides): (&Triangles, &NamedRaySet, Sides),
    source: &CastSource,
    progress: &dyn Progress,
) -> Result<RayPackCounts, FolderError> {
    let rays = RayArray { shape: set.shape.clone(), rays: set.set.rays().to_vec() };
    write_pack_of(folder, (mesh, &rays, sides), Some(&Scan::of(set)), source, progress)
}

fn write_pack_of(
    folder: &Path,
    (mesh, rays, sides): (&Triangles, &RayArray, Sides),
    scan: Option<&Scan>,
    source: &CastSource,
    progress: &dyn Progress,
) -> Result<RayPackCounts, FolderError> {
    let last = begin_output_folder(folder, PACK_NAME)?;
    let questions = Questions { any: true, all: true, margins: true };
    let answers = cast(mesh, &rays.rays, sides, questions, progress);
    write_answers(folder, &answers, (mesh, rays, sides), source)?;
    let returns = scan.and_then(|scan| scan.returns.as_ref());
    let told = returns.map(|ScanReturns { wanted, weights, echo }| {
        BeamReturns::of_first(&answers.first, *wanted, (weights, echo))
    });
    let of_returns =
        told.map_or_else(|| Ok(Vec::new()), |told| write_beam_returns(folder, &told, &rays.shape))?;
    let counts = RayPackCounts::of(&ExactCast::new(mesh), &rays.rays, sides);
    progress.stage("writing the mesh and the rays");
    let vertices: Vec<f64> = mesh.vertices().iter().flatten().copied().collect();
    let faces: Vec<u32> = mesh.faces().iter().flatten().copied().collect();
    let (width, numbers) = ray_rows(&rays.rays);
    let with_width: Vec<u64> = rays.shape.iter().copied().chain([width as u64]).collect();
    write_npy_numbers(folder.join("vertices.npy"), &[mesh.vertices().len() as u64, 3], &vertices)?;
    write_npy_numbers(folder.join("faces.npy"), &[mesh.faces().len() as u64, 3], &faces)?;
    write_npy_numbers(folder.join("rays.npy"), &with_width, &numbers)?;
    let mut names: Vec<String> = ["vertices", "faces", "rays"].map(|name| format!("{name}.npy")).into();
    if let Some(scan) = scan {
        names.extend(scan.write(folder, &rays.shape)?);
    }
    names.extend(answer_names());
    names.extend(of_returns);
    let files = names.iter().map(|name| {
        let path = folder.join(name);
        let (bytes, sha256) = file_sha256_hex(&path).map_err(|error| FileError::io(&path, "read", error))?;
        Ok(json!({ "path": name, "bytes": bytes, "sha256": sha256 }))
    });
    let files: Vec<serde_json::Value> = files.collect::<Result<_, FileError>>()?;
    let mut document = json!({
        "format": PACK_FORMAT,
        "kind": "rays",
        "raypencilVersion": VERSION,
        "sides": if sides == Sides::Both { "both" } else { "fronts" },
        "counts": counts.by_key().map(|(key, count)| (key.to_string(), json!(count))).into_iter().collect::<Map<_, _>>(),
        "files": files,
    });
    if let Some(scan) = scan {
        document["scan"] = json!({ "mounting": scan.mounting_word() });
    }
    if let Some(ScanReturns { wanted, echo, .. }) = returns {
        document["scan"]["returns"] =
            json!({ "keep": keep_json(wanted.keep), "separationM": wanted.separation_m });
        if *echo != EchoLight::default() {
            document["scan"]["light"] = echo_json(echo);
        }
    }
    write_atomically(&last, |file| file.write_all(format!("{document:#}\n").as_bytes()))?;
    Ok(counts)
}

/// The arrays of answers that every pack has.
fn answer_names() -> impl Iterator<Item = String> {
    let names = [
        "face",
        "side",
        "ties",
        "t",
        "range",
        "cos_incidence",
        "point",
        "normal",
        "barycentric",
        "any",
        "all.start",
        "all.face",
        "all.side",
        "all.t",
        "all.group",
        "all.crossing",
        "margin.face",
        "margin.surface",
        "across",
    ];
    names.into_iter().map(|name| format!("{name}.npy"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use raypencil_scene::Silent;

    #[test]
    fn counts_that_follow_from_first_hits_are_those_of_the_rays() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = Triangles::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("a square");
        let down = |(x, y, t_blind): (f64, f64, f64)| {
            let ray = CastRay::new(glam::DVec3::new(x, y, 1.0), -glam::DVec3::Z);
            CastRay { t_blind, ..ray }
        };
        // Three on the diagonal, which two faces share, two beside it, one that is too near, and two beside the square.
        let places =
            [(0.25, 0.25), (0.5, 0.5), (0.75, 0.75), (0.5, 0.25), (0.25, 0.5), (2.0, 0.0), (0.0, 2.0)];
        let mut rays: Vec<CastRay> = places.into_iter().map(|(x, y)| down((x, y, 0.0))).collect();
        rays.push(down((0.75, 0.5, 2.0)));
        let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
        let expected = [("rays", 8), ("hits", 5), ("tooNear", 1), ("misses", 2), ("ties", 3)];
        assert_eq!(
            RayPackCounts::of_first(&answers.first).by_key()[..RayPackCounts::KEYS_OF_FIRST],
            expected
        );
        let of_rays = RayPackCounts::of(&ExactCast::new(&mesh), &rays, Sides::Both);
        assert_eq!(of_rays.by_key()[..RayPackCounts::KEYS_OF_FIRST], expected);
    }
}
