//! The points that are hit, as point clouds: PLY and PCD.

use std::io::Write;
use std::path::Path;

use glam::DVec3;
use raypencil_files::{Fault, FileError, write_atomically};
use raypencil_referee::Margins;
use raypencil_scene::pattern::{EchoLight, Mounting};
use raypencil_scene::{NamedRaySet, Pose, Reading};

use crate::answers::{Answers, FirstHit};
use crate::pcd_data::PcdData;
use crate::returns::{BeamReturn, BeamReturns};

/// Stands for "no face" in a PCD file, whose fields of whole numbers have no NaN.
const NO_FACE: u32 = u32::MAX;

/// What a cloud has a place for: a ray, or a return of a beam with a width.
pub(crate) struct Spot<'a> {
    /// The ray; of a return its leading one, and where there is none the first of the footprint.
    pub(crate) ray: usize,
    /// What is read there.
    pub(crate) read: Reading<&'a FirstHit>,
    /// The light of it; NaN without a point.
    pub(crate) intensity: f64,
    /// What is told of a return.
    pub(crate) of_return: Option<SpotReturn>,
}

/// What a cloud tells of a return beside its point.
#[derive(Clone, Copy, Default)]
pub(crate) struct SpotReturn {
    /// Its number by range, the nearest is 1; 0 without a return.
    number: u16,
    /// All returns of the beam.
    returns: u16,
    /// Whether there are several.
    mixed: u8,
    /// Shares of the footprint's rays: of this return, of others, of those that hit nothing.
    pub(crate) shares: [f64; 3],
    /// Mean of the ranges; NaN without a return.
    pub(crate) mean_range: f64,
}

impl SpotReturn {
    /// What the clouds of drivers get beside their own fields: `share`, `share_other`, `share_missed` f32, `return` and `returns` u8,
    /// `mixed` u8, and a byte of filling.
    pub(crate) fn driver_bytes(&self) -> [u8; 16] {
        let byte = |number: u16| u8::try_from(number).unwrap_or(u8::MAX);
        let mut bytes = [0; 16];
        for (place, share) in bytes.chunks_exact_mut(4).zip(self.shares) {
            place.copy_from_slice(&(share as f32).to_le_bytes());
        }
        bytes[12..15].copy_from_slice(&[byte(self.number), byte(self.returns), self.mixed]);
        bytes
    }
}

/// The places of a cloud: of each ray, or of each return that may be told.
pub(crate) fn spots<'a>(
    answers: &'a Answers,
    returns: Option<&'a BeamReturns>,
    echo: &'a EchoLight,
) -> impl ExactSizeIterator<Item = Spot<'a>> + 'a {
    let count = returns.map_or(answers.first.len(), |returns| returns.told().len());
    (0..count).map(move |index| match returns {
        None => {
            let read = borrowed(&answers.first[index]);
            let intensity = read.hit().map_or(f64::NAN, |hit| hit.light(echo));
            Spot { ray: index, read, intensity, of_return: None }
        }
        Some(returns) => spot_of_return(answers, returns, index),
    })
}

fn borrowed(read: &Reading<FirstHit>) -> Reading<&FirstHit> {
    match read {
        Reading::Hit(hit) => Reading::Hit(hit),
        Reading::TooNear => Reading::TooNear,
        Reading::Miss => Reading::Miss,
    }
}

fn spot_of_return<'a>(answers: &'a Answers, returns: &BeamReturns, index: usize) -> Spot<'a> {
    let (beam, place) = (index / returns.most(), index % returns.most());
    let footprint = &returns.footprints()[beam];
    let word = |number: u32| u16::try_from(number).unwrap_or(u16::MAX);
    let told = returns.told()[index].as_ref();
    let rays = told.map_or(0, |told| told.rays);
    let of_return = Some(SpotReturn {
        number: told.map_or(0, |told| word(told.number)),
        returns: word(footprint.returns),
        mixed: footprint.is_mixed().into(),
        shares: [returns.share(rays), returns.share(footprint.hits - rays), returns.missed(footprint)],
        mean_range: told.map_or(f64::NAN, |told| told.mean_range),
    });
    match told {
        Some(&BeamReturn { ray, strength, .. }) => {
            Spot { ray, read: borrowed(&answers.first[ray]), intensity: strength, of_return }
        }
        None => {
            let is_too_near = place == 0 && footprint.too_near > 0;
            let read = if is_too_near { Reading::TooNear } else { Reading::Miss };
            Spot { ray: beam * returns.rays_of_beam(), read, intensity: f64::NAN, of_return }
        }
    }
}

/// The map in which the frame of a mesh lies. Its coordinates may have seven digits before the point, as many as single precision holds: so
/// clouds stay in the mesh's frame, and name the map in their headers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CloudMap {
    /// Where the origin of the mesh's frame lies, metres.
    pub origin: [f64; 3],
    /// The coordinate system of the map; `None` where there is no map.
    pub system: Option<String>,
}

impl CloudMap {
    /// Lines of comments, each after this word: none if the mesh's coordinates are those of its file.
    fn comments(&self, word: &str) -> String {
        let [x, y, z] = self.origin;
        let system = match &self.system {
            Some(system) => format!("{word} map_system {system}\n"),
            None => String::new(),
        };
        match self.origin == [0.0; 3] {
            true => system,
            false => format!("{word} map_origin_m {x} {y} {z}\n{system}"),
        }
    }
}

/// Writes one point for each hit, in the order of the rays: PLY, binary, little endian, with the properties x, y, z
/// (double), `face` (uint) and `cos_incidence` (double). (G. Turk, "The PLY polygon file format", 1994)
///
/// With returns there is a point for each of them that is told, and further properties: `range`, `mean_range` and `strength` (double),
/// `share`, `share_other` and `share_missed` (float), `return` and `returns` (ushort), `mixed` (uchar).
///
/// With margins there are `margin_face` and `margin_surface` (double), the proven lower ends of those of the ray, last.
///
/// Comments `map_origin_m X Y Z` and `map_system NAME` name the map: what is to be added to each point, metres.
///
/// # Errors
/// The file cannot be written; the message names it.
pub fn write_ply(
    path: impl AsRef<Path>,
    answers: &Answers,
    returns: Option<&BeamReturns>,
    map: &CloudMap,
) -> Result<(), FileError> {
    let map = map.comments("comment");
    let of_returns = match returns {
        None => "",
        Some(_) => {
            "property double range\nproperty double mean_range\nproperty double strength\nproperty float share\n\
             property float share_other\nproperty float share_missed\nproperty ushort return\nproperty ushort returns\n\
             property uchar mixed\n"
        }
    };
    let of_margins = match answers.margins {
        None => "",
        Some(_) => "property double margin_face\nproperty double margin_surface\n",
    };
    let points = returns.map_or(answers.counts().0, |returns| returns.told().iter().flatten().count());
    write_atomically(path, |file| {
        write!(
            file,
            "ply\nformat binary_little_endian 1.0\ncomment raypencil cast, frame of the mesh\n{map}\
             element vertex {points}\n\
             property double x\nproperty double y\nproperty double z\nproperty uint face\n\
             property double cos_incidence\n{of_returns}{of_margins}end_header\n",
        )?;
        for spot in spots(answers, returns, &EchoLight::default()) {
            let Some(hit) = spot.read.hit() else { continue };
            for value in hit.point.to_array() {
                file.write_all(&value.to_le_bytes())?;
            }
            file.write_all(&hit.face.0.to_le_bytes())?;
            file.write_all(&hit.cos_incidence.to_le_bytes())?;
            if let Some(SpotReturn { number, returns, mixed, shares, mean_range }) = spot.of_return {
                for value in [hit.range, mean_range, spot.intensity] {
                    file.write_all(&value.to_le_bytes())?;
                }
                for share in shares {
                    file.write_all(&(share as f32).to_le_bytes())?;
                }
                file.write_all(&number.to_le_bytes())?;
                file.write_all(&returns.to_le_bytes())?;
                file.write_all(&[mixed])?;
            }
            if let Some(margins) = &answers.margins {
                let Margins { face, surface } = margins[spot.ray];
                file.write_all(&face.lo.to_le_bytes())?;
                file.write_all(&surface.lo.to_le_bytes())?;
            }
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
    /// The sensor's own when it fires the first ray: without that distortion.
    SensorAtStart,
    /// The sensor's own when it fires the last ray: without it as well.
    SensorAtEnd,
}

impl CloudFrame {
    /// The frames that differ for a sensor with this mounting.
    pub fn of(mounting: &Mounting) -> &'static [Self] {
        match mounting {
            here if *here == Mounting::HERE => &[Self::Mesh],
            Mounting::Fixed(_) => &[Self::Mesh, Self::Sensor],
            Mounting::Moving(_) => &Self::ALL,
        }
    }

    /// Name of the file.
    pub fn file(self) -> &'static str {
        match self {
            Self::Mesh => "cloud.pcd",
            Self::Sensor => "cloud-sensor.pcd",
            Self::SensorAtStart => "cloud-start.pcd",
            Self::SensorAtEnd => "cloud-end.pcd",
        }
    }

    /// All of them.
    pub const ALL: [Self; 4] = [Self::Mesh, Self::Sensor, Self::SensorAtStart, Self::SensorAtEnd];

    /// The word of options.
    pub fn option(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Sensor => "sensor",
            Self::SensorAtStart => "start",
            Self::SensorAtEnd => "end",
        }
    }

    /// The frame in words.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Mesh => "the mesh",
            Self::Sensor => "the sensor, at the time of each ray",
            Self::SensorAtStart => "the sensor, at the time of the first ray",
            Self::SensorAtEnd => "the sensor, at the time of the last ray",
        }
    }
}

/// Writes one point for each ray: PCD 0.7, binary or compressed, organised. Where nothing is hit x, y, z, `intensity` and `range` are NaN, and
/// `face` is 4294967295. What is too near is no point either: `range` is -Inf. (Point Cloud Library, "The PCD (Point Cloud Data)
/// file format"; REP-117)
///
/// The width is the last dimension of the set's shape, the height the product of the others, so that points are in the
/// order of the rays. Fields, of which the first six have the names and types of the ROS driver of Velodyne:
///
/// | field | type | content |
/// | --- | --- | --- |
/// | x, y, z | float32 | the point, in the mesh's unit |
/// | `intensity` | float32 | r abs(cos psi) / R^2 e^(-2 sigma R): the light of a small spot on a diffuse surface, relative; r and sigma are those of the set |
/// | `ring` | uint16 | rank of the channel by its elevation, the lowest is 0; without elevations the channel |
/// | `time` | float32 | seconds after the first ray of the set |
/// | `timestamp` | float64 | seconds, as the set has them; 0 for sets without times |
/// | `channel` | uint16 | index in the second dimension, in the order of the manual; 0 without one |
/// | `range` | float32 | distance from the ray's origin |
/// | `face` | uint32 | the face |
///
/// With returns a point stands for each that may be told, those of a beam side by side: the width is that of the beams times their
/// number. `intensity` is then the light of the return, and after `face` there are `mean_range`, `share`, `share_other` and `share_missed`
/// (float32), `return` and `returns` (uint16) and `mixed` (uint8).
///
/// With margins there are `margin_face` and `margin_surface` (float32) last: the proven lower ends of those of the ray, rounded down; NaN in the
/// places of returns that are none.
///
/// Comments `# map_origin_m X Y Z` and `# map_system NAME` name the map in which the mesh's frame lies.
///
/// VIEWPOINT has the pose of the sensor in the mesh's frame, if the points are in the sensor's frame: that of the last ray for
/// [`CloudFrame::SensorAtEnd`], and else that of the first. Viewers that apply it show the cloud in its place. For points in the mesh's frame it is the
/// identity.
///
/// # Errors
/// The file cannot be written, or points that are to be compressed take more than 4 GiB; the message names it.
pub fn write_pcd(
    path: impl AsRef<Path>,
    answers: &Answers,
    (set, returns): (&NamedRaySet, Option<&BeamReturns>),
    (frame, data): (CloudFrame, PcdData),
    map: &CloudMap,
) -> Result<(), FileError> {
    let map = map.comments("#");
    let spots = spots(answers, returns, &set.echo);
    let count = spots.len() as u64;
    let (shape, rays_of_place, places) = places(set, returns);
    let width = shape.last().copied().unwrap_or(1) * places;
    let height = count.checked_div(width).unwrap_or(0);
    let rings = rings(set);
    // Number of places with the same index in the second dimension, one after the other.
    let of_channel: u64 = shape.iter().skip(2).product();
    let channel_of = |ray: usize| {
        let index = ray as u64 / rays_of_place;
        match shape.get(1) {
            Some(&channels) => index / of_channel % channels,
            None => 0,
        }
    };
    let [more_fields, more_sizes, more_types, more_counts] = match returns {
        None => [""; 4],
        Some(_) => [
            " mean_range share share_other share_missed return returns mixed",
            " 4 4 4 4 2 2 1",
            " F F F F U U U",
            " 1 1 1 1 1 1 1",
        ],
    };
    let [margin_fields, margin_sizes, margin_types, margin_counts] = match answers.margins {
        None => [""; 4],
        Some(_) => [" margin_face margin_surface", " 4 4", " F F", " 1 1"],
    };
    let word = |number: u64| u16::try_from(number).unwrap_or(u16::MAX);
    let time_of = |index: usize| set.times.as_ref().map_or(0.0, |times| times[index]);
    let first_time = set.times.iter().flatten().copied().reduce(f64::min).unwrap_or(0.0);
    let [start, end] = set.mounting.ends(set.times.as_deref());
    let placed = |index: usize, point: DVec3| match frame {
        CloudFrame::Mesh => point,
        CloudFrame::Sensor => set.mounting.at(time_of(index)).unwrap_or(start).inverse() * point,
        CloudFrame::SensorAtStart => start.inverse() * point,
        CloudFrame::SensorAtEnd => end.inverse() * point,
    };
    let Pose { position, rotation } = match frame {
        CloudFrame::Mesh => Pose::IDENTITY,
        CloudFrame::Sensor | CloudFrame::SensorAtStart => start,
        CloudFrame::SensorAtEnd => end,
    };
    let rotation = rotation.normalize();
    let ([x, y, z], [qx, qy, qz, qw]) = (position.to_array(), rotation.to_array());
    let sizes = format!("4 4 4 4 2 4 8 2 4 4{more_sizes}{margin_sizes}");
    let bytes_of_fields: Vec<usize> = sizes.split(' ').filter_map(|size| size.parse().ok()).collect();
    let point_bytes = bytes_of_fields.iter().sum::<usize>() as u64;
    if count * point_bytes > data.most() {
        let found = format!("{count} points of {point_bytes} bytes");
        let fault = Fault::new("points", found, "at most 4 GiB, for compressed ones");
        return Err(FileError::Cloud(fault.in_file(path.as_ref())));
    }
    let write_points = |file: &mut dyn Write| {
        for Spot { ray, read, intensity, of_return } in spots {
            let (point, range, face) = match read {
                Reading::Hit(hit) => (placed(ray, hit.point), hit.range, hit.face.0),
                Reading::TooNear => (DVec3::NAN, f64::NEG_INFINITY, NO_FACE),
                Reading::Miss => (DVec3::NAN, f64::NAN, NO_FACE),
            };
            for value in [point.x, point.y, point.z, intensity] {
                file.write_all(&(value as f32).to_le_bytes())?;
            }
            let channel = channel_of(ray);
            file.write_all(
                &word(rings.as_ref().map_or(channel, |rings| rings[channel as usize])).to_le_bytes(),
            )?;
            let time = time_of(ray);
            file.write_all(&((time - first_time) as f32).to_le_bytes())?;
            file.write_all(&time.to_le_bytes())?;
            file.write_all(&word(channel).to_le_bytes())?;
            file.write_all(&(range as f32).to_le_bytes())?;
            file.write_all(&face.to_le_bytes())?;
            let is_of_ray = of_return.is_none_or(|told| told.number != 0);
            if let Some(SpotReturn { number, returns, mixed, shares: [this, other, missed], mean_range }) =
                of_return
            {
                for value in [mean_range, this, other, missed] {
                    file.write_all(&(value as f32).to_le_bytes())?;
                }
                file.write_all(&number.to_le_bytes())?;
                file.write_all(&returns.to_le_bytes())?;
                file.write_all(&[mixed])?;
            }
            if let Some(margins) = &answers.margins {
                let Margins { face, surface } = margins[ray];
                for low in [face.lo, surface.lo] {
                    let low = if is_of_ray { rounded_down(low) } else { f32::NAN };
                    file.write_all(&low.to_le_bytes())?;
                }
            }
        }
        Ok(())
    };
    write_atomically(path.as_ref(), |file| {
        write!(
            file,
            "# .PCD v0.7 - Point Cloud Data file format\n# raypencil cast, frame of {}\n{map}VERSION 0.7\n\
             FIELDS x y z intensity ring time timestamp channel range face{more_fields}{margin_fields}\n\
             SIZE {sizes}\nTYPE F F F F U F F U F U{more_types}{margin_types}\n\
             COUNT 1 1 1 1 1 1 1 1 1 1{more_counts}{margin_counts}\n\
             WIDTH {width}\nHEIGHT {height}\nVIEWPOINT {x} {y} {z} {qw} {qx} {qy} {qz}\nPOINTS {count}\nDATA {}\n",
            frame.words(),
            data.word()
        )?;
        data.write(file, &bytes_of_fields, write_points)
    })
}

/// The greatest number of single precision that is not above a proven lower limit.
fn rounded_down(low: f64) -> f32 {
    let near = low as f32;
    if f64::from(near) > low { near.next_down() } else { near }
}

/// The shape of what has places in a cloud, rays or beams; the rays of each; and its number of places.
pub(crate) fn places<'a>(set: &'a NamedRaySet, returns: Option<&BeamReturns>) -> (&'a [u64], u64, u64) {
    match (returns, set.shape.as_slice()) {
        (Some(returns), [beams @ .., rays]) => (beams, *rays, returns.most() as u64),
        (_, shape) => (shape, 1, 1),
    }
}

pub(crate) fn rings(set: &NamedRaySet) -> Option<Vec<u64>> {
    Some(ranks(set.elevations_deg.as_ref()?))
}

/// The rank of each channel by its elevation, from below; of equal ones the first is lower.
pub(crate) fn ranks(elevations: &[f64]) -> Vec<u64> {
    let mut order: Vec<usize> = (0..elevations.len()).collect();
    order.sort_by(|a, b| elevations[*a].total_cmp(&elevations[*b]));
    let mut rings = vec![0; order.len()];
    (0..).zip(order).for_each(|(rank, channel)| rings[channel] = rank);
    rings
}
