//! A file of a cloud: its points on the rays of a pack, and what is stated by them.

use std::path::Path;

use glam::DVec3;
use raypencil_files::FileError;
use raypencil_mesh_io::{Cloud, CloudStorage, read_cloud};
use raypencil_scene::CastRay;

use super::assign::{Asked, Assigned, BY_RING, Ring, is_key, unclear};
use super::fit::rounded;
use crate::cloud::CloudFrame;
use crate::comparison::Stated;
use crate::pack::candidate::CandidateConventions;
use crate::pack::mistakes::CloudPart;
use crate::pack::scan::Scan;

/// What was read of a cloud, for reports.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudFacts {
    /// The frame that its points are taken to be in.
    pub frame: CloudFrame,
    /// Number of its points, without those that stand for no hit.
    pub points: usize,
    /// How they were laid on the rays, in words.
    pub assigned: &'static str,
    /// Indices of points that belong to no ray, or to one that has another point.
    pub strays: Vec<usize>,
    /// Whether the field `range` was judged too.
    pub has_range: bool,
    /// Number of points whose fields of channel and time are not those of their ray, as their order or another time tells it.
    pub wrong_keys: usize,
    /// What explains them.
    pub(in crate::pack) keys_why: Option<String>,
}

/// A cloud on the rays of a pack.
pub(in crate::pack) struct CloudCase<'a> {
    pub(in crate::pack) shape: &'a [u64],
    pub(in crate::pack) rays: &'a [CastRay],
    pub(in crate::pack) scan: Option<&'a Scan>,
    pub(in crate::pack) frame: CloudFrame,
    pub(in crate::pack) part: CloudPart,
    pub(in crate::pack) facts: CloudFacts,
    /// The same points on the rays that another rule of order gives, and that rule in words.
    pub(in crate::pack) otherwise: Vec<(&'static str, CloudPart)>,
    /// The field `range` and how far storing may have moved it, for each ray.
    ranges: Option<(Vec<f64>, Vec<f64>)>,
}

impl CloudCase<'_> {
    /// What the cloud states of the rays.
    pub(in crate::pack) fn stated(&self) -> Stated {
        let (range, range_error) = self.ranges.clone().unzip();
        let mut stated = Stated { range, range_error, ..Stated::default() };
        self.part.state(self.rays, &mut stated);
        stated
    }
}

/// What a number in the field `ring` may stand for in place of what it should.
const RINGS: [(&str, Ring); 3] = [
    ("the field ring counts channels from above: its 0 is the lowest", Ring::FromAbove),
    (
        "the field ring is the channel in the order of the manual: it counts elevations from below",
        Ring::Channel,
    ),
    (
        "the field ring counts channels in the opposite order of the manual: it counts elevations from below",
        Ring::ChannelReversed,
    ),
];

/// Reads a cloud and lays its points on the rays.
pub(in crate::pack) fn read_cloud_of<'a>(
    path: &Path,
    (shape, rays): (&'a [u64], &'a [CastRay]),
    scan: Option<&'a Scan>,
    conventions: CandidateConventions,
) -> Result<CloudCase<'a>, FileError> {
    let cloud = read_cloud(path, |name| name == "range" || is_key(name))?;
    let fault = |fault: raypencil_files::Fault| FileError::Cloud(fault.in_file(path));
    let frame = conventions.frame;
    if scan.is_none() && frame != CloudFrame::Mesh {
        let found = format!("--frame {}", frame.option());
        let expected = "a pack of a sensor's scan, which knows its pose (`pack MESH --rays PATTERN.toml`)";
        return Err(fault(raypencil_files::Fault::new("frame", found, expected)));
    }
    let axes = ["x", "y", "z"].map(|axis| cloud.column(axis));
    let [Some(x), Some(y), Some(z)] = axes else {
        return Err(fault(raypencil_files::Fault::new("fields", "no x, y or z", "x, y and z")));
    };
    let count = cloud.len();
    let points: Vec<DVec3> = (0..count).map(|k| DVec3::new(x.values[k], y.values[k], z.values[k])).collect();
    let is_miss = |point: DVec3| conventions.miss.is_some_and(|miss| point == DVec3::splat(miss));
    let is_point: Vec<bool> = points.iter().map(|&point| point.is_finite() && !is_miss(point)).collect();
    let real = is_point.iter().filter(|&&is_point| is_point).count();
    let asked = Asked { shape, count: rays.len(), scan };
    let found = assigned(&asked, &cloud, (&points, &is_point), rays, frame);
    let strays = found.as_ref().map_or(real, |found| found.strays.len());
    let lateness = asked.lateness(&cloud, &is_point);
    // Times with another zero still tell the rays.
    let shifted = |late: f64| {
        let found = asked.by_keys(&cloud, &is_point, (Ring::FromBelow, late));
        found.filter(|found| found.is_clear(real)).map(|found| (found, late))
    };
    let (found, late) = match found.filter(|found| found.is_clear(real)) {
        Some(found) => (found, 0.0),
        None => {
            let found = lateness.iter().find_map(|&late| shifted(late));
            found.ok_or_else(|| fault(unclear(strays, real)))?
        }
    };
    let part_of = |assigned: &Assigned| {
        let error = |k: usize| DVec3::new(x.error(k), y.error(k), z.error(k)).length();
        let pose = |index: usize| pose_of(scan, frame, index);
        CloudPart {
            raw: assigned
                .point_of
                .iter()
                .map(|of| of.filter(|&k| is_point[k]).map_or(DVec3::NAN, |k| points[k]))
                .collect(),
            error: assigned.point_of.iter().map(|of| of.map_or(0.0, error)).collect(),
            pose: (0..rays.len()).map(pose).collect(),
        }
    };
    let part = part_of(&found);
    let mut otherwise = Vec::new();
    let mut add = |words: &'static str, other: Option<Assigned>| {
        if let Some(other) = other.filter(|other| other.is_clear(real)) {
            otherwise.push((words, part_of(&other)));
        }
    };
    if found.by == BY_RING {
        for (words, ring) in RINGS {
            add(words, asked.by_keys(&cloud, &is_point, (ring, late)));
        }
    }
    if !found.by.starts_with("by the order") {
        let words = "ring, channel or time of the points are not those of their rays, which the order of the points gives";
        add(words, asked.by_order(&cloud, &is_point, asked.has_rows_of_channels(&cloud)));
    } else {
        let is_turned = found.by.ends_with("channel");
        let words = match is_turned {
            true => {
                "points are in the order of the rays, channel by channel in each sequence: WIDTH and HEIGHT are swapped"
            }
            false => "points are in rows of one channel: WIDTH and HEIGHT are swapped",
        };
        add(words, asked.by_order(&cloud, &is_point, !is_turned));
    }
    let ranges = cloud.column("range").filter(|column| column.storage != CloudStorage::Whole).map(|column| {
        let of = |of: &Option<usize>| {
            of.map_or((f64::NAN, 0.0), |k| match conventions.miss {
                Some(miss) if column.values[k] == miss => (f64::INFINITY, 0.0),
                _ => (column.values[k], column.error(k)),
            })
        };
        found.point_of.iter().map(of).unzip()
    });
    // Keys that do not tell the rays are wrong themselves.
    let unlike = |keys: &Assigned| {
        let pairs = found.point_of.iter().zip(&keys.point_of);
        pairs.filter(|(found, of_keys)| found.is_some_and(|k| is_point[k]) && found != of_keys).count()
    };
    let keys = asked.by_keys(&cloud, &is_point, (Ring::FromBelow, 0.0));
    let wrong_keys = keys.as_ref().map_or(0, unlike);
    let explains = |ring: Ring, late: f64| {
        asked.by_keys(&cloud, &is_point, (ring, late)).is_some_and(|keys| unlike(&keys) == 0)
    };
    let of_ring =
        || RINGS.iter().find(|(_, ring)| explains(*ring, 0.0)).map(|(words, _)| (*words).to_string());
    let of_time = || {
        let late =
            lateness.iter().flat_map(|&late| rounded(late)).find(|&late| explains(Ring::FromBelow, late))?;
        let way = if late > 0.0 { "late" } else { "early" };
        Some(format!("the times of the points are {} s too {way}", late.abs()))
    };
    let keys_why = if wrong_keys > 0 { of_ring().or_else(of_time) } else { None };
    let facts = CloudFacts {
        wrong_keys,
        keys_why,
        frame,
        points: real,
        assigned: found.by,
        strays: found.strays,
        has_range: ranges.is_some(),
    };
    Ok(CloudCase { shape, rays, scan, frame, part, facts, otherwise, ranges })
}

/// The pose of a cloud's frame for a ray; `None`: it is the mesh's.
pub(super) fn pose_of(scan: Option<&Scan>, frame: CloudFrame, index: usize) -> Option<raypencil_scene::Pose> {
    let scan = scan?;
    match frame {
        CloudFrame::Mesh => None,
        CloudFrame::Sensor => Some(scan.pose(index)),
        CloudFrame::SensorAtStart => Some(scan.mounting.first()),
    }
}

/// The first rule that lays nearly all points on rays of their own.
fn assigned(
    asked: &Asked<'_>,
    cloud: &Cloud,
    (points, is_point): (&[DVec3], &[bool]),
    rays: &[CastRay],
    frame: CloudFrame,
) -> Option<Assigned> {
    let real = is_point.iter().filter(|&&is_point| is_point).count();
    let clear = |assigned: &Assigned| assigned.is_clear(real);
    let by_keys = asked.by_keys(cloud, is_point, (Ring::FromBelow, 0.0)).filter(clear);
    let by_order = || asked.by_order(cloud, is_point, asked.has_rows_of_channels(cloud));
    by_keys.or_else(by_order).or_else(|| {
        // A direction tells rays apart in the sensor's own frame. Of one that moves, points in another frame have lost it.
        let is_moving = asked.scan.is_some_and(Scan::is_moving);
        if is_moving && frame != CloudFrame::Sensor {
            return None;
        }
        let of_sensor = |index: usize, ray: &CastRay| {
            let ray = asked.scan.map_or(*ray, |scan| scan.in_pattern(index, ray));
            (ray.origin, ray.direction.normalize())
        };
        let rays: Vec<(DVec3, DVec3)> =
            rays.iter().enumerate().map(|(index, ray)| of_sensor(index, ray)).collect();
        // A sensor that stands still has one pose for all points.
        let to_sensor =
            asked.scan.filter(|_| frame == CloudFrame::Mesh).map(|scan| scan.mounting.first().inverse());
        let points: Vec<DVec3> =
            points.iter().map(|&point| to_sensor.map_or(point, |pose| pose * point)).collect();
        Some(asked.by_direction(&rays, &points, is_point))
    })
}
