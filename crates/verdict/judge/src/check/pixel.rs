//! The flux of a beam on the image, pixel by pixel, against the sum over the pencils that land there.
//!
//! A recording that states where its pencils land is held to the exact sum over those pencils, each of which is judged
//! by itself. A recording of the image alone is held to the true pencils; a pencil that may round into another pixel,
//! or out of view, may then be in the sum or not, as a whole.

use std::collections::HashMap;

use crate::bounds::min_normal;
use crate::check::ground_truth::GroundTruth;
use crate::check::pencil::PencilContribution;
use crate::check::uncertain::UncertainFlux;
use crate::class::Class;
use crate::difference::Difference;
use crate::entry::RayEntry;
use crate::quantity::Item;
use crate::recorded::Recorded;
use raypencil_files::Storage;
use raypencil_scene::{Pixel, Place, SensorId};

/// Sum over the pencils of one beam that land in one pixel, by the scene's model and by the other.
#[derive(Debug, Clone, Copy)]
struct PixelSum {
    count: u32,
    flux: [f64; 2],
    bound: [f64; 2],
    /// Number, light and bounds of the pencils that truly land here, and are stated not to.
    missing: (u32, [f64; 2], [f64; 2]),
    class: Class,
}

/// One beam's light on the image.
#[derive(Debug)]
pub(super) struct BeamImage {
    beam: usize,
    width: u32,
    pixels: Vec<PixelSum>,
    /// Light that may be in a pixel's sum or not, by the pixel's index.
    uncertain: HashMap<usize, Vec<UncertainFlux>>,
}

/// Maximum number of uncertain pencils of a pixel whose subsets are tried (4,095 of them); later pencils are ignored.
const MAX_UNCERTAIN_PENCILS: usize = 12;

impl BeamImage {
    pub(super) fn empty(truth: &GroundTruth<'_>, beam: usize) -> Self {
        let camera = &truth.scene().camera().sensor;
        let nothing = PixelSum {
            count: 0,
            flux: [0.0; 2],
            bound: [0.0; 2],
            missing: (0, [0.0; 2], [0.0; 2]),
            class: Class::Agree,
        };
        let cells = camera.width as usize * camera.height as usize;
        Self { beam, width: camera.width, pixels: vec![nothing; cells], uncertain: HashMap::new() }
    }

    fn index(&self, pixel: Pixel) -> usize {
        pixel.j as usize * self.width as usize + pixel.i as usize
    }

    /// Adds a pencil where it is stated to land, and notes the true pixel from which it is missing.
    pub(super) fn add(&mut self, contribution: &PencilContribution) {
        if let Some(delivered) = &contribution.delivered {
            let index = self.index(delivered.pixel);
            let sum = &mut self.pixels[index];
            sum.count += 1;
            for k in 0..2 {
                sum.flux[k] += delivered.flux[k];
                sum.bound[k] += delivered.bound[k];
            }
            sum.class = sum.class.max(delivered.class);
        }
        if let Some(missing) = &contribution.missing {
            let index = self.index(missing.pixel);
            let sum = &mut self.pixels[index];
            let (count, flux, bound) = &mut sum.missing;
            *count += 1;
            for k in 0..2 {
                flux[k] += missing.flux[k];
                bound[k] += missing.bound[k];
            }
            sum.class = sum.class.max(missing.class);
        }
    }

    /// Adds light that may be in a sum or not.
    pub(super) fn add_uncertain(&mut self, fluxes: Vec<UncertainFlux>) {
        for flux in fluxes {
            let index = self.index(flux.pixel);
            self.uncertain.entry(index).or_default().push(flux);
        }
    }

    /// Judges the flux of one pixel.
    pub(super) fn judge(&self, truth: &GroundTruth<'_>, recorded: &Recorded, entry: &mut RayEntry<'_>) {
        let Place { i, j, .. } = entry.place;
        let (light, true_light) = (&recorded.answers.light[self.beam], &truth.answers().light[self.beam]);
        let stated = [&light.image, &light.other_image];
        let exact = [&true_light.image, &true_light.other_image];
        let index = self.index(Pixel { i, j });
        let sum = self.pixels[index];
        for k in 0..2 {
            let item = Item { is_other_model: k == 1, ..Item::of_image(self.beam) };
            let (Some(stated), Some(exact)) = (stated[k], exact[k]) else {
                entry.missing(item);
                continue;
            };
            let (stated, exact) = (stated.at(i, j), exact.at(i, j));
            let storage = recorded.storage_of(SensorId::Camera, item);
            // n u Sigma of the recording's sum, and the loss of n numbers that are subnormal in its arithmetic.
            let rounding = |count: u32, flux: f64| {
                let count = f64::from(count);
                count * recorded.precision.unit_roundoff * flux
                    + count * min_normal(recorded.precision) * recorded.precision.unit_roundoff
            };
            let base = sum.bound[k] + rounding(sum.count, sum.flux[k]);
            // The true sum has the pencils, too, that are stated not to be in it: who is wrong about a pencil may be right about its pixel.
            let (missing, lost, lost_bound) = sum.missing;
            let of_all = sum.bound[k] + lost_bound[k] + rounding(sum.count + missing, sum.flux[k] + lost[k]);
            let difference = |from: f64, bound: f64| {
                let stored = 0.5 * (storage.ulp(stated) + Storage::F64.ulp(from));
                Difference {
                    item,
                    error: (stated - from).abs(),
                    ulps: Some(if stated == from { 0.0 } else { (stated - from).abs() / storage.ulp(from) }),
                    // No light at all is exactly 0.
                    bound: Some(if from == 0.0 && bound == 0.0 { 0.0 } else { bound + stored }),
                    is_unrepresentable: from != 0.0 && 0.5 * storage.ulp(from) >= from,
                }
            };
            let of_truth = difference(exact, of_all);
            let own = difference(sum.flux[k], base);
            let (difference, class) = if of_truth.is_within() {
                (of_truth, Class::Agree)
            } else if sum.class != Class::Agree && own.is_within() {
                entry.ruled("the sum over its own pencils");
                if sum.class == Class::Defect {
                    let (stated, exact) = (format!("{stated:e}"), format!("{exact:e}"));
                    entry.note(&format!("it adds up a pencil that is wrong: {stated}, true is {exact}"));
                }
                (own, sum.class)
            } else if let Some(subset) = self.uncertain.get(&index).and_then(|fluxes| {
                subsets(fluxes, k)
                    .map(|[flux, bound]| difference((exact + flux).max(0.0), base + bound))
                    .find(Difference::is_within)
            }) {
                entry.ruled(
                    "rounding: a pencil on the border of the pixel, or of a shadow, may go either way",
                );
                (subset, Class::Rounding)
            } else {
                (of_truth, Class::Agree)
            };
            entry.difference(&difference, class);
        }
    }
}

/// For each subset of the uncertain light: its flux, and how far that may be off.
fn subsets(fluxes: &[UncertainFlux], k: usize) -> impl Iterator<Item = [f64; 2]> {
    let few = &fluxes[..fluxes.len().min(MAX_UNCERTAIN_PENCILS)];
    (1_u32..1 << few.len()).map(move |chosen| {
        let one = |[flux, bound]: [f64; 2], (index, uncertain): (usize, &UncertainFlux)| {
            if chosen >> index & 1 == 1 {
                [flux + uncertain.flux[k], bound + uncertain.bound[k]]
            } else {
                [flux, bound]
            }
        };
        few.iter().enumerate().fold([0.0; 2], one)
    })
}
