//! What the fields of a cloud say of the ray of each point: its channel, and its time.

use glam::DVec3;
use raypencil_mesh_io::{Cloud, CloudColumn};
use raypencil_scene::CastRay;

use super::assign::{Asked, Assigned, NUMBERS_OF_RETURNS};
use crate::cloud::{CloudFrame, ranks};
use crate::pack::scan::Scan;

/// Words for points that are laid on rays by ring and time.
pub(super) const BY_RING: &str = "by ring and time";

/// Words for points that are laid on rays by the channel in the order of the manual and by time.
pub(super) const BY_CHANNEL: &str = "by channel and time";

/// Points of which the elevation is looked at, at most.
const MAX_MEASURED: usize = 20_000;

/// What a number of a channel stands for, in the field `ring`, `channel` or `line`.
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

/// What a number in the field of the time stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clock {
    /// How many of its right units one of its units is.
    pub(super) unit: f64,
    /// How much too late the times are, seconds.
    pub(super) late_s: f64,
    /// All rays of a firing sequence have the time of the first of them.
    pub(super) is_of_sequence: bool,
}

impl Clock {
    /// The one that is asked for.
    pub(super) const RIGHT: Self = Self { unit: 1.0, late_s: 0.0, is_of_sequence: false };
}

/// How the fields of a cloud are read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Keys {
    pub(super) ring: Ring,
    /// The number of the first channel.
    pub(super) from: i64,
    /// Two channels, in the order of the manual, each with the number of the other.
    pub(super) exchanged: Option<[usize; 2]>,
    pub(super) clock: Clock,
}

impl Keys {
    /// Numbers of the ring, and right times.
    pub(super) fn of(ring: Ring) -> Self {
        Self { ring, from: 0, exchanged: None, clock: Clock::RIGHT }
    }

    /// The channel that a point's number names, of those of all numbers; `None`: it is the number of none.
    pub(super) fn channel(&self, column: &CloudColumn, point: usize, channel_of: &[usize]) -> Option<usize> {
        let key = column.values[point] - self.from as f64;
        channel_of.get((key.fract() == 0.0 && key >= 0.0).then_some(key as usize)?).copied()
    }
}

/// When the beams fire, by a clock.
pub(super) struct Fired {
    /// Times of the beams, seconds.
    pub(super) times: Vec<f64>,
    /// The same of each channel.
    pub(super) channels: Vec<ChannelTimes>,
}

/// The times of a channel in ascending order, no two of them the same, each with its beam.
pub(super) struct ChannelTimes {
    list: Vec<(f64, usize)>,
    /// The least time from one firing to the next; infinite for a channel that fires once.
    gap: f64,
}

impl ChannelTimes {
    /// `None` if two beams fire at one time.
    fn new(mut list: Vec<(f64, usize)>) -> Option<Self> {
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        let gap = list.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(f64::INFINITY, f64::min);
        (gap != 0.0).then_some(Self { list, gap })
    }

    /// How far off a time of the channel may be, seconds: a quarter of the way to the next firing.
    pub(super) fn tolerance(&self) -> f64 {
        self.gap / 4.0
    }

    /// The beam that fires at a time, within the tolerance.
    fn beam_at(&self, time: f64) -> Option<usize> {
        let after = self.list.partition_point(|(other, _)| *other < time);
        let near = [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|k| self.list.get(k));
        let nearest = near.min_by(|a, b| (a.0 - time).abs().total_cmp(&(b.0 - time).abs()))?;
        ((nearest.0 - time).abs() <= self.tolerance()).then_some(nearest.1)
    }
}

/// The field that has the time.
#[derive(Clone, Copy)]
struct TimeField<'a> {
    name: &'static str,
    column: &'a CloudColumn,
    /// Its right unit, seconds.
    unit: f64,
    /// Its right zero, seconds of the pattern.
    zero: f64,
}

impl TimeField<'_> {
    fn seconds(&self, point: usize, clock: Clock) -> f64 {
        self.column.values[point] * (self.unit * clock.unit) + self.zero - clock.late_s
    }
}

/// Whether a cloud has the fields of Livox's driver: its `timestamp` is in nanoseconds.
fn is_of_livox(cloud: &Cloud) -> bool {
    cloud.column("line").is_some() && cloud.column("tag").is_some()
}

/// What the field of the channel counts. `ring`: with Ouster's field `t` channels from above, as its driver does, else from below.
/// `channel` and Livox's `line` are channels in the order of the manual: its driver has the laser's number.
pub(super) fn usual_ring(cloud: &Cloud) -> Ring {
    if cloud.column("ring").is_none() {
        return Ring::Channel;
    }
    let is_of_ouster = cloud.column("t").is_some() && cloud.column("time").is_none();
    if is_of_ouster { Ring::FromAbove } else { Ring::FromBelow }
}

/// The fields that tell the ray of a point, and whose they are.
pub(super) fn is_key(name: &str) -> bool {
    ["ring", "channel", "line", "tag", "time", "timestamp", "t", "offset_time"].contains(&name)
        || NUMBERS_OF_RETURNS.contains(&name)
}

impl Asked<'_> {
    /// By channel and time, where the file has both and they tell rays apart.
    pub(super) fn by_keys(&self, cloud: &Cloud, is_point: &[bool], keys: Keys) -> Option<Assigned> {
        let (of_channel, by) = self.channel_field(cloud).filter(|_| !self.has_rows_as_rings(cloud))?;
        let channel_of = self.channel_of_number(keys);
        let (_, seconds) = self.stated_times(cloud, keys.clock)?;
        let fired = self.fired(keys.clock)?;
        let beam = |point: usize| {
            // Without channels the time alone tells the ray.
            let channel = of_channel.map_or(Some(0), |column| keys.channel(column, point, &channel_of))?;
            fired.channels[channel].beam_at(seconds(point))
        };
        Some(self.of_beams(cloud, is_point, beam, by))
    }

    /// The field that has the times of points, and what it says by a clock, in seconds.
    pub(super) fn stated_times<'c>(
        &self,
        cloud: &'c Cloud,
        clock: Clock,
    ) -> Option<(&'static str, impl Fn(usize) -> f64 + use<'c>)> {
        let field = self.time_field(cloud, &self.times()?)?;
        Some((field.name, move |point: usize| field.seconds(point, clock)))
    }

    /// When the beams fire by a clock; `None` if the pack does not know, or two of a channel fire at one time.
    pub(super) fn fired(&self, clock: Clock) -> Option<Fired> {
        let times = self.asked_times(&self.times()?, clock);
        let mut lists = vec![Vec::new(); self.channels().unwrap_or(1)];
        let channels = lists.len();
        for (beam, &time) in times.iter().enumerate() {
            lists[beam % channels].push((time, beam));
        }
        let channels = lists.into_iter().map(ChannelTimes::new).collect::<Option<_>>()?;
        Some(Fired { times, channels })
    }

    /// Velodyne: seconds after the first ray. Ouster and Livox: nanoseconds, `offset_time` after the first ray. Others: seconds. What counts
    /// from elsewhere is later by as much as the whole bag is.
    fn time_field<'c>(&self, cloud: &'c Cloud, times: &[f64]) -> Option<TimeField<'c>> {
        let first = times.iter().copied().fold(f64::INFINITY, f64::min);
        let stamp = if is_of_livox(cloud) { 1e-9 } else { 1.0 };
        let zero = -self.bag.map_or(0.0, |bag| bag.later_s(first));
        let known = [
            ("time", 1.0, first),
            ("timestamp", stamp, zero),
            ("t", 1e-9, first),
            ("offset_time", 1e-9, first),
        ];
        known
            .into_iter()
            .find_map(|(name, unit, zero)| Some(TimeField { name, column: cloud.column(name)?, unit, zero }))
    }

    /// Times of the beams, seconds.
    fn times(&self) -> Option<Vec<f64>> {
        let times = self.scan?.times.as_ref()?;
        Some(times.iter().step_by(self.places).copied().collect())
    }

    /// The times that beams have by a clock.
    fn asked_times(&self, times: &[f64], clock: Clock) -> Vec<f64> {
        match (clock.is_of_sequence, self.channels()) {
            (true, Some(channels)) => {
                let first = |sequence: &[f64]| sequence.iter().copied().fold(f64::INFINITY, f64::min);
                times.chunks(channels).flat_map(|sequence| vec![first(sequence); sequence.len()]).collect()
            }
            _ => times.to_vec(),
        }
    }

    /// The field that has the channel, and the rule in words; a pattern without channels has none.
    pub(super) fn channel_field<'c>(
        &self,
        cloud: &'c Cloud,
    ) -> Option<(Option<&'c CloudColumn>, &'static str)> {
        let of_channel = cloud.column("channel").or_else(|| cloud.column("line"));
        match (of_channel, cloud.column("ring")) {
            _ if self.channels().is_none() => Some((None, "by time")),
            (Some(column), None) => Some((Some(column), BY_CHANNEL)),
            // With both fields, the ring is what consumers read.
            (_, Some(column)) => Some((Some(column), BY_RING)),
            (None, None) => None,
        }
    }

    /// Whether the field `ring` is the row of a pattern without elevations: beside Ouster's field `t`, whose driver has a row for each ring.
    pub(super) fn has_rows_as_rings(&self, cloud: &Cloud) -> bool {
        let has_elevations = self.scan.is_some_and(|scan| scan.elevations_deg.is_some());
        !has_elevations && usual_ring(cloud) == Ring::FromAbove
    }

    /// The channel, in the order of the manual, of each number.
    pub(super) fn channel_of_number(&self, keys: Keys) -> Vec<usize> {
        let channels = self.channels().unwrap_or(1);
        let elevations = self.scan.and_then(|scan| scan.elevations_deg.as_ref());
        let mut channel_of: Vec<usize> = (0..channels).collect();
        if let Some(elevations) = elevations {
            let ranks = ranks(elevations);
            let key = |channel: usize| match keys.ring {
                Ring::FromBelow => ranks[channel] as usize,
                Ring::FromAbove => channels - 1 - ranks[channel] as usize,
                Ring::Channel => channel,
                Ring::ChannelReversed => channels - 1 - channel,
            };
            (0..channels).for_each(|channel| channel_of[key(channel)] = channel);
        }
        if let Some([a, b]) = keys.exchanged {
            for channel in &mut channel_of {
                *channel = match *channel {
                    own if own == a => b,
                    own if own == b => a,
                    own => own,
                };
            }
        }
        channel_of
    }

    /// Numbers from which channels may be counted in place of 0, the nearest to 0 first: with each of them the numbers of all points are
    /// those of channels.
    pub(super) fn other_beginnings(&self, cloud: &Cloud, is_point: &[bool]) -> Vec<i64> {
        let (Some((Some(column), _)), Some(channels)) = (self.channel_field(cloud), self.channels()) else {
            return Vec::new();
        };
        let numbers =
            || (0..is_point.len()).filter(|&point| is_point[point]).map(|point| column.values[point]);
        let (least, most) =
            (numbers().fold(f64::INFINITY, f64::min), numbers().fold(f64::NEG_INFINITY, f64::max));
        // No field of a ring or channel has more than 16 bits.
        if !(least..=most).contains(&least) || least.abs().max(most.abs()) > f64::from(u16::MAX) {
            return Vec::new();
        }
        let first = most as i64 - (channels as i64 - 1);
        let mut found: Vec<i64> = (first..=least as i64).filter(|from| *from != 0).collect();
        found.sort_by_key(|from| from.abs());
        found
    }

    /// How much too late the times of a cloud may be, seconds, by a clock that is right otherwise: those by which its first point has
    /// the time of the first ray, or its last that of the last.
    pub(super) fn lateness(&self, cloud: &Cloud, is_point: &[bool], clock: Clock) -> Vec<f64> {
        let Some(times) = self.times() else { return Vec::new() };
        let Some(field) = self.time_field(cloud, &times) else { return Vec::new() };
        let stated =
            || (0..is_point.len()).filter(|&point| is_point[point]).map(|point| field.seconds(point, clock));
        let least = |times: &mut dyn Iterator<Item = f64>| times.fold(f64::INFINITY, f64::min);
        let most = |times: &mut dyn Iterator<Item = f64>| times.fold(f64::NEG_INFINITY, f64::max);
        let of_clock = self.asked_times(&times, clock);
        let asked = || of_clock.iter().copied();
        let found = [least(&mut stated()) - least(&mut asked()), most(&mut stated()) - most(&mut asked())];
        found.into_iter().filter(|late| late.is_finite() && *late != 0.0).collect()
    }

    /// Other units that the field of the time may be in, and one time for each firing sequence: in words.
    pub(super) fn other_clocks(&self, cloud: &Cloud) -> Vec<(String, Clock)> {
        const UNITS: [(&str, f64); 4] =
            [("seconds", 1.0), ("milliseconds", 1e-3), ("microseconds", 1e-6), ("nanoseconds", 1e-9)];
        let Some(times) = self.times() else { return Vec::new() };
        let Some(field) = self.time_field(cloud, &times) else { return Vec::new() };
        let right = UNITS.iter().find(|(_, unit)| *unit == field.unit).map_or("seconds", |(name, _)| *name);
        let others = UNITS.iter().filter(|(_, unit)| *unit != field.unit).map(|(name, unit)| {
            let words = format!("the field {} is in {name}: it counts {right}", field.name);
            (words, Clock { unit: unit / field.unit, ..Clock::RIGHT })
        });
        let of_sequence = self.channels().filter(|channels| *channels > 1).map(|_| {
            let words = "all points of a firing sequence have the time of its first ray: each has that of its own firing";
            (words.to_string(), Clock { is_of_sequence: true, ..Clock::RIGHT })
        });
        others.chain(of_sequence).collect()
    }

    /// The one time that all points have, as the field has it, where their rays have several.
    pub(super) fn only_time(&self, cloud: &Cloud, is_point: &[bool]) -> Option<f64> {
        let times = self.times()?;
        let field = self.time_field(cloud, &times)?;
        let mut stated =
            (0..is_point.len()).filter(|&point| is_point[point]).map(|point| field.column.values[point]);
        let first = stated.next()?;
        let is_one = stated.clone().count() > 0 && stated.all(|time| time == first);
        (is_one && times.iter().any(|time| *time != times[0])).then_some(first)
    }

    /// Two channels, in the order of the manual, whose numbers are exchanged by the elevations of the points: those of either lie where
    /// the other looks, and those of all others where their own does.
    pub(super) fn exchanged(
        &self,
        cloud: &Cloud,
        (points, is_point): (&[DVec3], &[bool]),
        (frame, keys): (CloudFrame, Keys),
    ) -> Option<[usize; 2]> {
        let scan = self.scan?;
        let (Some(column), _) = self.channel_field(cloud)? else { return None };
        let channel_of = self.channel_of_number(keys);
        let times = self.times()?;
        let time = self.time_field(cloud, &times)?;
        let mut votes = Votes::new(scan, self.channels()?, &|channel| self.rays[channel * self.places])?;
        let every = points.len().div_ceil(MAX_MEASURED).max(1);
        for point in (0..points.len()).step_by(every).filter(|&point| is_point[point]) {
            let Some(channel) = keys.channel(column, point, &channel_of) else { continue };
            let Some(pose) = scan.mounting.at(time.seconds(point, keys.clock)) else { continue };
            let of_sensor = match frame {
                CloudFrame::Sensor => points[point],
                CloudFrame::Mesh => pose.inverse() * points[point],
                CloudFrame::SensorAtStart => pose.inverse() * (scan.ends[0] * points[point]),
                CloudFrame::SensorAtEnd => pose.inverse() * (scan.ends[1] * points[point]),
            };
            votes.add(channel, of_sensor);
        }
        votes.exchanged()
    }
}

/// Which channel the points of each channel lie on, by their elevation in the sensor's frame.
pub(super) struct Votes<'a> {
    elevations_deg: &'a [f64],
    /// Heights of the emitters above the sensor's origin.
    heights: Vec<f64>,
    counts: Vec<Vec<u32>>,
}

impl<'a> Votes<'a> {
    /// `None` without elevations. `first_ray` gives a ray of each channel.
    pub(super) fn new(scan: &'a Scan, channels: usize, first_ray: &dyn Fn(usize) -> CastRay) -> Option<Self> {
        let elevations_deg = scan.elevations_deg.as_deref()?;
        let height = |channel: usize| scan.in_pattern(channel, &first_ray(channel)).origin.z;
        (elevations_deg.len() == channels).then(|| Self {
            elevations_deg,
            heights: (0..channels).map(height).collect(),
            counts: vec![vec![0; channels]; channels],
        })
    }

    /// A point in the sensor's frame, of a channel.
    pub(super) fn add(&mut self, channel: usize, point: DVec3) {
        let level = libm::hypot(point.x, point.y);
        let off = |other: usize| {
            let elevation = libm::atan2(point.z - self.heights[other], level).to_degrees();
            (self.elevations_deg[other] - elevation).abs()
        };
        // Of channels at one elevation the point's own.
        let nearest = (0..self.elevations_deg.len())
            .fold(channel, |best, other| if off(other) < off(best) { other } else { best });
        self.counts[channel][nearest] += 1;
    }

    /// Two channels whose points lie on each other's, where all others lie on their own.
    pub(super) fn exchanged(&self) -> Option<[usize; 2]> {
        let most = |(channel, counts): (usize, &Vec<u32>)| {
            let all: u32 = counts.iter().sum();
            match (0..counts.len()).find(|&other| 2 * counts[other] > all) {
                Some(other) => Some(other),
                // A channel without points says nothing against it.
                None if all == 0 => Some(channel),
                None => None,
            }
        };
        let lies: Vec<usize> = self.counts.iter().enumerate().map(most).collect::<Option<_>>()?;
        let moved: Vec<usize> = (0..lies.len()).filter(|&channel| lies[channel] != channel).collect();
        match moved[..] {
            [a, b] if lies[a] == b && lies[b] == a => Some([a, b]),
            _ => None,
        }
    }
}
