//! When the referee is asked, and with what tolerance.

use crate::bounds::Bounds;
use raypencil_referee::{
    Approximations, Displacement, Explained, ExplainedVisibility, Format, Referee, RoundedReturn, Ruling,
    Tolerance, VisibilityApproximations, VisibilityRuling,
};
use raypencil_scene::Place;
use raypencil_scene::{FaceId, Hit, Pixel, Precision, Return, Sampling, Scene, SensorId};

/// Which of the rays that agree are judged as well; those that do not are always judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum JudgeShare {
    /// One in a hundred or more, chosen by a hash of the cell.
    #[default]
    Sample,
    /// All of them.
    All,
}

/// One in so many rays that agree is judged: 64, so that chance does not leave less than 1 %.
const ONE_IN: u64 = 64;

/// Roundings of a direction: a vertex is subtracted from the origin and turned into the sensor's frame (15 u S,
/// see `bounds`), and an edge's crossing formed from it (6 u S). As an angle, divided by the range.
const DIRECTION: f64 = 21.0;

/// The finest lateral resolution that any renderer is held to, in cells.
const FINEST: f64 = 1e-9;

/// The referee, and whom it asks.
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

    /// Whether a ray that agrees is judged.
    pub fn samples(&self, place: Place) -> bool {
        self.share == JudgeShare::All || hash(place).is_multiple_of(ONE_IN)
    }

    /// Rules on one side's answer to a ray, with the range it gave if it gave one.
    pub fn rule(
        &self,
        place: Place,
        answer: Option<FaceId>,
        range: Option<f64>,
        precision: Precision,
    ) -> Ruling {
        let tolerance = self.tolerance(place, answer, range, precision);
        // A face that the mesh does not have is as wrong as can be.
        self.referee.rule(place.sensor, place.i, place.j, answer, tolerance).unwrap_or(Ruling::Wrong)
    }

    /// Rules on what one side says of the camera's view of a pencil's hit on `face`.
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

    /// The values of where a ray meets the plane of a face, the nearest f64; `None` if they are not finite.
    pub fn plane_hit(&self, Place { sensor, i, j }: Place, face: FaceId) -> Option<Hit> {
        let hit = self.referee.plane_hit(sensor, i, j, face)?.in_format(Format::Double);
        (hit.range.is_finite() && hit.range > 0.0 && hit.point.is_finite()).then_some(hit)
    }

    /// What comes back of a pencil from the plane of a face, seen or not and landing as is said.
    pub fn returned_as(
        &self,
        place: Place,
        face: FaceId,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Option<Return> {
        let back = self.rounded_return(place, face, visible, pixel)?;
        Some(back.in_format(Format::Double, self.scene.flux_model()))
    }

    /// What comes back of a pencil from the plane of a face, by both models, correctly rounded.
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

    /// The faces that a ray may meet which is displaced by no more than a renderer may displace it.
    pub fn candidate_faces(&self, place: Place, range: Option<f64>, precision: Precision) -> Vec<FaceId> {
        let Tolerance { lateral, .. } = self.tolerance(place, None, range, precision);
        self.referee.candidate_faces(place.sensor, place.i, place.j, lateral).unwrap_or_default()
    }

    /// Explains one side's answer to a ray by the approximations it was made with; `None` if they do not.
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

    /// Explains what one side says of whether the camera sees a pencil's hit; `None` if the approximations do not.
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

    /// delta and epsilon of a renderer at this ray. delta = max(1e-9 cell, 21 u S / R as an angle, or 21 u S
    /// as a length along the focal axis, in cells); epsilon is the bound of the range.
    fn tolerance(
        &self,
        Place { sensor, i, j }: Place,
        answer: Option<FaceId>,
        claimed: Option<f64>,
        precision: Precision,
    ) -> Tolerance {
        let scene = self.scene;
        let (Some(ray), Some(max_range)) = (scene.ray(sensor, i, j), scene.max_range(sensor)) else {
            return Tolerance { lateral: FINEST, depth: 0.0, position: 0.0 };
        };
        let mesh = scene.mesh();
        let known = answer.filter(|face| (face.0 as usize) < mesh.faces().len());
        // The range of the face itself: what is claimed must not set the tolerance that it is judged by.
        let place = Place { sensor, i, j };
        let range = known.and_then(|face| self.plane_hit(place, face)).map(|hit| hit.range);
        let range = range.or(claimed.filter(|range| range.is_finite() && *range > 0.0)).unwrap_or(max_range);
        let depth = known.map_or(0.0, |face| Bounds::of(mesh, face, &ray, range, precision).range);
        let edge = known.map_or(0.0, |face| longest_edge(scene, face));
        let error = DIRECTION * precision.unit_roundoff * (range + edge + ray.origin.length());
        let q = ray.direction.length();
        // The smallest angle between neighbouring cells' rays here: across the ray, a cell is at least its
        // size times the cosine of the obliquity.
        let lateral = match sensor {
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
        };
        Tolerance { lateral: lateral.clamp(FINEST, 1.0), depth, position: error }
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
fn hash(Place { sensor, i, j }: Place) -> u64 {
    let sensor = match sensor {
        SensorId::Camera => 0,
        SensorId::Beam(index) => index as u64 + 1,
    };
    let mut x = (u64::from(i) << 32 | u64::from(j)).wrapping_add(sensor.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
