//! Returns of a beam's pencils, correctly rounded: a third evaluation beside the two renderers'.
//!
//! Every length and cosine is a quotient of polynomials in stored numbers, or the square root of one. `flux` has the
//! fluxes. A sum that lies exactly on a midpoint of two f64 cannot be told from its neighbours by any precision: it
//! stays [`Undecided`].

use std::cell::OnceCell;
use std::cmp::Ordering;
use std::sync::Arc;

use raypencil_scene::{FaceId, FluxModel, Pixel, Return, Sampling, SensorId};

use crate::hits::face::{ExactRay, Face};
use crate::hits::intersection::sign_of;
use crate::hits::verdict::Referee;
use crate::light::flux::{CameraTerms, Flux, FluxFormula, LitPoint, ReturnTerms};
use crate::light::shares::Shares;
use crate::numbers::arithmetic::{Arithmetic, Fast, Undecided, WeightSum, decide_rounding};
use crate::numbers::double_double::DoubleDouble;
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::{Format, Rounded, quotient, root};
use crate::rays::displacement::Displacement;
use crate::rays::ray::{Aim, MountedSensor};

/// A [`Return`] whose values are correctly rounded, with its flux by either model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundedReturn {
    /// Whether the camera sees the point.
    pub visible: bool,
    /// The pixel in which the point lands.
    pub pixel: Option<Pixel>,
    /// Depth r of the point in the camera, metres.
    pub depth: Rounded,
    /// cos(phi), phi being the angle between the camera's axis and the line to the point.
    pub cos_off_axis: Rounded,
    /// cos(theta), theta being the angle between the normal and the line to the camera.
    pub cos_view: Rounded,
    /// Flux by the model `radiometric`, watts.
    pub radiometric: Flux,
    /// Flux by the model `eq1`, W/m.
    pub eq1: Flux,
}

impl RoundedReturn {
    /// The flux by a model.
    pub fn flux(&self, model: FluxModel) -> Flux {
        match model {
            FluxModel::Radiometric => self.radiometric,
            FluxModel::Eq1 => self.eq1,
        }
    }

    /// The values in a format; of an undecided flux, one of the two nearest numbers.
    pub fn in_format(&self, format: Format, model: FluxModel) -> Return {
        let of = |rounded: Rounded| rounded.in_format(format);
        Return {
            visible: self.visible,
            pixel: self.pixel,
            depth: of(self.depth),
            cos_off_axis: of(self.cos_off_axis),
            cos_view: of(self.cos_view),
            flux: of(self.flux(model).unwrap_or_else(|undecided| undecided.0)),
        }
    }
}

/// A pencil that contributes to a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contribution {
    /// Column of the pencil.
    pub i: u32,
    /// Row of the pencil.
    pub j: u32,
    /// The face it lights.
    pub face: FaceId,
    /// The pixel in which it lands.
    pub pixel: Pixel,
}

/// The returns of one beam, pencil by pencil.
#[derive(Debug)]
pub struct BeamReturns<'r, 's> {
    referee: &'r Referee<'s>,
    beam: usize,
    shares: Shares,
}

impl<'s> Referee<'s> {
    /// The returns of a beam, or `None` if there is no such beam.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::Referee;
    /// use raypencil_scene::Sampling;
    ///
    /// let scene = wall_scene();
    /// let referee = Referee::new(&scene);
    /// let light = referee.light(0, Sampling::Centres).unwrap();
    /// let back = light.returned(0, 0).unwrap();
    /// // P = 4 W, r_d = 1/2, D = 1/512 m, r = 2 m, and cos(theta) = cos(phi) = 2 / sqrt(5):
    /// // P r_d (D^2 / 4) cos(theta) cos^3(phi) / r^2 = 2^-21 16/25 W.
    /// let watts = 16.0 / 25.0 / f64::from(1 << 21);
    /// assert_eq!(back.radiometric.unwrap().double, watts);
    /// ```
    pub fn light(&self, beam: usize, sampling: Sampling) -> Option<BeamReturns<'_, 's>> {
        let sensor = self.scene.beams().get(beam)?.sensor;
        // Without jitter the sum of the weights is the same for every call: the referee caches it.
        let weight_sum = match sampling {
            Sampling::Centres => Arc::clone(&self.weight_sums[beam]),
            Sampling::Jittered { .. } => Arc::new(WeightSum::default()),
        };
        Some(BeamReturns { referee: self, beam, shares: Shares::new(beam, sensor, sampling, weight_sum) })
    }
}

impl BeamReturns<'_, '_> {
    /// The displacement of a pencil's ray from the centre of its cell, cells.
    pub fn offset(&self, i: u32, j: u32) -> Displacement {
        self.shares.offset(i, j)
    }

    fn formula(&self) -> FluxFormula<'_> {
        FluxFormula { scene: self.referee.scene, shares: &self.shares }
    }

    /// The return of pencil (i, j); `None` if there is no such pencil, or it does not hit.
    pub fn returned(&self, i: u32, j: u32) -> Option<RoundedReturn> {
        self.returned_of_face(i, j).map(|(_, back)| back)
    }

    /// The return of pencil (i, j), and the face that it hits.
    pub(crate) fn returned_of_face(&self, i: u32, j: u32) -> Option<(FaceId, RoundedReturn)> {
        let sensor = self.beam_with(i, j)?;
        let aim = self.shares.aim(i, j);
        let nearest = self.referee.nearest(&sensor, aim);
        let face = nearest.first()?;
        let visibility = self.referee.visibility_of(&sensor, aim, face);
        let back = self.returned_seen(&sensor, aim, face, visibility.visible, visibility.pixel)?;
        Some((face.id, back))
    }

    /// The return of pencil (i, j) under the hypothesis that it hits the plane of `face`, with this visibility and
    /// pixel; `None` if there is no such pencil or face, or they are parallel.
    pub fn returned_as(
        &self,
        i: u32,
        j: u32,
        face: FaceId,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Option<RoundedReturn> {
        let sensor = self.beam_with(i, j)?;
        let face = self.referee.face(face)?;
        self.returned_seen(&sensor, self.shares.aim(i, j), &face, visible, pixel)
    }

    /// The flux that some pencils deliver together; an error if its rounding stays undecided, or if there is no such
    /// pencil or face.
    pub fn sum(&self, model: FluxModel, contributions: &[Contribution]) -> Flux {
        let lit: Option<Vec<(Contribution, MountedSensor, Face)>> = contributions
            .iter()
            .map(|one| Some((*one, self.beam_with(one.i, one.j)?, self.referee.face(one.face)?)))
            .collect();
        let lit = lit.ok_or(Undecided(Rounded::ZERO))?;
        match lit.as_slice() {
            [] => Ok(Rounded::ZERO),
            [(one, sensor, face)] => {
                let point = self.lit_point(sensor, self.shares.aim(one.i, one.j), face);
                point.flux(&self.formula(), model, one.pixel)
            }
            several => {
                let all: Vec<_> = several
                    .iter()
                    .map(|(one, sensor, face)| {
                        (self.lit_point(sensor, self.shares.aim(one.i, one.j), face), one.pixel)
                    })
                    .collect();
                let formula = self.formula();
                let mut fast = DoubleDouble::of(0.0);
                for (point, pixel) in &all {
                    fast =
                        fast.add(&formula.flux(&Fast, &point.fast(), point.aim, point.face, model, *pixel));
                }
                decide_rounding(fast, |precision| {
                    let parts = all.iter().map(|(point, pixel)| {
                        formula.flux(precision, &point.exact(), point.aim, point.face, model, *pixel)
                    });
                    parts.fold(precision.exact(0.0), |sum, part| precision.add(&sum, &part))
                })
            }
        }
    }

    /// The beam, if it has such a pencil.
    fn beam_with(&self, i: u32, j: u32) -> Option<MountedSensor> {
        let sensor = MountedSensor::of(self.referee.scene, SensorId::Beam(self.beam))?;
        let (columns, rows) = sensor.size();
        (i < columns && j < rows).then_some(sensor)
    }

    /// The point where an aim meets the plane of `face`.
    fn lit_point<'a>(&'a self, sensor: &'a MountedSensor, aim: Aim, face: &'a Face) -> LitPoint<'a> {
        LitPoint { camera: self.referee.scene.camera(), ray: ExactRay::new(sensor, aim), sensor, aim, face }
    }

    /// The return of an aim that meets the plane of `face`, with this visibility and pixel.
    pub(crate) fn returned_seen(
        &self,
        sensor: &MountedSensor,
        aim: Aim,
        face: &Face,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Option<RoundedReturn> {
        let point = self.lit_point(sensor, aim, face);
        let fast = point.fast();
        let is_parallel =
            |exact: &ReturnTerms<Dyadic>| exact.intersection.approach.sign() == Some(Ordering::Equal);
        if fast.intersection.approach.sign().is_none_or(Ordering::is_eq) && is_parallel(&point.exact()) {
            return None;
        }
        let exact = OnceCell::new();
        let exact = || exact.get_or_init(|| point.exact());
        let CameraTerms { direction_squared, towards, axial, squared, scale, frame_scale } = &fast.camera;
        let depth = axial.over(&frame_scale.mul(scale)).rounded().unwrap_or_else(|| {
            let CameraTerms { axial, scale, frame_scale, .. } = &exact().camera;
            quotient(axial, &frame_scale.mul(scale))
        });
        let cos_off_axis = axial.over(&squared.sqrt()).rounded().unwrap_or_else(|| {
            let CameraTerms { axial, squared, .. } = &exact().camera;
            cosine(axial, squared)
        });
        let length = direction_squared.mul(&fast.intersection.normal_squared).sqrt();
        let cos_view = towards.over(&length).rounded().unwrap_or_else(|| {
            let CameraTerms { towards, direction_squared, .. } = &exact().camera;
            cosine(towards, &direction_squared.mul(&exact().intersection.normal_squared))
        });
        let flux = |model| match (visible, pixel) {
            (true, Some(pixel)) => point.flux(&self.formula(), model, pixel),
            _ => Ok(Rounded::ZERO),
        };
        Some(RoundedReturn {
            visible,
            pixel,
            depth,
            cos_off_axis,
            cos_view,
            radiometric: flux(FluxModel::Radiometric),
            eq1: flux(FluxModel::Eq1),
        })
    }
}

/// The cosine part / sqrt(squared). CHOICE: a point in the projection centre itself, which has no angle, has cosines
/// of 0.
fn cosine(part: &Dyadic, squared: &Dyadic) -> Rounded {
    if squared.sign() == Some(Ordering::Equal) {
        return Rounded::ZERO;
    }
    root(sign_of(part), &part.square(), squared)
}

#[cfg(test)]
#[path = "../../tests/unit/beam_returns.rs"]
mod tests;
