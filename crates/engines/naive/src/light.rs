//! The naive renderer's light: every formula by its definition, every shadow ray against every face.

use std::f64::consts::{LN_2, PI};

use glam::DVec3;
use rayon::prelude::*;
use raypencil_scene::{
    Beam, Filter, FluxModel, Hit, Image, Mounted, Pixel, Profile, Return, Returns, Scene, SensorMap,
};

use crate::fault::Fault;
use crate::hits::Spheres;
use crate::injected::Injected;
use crate::quaternion::{conjugate, rotate};
use crate::rays::SceneRay;
use crate::slack::Slack;

/// The light that a scene's camera receives, computed with a fault or without.
struct Light<'a> {
    faults: Injected,
    scene: &'a Scene,
    faces: &'a [[DVec3; 3]],
    spheres: &'a Spheres,
}

/// The returns of a beam's pencils, and their flux on the camera's image, W.
pub(crate) fn returns(
    faults: Injected,
    scene: &Scene,
    (faces, spheres): (&[[DVec3; 3]], &Spheres),
    index: usize,
    map: &SensorMap,
) -> (Returns, Image<f64>) {
    Light { faults, scene, faces, spheres }.returns(index, map)
}

impl Light<'_> {
    /// Whether this fault is injected.
    fn has(&self, fault: Fault) -> bool {
        self.faults.has(fault)
    }

    /// The size of this slack; 0 if it is not there.
    fn size(&self, slack: Slack) -> f64 {
        self.faults.size(slack)
    }

    /// The returns of beam `index` from the hits of its map, and their flux on the image, W.
    fn returns(&self, index: usize, map: &SensorMap) -> (Returns, Image<f64>) {
        let scene = self.scene;
        let Mounted { sensor: beam, .. } = scene.beams()[index];
        let shares = self.shares(if self.has(Fault::StaleShares) { &scene.beams()[0].sensor } else { &beam });
        let mut returns = Returns::empty(beam.columns, beam.rows);
        let camera = &scene.camera().sensor;
        let mut image = Image::filled(camera.width, camera.height, 0.0);
        let pencils: Vec<[u32; 2]> =
            (0..beam.rows).flat_map(|j| (0..beam.columns).map(move |i| [i, j])).collect();
        // Pencils do not know of one another, and are summed in their order: the result does not depend on threads.
        let all = pencils.par_iter().map(|&[i, j]| {
            let power = beam.power * shares[i as usize % shares.len()];
            Some(self.return_of(&map.hit(i, j)?, &beam, power))
        });
        let all: Vec<Option<Return>> = all.collect();
        for (&[i, j], of_hit) in pencils.iter().zip(&all) {
            if let Some(of_hit) = of_hit {
                returns.put(i, j, of_hit);
                let is_received = of_hit.visible || (self.has(Fault::HiddenLit) && of_hit.flux > 0.0);
                if let (true, Some(Pixel { i, j })) = (is_received, of_hit.pixel) {
                    let before = if self.has(Fault::LastPencilWins) { 0.0 } else { image.at(i, j) };
                    image.set(i, j, before + of_hit.flux);
                }
            }
        }
        (returns, image)
    }

    /// The share of the beam's power in each pencil of a row.
    fn shares(&self, beam: &Beam) -> Vec<f64> {
        let (columns, rows) = (f64::from(beam.columns), f64::from(beam.rows));
        let angle = |i: u32| {
            let x = beam.half_width * (2.0 * f64::from(i) + 1.0 - columns) / columns;
            libm::atan2(x, beam.grid_distance)
        };
        let weight = |i: u32| match beam.profile {
            _ if self.has(Fault::ProfileFlat) => 1.0 / (columns * rows),
            Profile::Paper => libm::cos(angle(i)) / (columns * rows),
            Profile::UniformAngle => libm::cos(angle(i)) * libm::cos(angle(i)),
            Profile::Gaussian { half_width } => {
                libm::exp(-2.0 * (angle(i) / half_width) * (angle(i) / half_width))
            }
        };
        let weight_sum: f64 = match beam.profile {
            Profile::Paper => 1.0,
            _ if self.has(Fault::ProfileFlat) => 1.0,
            _ if self.has(Fault::ProfileNotNormalised) => columns * rows,
            _ => rows * (0..beam.columns).map(weight).sum::<f64>(),
        };
        (0..beam.columns).map(|i| weight(i) / weight_sum).collect()
    }

    /// The return of one hit.
    fn return_of(&self, hit: &Hit, beam: &Beam, power: f64) -> Return {
        let Mounted { scene_from_sensor, sensor: camera } = self.scene.camera();
        let centre = scene_from_sensor.position;
        let to_point = hit.point - centre;
        let sensor_from_scene = conjugate(scene_from_sensor.rotation);
        let seen = rotate(sensor_from_scene, to_point, self.has(Fault::QuaternionTakenAsUnit));
        let (depth, distance) = (seen.z, seen.length());
        let cos_off_axis = depth / distance;
        let cos_view = -hit.normal.dot(to_point) / distance;

        // The pixel that the light reaches: pixel (i, j) is [i, i + 1) x [j, j + 1).
        let place = [0, 1].map(|axis: usize| {
            let at = camera.focal_length * seen[axis] / depth / camera.pixel_pitch[axis]
                + camera.principal_point[axis];
            let moved = match axis {
                0 => self.size(Slack::LandsRight) - self.size(Slack::LandsLeft),
                _ => self.size(Slack::LandsBelow) - self.size(Slack::LandsAbove),
            };
            at + moved
        });
        let border = self.size(Slack::ImageWider) - self.size(Slack::ImageNarrower);
        let place = [0, 1].map(|axis: usize| {
            let at = place[axis];
            let size = f64::from([camera.width, camera.height][axis]);
            let is_near = at >= -border && at < size + border;
            let at = match border {
                0.0 => at,
                _ if is_near => at.clamp(0.0, size - 0.5),
                _ => -1.0,
            };
            let at = if self.has(Fault::PixelRounded) { (at - 0.5).floor() + 1.0 } else { at.floor() };
            let last = f64::from([camera.width, camera.height][axis] - 1);
            if self.has(Fault::OffImageClamped) { at.clamp(0.0, last) } else { at }
        });
        let is_before = depth > camera.focal_length || self.has(Fault::BehindCameraLands) && depth < 0.0;
        let on_image = is_before
            && (0.0..f64::from(camera.width)).contains(&place[0])
            && (0.0..f64::from(camera.height)).contains(&place[1]);
        let mut pixel = on_image.then_some(Pixel { i: place[0] as u32, j: place[1] as u32 });
        if let Some(Pixel { i, j }) = pixel
            && self.has(Fault::PixelTransposed)
        {
            pixel = Some(Pixel { i: j.min(camera.width - 1), j: i.min(camera.height - 1) });
        }
        let too_far = self.has(Fault::CameraRangeLimits) && distance > camera.max_range;
        let least = self.size(Slack::UnseenAtGrazing) - self.size(Slack::SeenFromBehindALittle);
        let visible = (cos_view > least || self.has(Fault::SeenFromBehind))
            && pixel.is_some()
            && !too_far
            && !self.is_hidden(hit, centre, to_point, (camera.focal_length / depth).max(0.0));
        if self.has(Fault::PixelOfVisibleOnly) && !visible {
            pixel = None;
        }

        let flux = match pixel {
            Some(pixel) if visible || self.has(Fault::HiddenLit) => {
                self.flux(hit, beam, power, [depth, distance, cos_off_axis, cos_view], pixel)
            }
            _ => 0.0,
        };
        Return { visible, pixel, depth, cos_off_axis, cos_view, flux }
    }

    /// Whether a face, front or back, meets the segment c + u (P - c), f_c / r <= u < 1. A face through P does not
    /// hide P: neither the hit face, nor faces that tie with it, nor backs at the same place.
    fn is_hidden(&self, hit: &Hit, centre: DVec3, to_point: DVec3, nearest: f64) -> bool {
        let nearest = if self.has(Fault::OccludersBeforePlane) {
            0.0
        } else {
            nearest * (1.0 - self.size(Slack::ShadowPastPlane))
                + self.size(Slack::ShadowStopsShort) * (1.0 - nearest)
        };
        let distance = to_point.length();
        let at_point = 1e-12 * (1.0 + (distance + centre.length()) / distance);
        let faces_at_point_hide = self.has(Fault::FacesAtPointHide);
        let farthest = if self.has(Fault::ShadowsFromBehind) {
            f64::INFINITY
        } else if faces_at_point_hide {
            1.0 + at_point
        } else if self.has(Fault::ShadowEpsilon) {
            1.0 - 1e-3 / distance
        } else {
            let away = self.size(Slack::ShadowStartsAway);
            let behind = self.size(Slack::ShadowFromBehind);
            if away > 0.0 { 1.0 - away.max(at_point) } else { 1.0 - at_point + behind }
        };
        let moved = self.size(Slack::OccludersNarrower) - self.size(Slack::OccludersWider);
        let way = SceneRay { origin: centre, q: to_point, is_lower_right: false };
        self.spheres.near(&way).any(|index| {
            let [a, b, c] = self.faces[index];
            let n = (b - a).cross(c - a);
            let towards = n.dot(to_point);
            if index == hit.face.0 as usize
                || towards == 0.0
                || (self.has(Fault::ShadowsOfFronts) && towards > 0.0)
            {
                return false;
            }
            let u = n.dot(a - centre) / towards;
            let corners = [a - centre, b - centre, c - centre];
            let sides = [0, 1, 2].map(|k: usize| to_point.dot(corners[k].cross(corners[(k + 1) % 3])));
            let least = moved * (sides[0] + sides[1] + sides[2]).abs();
            let is_inside =
                sides.iter().all(|side| -*side >= least) || sides.iter().all(|side| *side >= least);
            is_inside && u >= nearest && u < farthest && (faces_at_point_hide || (u - 1.0).abs() > at_point)
        })
    }

    /// The flux of a pencil on the image, W.
    fn flux(
        &self,
        hit: &Hit,
        beam: &Beam,
        power: f64,
        [depth, distance, cos_off_axis, cos_view]: [f64; 4],
        pixel: Pixel,
    ) -> f64 {
        let (scene, camera) = (self.scene, &self.scene.camera().sensor);
        let material = if self.has(Fault::ReflectivityOfFirst) {
            0
        } else {
            scene.mesh().face_materials()[hit.face.0 as usize] as usize
        };
        let reflectivity = scene.mesh().materials()[material].reflectivity;
        let sigma = scene.atmosphere().attenuation;
        let d = if self.has(Fault::ApertureAsRadius) { 2.0 * camera.aperture } else { camera.aperture };
        let sigma = if self.has(Fault::AttenuationOmitted) { 0.0 } else { sigma };
        let camera_depth = depth;
        let depth = if self.has(Fault::RangeForCameraDepth) {
            hit.range
        } else if self.has(Fault::DistanceForDepth) {
            distance
        } else {
            depth
        };
        let cos_theta = if self.has(Fault::IncidenceForViewCosine) {
            hit.cos_incidence
        } else if self.has(Fault::ViewCosineOmitted) {
            1.0
        } else if self.has(Fault::SeenFromBehind) {
            cos_view.abs()
        } else {
            cos_view
        };
        let q = camera.direction(pixel.i, pixel.j);
        let of_centre = q.z / q.length();
        let transmission =
            if self.has(Fault::LensTransmissionOmitted) { 1.0 } else { camera.lens.transmission };
        let power = power * (1.0 + self.size(Slack::FluxScaled));
        let common = power * reflectivity * transmission * cos_theta / (depth * depth);
        let model = scene.flux_model();
        match if self.has(Fault::FluxOfOtherModel) { model.other() } else { model } {
            FluxModel::Radiometric => {
                let cos_phi = if self.has(Fault::PhiOfPixelCentre) { of_centre } else { cos_off_axis };
                let power_of_cosine = if self.has(Fault::FourthPower) {
                    square(square(cos_phi))
                } else {
                    cos_phi * square(cos_phi)
                };
                let path = if self.has(Fault::AttenuationOnce) { hit.range } else { hit.range + distance };
                common
                    * self.filter(beam, cos_phi)
                    * (d * d / 4.0)
                    * power_of_cosine
                    * libm::exp(-sigma * path)
            }
            FluxModel::Eq1 => {
                let area = if self.has(Fault::PixelAreaOmitted) {
                    1.0
                } else {
                    camera.pixel_pitch[0] * camera.pixel_pitch[1]
                };
                let path =
                    if self.has(Fault::AttenuationOnce) { hit.range } else { hit.range + camera_depth };
                let of_centre = if self.has(Fault::PhiOfPoint) { cos_off_axis } else { of_centre };
                let cos_psi = if self.has(Fault::IncidenceOmitted) { 1.0 } else { hit.cos_incidence };
                let range = if self.has(Fault::RangeOmitted) { 1.0 } else { hit.range };
                common
                    * (PI / 4.0)
                    * square(d / camera.focal_length)
                    * self.filter(beam, of_centre)
                    * area
                    * square(square(of_centre))
                    * cos_psi
                    / range
                    * libm::exp(-sigma * path)
            }
        }
    }

    /// The transmission of the lens's filter.
    fn filter(&self, beam: &Beam, cos_phi: f64) -> f64 {
        let Filter::Interference { centre, width, index } = self.scene.camera().sensor.lens.filter else {
            return 1.0;
        };
        let sin_squared = if self.has(Fault::FilterAlongAxis) { 0.0 } else { 1.0 - cos_phi * cos_phi };
        let shifted = centre * (1.0 - sin_squared / (index * index)).sqrt();
        libm::exp(-4.0 * LN_2 * square((beam.wavelength - shifted) / width))
    }
}

fn square(x: f64) -> f64 {
    x * x
}
