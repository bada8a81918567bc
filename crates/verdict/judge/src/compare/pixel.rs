//! The flux of one beam on the camera's image, pixel by pixel, judged by the pencils that contribute to it.
//!
//! A pixel's flux is a sum in a fixed order of the fluxes of its n pencils. Two sums differ by no more than the
//! differences of their parts may add up to, and the roundings of both, n u Sigma each. Where a pencil is not alike on
//! both sides (it rounds to another pixel, say) the pixel is of that pencil's class, and may differ by that pencil's
//! flux; anything more is a defect.

use crate::class::Class;
use crate::compare::flux_pair::FluxPair;
use crate::difference::Difference;
use crate::entry::RayEntry;
use crate::quantity::Quantity;
use raypencil_scene::{Image, Scene, Switches};

/// The images of one beam on both sides, and the pencils that contribute to each pixel.
pub(super) struct BeamImages<'a> {
    images: [&'a Image<f64>; 2],
    /// For each pixel the place of its pencils in `pencils`.
    index: Vec<u32>,
    /// First those of all pixels without any.
    pencils: Vec<PixelPencils>,
    /// u, of the coarser of the two arithmetics.
    unit_roundoff: f64,
}

/// The pencils that land in one pixel.
#[derive(Debug, Clone, Copy)]
struct PixelPencils {
    /// Their number, on both sides together.
    count: u32,
    /// The worst class of those that are not alike.
    class: Class,
    causes: Switches,
    /// Flux of those that are alike, summed over both sides; and how far the two sums may differ.
    total: f64,
    bound: f64,
    /// Flux of the others, summed over both sides.
    unlike: f64,
    /// Flux of all, for each side.
    sums: [f64; 2],
}

impl PixelPencils {
    const NONE: Self = Self {
        count: 0,
        class: Class::Agree,
        causes: Switches::EXACT,
        total: 0.0,
        bound: 0.0,
        unlike: 0.0,
        sums: [0.0; 2],
    };
}

impl<'a> BeamImages<'a> {
    /// `pencils` in row-major order.
    pub(super) fn new(
        scene: &Scene,
        images: [&'a Image<f64>; 2],
        pencils: Vec<FluxPair>,
        unit_roundoff: f64,
    ) -> Self {
        let camera = &scene.camera().sensor;
        let mut index_of = vec![0; camera.width as usize * camera.height as usize];
        let mut all = vec![PixelPencils::NONE];
        for pencil in pencils {
            let index = |k: usize| {
                pencil.delivered[k]
                    .filter(|(pixel, _)| pixel.i < camera.width && pixel.j < camera.height)
                    .map(|(pixel, flux)| (pixel.j as usize * camera.width as usize + pixel.i as usize, flux))
            };
            let [a, b] = [index(0), index(1)];
            let is_alike = a.map(|(at, _)| at) == b.map(|(at, _)| at) && pencil.class == Class::Agree;
            for (k, delivered) in [a, b].into_iter().enumerate() {
                let Some((at, flux)) = delivered else { continue };
                if index_of[at] == 0 {
                    index_of[at] = all.len() as u32;
                    all.push(PixelPencils::NONE);
                }
                let pixel = &mut all[index_of[at] as usize];
                pixel.count += 1;
                pixel.sums[k] += flux;
                if is_alike {
                    pixel.total += flux;
                    // Once for both sides.
                    pixel.bound += if k == 0 { pencil.bound } else { 0.0 };
                } else {
                    pixel.class = pixel.class.max(pencil.class);
                    pixel.causes = pixel.causes.union(pencil.causes);
                    pixel.unlike += flux;
                }
            }
        }
        Self { images, index: index_of, pencils: all, unit_roundoff }
    }

    fn pencils(&self, i: u32, j: u32) -> &PixelPencils {
        let at = j as usize * self.images[0].width() as usize + i as usize;
        &self.pencils[self.index[at] as usize]
    }

    /// Whether no pencil lands in a pixel, and neither side has light there.
    #[inline]
    pub(super) fn are_dark(&self, i: u32, j: u32) -> bool {
        let at = j as usize * self.images[0].width() as usize + i as usize;
        self.index[at] == 0 && self.images.iter().all(|image| image.cells()[at] == 0.0)
    }

    /// The causes of the pencils in a pixel that are not alike.
    pub(super) fn causes(&self, i: u32, j: u32) -> Switches {
        self.pencils(i, j).causes
    }

    /// The difference of a pixel's two sums, and its class.
    fn compare(&self, i: u32, j: u32) -> (Difference, Class) {
        let [a, b] = self.images.map(|image| image.at(i, j));
        let pixel = self.pencils(i, j);
        // n u Sigma of each sum, and of the sums formed here.
        let rounding = 2.0 * f64::from(pixel.count) * self.unit_roundoff * (pixel.total + pixel.unlike);
        let bound = pixel.bound + rounding;
        let difference = (a - b).abs();
        let adds_up = [a, b].iter().zip(pixel.sums).all(|(image, sum)| (image - sum).abs() <= rounding);
        let class = if !adds_up || !(difference == 0.0 || difference <= bound + pixel.unlike) {
            Class::Defect
        } else {
            pixel.class
        };
        (Difference::computed(Quantity::PixelFlux, difference, Some(bound)), class)
    }
}

/// Compares the flux of all beams in one pixel.
pub(super) fn compare_pixel(entry: &mut RayEntry<'_>, light: &[BeamImages<'_>], beams: usize) {
    if light.len() < beams {
        // A beam without an image, or without pencils to judge it by.
        entry.missing(Quantity::PixelFlux);
    }
    if light.is_empty() {
        return;
    }
    let mut class = Class::Agree;
    for images in light {
        let (difference, of_pixel) = images.compare(entry.place.i, entry.place.j);
        class = class.max(of_pixel);
        if matches!(of_pixel, Class::Agree | Class::Defect) {
            entry.extremes(&difference);
        }
    }
    entry.class(Quantity::PixelFlux, class);
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use raypencil_scene::{Atmosphere, FluxModel, Mesh, Pixel, rig};

    #[test]
    fn two_sums_may_differ_by_their_pencils_and_their_roundings() {
        let mesh = Arc::new(Mesh::new(glam::DVec3::ZERO, vec![], vec![], vec![], vec![]).unwrap());
        let camera = rig::pitched(glam::DVec3::ZERO, 0.0, rig::camera(2, 1, 0.0625, 0.5));
        let scene =
            Scene::new(mesh, camera, vec![], Atmosphere { attenuation: 0.0 }, FluxModel::Eq1).unwrap();
        let at = |i, flux| Some((Pixel { i, j: 0 }, flux));
        // Two pencils of 8 W that are alike, each to 1/2 W, and one of 4 W that rounds to the other pixel.
        let alike = FluxPair { delivered: [at(0, 8.0), at(0, 8.0)], bound: 0.5, ..FluxPair::NOTHING };
        let unlike =
            FluxPair { delivered: [at(0, 4.0), at(1, 4.0)], class: Class::Rounding, ..FluxPair::NOTHING };
        let compared = |pencils: &[FluxPair], [a, b]: [f64; 2]| {
            let [a, b] = [a, b].map(|sum| Image::from_cells(2, 1, vec![sum, 0.0]));
            let (difference, class) =
                BeamImages::new(&scene, [&a, &b], pencils.to_vec(), 1.0 / 1024.0).compare(0, 0);
            (difference.error, difference.bound.unwrap(), class)
        };
        // n = 4 and Sigma = 32 W over both sides: 2 n u Sigma = 1/4 W.
        let two = [alike, alike];
        assert_eq!(compared(&two, [16.0, 16.25]), (0.25, 1.25, Class::Agree));
        assert_eq!(compared(&two, [15.75, 16.25]), (0.5, 1.25, Class::Agree));
        // A sum that is not that of its own pencils.
        assert_eq!(compared(&two, [16.0, 16.251]).2, Class::Defect);
        assert_eq!(compared(&two, [15.749, 16.0]).2, Class::Defect);
        // n = 5 and Sigma = 36 W. The sums may differ by the pencil that is not alike.
        let three = [alike, alike, unlike];
        assert_eq!(compared(&three, [20.0, 16.0]), (4.0, 1.0 + 360.0 / 1024.0, Class::Rounding));
        assert_eq!(compared(&three, [16.0, 20.0]).2, Class::Defect);
    }
}
