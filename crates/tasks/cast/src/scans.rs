//! A spinning head's scans one after the other: the rays of each are answered and written, and then forgotten.

use std::ops::Range;
use std::path::{Path, PathBuf};

use raypencil_files::{FileError, FolderError, begin_output_folder, create_dir_all, write_atomically};
use raypencil_mesh_io::FileUnits;
use raypencil_referee::ExactCast;
use raypencil_report::{VERSION, counted};
use raypencil_scene::pattern::Mounting;
use raypencil_scene::{HeadSweep, NamedRaySet, Progress, RaySet, SceneError, Sides, Silent, Triangles};
use serde_json::json;

use crate::answers::{Questions, cast_with};
use crate::bag::{BagForm, ScanBag};
use crate::cloud::{CloudFrame, write_pcd};
use crate::pcd_data::PcdData;
use crate::returns::BeamReturns;
use crate::write::CastSource;

/// What became of all scans.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ScansWritten {
    /// Number of scans.
    pub scans: usize,
    /// Rays of all of them.
    pub rays: usize,
    /// Rays that hit.
    pub hits: usize,
    /// Rays whose nearest hit is too near for the sensor.
    pub too_near: usize,
    /// `summary.json`.
    pub summary: PathBuf,
}

/// Answers a spinning head's set in scans of so many firing sequences, and writes each before the next one begins: only the rays
/// and the answers of one are in memory, and of a set whose rays are made before the rays of all.
///
/// | file | content |
/// | --- | --- |
/// | `scans/000000.pcd`, ... | a cloud for each scan, as [`write_pcd`] writes it, in the sensor's frame at the time of each ray |
/// | `scans.csv` | for each scan its file, the times of its first and last ray, its rays, and those that hit |
/// | `rosbag/` | with a form: a bag with a `PointCloud2` for each scan |
/// | `summary.json` | the sums; written last |
///
/// The last scan has what is left.
///
/// # Errors
/// A file that cannot be written. A set that has no firing sequences, or of which a scan's rays are none.
pub fn write_scans(
    folder: &Path,
    (mesh, set, sides): (&Triangles, SetOfScans<'_>, Sides),
    sequences: u64,
    (form, pcd): (Option<BagForm>, PcdData),
    source: &CastSource,
    progress: &dyn Progress,
) -> Result<ScansWritten, FolderError> {
    let summary = begin_output_folder(folder, "summary.json")?;
    let of_scene = |source| FileError::Scene { origin: set.name().to_string(), source };
    let ranges = scan_ranges(set, sequences).map_err(of_scene)?;
    let folder_of_scans = folder.join("scans");
    create_dir_all(&folder_of_scans).map_err(|error| FileError::io(&folder_of_scans, "create", error))?;
    let frame = match CloudFrame::of(set.mounting()) {
        [only] => *only,
        _ => CloudFrame::Sensor,
    };
    let folder_of_bag = folder.join("rosbag");
    let first_s = set.part(0..1).map_err(of_scene)?.times.into_iter().flatten().reduce(f64::min);
    let of_bag = (first_s.unwrap_or(0.0), set.mounting());
    let mut bag =
        form.map(|form| ScanBag::create(&folder_of_bag, of_bag, form, source.origin)).transpose()?;
    let map = source.map();
    progress.stage(&format!("building a tree of {}", counted(mesh.faces().len() as u64, "face", "faces")));
    let exact = ExactCast::new(mesh);
    let mut written = ScansWritten { scans: ranges.len(), rays: set.rays(), ..ScansWritten::default() };
    let mut rows = String::from("file,first_s,last_s,rays,hits,too_near\n");
    for (index, range) in ranges.iter().enumerate() {
        let scan = set.part(range.clone()).map_err(of_scene)?;
        let answers = cast_with(&exact, scan.set.rays(), sides, Questions::default(), &Silent);
        progress.stage(&format!("scan {} of {}", index + 1, ranges.len()));
        let name = format!("scans/{index:06}.pcd");
        let returns = BeamReturns::of(&answers, &scan);
        write_pcd(folder.join(&name), &answers, (&scan, returns.as_ref()), (frame, pcd), &map)?;
        if let Some(bag) = &mut bag {
            bag.add(&answers, &scan)?;
        }
        let times = || scan.times.iter().flatten().copied();
        let [first, last] =
            [times().reduce(f64::min), times().reduce(f64::max)].map(|time| time.unwrap_or(0.0));
        let (hits, too_near) = (answers.counts().0, answers.too_near());
        rows += &format!("{name},{first},{last},{},{hits},{too_near}\n", scan.set.rays().len());
        written.hits += hits;
        written.too_near += too_near;
    }
    if let Some(bag) = bag {
        bag.finish()?;
    }
    write_atomically(folder.join("scans.csv"), |file| file.write_all(rows.as_bytes()))?;
    let document = json!({
        "format": 1,
        "kind": "scans",
        "raypencilVersion": VERSION,
        "mesh": {
            "file": source.mesh,
            "sha256": source.mesh_sha256,
            "faces": mesh.faces().len(),
            "originM": source.origin,
            "units": source.facts.units.as_ref().map(FileUnits::to_json),
        },
        "rays": { "file": source.rays, "sha256": source.rays_sha256, "name": set.name(), "count": written.rays },
        "sides": if sides == Sides::Both { "both" } else { "fronts" },
        "scans": { "count": written.scans, "sequences": sequences, "frame": frame.option() },
        "counts": {
            "hits": written.hits,
            "tooNear": written.too_near,
            "misses": written.rays - written.hits - written.too_near,
        },
    });
    write_atomically(&summary, |file| file.write_all(format!("{document:#}\n").as_bytes()))?;
    Ok(ScansWritten { summary, ..written })
}

/// The set of a spinning head of which scans are parts.
#[derive(Debug, Clone, Copy)]
pub enum SetOfScans<'a> {
    /// All its rays are there.
    Made(&'a NamedRaySet),
    /// The rays of each scan are made when it is its turn.
    Sweep(&'a HeadSweep),
}

impl<'a> SetOfScans<'a> {
    /// Its name.
    pub fn name(&self) -> &'a str {
        match self {
            Self::Made(set) => &set.name,
            Self::Sweep(sweep) => &sweep.name,
        }
    }

    /// Number of all rays.
    pub fn rays(&self) -> usize {
        match self {
            Self::Made(set) => set.set.rays().len(),
            Self::Sweep(sweep) => sweep.rays() as usize,
        }
    }

    /// The sides of faces that it hits.
    pub fn sides(&self) -> Sides {
        match self {
            Self::Made(set) => set.set.sides(),
            Self::Sweep(sweep) => sweep.sides,
        }
    }

    /// Rays that are in memory at a time, if a scan has so many firing sequences: those of all, or of a scan.
    pub fn rays_at_a_time(&self, sequences: u64) -> usize {
        match self {
            Self::Made(set) => set.set.rays().len(),
            Self::Sweep(sweep) => {
                let of_sequence = sweep.rays() / sweep.head.steps.max(1);
                sequences.min(sweep.head.steps).saturating_mul(of_sequence) as usize
            }
        }
    }

    fn mounting(&self) -> &'a Mounting {
        match self {
            Self::Made(set) => &set.mounting,
            Self::Sweep(sweep) => &sweep.mounting,
        }
    }

    /// Number of firing sequences.
    fn sequences(&self) -> Result<u64, SceneError> {
        let of_set = match self {
            Self::Made(set) => set.shape.first().filter(|_| set.elevations_deg.is_some()).copied(),
            Self::Sweep(sweep) => Some(sweep.head.steps),
        };
        of_set
            .ok_or_else(|| SceneError::new(self.name(), "no firing sequences", "a spinning head, for scans"))
    }

    /// The part of the set that some firing sequences are.
    fn part(&self, sequences: Range<u64>) -> Result<NamedRaySet, SceneError> {
        match self {
            Self::Made(set) => scan_of(set, sequences),
            Self::Sweep(sweep) => sweep.part(sequences, &sweep.name),
        }
    }
}

/// The firing sequences of each scan.
fn scan_ranges(set: SetOfScans<'_>, sequences: u64) -> Result<Vec<Range<u64>>, SceneError> {
    let all = set.sequences()?;
    if sequences == 0 {
        return Err(SceneError::new("scans", "0 firing sequences", "at least 1"));
    }
    Ok((0..all.div_ceil(sequences)).map(|scan| scan * sequences..((scan + 1) * sequences).min(all)).collect())
}

/// The part of a set that some firing sequences are.
fn scan_of(set: &NamedRaySet, sequences: Range<u64>) -> Result<NamedRaySet, SceneError> {
    let each: u64 = set.shape[1..].iter().product();
    let rays = (sequences.start * each) as usize..(sequences.end * each) as usize;
    let mut shape = set.shape.clone();
    shape[0] = sequences.end - sequences.start;
    Ok(NamedRaySet {
        name: set.name.clone(),
        shape,
        set: RaySet::new(set.set.rays()[rays.clone()].to_vec(), set.set.sides())?,
        times: set.times.as_ref().map(|times| times[rays].to_vec()),
        weights: set.weights.clone(),
        returns: set.returns,
        elevations_deg: set.elevations_deg.clone(),
        mounting: set.mounting.clone(),
        echo: set.echo,
    })
}

#[cfg(test)]
#[path = "../tests/unit/scans.rs"]
mod tests;
