//! Where a pattern stands: a pose, or a list of poses with times for a head that moves.

use glam::DQuat;

use super::PatternRays;
use crate::{CastRay, Pose, SceneError};

/// Pose of a moving head at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedPose {
    /// Time, seconds.
    pub time_s: f64,
    /// The pattern's frame in the mesh's.
    pub pose: Pose,
}

/// Poses in the order of their times. Between two of them the position is interpolated linearly, the orientation on the
/// shorter arc at a constant rate (slerp). Valid by construction.
///
/// ```
/// use glam::DVec3;
/// use raypencil_scene::Pose;
/// use raypencil_scene::pattern::{TimedPose, TimedPoses};
///
/// let at = |time_s: f64, x: f64, turn: f64| TimedPose {
///     time_s,
///     pose: Pose { position: DVec3::X * x, ..Pose::from_axis_angle(DVec3::Z, turn) },
/// };
/// let poses = TimedPoses::new(vec![at(0.0, 0.0, 0.0), at(2.0, 4.0, 1.0)], "poses")?;
/// let half = poses.at(1.0).expect("a time within the list");
/// assert_eq!(half.position, DVec3::X * 2.0);
/// assert!((half.rotate(DVec3::X) - Pose::from_axis_angle(DVec3::Z, 0.5).rotate(DVec3::X)).length() < 1e-15);
/// assert_eq!(poses.at(2.5), None);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TimedPoses {
    poses: Vec<TimedPose>,
}

/// Below this sine of the angle between two quaternions their chord is as good as the arc.
const SMALL_SINE: f64 = 1e-8;

impl TimedPoses {
    /// A list of poses. `field` names it in messages.
    ///
    /// # Errors
    /// Names the first pose whose time is not finite or not later than that before it, or whose numbers are not finite;
    /// and an empty list.
    pub fn new(poses: Vec<TimedPose>, field: &str) -> Result<Self, SceneError> {
        if poses.is_empty() {
            return Err(SceneError::new(field, "empty", "at least one pose"));
        }
        for (index, TimedPose { time_s, pose }) in poses.iter().enumerate() {
            if !time_s.is_finite() {
                let name = format!("{field}[{index}].time");
                return Err(SceneError::new(name, time_s, "a finite number of seconds"));
            }
            let length = pose.rotation.length_squared();
            if !pose.position.is_finite() || !(1e-6..=1e6).contains(&length) {
                let value = format!("{} {}", pose.position, pose.rotation);
                let expected = "a finite position and a quaternion of length 1e-3 to 1e3";
                return Err(SceneError::new(format!("{field}[{index}]"), value, expected));
            }
        }
        if let Some(index) = poses.windows(2).position(|pair| pair[1].time_s <= pair[0].time_s) {
            let expected = format!("more than {} s, the time before it", poses[index].time_s);
            let name = format!("{field}[{}].time", index + 1);
            return Err(SceneError::new(name, format!("{} s", poses[index + 1].time_s), expected));
        }
        Ok(Self { poses })
    }

    /// The poses themselves.
    pub fn poses(&self) -> &[TimedPose] {
        &self.poses
    }

    /// First and last time, seconds.
    pub fn span_s(&self) -> [f64; 2] {
        [self.poses[0].time_s, self.poses[self.poses.len() - 1].time_s]
    }

    /// The pose at a time; `None` before the first pose and after the last.
    pub fn at(&self, time_s: f64) -> Option<Pose> {
        let after = self.poses.partition_point(|pose| pose.time_s < time_s);
        let next = self.poses.get(after)?;
        if next.time_s == time_s {
            return Some(next.pose);
        }
        let before = self.poses[..after].last()?;
        let share = (time_s - before.time_s) / (next.time_s - before.time_s);
        let (from, to) = (before.pose.position, next.pose.position);
        Some(Pose {
            position: from + (to - from) * share,
            rotation: slerp(before.pose.rotation, next.pose.rotation, share),
        })
    }
}

/// The quaternion at a share of the shorter arc from `a` to `b`.
fn slerp(a: DQuat, b: DQuat, share: f64) -> DQuat {
    let (a, mut b) = (a.normalize(), b.normalize());
    let dot = |a: DQuat, b: DQuat| a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    // q and -q are the same rotation.
    if dot(a, b) < 0.0 {
        b = -b;
    }
    // The angle from the chords to b and to -b: exact for small angles, where its cosine says little.
    let angle = 2.0 * libm::atan2((b - a).length(), (b + a).length());
    let sin = libm::sin(angle);
    if sin < SMALL_SINE {
        return (a * (1.0 - share) + b * share).normalize();
    }
    a * (libm::sin((1.0 - share) * angle) / sin) + b * (libm::sin(share * angle) / sin)
}

/// Where a pattern stands in the mesh's frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Mounting {
    /// It stands still.
    Fixed(Pose),
    /// It moves: each ray has the pose at the time at which it is fired.
    Moving(TimedPoses),
}

impl Mounting {
    /// The pattern's frame is the mesh's.
    pub const HERE: Self = Self::Fixed(Pose::IDENTITY);

    /// The first pose of all.
    pub fn first(&self) -> Pose {
        match self {
            Self::Fixed(pose) => *pose,
            Self::Moving(poses) => poses.poses[0].pose,
        }
    }

    /// The pose at a time; `None` at a time for which there is none. Who stands still stands so at any time.
    pub fn at(&self, time_s: f64) -> Option<Pose> {
        match self {
            Self::Fixed(pose) => Some(*pose),
            Self::Moving(poses) => poses.at(time_s),
        }
    }

    /// The poses at the first and at the last of the times at which rays are fired; without times that of the first of all.
    ///
    /// ```
    /// use glam::DVec3;
    /// use raypencil_scene::Pose;
    /// use raypencil_scene::pattern::{Mounting, TimedPose, TimedPoses};
    ///
    /// let at = |time_s: f64| TimedPose { time_s, pose: Pose::from_position(DVec3::X * time_s) };
    /// let mounting = Mounting::Moving(TimedPoses::new(vec![at(0.0), at(9.0)], "poses")?);
    /// // Neither the order of the times nor the poses before and after them matter.
    /// let ends = mounting.ends(Some(&[3.0, 2.0, 5.0, 4.0]));
    /// assert_eq!(ends.map(|pose| pose.position.x), [2.0, 5.0]);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn ends(&self, times: Option<&[f64]>) -> [Pose; 2] {
        let times = || times.into_iter().flatten().copied();
        [times().reduce(f64::min), times().reduce(f64::max)]
            .map(|time| time.and_then(|time| self.at(time)).unwrap_or_else(|| self.first()))
    }

    /// The same in a frame in which its own frame has this pose.
    #[must_use]
    pub fn moved_by(&self, frame: &Pose) -> Self {
        match self {
            Self::Fixed(pose) => Self::Fixed(*frame * *pose),
            Self::Moving(TimedPoses { poses }) => {
                let moved = |one: &TimedPose| TimedPose { pose: *frame * one.pose, ..*one };
                Self::Moving(TimedPoses { poses: poses.iter().map(moved).collect() })
            }
        }
    }

    /// A ray is fired before the first pose or after the last.
    pub(crate) fn no_pose(field: &str, ray: u64, time: f64, [first, last]: [f64; 2]) -> SceneError {
        let expected = format!("{first} to {last} s, the times of its poses");
        SceneError::new(format!("{field}: time of ray {ray}"), format!("{time} s"), expected)
    }

    /// The pattern in the mesh's frame. `field` names it in messages.
    ///
    /// # Errors
    /// Names the first ray that is fired at a time for which there is no pose.
    pub fn place(&self, pattern: PatternRays, field: &str) -> Result<PatternRays, SceneError> {
        let placed = |pose: &Pose, ray: &CastRay| CastRay {
            origin: *pose * ray.origin,
            direction: pose.rotate(ray.direction),
            ..*ray
        };
        let mut pattern = match self {
            Self::Fixed(_) => pattern,
            Self::Moving(_) if pattern.times.is_none() => pattern.starting_at(0.0),
            Self::Moving(_) => pattern,
        };
        pattern.mounting = self.clone();
        match (self, &pattern.times) {
            (Self::Fixed(pose), _) => pattern.rays.iter_mut().for_each(|ray| *ray = placed(pose, ray)),
            (Self::Moving(poses), times) => {
                let times = times.iter().flatten();
                for (index, (ray, &time)) in pattern.rays.iter_mut().zip(times).enumerate() {
                    let no_pose = || Self::no_pose(field, index as u64, time, poses.span_s());
                    let pose = poses.at(time).ok_or_else(no_pose)?;
                    *ray = placed(&pose, ray);
                }
            }
        }
        Ok(pattern)
    }
}
