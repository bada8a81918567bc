//! Beams whose pencils bite: each passes a limit of the contract at a distance that is given, from a hundredth down to what
//! rounding excuses, so that a pack notices a clause that is kept, but not to its last digits.
//!
//! A beam stands beside the camera and looks where the camera looks, so that its points are on the image, or at its border. Each pencil has a tube
//! of its own: its faces are so small that no neighbour meets them, and they lie at nearly one depth, so that no way to the
//! camera crosses a neighbour's faces. [`tuned`] finds the corners.

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Mounted, Pose, Profile};

use crate::bench::faces::{AddedFaces, Side, Triangle, showing};
use crate::bench::lattice::tuned;

/// How many beams of a bench, the last ones, pass limits at distances down to what rounding excuses.
pub const BITING_BEAMS: usize = 3;

/// Columns and rows of the beam for all limits but the image's border.
const CELLS: [u32; 2] = [24, 10];

/// Columns and rows of the beams before two corners of the image.
const CORNER_CELLS: [u32; 2] = [8, 4];

/// Depth of the points, metres: nearer than all other plates of the bench.
const DEPTH_M: f64 = 0.5;

/// Most metres between neighbouring pencils at that depth.
const MAX_SPACING_M: f64 = 1.0 / 256.0;

/// Distance of the SPP, metres.
const PLANE_M: f64 = 0.125;

/// Place of the beam in the camera's frame, as a share of the image's half width and half height at the depth of the points: to the
/// left and below, so that points that move along their pencils cross the borders of pixels.
const PLACE: [f64; 2] = [-0.18, 0.35];

/// Pencils that are tried for a limit.
const MAX_TRIED: usize = 10;

/// Maximum range, metres: beyond all other points of the beam.
const MAX_RANGE_M: f64 = 0.55;

/// Distance of the middle of a small face from its corners, as a share of what is between two pencils.
const RADIUS: f64 = 0.1;

/// A direction across a pencil.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Across {
    Right,
    Left,
    Down,
    Up,
}

impl Across {
    /// The axis of the image: 0 across, 1 down.
    fn axis(self) -> usize {
        usize::from(matches!(self, Self::Down | Self::Up))
    }

    /// Whether coordinates grow in this direction: 1, else -1.
    fn sign(self) -> f64 {
        if matches!(self, Self::Right | Self::Down) { 1.0 } else { -1.0 }
    }

    fn reversed(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
            Self::Down => Self::Up,
            Self::Up => Self::Down,
        }
    }
}

const ALL_ACROSS: [Across; 4] = [Across::Right, Across::Left, Across::Down, Across::Up];

/// A limit of the contract that a pencil passes at the distance x.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Limit {
    /// The edge of a face lies x of a cell beside the pencil, and the face beyond it.
    EdgeBeside(Across),
    /// The same, with the face on the pencil's side.
    EdgeInside(Across),
    /// A face at t = 1 - x.
    BeforePlane,
    /// A face at t = 1 + x.
    BeyondPlane,
    /// A face at (1 - x) of the maximum range.
    WithinRange,
    /// A face at (1 + x) of the maximum range.
    BeyondRange,
    /// A face that is farther than another one by a share x.
    Farther,
    /// A front, met at the cosine x.
    GrazingFront,
    /// A back at the cosine x.
    GrazingBack,
    /// A face on the way to the camera, at a share x of it from the point.
    OccluderAtPoint,
    /// A face behind the point.
    OccluderBehindPoint,
    /// A face on the way to the camera, at a share x of it from the projection plane.
    OccluderAtPlane,
    /// A face before the projection plane by a share x of its distance.
    OccluderBeforePlane,
    /// The edge of a face on the way to the camera lies x of the face's size beside the way.
    OccluderBeside,
    /// The same, with the face on the way.
    OccluderEdgeOnWay,
    /// A face seen at the cosine x.
    SeenGrazing,
    /// A face seen from behind, at the cosine -x.
    SeenFromBehind,
    /// A point x of a pixel beyond the border of two pixels, in this direction.
    Lands(Across),
    /// A point x of a pixel outside the image, beyond its border in this direction.
    Outside(Across),
    /// A point x of a pixel inside that border.
    Inside(Across),
}

/// The distances, from coarse to what double precision excuses. Tuned: the finest ones are about what `docs/evidence/slack.md` shows
/// as excused.
fn limits() -> Vec<(Limit, f64)> {
    let mut all = Vec::new();
    let mut add = |limit: Limit, sizes: &[f64]| all.extend(sizes.iter().map(|size| (limit, *size)));
    for across in ALL_ACROSS {
        let sizes = [1e-2, 3e-3, 1e-3, 1e-5, 1e-7, 1e-8, 2e-9];
        add(Limit::EdgeBeside(across), &sizes);
        add(Limit::EdgeInside(across), &sizes);
        add(Limit::Lands(across), &[1e-2, 3e-3, 1e-4, 1e-6, 1e-8, 2e-9]);
    }
    let along = [1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-9, 1e-11, 1e-12, 2e-13];
    for limit in
        [Limit::BeforePlane, Limit::BeyondPlane, Limit::WithinRange, Limit::BeyondRange, Limit::Farther]
    {
        add(limit, &along);
    }
    for limit in [Limit::GrazingFront, Limit::GrazingBack, Limit::SeenGrazing, Limit::SeenFromBehind] {
        add(limit, &[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8]);
    }
    for limit in [
        Limit::OccluderAtPoint,
        Limit::OccluderBehindPoint,
        Limit::OccluderAtPlane,
        Limit::OccluderBeforePlane,
    ] {
        add(limit, &[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-8, 1e-9, 4e-10, 1e-10, 1e-11]);
    }
    for limit in [Limit::OccluderBeside, Limit::OccluderEdgeOnWay] {
        add(limit, &[1e-2, 1e-3, 1e-5, 1e-7, 1e-8]);
    }
    all
}

/// The distances of points from the image's borders, for these two directions.
fn limits_of_corner(borders: [Across; 2]) -> Vec<(Limit, f64)> {
    let mut all = Vec::new();
    for across in borders {
        for size in [1e-2, 3e-3, 1e-5, 1e-7, 1e-8, 2e-9] {
            all.extend([(Limit::Outside(across), size), (Limit::Inside(across), size)]);
        }
    }
    all
}

/// The biting beams: one for all limits but the image's border, and one before each of two corners of the image. Their faces are added
/// to `faces`.
pub(super) fn biting_beams(
    camera: &Mounted<Camera>,
    faces: &mut AddedFaces,
) -> [Mounted<Beam>; BITING_BEAMS] {
    let image = ImageAtDepth::of(&camera.sensor);
    let [x, y] = [0, 1].map(|axis: usize| image.middle(axis) + PLACE[axis] * image.half(axis));
    let corner = |sign: [f64; 2]| {
        [0, 1].map(|axis: usize| {
            // Inside the image by the half of what the beam covers.
            let covered = 0.5 * image.spacing() * f64::from(CORNER_CELLS[axis]);
            image.middle(axis) + sign[axis] * (image.half(axis) - covered)
        })
    };
    [
        beam_for(camera, [x, y], CELLS, &limits(), faces),
        beam_for(
            camera,
            corner([-1.0, 1.0]),
            CORNER_CELLS,
            &limits_of_corner([Across::Left, Across::Down]),
            faces,
        ),
        beam_for(
            camera,
            corner([1.0, -1.0]),
            CORNER_CELLS,
            &limits_of_corner([Across::Right, Across::Up]),
            faces,
        ),
    ]
}

/// The image's borders at the depth of the points, in the camera's frame, metres.
struct ImageAtDepth([[f64; 2]; 2]);

impl ImageAtDepth {
    fn of(camera: &Camera) -> Self {
        let size = [camera.width, camera.height].map(f64::from);
        Self([0, 1].map(|axis: usize| {
            [0.0, size[axis]].map(|at| {
                (at - camera.principal_point[axis]) * camera.pixel_pitch[axis] * DEPTH_M / camera.focal_length
            })
        }))
    }

    fn middle(&self, axis: usize) -> f64 {
        0.5 * (self.0[axis][0] + self.0[axis][1])
    }

    fn half(&self, axis: usize) -> f64 {
        0.5 * (self.0[axis][1] - self.0[axis][0])
    }

    /// Metres between neighbouring pencils: so many fit into any image.
    fn spacing(&self) -> f64 {
        MAX_SPACING_M.min(self.half(0).min(self.half(1)) / 50.0)
    }
}

/// A beam that looks where the camera looks, with faces for each of these limits before a pencil of its own.
fn beam_for(
    camera: &Mounted<Camera>,
    [x, y]: [f64; 2],
    [columns, rows]: [u32; 2],
    limits: &[(Limit, f64)],
    faces: &mut AddedFaces,
) -> Mounted<Beam> {
    let Mounted { scene_from_sensor: of_camera, sensor } = camera;
    let spacing = ImageAtDepth::of(sensor).spacing();
    let pose = Pose {
        position: of_camera.position + of_camera.rotate(DVec3::new(x, y, 0.0)),
        rotation: of_camera.rotation,
    };
    let beam = Beam {
        columns,
        rows,
        thickness: spacing * f64::from(rows),
        grid_distance: PLANE_M,
        half_width: 0.5 * spacing * f64::from(columns) * PLANE_M / DEPTH_M,
        max_range: MAX_RANGE_M,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let mut free: Vec<(u32, u32)> = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))).collect();
    for &(limit, size) in limits {
        // The first free pencils before which such faces are found.
        let tubes = free.iter().map(|&cell| Tube::new(&pose, &beam, of_camera, sensor, cell, spacing));
        let mut suited = tubes.enumerate().filter(|(_, tube)| tube.can_reach(limit)).take(MAX_TRIED);
        let found = suited.find_map(|(place, tube)| Some((place, tube.faces_of(limit, size)?)));
        if let Some((place, of_limit)) = found {
            free.remove(place);
            faces.extend_scene(of_limit);
        }
    }
    Mounted { scene_from_sensor: pose, sensor: beam }
}

/// What is around one pencil, in the scene's frame.
struct Tube<'a> {
    camera: &'a Camera,
    camera_pose: &'a Pose,
    origin: DVec3,
    /// From the origin to the SPP.
    q: DVec3,
    /// The distance of neighbouring pencils at the depth of the points, metres: by so much a cell moves a pencil.
    spacing: f64,
}

impl<'a> Tube<'a> {
    fn new(
        pose: &Pose,
        beam: &Beam,
        camera_pose: &'a Pose,
        camera: &'a Camera,
        (i, j): (u32, u32),
        spacing: f64,
    ) -> Self {
        let (columns, rows) = (f64::from(beam.columns), f64::from(beam.rows));
        let x = beam.half_width * (2.0 * f64::from(i) + 1.0 - columns) / columns;
        let y = beam.thickness * (2.0 * f64::from(j) + 1.0 - rows) / (2.0 * rows);
        Self {
            camera,
            camera_pose,
            origin: pose.position + pose.rotate(DVec3::new(0.0, y, 0.0)),
            q: pose.rotate(DVec3::new(x, 0.0, PLANE_M)),
            spacing,
        }
    }

    /// Distance of the middle of a small face from its corners, metres.
    fn radius(&self) -> f64 {
        RADIUS * self.spacing
    }

    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.q * t
    }

    /// The parameter t of the points.
    fn usual(&self) -> f64 {
        DEPTH_M / PLANE_M
    }

    /// A direction across, in the scene.
    fn across(&self, across: Across) -> DVec3 {
        self.camera_pose.rotate(match across {
            Across::Right => DVec3::X,
            Across::Left => DVec3::NEG_X,
            Across::Down => DVec3::Y,
            Across::Up => DVec3::NEG_Y,
        })
    }

    /// A triangle around a point, across the line to `viewer`, its front to there.
    fn around(&self, centre: DVec3, radius: f64, viewer: DVec3) -> Triangle {
        let (right, down) = (self.across(Across::Right), self.across(Across::Down));
        let at = |x: f64, y: f64| centre + radius * (x * right + y * down);
        // Not symmetric: no edge is parallel to an axis.
        showing(Side::Front, [at(-1.0, -0.7), at(1.05, -0.6), at(-0.1, 1.1)], viewer)
    }

    /// The front of a small face around the pencil at the parameter t.
    fn target(&self, t: f64) -> Triangle {
        self.around(self.at(t), self.radius(), self.origin)
    }

    /// The parameter at which the pencil meets the plane of a face.
    fn parameter(&self, face: &Triangle) -> f64 {
        parameter(face, self.origin, self.q)
    }

    fn point(&self, face: &Triangle) -> DVec3 {
        self.at(self.parameter(face))
    }

    /// Depth of a point before the camera, and the pixel coordinates of its image.
    fn seen(&self, point: DVec3) -> (f64, [f64; 2]) {
        let back = self.camera_pose.inverse();
        let seen = Pose { position: DVec3::ZERO, ..back }.rotate(point - self.camera_pose.position);
        let pixel = [0, 1].map(|axis: usize| {
            self.camera.focal_length * seen[axis] / seen.z / self.camera.pixel_pitch[axis]
                + self.camera.principal_point[axis]
        });
        (seen.z, pixel)
    }

    /// Whether the pencil can pass a limit at all: the image of a pencil crosses few borders.
    fn can_reach(&self, limit: Limit) -> bool {
        let border = match limit {
            Limit::Lands(across) => Some((across, self.pixel_border(across))),
            Limit::Outside(across) | Limit::Inside(across) => Some((across, self.image_border(across))),
            _ => None,
        };
        border.is_none_or(|(across, border)| self.crossing(across, border).is_some())
    }

    /// The faces by which the pencil passes a limit at the distance `size`.
    fn faces_of(&self, limit: Limit, size: f64) -> Option<Vec<Triangle>> {
        let usual = self.usual();
        let behind = self.target(1.04 * usual);
        Some(match limit {
            Limit::EdgeBeside(across) => vec![self.edge(across, size)?, behind],
            Limit::EdgeInside(across) => vec![self.edge(across, -size)?, behind],
            Limit::BeforePlane => vec![self.at_parameter(1.0 - size, 1.0, size)?, self.target(usual)],
            Limit::BeyondPlane => vec![self.at_parameter(1.0 + size, 1.0, size)?, self.target(usual)],
            Limit::WithinRange | Limit::BeyondRange => {
                let most = MAX_RANGE_M / self.q.length();
                let sign = if limit == Limit::WithinRange { -1.0 } else { 1.0 };
                vec![self.at_parameter(most * (1.0 + sign * size), most, size)?]
            }
            Limit::Farther => {
                let near = self.target(usual);
                let near = near.map(rounded);
                let t = self.parameter(&near);
                // The farther one comes first in the file.
                vec![self.at_parameter(t * (1.0 + size), t, size)?, near]
            }
            Limit::GrazingFront => vec![self.grazing(size, Side::Front)?, behind],
            Limit::GrazingBack => vec![self.grazing(size, Side::Back)?, behind],
            Limit::OccluderAtPoint => self.occluded(|_, _| 1.0 - size, size)?,
            Limit::OccluderBehindPoint => self.occluded(|_, _| 1.0 + size, size)?,
            Limit::OccluderAtPlane => self.occluded(|nearest, _| nearest + size * (1.0 - nearest), size)?,
            Limit::OccluderBeforePlane => self.occluded(|nearest, _| nearest * (1.0 - size), size)?,
            Limit::OccluderBeside => self.occluder_edge(-size)?,
            Limit::OccluderEdgeOnWay => self.occluder_edge(size)?,
            Limit::SeenGrazing => vec![self.seen_at(size)?],
            Limit::SeenFromBehind => vec![self.seen_at(-size)?],
            Limit::Lands(across) => vec![self.landing(across, self.pixel_border(across), size)?],
            Limit::Outside(across) => vec![self.landing(across, self.image_border(across), size)?],
            Limit::Inside(across) => {
                vec![self.landing(across.reversed(), self.image_border(across), size)?]
            }
        })
    }

    /// Parameters between which a point may move: before the faces behind, and beyond the middle of the way.
    fn near_depths(&self) -> [f64; 2] {
        [0.85, 1.02].map(|share| share * self.usual())
    }

    /// The pixel coordinate of the image's border in a direction.
    fn image_border(&self, across: Across) -> f64 {
        match across {
            Across::Left | Across::Up => 0.0,
            Across::Right => f64::from(self.camera.width),
            Across::Down => f64::from(self.camera.height),
        }
    }

    /// A border of two pixels that the image of the pencil may cross near the usual depth.
    fn pixel_border(&self, across: Across) -> f64 {
        let [from, to] = self.near_depths().map(|t| self.seen(self.at(t)).1[across.axis()]);
        from.max(to).floor()
    }

    /// The parameter at which the image of the pencil crosses a pixel coordinate, if it does so on the image.
    fn crossing(&self, across: Across, border: f64) -> Option<f64> {
        let axis = across.axis();
        let image = |t: f64| self.seen(self.at(t)).1[axis];
        let [mut from, mut to] = self.near_depths();
        if border < image(from).min(image(to)) || border > image(from).max(image(to)) {
            return None;
        }
        let rises = image(to) > image(from);
        for _ in 0..60 {
            let middle = 0.5 * (from + to);
            if (image(middle) < border) == rises { from = middle } else { to = middle }
        }
        // Along the other axis the point is on the image.
        let other = self.seen(self.at(from)).1[1 - axis];
        let most = f64::from([self.camera.width, self.camera.height][1 - axis]);
        (other > 0.1 && other < most - 0.1).then_some(from)
    }

    /// A small face whose point lands `size` beyond a pixel coordinate, in a direction.
    fn landing(&self, across: Across, border: f64, size: f64) -> Option<Triangle> {
        let (axis, sign) = (across.axis(), across.sign());
        let beyond = |face: &Triangle| sign * (self.seen(self.point(face)).1[axis] - border);
        tuned(self.target(self.crossing(across, border)?), [0, 1], size, beyond)
    }

    /// A small face that the pencil meets at a parameter which differs from `limit` by a share `size`.
    fn at_parameter(&self, t: f64, limit: f64, size: f64) -> Option<Triangle> {
        let sign = if t < limit { -1.0 } else { 1.0 };
        tuned(self.target(t), [0, 1], size, |face| {
            let [a, b, c] = face;
            let n = (b - a).cross(c - a);
            // The share by which the plane is beyond the limit, from small differences.
            sign * n.dot(a - self.origin - self.q * limit) / (n.dot(self.q) * limit)
        })
    }

    /// A face that lies across from its edge, which is `cells` beside the pencil in this direction.
    fn edge(&self, across: Across, cells: f64) -> Option<Triangle> {
        let centre = self.at(self.usual());
        let away = self.across(across);
        let along = self.q.cross(away).normalize();
        let cell = self.spacing;
        // Large enough that a pencil that is moved in a diagonal meets it as well.
        let reach = 4.0 * self.radius();
        let face = [
            centre + along * reach + away * (cells * cell),
            centre - along * reach + away * (cells * cell),
            centre + away * reach,
        ];
        let face = showing(Side::Front, face, self.origin);
        // Which two corners are on the edge does not depend on the order that `showing` chose: the first stays.
        let far =
            (1..3).max_by(|a, b| (face[*a] - centre).dot(away).total_cmp(&(face[*b] - centre).dot(away)))?;
        let near = 3 - far;
        tuned(face, [0, near], cells.abs(), |face| {
            let [p, o] = [face[0] - self.origin, face[near] - self.origin];
            // The pencil's distance from the edge's line, along `away`: it crosses the plane through the edge and the origin of the
            // pencil nowhere else.
            let across_edge = p.cross(o);
            let t = self.usual();
            -cells.signum() * self.q.dot(across_edge) * t / (across_edge.dot(away) * cell)
        })
    }

    /// A face along the pencil, met at this cosine from its front, or which shows its back.
    fn grazing(&self, cosine: f64, side: Side) -> Option<Triangle> {
        let along = self.q.normalize();
        let (right, down) = (self.across(Across::Right), self.across(Across::Down));
        let centre = self.at(self.usual());
        // The plane rises by the cosine along the pencil, and crosses it a third on the way.
        let length = 0.75 * self.spacing;
        let at = |s: f64, x: f64| centre + along * s + right * x - down * (cosine * s);
        let face =
            [at(-length, -2.0 * self.radius()), at(-length, 2.0 * self.radius()), at(2.0 * length, 0.0)];
        let face = showing(side, face, centre - along + down * -0.01 * cosine.signum());
        // How far the plane is above the pencil at a place along it.
        let above = |face: &Triangle, s: f64| {
            let [a, b, c] = face;
            let n = (b - a).cross(c - a);
            let point = centre + along * s;
            n.dot(a - point) / n.dot(down)
        };
        let far = (0..3)
            .max_by(|a, b| (face[*a] - centre).dot(along).total_cmp(&(face[*b] - centre).dot(along)))?;
        let [first, second] = [(far + 1) % 3, (far + 2) % 3];
        let face = tuned(face, [first, second], cosine * length, |face| above(face, -length))?;
        let found = tuned(face, [far, far], cosine * 2.0 * length, |face| -above(face, 2.0 * length))?;
        let [a, b, c] = found;
        let n = (b - a).cross(c - a);
        let cos = -n.dot(self.q) / (n.length() * self.q.length());
        let t = self.parameter(&found);
        let is_met = (cos > 0.0) == (side == Side::Front) && (self.at(t) - centre).length() < 0.9 * length;
        is_met.then_some(found)
    }

    /// A small face, and another one on the way from its point to the camera, at the share of the way from the camera which
    /// `place` says for the share of the projection plane.
    fn occluded(&self, place: impl Fn(f64, f64) -> f64, size: f64) -> Option<Vec<Triangle>> {
        let target = self.target(self.usual()).map(rounded);
        let point = self.point(&target);
        let camera = self.camera_pose.position;
        let (depth, _) = self.seen(point);
        let nearest = self.camera.focal_length / depth;
        let u = place(nearest, depth);
        let way = point - camera;
        // Away from the point the tubes are narrower.
        let radius = self.radius() * u.min(1.0);
        let centre = camera + way * u;
        // Near the point the pencil meets the plate right behind it, from its front: whichever of the two a program in single
        // precision meets first, it meets one. A back there would have to be told from a front that is as near as rounding.
        let plate = if u > 1.0 {
            showing(Side::Front, self.around(centre, radius, camera), self.origin)
        } else if u > 0.5 {
            // Between the pencil and the way: it cuts the way before the point, and the pencil behind it.
            let along = (self.q.normalize() + way.normalize()).normalize();
            let other = self.q.cross(way).normalize();
            let at = |x: f64, y: f64| centre + radius * (x * along + y * other);
            showing(Side::Front, [at(-1.0, -0.7), at(1.05, -0.6), at(-0.1, 1.1)], self.origin)
        } else {
            showing(Side::Back, self.around(centre, radius, camera), self.origin)
        };
        // From the near one of both limits, so that small differences are formed of small numbers.
        let (limit, sign) = match u {
            _ if u > 1.0 => (1.0, 1.0),
            _ if u > 0.5 && u >= 1.0 - 1.5 * size => (1.0, -1.0),
            _ if u >= nearest => (nearest, 1.0),
            _ => (nearest, -1.0),
        };
        let unit = if limit == 1.0 {
            1.0
        } else if sign > 0.0 {
            1.0 - nearest
        } else {
            nearest
        };
        let from = camera + way * limit;
        let plate = tuned(plate, [0, 1], size, |face| {
            let [a, b, c] = face;
            let n = (b - a).cross(c - a);
            sign * n.dot(a - from) / n.dot(way) / unit
        })?;
        Some(vec![target, plate])
    }

    /// A small face, and another one half on the way to the camera, whose barycentric coordinate there is `size`.
    fn occluder_edge(&self, size: f64) -> Option<Vec<Triangle>> {
        let target = self.target(self.usual()).map(rounded);
        let point = self.point(&target);
        let camera = self.camera_pose.position;
        let middle = camera.midpoint(point);
        let plate = self.around(middle, self.radius(), camera);
        // The way passes the edge between its first two corners.
        let plate = showing(Side::Back, plate, self.origin);
        let centre = plate[0].midpoint(plate[1]);
        let plate = plate.map(|corner| corner + (middle - centre));
        let plate = tuned(plate, [0, 1], size.abs(), |face| {
            let corners = face.map(|corner| corner - camera);
            let side = |k: usize| (point - camera).dot(corners[k].cross(corners[(k + 1) % 3]));
            size.signum() * side(0) / (side(0) + side(1) + side(2))
        })?;
        Some(vec![target, plate])
    }

    /// A small face that the camera sees at this cosine.
    fn seen_at(&self, cosine: f64) -> Option<Triangle> {
        let camera = self.camera_pose.position;
        let centre = self.at(self.usual());
        let to_camera = (camera - centre).normalize();
        let to_beam = (self.origin - centre).normalize();
        let normal = (to_beam - to_camera * to_beam.dot(to_camera)).normalize() + to_camera * cosine;
        let along = normal.cross(to_camera).normalize();
        let other = normal.cross(along).normalize();
        let at = |x: f64, y: f64| centre + self.radius() * (x * along + y * other);
        let face = showing(Side::Front, [at(-1.0, -0.7), at(1.05, -0.6), at(-0.1, 1.1)], self.origin);
        tuned(face, [0, 1], cosine.abs(), |face| {
            let [a, b, c] = face;
            let n = (b - a).cross(c - a);
            // The point is on the plane, so that any corner tells its distance from the camera.
            let way = camera - self.point(face);
            cosine.signum() * n.dot(camera - a) / (n.length() * way.length())
        })
    }
}

/// The parameter at which a line meets the plane of a face.
fn parameter([a, b, c]: &Triangle, origin: DVec3, q: DVec3) -> f64 {
    let n = (b - a).cross(c - a);
    n.dot(a - origin) / n.dot(q)
}

/// A corner rounded to f32.
fn rounded(corner: DVec3) -> DVec3 {
    corner.as_vec3().as_dvec3()
}
