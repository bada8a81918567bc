//! What a simulator of a sensor may do otherwise, undone on the points of its cloud or in the rays that are asked.

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_scene::pattern::Mounting;
use raypencil_scene::{CastRay, Pose, Sides};

use super::fit::{least, median, rounded};
use super::limits::{of_ranges, of_steps};
use super::list::{List, along, laid, parts, scaled, set_poses};
use super::places::{of_exchanged_channels, of_order, of_returns};
use super::read::{CloudCase, pose_of};
use super::turn::{Turn, azimuth_deg, turned, wrapped_deg};
use crate::cloud::CloudFrame;
use crate::comparison::Stated;
use crate::pack::lengths::numbers_of;
use crate::pack::mistakes::OfCloud;
use crate::pack::scan::{Scan, moved};
use crate::pack::trial::Trial;

/// Rays from which a number is estimated, at most.
const MAX_FITTED: usize = 200;

/// Least cosine by which a length is divided.
const MIN_COSINE: f64 = 1e-3;

/// Units of length that are taken for another one, and the factor to the mesh's.
const LENGTHS: [(&str, f64); 4] = [
    ("lengths are in thousandths of the mesh's unit", 1e-3),
    ("lengths are in hundredths of the mesh's unit", 1e-2),
    ("lengths are in thousands of the mesh's unit", 1e3),
    ("lengths are in feet", 0.3048),
];

/// Points in another order.
const DIRECTED: &str = "points are not in the order of the rays: their directions tell which is whose";

/// A cosine between a ray, by its index, and what a length is measured along.
type Cosine<'a> = Box<dyn Fn(usize, &CastRay) -> f64 + 'a>;

/// The mistakes that a cloud may have.
pub(in crate::pack) fn of_cloud<'a>(
    case: &'a CloudCase<'a>,
    exact: &'a ExactCast<'a>,
    sides: Sides,
) -> OfCloud<'a> {
    let mut list = List { extras: Vec::new() };
    for (words, part) in &case.otherwise {
        list.add(words.as_str(), true, move |trial| laid(trial, part));
    }
    if let Some(beams) = case.beams {
        of_returns(&mut list, case, beams);
    }
    let words_of = |list: &List<'_>, from: usize| -> Vec<String> {
        list.extras[from..].iter().map(|extra| extra.words.clone()).collect()
    };
    let mut words_laid = words_of(&list, 0);
    if let Some(scan) = case.scan {
        of_frames(&mut list, case, scan);
        let from = list.extras.len();
        of_order(&mut list, case, scan);
        words_laid.extend(words_of(&list, from));
        of_head(&mut list, case, scan);
        of_motion(&mut list, case, scan);
        of_depth(&mut list, case, scan);
    }
    for (words, factor) in LENGTHS {
        list.add_factor(words, true, move |trial| scaled(trial, factor));
    }
    list.add("points at (0, 0, 0) mean no hit: declare --miss 0", true, |trial| {
        for point in parts(trial).iter_mut().filter(|point| **point == DVec3::ZERO) {
            *point = DVec3::NAN;
        }
    });
    of_axes(&mut list);
    // These explain much: a head that turns otherwise gives points that other rays have.
    for (words, part) in &case.backwards {
        list.add(words.as_str(), true, move |trial| laid(trial, part));
    }
    words_laid.extend(case.backwards.iter().map(|(words, _)| words.clone()));
    words_laid.push(DIRECTED.into());
    let estimated = move |trial: &Trial| {
        let mut list = List { extras: Vec::new() };
        estimate(&mut list, trial, case, exact, sides);
        if let Some(part) = &case.directed {
            list.add(DIRECTED, true, move |trial| laid(trial, part));
        }
        list.extras
    };
    // A ray without a length meets what is there if its end is ignored: that explains no return that is none.
    let has_ends = case.beams.is_none();
    OfCloud {
        part: &case.part,
        extras: list.extras,
        laid: words_laid,
        estimated: Box::new(estimated),
        has_ends,
    }
}

/// Frames of the points.
fn of_frames<'a>(list: &mut List<'a>, case: &'a CloudCase<'a>, scan: &'a Scan) {
    let is_here = scan.mounting == Mounting::HERE;
    for frame in CloudFrame::ALL {
        let is_one_with_sensor =
            matches!(frame, CloudFrame::SensorAtStart | CloudFrame::SensorAtEnd) && !scan.is_moving();
        let is_other = frame != case.frame && !is_one_with_sensor;
        if is_other && !is_here {
            let words =
                format!("points are in the frame of {}: declare --frame {}", frame.words(), frame.option());
            list.add(words, true, move |trial| set_poses(trial, |index| pose_of(Some(scan), frame, index)));
        }
    }
    if is_here {
        return;
    }
    if scan.is_moving() && case.frame == CloudFrame::Mesh {
        for (which, end) in ["start", "end"].into_iter().zip(scan.ends) {
            let words = format!(
                "points are placed on the mesh by the sensor's pose at the {which} of the scan: each has the pose of its own time"
            );
            list.add(words, true, move |trial| {
                let end = end.inverse();
                set_poses(trial, |index| Some(scan.pose(index) * end));
            });
        }
    }
    let at = move |index: usize| pose_of(Some(scan), case.frame, index).unwrap_or_else(|| scan.pose(index));
    list.add(
        "the sensor's pose is applied the other way round: as that of the mesh in the sensor's frame",
        false,
        move |trial| {
            set_poses(trial, |index| match case.frame {
                // The inverse in place of the pose, from the sensor's frame.
                CloudFrame::Mesh => Some(at(index) * at(index)),
                _ => Some(at(index).inverse()),
            });
        },
    );
    list.add("the sensor's position is left out: its rotation alone is applied", false, move |trial| {
        set_poses(trial, |index| {
            let position = at(index).position;
            match case.frame {
                CloudFrame::Mesh => Some(Pose::from_position(position)),
                _ => Some(Pose { position: DVec3::ZERO, ..at(index) }),
            }
        });
    });
    list.add("the sensor's rotation is left out: its position alone is applied", false, move |trial| {
        set_poses(trial, |index| {
            let pose = at(index);
            match case.frame {
                CloudFrame::Mesh => Some(pose * Pose::from_position(-pose.position)),
                _ => Some(Pose::from_position(pose.position)),
            }
        });
    });
}

/// Rules of a spinning head.
fn of_head<'a>(list: &mut List<'a>, case: &'a CloudCase<'a>, scan: &'a Scan) {
    let starts_off = |(index, ray): (usize, &CastRay)| scan.in_pattern(index, ray).origin.length() > 1e-9;
    if case.rays.iter().enumerate().any(starts_off) {
        let words = "rays start at the sensor's origin: the offsets of the emitters are left out";
        list.add_ray(words, true, scan, |_, ray| CastRay { origin: DVec3::ZERO, ..ray });
        let words = "points are the range along their ray from the sensor's origin: the offsets of the emitters are left out";
        list.add(words, true, move |trial| {
            let Some(cloud) = &mut trial.cloud else { return };
            for (k, &index) in trial.indices.iter().enumerate() {
                let pose = scan.pose(index);
                let offset = case.rays[index].origin - pose.position;
                let point = cloud.point(k).0 + offset;
                cloud.raw[k] = cloud.pose[k].map_or(point, |pose| pose.inverse() * point);
            }
        });
    }
    let Some(turn) = Turn::of(scan, case.shape, case.rays) else { return };
    let Turn { channels, step_deg, .. } = turn;
    let sense = if step_deg > 0.0 { "to the left" } else { "to the right, clockwise" };
    let turn = std::rc::Rc::new(turn);
    let of_turn = std::rc::Rc::clone(&turn);
    list.add_ray(format!("the head turns the other way: it turns {sense}"), true, scan, move |index, ray| {
        turned(&ray, -2.0 * step_deg * of_turn.sequences(scan.time(index)))
    });
    for (words, by) in [("late", -1.0), ("early", 1.0)] {
        let words = format!(
            "the head stands one azimuth step {words}: the first sequence looks where the pattern begins"
        );
        list.add_ray(words, true, scan, move |_, ray| turned(&ray, by * step_deg));
    }
    let words = "the head stands still during a firing sequence: it turns on from one channel to the next";
    list.add_ray(words, false, scan, move |index, ray| {
        let begun = turn.sequences(scan.time(index));
        turned(&ray, -step_deg * (begun - (index / channels) as f64))
    });
}

/// Poses of a moving head.
fn of_motion<'a>(list: &mut List<'a>, case: &'a CloudCase<'a>, scan: &'a Scan) {
    let Mounting::Moving(poses) = &scan.mounting else { return };
    let [of_first, of_last] = scan.ends;
    let held = move |index: usize| {
        let time = scan.time(index);
        let after = poses.poses().partition_point(|pose| pose.time_s <= time);
        poses.poses()[after.saturating_sub(1)].pose
    };
    let mut add = |words: &str, pose: Box<dyn Fn(usize) -> Pose + 'a>| {
        list.add(words, true, move |trial| posed(trial, case, scan, &pose));
    };
    add(
        "the pose of the scan's start is taken for all rays: each has the pose of its own time",
        Box::new(move |_| of_first),
    );
    add(
        "the pose of the scan's end is taken for all rays: each has the pose of its own time",
        Box::new(move |_| of_last),
    );
    add("poses are held until the next one: between two of them they are interpolated", Box::new(held));
}

/// Fires the rays of a trial from other poses. Points in the sensor's frame are seen from these too.
fn posed(trial: &mut Trial, case: &CloudCase<'_>, scan: &Scan, pose: &dyn Fn(usize) -> Pose) {
    for (&index, ray) in trial.indices.iter().zip(&mut trial.rays) {
        *ray = moved(&pose(index), &scan.in_pattern(index, ray));
    }
    if case.frame == CloudFrame::Sensor {
        set_poses(trial, |index| Some(pose(index)));
    }
}

/// Depths and level distances in place of ranges.
fn of_depth<'a>(list: &mut List<'a>, case: &'a CloudCase<'a>, scan: &'a Scan) {
    let axis = move |index: usize, ray: &CastRay| {
        let along = scan.in_pattern(index, ray).direction;
        along.x / along.length()
    };
    let level = move |index: usize, ray: &CastRay| {
        let along = scan.in_pattern(index, ray).direction;
        libm::hypot(along.x, along.y) / along.length()
    };
    let cosines: [(&str, Cosine<'a>); 2] =
        [("depth along the sensor's x axis", Box::new(axis)), ("level distance", Box::new(level))];
    for (what, cosine) in cosines {
        let cosine = std::rc::Rc::new(cosine);
        let safe = |cosine: f64| if cosine.abs() < MIN_COSINE { f64::NAN } else { cosine };
        let of_point = std::rc::Rc::clone(&cosine);
        list.add(
            format!("points stand at the {what}, along their rays: it is taken for the range"),
            true,
            move |trial| {
                along(trial, |index, ray, length| length / safe(of_point(index, ray)));
            },
        );
        let of_point = std::rc::Rc::clone(&cosine);
        list.add(
            format!("the range is taken for the {what}: points stand too far along their rays"),
            true,
            move |trial| {
                along(trial, |index, ray, length| length * of_point(index, ray));
            },
        );
        if case.facts.has_range {
            list.add(format!("the field range holds the {what}"), true, move |trial| {
                let Trial { rays, indices, stated, .. } = trial;
                let factors: Vec<f64> = indices
                    .iter()
                    .zip(rays.iter())
                    .map(|(&index, ray)| safe(cosine(index, ray)).recip())
                    .collect();
                stated.range.iter_mut().flatten().zip(&factors).for_each(|(range, factor)| *range *= factor);
                let errors = stated.stored.range.iter_mut().flatten();
                errors.zip(&factors).for_each(|(error, factor)| *error *= factor.abs().max(1.0));
            });
        }
    }
}

/// All ways to name and turn three axes, but the right one.
fn of_axes(list: &mut List<'_>) {
    // The usual ones first: swapped, mirrored, y up, and the axes of a camera (x right, y down, z ahead).
    let usual: [([usize; 3], [f64; 3]); 9] = [
        ([1, 0, 2], [1.0, 1.0, 1.0]),
        ([0, 2, 1], [1.0, 1.0, 1.0]),
        ([2, 1, 0], [1.0, 1.0, 1.0]),
        ([0, 1, 2], [1.0, -1.0, 1.0]),
        ([0, 1, 2], [-1.0, 1.0, 1.0]),
        ([0, 1, 2], [1.0, 1.0, -1.0]),
        ([0, 2, 1], [1.0, 1.0, -1.0]),
        ([0, 2, 1], [1.0, -1.0, 1.0]),
        ([1, 2, 0], [-1.0, -1.0, 1.0]),
    ];
    let orders = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
    let sign = |bits: u32| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { -1.0 } else { 1.0 });
    let all = orders.into_iter().flat_map(|order| (0..8).map(move |bits| (order, sign(bits))));
    let others = all.filter(|one| !usual.contains(one) && *one != ([0, 1, 2], [1.0; 3]));
    for (k, (order, signs)) in usual.into_iter().chain(others).enumerate() {
        let name = |axis: usize| {
            format!("{}{}", if signs[axis] < 0.0 { "-" } else { "" }, ["x", "y", "z"][order[axis]])
        };
        let words =
            format!("x, y, z of the points hold {}, {}, {} of their frame", name(0), name(1), name(2));
        list.add(words, k < usual.len(), move |trial| {
            for point in parts(trial) {
                let mut right = [0.0; 3];
                (0..3).for_each(|axis| right[order[axis]] = signs[axis] * point[axis]);
                *point = DVec3::from_array(right);
            }
        });
    }
}

/// Units of the field `range`: numbers for one of the mesh's unit, and words.
const UNITS_OF_RANGE: [(f64, &str); 4] = [
    (1000.0, "thousandths of the mesh's unit"),
    (100.0, "hundredths of the mesh's unit"),
    (0.001, "thousands of the mesh's unit"),
    (1.0 / 0.3048, "feet"),
];

/// A factor and a length by which the field `range` alone is off, beside points that are right.
fn estimate_field(list: &mut List<'_>, trial: &Trial, range_of: &dyn Fn(&CastRay) -> Option<f64>) {
    let Some(field) = &trial.stated.range else { return };
    let t = trial.stated.t.iter().flatten();
    // A ray without a point has no range.
    let of_misses = field.iter().zip(t).filter(|(_, t)| !t.is_finite()).map(|(range, _)| *range);
    let mut of_misses = of_misses.filter(|range| !range.is_nan());
    if let Some(number) =
        of_misses.next().filter(|number| number.is_finite() && of_misses.all(|other| other == *number))
    {
        let words = format!("{number} in the field range means no hit: declare --miss {number}");
        list.add(words, true, move |trial| {
            let Stated { t, range, .. } = &mut trial.stated;
            let pairs = range.iter_mut().flatten().zip(t.iter().flatten());
            pairs.filter(|(_, t)| !t.is_finite()).for_each(|(range, _)| *range = f64::INFINITY);
        });
    }
    let every = trial.rays.len().div_ceil(MAX_FITTED).max(1);
    let some = (0..trial.rays.len()).step_by(every).filter(|&k| field[k].is_finite());
    let pairs: Vec<(f64, f64)> = some.filter_map(|k| Some((field[k], range_of(&trial.rays[k])?))).collect();
    let middle = |of: fn(&(f64, f64)) -> f64| median(pairs.iter().map(of).collect());
    let (Some(offset), Some(factor)) =
        (middle(|(stated, exact)| stated - exact), middle(|(stated, exact)| stated / exact))
    else {
        return;
    };
    for by in rounded(offset) {
        let way = if by > 0.0 { "long" } else { "short" };
        list.add(format!("the field range is {} too {way}", by.abs()), false, move |trial| {
            trial.stated.range.iter_mut().flatten().for_each(|range| *range -= by);
        });
    }
    let mut add_factor = |words: String, by: f64| {
        list.add(words, false, move |trial| {
            let stated = &mut trial.stated;
            let numbers = [&mut stated.range, &mut stated.stored.range].into_iter().flatten().flatten();
            numbers.for_each(|number| *number /= by);
        });
    };
    // A unit is told as such, with its own factor.
    if let Some((by, unit)) = UNITS_OF_RANGE.iter().find(|(by, _)| (factor / by - 1.0).abs() < 1e-5) {
        return add_factor(format!("the field range is in {unit}"), *by);
    }
    for by in rounded(factor).into_iter().filter(|by| *by > 0.0 && *by != 1.0) {
        add_factor(format!("the field range is {by} times what it is"), by);
    }
}

/// Mistakes with a number.
fn estimate<'a>(
    list: &mut List<'a>,
    trial: &Trial,
    case: &'a CloudCase<'a>,
    exact: &'a ExactCast<'a>,
    sides: Sides,
) {
    let Some(cloud) = &trial.cloud else { return };
    let every = trial.rays.len().div_ceil(MAX_FITTED).max(1);
    let some: Vec<usize> =
        (0..trial.rays.len()).step_by(every).filter(|&k| cloud.raw[k].is_finite()).collect();
    let range_of = |ray: &CastRay| {
        let read = exact.reading(ray, sides);
        let face = *read.hit()?.first()?;
        Some(exact.meeting(ray, face)?.range().double)
    };
    let exact_of: Vec<(usize, f64)> =
        some.iter().filter_map(|&k| Some((k, range_of(&trial.rays[k])?))).collect();
    let stated_of = |k: usize| (cloud.point(k).0 - trial.rays[k].origin).length();
    let pairs: Vec<[f64; 2]> = exact_of.iter().map(|&(k, exact)| [stated_of(k), exact]).collect();
    for (by, is_factor) in numbers_of(&pairs) {
        match is_factor {
            true => list.add_factor(format!("ranges are {by} times what they are"), false, move |trial| {
                along(trial, |_, _, length| length / by);
            }),
            false => {
                let words =
                    format!("ranges are {} too {}", by.abs(), if by > 0.0 { "long" } else { "short" });
                list.add(words, false, move |trial| along(trial, |_, _, length| length - by));
            }
        }
    }
    estimate_field(list, trial, &range_of);
    of_ranges(list, trial, exact, sides);
    of_steps(list, trial, &exact_of);
    let Some(scan) = case.scan else { return };
    of_exchanged_channels(list, trial, case, scan);
    for by in start_angle(trial, &some, scan).map_or_else(Vec::new, rounded) {
        let side = if by > 0.0 { "left" } else { "right" };
        let words = format!("the pattern begins {} degrees to the {side} of where it is asked to", by.abs());
        list.add_ray(words, false, scan, move |_, ray| turned(&ray, by));
    }
    let Mounting::Moving(poses) = &scan.mounting else { return };
    let [first, last] = poses.span_s();
    let times = || some.iter().map(|&k| scan.time(trial.indices[k]));
    let (earliest, latest) =
        (times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max));
    let asked: Vec<CastRay> =
        some.iter().map(|&k| scan.in_pattern(trial.indices[k], &trial.rays[k])).collect();
    let residuals = |by: f64| {
        let of = |(&k, asked): (&usize, &CastRay)| {
            let pose = scan.mounting.at(scan.time(trial.indices[k]) + by)?;
            let ray = moved(&pose, asked);
            let t = range_of(&ray)? / ray.direction.length();
            let is_of_sensor = case.frame == CloudFrame::Sensor;
            let point = if is_of_sensor { pose * cloud.raw[k] } else { cloud.point(k).0 };
            Some(ray.origin + ray.direction * t - point)
        };
        some.iter().zip(&asked).map(|pair| of(pair).unwrap_or(DVec3::NAN)).collect()
    };
    // A hundred-thousandth of the poses' time: small beside it, and far above the rounding of times.
    let found = least(residuals, (last - first) * 1e-5, [first - earliest, last - latest]);
    for by in found.map_or_else(Vec::new, rounded) {
        let words =
            format!("poses are those of {} s {}", by.abs(), if by > 0.0 { "later" } else { "earlier" });
        list.add(words, false, move |trial| {
            posed(trial, case, scan, &|index| {
                scan.mounting.at(scan.time(index) + by).unwrap_or_else(|| scan.pose(index))
            });
        });
    }
}

/// Angle by which the points stand to the left of their rays about the sensor's z axis, degrees.
fn start_angle(trial: &Trial, some: &[usize], scan: &Scan) -> Option<f64> {
    let cloud = trial.cloud.as_ref()?;
    let seen = |&k: &usize| {
        let index = trial.indices[k];
        (scan.pose(index).inverse() * cloud.point(k).0, scan.in_pattern(index, &trial.rays[k]))
    };
    let seen: Vec<(DVec3, CastRay)> = some.iter().map(seen).collect();
    let mut found = 0.0;
    // Emitters stand off the axis: the origin turns too, so that each step gives more digits.
    for _ in 0..6 {
        let off = |(point, ray): &(DVec3, CastRay)| {
            let ray = turned(ray, found);
            wrapped_deg(azimuth_deg(*point - ray.origin) - azimuth_deg(ray.direction))
        };
        found += median(seen.iter().map(off).collect())?;
    }
    Some(wrapped_deg(found))
}
