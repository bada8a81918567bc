//! The vehicle: its dimensions, and how it stands on the ground.

use glam::{DVec2, DVec3};
use raypencil_chassis::{Chassis, GroundFaces};
use raypencil_scene::{Pose, SceneError, check_count, check_range};
use raypencil_terrain::HeightIndex;

/// Dimensions of a vehicle on four wheels.
///
/// The vehicle frame has x forward, y left, z up. Its origin, the paper's "local vehicle origin" (§7), lies in the
/// plane of the wheels' lowest points, midway between the axles and between the sides.
///
/// CHOICE: the paper gives neither the origin nor any dimension. With this origin a vehicle on a level plane has the
/// plane's height, as in the scene files.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle {
    /// Distance between the front and the rear axle, metres.
    pub wheelbase: f64,
    /// Distance between the middles of a left and a right wheel, metres.
    pub track: f64,
    /// Radius of every wheel, metres.
    pub wheel_radius: f64,
    /// Width of every wheel, metres: the paper's "wheel thickness".
    pub wheel_width: f64,
    /// Height of the body's underside above the plane of the wheels' lowest points, midway between the axles, metres.
    pub clearance: f64,
    /// Number of points of a wheel's rim, along its diameter, that are tested against the ground. 1: the lowest point
    /// only.
    pub rim_points: u32,
}

impl Default for Vehicle {
    /// CHOICE: a rover of one to two metres, which suits the built-in scenes and the default rig. It fits into the
    /// strip of 2.6 m that `pyramids` leaves free, and its front end is behind the nearest ground that a panned camera
    /// sees.
    ///
    /// Two statements of §7 are kept. A wheel is thicker than one grid spacing of 0.1 m, since the paper distinguishes
    /// gaps "less than or equal to one grid spacing" from those "less than one wheel thickness wide". The underside is
    /// at the height of the hubs, since the paper tests "the midpoint between the rear and front wheel centers".
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

/// Orientation of a vehicle: heading, then pitch, then roll, radians. Each turn is about the axis as turned by those
/// before it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Heading, to the left of the global x axis.
    pub heading: f64,
    /// Pitch, positive with the front end down.
    pub pitch_down: f64,
    /// Roll, positive with the right side down.
    pub roll_right: f64,
}

impl Attitude {
    /// Pose `global_from_vehicle` of a vehicle with this orientation and its origin at `position` (global, metres).
    pub fn at(&self, position: DVec3) -> Pose {
        let heading = Pose::from_axis_angle(DVec3::Z, self.heading);
        let pitch = Pose::from_axis_angle(DVec3::Y, self.pitch_down);
        let roll = Pose::from_axis_angle(DVec3::X, self.roll_right);
        Pose { position, ..heading * pitch * roll }
    }
}

/// True pose of a vehicle at rest on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stance {
    /// Origin of the vehicle frame, global, metres.
    pub position: DVec3,
    /// Orientation.
    pub attitude: Attitude,
    /// Motion of the wheels in the last iteration, metres. It is small, unless the ground is so rough that the
    /// iteration does not converge.
    pub residual: f64,
}

impl Stance {
    /// Pose `global_from_vehicle`.
    pub fn pose(&self) -> Pose {
        self.attitude.at(self.position)
    }
}

/// Signs of the four wheels' x and y in the vehicle frame.
const WHEEL_SIGNS: [(f64, f64); 4] = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];

/// Iterations of settling. On slopes up to 45 degrees each one halves the error at least: 2^-40 m is enough.
const SETTLING_STEPS: u32 = 40;

impl Vehicle {
    /// Whether a point (vehicle frame x and y, metres) is in the rectangle around the wheels.
    pub fn covers(&self, point: DVec2) -> bool {
        let half_length = 0.5 * self.wheelbase + self.wheel_radius;
        let half_width = 0.5 * (self.track + self.wheel_width);
        point.x.abs() <= half_length && point.y.abs() <= half_width
    }

    /// Radius of the circle that the vehicle needs to turn on the spot, metres.
    pub fn turning_radius(&self) -> f64 {
        let corner = DVec2::new(0.5 * self.wheelbase + self.wheel_radius, 0.5 * self.width());
        corner.length()
    }

    /// Overall width, metres.
    pub fn width(&self) -> f64 {
        self.track + self.wheel_width
    }

    /// Height of the hub of a wheel above the global point `hub`, global z, metres. The wheel rolls towards `heading`
    /// (a unit vector) and rests on the highest of its rim's points. `None` if there is no ground below.
    fn hub_height(&self, ground: &HeightIndex, hub: DVec2, heading: DVec2) -> Option<f64> {
        let points = self.rim_points.max(1);
        let across = heading.perp() * (0.5 * self.wheel_width);
        let mut highest: Option<f64> = None;
        for point in 0..points {
            // Shares from -1 to 1 of the radius, without the ends, where the rim is vertical.
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

    /// Pose of the vehicle when its centre is at the global point `place` with this heading. `None` if a wheel has no
    /// ground below it.
    ///
    /// CHOICE: all four wheels carry the same load, as with a rocker suspension: the body takes the plane that fits the
    /// four hubs best. The paper leaves suspension and sinkage to other programs (§1).
    ///
    /// ```
    /// use glam::DVec2;
    /// use raypencil_rover::Vehicle;
    /// use raypencil_terrain::{HeightIndex, builtin};
    ///
    /// // The built-in scene is level at its start, (-9, 0): a vehicle stands level at z = 0 there.
    /// let ground = HeightIndex::new(&builtin("pyramids", 0.25).unwrap().into_mesh()?);
    /// let stance = Vehicle::default().settle(&ground, DVec2::new(-9.0, 0.0), 0.0).unwrap();
    /// assert!(stance.position.z.abs() < 1e-9 && stance.attitude.pitch_down.abs() < 1e-9);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn settle(&self, ground: &HeightIndex, place: DVec2, heading: f64) -> Option<Stance> {
        let mut attitude = Attitude { heading, ..Attitude::default() };
        let mut position = place.extend(ground.height_at(place.x, place.y)?);
        let mut residual = f64::INFINITY;
        for step in 0..SETTLING_STEPS {
            let pose = attitude.at(position);
            let forward = pose.rotate(DVec3::X).truncate().normalize_or_zero();
            // Height of each hub above its present one, metres.
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
            // On broken ground full steps may oscillate: halve them in the second half of the iterations.
            let share = if step < SETTLING_STEPS / 2 { 1.0 } else { 0.5 };
            position.z += share * heave;
            attitude.pitch_down -= share * 2.0 * nose / self.wheelbase;
            attitude.roll_right += share * 2.0 * left / self.track;
        }
        Some(Stance { position, attitude, residual })
    }

    /// Pose of the vehicle when its centre is at the global point `place` with this heading, by the mended rule: wheels
    /// as discs of their width in contact with the true faces, and the plane of the hubs solved. `None` if a wheel has no
    /// ground below it.
    pub fn stand(&self, ground: &GroundFaces, place: DVec2, heading: f64) -> Option<Stance> {
        let Self { wheelbase, track, wheel_radius, wheel_width, clearance, .. } = *self;
        let chassis = Chassis { wheelbase, track, wheel_radius, wheel_width, clearance };
        let rest = chassis.rest(ground, place, heading)?;
        let attitude = Attitude { heading, pitch_down: rest.pitch_down, roll_right: rest.roll_right };
        Some(Stance { position: rest.position, attitude, residual: rest.residual })
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        for (name, length) in [
            ("wheelbase", self.wheelbase),
            ("track", self.track),
            ("wheel_radius", self.wheel_radius),
            ("wheel_width", self.wheel_width),
            ("clearance", self.clearance),
        ] {
            check_range(|| format!("{field}.{name}"), length, 1e-2, 1e2, "m")?;
        }
        check_range(
            || format!("{field}.wheel_radius"),
            self.wheel_radius,
            1e-2,
            0.5 * self.wheelbase,
            "m (half the wheelbase)",
        )?;
        check_range(|| format!("{field}.wheel_width"), self.wheel_width, 1e-2, self.track, "m (the track)")?;
        check_count(|| format!("{field}.rim_points"), self.rim_points.into(), 1, 1001)
    }
}
