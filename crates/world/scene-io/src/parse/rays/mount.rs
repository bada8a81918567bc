//! Where a pattern stands: the keys of a pose, or `poses` with times.

use glam::DVec3;
use serde::Deserialize;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

use raypencil_rosbag::PoseChoice;
use raypencil_scene::Pose;
use raypencil_scene::pattern::{Mounting, TimedPose, TimedPoses};

use crate::digest::NamedDigest;
use crate::parse::key::{Key, span};
use crate::parse::shared::{GLOBAL_M, TURN_DEG};
use crate::parse::source::Source;
use crate::resolve::turned;
use crate::scene_error::SceneIoError;
use crate::trajectory::{TIME_S, is_bag, read_trajectory};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TimedPoseKeys {
    time_s: Key<f64>,
    position_m: Key<Vec<f64>>,
    pitch_down_deg: Key<f64>,
    yaw_left_deg: Key<f64>,
    roll_right_deg: Key<f64>,
}

/// Keys that choose poses of a bag.
#[derive(Clone, Copy)]
pub(super) struct BagKeys<'k> {
    pub topic: &'k Key<String>,
    pub frames: &'k Key<Vec<String>>,
}

/// Keys of one pose: its position, and its yaw, pitch and roll.
pub(super) struct OnePose<'k> {
    position: &'k Key<Vec<f64>>,
    turns: [(&'static str, &'k Key<f64>); 3],
}

impl<'k> OnePose<'k> {
    pub(super) fn new(position: &'k Key<Vec<f64>>, [yaw, pitch, roll]: [&'k Key<f64>; 3]) -> Self {
        let turns = [("yaw_left_deg", yaw), ("pitch_down_deg", pitch), ("roll_right_deg", roll)];
        Self { position, turns }
    }

    /// The first key that is given, and its place.
    fn first_given(&self) -> Option<(&'static str, Range<usize>)> {
        let turns = self.turns.iter().map(|(name, key)| (*name, span(key)));
        std::iter::once(("position_m", span(self.position)))
            .chain(turns)
            .find_map(|(name, place)| Some((name, place?)))
    }
}

impl Source<'_> {
    /// Time of the first ray, if it is given.
    pub(super) fn start(&self, name: &str, key: &Key<f64>) -> Result<Option<f64>, SceneIoError> {
        self.optional(key, &format!("{name}.start_s"), TIME_S, "seconds")
    }

    /// Poses of the set `name` from a file, whose path is relative to the TOML file.
    pub(super) fn mounting_of_file(
        &self,
        name: &str,
        pose: &OnePose<'_>,
        (poses, file): (&Key<Vec<Spanned<TimedPoseKeys>>>, &Spanned<String>),
        choice: BagKeys<'_>,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<Mounting, SceneIoError> {
        let beside = poses.as_ref().map(|poses| ("poses", poses.span())).or_else(|| pose.first_given());
        if let Some((key, place)) = beside {
            let message = format!("`{name}.{key}` beside `poses_file`; expected one of the two");
            return Err(self.error(place, message));
        }
        let path = self.file.parent().unwrap_or(Path::new("")).join(file.get_ref());
        if !path.is_file() {
            let message = format!(
                "`{name}.poses_file`: there is no file \"{}\"; expected poses as TUM, CSV or MCAP, the path relative to this file",
                path.display()
            );
            return Err(self.error(file.span(), message));
        }
        if !is_bag(&path) {
            self.without_bag(name, choice)?;
        }
        let choice = PoseChoice {
            topic: choice.topic.as_ref().map(|topic| topic.get_ref().as_str()),
            frames: choice.frames.as_ref().map(|frames| self.frames(name, frames)).transpose()?,
        };
        let (timed, digest) = read_trajectory(&path, &choice)?;
        digests.push((file.get_ref().clone(), digest));
        let refused = |error| self.refused(file.span(), &error);
        Ok(Mounting::Moving(TimedPoses::new(timed, &format!("{name}.poses_file")).map_err(refused)?))
    }

    /// Refuses keys of a bag where there is none.
    pub(super) fn without_bag(&self, name: &str, choice: BagKeys<'_>) -> Result<(), SceneIoError> {
        let given = [("poses_topic", span(choice.topic)), ("poses_frames", span(choice.frames))];
        match given.into_iter().find_map(|(key, place)| Some((key, place?))) {
            Some((key, place)) => {
                let message = format!(
                    "`{name}.{key}` without a bag; expected it beside a `poses_file` that ends in .mcap"
                );
                Err(self.error(place, message))
            }
            None => Ok(()),
        }
    }

    /// Parent and child frame.
    fn frames<'k>(&self, name: &str, frames: &'k Spanned<Vec<String>>) -> Result<[&'k str; 2], SceneIoError> {
        match frames.get_ref().as_slice() {
            [parent, child] => Ok([parent, child]),
            other => {
                let message = format!(
                    "`{name}.poses_frames` has {} names; expected two: the parent and the child, as [\"map\", \"lidar\"]",
                    other.len()
                );
                Err(self.error(frames.span(), message))
            }
        }
    }

    /// Pose, or poses, of the set `name`.
    pub(super) fn mounting(
        &self,
        name: &str,
        pose: &OnePose<'_>,
        poses: &Key<Vec<Spanned<TimedPoseKeys>>>,
    ) -> Result<Mounting, SceneIoError> {
        let Some(poses) = poses else { return self.pose(name, pose).map(Mounting::Fixed) };
        if let Some((key, place)) = pose.first_given() {
            let message = format!("`{name}.{key}` beside `poses`; expected one of the two");
            return Err(self.error(place, message));
        }
        if poses.get_ref().is_empty() {
            let message = format!("`{name}.poses` is empty; expected at least one pose");
            return Err(self.error(poses.span(), message));
        }
        let mut timed: Vec<TimedPose> = Vec::new();
        for (index, table) in poses.get_ref().iter().enumerate() {
            let (name, keys) = (format!("{name}.poses[{index}]"), table.get_ref());
            let Some(time) = &keys.time_s else {
                let message = format!("`{name}.time_s` is missing; expected the time of the pose in seconds");
                return Err(self.error(table.span(), message));
            };
            let time_s = *time.get_ref();
            self.check(time_s, time.span(), &format!("{name}.time_s"), TIME_S, "seconds")?;
            if let Some(before) = timed.last().filter(|before| time_s <= before.time_s) {
                let message = format!(
                    "`{name}.time_s` is {time_s}; expected more than {} seconds, the time before it",
                    before.time_s
                );
                return Err(self.error(time.span(), message));
            }
            let turns = [&keys.yaw_left_deg, &keys.pitch_down_deg, &keys.roll_right_deg];
            let one = OnePose::new(&keys.position_m, turns);
            timed.push(TimedPose { time_s, pose: self.pose(&name, &one)? });
        }
        let poses_of = |error| self.refused(poses.span(), &error);
        Ok(Mounting::Moving(TimedPoses::new(timed, &format!("{name}.poses")).map_err(poses_of)?))
    }

    /// One pose: angles as those of a camera, in the mesh's frame.
    fn pose(&self, name: &str, keys: &OnePose<'_>) -> Result<Pose, SceneIoError> {
        let mut position = DVec3::ZERO;
        if let Some(key) = keys.position {
            let key_name = format!("{name}.position_m");
            position = DVec3::from_slice(self.list(key, &key_name, &[3], GLOBAL_M, "metres")?);
        }
        let mut angles = [0.0; 3];
        for ((key, value), angle) in keys.turns.iter().zip(&mut angles) {
            self.number(value, &format!("{name}.{key}"), angle, TURN_DEG, "degrees")?;
        }
        let [yaw, pitch, roll] = angles;
        Ok(Pose { position, ..turned(yaw, pitch, roll) })
    }
}
