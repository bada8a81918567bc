//! Flux that a pencil delivers to a pixel, correctly rounded, by both flux models.
//!
//! In the radiometric model without air and filter, and with the paper's own profile, the flux is the square root of
//! a quotient of polynomials in stored numbers. Otherwise it has factors pi, exp and atan, or a sum of as many roots
//! as there are pencils: `arithmetic` encloses it with growing precision until its rounding is certain.

use std::cell::OnceCell;

use dashu_int::Sign;
use raypencil_scene::{Camera, Filter, FluxModel, Mounted, Pixel, Profile, Scene};

use crate::hits::face::{ExactRay, Face};
use crate::hits::intersection::{Intersection, minus};
use crate::light::shares::Shares;
use crate::numbers::arithmetic::{Arithmetic, Fast, Undecided, decide_rounding};
use crate::numbers::double_double::DoubleDouble;
use crate::numbers::number::{Dyadic, Number};
use crate::numbers::rounding::{Rounded, root};
use crate::numbers::vector::Vector;
use crate::rays::ray::{Aim, MountedSensor, ScaledRay};
use crate::visibility::line_of_sight::{ExactLineOfSight, LineOfSight};

/// A flux, correctly rounded; an error if the rounding stays [`Undecided`].
pub type Flux = Result<Rounded, Undecided>;

/// The terms of the values that depend on the camera's view of the point, named as in `line_of_sight`.
pub(crate) struct CameraTerms<T> {
    /// V^2.
    pub(crate) direction_squared: T,
    /// -n.V.
    pub(crate) towards: T,
    /// Z.
    pub(crate) axial: T,
    /// X^2 + Y^2 + Z^2.
    pub(crate) squared: T,
    /// W.
    pub(crate) scale: T,
    /// N.
    pub(crate) frame_scale: T,
}

impl<T: Number> CameraTerms<T> {
    fn new(line: &LineOfSight<T>, normal: &Vector<T>) -> Self {
        Self {
            direction_squared: line.direction.length_squared(),
            towards: minus(&normal.dot(&line.direction)),
            axial: line.in_camera.0[2].clone(),
            squared: line.in_camera.length_squared(),
            scale: line.scale.clone(),
            frame_scale: line.frame_scale.clone(),
        }
    }
}

/// All terms of one pencil's values, in one kind of number.
pub(crate) struct ReturnTerms<T> {
    pub(crate) intersection: Intersection<T>,
    pub(crate) camera: CameraTerms<T>,
}

/// A point where a pencil's ray meets the plane of a face.
pub(crate) struct LitPoint<'a> {
    pub(crate) camera: &'a Mounted<Camera>,
    pub(crate) ray: ExactRay<'a>,
    pub(crate) sensor: &'a MountedSensor,
    pub(crate) aim: Aim,
    pub(crate) face: &'a Face,
}

impl LitPoint<'_> {
    fn terms<T: Number>(&self, ray: ScaledRay<T>) -> ReturnTerms<T> {
        let line = LineOfSight::new(&ray, self.face, self.camera, self.face.shows_back_to(&self.ray));
        let intersection = Intersection::new(ray, self.face);
        ReturnTerms { camera: CameraTerms::new(&line, &intersection.normal), intersection }
    }

    /// The terms in pairs of f64.
    pub(crate) fn fast(&self) -> ReturnTerms<DoubleDouble> {
        self.terms(self.sensor.ray(self.aim))
    }

    /// The terms without rounding.
    pub(crate) fn exact(&self) -> ReturnTerms<Dyadic> {
        self.terms(self.ray.exact().clone())
    }

    /// The flux delivered to `pixel`: 0 if the face turns its back to the camera or, in the model `eq1`, to the
    /// pencil.
    pub(crate) fn flux(&self, formula: &FluxFormula<'_>, model: FluxModel, pixel: Pixel) -> Flux {
        let line = ExactLineOfSight::new(&self.ray, self.face, self.camera);
        if !line.is_front_seen() || model == FluxModel::Eq1 && self.face.shows_back_to(&self.ray) {
            return Ok(Rounded::ZERO);
        }
        let fast = formula.flux(&Fast, &self.fast(), self.aim, self.face, model, pixel);
        if formula.is_root(model) {
            let exact = || formula.root_of(&self.exact(), self.aim, self.face);
            return Ok(fast.rounded().unwrap_or_else(exact));
        }
        let exact = OnceCell::new();
        decide_rounding(fast, |precision| {
            let terms = exact.get_or_init(|| self.exact());
            formula.flux(precision, terms, self.aim, self.face, model, pixel)
        })
    }
}

/// The flux models, evaluated in any arithmetic.
pub(crate) struct FluxFormula<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) shares: &'a Shares,
}

impl FluxFormula<'_> {
    /// The flux that a pencil which meets the plane of `face` delivers to `pixel`.
    pub(crate) fn flux<A: Arithmetic>(
        &self,
        a: &A,
        terms: &ReturnTerms<A::Exact>,
        aim: Aim,
        face: &Face,
        model: FluxModel,
        pixel: Pixel,
    ) -> A::Real {
        let camera = &self.scene.camera().sensor;
        let ReturnTerms { intersection, camera: view } = terms;
        let product = |factors: &[A::Real]| {
            let rest = factors[1..].iter();
            rest.fold(factors[0].clone(), |product, factor| a.mul(&product, factor))
        };
        let square = |x: &A::Real| a.mul(x, x);
        // P_k r_d C_loss D^2 / 4.
        let power = product(&[
            self.shares.share(a, aim.i, aim.j),
            a.exact(self.shares.beam().power),
            a.exact(self.reflectivity(face)),
            a.exact(camera.lens.transmission),
            square(&a.exact(camera.aperture)),
            a.exact(0.25),
        ]);
        let depth = a.div(&a.abs(&view.axial), &a.mul(&a.abs(&view.frame_scale), &a.abs(&view.scale)));
        // cos(theta).
        let lengths = a.mul(&a.abs(&view.direction_squared), &a.abs(&intersection.normal_squared));
        let cos_view = a.div(&a.abs(&view.towards), &a.sqrt(&lengths));
        let range = a.div(
            &a.mul(&a.abs(&intersection.height), &a.sqrt(&a.abs(&intersection.direction_squared))),
            &a.abs(&intersection.scale),
        );
        match model {
            FluxModel::Radiometric => {
                // cos(phi), of the ray itself, and its square.
                let squared = a.abs(&view.squared);
                let cos_off_axis = a.div(&a.abs(&view.axial), &a.sqrt(&squared));
                let cos_squared = a.div(&a.abs(&view.axial.square()), &squared);
                let sin_squared = a.div(&a.abs(&view.squared.sub(&view.axial.square())), &squared);
                let distance = a.div(&a.sqrt(&a.abs(&view.direction_squared)), &a.abs(&view.scale));
                let delivered =
                    product(&[power, cos_view, cos_squared, cos_off_axis, self.filter(a, sin_squared)]);
                let delivered = a.div(&delivered, &square(&depth));
                self.through_air(a, delivered, || a.add(&range, &distance))
            }
            FluxModel::Eq1 => {
                // phi is that of the pixel's centre; `offset` is its squared distance from the axis on the image.
                let offset = |index: u32, axis: usize| {
                    let cells = A::Exact::of_integer(index)
                        .add(&A::Exact::of(0.5))
                        .sub(&A::Exact::of(camera.principal_point[axis]));
                    cells.mul(&A::Exact::of(camera.pixel_pitch[axis])).square()
                };
                let f_squared = A::Exact::of(camera.focal_length).square();
                let aside = offset(pixel.i, 0).add(&offset(pixel.j, 1));
                let squared = a.abs(&aside.add(&f_squared));
                let f_squared = a.abs(&f_squared);
                let cos_squared = a.div(&f_squared, &squared);
                let sin_squared = a.div(&a.abs(&aside), &squared);
                let lengths =
                    a.mul(&a.abs(&intersection.normal_squared), &a.abs(&intersection.direction_squared));
                let cos_incidence = a.div(&a.abs(&intersection.approach), &a.sqrt(&lengths));
                let delivered = product(&[
                    power,
                    a.pi(),
                    cos_view,
                    cos_incidence,
                    square(&cos_squared),
                    self.filter(a, sin_squared),
                    a.exact(camera.pixel_pitch[0]),
                    a.exact(camera.pixel_pitch[1]),
                ]);
                let divisor = product(&[f_squared, range.clone(), square(&depth)]);
                let delivered = a.div(&delivered, &divisor);
                self.through_air(a, delivered, || a.add(&range, &depth))
            }
        }
    }

    /// The flux attenuated by the air: times exp(-sigma length).
    fn through_air<A: Arithmetic>(&self, a: &A, flux: A::Real, length: impl FnOnce() -> A::Real) -> A::Real {
        let sigma = self.scene.atmosphere().attenuation;
        if sigma == 0.0 {
            return flux;
        }
        a.mul(&flux, &a.exp_minus(&a.mul(&a.exact(sigma), &length())))
    }

    /// The transmission F of the filter, by sin(phi)^2.
    fn filter<A: Arithmetic>(&self, a: &A, sin_squared: A::Real) -> A::Real {
        let Camera { lens, .. } = &self.scene.camera().sensor;
        let Filter::Interference { centre, width, index } = lens.filter else { return a.exact(1.0) };
        // centre sqrt(1 - (sin(phi) / n_eff)^2).
        let index = a.exact(index);
        let slanted = a.div(&sin_squared, &a.mul(&index, &index));
        let shifted = a.mul(&a.exact(centre), &a.sqrt(&a.distance(&a.exact(1.0), &slanted)));
        let away = a.distance(&a.exact(self.shares.beam().wavelength), &shifted);
        let relative = a.div(&away, &a.exact(width));
        let squared = a.mul(&relative, &relative);
        a.exp_minus(&a.mul(&a.mul(&a.exact(4.0), &a.ln_2()), &squared))
    }

    fn reflectivity(&self, face: &Face) -> f64 {
        let mesh = self.scene.mesh();
        mesh.materials()[mesh.face_materials()[face.id.0 as usize] as usize].reflectivity
    }

    /// Whether the flux is the square root of a quotient of polynomials.
    pub(crate) fn is_root(&self, model: FluxModel) -> bool {
        let scene = self.scene;
        model == FluxModel::Radiometric
            && scene.atmosphere().attenuation == 0.0
            && scene.camera().sensor.lens.filter == Filter::None
            && self.shares.beam().profile == Profile::Paper
    }

    /// The flux as that root, correctly rounded. With K = I_b r_d C_loss D^2 and the pencil's (x, z),
    /// flux^2 = (K z (-n.V) Z N^2 W^2)^2 / ((4 columns rows)^2 (x^2 + z^2) n^2 V^2 (X^2 + Y^2 + Z^2)^3).
    pub(crate) fn root_of(&self, terms: &ReturnTerms<Dyadic>, aim: Aim, face: &Face) -> Rounded {
        let ReturnTerms { intersection, camera: view } = terms;
        let (beam, camera) = (self.shares.beam(), &self.scene.camera().sensor);
        let product =
            |factors: &[Dyadic]| factors.iter().fold(Dyadic::of(1.0), |product, one| product.mul(one));
        let [x, z] = self.shares.across_and_ahead::<Dyadic>(aim.i, aim.j);
        let squared = view.frame_scale.mul(&view.scale).square();
        let above = product(&[
            Dyadic::of(beam.power),
            Dyadic::of(self.reflectivity(face)),
            Dyadic::of(camera.lens.transmission),
            Dyadic::of(camera.aperture).square(),
            z.clone(),
            view.towards.clone(),
            view.axial.clone(),
            squared,
        ]);
        let pencils =
            Dyadic::of_integer(beam.columns).mul(&Dyadic::of_integer(beam.rows)).mul(&Dyadic::of(4.0));
        let below = product(&[
            pencils.square(),
            x.square().add(&z.square()),
            intersection.normal_squared.clone(),
            view.direction_squared.clone(),
            view.squared.square().mul(&view.squared),
        ]);
        root(Sign::Positive, &above.square(), &below)
    }
}
