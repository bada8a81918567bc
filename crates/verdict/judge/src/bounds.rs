//! Bounds of the rounding error of an honest renderer, quantity by quantity, with their derivation.
//!
//! Let u be the unit roundoff, and for the face hit: e1 = b - a, e2 = c - a, n = e1 x e2, L its longest edge, and
//! kappa its [aspect]: the largest |e1| |e2| / |n| of its three corners, as the corner a at which a renderer begins is its
//! own affair (ours begin at the lowest of the three). It is at most longest edge / smallest altitude.
//! Let the ray start at o, run along q, meet the face at range R under the cosine c = cos(psi), and let
//! S = R + L + |o|, which is at least the length of every vector that is subtracted or dotted on the way.
//!
//! Both renderers form n from edges of the scene frame, t from a quotient of n.(a - o) and n.q. To first
//! order in u:
//!
//! * n: differences of f32 numbers (u each), two products and a difference per component:
//!   |dn| <= 5 u |e1| |e2| = 5 kappa u |n|.
//! * n.(a - o): n's error, the subtraction (u S, and u |o| where o had to be formed), a dot product (3 u):
//!   <= (5 kappa + 6) u |n| S.
//! * n.q: n's error, the rotation of q by a quaternion or a matrix formed from it (12 u), a dot product
//!   (3 u): <= (5 kappa + 15) u |n| |q|. Where c is smaller than (5 kappa + 15) u, its sign is open: the referee excuses a
//!   renderer that takes the front of such a face for its back.
//! * |n.(a - o)| = |n| R c and |n.q| = |n| |q| c, so the relative error of t is at most
//!   ((5 kappa + 6) S / R + 5 kappa + 15 + 3) u / c <= 34 kappa u S / (R c), as kappa >= 1 and S >= R.
//! * R = t |q|, or |q| / (1/t): two more roundings at most, and a square root.
//!
//! [`RANGE_ROUNDINGS`] = 36 rounds this up. The other quantities follow. Two renderers may differ by the sum of
//! their bounds. Where a bound reaches the size of the quantity itself, the first order in u is no estimate any more;
//! the bound then allows any value of that size.

use glam::DVec3;

use crate::answer::{StatedHit, StatedReturn};
use raypencil_referee::{RANGE_ROUNDINGS, aspect, edge_slip};
use raypencil_scene::{
    Beam, FaceId, Filter, FluxModel, Hit, HitQuantity, HitValue, Mesh, Place, Precision, Profile, Ray,
    Return, Scene,
};

/// Roundings of a direction: a vertex is subtracted from the origin and turned into the sensor's frame (15 u S,
/// see above), and an edge's crossing formed from it (6 u S). As an angle, divided by the range.
pub(crate) const DIRECTION_ROUNDINGS: f64 = 21.0;

/// Roundings of a point along a known range: rotation (12 u R), origin (4 u |o|), sum (u |P|), |P| <= S.
const POINT_ROUNDINGS: f64 = 18.0;

/// Roundings of the unit normal: |dn^| <= 2 |dn| / |n| + 3 u <= 13 kappa u.
const NORMAL_ROUNDINGS: f64 = 13.0;

/// Roundings of cos(psi) by the longer of its two formulas, -n.(a - o) (1/t) / (|n| |q|): the relative errors of
/// n.(a - o) and of 1/t, each of which carries 1/c, times c: (11 + 34) kappa u S / R, and a few roundings.
const INCIDENCE_ROUNDINGS: f64 = 48.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HitBounds {
    /// Range and depth, metres.
    pub(crate) range: f64,
    /// Distance of the point, metres.
    pub(crate) point: f64,
    /// Distance of the unit normal.
    pub(crate) normal: f64,
    pub(crate) cos_incidence: f64,
}

impl HitBounds {
    /// The bounds for a hit on `face` at `range` metres along `ray`.
    pub(crate) fn of(mesh: &Mesh, face: FaceId, ray: &Ray, range: f64, precision: Precision) -> Self {
        FaceShape::of(mesh, face).met_by(ray).bounds(range, precision)
    }

    pub(crate) fn of_exact(scene: &Scene, ray: &Ray, hit: &Hit, precision: Precision) -> Self {
        Self::of(scene.mesh(), hit.face, ray, hit.range, precision)
    }

    /// The bound of one quantity, in its unit.
    pub(crate) fn of_quantity(&self, quantity: HitQuantity) -> f64 {
        match quantity {
            HitQuantity::Range | HitQuantity::Depth => self.range,
            HitQuantity::Point => self.point,
            HitQuantity::Normal => self.normal,
            HitQuantity::CosIncidence => self.cos_incidence,
        }
    }

    /// How far two renderers with these bounds may differ.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            range: self.range + other.range,
            point: self.point + other.point,
            normal: self.normal + other.normal,
            cos_incidence: self.cos_incidence + other.cos_incidence,
        }
    }
}

/// How far the ranges of two renderers, with these precisions, may differ at a hit on `face` at `range` metres, in metres;
/// `None` if the scene has no such ray or face.
///
/// ```
/// # use raypencil_scene::{Atmosphere, FluxModel, Renderer, Request, Scene, rig};
/// # use glam::DVec3;
/// use raypencil_judge::range_bound;
/// use raypencil_referee::ExactRenderer;
/// use raypencil_scene::{Place, Precision, SensorId};
///
/// # let mesh = raypencil_terrain::builtin("facets", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(mesh.into(), camera, beams, air, FluxModel::Radiometric)?;
/// let place = Place { sensor: SensorId::Camera, i: 8, j: 15 };
/// let hit = ExactRenderer.render(&scene, &Request::MAPS).map(SensorId::Camera).unwrap().hit(8, 15).unwrap();
/// let bound = |precisions| range_bound(&scene, place, hit.face, hit.range, precisions).unwrap();
/// // A few hundred roundings of 2^-53 of the range, and 2^29 times as much where both compute in f32.
/// let doubles = bound([Precision::F64; 2]);
/// assert!(doubles > hit.range * 2e-16 && doubles < hit.range * 1e-12);
/// assert!(bound([Precision::F32; 2]) > 1e8 * doubles);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn range_bound(
    scene: &Scene,
    place: Place,
    face: FaceId,
    range: f64,
    precisions: [Precision; 2],
) -> Option<f64> {
    let ray = scene.ray(place.sensor, place.i, place.j)?;
    let is_known = (face.0 as usize) < scene.mesh().faces().len();
    let met = is_known.then(|| FaceShape::of(scene.mesh(), face).met_by(&ray))?;
    Some(precisions.map(|precision| met.bounds(range, precision).range).iter().sum())
}

/// What the bounds of all hits on one face depend on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceShape {
    /// n, square metres.
    n: DVec3,
    n_length: f64,
    /// kappa.
    aspect: f64,
    /// L, metres.
    longest_edge: f64,
    corners: [DVec3; 3],
}

impl FaceShape {
    pub(crate) fn of(mesh: &Mesh, face: FaceId) -> Self {
        let [a, b, c] = mesh.faces()[face.0 as usize].map(|v| {
            let [x, y, z] = mesh.vertices()[v as usize];
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        });
        let (e1, e2) = (b - a, c - a);
        let n = e1.cross(e2);
        let n_length = n.length();
        let aspect = aspect([a, b, c]);
        let longest_edge = e1.length().max(e2.length()).max((c - b).length());
        Self { n, n_length, aspect, longest_edge, corners: [a, b, c] }
    }

    /// How far beside this face a ray may be said to meet it, or within it to miss it, metres: every program's roundings of a
    /// direction, and the slip of an edge that the ray passes no farther, for one that forms the point on the plane first.
    pub(crate) fn lateral(&self, ray: &Ray, range: f64, precision: Precision) -> f64 {
        let u = precision.unit_roundoff;
        let scale = range + self.longest_edge + ray.origin.length();
        let of_direction = DIRECTION_ROUNDINGS * u * scale;
        let allowed = (0..3).filter_map(|k| {
            let (a, edge) = (self.corners[k], self.corners[(k + 1) % 3] - self.corners[k]);
            let across =
                |v: DVec3| v - ray.direction * (v.dot(ray.direction) / ray.direction.length_squared());
            // Seen along the ray, the point of the edge that is nearest to it.
            let (from, along) = (across(a - ray.origin), across(edge));
            let share = (-from.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let distance = (from + along * share).length();
            let slip = edge_slip(self.aspect, self.n, edge, ray.direction, scale, u);
            (!(distance > of_direction + slip)).then_some(of_direction + slip)
        });
        allowed.fold(of_direction, f64::max)
    }

    /// With what the ray adds.
    #[inline]
    pub(crate) fn met_by(&self, ray: &Ray) -> MetFace {
        MetFace {
            aspect: self.aspect,
            longest_edge: self.longest_edge,
            origin: ray.origin.length(),
            cosine: (self.n.dot(ray.direction) / (self.n_length * ray.direction.length())).abs(),
        }
    }
}

/// What the bounds of a hit depend on, beside its range and the arithmetic.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MetFace {
    aspect: f64,
    longest_edge: f64,
    /// |o|, metres.
    origin: f64,
    /// c = cos(psi).
    cosine: f64,
}

impl MetFace {
    /// The bounds for a hit at `range` metres.
    #[inline]
    pub(crate) fn bounds(&self, range: f64, precision: Precision) -> HitBounds {
        let u = precision.unit_roundoff;
        let scale = range + self.longest_edge + self.origin;
        let range_bound = RANGE_ROUNDINGS * self.aspect * u * scale / self.cosine;
        HitBounds {
            range: range_bound,
            point: range_bound + POINT_ROUNDINGS * u * scale,
            normal: NORMAL_ROUNDINGS * self.aspect * u,
            cos_incidence: INCIDENCE_ROUNDINGS * self.aspect * u * scale / range,
        }
    }
}

/// Roundings of a point in the camera's frame, beside its own error: a subtraction, a rotation by a quaternion or a
/// matrix formed from it (15 u), of a vector no longer than S' = |P| + |c| + d.
const CAMERA_POINT_ROUNDINGS: f64 = 18.0;

/// Roundings of a flux beside those of its lengths and cosines: two dozen products and quotients, a share of the power
/// (four), an `exp` or two of `libm` (1 ulp, and the rounding of its argument).
const FLUX_ROUNDINGS: f64 = 64.0;

/// Error bounds of one pencil's return by one renderer.
///
/// Let dP = [`HitBounds::point`] + [`CAMERA_POINT_ROUNDINGS`] u S' bound the error of the point in the camera's frame,
/// let d be its distance from the projection centre and r its depth. Then r is off by at most dP, and the direction to
/// the point by the angle dP / d. cos(phi) is off by at most that angle, cos(theta) by the error of the normal as well.
/// The flux is a product of powers of these: its relative error is the sum of theirs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ReturnBounds {
    /// r, metres.
    pub(crate) depth: f64,
    /// cos(phi).
    pub(crate) cos_off_axis: f64,
    /// cos(theta).
    pub(crate) cos_view: f64,
    /// The flux, relative.
    pub(crate) flux: f64,
    /// The flux, watts (`eq1`: W/m): a share of the power below the smallest normal number has lost digits.
    pub(crate) subnormal_flux: f64,
}

/// The values that the bounds of a return depend on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReturnValues {
    /// R, metres.
    pub(crate) range: f64,
    /// cos(psi).
    pub(crate) cos_incidence: f64,
    /// r, metres.
    pub(crate) depth: f64,
    /// cos(phi).
    pub(crate) cos_off_axis: f64,
    /// cos(theta).
    pub(crate) cos_view: f64,
    /// d, metres.
    pub(crate) distance: f64,
}

impl ReturnValues {
    pub(crate) fn of_exact(scene: &Scene, hit: &Hit, exact: &Return) -> Self {
        Self {
            range: hit.range,
            cos_incidence: hit.cos_incidence,
            depth: exact.depth,
            cos_off_axis: exact.cos_off_axis,
            cos_view: exact.cos_view,
            distance: hit.point.distance(scene.camera().scene_from_sensor.position),
        }
    }

    /// The values that a side states; `None` if it leaves one out.
    pub(crate) fn of_stated(scene: &Scene, hit: &StatedHit<'_>, stated: &StatedReturn) -> Option<Self> {
        let (depth, cos_off_axis) = (stated.depth?, stated.cos_off_axis?);
        Some(Self {
            range: hit.range?,
            cos_incidence: hit.value(HitQuantity::CosIncidence)?.scalar()?,
            depth,
            cos_off_axis,
            cos_view: stated.cos_view?,
            distance: match hit.value(HitQuantity::Point).and_then(HitValue::vector) {
                Some(point) => point.distance(scene.camera().scene_from_sensor.position),
                None => (depth / cos_off_axis).abs(),
            },
        })
    }
}

impl ReturnBounds {
    /// The bounds of a return to the camera from a hit of a beam, the pencil being in `column`.
    pub(crate) fn of(
        scene: &Scene,
        (beam, column): (usize, u32),
        hit: &HitBounds,
        values: ReturnValues,
        precision: Precision,
        model: FluxModel,
    ) -> Self {
        let u = precision.unit_roundoff;
        let ReturnValues { range, cos_incidence, depth, cos_off_axis, cos_view, distance } = values;
        let centre = scene.camera().scene_from_sensor.position.length();
        let point = hit.point + CAMERA_POINT_ROUNDINGS * u * (2.0 * centre + 2.0 * distance);
        let direction = point / distance;
        let (off_axis_error, view_error) = (direction + 8.0 * u, direction + hit.normal + 8.0 * u);

        let beam = &scene.beams()[beam].sensor;
        let sigma = scene.atmosphere().attenuation;
        // A normalised profile is divided by a sum of as many weights.
        let weights = f64::from(beam.columns) * f64::from(beam.rows) * u;
        let sum = match beam.profile {
            Profile::Paper => 0.0,
            Profile::UniformAngle => weights,
            // An exponential is as relatively wrong as its exponent, 2 (alpha / w)^2, is absolutely: alpha is good
            // to 4 u, its square to 10 u, and the brightest weight, by which all may be divided, as well.
            Profile::Gaussian { half_width } => {
                let alpha = incidence_angle(beam, column) / half_width;
                weights + 2.0 * alpha * alpha * 20.0 * u
            }
        };
        let shared = (2.0 * point / depth + view_error / cos_view).abs() + FLUX_ROUNDINGS * u + sum;
        let relative = match model {
            FluxModel::Radiometric => {
                let filter = filter_bound(scene, beam, cos_off_axis, off_axis_error, u);
                shared
                    + (3.0 * off_axis_error / cos_off_axis).abs()
                    + filter
                    + sigma * (hit.range + point)
                    + sigma * (range + distance) * 4.0 * u
            }
            // phi is that of the pixel's centre: rounding only.
            FluxModel::Eq1 => {
                shared
                    + hit.range / range
                    + (hit.cos_incidence / cos_incidence).abs()
                    + filter_bound(scene, beam, cos_off_axis, 8.0 * u, u)
                    + sigma * (hit.range + point)
                    + sigma * (range + distance) * 4.0 * u
            }
        };
        // The error of a subnormal share, times all that it is multiplied by.
        let camera = &scene.camera().sensor;
        let squares = camera.aperture * camera.aperture / (depth * depth);
        let gain = match model {
            FluxModel::Radiometric => squares,
            FluxModel::Eq1 => {
                let area = camera.pixel_pitch[0] * camera.pixel_pitch[1];
                squares * area / (camera.focal_length * camera.focal_length * range)
            }
        };
        let subnormal_flux = min_normal(precision) * (1.0 + beam.power) * (1.0 + gain);
        Self {
            depth: point,
            cos_off_axis: off_axis_error,
            cos_view: view_error,
            flux: relative,
            subnormal_flux,
        }
    }

    /// The bounds by the scene's flux model, and by the other.
    pub(crate) fn by_both_models(
        scene: &Scene,
        pencil: (usize, u32),
        hit: &HitBounds,
        values: ReturnValues,
        precision: Precision,
    ) -> [Self; 2] {
        let model = scene.flux_model();
        [model, model.other()].map(|model| Self::of(scene, pencil, hit, values, precision, model))
    }

    /// The bound of a flux, watts (`eq1`: W/m).
    pub(crate) fn of_flux(&self, flux: f64) -> f64 {
        self.flux * flux + self.subnormal_flux
    }

    /// How far two renderers with these bounds may differ.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            depth: self.depth + other.depth,
            cos_off_axis: self.cos_off_axis + other.cos_off_axis,
            cos_view: self.cos_view + other.cos_view,
            flux: self.flux + other.flux,
            subnormal_flux: self.subnormal_flux + other.subnormal_flux,
        }
    }
}

/// The smallest normal number of an arithmetic: smaller numbers have lost digits.
pub(crate) fn min_normal(precision: Precision) -> f64 {
    let is_double = precision.unit_roundoff <= Precision::F64.unit_roundoff;
    if is_double { f64::MIN_POSITIVE } else { f64::from(f32::MIN_POSITIVE) }
}

/// alpha of the pencils of a column, to a few roundings.
fn incidence_angle(beam: &Beam, column: u32) -> f64 {
    let columns = f64::from(beam.columns);
    let half_cells = 2.0 * f64::from(column) + 1.0 - columns;
    libm::atan(beam.half_width * half_cells / (columns * beam.grid_distance))
}

/// The relative error of F(phi) = exp(-4 ln 2 away^2), away = (wavelength - c') / width, c' = c sqrt(1 - sin(phi)^2 /
/// n^2), where cos(phi) is off by `off_axis_error`.
///
/// |dc'| <= c^2 / (c' n^2) |cos(phi)| |d cos(phi)|, c' and the difference are rounded (8 u c), and the exponent
/// itself (10 u of it): |d ln F| = 4 ln 2 |away| (2 |dc'| / width + 10 u |away|).
fn filter_bound(scene: &Scene, beam: &Beam, cos_off_axis: f64, off_axis_error: f64, u: f64) -> f64 {
    let Filter::Interference { centre, width, index } = scene.camera().sensor.lens.filter else { return 0.0 };
    let sin_squared = (1.0 - cos_off_axis * cos_off_axis).max(0.0);
    let shifted = centre * (1.0 - sin_squared / (index * index)).sqrt();
    let shift_error = centre * centre / (shifted * index * index) * off_axis_error + 8.0 * u * centre;
    let away = ((beam.wavelength - shifted).abs() + shift_error) / width;
    4.0 * std::f64::consts::LN_2 * away * (2.0 * shift_error / width + 10.0 * u * away)
}

#[cfg(test)]
#[path = "../tests/unit/bounds.rs"]
mod tests;
