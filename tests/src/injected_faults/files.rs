//! Faults of writing: correct maps, corrupted on their way to a file by common mistakes.

use std::path::Path;

use raypencil::harness::write_maps;
use raypencil::io::{ExrMap, Limits, Raster, SceneIoError, Subject, read_exr, scene_sha256, write_exr};
use raypencil::judge::{Check, Class, GroundTruth, Item, Recorded, RecordingError, check};
use raypencil::tracer::Tracer;
use raypencil::{Image, Place, Precision, Renderer, Request, Sampling, Scene, Silent};

/// A mistake in writing a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FileFault {
    /// Row 0 is the bottom row in every channel.
    RowsBottomUp,
    /// The range channel holds depths.
    DepthAsRange,
    /// Face indices start at 1.
    FacesFromOne,
    /// Every real number was rounded to half precision.
    ThroughHalf,
    /// A miss has the range -1.
    MinusOneForNoHit,
    /// Points are in the axes of glTF: y is up.
    PointsOfGltf,
    /// Normals are stored as colours from 0 to 1.
    NormalsAsColours,
}

/// Why a corrupted recording was rejected.
#[derive(Debug)]
pub enum FileRejection {
    /// The recording breaks the conventions of files: the reader refuses it.
    Refused(RecordingError),
    /// The check found a defect: the first wrong ray, the quantity with the largest error, and the number of rays
    /// compared up to it.
    Wrong(Place, Item, u64),
}

impl FileFault {
    /// All faults of files.
    pub const ALL: [Self; 7] = [
        Self::RowsBottomUp,
        Self::DepthAsRange,
        Self::FacesFromOne,
        Self::ThroughHalf,
        Self::MinusOneForNoHit,
        Self::PointsOfGltf,
        Self::NormalsAsColours,
    ];

    /// The real mistake that the fault imitates.
    pub fn imitates(self) -> &'static str {
        match self {
            Self::RowsBottomUp => "the row order of PFM and OpenGL, written unchanged",
            Self::DepthAsRange => "a z buffer exported as a range",
            Self::FacesFromOne => "face indices that start at 1, as in OBJ files",
            Self::ThroughHalf => "the default pixel type of an image writer",
            Self::MinusOneForNoHit => "the -1 that depth cameras report for no return",
            Self::PointsOfGltf => "points exported with a mesh, in the axes of its file",
            Self::NormalsAsColours => "a normal pass for display, n/2 + 1/2",
        }
    }

    /// Corrupts the map of one sensor.
    fn corrupt(self, map: &mut ExrMap) {
        match self {
            Self::RowsBottomUp => {
                for raster in map.channels.values_mut() {
                    match raster {
                        Raster::F32(image) => *image = flipped(image),
                        Raster::U32(image) => *image = flipped(image),
                    }
                }
            }
            Self::DepthAsRange => {
                let depth = map.channels["depth.Z"].clone();
                map.insert("range.T", depth);
            }
            Self::FacesFromOne => {
                if let Some(Raster::U32(faces)) = map.channels.get_mut("face.I") {
                    let hit = faces.cells_mut().iter_mut().filter(|face| **face != u32::MAX);
                    hit.for_each(|face| *face += 1);
                }
            }
            Self::ThroughHalf => {
                for raster in map.channels.values_mut() {
                    if let Raster::F32(image) = raster {
                        image.cells_mut().iter_mut().for_each(|x| *x = through_half(*x));
                    }
                }
            }
            Self::MinusOneForNoHit => {
                for name in ["range.T", "depth.Z"] {
                    let missed = reals(map, name).iter_mut().filter(|range| !range.is_finite());
                    missed.for_each(|range| *range = -1.0);
                }
            }
            Self::PointsOfGltf => {
                // Scene (x, y, z) is (x, z, -y).
                let (y, z) = (reals(map, "P.Y").to_vec(), reals(map, "P.Z").to_vec());
                reals(map, "P.Y").copy_from_slice(&z);
                reals(map, "P.Z").iter_mut().zip(y).for_each(|(z, y)| *z = -y);
            }
            Self::NormalsAsColours => {
                for name in ["N.X", "N.Y", "N.Z"] {
                    reals(map, name).iter_mut().for_each(|x| *x = 0.5 * *x + 0.5);
                }
            }
        }
    }
}

/// The cells of a channel of real numbers.
fn reals<'m>(map: &'m mut ExrMap, name: &str) -> &'m mut [f32] {
    match map.channels.get_mut(name) {
        Some(Raster::F32(image)) => image.cells_mut(),
        _ => panic!("{name}: expected a channel of real numbers"),
    }
}

/// The rows in reverse order.
fn flipped<T: Copy>(image: &Image<T>) -> Image<T> {
    let rows = image.cells().chunks_exact(image.width() as usize).rev();
    Image::from_cells(image.width(), image.height(), rows.flatten().copied().collect())
}

/// Rounds to IEEE 754 binary16: 11 significant binary digits and multiples of 2^-24, ties to even.
fn through_half(x: f32) -> f32 {
    if !x.is_finite() || x == 0.0 {
        return x;
    }
    let unit = libm::ldexp(1.0, (libm::ilogb(f64::from(x)) - 10).max(-24));
    ((f64::from(x) / unit).round_ties_even() * unit) as f32
}

/// Writes the tracer's maps of a scene to a folder, with a fault or without.
///
/// # Errors
/// If a file cannot be written or read.
pub fn write(scene: &Scene, fault: Option<FileFault>, folder: &Path) -> Result<(), SceneIoError> {
    let output = Tracer::new().render(scene, &Request::EVERYTHING);
    let subject = Subject {
        scene: scene.clone(),
        name: "injected".into(),
        arguments: "injected".into(),
        vehicle: None,
        file_facts: Default::default(),
        sha256: scene_sha256(scene),
    };
    let files =
        write_maps(&output, "tracer", &subject, Sampling::Centres, folder).expect("a folder to write to");
    for file in files {
        let mut map = read_exr(&file, &Limits::default())?;
        if let Some(fault) = fault {
            fault.corrupt(&mut map);
        }
        write_exr(&file, &map)?;
    }
    Ok(())
}

/// Writes a recording with a fault or without, reads it and checks it. `None` if it passes.
///
/// # Panics
/// If there is no folder to write to.
pub fn check_files(scene: &Scene, fault: Option<FileFault>) -> Option<FileRejection> {
    let folder = tempfile::tempdir().expect("a folder");
    write(scene, fault, folder.path()).expect("files");
    let recorded = match Recorded::read(folder.path(), scene, Precision::F64) {
        Ok(recorded) => recorded,
        Err(refusal) => return Some(FileRejection::Refused(refusal)),
    };
    let found = check(&GroundTruth::certified(scene, &Silent), &recorded, &Silent);
    assert_eq!(found.passes(), found.of(Class::Defect) == 0, "the check leaves nothing undecided");
    first_wrong(scene, &found)
}

/// The first wrong ray in the order of a check: the beams, then the camera.
fn first_wrong(scene: &Scene, found: &Check) -> Option<FileRejection> {
    let mut before = 0;
    for sensor in found.sensors[1..].iter().chain(&found.sensors[..1]) {
        let (width, height) = scene.size(sensor.sensor).expect("a sensor of this scene");
        if let Some(wrong) = sensor.defects.first() {
            let Place { i, j, .. } = wrong.place;
            let compared = before + u64::from(j) * u64::from(width) + u64::from(i) + 1;
            return Some(FileRejection::Wrong(wrong.place, wrong.item, compared));
        }
        before += u64::from(width) * u64::from(height);
    }
    None
}
