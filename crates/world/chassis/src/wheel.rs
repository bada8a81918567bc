//! Where a wheel touches the ground.

use glam::{DVec2, DVec3};

use crate::chassis::Chassis;
use crate::ground_faces::{Face, GroundFaces, Search};
use crate::rectangle::Rectangle;

/// Where a wheel rests on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelContact {
    /// Height of the hub, global z, metres.
    pub hub_height: f64,
    /// The ground point that carries the wheel, global, metres. Of several, the one nearest to the hub in plan, then
    /// that of the face with the lowest index.
    pub point: DVec3,
}

/// A contact in the local coordinates of the wheel's rectangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Touch {
    /// Height of the hub above the mesh's origin, metres.
    pub(crate) hub: f64,
    /// The ground point: along, across, height above the mesh's origin; metres.
    pub(crate) point: DVec3,
    /// Index of its face.
    face: u32,
}

/// The search for the highest hub: no ground point may be inside the wheel.
///
/// Over a ground point at the distance a along the rolling direction, the hub is at least at z + sqrt(R^2 - a^2). Over
/// one triangle, clipped to the wheel's rectangle, z is linear in a and b. Across (along b) the expression is linear,
/// so that its maximum over the polygon lies on an edge. Along an edge on which z grows by m for each metre of a, it
/// is concave, with the derivative m - a / sqrt(R^2 - a^2). This is zero at a* = R m / sqrt(1 + m^2). If a* is not on
/// the edge, or if the edge runs across (all of it has one a), the maximum is at an end.
struct HighestHub<'a> {
    rectangle: &'a Rectangle,
    radius: f64,
    best: Option<Touch>,
}

impl HighestHub<'_> {
    /// Height of the hub above the lower rim at the distance `along` from it, metres.
    fn rim(&self, along: f64) -> f64 {
        (self.radius * self.radius - along * along).max(0.0).sqrt()
    }

    /// Whether ground up to `top`, from a = `low` to `high`, may carry the wheel as high as the best so far.
    fn can_lift(&self, low: f64, high: f64, top: f64) -> bool {
        let nearest = low.max(-high).max(0.0);
        self.best.as_ref().is_none_or(|best| top + self.rim(nearest) >= best.hub)
    }

    /// Takes a ground point into account.
    fn consider(&mut self, point: DVec3, face: u32) {
        let touch = Touch { hub: point.z + self.rim(point.x), point, face };
        let from_hub = |touch: &Touch| touch.point.truncate().length_squared();
        let is_better = self.best.as_ref().is_none_or(|best| {
            let nearer = (from_hub(&touch), touch.face) < (from_hub(best), best.face);
            touch.hub > best.hub || (touch.hub == best.hub && nearer)
        });
        if is_better {
            self.best = Some(touch);
        }
    }

    /// Takes the stationary point of an edge into account, if it has one between its ends.
    fn consider_edge(&mut self, [from, to]: [DVec3; 2], face: u32) {
        let (run, rise) = (to.x - from.x, to.z - from.z);
        // R m / sqrt(1 + m^2) with m = rise / run; this form has no quotient that overflows.
        let stationary = self.radius * rise * run.signum() / (run * run + rise * rise).sqrt();
        let share = (stationary - from.x) / run;
        if share > 0.0 && share < 1.0 {
            let mut point = from + (to - from) * share;
            // On a steep edge z and a must be those of one and the same share: there, a rounding of a is a large one
            // of z.
            if rise.abs() <= run.abs() {
                point.x = stationary;
            }
            self.consider(point, face);
        }
    }
}

impl Search for HighestHub<'_> {
    fn can_matter(&self, top: f64) -> bool {
        // An equal one can matter: it may be nearer to the hub.
        self.best.as_ref().is_none_or(|best| top + self.radius >= best.hub)
    }

    fn visit(&mut self, face: &Face) {
        let corners = face.corners.map(|corner| self.rectangle.local(corner));
        let [a, b, c] = corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        if !self.rectangle.may_overlap(low, high) || !self.can_lift(low.x, high.x, high.z) {
            return;
        }
        let polygon = self.rectangle.clip(corners);
        for &corner in polygon.corners() {
            self.consider(corner, face.index);
        }
        for edge in polygon.edges() {
            self.consider_edge(edge, face.index);
        }
        // Ground that is level across carries the wheel along a line. Its point nearest to the hub may be inside the
        // face, at b = 0.
        if let Some(chord) = polygon.chord() {
            chord.into_iter().for_each(|end| self.consider(end, face.index));
            self.consider_edge(chord, face.index);
        }
    }
}

impl Touch {
    /// This contact in global coordinates.
    pub(crate) fn global(&self, ground: &GroundFaces, rectangle: &Rectangle) -> WheelContact {
        let origin = ground.origin();
        WheelContact { hub_height: origin.z + self.hub, point: origin + rectangle.scene(self.point) }
    }
}

impl Chassis {
    /// The rectangle below a wheel whose hub is over `place` + `offset`, from the mesh's origin.
    pub(crate) fn below_wheel(&self, place: DVec2, offset: DVec2, forward: DVec2) -> Rectangle {
        let (half_length, half_width) = (self.wheel_radius, 0.5 * self.wheel_width);
        Rectangle { place, offset, forward, half_length, half_width }
    }

    /// Contact of a wheel with the ground in its rectangle.
    pub(crate) fn touch(&self, ground: &GroundFaces, rectangle: &Rectangle) -> Option<Touch> {
        let mut highest = HighestHub { rectangle, radius: self.wheel_radius, best: None };
        ground.search(rectangle, &mut highest);
        highest.best
    }

    /// Contact of a wheel whose hub is over the global plan point `hub`. The wheel rolls towards `forward`, a unit
    /// vector in plan. `None` if there is no ground below any part of the wheel.
    ///
    /// The wheel is a short upright cylinder with a horizontal axle; its hub is as low as the ground allows. The
    /// result is exact up to rounding, for any triangles.
    ///
    /// CHOICE: the axle stays horizontal, also if the vehicle rolls. A wheel that rolls with the body would touch with
    /// the same point of its rim on most ground, a little nearer to its middle.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use raypencil_chassis::{Chassis, GroundFaces};
    /// use raypencil_scene::{Material, Mesh};
    ///
    /// // Level ground, 8 m wide.
    /// let corners = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    /// let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    /// let mesh = Mesh::from_global(&corners, vec![[0, 1, 2], [0, 2, 3]], vec![0, 0], vec![sand])?;
    /// let contact = Chassis::default().contact(&GroundFaces::new(&mesh), DVec2::new(1.0, 0.5), DVec2::X).unwrap();
    /// // The hub is one radius up, and the wheel touches right below it.
    /// assert_eq!(contact.hub_height, 0.35);
    /// assert_eq!(contact.point, DVec3::new(1.0, 0.5, 0.0));
    /// # Ok::<(), raypencil_scene::SceneError>(())
    /// ```
    pub fn contact(&self, ground: &GroundFaces, hub: DVec2, forward: DVec2) -> Option<WheelContact> {
        let rectangle = self.below_wheel(hub - ground.origin().truncate(), DVec2::ZERO, forward);
        self.touch(ground, &rectangle).map(|touch| touch.global(ground, &rectangle))
    }
}
