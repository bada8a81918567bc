//! A file of a cloud: its points on the rays of a pack, and what is stated by them.

use std::path::Path;

use glam::DVec3;
use raypencil_files::FileError;
use raypencil_mesh_io::{Cloud, CloudColumn, CloudStorage};
use raypencil_scene::{CastRay, Precision};

use super::assign::{Asked, Assigned, BY_DIRECTION, OfFields, Order, number_of_return, too_many, unclear};
use super::beams::Beams;
use super::each_key::EachKey;
use super::file;
use super::fit::rounded;
use super::keys::{BY_CHANNEL, BY_RING, Clock, Keys, is_key, usual_ring};
use super::numbers::{NUMBER_RULES, wrong_numbers};
use super::rules::{Places, assigned, backwards, by_direction, rings, swapped};
use crate::cloud::CloudFrame;
use crate::comparison::{CastValue, Stated, StoredErrors};
use crate::pack::candidate::CandidateConventions;
use crate::pack::scan::Scan;
use crate::pack::trial::CloudPart;

/// What was read of a cloud, for reports.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudFacts {
    /// The frame that its points are taken to be in.
    pub frame: CloudFrame,
    /// Which message of a bag it is, in words; `None`: a file of its own.
    pub source: Option<String>,
    /// Number of its points, without those that stand for no hit.
    pub points: usize,
    /// Returns that may be told of each beam; `None`: rays stand for themselves.
    pub returns_of_beam: Option<usize>,
    /// How they were laid on the rays, in words.
    pub assigned: &'static str,
    /// Indices of points that belong to no ray, or to one that has another point.
    pub strays: Vec<usize>,
    /// Whether the field `range` was judged too.
    pub has_range: bool,
    /// The steps in which coordinates and ranges are printed, in words, where these are coarser than single precision.
    pub steps: Option<String>,
    /// Number of the rays whose points agree by these steps alone.
    pub(in crate::pack) excused: u64,
    /// Names of the fields that tell the ray of a point and were judged, or laid the points on their rays.
    pub keys: Vec<String>,
    /// Names of such fields that were not judged: the pack knows nothing of them, or another field was judged in their place.
    pub unjudged: Vec<String>,
    /// Indices of the rays whose points have another ring, channel or time than theirs, as order or another time tells it.
    pub wrong_keys: Vec<usize>,
    /// What explains them.
    pub(in crate::pack) keys_why: Option<String>,
    /// Name of the field with the number of a point's return, if it was judged.
    pub number_field: Option<String>,
    /// Number of points whose number of a return was compared with that of their ray.
    pub(in crate::pack) numbered: usize,
    /// Indices of the rays whose points have another number of a return than that of theirs.
    pub wrong_numbers: Vec<usize>,
    /// What explains them.
    pub(in crate::pack) numbers_why: Option<String>,
}

impl CloudFacts {
    /// What explains all that the fields say otherwise, in words.
    pub(in crate::pack) fn why(&self) -> Option<String> {
        let of = |wrong: &[usize], why: &Option<String>| match wrong {
            [] => Some(None),
            _ => why.clone().map(Some),
        };
        let keys = of(&self.wrong_keys, &self.keys_why)?;
        let numbers = of(&self.wrong_numbers, &self.numbers_why)?;
        let words: Vec<String> = [keys, numbers].into_iter().flatten().collect();
        (!words.is_empty()).then(|| words.join(", and "))
    }

    /// What is wrong beside the points themselves, in words that follow a reason: what explains it, or that something else is wrong. `is_laid`: the reason lays points on other
    /// rays, which may be all that is wrong.
    pub(in crate::pack) fn beside(&self, reason: &str, is_laid: bool) -> String {
        let of_fields = [(&self.wrong_keys, &self.keys_why), (&self.wrong_numbers, &self.numbers_why)];
        let known = of_fields.iter().filter_map(|(_, why)| why.as_ref()).filter(|why| !reason.contains(*why));
        let words: String = known.map(|why| format!(", and {why}")).collect();
        let is_unknown = of_fields.iter().any(|(wrong, why)| !wrong.is_empty() && why.is_none());
        match !is_laid && (is_unknown || !self.strays.is_empty()) {
            true => format!("{words}; something else is wrong, too"),
            false => words,
        }
    }
}

/// A cloud on the rays of a pack.
pub(in crate::pack) struct CloudCase<'a> {
    pub(in crate::pack) shape: &'a [u64],
    pub(in crate::pack) rays: &'a [CastRay],
    pub(in crate::pack) scan: Option<&'a Scan>,
    /// What is known of the returns of beams; `None`: rays stand for themselves.
    pub(in crate::pack) beams: Option<&'a Beams>,
    /// Whether its points have numbers of returns.
    pub(in crate::pack) has_numbers: bool,
    pub(in crate::pack) frame: CloudFrame,
    pub(in crate::pack) part: CloudPart,
    pub(in crate::pack) facts: CloudFacts,
    /// The same points on the rays that another rule of order gives, and that rule in words.
    pub(in crate::pack) otherwise: Vec<(String, CloudPart)>,
    /// The same for orders that run from the last to the first.
    pub(in crate::pack) backwards: Vec<(String, CloudPart)>,
    /// The same for points that were laid by their order, each on the ray that its direction tells.
    pub(in crate::pack) directed: Option<CloudPart>,
    /// The field `range` and how far storing may have moved it, for each ray.
    ranges: Option<(Vec<f64>, Vec<f64>)>,
}

impl CloudCase<'_> {
    /// What the cloud states of the rays.
    pub(in crate::pack) fn stated(&self) -> Stated {
        let (range, of_storing) = self.ranges.clone().unzip();
        let coarse = self.facts.steps.iter().map(|steps| (CastValue::Point, steps.clone())).collect();
        let stored = StoredErrors { range: of_storing, coarse, ..StoredErrors::default() };
        let mut stated = Stated { range, stored, ..Stated::default() };
        self.part.state(self.rays, &mut stated);
        stated
    }

    /// The same, as if no number had been rounded when it was stored.
    pub(in crate::pack) fn stated_as_if_exact(&self) -> Stated {
        let range = self.ranges.as_ref().map(|(ranges, _)| ranges.clone());
        let mut stated = Stated { range, ..Stated::default() };
        let part = CloudPart { error: vec![0.0; self.part.error.len()], ..self.part.clone() };
        part.state(self.rays, &mut stated);
        stated
    }
}

/// Reads a cloud and lays its points on the rays.
pub(in crate::pack) fn read_cloud_of<'a>(
    path: &Path,
    (shape, rays): (&'a [u64], &'a [CastRay]),
    (scan, beams): (Option<&'a Scan>, Option<&'a Beams>),
    conventions: CandidateConventions<'_>,
) -> Result<CloudCase<'a>, FileError> {
    let choice = &conventions.cloud.choice;
    let (cloud, bag) = file::read(path, choice, |name| name == "range" || is_key(name))?;
    let fault = |fault: raypencil_files::Fault| FileError::Cloud(fault.in_file(path));
    let frame = conventions.cloud.frame;
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
    let is_miss =
        |k: usize| [x, y, z].iter().all(|axis| conventions.means_miss(axis.values[k], axis.error(k)));
    let is_point: Vec<bool> = (0..count).map(|k| points[k].is_finite() && !is_miss(k)).collect();
    let real = is_point.iter().filter(|&&is_point| is_point).count();
    let places = beams.map_or(1, Beams::places);
    let shape_of_beams = if places > 1 { &shape[..shape.len() - 1] } else { shape };
    let numbers = beams.map_or_else(Vec::new, Beams::told_numbers);
    let asked = Asked { shape: shape_of_beams, rays, scan, places, numbers: &numbers, bag: bag.as_ref() };
    let usual = usual_ring(&cloud);
    let by_direction = || by_direction(&asked, rays, (&points, &cloud, &is_point), frame);
    let angle = |point: usize, ray: usize| {
        let place = pose_of(scan, frame, ray).map_or(points[point], |pose| pose * points[point]);
        let (from, along) = (place - rays[ray].origin, rays[ray].direction);
        libm::atan2(from.cross(along).length(), from.dot(along))
    };
    let found =
        assigned(&asked, &cloud, &is_point, usual, Places { by_direction: &by_direction, angle: &angle });
    let strays = found.as_ref().map_or(real, |(found, _)| found.strays.len());
    let order = found.as_ref().and_then(|(_, order)| *order);
    let said = Said { asked: &asked, cloud: &cloud, is_point: &is_point, usual: Keys::of(usual) };
    let exchanged = || asked.exchanged(&cloud, (&points, &is_point), (frame, Keys::of(usual)));
    let (found, keys) = match found.map(|(found, _)| found) {
        Some(found) if found.is_clear(real) => (found, Keys::of(usual)),
        // Wrong times or numbers still tell the rays.
        laid => said.otherwise(&exchanged, real).ok_or_else(|| {
            let of_keys = asked.by_keys(&cloud, &is_point, Keys::of(usual));
            let only = asked.only_time(&cloud, &is_point);
            let known = of_keys.as_ref().filter(|_| only.is_none()).or(laid.as_ref());
            if let Some(too_many) = known.and_then(|known| too_many(known, real, places)) {
                return fault(too_many);
            }
            let of_fields = only.map_or(String::new(), |time| format!("; all have the same time, {time}"));
            let fields = match (asked.fired(Clock::RIGHT), &of_keys) {
                (None, _) => OfFields::NotOfPack,
                (Some(_), None) => OfFields::NotOfFile,
                (Some(_), Some(_)) => OfFields::Others,
            };
            fault(unclear(strays, real, (fields, &of_fields)))
        })?,
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
    let of =
        |other: Option<Assigned>| other.filter(|other| other.is_clear(real)).map(|other| part_of(&other));
    let with = |(words, other): (&'static str, Option<Assigned>)| Some((words.to_string(), of(other)?));
    let mut otherwise = Vec::new();
    if [BY_RING, BY_CHANNEL].contains(&found.by) {
        let of_ring = |(words, ring)| (words, asked.by_keys(&cloud, &is_point, Keys { ring, ..keys }));
        otherwise.extend(rings(usual).into_iter().map(of_ring).filter_map(with));
    }
    if keys.exchanged.is_none()
        && let Some(pair) = exchanged()
    {
        let other = asked.by_keys(&cloud, &is_point, Keys { exchanged: Some(pair), ..keys });
        otherwise.extend(of(other).map(|part| (exchanged_words(pair), part)));
    }
    let by_order = |(words, order)| (words, asked.by_order(&cloud, &is_point, order));
    if let Some(beams) = beams
        && places > 1
        && let Some(column) = number_of_return(&cloud)
        && found.by != BY_DIRECTION
    {
        for rule in &NUMBER_RULES {
            let numbers = rule.numbers(beams);
            let asked = Asked { numbers: &numbers, ..asked };
            let other = match order {
                Some(order) => asked.by_order(&cloud, &is_point, order),
                None => asked.by_keys(&cloud, &is_point, keys),
            };
            // Points whose numbers are none of the rule's take the places that are left: such a rule explains nothing.
            let other = other.filter(|other| other.has_numbers(&numbers, (column, &is_point), real));
            otherwise.extend(with((rule.words, other)));
        }
    }
    let (mut of_backwards, mut directed) = (Vec::new(), None);
    match order {
        // A list without an order of its own is held to none.
        None if found.by == BY_DIRECTION => {}
        None => {
            let words = "ring, channel or time of the points are not those of their rays, which the order of the points gives";
            let is_of_channels = asked.has_rows_of_channels(&cloud) == Some(true);
            otherwise.extend(with(by_order((words, Order { is_of_channels, ..Order::default() }))));
        }
        Some(order) => {
            otherwise.extend(with(by_order(swapped(order))));
            of_backwards.extend(backwards(order).into_iter().map(by_order).filter_map(with));
            directed = of(by_direction());
        }
    }
    let ranges = cloud.column("range").filter(|column| column.storage != CloudStorage::Whole).map(|column| {
        let of = |of: &Option<usize>| {
            of.map_or((f64::NAN, 0.0), |k| match conventions.means_miss(column.values[k], column.error(k)) {
                true => (f64::INFINITY, 0.0),
                false => (column.values[k], column.error(k)),
            })
        };
        found.point_of.iter().map(of).unzip()
    });
    // Keys that do not tell the rays are wrong themselves.
    let EachKey { wrong: wrong_keys, compared: keys } = said.of_rays(&found, Keys::of(usual));
    let keys_why = if wrong_keys.is_empty() { None } else { said.why(&found, &exchanged) };
    let of_returns = number_of_return(&cloud);
    let (numbered, wrong_numbers, numbers_why) = match (of_returns, beams) {
        (Some(column), Some(beams)) => wrong_numbers(&found, beams, (column, &is_point)),
        _ => (0, Vec::new(), None),
    };
    let of_numbers = of_returns.filter(|_| beams.is_some()).map(|column| &column.name);
    let is_unjudged = |name: &&String| is_key(name) && !keys.contains(name) && Some(*name) != of_numbers;
    let unjudged = cloud.columns.iter().map(|column| &column.name).filter(is_unjudged).cloned().collect();
    let number_field = of_numbers.filter(|_| numbered > 0).cloned();
    let facts = CloudFacts {
        number_field,
        wrong_keys,
        keys_why,
        numbered,
        wrong_numbers,
        numbers_why,
        frame,
        source: bag.as_ref().map(|bag| bag.words.clone()),
        points: real,
        returns_of_beam: beams.map(Beams::places),
        assigned: found.by,
        strays: found.strays,
        has_range: ranges.is_some(),
        steps: printed_steps([x, y, z].into_iter().chain(cloud.column("range")), &is_point),
        excused: 0,
        keys,
        unjudged,
    };
    Ok(CloudCase {
        shape,
        rays,
        scan,
        beams,
        has_numbers: of_returns.is_some(),
        frame,
        part,
        facts,
        otherwise,
        backwards: of_backwards,
        directed,
        ranges,
    })
}

/// The steps in which the numbers of columns are printed, in words; `None`: they are as fine as numbers of single precision.
fn printed_steps<'a>(columns: impl Iterator<Item = &'a CloudColumn>, is_point: &[bool]) -> Option<String> {
    let (mut finest, mut coarsest, mut largest) = (i32::MIN, i32::MAX, 0.0_f64);
    for column in columns {
        let CloudStorage::Decimal { decimals, .. } = &column.storage else { continue };
        for point in (0..is_point.len()).filter(|&point| is_point[point] && column.values[point] != 0.0) {
            finest = finest.max(decimals[point]);
            coarsest = coarsest.min(decimals[point]);
            largest = largest.max(column.values[point].abs());
        }
    }
    let step: f64 = format!("1e{}", -coarsest).parse().unwrap_or(0.0);
    // Neighbours of single precision stand at most this far apart.
    let of_single = largest * 2.0 * Precision::F32.unit_roundoff;
    let up_to = if finest == coarsest { "" } else { "up to " };
    (largest > 0.0 && step > of_single).then(|| format!("steps of {up_to}{step} m"))
}

/// What the fields of a cloud say of its points.
struct Said<'a> {
    asked: &'a Asked<'a>,
    cloud: &'a Cloud,
    is_point: &'a [bool],
    usual: Keys,
}

/// A pair of channels whose numbers are exchanged, if the elevations of the points say so.
type Exchanged<'a> = &'a dyn Fn() -> Option<[usize; 2]>;

impl Said<'_> {
    fn by(&self, keys: Keys) -> Option<Assigned> {
        self.asked.by_keys(self.cloud, self.is_point, keys)
    }

    /// Keys with a clock that is late, by the first and by the last point.
    fn late(&self, keys: Keys) -> impl Iterator<Item = Keys> {
        let lateness = self.asked.lateness(self.cloud, self.is_point, keys.clock);
        lateness.into_iter().map(move |late_s| Keys { clock: Clock { late_s, ..keys.clock }, ..keys })
    }

    /// Keys whose channels are counted from another number than 0.
    fn begun(&self) -> impl Iterator<Item = Keys> {
        let all = self.asked.other_beginnings(self.cloud, self.is_point);
        all.into_iter().map(|from| Keys { from, ..self.usual })
    }

    /// The points by fields that are wrong in a way that still tells their rays.
    fn otherwise(&self, exchanged: Exchanged<'_>, points: usize) -> Option<(Assigned, Keys)> {
        let of_clocks = self.asked.other_clocks(self.cloud).into_iter().flat_map(|(_, clock)| {
            let keys = Keys { clock, ..self.usual };
            std::iter::once(keys).chain(self.late(keys))
        });
        let of_exchange = || exchanged().map(|pair| Keys { exchanged: Some(pair), ..self.usual });
        let all = self
            .begun()
            .chain(self.late(self.usual))
            .chain(of_clocks)
            .chain(std::iter::once_with(of_exchange).flatten());
        all.filter_map(|keys| Some((self.by(keys)?, keys))).find(|(found, _)| found.is_clear(points))
    }

    /// The rays whose points have the keys of others.
    fn unlike(&self, found: &Assigned, keys: &Assigned) -> Vec<usize> {
        let pairs = found.point_of.iter().zip(&keys.point_of).enumerate();
        let is_unlike = |(found, of_keys): (&Option<usize>, &Option<usize>)| {
            found.is_some_and(|point| self.is_point[point]) && found != of_keys
        };
        pairs.filter(|(_, pair)| is_unlike(*pair)).map(|(ray, _)| ray).collect()
    }

    /// What the fields say of points on their rays: both together where they tell rays apart, else each by itself.
    fn of_rays(&self, found: &Assigned, keys: Keys) -> EachKey {
        let each = self.asked.each_key(self.cloud, (found, self.is_point), keys);
        match self.by(keys) {
            Some(of_keys) => EachKey { wrong: self.unlike(found, &of_keys), ..each },
            None => each,
        }
    }

    /// What explains keys that are not those of the rays, in words.
    fn why(&self, found: &Assigned, exchanged: Exchanged<'_>) -> Option<String> {
        let explains = |keys: Keys| {
            let EachKey { wrong, compared } = self.of_rays(found, keys);
            wrong.is_empty() && !compared.is_empty()
        };
        let of_ring = || {
            let all = rings(self.usual.ring);
            let ring = all.iter().find(|(_, ring)| explains(Keys { ring: *ring, ..self.usual }));
            ring.map(|(words, _)| (*words).to_string())
        };
        let of_exchange = || {
            let pair = exchanged().filter(|pair| explains(Keys { exchanged: Some(*pair), ..self.usual }))?;
            Some(exchanged_words(pair))
        };
        // The fewest decimals that explain the times of all.
        let of_lateness = |keys: Keys| {
            let near =
                self.late(keys).filter(|keys| explains(*keys)).flat_map(|keys| rounded(keys.clock.late_s));
            let of = |late_s: &f64| explains(Keys { clock: Clock { late_s: *late_s, ..keys.clock }, ..keys });
            let late = near.collect::<Vec<_>>().into_iter().find(of)?;
            let way = if late > 0.0 { "late" } else { "early" };
            Some(format!("the times of the points are {} s too {way}", late.abs()))
        };
        let of_clock = || {
            self.asked.other_clocks(self.cloud).into_iter().find_map(|(words, clock)| {
                let keys = Keys { clock, ..self.usual };
                if explains(keys) {
                    Some(words)
                } else {
                    Some(format!("{words}, and {}", of_lateness(keys)?))
                }
            })
        };
        let of_one_time = || {
            let time = self.asked.only_time(self.cloud, self.is_point)?;
            Some(format!("all points have the same time, {time}: each has that of its own firing"))
        };
        let of_beginning = || {
            let from = self.begun().find(|keys| explains(*keys))?.from;
            Some(format!("the numbers of channels count from {from}: they count from 0"))
        };
        of_ring()
            .or_else(of_beginning)
            .or_else(|| of_lateness(self.usual))
            .or_else(of_one_time)
            .or_else(of_clock)
            .or_else(of_exchange)
    }
}

fn exchanged_words([a, b]: [usize; 2]) -> String {
    format!("channels {a} and {b}, counted from 0 in the order of the manual, have each other's number")
}

/// The pose of a cloud's frame for a ray; `None`: it is the mesh's.
pub(super) fn pose_of(scan: Option<&Scan>, frame: CloudFrame, index: usize) -> Option<raypencil_scene::Pose> {
    let scan = scan?;
    match frame {
        CloudFrame::Mesh => None,
        CloudFrame::Sensor => Some(scan.pose(index)),
        CloudFrame::SensorAtStart => Some(scan.ends[0]),
        CloudFrame::SensorAtEnd => Some(scan.ends[1]),
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/cloud_facts.rs"]
mod tests;
