//! What the vehicle can pass.

use glam::{DVec2, DVec3};

use crate::belly::{Plane, highest_excess};
use crate::chassis::{Chassis, WHEEL_SIGNS};
use crate::ground_faces::GroundFaces;
use crate::rectangle::Rectangle;

/// Rounding that a rise is allowed, metres: a slope exactly at its limit passes, and ground exactly at the height of
/// the underside is hit. Heights within 1e4 m of the mesh's origin have rounding errors of 1e-12 m, and a mean of two
/// heights, its difference to another and a product with a limit have a few of these.
const RISE_ROUNDING_M: f64 = 1e-11;

/// Maximum slopes between wheels' centres: rise over horizontal distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassageLimits {
    /// Between the two front wheels.
    pub front: f64,
    /// Between the two rear wheels.
    pub rear: f64,
    /// Between the middle of the front wheels and that of the rear ones, over the wheelbase.
    pub length: f64,
}

/// Whether the vehicle can stand at a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Passage {
    /// It can.
    Clear,
    /// A wheel has no ground below it.
    OffGround,
    /// It cannot; this is the first reason, in the order of [`ObstructionKind`].
    Blocked(Obstruction),
}

/// Why the vehicle cannot stand at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstruction {
    /// The test that failed.
    pub kind: ObstructionKind,
    /// The ground points that decide it, global, metres: the contacts (front left, front right, rear left, rear right,
    /// as far as the test uses them), or the point that hits the underside.
    pub points: Vec<DVec3>,
}

/// A test of a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ObstructionKind {
    /// The slope between the front wheels.
    FrontSlope,
    /// The slope between the rear wheels.
    RearSlope,
    /// The slope from the rear axle to the front axle, up or down.
    LengthSlope,
    /// The ground touches the underside, or is higher.
    Belly,
}

impl Chassis {
    /// Whether the vehicle can stand with the middle of its front axle over the global plan point `front`, facing
    /// `forward`, a unit vector in plan.
    ///
    /// CHOICE: the wheels are where those of a level vehicle are in plan: half the track to the left and right of the
    /// axles' middles, and the rear axle one wheelbase behind. This is the "imaginary vehicle" of the paper's tests
    /// (§7).
    ///
    /// *Slopes* are between the wheels' centres: the difference of their heights over their distance on level ground,
    /// which is the track, or for the axles' middles the wheelbase; a slope at its limit passes. On a plane this is the
    /// plane's own slope. CHOICE: centres as the paper says ("two front wheel centers"), not the ground points that
    /// carry them. A wheel that rests on two points at once may be carried by either, which differ in height and place,
    /// but its centre is at one height.
    ///
    /// A wheel of radius R touches a step of height h before its centre is over it: with the centre at d < R before the
    /// step it is lifted by h - R + sqrt(R^2 - d^2), if that is positive. A step across the way stops a vehicle of
    /// wheelbase L if h > length L, as soon as the lift exceeds length L. A wall is met at its first touch, d = R, if
    /// h - R > length L. A lower one lets the axle come nearer first: no test asks whether a wheel could climb what it
    /// touches.
    ///
    /// *Belly*: the underside is a flat rectangle from axle to axle and between the wheels' inner sides. The hubs'
    /// plane is z = h + p a + q b, with h the mean of the four hubs, p the rise from rear to front axle over L, and q
    /// from right to left side over the track. A distance of 1 m along its normal is sqrt(1 + p^2 + q^2) m along z.
    /// The underside is `clearance` above the plane of the wheels' lowest points, which is one radius below the hubs'
    /// plane; both are measured along the normal. Ground that touches the underside blocks.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use raypencil_chassis::{Chassis, GroundFaces, ObstructionKind, Passage, PassageLimits};
    /// use raypencil_scene::{Material, Mesh};
    ///
    /// // The plane z = x / 4, 8 m wide.
    /// let corners = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.25 * x));
    /// let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    /// let mesh = Mesh::from_global(&corners, vec![[0, 1, 2], [0, 2, 3]], vec![0, 0], vec![sand])?;
    /// let (ground, chassis) = (GroundFaces::new(&mesh), Chassis::default());
    /// let limits = PassageLimits { front: 0.35, rear: 0.35, length: 0.25 };
    /// // Straight up is just allowed.
    /// assert_eq!(chassis.passage(&ground, DVec2::ZERO, DVec2::X, &limits), Passage::Clear);
    /// let steeper = PassageLimits { length: 0.24, ..limits };
    /// let Passage::Blocked(obstruction) = chassis.passage(&ground, DVec2::ZERO, DVec2::X, &steeper) else { panic!() };
    /// assert_eq!(obstruction.kind, ObstructionKind::LengthSlope);
    /// assert_eq!(chassis.passage(&ground, DVec2::new(9.0, 0.0), DVec2::X, &limits), Passage::OffGround);
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn passage(
        &self,
        ground: &GroundFaces,
        front: DVec2,
        forward: DVec2,
        limits: &PassageLimits,
    ) -> Passage {
        let Self { wheelbase, track, wheel_radius, wheel_width, clearance } = *self;
        let left = forward.perp();
        let origin = ground.origin();
        let place = front - origin.truncate();

        // Heights of the hubs from the mesh's origin, and the ground points that carry them.
        let mut hubs = [0.0; 4];
        let mut points = [DVec3::ZERO; 4];
        for (wheel, (sign_x, sign_y)) in WHEEL_SIGNS.into_iter().enumerate() {
            let axle = DVec2::new(if sign_x > 0.0 { 0.0 } else { -wheelbase }, 0.5 * sign_y * track);
            let rectangle = self.below_wheel(place, forward * axle.x + left * axle.y, forward);
            let Some(touch) = self.touch(ground, &rectangle) else { return Passage::OffGround };
            hubs[wheel] = touch.hub;
            points[wheel] = touch.global(ground, &rectangle).point;
        }

        let [front_left, front_right, rear_left, rear_right] = hubs;
        let along = 0.5 * ((front_left + front_right) - (rear_left + rear_right));
        for (kind, rise, distance, limit, range) in [
            (ObstructionKind::FrontSlope, front_left - front_right, track, limits.front, 0..2),
            (ObstructionKind::RearSlope, rear_left - rear_right, track, limits.rear, 2..4),
            (ObstructionKind::LengthSlope, along, wheelbase, limits.length, 0..4),
        ] {
            if rise.abs() > limit * distance + RISE_ROUNDING_M {
                return Passage::Blocked(Obstruction { kind, points: points[range].to_vec() });
            }
        }

        let mean = 0.25 * ((front_left + front_right) + (rear_left + rear_right));
        let p = along / wheelbase;
        let q = 0.5 * ((front_left + rear_left) - (front_right + rear_right)) / track;
        let upright = (1.0 + p * p + q * q).sqrt();
        let underside = Plane { middle: mean + (clearance - wheel_radius) * upright, along: p, across: q };
        let rectangle = Rectangle {
            place,
            offset: forward * (-0.5 * wheelbase),
            forward,
            half_length: 0.5 * wheelbase,
            half_width: 0.5 * (track - wheel_width),
        };
        match highest_excess(ground, &rectangle, underside) {
            Some(highest) if highest.height >= -RISE_ROUNDING_M => {
                let point = origin + rectangle.scene(highest.point);
                Passage::Blocked(Obstruction { kind: ObstructionKind::Belly, points: vec![point] })
            }
            _ => Passage::Clear,
        }
    }
}
