//! The ray of each point.

use std::collections::HashMap;

use glam::DVec3;
use raypencil_files::Fault;
use raypencil_mesh_io::{Cloud, CloudColumn};

use crate::cloud::ranks;
use crate::pack::scan::Scan;

/// Greatest share of the points, in a hundred, that may belong to no ray. Tuned: more say that the points were laid on the wrong rays.
const MAX_STRAY_PERCENT: usize = 1;

/// How much nearer the nearest ray of a point must be than the next one, as a factor. Tuned: at 3 a point that stands a quarter of
/// the way from its ray to the next is still told.
const NEARER: f64 = 3.0;

/// Cells along each axis of the grid in which rays are looked up by their direction, at most.
const MAX_CELLS: i32 = 1024;

/// Words for points that are laid on rays by ring and time.
pub(super) const BY_RING: &str = "by ring and time";

/// Words for points that are laid on rays by their direction.
pub(super) const BY_DIRECTION: &str = "by direction";

/// In which order points lie in their file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Order {
    /// A row of points is one channel, and not one firing sequence.
    pub(super) is_of_channels: bool,
    /// The rows run from the last to the first; the points of each row do.
    pub(super) backwards: [bool; 2],
}

/// What a number in the field `ring` stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ring {
    /// The rank of the channel by its elevation, from below.
    FromBelow,
    /// The same from above.
    FromAbove,
    /// The channel in the order of the manual.
    Channel,
    /// The channel in the opposite order.
    ChannelReversed,
}

/// The points of a cloud on the rays of a pack.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Assigned {
    /// For each ray the index of its point.
    pub(super) point_of: Vec<Option<usize>>,
    /// Points of no ray, or of one that has another.
    pub(super) strays: Vec<usize>,
    /// How it was found, in words.
    pub(super) by: &'static str,
}

/// What is asked of a pack of rays.
pub(super) struct Asked<'a> {
    pub(super) shape: &'a [u64],
    pub(super) count: usize,
    pub(super) scan: Option<&'a Scan>,
}

impl Asked<'_> {
    /// The channels, if rays have one each.
    pub(super) fn channels(&self) -> Option<usize> {
        match self.shape {
            [_, channels] => Some(*channels as usize),
            _ => None,
        }
    }

    /// By channel and time, where the file has both and they tell rays apart. `late_s` is what its times are too late.
    pub(super) fn by_keys(
        &self,
        cloud: &Cloud,
        is_point: &[bool],
        (ring, late_s): (Ring, f64),
    ) -> Option<Assigned> {
        let scan = self.scan?;
        let times = scan.times.as_ref()?;
        // Without channels the time alone tells the ray.
        let channels = self.channels().unwrap_or(1);
        let of_channel = cloud.column("channel").or_else(|| cloud.column("line"));
        let (of_channel, by) = match (of_channel, cloud.column("ring")) {
            _ if self.channels().is_none() => (None, "by time"),
            (Some(column), None) => (Some(column), "by channel and time"),
            (_, Some(column)) => (Some(column), BY_RING),
            (None, None) => return None,
        };
        // With both fields, the ring is what consumers read.
        let is_ring = by == BY_RING;
        let channel_of: Vec<usize> = match (is_ring, &scan.elevations_deg) {
            (true, Some(elevations)) => {
                let ranks = ranks(elevations);
                let key = |channel: usize| match ring {
                    Ring::FromBelow => ranks[channel] as usize,
                    Ring::FromAbove => channels - 1 - ranks[channel] as usize,
                    Ring::Channel => channel,
                    Ring::ChannelReversed => channels - 1 - channel,
                };
                let mut channel_of = vec![0; channels];
                (0..channels).for_each(|channel| channel_of[key(channel)] = channel);
                channel_of
            }
            _ => (0..channels).collect(),
        };
        let (of_time, seconds) = seconds(cloud, times)?;
        // The times of each channel in ascending order, with their rays.
        let mut fired: Vec<Vec<(f64, usize)>> = vec![Vec::new(); channels];
        for (index, &time) in times.iter().enumerate() {
            fired[index % channels].push((time, index));
        }
        for list in &mut fired {
            list.sort_by(|a, b| a.0.total_cmp(&b.0));
            if list.windows(2).any(|pair| pair[0].0 == pair[1].0) {
                return None;
            }
        }
        let ray = |point: usize| {
            let key = of_channel.map_or(0.0, |column| column.values[point]);
            let channel = *channel_of.get((key.fract() == 0.0 && key >= 0.0).then_some(key as usize)?)?;
            let time = seconds(of_time.values[point]) - late_s;
            let list = &fired[channel];
            let after = list.partition_point(|(other, _)| *other < time);
            let near = [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|k| list.get(k));
            let nearest = near.min_by(|a, b| (a.0 - time).abs().total_cmp(&(b.0 - time).abs()))?;
            // A quarter of the way to the next firing of the channel; a channel that fires once has no next.
            let gap = list.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(f64::INFINITY, f64::min);
            ((nearest.0 - time).abs() <= gap / 4.0).then_some(nearest.1)
        };
        Some(self.collected(is_point, ray, by))
    }

    /// How much too late the times of a cloud may be, seconds: those by which its first point has the time of the first ray, or its
    /// last that of the last.
    pub(super) fn lateness(&self, cloud: &Cloud, is_point: &[bool]) -> Vec<f64> {
        let Some(times) = self.scan.and_then(|scan| scan.times.as_ref()) else { return Vec::new() };
        let Some((column, seconds)) = seconds(cloud, times) else { return Vec::new() };
        let stated =
            || column.values.iter().zip(is_point).filter(|(_, is)| **is).map(|(time, _)| seconds(*time));
        let least = |times: &mut dyn Iterator<Item = f64>| times.fold(f64::INFINITY, f64::min);
        let most = |times: &mut dyn Iterator<Item = f64>| times.fold(f64::NEG_INFINITY, f64::max);
        let asked = || times.iter().copied();
        let found = [least(&mut stated()) - least(&mut asked()), most(&mut stated()) - most(&mut asked())];
        found.into_iter().filter(|late| late.is_finite() && *late != 0.0).collect()
    }

    /// By order: one point for each ray.
    pub(super) fn by_order(&self, cloud: &Cloud, is_point: &[bool], order: Order) -> Option<Assigned> {
        if cloud.len() != self.count {
            return None;
        }
        if order == Order::default() {
            return Some(self.collected(is_point, Some, "by the order of the points"));
        }
        let channels = self.channels()?;
        let sequences = self.count.checked_div(channels)?;
        let (rows, columns) =
            if order.is_of_channels { (channels, sequences) } else { (sequences, channels) };
        let ray = |point: usize| {
            let turned = |at: usize, of: usize, backwards: bool| if backwards { of - 1 - at } else { at };
            let row = turned(point / columns, rows, order.backwards[0]);
            let column = turned(point % columns, columns, order.backwards[1]);
            Some(if order.is_of_channels { column * channels + row } else { row * channels + column })
        };
        let words = match order.is_of_channels {
            true => "by the order of the points, a row for each channel",
            false => "by the order of the points",
        };
        Some(self.collected(is_point, ray, words))
    }

    /// Whether the rows of an organised cloud are channels, and not firing sequences; `None` if their numbers are the same.
    pub(super) fn has_rows_of_channels(&self, cloud: &Cloud) -> Option<bool> {
        let Some(channels) = self.channels() else { return Some(false) };
        let has_channels = cloud.height > 1 && cloud.height as usize == channels;
        if has_channels && cloud.width as usize == channels { None } else { Some(has_channels) }
    }

    /// By direction: rays and points in the sensor's frame, the ray that is nearest in angle.
    pub(super) fn by_direction(
        &self,
        rays: &[(DVec3, DVec3)],
        points: &[DVec3],
        is_point: &[bool],
    ) -> Assigned {
        let cells = (libm::sqrt(rays.len() as f64) as i32).clamp(1, MAX_CELLS);
        let cell = |direction: DVec3| {
            direction.to_array().map(|part| libm::floor(part * f64::from(cells) / 2.0) as i32)
        };
        let mut grid: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
        for (index, (_, direction)) in rays.iter().enumerate() {
            grid.entry(cell(*direction)).or_default().push(index);
        }
        let ray = |point: usize| {
            let place = points[point];
            let [x, y, z] = cell(place.normalize_or_zero());
            let (mut best, mut next) = ((f64::INFINITY, 0), f64::INFINITY);
            for k in 0..27 {
                let around = [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1];
                for &index in grid.get(&around).into_iter().flatten() {
                    let (origin, direction) = rays[index];
                    let from = place - origin;
                    let angle = libm::atan2(from.cross(direction).length(), from.dot(direction));
                    if angle < best.0 {
                        (next, best) = (best.0, (angle, index));
                    } else if angle < next {
                        next = angle;
                    }
                }
            }
            (best.0 * NEARER <= next && best.0.is_finite()).then_some(best.1)
        };
        self.collected(is_point, ray, BY_DIRECTION)
    }

    fn collected(
        &self,
        is_point: &[bool],
        ray: impl Fn(usize) -> Option<usize>,
        by: &'static str,
    ) -> Assigned {
        let mut assigned = Assigned { point_of: vec![None; self.count], strays: Vec::new(), by };
        // What is no point takes the places that are left.
        for pass in [true, false] {
            for point in (0..is_point.len()).filter(|&point| is_point[point] == pass) {
                match ray(point).map(|index| &mut assigned.point_of[index]) {
                    Some(place @ None) => *place = Some(point),
                    _ if pass => assigned.strays.push(point),
                    _ => {}
                }
            }
        }
        assigned
    }
}

impl Assigned {
    /// Whether so few points belong to no ray that the others can be judged.
    pub(super) fn is_clear(&self, points: usize) -> bool {
        self.strays.len() * 100 <= points * MAX_STRAY_PERCENT
    }

    /// Whether another rule lays so few of these points otherwise.
    pub(super) fn is_like(&self, other: &Self, points: usize) -> bool {
        let otherwise = self.point_of.iter().zip(&other.point_of).filter(|(a, b)| a.is_some() && a != b);
        otherwise.count() * 100 <= points * MAX_STRAY_PERCENT
    }
}

/// The field that has the time, and what makes seconds of the pack of its numbers.
fn seconds<'a>(cloud: &'a Cloud, times: &[f64]) -> Option<(&'a CloudColumn, impl Fn(f64) -> f64)> {
    let first = times.iter().copied().fold(f64::INFINITY, f64::min);
    // Velodyne: seconds after the first ray. Ouster and Livox: nanoseconds, `offset_time` after the first ray. Others: seconds.
    let stamp = if is_of_livox(cloud) { 1e-9 } else { 1.0 };
    let known =
        [("time", 1.0, first), ("timestamp", stamp, 0.0), ("t", 1e-9, first), ("offset_time", 1e-9, first)];
    known
        .into_iter()
        .find_map(|(name, unit, zero)| Some((cloud.column(name)?, move |number: f64| number * unit + zero)))
}

/// Whether a cloud has the fields of Livox's driver: its `timestamp` is in nanoseconds.
fn is_of_livox(cloud: &Cloud) -> bool {
    cloud.column("line").is_some() && cloud.column("tag").is_some()
}

/// What the field `ring` counts: with Ouster's field `t` channels from above, as its driver does, else from below.
pub(super) fn usual_ring(cloud: &Cloud) -> Ring {
    let is_of_ouster = cloud.column("t").is_some() && cloud.column("time").is_none();
    if is_of_ouster { Ring::FromAbove } else { Ring::FromBelow }
}

/// The fields that tell the ray of a point, and whose they are.
pub(super) fn is_key(name: &str) -> bool {
    ["ring", "channel", "line", "tag", "time", "timestamp", "t", "offset_time"].contains(&name)
}

/// Why points cannot be laid on rays.
pub(super) fn unclear(strays: usize, points: usize) -> Fault {
    Fault::new(
        "points",
        format!("{strays} of {points} points belong to no ray that is known, or share one"),
        "the fields `ring` (or `channel`) and `time`, or one point for each ray in their order, NaN where there is none",
    )
}
