//! The judge: which rays the referee is asked about, and with what tolerance.

use crate::bounds::{DIRECTION_ROUNDINGS, FaceShape, HitBounds};
use raypencil_referee::{
    Approximations, Displacement, Explained, ExplainedVisibility, Format, Referee, RefereeTree,
    RoundedReturn, Ruling, Tolerance, VisibilityApproximations, VisibilityRuling,
};
use raypencil_scene::{FaceId, Hit, Pixel, Place, Precision, Ray, Return, Sampling, Scene, SensorId};

/// Rays of agreeing answers that are judged as well; rays of differing answers are always judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum JudgeShare {
    /// One in a hundred or more, chosen by a hash of the cell.
    #[default]
    Sample,
    /// All of them.
    All,
}

/// Number of rays of which one is sampled: 64, so that chance does not leave less than 1 % of them.
const SAMPLE_ONE_IN_RAYS: u64 = 64;

/// The smallest lateral tolerance that any renderer is held to, in cells.
const MIN_LATERAL_TOLERANCE_CELLS: f64 = 1e-9;

/// The referee, and the rays that it is asked about.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// # use raypencil_scene::{Atmosphere, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pose, Scene};
/// # let corners = vec![[0.125, -40.0, 2.0], [-90.0, 0.0, 2.0], [0.125, 40.0, 2.0]];
/// # let plaster = Material { name: "plaster".into(), reflectivity: 0.5 };
/// # let wall = Mesh::new(DVec3::ZERO, corners, vec![[0, 1, 2]], vec![0], vec![plaster])?;
/// # let camera = Camera {
/// #     width: 9, height: 9, pixel_pitch: [0.0625; 2], focal_length: 0.5, principal_point: [4.5; 2],
/// #     aperture: 0.01, lens: Lens::CLEAR, max_range: 20.0,
/// # };
/// # let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(wall), camera, vec![], air, FluxModel::Radiometric)?;
/// // A wall at z = 2 m that ends at x = 1/8 m, before a camera of 9 x 9 pixels at the origin that looks along z.
/// use raypencil_judge::{Judge, JudgeShare};
/// use raypencil_referee::Ruling;
/// use raypencil_scene::{FaceId, Place, Precision, SensorId};
///
/// let judge = Judge::new(&scene, JudgeShare::Sample);
/// let rule = |i| {
///     let place = Place { sensor: SensorId::Camera, i, j: 4 };
///     judge.rule(place, Some(FaceId(0)), Some(2.0), Precision::F64)
/// };
/// // Pixel (4, 4) hits the wall at x = 0. Pixel (5, 4) passes it at x = 1/4 m, half a pixel from its edge.
/// assert_eq!(rule(4), Ruling::Exact);
/// assert_eq!(rule(5), Ruling::Wrong);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug)]
pub struct Judge<'s> {
    referee: Referee<'s>,
    scene: &'s Scene,
    share: JudgeShare,
}

impl<'s> Judge<'s> {
    /// Prepares to judge the rays of `scene`.
    pub fn new(scene: &'s Scene, share: JudgeShare) -> Self {
        Self { referee: Referee::new(scene), scene, share }
    }

    /// The same with a hierarchy that was built for the scene's mesh before.
    ///
    /// # Panics
    /// If it was built for another mesh.
    pub fn on(scene: &'s Scene, tree: &RefereeTree, share: JudgeShare) -> Self {
        Self { referee: Referee::on(scene, tree), scene, share }
    }

    /// Whether a ray of agreeing answers is judged.
    pub fn samples(&self, place: Place) -> bool {
        self.share == JudgeShare::All || hash(place).is_multiple_of(SAMPLE_ONE_IN_RAYS)
    }

    /// Rules on the face that one side states for a ray (`None`: no hit), with the range if it states one.
    pub fn rule(
        &self,
        place: Place,
        answer: Option<FaceId>,
        range: Option<f64>,
        precision: Precision,
    ) -> Ruling {
        let tolerance = || {
            let tolerance = self.tolerance(place, answer, range, precision);
            // The named face may be found beside its edge, and a nearest face before it be lost there.
            let range_of = |face: FaceId| self.plane_hit(place, face).map_or(f64::INFINITY, |hit| hit.range);
            let named = answer.map_or(f64::INFINITY, range_of);
            let nearest = self.referee.verdict(place.sensor, place.i, place.j);
            let lost = nearest.into_iter().flat_map(|nearest| nearest.faces);
            let faces = lost.filter(|face| range_of(*face) < named).chain(answer);
            let slips = faces.filter_map(|face| self.lateral_of(place, face, precision));
            Tolerance { lateral: slips.fold(tolerance.lateral, f64::max).min(1.0), ..tolerance }
        };
        // A face that the mesh does not have is as wrong as can be.
        self.referee.rule_within(place.sensor, place.i, place.j, answer, tolerance).unwrap_or(Ruling::Wrong)
    }

    /// Rules on the visibility and the pixel that one side states for a pencil's hit on `face`.
    pub fn rule_visibility(
        &self,
        place: Place,
        face: FaceId,
        range: Option<f64>,
        visible: bool,
        pixel: Option<Pixel>,
        precision: Precision,
    ) -> Option<VisibilityRuling> {
        let SensorId::Beam(beam) = place.sensor else { return None };
        let tolerance = self.tolerance(place, Some(face), range, precision);
        let Place { i, j, .. } = place;
        self.referee.rule_visibility(beam, i, j, Displacement::ZERO, face, visible, pixel, tolerance)
    }

    /// The hit of a ray on the plane of a face, rounded to the nearest f64; `None` if it is not finite.
    pub fn plane_hit(&self, Place { sensor, i, j }: Place, face: FaceId) -> Option<Hit> {
        let hit = self.referee.plane_hit(sensor, i, j, face)?.in_format(Format::Double);
        (hit.range.is_finite() && hit.range > 0.0 && hit.point.is_finite()).then_some(hit)
    }

    /// The return of a pencil from the plane of a face, with this visibility and this pixel, rounded to f64.
    pub fn returned_as(
        &self,
        place: Place,
        face: FaceId,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Option<Return> {
        let exact = self.rounded_return(place, face, visible, pixel)?;
        Some(exact.in_format(Format::Double, self.scene.flux_model()))
    }

    /// The return of a pencil from the plane of a face, by both flux models, correctly rounded.
    pub fn rounded_return(
        &self,
        Place { sensor, i, j }: Place,
        face: FaceId,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Option<RoundedReturn> {
        let SensorId::Beam(beam) = sensor else { return None };
        self.referee.light(beam, Sampling::Centres)?.returned_as(i, j, face, visible, pixel)
    }

    /// The faces that a ray may meet if it is displaced by no more than this precision may displace it.
    pub fn candidate_faces(&self, place: Place, range: Option<f64>, precision: Precision) -> Vec<FaceId> {
        let Tolerance { lateral, .. } = self.tolerance(place, None, range, precision);
        self.referee.candidate_faces(place.sensor, place.i, place.j, lateral).unwrap_or_default()
    }

    /// Explains the face that one side states by the approximations it uses; `None` if they do not explain it.
    pub fn explain(
        &self,
        place: Place,
        answer: Option<FaceId>,
        range: Option<f64>,
        with: Approximations,
        precision: Precision,
    ) -> Option<Vec<Explained>> {
        let tolerance = self.tolerance(place, answer, range, precision);
        self.referee.explain(place.sensor, place.i, place.j, answer, with, tolerance)
    }

    /// Explains the visibility that one side states by the approximations it uses; `None` if they do not explain it.
    pub fn explain_visibility(
        &self,
        place: Place,
        face: FaceId,
        range: Option<f64>,
        visible: bool,
        with: VisibilityApproximations,
        precision: Precision,
    ) -> Option<Vec<ExplainedVisibility>> {
        let SensorId::Beam(beam) = place.sensor else { return None };
        let tolerance = self.tolerance(place, Some(face), range, precision);
        self.referee.explain_visibility(beam, place.i, place.j, face, visible, with, tolerance)
    }

    /// Tolerances delta and epsilon of a renderer at this ray, but for [the slip of edges](Self::lateral_of). delta = max(1e-9
    /// cell, 21 u S / R as an angle, or 21 u S as a length along the focal axis, in cells); epsilon is the bound of the range.
    fn tolerance(
        &self,
        Place { sensor, i, j }: Place,
        answer: Option<FaceId>,
        stated_range: Option<f64>,
        precision: Precision,
    ) -> Tolerance {
        let scene = self.scene;
        let (Some(ray), Some(max_range)) = (scene.ray(sensor, i, j), scene.max_range(sensor)) else {
            return Tolerance {
                lateral: MIN_LATERAL_TOLERANCE_CELLS,
                depth: 0.0,
                position: 0.0,
                unit_roundoff: precision.unit_roundoff,
            };
        };
        let mesh = scene.mesh();
        let known = answer.filter(|face| (face.0 as usize) < mesh.faces().len());
        // The range of the face itself, also where its plane is behind the ray: a stated range must not set the tolerance that
        // it is judged by.
        let of_plane = known.and_then(|face| self.referee.plane_hit(sensor, i, j, face));
        let range =
            of_plane.map(|hit| hit.in_format(Format::Double).range.abs()).filter(|range| range.is_finite());
        let stated_range = stated_range.filter(|range| range.is_finite() && *range > 0.0);
        let range = range.or(stated_range).unwrap_or(max_range);
        let depth = known.map_or(0.0, |face| HitBounds::of(mesh, face, &ray, range, precision).range);
        let edge = known.map_or(0.0, |face| longest_edge(scene, face));
        let error = DIRECTION_ROUNDINGS * precision.unit_roundoff * (range + edge + ray.origin.length());
        let lateral = self.cells(sensor, &ray, error, range);
        Tolerance {
            lateral: lateral.clamp(MIN_LATERAL_TOLERANCE_CELLS, 1.0),
            depth,
            position: error,
            unit_roundoff: precision.unit_roundoff,
        }
    }

    /// How far a face's edges may seem displaced to a program that forms the point on its plane first, cells; `None` if there is
    /// no such face, or the ray is parallel to it.
    fn lateral_of(
        &self,
        place @ Place { sensor, i, j }: Place,
        face: FaceId,
        precision: Precision,
    ) -> Option<f64> {
        let ray = self.scene.ray(sensor, i, j)?;
        let is_known = (face.0 as usize) < self.scene.mesh().faces().len();
        let exact = is_known.then(|| self.referee.plane_hit(sensor, i, j, face))??.in_format(Format::Double);
        let range = exact.range.abs();
        if !range.is_finite() {
            return None;
        }
        let slip = FaceShape::of(self.scene.mesh(), face).lateral(&ray, range, precision);
        Some(self.cells(place.sensor, &ray, slip, range))
    }

    /// A displacement across a ray, metres at this range, in cells of the sensor: the most that it may be.
    fn cells(&self, sensor: SensorId, ray: &Ray, error: f64, range: f64) -> f64 {
        let scene = self.scene;
        let q = ray.direction.length();
        // The smallest angle between neighbouring cells' rays here: across the ray, a cell is at least its
        // size times the cosine of the obliquity.
        match sensor {
            SensorId::Camera => {
                let camera = &scene.camera().sensor;
                let cell = camera.pixel_pitch[0].min(camera.pixel_pitch[1]) * camera.focal_length / (q * q);
                error / range / cell
            }
            SensorId::Beam(index) => {
                let beam = &scene.beams()[index].sensor;
                let width = 2.0 * beam.half_width / f64::from(beam.columns);
                let cell = width * beam.grid_distance / (q * q);
                let row = beam.thickness / f64::from(beam.rows);
                (error / range / cell).max(error / row)
            }
        }
    }

    /// The scene whose rays are judged.
    pub fn scene(&self) -> &'s Scene {
        self.scene
    }

    /// The referee itself, for questions about single rays.
    pub fn referee(&self) -> &Referee<'s> {
        &self.referee
    }
}

/// The longest edge of a face, metres.
fn longest_edge(scene: &Scene, face: FaceId) -> f64 {
    let corner = |v: u32| glam::Vec3::from_array(scene.mesh().vertices()[v as usize]).as_dvec3();
    let [a, b, c] = scene.mesh().faces()[face.0 as usize].map(corner);
    (b - a).length().max((c - b).length()).max((a - c).length())
}

/// A fixed hash of a cell (the finaliser of splitmix64), so that the sample is the same in every run.
pub(crate) fn hash(Place { sensor, i, j }: Place) -> u64 {
    let sensor = match sensor {
        SensorId::Camera => 0,
        SensorId::Beam(index) => index as u64 + 1,
    };
    let mut x = (u64::from(i) << 32 | u64::from(j)).wrapping_add(sensor.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
#[path = "../tests/unit/judge.rs"]
mod tests;
