//! The points that are hit as a bag of ROS 2: a `PointCloud2` as a driver gives it, the sensor's poses, and the clock.

use std::path::Path;

use glam::DVec3;
use raypencil_files::{Fault, FileError};
use raypencil_rosbag::{
    BagWriter, Clock, Header, PointCloud2, PointField, Quaternion, Stamp, TfMessage, Topic, Transform,
    TransformStamped, Vector3,
};
use raypencil_scene::pattern::Mounting;
use raypencil_scene::{NamedRaySet, Pose};

use crate::answers::Answers;
use crate::cloud::{Spot, SpotReturn, places, rings, spots};
use crate::returns::BeamReturns;

/// The frame of the mesh, and that of the sensor (REP-105 has `map`). Where the mesh's origin is moved in its map, `map` is the
/// map and the mesh's frame is `mesh`, fixed in it: numbers in `mesh` stay small, those of `map` may have seven digits.
const MAP: &str = "map";
const MESH: &str = "mesh";
const SENSOR: &str = "lidar";

/// Earliest time of a message, seconds: the time 0 means "no time" in ROS.
const FIRST_S: f64 = 1.0;

/// What follows the fields of a driver in clouds of returns: name, place after them and type of each.
const RETURN_FIELDS: [(&str, u32, u8); 6] = [
    ("share", 0, PointField::FLOAT32),
    ("share_other", 4, PointField::FLOAT32),
    ("share_missed", 8, PointField::FLOAT32),
    ("return", 12, PointField::UINT8),
    ("returns", 13, PointField::UINT8),
    ("mixed", 14, PointField::UINT8),
];

/// Their bytes, with one of filling: a multiple of what PCL aligns points to.
const RETURN_BYTES: u32 = 16;

/// Whose fields the points have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BagFields {
    /// `x y z intensity` f32, `ring` u16 from below, `time` f32 in seconds after the first ray; 22 bytes, without gaps. (ROS driver of
    /// Velodyne, `velodyne_pointcloud`, `pointcloudXYZIRT`)
    Velodyne,
    /// `x y z intensity` f32, `t` u32 in nanoseconds after the first ray, `reflectivity ring ambient` u16, `range` u32 in
    /// thousandths; 48 bytes, aligned as PCL does. `ring` counts from above. (ROS driver of Ouster, `ouster_ros`, `os_point.h`)
    Ouster,
    /// `x y z intensity` f32, `tag line` u8, `timestamp` f64 in nanoseconds; 26 bytes, without gaps. `line` is the channel, in the order
    /// of the pattern: the driver has the number of the laser. (`livox_ros_driver2`,
    /// `InitPointcloud2MsgHeader`, with `xfer_format` 0)
    Livox,
}

impl BagFields {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Velodyne, Self::Ouster, Self::Livox];

    /// The word of options.
    pub fn option(self) -> &'static str {
        match self {
            Self::Velodyne => "velodyne",
            Self::Ouster => "ouster",
            Self::Livox => "livox",
        }
    }

    /// Name, place and type of each field, those of returns behind the driver's own, and the bytes of a point.
    fn point(self, has_returns: bool) -> (Vec<(&'static str, u32, u8)>, u32) {
        let (own, bytes) = self.layout();
        let mut fields = own.to_vec();
        if !has_returns {
            return (fields, bytes);
        }
        fields.extend(RETURN_FIELDS.map(|(name, at, datatype)| (name, bytes + at, datatype)));
        (fields, bytes + RETURN_BYTES)
    }

    /// The same of the driver's own fields.
    fn layout(self) -> (&'static [(&'static str, u32, u8)], u32) {
        const REAL: u8 = PointField::FLOAT32;
        match self {
            Self::Velodyne => (
                &[
                    ("x", 0, REAL),
                    ("y", 4, REAL),
                    ("z", 8, REAL),
                    ("intensity", 12, REAL),
                    ("ring", 16, PointField::UINT16),
                    ("time", 18, REAL),
                ],
                22,
            ),
            // Four reals for the place, of which the last is filling; the end is filled up to a multiple of 16 bytes.
            Self::Ouster => (
                &[
                    ("x", 0, REAL),
                    ("y", 4, REAL),
                    ("z", 8, REAL),
                    ("intensity", 16, REAL),
                    ("t", 20, PointField::UINT32),
                    ("reflectivity", 24, PointField::UINT16),
                    ("ring", 26, PointField::UINT16),
                    ("ambient", 28, PointField::UINT16),
                    ("range", 32, PointField::UINT32),
                ],
                48,
            ),
            Self::Livox => (
                &[
                    ("x", 0, REAL),
                    ("y", 4, REAL),
                    ("z", 8, REAL),
                    ("intensity", 12, REAL),
                    ("tag", 16, PointField::UINT8),
                    ("line", 17, PointField::UINT8),
                    ("timestamp", 18, PointField::FLOAT64),
                ],
                26,
            ),
        }
    }
}

/// What the points of a bag are like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BagForm {
    /// Their fields.
    pub fields: BagFields,
    /// Leave out rays without a point, and with them the order. Clouds of Livox have no order in any case.
    pub is_dense: bool,
}

/// Where each ray of a set, or each return, belongs.
struct Places {
    rows: u64,
    columns: u64,
    /// Cell of each, row by row.
    cells: Vec<usize>,
    /// Ring of each; of Livox the channel.
    rings: Vec<u64>,
}

impl Places {
    /// Velodyne: a row for each firing sequence, its rings from below. Ouster: a row for each channel, from above, and a column
    /// for each sequence. A pattern without elevations keeps its own rows and columns.
    ///
    /// The returns of a beam stand side by side.
    fn of(set: &NamedRaySet, returns: Option<&BeamReturns>, fields: BagFields) -> Self {
        let (shape, _, of_each) = places(set, returns);
        let one = Self::of_beams(set, shape, fields);
        let spread = |of: &[usize]| -> Vec<usize> {
            of.iter()
                .flat_map(|cell| (0..of_each as usize).map(move |place| cell * of_each as usize + place))
                .collect()
        };
        Self {
            rows: one.rows,
            columns: one.columns * of_each,
            cells: spread(&one.cells),
            rings: one.rings.iter().flat_map(|ring| std::iter::repeat_n(*ring, of_each as usize)).collect(),
        }
    }

    fn of_beams(set: &NamedRaySet, shape: &[u64], fields: BagFields) -> Self {
        let count: u64 = shape.iter().product();
        let columns = shape.last().copied().unwrap_or(1);
        let rows = count.checked_div(columns).unwrap_or(0);
        let by_channel = rings(set).filter(|_| shape.len() == 2);
        let Some(ranks) = by_channel else {
            let ring =
                |index: u64| if fields == BagFields::Ouster { index / columns } else { index % columns };
            return Self {
                rows,
                columns,
                cells: (0..count as usize).collect(),
                rings: (0..count).map(ring).collect(),
            };
        };
        let ring = |channel: u64| match fields {
            BagFields::Ouster => columns - 1 - ranks[channel as usize],
            BagFields::Velodyne => ranks[channel as usize],
            BagFields::Livox => channel,
        };
        let cell = |index: u64| match fields {
            BagFields::Ouster => ring(index % columns) * rows + index / columns,
            BagFields::Velodyne | BagFields::Livox => index / columns * columns + ring(index % columns),
        };
        let (height, width) = if fields == BagFields::Ouster { (columns, rows) } else { (rows, columns) };
        Self {
            rows: height,
            columns: width,
            cells: (0..count).map(|index| cell(index) as usize).collect(),
            rings: (0..count).map(|index| ring(index % columns)).collect(),
        }
    }
}

/// Writes a bag of ROS 2 (MCAP): `/points`, a `PointCloud2` of all rays in the sensor's own frame at the time of each, `lidar`; its poses
/// in `map`, the frame of the mesh, as `/tf`, or `/tf_static` for one that stands still; and `/clock`. If `origin`, where the mesh's frame lies in
/// its map, is not 0, the frame of the mesh is `mesh`, and `/tf_static` has it in `map`.
///
/// Times are those of the set, or later by as much as brings the first of them to 1 s. The cloud's header has the time of the
/// first ray, and it is recorded at that of the last. Without order the points are in the order of the rays; with it, cells
/// without a point have NaN, and `is_dense` is false.
///
/// Of a set that asks for returns a point stands for each of them, those of a beam side by side. Its fields are followed by `share`,
/// `share_other`, `share_missed` f32, `return`, `returns` and `mixed` u8, and a byte of filling.
///
/// # Errors
/// The file cannot be written, or the points take more than 4 GiB; the message names the folder.
pub fn write_scan_bag(
    folder: &Path,
    answers: &Answers,
    set: &NamedRaySet,
    form: BagForm,
    origin: [f64; 3],
) -> Result<(), FileError> {
    let first = set.times.iter().flatten().copied().reduce(f64::min).unwrap_or(0.0);
    let mut bag = ScanBag::create(folder, (first, &set.mounting), form, origin)?;
    bag.add(answers, set)?;
    bag.finish()
}

/// Such a bag with a cloud for each of several scans, in the order of time.
pub(crate) struct ScanBag<'a> {
    folder: &'a Path,
    bag: BagWriter,
    mounting: &'a Mounting,
    form: BagForm,
    /// Name of the mesh's frame.
    mesh_frame: &'static str,
    /// Seconds by which all times are later.
    later: f64,
    /// The last time at which something was told.
    told: f64,
}

impl<'a> ScanBag<'a> {
    /// Begins a bag of the scans of a set, with the time of its first ray.
    pub(crate) fn create(
        folder: &'a Path,
        (first, mounting): (f64, &'a Mounting),
        form: BagForm,
        origin: [f64; 3],
    ) -> Result<Self, FileError> {
        let begin = match mounting {
            Mounting::Fixed(_) => first,
            Mounting::Moving(poses) => first.min(poses.span_s()[0]),
        };
        let later = (FIRST_S - begin).max(0.0);
        let bag = BagWriter::create(folder)?;
        let mesh_frame = if origin == [0.0; 3] { MAP } else { MESH };
        let mut begun = Self { folder, bag, mounting, form, mesh_frame, later, told: f64::NEG_INFINITY };
        let at = begun.at(begin);
        let mut transforms = Vec::new();
        if mesh_frame == MESH {
            transforms.push(transform(at, [MAP, MESH], &Pose::from_position(origin.into())));
        }
        if let Mounting::Fixed(pose) = mounting {
            transforms.push(transform(at, [mesh_frame, SENSOR], pose));
        }
        if !transforms.is_empty() {
            begun.bag.write(&Topic::latched("/tf_static"), at, &TfMessage { transforms })?;
        }
        Ok(begun)
    }

    fn at(&self, seconds: f64) -> Stamp {
        Stamp::from_nanoseconds(((seconds + self.later) * 1e9).round() as u64)
    }

    /// The next scan.
    pub(crate) fn add(&mut self, answers: &Answers, scan: &NamedRaySet) -> Result<(), FileError> {
        let returns = BeamReturns::of(answers, scan);
        let (_, point_bytes) = self.form.fields.point(returns.is_some());
        let count = spots(answers, returns.as_ref(), &scan.echo).len() as u64;
        if count * u64::from(point_bytes) > u64::from(u32::MAX) {
            let found = format!("{count} points of {point_bytes} bytes");
            return Err(FileError::Cloud(Fault::new("points", found, "at most 4 GiB").in_file(self.folder)));
        }
        let time_of = |index: usize| scan.times.as_ref().map_or(0.0, |times| times[index]);
        let times = || (0..answers.first.len()).map(time_of);
        let (first, last) =
            (times().reduce(f64::min).unwrap_or(0.0), times().reduce(f64::max).unwrap_or(0.0));
        self.tell(&[first, last], last)?;
        let cloud = cloud((answers, returns.as_ref()), scan, self.form, (self.at(first), first));
        self.bag.write(&Topic::new("/points"), self.at(last), &cloud)
    }

    /// Clock and pose at some times, and at those of all poses up to a time that were not told yet.
    fn tell(&mut self, times: &[f64], end: f64) -> Result<(), FileError> {
        let mut ticks = times.to_vec();
        if let Mounting::Moving(poses) = self.mounting {
            ticks.extend(poses.poses().iter().map(|pose| pose.time_s).filter(|time| *time <= end));
        }
        ticks.retain(|tick| *tick > self.told);
        ticks.sort_by(f64::total_cmp);
        ticks.dedup();
        for tick in ticks {
            let at = self.at(tick);
            self.bag.write(&Topic::new("/clock"), at, &Clock { clock: at })?;
            if let Mounting::Moving(poses) = self.mounting
                && let Some(pose) = poses.at(tick)
            {
                let transforms = vec![transform(at, [self.mesh_frame, SENSOR], &pose)];
                self.bag.write(&Topic::new("/tf"), at, &TfMessage { transforms })?;
            }
            self.told = tick;
        }
        Ok(())
    }

    /// Ends the bag, with the poses that are left.
    pub(crate) fn finish(mut self) -> Result<(), FileError> {
        self.tell(&[], f64::INFINITY)?;
        self.bag.finish()
    }
}

/// The pose of a frame in its parent, which stands first.
fn transform(stamp: Stamp, [parent, child]: [&str; 2], pose: &Pose) -> TransformStamped {
    let rotation = pose.rotation.normalize();
    TransformStamped {
        header: Header { stamp, frame_id: parent.into() },
        child_frame_id: child.into(),
        transform: Transform {
            translation: Vector3 { x: pose.position.x, y: pose.position.y, z: pose.position.z },
            rotation: Quaternion { x: rotation.x, y: rotation.y, z: rotation.z, w: rotation.w },
        },
    }
}

fn cloud(
    (answers, returns): (&Answers, Option<&BeamReturns>),
    set: &NamedRaySet,
    form: BagForm,
    (stamp, first_s): (Stamp, f64),
) -> PointCloud2 {
    let BagForm { fields, is_dense } = form;
    let (layout, point_step) = fields.point(returns.is_some());
    let step = point_step as usize;
    let places = Places::of(set, returns, fields);
    let is_dense = is_dense || fields == BagFields::Livox;
    let bytes = |(spot, ring): (Spot<'_>, u64)| {
        let time = set.times.as_ref().map_or(0.0, |times| times[spot.ray]);
        let pose = set.mounting.at(time).unwrap_or_else(|| set.mounting.first());
        let place = spot.read.hit().map_or(DVec3::NAN, |hit| pose.inverse() * hit.point);
        let mut bytes = point(fields, (place, &spot), ring, time - first_s, stamp);
        bytes.extend(spot.of_return.iter().flat_map(SpotReturn::driver_bytes));
        bytes
    };
    let each = || spots(answers, returns, &set.echo).zip(places.rings.iter().copied());
    let has_all = spots(answers, returns, &set.echo).all(|spot| spot.read.hit().is_some());
    let (data, height, width) = match is_dense {
        true => {
            let hits = each().filter(|(spot, _)| spot.read.hit().is_some());
            let data: Vec<u8> = hits.flat_map(bytes).collect();
            let points = data.len() / step;
            (data, 1, points as u32)
        }
        false => {
            let mut data = vec![0; places.cells.len() * step];
            for (spot, &cell) in each().zip(&places.cells) {
                data[cell * step..(cell + 1) * step].copy_from_slice(&bytes(spot));
            }
            (data, places.rows as u32, places.columns as u32)
        }
    };
    let field = |&(name, offset, datatype): &(&str, u32, u8)| PointField {
        name: name.into(),
        offset,
        datatype,
        count: 1,
    };
    PointCloud2 {
        header: Header { stamp, frame_id: SENSOR.into() },
        height,
        width,
        fields: layout.iter().map(field).collect(),
        is_bigendian: false,
        point_step,
        row_step: width * point_step,
        data: data.into(),
        // The order keeps cells without a point.
        is_dense: is_dense || has_all,
    }
}

/// The bytes of a point.
fn point(
    fields: BagFields,
    (place, spot): (DVec3, &Spot<'_>),
    ring: u64,
    after_s: f64,
    stamp: Stamp,
) -> Vec<u8> {
    let mut bytes: Vec<u8> = place.to_array().iter().flat_map(|part| (*part as f32).to_le_bytes()).collect();
    let light = spot.intensity as f32;
    let nanoseconds = (after_s * 1e9).round();
    let word = |number: u64| u16::try_from(number).unwrap_or(u16::MAX).to_le_bytes();
    match fields {
        BagFields::Velodyne => {
            bytes.extend(light.to_le_bytes());
            bytes.extend(word(ring));
            bytes.extend((after_s as f32).to_le_bytes());
        }
        BagFields::Ouster => {
            bytes.extend([0; 4]);
            bytes.extend(light.to_le_bytes());
            bytes.extend((nanoseconds as u32).to_le_bytes());
            bytes.extend([0; 2]);
            bytes.extend(word(ring));
            // ambient, and two bytes of filling.
            bytes.extend([0; 4]);
            let range = spot.read.hit().map_or(0.0, |hit| (hit.range * 1e3).round());
            bytes.extend((range as u32).to_le_bytes());
            bytes.extend([0; 12]);
        }
        BagFields::Livox => {
            bytes.extend(light.to_le_bytes());
            bytes.extend([0, u8::try_from(ring).unwrap_or(u8::MAX)]);
            bytes.extend((stamp.nanoseconds() as f64 + nanoseconds).to_le_bytes());
        }
    }
    bytes
}
