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

/// What the vehicle can do: slopes between wheels' centres (rise over horizontal distance), the height that a wheel climbs, and
/// where its mass is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassageLimits {
    /// Maximum slope between the two front wheels.
    pub front: f64,
    /// Maximum slope between the two rear wheels.
    pub rear: f64,
    /// Maximum slope between the middle of the front wheels and that of the rear ones, over the wheelbase.
    pub length: f64,
    /// Maximum height of a step that a wheel climbs ([`Chassis::step`]), metres. Infinite: any.
    pub step: f64,
    /// Centre of mass in the vehicle frame, metres. `None`: the vehicle never tips over.
    pub centre_of_mass: Option<DVec3>,
}

impl PassageLimits {
    /// Maximum slopes alone: wheels climb any step, and the vehicle never tips over.
    pub fn slopes(front: f64, rear: f64, length: f64) -> Self {
        Self { front, rear, length, step: f64::INFINITY, centre_of_mass: None }
    }
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
    /// as far as the test uses them), the point that hits the underside, or the upper edge of the step.
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
    /// The centre of mass is beyond the line through two wheels.
    TipOver,
    /// The ground touches the underside, or is higher.
    Belly,
    /// A wheel has to climb too high a step on its way ([`Chassis::step`]).
    Step,
}

/// Way on which a rise counts as one step, metres. On a slope of 1:1 the ground itself rises by as much meanwhile.
const STEP_WAY_M: f64 = 1e-4;

/// Parts of a wheel's radius in one piece of its way. A stone that is h high lifts a wheel of radius R for a way of
/// 2 sqrt(2 R h - h^2) at least: between two places R / 4 apart no step above R - sqrt(R^2 - (R / 8)^2) = R / 128 is lost.
const PIECES_OF_RADIUS: f64 = 4.0;

/// The ground under a wheel on a part of its way.
#[derive(Debug, Clone, Copy)]
struct Carried {
    /// Distance along the way, metres.
    at: f64,
    /// Ground point that carries the wheel, global, metres.
    point: DVec3,
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
    /// h - R > length L. A lower one lets the axle come nearer first: whether a wheel climbs what it touches is asked by
    /// [`Chassis::step`].
    ///
    /// *Tip-over*, if a centre of mass is given: static stability. The hubs' plane rises by p along and by q to the left (see
    /// below). Through a centre of mass at (x, y, h) in the vehicle frame, the vertical meets the plane of the wheels' lowest
    /// points at x - h p sqrt(1 + p^2 + q^2) / sqrt(1 + p^2) along, and at y - h q / sqrt(1 + p^2) across. The vehicle tips
    /// over if this is farther from the middle than half the wheelbase or half the track. On a plane that rises by tan t
    /// straight ahead, with the mass in the middle, it is tan t > L / (2 h); straight across, tan t > track / (2 h), which
    /// is the static stability factor of the makers of cars (NHTSA). CHOICE: the support is the rectangle between the
    /// middles of the wheels, and all four of them carry, as in [`Chassis::rest`]. No speed, no swaying load.
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
    /// let limits = PassageLimits::slopes(0.35, 0.35, 0.25);
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
        if let Some(mass) = limits.centre_of_mass {
            let pitched = (1.0 + p * p).sqrt();
            let foot =
                DVec2::new(mass.x - mass.z * p * upright / pitched, mass.y - mass.z * q / pitched).abs();
            if foot.x > 0.5 * wheelbase + RISE_ROUNDING_M || foot.y > 0.5 * track + RISE_ROUNDING_M {
                let points = points.to_vec();
                return Passage::Blocked(Obstruction { kind: ObstructionKind::TipOver, points });
            }
        }
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

    /// The first wheel that has to climb a step of more than `height` metres, while the vehicle drives straight for `way`
    /// metres, up to where the middle of its front axle is over the global plan point `front`. `None`: there is none.
    ///
    /// The wheels are where [`Chassis::passage`] has them. A wheel that rolls on level ground against a step of height h touches
    /// its edge while it still stands before it: the ground point that carries it changes from one to the other, and is h higher
    /// at once. This is the step, whatever its edge is like; the wheel's centre rises only later, bit by bit. Where a slope
    /// with the angle a begins, the point jumps by R (1 - cos a). CHOICE: a rise within 0.1 mm of way is at once; it is found
    /// by halving pieces of a quarter of a radius, in which no step above R / 128 is lost. Steps down are none, and a
    /// place without ground before the way's first one begins it.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use raypencil_chassis::{Chassis, GroundFaces, ObstructionKind};
    /// use raypencil_scene::{Material, Mesh};
    ///
    /// // Level ground with a step of 0.2 m at x = 1 m.
    /// let rows = [(-4.0, 0.0), (1.0, 0.0), (1.0, 0.2), (4.0, 0.2)];
    /// let corners: Vec<DVec3> =
    ///     rows.iter().flat_map(|&(x, z)| [-4.0, 4.0].map(|y| DVec3::new(x, y, z))).collect();
    /// let faces = [0, 2, 4].iter().flat_map(|&i| [[i, i + 2, i + 1], [i + 1, i + 2, i + 3]]).collect();
    /// let rock = Material { name: "rock".into(), reflectivity: 0.25 };
    /// let ground = GroundFaces::new(&Mesh::from_global(&corners, faces, vec![0; 6], vec![rock])?);
    /// let chassis = Chassis::default();
    /// let step = |x, height| chassis.step(&ground, DVec2::new(x, 0.0), DVec2::X, 0.1, height);
    /// // The wheel of 0.35 m touches the edge with its axle sqrt(0.35^2 - 0.15^2) = 0.316 m before it.
    /// assert_eq!(step(0.7, 0.19).map(|step| step.kind), Some(ObstructionKind::Step));
    /// assert!(step(0.68, 0.19).is_none() && step(0.7, 0.21).is_none());
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn step(
        &self,
        ground: &GroundFaces,
        front: DVec2,
        forward: DVec2,
        way: f64,
        height: f64,
    ) -> Option<Obstruction> {
        let left = forward.perp();
        let place = front - ground.origin().truncate();
        let pieces = (PIECES_OF_RADIUS * way / self.wheel_radius).ceil().max(1.0);
        WHEEL_SIGNS.into_iter().find_map(|(sign_x, sign_y)| {
            let behind = if sign_x > 0.0 { 0.0 } else { self.wheelbase };
            let carried = |at: f64| -> Option<Carried> {
                let offset = forward * (at - way - behind) + left * (0.5 * sign_y * self.track);
                let rectangle = self.below_wheel(place, offset, forward);
                let touch = self.touch(ground, &rectangle)?;
                Some(Carried { at, point: touch.global(ground, &rectangle).point })
            };
            let mut before = carried(0.0);
            for piece in 1..=pieces as u64 {
                let now = carried(way * (piece as f64 / pieces));
                if let Some(point) = before.zip(now).and_then(|ends| step_within(&carried, ends, height)) {
                    return Some(Obstruction { kind: ObstructionKind::Step, points: vec![point] });
                }
                before = now;
            }
            None
        })
    }
}

/// The ground point to which a wheel has to climb by more than `height` metres at once between two places of its way.
fn step_within(
    carried: &dyn Fn(f64) -> Option<Carried>,
    (from, to): (Carried, Carried),
    height: f64,
) -> Option<DVec3> {
    if to.point.z - from.point.z <= height + RISE_ROUNDING_M {
        return None;
    }
    if to.at - from.at <= STEP_WAY_M {
        return Some(to.point);
    }
    // Over a hole in the ground the whole rise is at once.
    let Some(middle) = carried(0.5 * (from.at + to.at)) else { return Some(to.point) };
    step_within(carried, (from, middle), height).or_else(|| step_within(carried, (middle, to), height))
}
