//! Rules and numbers of a renderer's rays that may differ from the contract's and the scene's.

use glam::{DQuat, DVec3};
use raypencil_scene::{Place, Pose, Scene, SensorId};

use crate::mistake::Mistake;

/// What the maximum range limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Longest {
    Range,
    Depth,
    Nothing,
}

/// How the numbers of a sensor differ from the scene's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Numbers {
    /// Where a ray goes through its cell, from the middle, in cells.
    pub(crate) offset: [f64; 2],
    /// Focal length or grid distance over the scene's.
    pub(crate) focal: f64,
    /// Pixel pitch over the scene's, across and down.
    pub(crate) pitch: [f64; 2],
    /// Half width of a beam's grid over the scene's.
    pub(crate) fan: f64,
    /// Thickness of a beam over the scene's.
    pub(crate) thickness: f64,
    /// Rotation vector in the sensor's frame, radians.
    pub(crate) turn: DVec3,
    /// In the scene frame, metres.
    pub(crate) shift: DVec3,
}

impl Numbers {
    pub(crate) const SCENE: Self = Self {
        offset: [0.0; 2],
        focal: 1.0,
        pitch: [1.0; 2],
        fan: 1.0,
        thickness: 1.0,
        turn: DVec3::ZERO,
        shift: DVec3::ZERO,
    };
}

/// Rules of a cast that may differ from the contract's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rules {
    pub(crate) hits_backs: bool,
    /// The least t of a hit.
    pub(crate) least: f64,
    pub(crate) longest: Longest,
    /// Whether a ray that meets an edge exactly passes it.
    pub(crate) edges_open: bool,
    pub(crate) numbers: Numbers,
}

impl Rules {
    pub(crate) const CONTRACT: Self = Self {
        hits_backs: false,
        least: 1.0,
        longest: Longest::Range,
        edges_open: false,
        numbers: Numbers::SCENE,
    };

    /// The rules of a renderer with a mistake; `None` if the mistake is not one of rules.
    fn of(mistake: Mistake) -> Option<Self> {
        let contract = Self::CONTRACT;
        match mistake {
            Mistake::BacksHit => Some(Self { hits_backs: true, ..contract }),
            Mistake::NearPlaneIgnored => Some(Self { least: 0.0, ..contract }),
            Mistake::MaximumRangeIgnored => Some(Self { longest: Longest::Nothing, ..contract }),
            Mistake::MaximumRangeAsDepth => Some(Self { longest: Longest::Depth, ..contract }),
            Mistake::EdgesOpen => Some(Self { edges_open: true, ..contract }),
            Mistake::NearLimit(least) => Some(Self { least, ..contract }),
            Mistake::CornerRays { columns, rows } => {
                Some(Self { numbers: Numbers { offset: [columns, rows], ..Numbers::SCENE }, ..contract })
            }
            _ => None,
        }
    }

    /// The rules of a renderer with both mistakes; `None` if the two change the same rule.
    fn and(self, other: Self) -> Option<Self> {
        fn one<T: PartialEq>(a: T, b: T, contract: T) -> Option<T> {
            match (a == contract, b == contract) {
                (true, _) => Some(b),
                (_, true) => Some(a),
                _ => None,
            }
        }
        Some(Self {
            hits_backs: self.hits_backs || other.hits_backs,
            least: one(self.least, other.least, 1.0)?,
            longest: one(self.longest, other.longest, Longest::Range)?,
            edges_open: self.edges_open || other.edges_open,
            numbers: one(self.numbers, other.numbers, Numbers::SCENE)?,
        })
    }
}

/// The mistakes of rules, the plainest first.
pub(crate) fn wrong_rules() -> Vec<(Mistake, Rules)> {
    let corner = |(columns, rows)| Mistake::CornerRays { columns, rows };
    let corners = [(-0.5, -0.5), (0.5, 0.5), (0.5, -0.5), (-0.5, 0.5)].map(corner);
    [
        Mistake::BacksHit,
        Mistake::NearPlaneIgnored,
        Mistake::MaximumRangeIgnored,
        Mistake::MaximumRangeAsDepth,
        Mistake::EdgesOpen,
    ]
    .into_iter()
    .chain(corners)
    .filter_map(|mistake| Some((mistake, Rules::of(mistake)?)))
    .collect()
}

/// The rules of a renderer that uses a sensor's pose otherwise than the scene states it; none where that changes nothing.
pub(crate) fn wrong_poses(scene: &Scene, sensor: SensorId) -> Vec<(Mistake, Rules)> {
    let own = match sensor {
        SensorId::Camera => scene.camera().scene_from_sensor,
        SensorId::Beam(beam) => scene.beams()[beam].scene_from_sensor,
    };
    let [x, y, z, w] = own.rotation.to_array();
    let reordered = Pose { rotation: DQuat::from_xyzw(y, z, w, x), ..own };
    let as_rules = |(mistake, pose): (Mistake, Pose)| {
        let turn = rotation_vector(own.rotation.inverse() * pose.rotation);
        let numbers = Numbers { turn, shift: pose.position - own.position, ..Numbers::SCENE };
        (numbers != Numbers::SCENE).then_some((mistake, Rules { numbers, ..Rules::CONTRACT }))
    };
    let all = [(Mistake::PoseInverted, own.inverse()), (Mistake::QuaternionOrder, reordered)];
    all.into_iter().filter_map(as_rules).collect()
}

/// The axis of a rotation times its angle, radians.
fn rotation_vector(rotation: DQuat) -> DVec3 {
    let vector = DVec3::new(rotation.x, rotation.y, rotation.z);
    let sine = vector.length();
    if sine == 0.0 { DVec3::ZERO } else { vector * (2.0 * libm::atan2(sine, rotation.w) / sine) }
}

/// The rules of a renderer in which a hit needs more than t = 1.
pub(crate) fn near_limit(least: f64) -> Option<(Mistake, Rules)> {
    let mistake = Mistake::NearLimit(least);
    Some((mistake, Rules::of(mistake)?))
}

/// Two mistakes of rules at a time.
pub(crate) fn pairs_of_wrong_rules() -> Vec<([Mistake; 2], Rules)> {
    let all = wrong_rules();
    let pair = |k: usize, other: &(Mistake, Rules)| Some(([all[k].0, other.0], all[k].1.and(other.1)?));
    (0..all.len()).flat_map(|k| all[k + 1..].iter().filter_map(move |other| pair(k, other))).collect()
}

/// A ray, and the distance along the sensor's normal axis that it goes in t = 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SensorRay {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
    pub(crate) axis: f64,
}

/// A rotation vector as a rotation.
fn turned(turn: DVec3, vector: DVec3) -> DVec3 {
    let angle = turn.length();
    if angle == 0.0 { vector } else { Pose::from_axis_angle(turn / angle, angle).rotate(vector) }
}

/// The ray of a cell of a sensor with other numbers.
pub(crate) fn ray(scene: &Scene, place: Place, numbers: &Numbers) -> Option<SensorRay> {
    let (width, height) = scene.size(place.sensor)?;
    if place.i >= width || place.j >= height {
        return None;
    }
    let [dx, dy] = numbers.offset;
    let (pose, start, mut direction) = match place.sensor {
        SensorId::Camera => {
            let camera = scene.camera();
            let [px, py] = camera.sensor.pixel_pitch;
            let mut direction = camera.sensor.direction(place.i, place.j) + DVec3::new(dx * px, dy * py, 0.0);
            direction.x *= numbers.pitch[0];
            direction.y *= numbers.pitch[1];
            (camera.scene_from_sensor, DVec3::ZERO, direction)
        }
        SensorId::Beam(beam) => {
            let beam = &scene.beams()[beam];
            let across = 2.0 * beam.sensor.half_width / f64::from(beam.sensor.columns);
            let down = beam.sensor.thickness / f64::from(beam.sensor.rows);
            let mut direction = beam.sensor.direction(place.i) + DVec3::new(dx * across, 0.0, 0.0);
            direction.x *= numbers.fan;
            let mut start = beam.sensor.origin(place.j) + DVec3::new(0.0, dy * down, 0.0);
            start.y *= numbers.thickness;
            (beam.scene_from_sensor, start, direction)
        }
    };
    direction.z *= numbers.focal;
    let axis = direction.z;
    Some(SensorRay {
        origin: pose.position + numbers.shift + pose.rotate(turned(numbers.turn, start)),
        direction: pose.rotate(turned(numbers.turn, direction)),
        axis,
    })
}

#[cfg(test)]
#[path = "../tests/unit/rules.rs"]
mod tests;
