//! The points that are hit, as point clouds: PLY and PCD.

use std::path::Path;

use glam::DVec3;
use raypencil_files::{FileError, write_atomically};
use raypencil_scene::pattern::Mounting;
use raypencil_scene::{NamedRaySet, Pose, Reading};

use crate::answers::{Answers, FirstHit};

/// Stands for "no face" in a PCD file, whose fields of whole numbers have no NaN.
const NO_FACE: u32 = u32::MAX;

/// Writes one point for each hit, in the order of the rays: PLY, binary, little endian, with the properties x, y, z
/// (double), `face` (uint) and `cos_incidence` (double). (G. Turk, "The PLY polygon file format", 1994)
///
/// # Errors
/// The file cannot be written; the message names it.
pub fn write_ply(path: impl AsRef<Path>, answers: &Answers) -> Result<(), FileError> {
    write_atomically(path, |file| {
        write!(
            file,
            "ply\nformat binary_little_endian 1.0\ncomment raypencil cast, frame of the mesh\nelement vertex {}\n\
             property double x\nproperty double y\nproperty double z\nproperty uint face\n\
             property double cos_incidence\nend_header\n",
            answers.counts().0
        )?;
        for hit in answers.hits() {
            for value in hit.point.to_array() {
                file.write_all(&value.to_le_bytes())?;
            }
            file.write_all(&hit.face.0.to_le_bytes())?;
            file.write_all(&hit.cos_incidence.to_le_bytes())?;
        }
        Ok(())
    })
}

/// The frame in which the points of a PCD file stand.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum CloudFrame {
    /// That of the mesh.
    #[default]
    Mesh,
    /// The sensor's own at the time at which each ray is fired: as its driver gives them, distorted by the sensor's motion.
    Sensor,
    /// The sensor's own at its first pose: without that distortion.
    SensorAtStart,
}

impl CloudFrame {
    /// The frames that differ for a sensor with this mounting.
    pub fn of(mounting: &Mounting) -> &'static [Self] {
        match mounting {
            here if *here == Mounting::HERE => &[Self::Mesh],
            Mounting::Fixed(_) => &[Self::Mesh, Self::Sensor],
            Mounting::Moving(_) => &[Self::Mesh, Self::Sensor, Self::SensorAtStart],
        }
    }

    /// Name of the file.
    pub fn file(self) -> &'static str {
        match self {
            Self::Mesh => "cloud.pcd",
            Self::Sensor => "cloud-sensor.pcd",
            Self::SensorAtStart => "cloud-start.pcd",
        }
    }

    /// All of them.
    pub const ALL: [Self; 3] = [Self::Mesh, Self::Sensor, Self::SensorAtStart];

    /// The word of options.
    pub fn option(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Sensor => "sensor",
            Self::SensorAtStart => "start",
        }
    }

    /// The frame in words.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Mesh => "the mesh",
            Self::Sensor => "the sensor, at the time of each ray",
            Self::SensorAtStart => "the sensor, at its first pose",
        }
    }
}

/// Writes one point for each ray: PCD 0.7, binary, organised. Where nothing is hit x, y, z, `intensity` and `range` are NaN, and
/// `face` is 4294967295. What is too near is no point either: `range` is -Inf. (Point Cloud Library, "The PCD (Point Cloud Data)
/// file format"; REP-117)
///
/// The width is the last dimension of the set's shape, the height the product of the others, so that points are in the
/// order of the rays. Fields, of which the first six have the names and types of the ROS driver of Velodyne:
///
/// | field | type | content |
/// | --- | --- | --- |
/// | x, y, z | float32 | the point, in the mesh's unit |
/// | `intensity` | float32 | cos(psi) / R^2: the light of a small spot on a diffuse surface, relative, without air |
/// | `ring` | uint16 | rank of the channel by its elevation, the lowest is 0; without elevations the channel |
/// | `time` | float32 | seconds after the first ray of the set |
/// | `timestamp` | float64 | seconds, as the set has them; 0 for sets without times |
/// | `channel` | uint16 | index in the second dimension, in the order of the manual; 0 without one |
/// | `range` | float32 | distance from the ray's origin |
/// | `face` | uint32 | the face |
///
/// VIEWPOINT has the pose of the sensor in the mesh's frame, its first one, if the points are in the sensor's frame: viewers that
/// apply it show the cloud in its place. For points in the mesh's frame it is the identity.
///
/// # Errors
/// The file cannot be written; the message names it.
pub fn write_pcd(
    path: impl AsRef<Path>,
    answers: &Answers,
    set: &NamedRaySet,
    frame: CloudFrame,
) -> Result<(), FileError> {
    let count = answers.first.len() as u64;
    let width = set.shape.last().copied().unwrap_or(1);
    let height = count.checked_div(width).unwrap_or(0);
    let rings = rings(set);
    // Number of rays with the same index in the second dimension, one after the other.
    let of_channel: u64 = set.shape.iter().skip(2).product();
    let channel_of = |index: u64| match set.shape.get(1) {
        Some(&channels) => index / of_channel % channels,
        None => 0,
    };
    let word = |number: u64| u16::try_from(number).unwrap_or(u16::MAX);
    let time_of = |index: usize| set.times.as_ref().map_or(0.0, |times| times[index]);
    let first_time = set.times.iter().flatten().copied().reduce(f64::min).unwrap_or(0.0);
    let start = set.mounting.first();
    let placed = |index: usize, point: DVec3| match frame {
        CloudFrame::Mesh => point,
        CloudFrame::Sensor => set.mounting.at(time_of(index)).unwrap_or(start).inverse() * point,
        CloudFrame::SensorAtStart => start.inverse() * point,
    };
    let Pose { position, rotation } = match frame {
        CloudFrame::Mesh => Pose::IDENTITY,
        CloudFrame::Sensor | CloudFrame::SensorAtStart => start,
    };
    let rotation = rotation.normalize();
    let ([x, y, z], [qx, qy, qz, qw]) = (position.to_array(), rotation.to_array());
    write_atomically(path, |file| {
        write!(
            file,
            "# .PCD v0.7 - Point Cloud Data file format\n# raypencil cast, frame of {}\nVERSION 0.7\n\
             FIELDS x y z intensity ring time timestamp channel range face\n\
             SIZE 4 4 4 4 2 4 8 2 4 4\nTYPE F F F F U F F U F U\nCOUNT 1 1 1 1 1 1 1 1 1 1\n\
             WIDTH {width}\nHEIGHT {height}\nVIEWPOINT {x} {y} {z} {qw} {qx} {qy} {qz}\nPOINTS {count}\nDATA binary\n",
            frame.words()
        )?;
        for (index, read) in answers.first.iter().enumerate() {
            let (point, intensity, range, face) = match read {
                Reading::Hit(hit) => {
                    let intensity = intensity(hit);
                    (placed(index, hit.point), intensity, hit.range, hit.face.0)
                }
                Reading::TooNear => (DVec3::NAN, f64::NAN, f64::NEG_INFINITY, NO_FACE),
                Reading::Miss => (DVec3::NAN, f64::NAN, f64::NAN, NO_FACE),
            };
            for value in [point.x, point.y, point.z, intensity] {
                file.write_all(&(value as f32).to_le_bytes())?;
            }
            let channel = channel_of(index as u64);
            file.write_all(
                &word(rings.as_ref().map_or(channel, |rings| rings[channel as usize])).to_le_bytes(),
            )?;
            let time = time_of(index);
            file.write_all(&((time - first_time) as f32).to_le_bytes())?;
            file.write_all(&time.to_le_bytes())?;
            file.write_all(&word(channel).to_le_bytes())?;
            file.write_all(&(range as f32).to_le_bytes())?;
            file.write_all(&face.to_le_bytes())?;
        }
        Ok(())
    })
}

pub(crate) fn rings(set: &NamedRaySet) -> Option<Vec<u64>> {
    Some(ranks(set.elevations_deg.as_ref()?))
}

/// The light of a small spot on a diffuse surface: cos(psi) / R^2, relative, without air.
pub(crate) fn intensity(hit: &FirstHit) -> f64 {
    hit.cos_incidence.abs() / (hit.range * hit.range)
}

/// The rank of each channel by its elevation, from below; of equal ones the first is lower.
pub(crate) fn ranks(elevations: &[f64]) -> Vec<u64> {
    let mut order: Vec<usize> = (0..elevations.len()).collect();
    order.sort_by(|a, b| elevations[*a].total_cmp(&elevations[*b]));
    let mut rings = vec![0; order.len()];
    (0..).zip(order).for_each(|(rank, channel)| rings[channel] = rank);
    rings
}
