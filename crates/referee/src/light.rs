//! What comes back of a pencil, correctly rounded: a third evaluation beside the renderers'.
//!
//! Every length and cosine is a quotient of polynomials of stored numbers, or the root of one. So is the flux, in
//! the radiometric model without air and filter and with the paper's own profile. Otherwise it has factors pi,
//! exp and atan, or a sum of as many roots as there are pencils; such numbers are enclosed with growing precision until
//! their rounding is certain. A sum that lies exactly on a midpoint would never be: then the budget
//! ends, and the value is [`Undecided`].

use std::cell::OnceCell;
use std::cmp::Ordering;
use std::sync::Arc;

use dashu_int::Sign;
use raypencil_scene::{
    Beam, Camera, FaceId, Filter, FluxModel, Mounted, Pixel, Profile, Return, Sampling, SensorId,
};

use crate::arithmetic::{Arithmetic, Fast, Undecided, Whole, decide};
use crate::face::{ExactRay, Face};
use crate::number::{Dyadic, Number};
use crate::pencil::{Aim, ScaledRay, Sensor};
use crate::rounding::{Format, Rounded, quotient, root};
use crate::sight::{ExactWay, Way};
use crate::twofold::Twofold;
use crate::values::{Meeting, minus, sign_of};
use crate::vector::Vector;
use crate::verdict::{Displacement, Referee};

/// A flux, correctly rounded; an error if the budget ran out.
pub type Flux = Result<Rounded, Undecided>;

/// A [`Return`] whose values are correctly rounded, its flux by either model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundedReturn {
    /// Whether the camera sees the point.
    pub visible: bool,
    /// Where it lands.
    pub pixel: Option<Pixel>,
    /// r, metres.
    pub depth: Rounded,
    /// cos(phi).
    pub off_axis: Rounded,
    /// cos(theta).
    pub emission: Rounded,
    /// By the model `radiometric`, watts.
    pub radiometric: Flux,
    /// By the model `eq1`, W/m.
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

    /// The nearest numbers of a format; of a flux that is undecided, one of the two nearest.
    pub fn in_format(&self, format: Format, model: FluxModel) -> Return {
        let of = |rounded: Rounded| rounded.in_format(format);
        Return {
            visible: self.visible,
            pixel: self.pixel,
            depth: of(self.depth),
            off_axis: of(self.off_axis),
            emission: of(self.emission),
            flux: of(self.flux(model).unwrap_or_else(|undecided| undecided.0)),
        }
    }
}

/// A pencil that delivers, to be summed: its ray and face, and the pixel that it lands in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contribution {
    /// Column of the pencil.
    pub i: u32,
    /// Row of the pencil.
    pub j: u32,
    /// The face it lights.
    pub face: FaceId,
    /// The pixel.
    pub pixel: Pixel,
}

/// The returns of one beam, pencil by pencil.
#[derive(Debug)]
pub struct Light<'r, 's> {
    referee: &'r Referee<'s>,
    beam: usize,
    mounted: Mounted<Beam>,
    sampling: Sampling,
    /// The weights of all pencils, added up.
    whole: Arc<Whole>,
    /// Certainly no more than (alpha / w)^2 of any pencil of a Gaussian, and near the least. All weights are divided by
    /// exp(-2 this), which changes no share: a Gaussian may be so narrow that all would vanish.
    brightest: f64,
}

/// What of the camera's view the values need.
struct Seen<T> {
    /// V^2.
    along_squared: T,
    /// -n.V.
    towards: T,
    /// Z.
    axial: T,
    /// X^2 + Y^2 + Z^2.
    squared: T,
    /// W.
    scale: T,
    /// N.
    frame_scale: T,
}

impl<T: Number> Seen<T> {
    fn new(way: &Way<T>, normal: &Vector<T>) -> Self {
        Self {
            along_squared: way.along.length_squared(),
            towards: minus(&normal.dot(&way.along)),
            axial: way.seen.0[2].clone(),
            squared: way.seen.length_squared(),
            scale: way.scale.clone(),
            frame_scale: way.frame_scale.clone(),
        }
    }
}

/// Everything about one pencil's light, in one kind of number.
struct Lit<T> {
    meeting: Meeting<T>,
    seen: Seen<T>,
}

impl<'s> Referee<'s> {
    /// The returns of a beam, or `None` if there is no such beam.
    pub fn light(&self, beam: usize, sampling: Sampling) -> Option<Light<'_, 's>> {
        let mounted = *self.scene.beams().get(beam)?;
        // The sum of the central pencils' weights is kept: it is asked for again and again.
        let whole = match sampling {
            Sampling::Centres => Arc::clone(&self.wholes[beam]),
            Sampling::Jittered { .. } => Arc::new(Whole::default()),
        };
        let mut light = Light { referee: self, beam, mounted, sampling, whole, brightest: 0.0 };
        if let Profile::Gaussian { half_width } = mounted.sensor.profile {
            light.brightest = light.least_exponent(half_width);
        }
        Some(light)
    }
}

impl Light<'_, '_> {
    /// By how much the ray of a pencil is displaced, in cells.
    pub fn offset(&self, i: u32, j: u32) -> Displacement {
        let [dx, dy] = self.sampling.offset(self.beam, i, j);
        Displacement { dx, dy }
    }

    fn aim(&self, i: u32, j: u32) -> Aim {
        let Displacement { dx, dy } = self.offset(i, j);
        Aim { i, j, dx, dy }
    }

    /// x and z of a pencil's ray, in units of 1 / columns: (w (2i + 1 - columns + 2 dx), columns g).
    fn across_and_ahead<T: Number>(&self, i: u32, j: u32) -> [T; 2] {
        let Beam { columns, half_width, grid_distance, .. } = self.mounted.sensor;
        let whole = T::of(2.0 * f64::from(i) + 1.0 - f64::from(columns));
        let half_cells = whole.add(&T::of(self.offset(i, j).dx).doubled());
        [T::of(half_width).mul(&half_cells), T::of_integer(columns).mul(&T::of(grid_distance))]
    }

    /// What of the beam's power goes to a pencil, before it is divided by the whole.
    fn weight<A: Arithmetic>(&self, a: &A, i: u32, j: u32) -> A::Real {
        let [x, z] = self.across_and_ahead::<A::Exact>(i, j);
        let squared = a.size(&x.square().add(&z.square()));
        match self.mounted.sensor.profile {
            Profile::Paper => {
                let pencils = A::Exact::of_integer(self.mounted.sensor.columns)
                    .mul(&A::Exact::of_integer(self.mounted.sensor.rows));
                a.div(&a.size(&z), &a.mul(&a.sqrt(&squared), &a.size(&pencils)))
            }
            Profile::UniformAngle => a.div(&a.size(&z.square()), &squared),
            Profile::Gaussian { half_width } => {
                let alpha = a.atan(&a.div(&a.size(&x), &a.size(&z)));
                let relative = a.div(&alpha, &a.exactly(half_width));
                let beyond = a.distance(&a.mul(&relative, &relative), &a.exactly(self.brightest));
                a.exp_minus(&a.mul(&a.exactly(2.0), &beyond))
            }
        }
    }

    /// The share of the beam's power that goes to a pencil.
    fn share<A: Arithmetic>(&self, a: &A, i: u32, j: u32) -> A::Real {
        let weight = self.weight(a, i, j);
        if self.mounted.sensor.profile == Profile::Paper {
            return weight;
        }
        let whole = a.whole(&self.whole, || {
            let Beam { columns, rows, .. } = self.mounted.sensor;
            // The rows of central pencils are alike.
            let rows_alike = self.sampling == Sampling::Centres;
            let different = if rows_alike { 1 } else { rows };
            let pencils = (0..different).flat_map(|j| (0..columns).map(move |i| (i, j)));
            let sum = pencils.map(|(i, j)| self.weight(a, i, j)).reduce(|sum, weight| a.add(&sum, &weight));
            let sum = sum.unwrap_or_else(|| a.exactly(0.0));
            if rows_alike { a.mul(&sum, &a.size(&A::Exact::of_integer(rows))) } else { sum }
        });
        a.div(&weight, &whole)
    }

    /// The least (alpha / w)^2 of all pencils but for a billionth of it, which is far more than it is off in f64; 0 if
    /// it is small anyway.
    fn least_exponent(&self, half_width: f64) -> f64 {
        let Beam { columns, rows, half_width: w, grid_distance, .. } = self.mounted.sensor;
        let different = if self.sampling == Sampling::Centres { 1 } else { rows };
        let pencils = (0..different).flat_map(|j| (0..columns).map(move |i| (i, j)));
        let half_cells = |(i, j)| 2.0 * f64::from(i) + 1.0 - f64::from(columns) + 2.0 * self.offset(i, j).dx;
        let nearest = pencils.map(|cell| half_cells(cell).abs()).fold(f64::INFINITY, f64::min);
        let relative = libm::atan(w * nearest / (f64::from(columns) * grid_distance)) / half_width;
        let exponent = relative * relative;
        if exponent < 100.0 { 0.0 } else { exponent * (1.0 - 1e-9) }
    }

    /// What comes back of pencil (i, j); `None` if there is no such pencil, or it does not hit.
    pub fn returned(&self, i: u32, j: u32) -> Option<RoundedReturn> {
        self.returned_of_face(i, j).map(|(_, back)| back)
    }

    /// The same, and the face.
    pub(crate) fn returned_of_face(&self, i: u32, j: u32) -> Option<(FaceId, RoundedReturn)> {
        let sensor = self.sensor_with(i, j)?;
        let aim = self.aim(i, j);
        let nearest = self.referee.nearest(&sensor, aim);
        let face = nearest.first()?;
        let sight = self.referee.sight_of(&sensor, aim, face);
        let back = self.returned_seen(&sensor, aim, face, sight.visible, sight.pixel)?;
        Some((face.id, back))
    }

    /// What comes back of pencil (i, j) from where its ray meets the plane of `face`, if the point is seen or not, and
    /// lands where, as is said; `None` if there is no such pencil or face, or they are parallel.
    pub fn returned_as(
        &self,
        i: u32,
        j: u32,
        face: FaceId,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Option<RoundedReturn> {
        let sensor = self.sensor_with(i, j)?;
        let face = self.referee.face(face)?;
        self.returned_seen(&sensor, self.aim(i, j), &face, visible, pixel)
    }

    /// What some pencils deliver together; an error if the budget ran out, or there is no such pencil or face.
    pub fn sum(&self, model: FluxModel, contributions: &[Contribution]) -> Flux {
        let lit: Option<Vec<(Contribution, Sensor, Face)>> = contributions
            .iter()
            .map(|one| Some((*one, self.sensor_with(one.i, one.j)?, self.referee.face(one.face)?)))
            .collect();
        let lit = lit.ok_or(Undecided(Rounded::ZERO))?;
        match lit.as_slice() {
            [] => Ok(Rounded::ZERO),
            [(one, sensor, face)] => {
                let rays = self.rays(sensor, self.aim(one.i, one.j), face);
                rays.flux(self, model, one.pixel)
            }
            several => {
                let all: Vec<_> = several
                    .iter()
                    .map(|(one, sensor, face)| (self.rays(sensor, self.aim(one.i, one.j), face), one.pixel))
                    .collect();
                let mut fast = Twofold::of(0.0);
                for (rays, pixel) in &all {
                    fast = fast.add(&self.flux(&Fast, &rays.fast(), rays.aim, rays.face, model, *pixel));
                }
                decide(fast, |precision| {
                    let parts = all.iter().map(|(rays, pixel)| {
                        self.flux(precision, &rays.exact(), rays.aim, rays.face, model, *pixel)
                    });
                    parts.fold(precision.exactly(0.0), |sum, part| precision.add(&sum, &part))
                })
            }
        }
    }

    /// The beam, if it has such a pencil.
    fn sensor_with(&self, i: u32, j: u32) -> Option<Sensor> {
        let sensor = Sensor::of(self.referee.scene, SensorId::Beam(self.beam))?;
        let (columns, rows) = sensor.size();
        (i < columns && j < rows).then_some(sensor)
    }

    fn rays<'a>(&'a self, sensor: &'a Sensor, aim: Aim, face: &'a Face) -> Rays<'a> {
        Rays { camera: self.referee.scene.camera(), ray: ExactRay::new(sensor, aim), sensor, aim, face }
    }

    /// What comes back of an aim that meets the plane of `face`.
    pub(crate) fn returned_seen(
        &self,
        sensor: &Sensor,
        aim: Aim,
        face: &Face,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Option<RoundedReturn> {
        let rays = self.rays(sensor, aim, face);
        let fast = rays.fast();
        let is_parallel = |exact: &Lit<Dyadic>| exact.meeting.approach.sign() == Some(Ordering::Equal);
        if fast.meeting.approach.sign().is_none_or(Ordering::is_eq) && is_parallel(&rays.exact()) {
            return None;
        }
        let exact = OnceCell::new();
        let exact = || exact.get_or_init(|| rays.exact());
        let Seen { along_squared, towards, axial, squared, scale, frame_scale } = &fast.seen;
        let depth = axial.over(&frame_scale.mul(scale)).rounded().unwrap_or_else(|| {
            let Seen { axial, scale, frame_scale, .. } = &exact().seen;
            quotient(axial, &frame_scale.mul(scale))
        });
        let off_axis = axial.over(&squared.sqrt()).rounded().unwrap_or_else(|| {
            let Seen { axial, squared, .. } = &exact().seen;
            cosine(axial, squared)
        });
        let length = along_squared.mul(&fast.meeting.normal_squared).sqrt();
        let emission = towards.over(&length).rounded().unwrap_or_else(|| {
            let Seen { towards, along_squared, .. } = &exact().seen;
            cosine(towards, &along_squared.mul(&exact().meeting.normal_squared))
        });
        let flux = |model| match (visible, pixel) {
            (true, Some(pixel)) => rays.flux(self, model, pixel),
            _ => Ok(Rounded::ZERO),
        };
        Some(RoundedReturn {
            visible,
            pixel,
            depth,
            off_axis,
            emission,
            radiometric: flux(FluxModel::Radiometric),
            eq1: flux(FluxModel::Eq1),
        })
    }

    /// What a pencil that meets the plane of `face` delivers to `pixel`.
    fn flux<A: Arithmetic>(
        &self,
        a: &A,
        lit: &Lit<A::Exact>,
        aim: Aim,
        face: &Face,
        model: FluxModel,
        pixel: Pixel,
    ) -> A::Real {
        let scene = self.referee.scene;
        let camera = &scene.camera().sensor;
        let Lit { meeting, seen } = lit;
        let product = |factors: &[A::Real]| {
            let rest = factors[1..].iter();
            rest.fold(factors[0].clone(), |product, factor| a.mul(&product, factor))
        };
        let square = |x: &A::Real| a.mul(x, x);
        // P_k r_d C_loss D^2 / 4.
        let power = product(&[
            self.share(a, aim.i, aim.j),
            a.exactly(self.mounted.sensor.power),
            a.exactly(self.reflectivity(face)),
            a.exactly(camera.lens.transmission),
            square(&a.exactly(camera.aperture)),
            a.exactly(0.25),
        ]);
        let depth = a.div(&a.size(&seen.axial), &a.mul(&a.size(&seen.frame_scale), &a.size(&seen.scale)));
        // cos(theta).
        let lengths = a.mul(&a.size(&seen.along_squared), &a.size(&meeting.normal_squared));
        let emission = a.div(&a.size(&seen.towards), &a.sqrt(&lengths));
        let range = a.div(
            &a.mul(&a.size(&meeting.height), &a.sqrt(&a.size(&meeting.direction_squared))),
            &a.size(&meeting.scale),
        );
        match model {
            FluxModel::Radiometric => {
                // cos(phi), of the ray itself, and its square.
                let squared = a.size(&seen.squared);
                let off_axis = a.div(&a.size(&seen.axial), &a.sqrt(&squared));
                let cos_squared = a.div(&a.size(&seen.axial.square()), &squared);
                let sin_squared = a.div(&a.size(&seen.squared.sub(&seen.axial.square())), &squared);
                let distance = a.div(&a.sqrt(&a.size(&seen.along_squared)), &a.size(&seen.scale));
                let delivered =
                    product(&[power, emission, cos_squared, off_axis, self.filter(a, sin_squared)]);
                let delivered = a.div(&delivered, &square(&depth));
                self.through_air(a, delivered, || a.add(&range, &distance))
            }
            FluxModel::Eq1 => {
                // phi of the pixel's centre: X, Y are how far that is from the axis on the image.
                let offset = |index: u32, axis: usize| {
                    let cells = A::Exact::of_integer(index)
                        .add(&A::Exact::of(0.5))
                        .sub(&A::Exact::of(camera.principal_point[axis]));
                    cells.mul(&A::Exact::of(camera.pixel_pitch[axis])).square()
                };
                let f_squared = A::Exact::of(camera.focal_length).square();
                let aside = offset(pixel.i, 0).add(&offset(pixel.j, 1));
                let squared = a.size(&aside.add(&f_squared));
                let f_squared = a.size(&f_squared);
                let cos_squared = a.div(&f_squared, &squared);
                let sin_squared = a.div(&a.size(&aside), &squared);
                let lengths = a.mul(&a.size(&meeting.normal_squared), &a.size(&meeting.direction_squared));
                let incidence = a.div(&a.size(&meeting.approach), &a.sqrt(&lengths));
                let delivered = product(&[
                    power,
                    a.pi(),
                    emission,
                    incidence,
                    square(&cos_squared),
                    self.filter(a, sin_squared),
                    a.exactly(camera.pixel_pitch[0]),
                    a.exactly(camera.pixel_pitch[1]),
                ]);
                let divisor = product(&[f_squared, range.clone(), square(&depth)]);
                let delivered = a.div(&delivered, &divisor);
                self.through_air(a, delivered, || a.add(&range, &depth))
            }
        }
    }

    /// exp(-sigma length) of some flux.
    fn through_air<A: Arithmetic>(&self, a: &A, flux: A::Real, length: impl FnOnce() -> A::Real) -> A::Real {
        let sigma = self.referee.scene.atmosphere().attenuation;
        if sigma == 0.0 {
            return flux;
        }
        a.mul(&flux, &a.exp_minus(&a.mul(&a.exactly(sigma), &length())))
    }

    /// F, by sin(phi)^2.
    fn filter<A: Arithmetic>(&self, a: &A, sin_squared: A::Real) -> A::Real {
        let Camera { lens, .. } = &self.referee.scene.camera().sensor;
        let Filter::Interference { centre, width, index } = lens.filter else { return a.exactly(1.0) };
        // centre sqrt(1 - (sin(phi) / n_eff)^2).
        let index = a.exactly(index);
        let slanted = a.div(&sin_squared, &a.mul(&index, &index));
        let shifted = a.mul(&a.exactly(centre), &a.sqrt(&a.distance(&a.exactly(1.0), &slanted)));
        let away = a.distance(&a.exactly(self.mounted.sensor.wavelength), &shifted);
        let relative = a.div(&away, &a.exactly(width));
        let squared = a.mul(&relative, &relative);
        a.exp_minus(&a.mul(&a.mul(&a.exactly(4.0), &a.ln_2()), &squared))
    }

    fn reflectivity(&self, face: &Face) -> f64 {
        let mesh = self.referee.scene.mesh();
        mesh.materials()[mesh.face_materials()[face.id.0 as usize] as usize].reflectivity
    }

    /// Whether the flux by a model is the root of a quotient of polynomials.
    fn is_root(&self, model: FluxModel) -> bool {
        let scene = self.referee.scene;
        model == FluxModel::Radiometric
            && scene.atmosphere().attenuation == 0.0
            && scene.camera().sensor.lens.filter == Filter::None
            && self.mounted.sensor.profile == Profile::Paper
    }

    /// That root: with K = I_b r_d C_loss D^2 and the pencil's (x, z),
    /// flux^2 = (K z (-n.V) Z N^2 W^2)^2 / ((4 columns rows)^2 (x^2 + z^2) n^2 V^2 (X^2 + Y^2 + Z^2)^3).
    fn root_of(&self, lit: &Lit<Dyadic>, aim: Aim, face: &Face) -> Rounded {
        let Lit { meeting, seen } = lit;
        let (beam, camera) = (&self.mounted.sensor, &self.referee.scene.camera().sensor);
        let product =
            |factors: &[Dyadic]| factors.iter().fold(Dyadic::of(1.0), |product, one| product.mul(one));
        let [x, z] = self.across_and_ahead::<Dyadic>(aim.i, aim.j);
        let squared = seen.frame_scale.mul(&seen.scale).square();
        let above = product(&[
            Dyadic::of(beam.power),
            Dyadic::of(self.reflectivity(face)),
            Dyadic::of(camera.lens.transmission),
            Dyadic::of(camera.aperture).square(),
            z.clone(),
            seen.towards.clone(),
            seen.axial.clone(),
            squared,
        ]);
        let pencils =
            Dyadic::of_integer(beam.columns).mul(&Dyadic::of_integer(beam.rows)).mul(&Dyadic::of(4.0));
        let below = product(&[
            pencils.square(),
            x.square().add(&z.square()),
            meeting.normal_squared.clone(),
            seen.along_squared.clone(),
            seen.squared.square().mul(&seen.squared),
        ]);
        root(Sign::Positive, &above.square(), &below)
    }
}

/// The ray of a pencil and the way from the camera to what it meets.
struct Rays<'a> {
    camera: &'a Mounted<Camera>,
    ray: ExactRay<'a>,
    sensor: &'a Sensor,
    aim: Aim,
    face: &'a Face,
}

impl Rays<'_> {
    fn lit<T: Number>(&self, ray: ScaledRay<T>) -> Lit<T> {
        let way = Way::new(&ray, self.face, self.camera, self.face.shows_back_to(&self.ray));
        let meeting = Meeting::new(ray, self.face);
        Lit { seen: Seen::new(&way, &meeting.normal), meeting }
    }

    fn fast(&self) -> Lit<Twofold> {
        self.lit(self.sensor.ray(self.aim))
    }

    fn exact(&self) -> Lit<Dyadic> {
        self.lit(self.ray.exact().clone())
    }

    /// What is delivered to `pixel`. Nothing if the face turns its back to the camera, or (`eq1`) to the pencil.
    fn flux(&self, light: &Light<'_, '_>, model: FluxModel, pixel: Pixel) -> Flux {
        let way = ExactWay::new(&self.ray, self.face, self.camera);
        if !way.is_front_seen() || model == FluxModel::Eq1 && self.face.shows_back_to(&self.ray) {
            return Ok(Rounded::ZERO);
        }
        let fast = light.flux(&Fast, &self.fast(), self.aim, self.face, model, pixel);
        if light.is_root(model) {
            return Ok(fast.rounded().unwrap_or_else(|| light.root_of(&self.exact(), self.aim, self.face)));
        }
        let exact = OnceCell::new();
        decide(fast, |precision| {
            let lit = exact.get_or_init(|| self.exact());
            light.flux(precision, lit, self.aim, self.face, model, pixel)
        })
    }
}

/// The cosine part / sqrt(squared). A point in the projection centre itself is seen under no angle. CHOICE: cosines of 0.
fn cosine(part: &Dyadic, squared: &Dyadic) -> Rounded {
    if squared.sign() == Some(Ordering::Equal) {
        return Rounded::ZERO;
    }
    root(sign_of(part), &part.square(), squared)
}

#[cfg(test)]
#[path = "../tests/unit/light.rs"]
mod tests;
