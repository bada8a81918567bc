//! Points that stand in the place of others: of another sequence, channel or return.

use glam::{DQuat, DVec3};

use super::beams::Beams;
use super::keys::Votes;
use super::list::{List, along};
use super::read::CloudCase;
use super::turn::{Turn, turned};
use crate::cloud::ranks;
use crate::pack::scan::{Scan, moved};
use crate::pack::trial::Trial;

/// The sequence and channel whose point stands in the place of these, if there is one.
type OtherPlace<'a> = Box<dyn Fn(usize, usize) -> Option<(usize, usize)> + 'a>;

/// Orders of the points, where their order lays them on rays.
pub(super) fn of_order<'a>(list: &mut List<'a>, case: &'a CloudCase<'a>, scan: &'a Scan) {
    let &[sequences, channels] = case.shape else { return };
    let (sequences, channels) = (sequences as usize, channels as usize);
    // Where channel and sequence of each point are: in the place of others.
    let mut add = |words: &'static str, from: OtherPlace<'a>| {
        list.add(words, true, move |trial| {
            let Some(cloud) = &mut trial.cloud else { return };
            for (k, &index) in trial.indices.iter().enumerate() {
                let place = from(index / channels, index % channels)
                    .filter(|(sequence, _)| *sequence < sequences)
                    .map(|(sequence, channel)| sequence * channels + channel);
                match place {
                    Some(place) => {
                        (cloud.raw[k], cloud.error[k]) = (case.part.raw[place], case.part.error[place])
                    }
                    None => cloud.raw[k] = DVec3::NAN,
                }
            }
        });
    };
    if scan.elevations_deg.is_some() {
        add(
            "points are one firing sequence late: each stands in the place of the sequence after its own",
            Box::new(|sequence, channel| Some((sequence + 1, channel))),
        );
        add(
            "points are one firing sequence early: each stands in the place of the sequence before its own",
            Box::new(|sequence, channel| Some((sequence.checked_sub(1)?, channel))),
        );
    }
    if let Some(elevations) =
        scan.elevations_deg.as_ref().filter(|_| case.facts.assigned.starts_with("by the order"))
    {
        let rank: Vec<usize> = ranks(elevations).into_iter().map(|rank| rank as usize).collect();
        let other = rank.clone();
        add(
            "the channels of each sequence are in the opposite order",
            Box::new(move |sequence, channel| Some((sequence, channels - 1 - channel))),
        );
        add(
            "the channels of each sequence are in the order of their elevation, the lowest first: it is that of the manual",
            Box::new(move |sequence, channel| Some((sequence, rank[channel]))),
        );
        add(
            "the channels of each sequence are in the order of their elevation, the highest first: it is that of the manual",
            Box::new(move |sequence, channel| Some((sequence, channels - 1 - other[channel]))),
        );
    }
}

/// Returns of beams with a width.
pub(super) fn of_returns<'a>(list: &mut List<'a>, case: &'a CloudCase<'a>, beams: &'a Beams) {
    let by_number = case.has_numbers && beams.places() > 1;
    if beams.places() > 1 {
        // With numbers it is their rule that lays the points: see `numbers`.
        if !by_number {
            let words = "the returns of a beam run from the farthest to the nearest";
            list.add(words, true, move |trial| {
                let Some(cloud) = &mut trial.cloud else { return };
                for (k, &place) in trial.indices.iter().enumerate() {
                    let (told, at) = beams.told_of_beam(place);
                    if at < told {
                        let other = place - at + (told - 1 - at);
                        (cloud.raw[k], cloud.error[k]) = (case.part.raw[other], case.part.error[other]);
                    }
                }
            });
        }
        // A rule holds for all beams that have fewer.
        let places = || 0..case.part.raw.len();
        if places().filter_map(|place| is_again(case, beams, place)).all(|is_again| is_again) {
            let words = "a beam with fewer returns has one of them again: its other places are empty";
            list.add(words, true, move |trial| {
                let Some(cloud) = &mut trial.cloud else { return };
                for (k, &place) in trial.indices.iter().enumerate() {
                    if is_again(case, beams, place) == Some(true) {
                        cloud.raw[k] = DVec3::NAN;
                    }
                }
            });
        }
    }
    for other in beams.others() {
        list.add(other.words.as_str(), true, move |trial| {
            for (ray, &place) in trial.rays.iter_mut().zip(&trial.indices) {
                *ray = beams.ray_by(place, other, by_number);
            }
        });
    }
    let words = "points stand on the middle of their beam, at the range of the return: they are those of its leading ray";
    list.add(words, true, move |trial| {
        let Some(cloud) = &mut trial.cloud else { return };
        for (k, (&place, ray)) in trial.indices.iter().zip(&trial.rays).enumerate() {
            let (point, _) = cloud.point(k);
            // One turn takes the middle to the leading ray, and the point with it.
            let turn = DQuat::from_rotation_arc(
                beams.middle(place).direction.normalize(),
                ray.direction.normalize(),
            );
            let point = ray.origin + turn * (point - ray.origin);
            cloud.raw[k] = cloud.pose[k].map_or(point, |pose| pose.inverse() * point);
        }
    });
    let words = "points stand at the mean range of their return: they are those of its leading ray";
    list.add(words, true, move |trial| {
        along(trial, |place, _, length| {
            beams.told(place).map_or(length, |told| length * (told.range / told.mean_range))
        });
    });
}

/// Whether a place has the point of a return of its beam again; `None`: it has a return of its own, or its beam has none.
fn is_again(case: &CloudCase<'_>, beams: &Beams, place: usize) -> Option<bool> {
    let (told, at) = beams.told_of_beam(place);
    let first = place - at;
    let same = |other: usize| case.part.raw[other] == case.part.raw[place];
    (told > 0 && at >= told).then(|| (first..first + told).any(same))
}

/// Two channels whose points lie on each other's elevation.
pub(super) fn of_exchanged_channels<'a>(
    list: &mut List<'a>,
    trial: &Trial,
    case: &'a CloudCase<'a>,
    scan: &'a Scan,
) {
    let (Some(cloud), &[_, channels]) = (&trial.cloud, case.shape) else { return };
    let channels = channels as usize;
    let Some(mut votes) = Votes::new(scan, channels, &|channel| case.rays[channel]) else { return };
    for (k, &index) in trial.indices.iter().enumerate().filter(|(k, _)| cloud.raw[*k].is_finite()) {
        votes.add(index % channels, scan.pose(index).inverse() * cloud.point(k).0);
    }
    let Some([a, b]) = votes.exchanged() else { return };
    let other = move |index: usize| match index % channels {
        channel if channel == a => index - a + b,
        channel if channel == b => index - b + a,
        _ => index,
    };
    let counted = "counted from 0 in the order of the manual";
    if case.facts.assigned.starts_with("by the order") {
        list.add(
            format!("the points of channels {a} and {b}, {counted}, are exchanged"),
            false,
            move |trial| {
                let Some(cloud) = &mut trial.cloud else { return };
                for (k, &index) in trial.indices.iter().enumerate() {
                    (cloud.raw[k], cloud.error[k]) =
                        (case.part.raw[other(index)], case.part.error[other(index)]);
                }
            },
        );
    }
    let Some(turn) = Turn::of(scan, case.shape, case.rays) else { return };
    let words =
        format!("channels {a} and {b}, {counted}, look where the other should: their angles are exchanged");
    list.add(words, false, move |trial| {
        for (ray, &index) in trial.rays.iter_mut().zip(&trial.indices) {
            let from = other(index);
            if from != index {
                let by = turn.sequences(scan.time(index)) - turn.sequences(scan.time(from));
                let asked = turned(&scan.in_pattern(from, &case.rays[from]), turn.step_deg * by);
                *ray = moved(&scan.pose(index), &asked);
            }
        }
    });
}
