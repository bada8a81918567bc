//! What comes back of a pencil, as values: a third evaluation beside the renderers'.
//!
//! Every length and cosine is a quotient of polynomials, or the root of one, of stored numbers. The polynomials
//! are exact; a quotient of two is good to 2 u, its root to 3 u, u = 2^-53. So the flux, a product of at most
//! two dozen such factors and one or two `exp` and `atan` of `libm` (each within 1 ulp), is good to 100 u of
//! itself, and a share of a normalised profile to 20 u more (its sum is compensated).

use std::cmp::Ordering;
use std::f64::consts::PI;

use raypencil_scene::{
    Beam, Camera, FaceId, Filter, FluxModel, Mounted, Pixel, Profile, Return, Sampling, SensorId,
};

use crate::face::{ExactRay, Face};
use crate::number::{Dyadic, Number};
use crate::pencil::{Aim, Sensor};
use crate::sight::ExactWay;
use crate::verdict::{Displacement, Referee};

/// The returns of one beam, pencil by pencil.
#[derive(Debug)]
pub struct Light<'r, 's> {
    referee: &'r Referee<'s>,
    beam: usize,
    mounted: Mounted<Beam>,
    sampling: Sampling,
    /// The weights of all pencils, added up; 1 for the paper's own shares.
    whole: f64,
    /// (alpha / w)^2 of the brightest pencil of a Gaussian, by which all weights are divided: a Gaussian may be so
    /// narrow that all would vanish.
    brightest: f64,
}

impl<'s> Referee<'s> {
    /// The returns of a beam, or `None` if there is no such beam.
    pub fn light(&self, beam: usize, sampling: Sampling) -> Option<Light<'_, 's>> {
        let mounted = *self.scene.beams().get(beam)?;
        let mut light = Light { referee: self, beam, mounted, sampling, whole: 1.0, brightest: 0.0 };
        let Beam { columns, rows, profile, .. } = mounted.sensor;
        if profile != Profile::Paper {
            // Added with what rounding leaves over. (A. Neumaier, 1974)
            let (mut sum, mut rest) = (0.0_f64, 0.0);
            let rows_alike = sampling == Sampling::Centres;
            let different = if rows_alike { 1 } else { rows };
            if let Profile::Gaussian { half_width } = profile {
                let pencils = (0..different).flat_map(|j| (0..columns).map(move |i| (i, j)));
                light.brightest = pencils
                    .map(|(i, j)| light.relative_angle(i, j, half_width))
                    .fold(f64::INFINITY, |least, relative| least.min(relative * relative));
            }
            for j in 0..different {
                for i in 0..columns {
                    let weight = light.weight(i, j);
                    let total = sum + weight;
                    rest += if sum >= weight { (sum - total) + weight } else { (weight - total) + sum };
                    sum = total;
                }
            }
            light.whole = (sum + rest) * if rows_alike { f64::from(rows) } else { 1.0 };
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

    /// x / g of a pencil's ray.
    fn slope(&self, i: u32, j: u32) -> f64 {
        let Beam { columns, half_width, grid_distance, .. } = self.mounted.sensor;
        let half_cells = 2.0 * f64::from(i) + 1.0 - f64::from(columns) + 2.0 * self.offset(i, j).dx;
        half_width * half_cells / (f64::from(columns) * grid_distance)
    }

    /// alpha / w.
    fn relative_angle(&self, i: u32, j: u32, half_width: f64) -> f64 {
        libm::atan(self.slope(i, j)) / half_width
    }

    /// What of the beam's power goes to a pencil, before it is divided by the whole.
    fn weight(&self, i: u32, j: u32) -> f64 {
        let slope = self.slope(i, j);
        let cos_squared = 1.0 / (1.0 + slope * slope);
        match self.mounted.sensor.profile {
            Profile::Paper => {
                let pencils = f64::from(self.mounted.sensor.columns) * f64::from(self.mounted.sensor.rows);
                cos_squared.sqrt() / pencils
            }
            Profile::UniformAngle => cos_squared,
            Profile::Gaussian { half_width } => {
                let relative = self.relative_angle(i, j, half_width);
                libm::exp(-2.0 * (relative * relative - self.brightest))
            }
        }
    }

    /// P_k, watts.
    pub fn power(&self, i: u32, j: u32) -> f64 {
        self.mounted.sensor.power * self.weight(i, j) / self.whole
    }

    /// What comes back of pencil (i, j); `None` if there is no such pencil, or it does not hit.
    pub fn returned(&self, i: u32, j: u32) -> Option<Return> {
        let sensor = Sensor::of(self.referee.scene, SensorId::Beam(self.beam))?;
        let (columns, rows) = sensor.size();
        if i >= columns || j >= rows {
            return None;
        }
        let Displacement { dx, dy } = self.offset(i, j);
        let aim = Aim { i, j, dx, dy };
        let nearest = self.referee.nearest(&sensor, aim);
        Some(self.returned_of(&sensor, aim, nearest.first()?))
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
    ) -> Option<Return> {
        let sensor = Sensor::of(self.referee.scene, SensorId::Beam(self.beam))?;
        let (columns, rows) = sensor.size();
        let mesh = self.referee.scene.mesh();
        if i >= columns || j >= rows || face.0 as usize >= mesh.faces().len() {
            return None;
        }
        let face = Face::of(mesh, face);
        let Displacement { dx, dy } = self.offset(i, j);
        let aim = Aim { i, j, dx, dy };
        let is_parallel = face.approach(ExactRay::new(&sensor, aim).exact()).sign() == Some(Ordering::Equal);
        (!is_parallel).then(|| self.returned_seen(&sensor, aim, &face, visible, pixel))
    }

    /// What comes back of an aim that meets `face`.
    pub(crate) fn returned_of(&self, sensor: &Sensor, aim: Aim, face: &Face) -> Return {
        let sight = self.referee.sight_of(sensor, aim, face);
        self.returned_seen(sensor, aim, face, sight.visible, sight.pixel)
    }

    fn returned_seen(
        &self,
        sensor: &Sensor,
        aim: Aim,
        face: &Face,
        visible: bool,
        pixel: Option<Pixel>,
    ) -> Return {
        let scene = self.referee.scene;
        let Mounted { sensor: camera, .. } = scene.camera();
        let ray = ExactRay::new(sensor, aim);
        let way = ExactWay::new(&ray, face, scene.camera());
        let values = Values::new(&ray, &way, face);

        // P_k r_d C_loss, and what the equations share of the rest.
        let material = &scene.mesh().materials()[scene.mesh().face_materials()[face.id.0 as usize] as usize];
        let power = self.power(aim.i, aim.j) * material.reflectivity * camera.lens.transmission;
        let sigma = scene.atmosphere().attenuation;
        let aperture_squared = camera.aperture * camera.aperture;
        let flux = match (visible, pixel) {
            (true, Some(pixel)) => match scene.flux_model() {
                FluxModel::Radiometric => {
                    let Values { range, distance, depth, off_axis, emission, .. } = values;
                    power
                        * self.filter(camera, 1.0 - off_axis * off_axis)
                        * (aperture_squared / 4.0)
                        * emission
                        * (off_axis * off_axis * off_axis)
                        / (depth * depth)
                        * libm::exp(-sigma * (range + distance))
                }
                FluxModel::Eq1 => {
                    let Values { range, depth, emission, incidence, .. } = values;
                    // phi of the pixel's centre, whose tangent is how far that is from the axis over f.
                    let offset = |index: u32, axis: usize| {
                        let cells = f64::from(index) + 0.5 - camera.principal_point[axis];
                        cells * camera.pixel_pitch[axis] / camera.focal_length
                    };
                    let (x, y) = (offset(pixel.i, 0), offset(pixel.j, 1));
                    let tan_squared = x * x + y * y;
                    let cos_squared = 1.0 / (1.0 + tan_squared);
                    let sin_squared = tan_squared * cos_squared;
                    let area = camera.pixel_pitch[0] * camera.pixel_pitch[1];
                    power * (PI / 4.0) * aperture_squared / (camera.focal_length * camera.focal_length)
                        * self.filter(camera, sin_squared)
                        * area
                        * (cos_squared * cos_squared)
                        * emission
                        * incidence
                        / (range * depth * depth)
                        * libm::exp(-sigma * depth)
                        * libm::exp(-sigma * range)
                }
            },
            _ => 0.0,
        };
        Return {
            visible,
            pixel,
            depth: values.depth,
            off_axis: values.off_axis,
            emission: values.emission,
            flux,
        }
    }

    /// F, by sin(phi)^2.
    fn filter(&self, camera: &Camera, sin_squared: f64) -> f64 {
        let Filter::Interference { centre, width, index } = camera.lens.filter else { return 1.0 };
        let shifted = centre * (1.0 - sin_squared / (index * index)).sqrt();
        let relative = (self.mounted.sensor.wavelength - shifted) / width;
        libm::exp(-4.0 * std::f64::consts::LN_2 * relative * relative)
    }
}

/// Lengths in metres and cosines of one return.
#[derive(Debug, Clone, Copy)]
struct Values {
    /// R.
    range: f64,
    /// d = |P - c|.
    distance: f64,
    /// r.
    depth: f64,
    /// cos(phi).
    off_axis: f64,
    /// cos(theta).
    emission: f64,
    /// cos(psi).
    incidence: f64,
}

impl Values {
    fn new(ray: &ExactRay<'_>, way: &ExactWay<'_>, face: &Face) -> Self {
        let (pencil, way) = (ray.exact(), way.exact());
        let normal = face.normal::<Dyadic>();
        let (height, approach) = (face.height(pencil), face.approach(pencil));
        let (n_squared, d_squared) = (normal.length_squared(), pencil.direction.length_squared());
        let v_squared = way.along.length_squared();
        // The root of a quotient of squares, with the sign of `signed`.
        let root = |signed: &Dyadic, over: &Dyadic| {
            signed.over(&Dyadic::of(1.0)).signum() * signed.square().over(over).sqrt()
        };
        let minus = |x: &Dyadic| Dyadic::of(0.0).sub(x);
        let scale = pencil.origin_scale.mul(&approach);
        let is_centre = v_squared.sign() == Some(Ordering::Equal);
        Self {
            range: height.square().mul(&d_squared).over(&scale.square()).sqrt(),
            distance: v_squared.over(&way.scale.square()).sqrt(),
            depth: way.seen.0[2].over(&way.frame_scale.mul(&way.scale)),
            // A point in the projection centre itself is seen under no angle. CHOICE: cosines of 0.
            off_axis: if is_centre { 0.0 } else { root(&way.seen.0[2], &way.seen.length_squared()) },
            emission: if is_centre {
                0.0
            } else {
                root(&minus(&normal.dot(&way.along)), &n_squared.mul(&v_squared))
            },
            incidence: root(&minus(&approach), &n_squared.mul(&d_squared)),
        }
    }
}
