//! How the vehicle stands on the ground.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};
use raypencil_scene::Pose;

use crate::chassis::{Chassis, WHEEL_SIGNS};
use crate::ground_faces::GroundFaces;
use crate::wheel::{Touch, WheelContact};

/// How a vehicle stands on the ground.
///
/// The turns are heading, then pitch, then roll, each about the axis as turned by those before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Origin of the vehicle frame, global, metres.
    pub position: DVec3,
    /// Heading, to the left of the global x axis, radians.
    pub heading: f64,
    /// Pitch, positive with the front end down, radians.
    pub pitch_down: f64,
    /// Roll, positive with the right side down, radians.
    pub roll_right: f64,
    /// Contacts of the wheels: front left, front right, rear left, rear right.
    pub contacts: [WheelContact; 4],
    /// By how much the body misses the plane that fits the four hubs best, metres: the sum of how far an axle and a
    /// side should still move. It is rounding, or large where no attitude fits: a wheel stands right before a wall as
    /// high as its hub. It is millimetres at few places on an oblique step of 0.97 radii, where the pitch that fits
    /// tips over as the roll changes, and the search ends there. That the four hubs are in no common plane is not part
    /// of it; the suspension takes this.
    pub residual: f64,
}

impl Rest {
    /// Pose `global_from_vehicle`.
    pub fn pose(&self) -> Pose {
        let heading = Pose::from_axis_angle(DVec3::Z, self.heading);
        let pitch = Pose::from_axis_angle(DVec3::Y, self.pitch_down);
        let roll = Pose::from_axis_angle(DVec3::X, self.roll_right);
        Pose { position: self.position, ..heading * pitch * roll }
    }
}

/// Residual at which a stance is solved, metres: a few hundred roundings of a length of 1 m.
const SOLVED_M: f64 = 1e-13;

/// What the rounding of heights adds to it, as a share of the largest height above the mesh's origin: eight roundings.
const SOLVED_SHARE: f64 = 8.0 * f64::EPSILON;

/// Fixed-point steps before bisection. On planes of up to 30 degrees each step leaves at most a third of the error
/// (the square of the slope): 28 steps take 1 m to 1e-13 m. The rest is for rougher ground.
const MAX_FIXED_POINT_STEPS: u32 = 48;

/// Width at which a bracket of an angle counts as closed, radians: a few spacings of numbers near pi / 2.
const CLOSED_RAD: f64 = 1e-15;

/// Heights at an attitude, and what they demand.
#[derive(Debug, Clone, Copy)]
struct Trial {
    pitch_down: f64,
    roll_right: f64,
    contacts: [WheelContact; 4],
    /// Height of the vehicle's origin above the mesh's origin, metres, if the hubs' mean is right.
    height: f64,
    /// Front hubs' mean height less that of the rear ones, metres, as the ground has it.
    rise_along: f64,
    /// The same, left less right.
    rise_across: f64,
    /// How far the front axle should move up, and the rear one down, metres.
    nose: f64,
    /// How far the left side should move up, and the right one down, metres.
    left: f64,
    /// Sum of |nose| and |left| at which the stance is solved, metres.
    solved: f64,
}

impl Trial {
    fn residual(&self) -> f64 {
        self.nose.abs() + self.left.abs()
    }
}

/// A vehicle over a place of the ground.
struct Standing<'a> {
    chassis: &'a Chassis,
    ground: &'a GroundFaces,
    /// From the mesh's origin.
    place: DVec2,
    forward: DVec2,
}

impl Standing<'_> {
    /// The four wheels at an attitude. `None` if one has no ground.
    ///
    /// With the pitch p and the roll r, a hub is at (x, y, R) in the vehicle frame, x = +-L/2 and y = +-T/2. Roll takes
    /// it to (x, y cos r - R sin r, k), where k = y sin r + R cos r. Then pitch takes x to x cos p + k sin p, and the
    /// height to k cos p - x sin p. So the hubs' mean is R cos r cos p above the origin, an axle L/2 sin p below or
    /// above this mean, and a side T/2 sin r cos p.
    fn try_attitude(&self, pitch_down: f64, roll_right: f64) -> Option<Trial> {
        let Chassis { wheelbase, track, wheel_radius, .. } = *self.chassis;
        let (sin_pitch, cos_pitch) = libm::sincos(pitch_down);
        let (sin_roll, cos_roll) = libm::sincos(roll_right);
        let mut contacts = [WheelContact { hub_height: 0.0, point: DVec3::ZERO }; 4];
        let (mut mean, mut nose, mut left, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for (contact, (sign_x, sign_y)) in contacts.iter_mut().zip(WHEEL_SIGNS) {
            let (x, y) = (0.5 * sign_x * wheelbase, 0.5 * sign_y * track);
            let raised = y * sin_roll + wheel_radius * cos_roll;
            let offset = self.forward * (x * cos_pitch + raised * sin_pitch)
                + self.forward.perp() * (y * cos_roll - wheel_radius * sin_roll);
            let rectangle = self.chassis.below_wheel(self.place, offset, self.forward);
            let touch: Touch = self.chassis.touch(self.ground, &rectangle)?;
            mean += 0.25 * touch.hub;
            nose += 0.25 * sign_x * touch.hub;
            left += 0.25 * sign_y * touch.hub;
            largest = largest.max(touch.hub.abs());
            *contact = touch.global(self.ground, &rectangle);
        }
        Some(Trial {
            pitch_down,
            roll_right,
            contacts,
            height: mean - wheel_radius * cos_roll * cos_pitch,
            rise_along: 2.0 * nose,
            rise_across: 2.0 * left,
            nose: nose + 0.5 * wheelbase * sin_pitch,
            left: left - 0.5 * track * sin_roll * cos_pitch,
            solved: SOLVED_M + SOLVED_SHARE * largest,
        })
    }

    /// Fixed-point steps: the attitude that the present contacts demand becomes the next one. `Ok(None)` if they do not
    /// converge, `None` if a wheel has no ground.
    fn by_fixed_point(&self) -> Option<Option<Trial>> {
        let Chassis { wheelbase, track, .. } = *self.chassis;
        let mut trial = self.try_attitude(0.0, 0.0)?;
        for _ in 0..MAX_FIXED_POINT_STEPS {
            if trial.residual() <= trial.solved {
                return Some(Some(trial));
            }
            let sin_pitch = -trial.rise_along / wheelbase;
            let sin_roll = trial.rise_across / (track * (1.0 - sin_pitch * sin_pitch).max(0.0).sqrt());
            if !(sin_pitch.abs() < 1.0 && sin_roll.abs() < 1.0) {
                return Some(None);
            }
            trial = self.try_attitude(libm::asin(sin_pitch), libm::asin(sin_roll))?;
        }
        Some(None)
    }

    /// The pitch that fits, for a given roll. Upright on its front end the vehicle should lower its nose (both
    /// axles are over one place), and upright on its rear end it should raise it: there is a pitch between.
    fn pitch_for(&self, roll_right: f64) -> Option<Trial> {
        sign_change(|pitch_down| {
            let trial = self.try_attitude(pitch_down, roll_right)?;
            // Finer than the search for the roll, which goes by what this leaves.
            Some((trial.nose, 0.25 * trial.solved, trial))
        })
    }

    /// The roll that fits, each with the pitch that fits it.
    fn by_bisection(&self) -> Option<Trial> {
        sign_change(|roll_right| {
            let trial = self.pitch_for(roll_right)?;
            Some((-trial.left, 0.5 * trial.solved, trial))
        })
    }
}

/// Angle from -pi/2 to pi/2 at which a value changes its sign from - to +, and what belongs to it. `evaluate` gives the
/// value, how near to zero it has to be, and the rest. The value counts as negative at the lower end and as positive at
/// the upper one. Where it jumps over zero, the search ends at the jump, on the side with the smaller value.
///
/// A secant and a halving take turns: at most 104 evaluations close the bracket from pi to 1e-15, and about ten
/// suffice on smooth ground.
fn sign_change<T>(mut evaluate: impl FnMut(f64) -> Option<(f64, f64, T)>) -> Option<T> {
    // Angle, and, once it has been evaluated, the value and the rest.
    let (mut low, mut high) = ((-FRAC_PI_2, None), (FRAC_PI_2, None));
    let mut halve = true;
    loop {
        let secant = match (&low, &high) {
            ((from, Some((below, _))), (to, Some((above, _)))) if !halve => {
                let (below, above): (&f64, &f64) = (below, above);
                from + (to - from) * (below / (below - above))
            }
            _ => f64::NAN,
        };
        let middle = 0.5 * (low.0 + high.0);
        let angle = if secant > low.0 && secant < high.0 { secant } else { middle };
        halve = !halve;
        let closed = high.0 - low.0 <= CLOSED_RAD || !(angle > low.0 && angle < high.0);
        if closed {
            return match (low.1, high.1) {
                (Some((below, at_low)), Some((above, at_high))) => {
                    Some(if f64::abs(below) <= f64::abs(above) { at_low } else { at_high })
                }
                (Some((_, only)), None) | (None, Some((_, only))) => Some(only),
                (None, None) => None,
            };
        }
        let (value, enough, rest) = evaluate(angle)?;
        if value.abs() <= enough {
            return Some(rest);
        }
        if value < 0.0 {
            low = (angle, Some((value, rest)));
        } else {
            high = (angle, Some((value, rest)));
        }
    }
}

impl Chassis {
    /// How the vehicle stands when its origin is over the global plan point `place` with this heading (to the left of
    /// the global x axis, radians). `None` if a wheel has no ground below it.
    ///
    /// CHOICE: all four wheels carry the same load, as with a rocker suspension: the body takes the plane that fits the
    /// four hubs best. Wheelbase and track are rigid, so the hubs move in plan when the body turns.
    /// CHOICE: wheels are upright discs; see [`Chassis::contact`].
    ///
    /// The stance is solved, and the same call gives the same bits: by fixed-point steps where they converge, else by
    /// bisection of the roll, with a bisection of the pitch for each. There is one solution if the slopes of the hubs'
    /// paths differ by less than about wheelbase / radius between the axles, and track / radius between the sides. The
    /// stance then follows the place without a jump. Beyond that a vehicle may tip over suddenly, as with the rear
    /// wheels on a step almost as high as the hub; which of its attitudes is found is then no matter of physics.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use raypencil_chassis::{Chassis, GroundFaces};
    /// use raypencil_scene::{Material, Mesh};
    ///
    /// // The plane z = x / 4.
    /// let corners = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.25 * x));
    /// let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    /// let mesh = Mesh::from_global(&corners, vec![[0, 1, 2], [0, 2, 3]], vec![0, 0], vec![sand])?;
    /// let rest = Chassis::default().rest(&GroundFaces::new(&mesh), DVec2::ZERO, 0.0).unwrap();
    /// // Uphill the front end is up, and the body is parallel to the ground.
    /// assert!((rest.pose().rotate(DVec3::X) - DVec3::new(4.0, 0.0, 1.0).normalize()).length() < 1e-12);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn rest(&self, ground: &GroundFaces, place: DVec2, heading: f64) -> Option<Rest> {
        let (sin, cos) = libm::sincos(heading);
        let origin = ground.origin();
        let standing = Standing {
            chassis: self,
            ground,
            place: place - origin.truncate(),
            forward: DVec2::new(cos, sin),
        };
        let trial = match standing.by_fixed_point()? {
            Some(trial) => trial,
            None => standing.by_bisection()?,
        };
        Some(Rest {
            position: place.extend(origin.z + trial.height),
            heading,
            pitch_down: trial.pitch_down,
            roll_right: trial.roll_right,
            contacts: trial.contacts,
            residual: trial.residual(),
        })
    }
}

#[cfg(test)]
#[path = "../tests/unit/rest.rs"]
mod tests;
