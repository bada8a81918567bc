//! What a pack of a sensor's scan knows of its rays beyond the rays: times, channels, and where the sensor stands.

use std::path::Path;

use glam::{DQuat, DVec3};
use raypencil_files::{Fault, FileError, Limits, read_npy_numbers, write_npy_numbers};
use raypencil_scene::pattern::{EchoLight, Mounting, Returns, TimedPose, TimedPoses};
use raypencil_scene::{CastRay, NamedRaySet, Pose};

use crate::layout::PageScan;

/// Numbers of a pose in its file: time, position, quaternion with the scalar last.
const POSE_NUMBERS: u64 = 8;

/// A sensor's scan, beside its rays.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scan {
    /// Time at which each ray is fired, seconds, if there are times.
    pub(super) times: Option<Vec<f64>>,
    /// Elevations of the channels of a spinning head along the second dimension, degrees.
    pub(super) elevations_deg: Option<Vec<f64>>,
    /// Where the sensor stands in the mesh's frame.
    pub(super) mounting: Mounting,
    /// Its poses at the first and at the last ray.
    pub(super) ends: [Pose; 2],
    /// Which returns of a beam are told, if rays are parts of beams; `None`: rays stand for themselves.
    pub(super) returns: Option<ScanReturns>,
}

/// The returns of beams with a width.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ScanReturns {
    /// Which of them are told.
    pub(super) wanted: Returns,
    /// Shares of a beam's power along the last dimension.
    pub(super) weights: Vec<f64>,
    /// What surfaces and air leave of the light, which decides what is strongest.
    pub(super) echo: EchoLight,
}

impl Scan {
    pub(super) fn of(set: &NamedRaySet) -> Self {
        Self {
            times: set.times.clone(),
            elevations_deg: set.elevations_deg.clone(),
            mounting: set.mounting.clone(),
            ends: set.mounting.ends(set.times.as_deref()),
            returns: set.returns.zip(set.weights.clone()).map(|(wanted, weights)| ScanReturns {
                wanted,
                weights,
                echo: set.echo,
            }),
        }
    }

    /// The word for the mounting in `raypack.json`.
    pub(super) fn mounting_word(&self) -> &'static str {
        match self.mounting {
            Mounting::Fixed(_) => "fixed",
            Mounting::Moving(_) => "moving",
        }
    }

    /// Writes `time.npy`, `elevation.npy` and `weight.npy`, if there are any, and `pose.npy` (poses, 8). Returns their names.
    pub(super) fn write(&self, folder: &Path, shape: &[u64]) -> Result<Vec<String>, FileError> {
        let mut names = Vec::new();
        let mut write = |name: &str, shape: &[u64], values: &[f64]| {
            names.push(name.to_string());
            write_npy_numbers(folder.join(name), shape, values)
        };
        if let Some(times) = &self.times {
            write("time.npy", shape, times)?;
        }
        if let Some(elevations) = &self.elevations_deg {
            write("elevation.npy", &[elevations.len() as u64], elevations)?;
        }
        if let Some(returns) = &self.returns {
            write("weight.npy", &[returns.weights.len() as u64], &returns.weights)?;
        }
        let row = |time_s: f64, pose: &Pose| {
            let ([x, y, z], [qx, qy, qz, qw]) = (pose.position.to_array(), pose.rotation.to_array());
            [time_s, x, y, z, qx, qy, qz, qw]
        };
        let rows: Vec<[f64; 8]> = match &self.mounting {
            // One that stands still has no time.
            Mounting::Fixed(pose) => vec![row(0.0, pose)],
            Mounting::Moving(poses) => poses.poses().iter().map(|one| row(one.time_s, &one.pose)).collect(),
        };
        write("pose.npy", &[rows.len() as u64, POSE_NUMBERS], rows.as_flattened())?;
        Ok(names)
    }

    /// Reads what [`Scan::write`] wrote. `listed` says whether the pack lists a file.
    pub(super) fn read(
        folder: &Path,
        shape: &[u64],
        (mounting, wanted): (&str, Option<(Returns, EchoLight)>),
        listed: impl Fn(&str) -> bool,
    ) -> Result<Self, FileError> {
        let fault = |name: &str, place: &str, found: String, expected: String| {
            FileError::Array(Fault::new(place, found, expected).in_file(&folder.join(name)))
        };
        let numbers = |name: &str, expected: &[u64]| {
            if !listed(name) {
                return Ok(None);
            }
            let array = read_npy_numbers(folder.join(name), &Limits::default())?;
            if array.shape != expected {
                return Err(fault(name, "shape", format!("{:?}", array.shape), format!("{expected:?}")));
            }
            match array.values.iter().position(|value| !value.is_finite()) {
                Some(cell) => {
                    let place = format!("cell {cell}");
                    Err(fault(name, &place, array.values[cell].to_string(), "a finite number".into()))
                }
                None => Ok(Some(array.values)),
            }
        };
        let times = numbers("time.npy", shape)?;
        let channels = shape.get(1).copied().unwrap_or(0);
        let elevations_deg = numbers("elevation.npy", &[channels])?;
        let returns = match wanted {
            None => None,
            Some((wanted, echo)) => {
                let rays_of_beam = shape.last().copied().unwrap_or(1);
                let weights = numbers("weight.npy", &[rays_of_beam])?;
                let scene = |source| FileError::Scene {
                    origin: folder.join("raypack.json").display().to_string(),
                    source,
                };
                wanted.validate("returns").map_err(scene)?;
                echo.validate("light").map_err(scene)?;
                weights.map(|weights| ScanReturns { wanted, weights, echo })
            }
        };
        let array = read_npy_numbers(folder.join("pose.npy"), &Limits::default())?;
        let count = match array.shape[..] {
            [count, POSE_NUMBERS] if count > 0 => count,
            _ => return Err(fault("pose.npy", "shape", format!("{:?}", array.shape), "(poses, 8)".into())),
        };
        let poses: Vec<TimedPose> = array.values.chunks_exact(8).map(pose).collect();
        let scene =
            |source| FileError::Scene { origin: folder.join("pose.npy").display().to_string(), source };
        let mounting = match (mounting, count) {
            ("fixed", 1) => {
                poses[0].pose.validate("pose").map_err(scene)?;
                Mounting::Fixed(poses[0].pose)
            }
            ("moving", _) => {
                let poses = TimedPoses::new(poses, "poses").map_err(scene)?;
                let [first, last] = poses.span_s();
                // Else a ray would have no pose.
                let outside = times.iter().flatten().find(|&&time| time < first || time > last);
                if let Some(time) = outside {
                    return Err(fault(
                        "time.npy",
                        "times",
                        format!("{time} s"),
                        format!("{first} to {last} s"),
                    ));
                }
                Mounting::Moving(poses)
            }
            (word, count) => {
                let found = format!("{count} poses of a mounting that is {word:?}");
                return Err(fault(
                    "pose.npy",
                    "shape",
                    found,
                    "one that is fixed, or some of one that is moving".into(),
                ));
            }
        };
        let ends = mounting.ends(times.as_deref());
        Ok(Self { times, elevations_deg, mounting, ends, returns })
    }

    /// What a page shows of it.
    pub(super) fn on_page<'a>(&'a self, name: &'a str) -> PageScan<'a> {
        PageScan {
            name,
            times: self.times.as_deref(),
            elevations_deg: self.elevations_deg.as_deref(),
            mounting: &self.mounting,
        }
    }

    /// The time of a ray; 0 without times.
    pub(super) fn time(&self, index: usize) -> f64 {
        self.times.as_ref().map_or(0.0, |times| times[index])
    }

    /// The sensor's pose when it fires a ray.
    pub(super) fn pose(&self, index: usize) -> Pose {
        self.mounting.at(self.time(index)).unwrap_or_else(|| self.mounting.first())
    }

    /// A ray of the pack in the pattern's frame.
    pub(super) fn in_pattern(&self, index: usize, ray: &CastRay) -> CastRay {
        moved(&self.pose(index).inverse(), ray)
    }

    /// Whether the sensor moves.
    pub(super) fn is_moving(&self) -> bool {
        matches!(self.mounting, Mounting::Moving(_))
    }
}

/// A ray moved with a frame.
pub(super) fn moved(pose: &Pose, ray: &CastRay) -> CastRay {
    CastRay { origin: *pose * ray.origin, direction: pose.rotate(ray.direction), ..*ray }
}

fn pose(row: &[f64]) -> TimedPose {
    TimedPose {
        time_s: row[0],
        pose: Pose {
            position: DVec3::from_slice(&row[1..4]),
            rotation: DQuat::from_xyzw(row[4], row[5], row[6], row[7]),
        },
    }
}
