//! The vehicle's measures, and how it settles on the ground.

use glam::{DVec2, DVec3};
use raypencil_scene::{Pose, SceneError};
use raypencil_terrain::HeightIndex;

use crate::check::{check_count, check_range};

/// A vehicle on four wheels. Its frame has x forward, y left, z up; its origin, the paper's "local vehicle
/// origin" (§7), is in the plane of the wheels' lowest points, midway between the axles and the sides.
///
/// CHOICE: the paper says where neither the origin is nor how large anything. With the origin on the ground a
/// vehicle on a plane has the plane's height, as the scene files have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle {
    /// Between the front and the rear axle, metres.
    pub wheelbase: f64,
    /// Between the middles of a left and a right wheel, metres.
    pub track: f64,
    /// Of every wheel, metres.
    pub wheel_radius: f64,
    /// Of every wheel, metres: the paper's "wheel thickness".
    pub wheel_width: f64,
    /// From the plane of the wheels' lowest points up to the body's underside, midway between the axles, metres.
    pub clearance: f64,
    /// How many points of a wheel's rim, over its whole diameter, are held against the ground. 1: its lowest alone.
    pub rim_points: u32,
}

impl Default for Vehicle {
    /// CHOICE: a rover of a metre or two, as the built-in scenes and the rig want it: it fits in the strip of
    /// 2.6 m that `pyramids` leaves free, and its nose ends behind the nearest ground that a panned camera sees.
    /// What the paper does say is kept: a wheel is thicker than one grid spacing of 0.1 m, since gaps "less than
    /// or equal to one grid spacing" and those "less than one wheel thickness wide" are different things to it.
    /// The belly is at the height of the hubs, since the paper's belly test is for "the midpoint between the rear
    /// and front wheel centers" (all §7).
    fn default() -> Self {
        Self {
            wheelbase: 1.2,
            track: 1.0,
            wheel_radius: 0.35,
            wheel_width: 0.25,
            clearance: 0.35,
            rim_points: 17,
        }
    }
}

/// Which way a vehicle is turned: heading first, then pitch, then roll, each about the axis that the turns before
/// it left, radians.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// To the left of the global x axis.
    pub heading: f64,
    /// Of the nose.
    pub pitch_down: f64,
    /// Of the right side, downwards.
    pub roll_right: f64,
}

impl Attitude {
    /// The pose of a vehicle so turned, its origin at `position` (global).
    pub fn at(&self, position: DVec3) -> Pose {
        let heading = Pose::from_axis_angle(DVec3::Z, self.heading);
        let pitch = Pose::from_axis_angle(DVec3::Y, self.pitch_down);
        let roll = Pose::from_axis_angle(DVec3::X, self.roll_right);
        Pose { position, ..heading * pitch * roll }
    }
}

/// How a vehicle stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stance {
    /// Its origin, global, metres.
    pub position: DVec3,
    /// Its attitude.
    pub attitude: Attitude,
    /// By how much the last step of settling still moved a wheel, metres: small, unless the ground is so rough
    /// that no stance is at rest.
    pub residual: f64,
}

impl Stance {
    /// `global_from_vehicle`.
    pub fn pose(&self) -> Pose {
        self.attitude.at(self.position)
    }
}

/// The ways of the four wheels from the vehicle's middle: forward or back, left or right.
const WHEEL_SIGNS: [(f64, f64); 4] = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];

/// Steps of settling. On slopes up to 45 degrees each leaves less than half of the error: 2^-40 m is enough.
const SETTLING_STEPS: u32 = 40;

impl Vehicle {
    /// Whether a point of the vehicle frame is under the vehicle: within the rectangle around its wheels.
    pub fn covers(&self, point: DVec2) -> bool {
        let half_length = 0.5 * self.wheelbase + self.wheel_radius;
        let half_width = 0.5 * (self.track + self.wheel_width);
        point.x.abs() <= half_length && point.y.abs() <= half_width
    }

    /// The width over all, metres.
    pub fn width(&self) -> f64 {
        self.track + self.wheel_width
    }

    /// How high the hub of a wheel stands whose middle is above the global point `hub` and which rolls towards
    /// `heading` (a unit): as high as the highest of its rim's points needs. `None` if there is no ground below.
    fn hub_height(&self, ground: &HeightIndex, hub: DVec2, heading: DVec2) -> Option<f64> {
        let points = self.rim_points.max(1);
        let across = heading.perp() * (0.5 * self.wheel_width);
        let mut highest: Option<f64> = None;
        for point in 0..points {
            // From -1 to 1 over the diameter, ends left out: there the rim is vertical.
            let share = (2.0 * f64::from(point) + 1.0 - f64::from(points)) / f64::from(points);
            let along = heading * (share * self.wheel_radius);
            let rim = self.wheel_radius * (1.0 - share * share).sqrt();
            for side in [-1.0, 0.0, 1.0] {
                let at = hub + along + across * side;
                if let Some(z) = ground.height_at(at.x, at.y) {
                    highest = Some(highest.map_or(z + rim, |top: f64| top.max(z + rim)));
                }
            }
        }
        highest
    }

    /// How the vehicle stands when its middle is driven to the global point `place` with that heading; `None` if a
    /// wheel has no ground below it.
    ///
    /// CHOICE: all four wheels carry alike, as with a rocker between the sides: the body takes the plane that fits
    /// the four hubs best. The paper has other programs for suspension and sinkage (§1).
    pub fn settle(&self, ground: &HeightIndex, place: DVec2, heading: f64) -> Option<Stance> {
        let mut attitude = Attitude { heading, ..Attitude::default() };
        let mut position = place.extend(ground.height_at(place.x, place.y)?);
        let mut residual = f64::INFINITY;
        for step in 0..SETTLING_STEPS {
            let pose = attitude.at(position);
            let forward = pose.rotate(DVec3::X).truncate().normalize_or_zero();
            // How much higher each hub should be.
            let mut lift = [0.0; 4];
            for (lift, (x, y)) in lift.iter_mut().zip(WHEEL_SIGNS) {
                let hub = DVec3::new(0.5 * x * self.wheelbase, 0.5 * y * self.track, self.wheel_radius);
                let hub = pose * hub;
                *lift = self.hub_height(ground, hub.truncate(), forward)? - hub.z;
            }
            let part = |sign: fn((f64, f64)) -> f64| {
                lift.iter().zip(WHEEL_SIGNS).map(|(lift, wheel)| lift * sign(wheel)).sum::<f64>() / 4.0
            };
            let (heave, nose, left) = (part(|_| 1.0), part(|(x, _)| x), part(|(_, y)| y));
            residual = heave.abs() + nose.abs() + left.abs();
            // On broken ground the full steps may swing for ever: shorter ones later on.
            let share = if step < SETTLING_STEPS / 2 { 1.0 } else { 0.5 };
            position.z += share * heave;
            attitude.pitch_down -= share * 2.0 * nose / self.wheelbase;
            attitude.roll_right += share * 2.0 * left / self.track;
        }
        Some(Stance { position, attitude, residual })
    }

    /// Refuses a vehicle that is none, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        for (name, length) in [
            ("wheelbase", self.wheelbase),
            ("track", self.track),
            ("wheel_radius", self.wheel_radius),
            ("wheel_width", self.wheel_width),
            ("clearance", self.clearance),
        ] {
            check_range(field, name, length, 1e-2, 1e2, "m")?;
        }
        check_range(
            field,
            "wheel_radius",
            self.wheel_radius,
            1e-2,
            0.5 * self.wheelbase,
            "m (half the wheelbase)",
        )?;
        check_range(field, "wheel_width", self.wheel_width, 1e-2, self.track, "m (the track)")?;
        check_count(field, "rim_points", self.rim_points.into(), 1, 1001)
    }
}
