//! The flux of a beam on the image, pixel by pixel, against the sum over the pencils that land there.
//!
//! A recording that says where its pencils land is held to the exact sum over those, each of which is judged by
//! itself. One that gives the image alone is held to the true pencils; a pencil that may round into another pixel,
//! or out of sight, may then be in the sum or not, as a whole.

use std::collections::HashMap;

use crate::bounds::least_normal;
use crate::check::doubt::Possible;
use crate::check::pencil::Landing;
use crate::check::ray::Judged;
use crate::check::said::Difference;
use crate::check::truth::Truth;
use crate::class::{Class, Item, Quantity};
use crate::recorded::Recorded;
use raypencil_files::Storage;
use raypencil_scene::Place;
use raypencil_scene::{Pixel, SensorId};

/// What lands in one pixel of one beam, by the scene's model and by the other.
#[derive(Debug, Clone, Copy)]
struct Landed {
    count: u32,
    flux: [f64; 2],
    bound: [f64; 2],
    class: Class,
}

/// One beam's light on the image.
#[derive(Debug)]
pub(crate) struct BeamImage {
    beam: usize,
    width: u32,
    pixels: Vec<Landed>,
    /// What may be in a pixel's sum or not, by the pixel's index.
    options: HashMap<usize, Vec<Possible>>,
}

/// All subsets are tried of so many pencils at most; of more, only how much they could change in all is asked.
const SUBSETS: usize = 12;

impl BeamImage {
    pub(super) fn empty(truth: &Truth<'_>, beam: usize) -> Self {
        let camera = &truth.scene().camera().sensor;
        let nothing = Landed { count: 0, flux: [0.0; 2], bound: [0.0; 2], class: Class::Agree };
        let cells = camera.width as usize * camera.height as usize;
        Self { beam, width: camera.width, pixels: vec![nothing; cells], options: HashMap::new() }
    }

    fn index(&self, pixel: Pixel) -> usize {
        pixel.j as usize * self.width as usize + pixel.i as usize
    }

    /// Adds a pencil where it lands, and notes where it does not land any more.
    pub(super) fn land(&mut self, landing: &Landing) {
        if let Some(delivered) = &landing.delivered {
            let index = self.index(delivered.pixel);
            let landed = &mut self.pixels[index];
            landed.count += 1;
            for k in 0..2 {
                landed.flux[k] += delivered.flux[k];
                landed.bound[k] += delivered.bound[k];
            }
            landed.class = landed.class.max(delivered.class);
        }
        if let Some((pixel, class)) = landing.left {
            let index = self.index(pixel);
            self.pixels[index].class = self.pixels[index].class.max(class);
        }
    }

    /// Adds what may be in a sum or not.
    pub(super) fn may_land(&mut self, options: Vec<Possible>) {
        for option in options {
            let index = self.index(option.pixel);
            self.options.entry(index).or_default().push(option);
        }
    }

    /// Judges what is said of one pixel.
    pub(super) fn judge(&self, truth: &Truth<'_>, recorded: &Recorded, judged: &mut Judged<'_>) {
        let Place { i, j, .. } = judged.place;
        let (light, true_light) = (&recorded.answers.light[self.beam], &truth.answers().light[self.beam]);
        let said = [&light.image, &light.other_image];
        let exact = [&true_light.image, &true_light.other_image];
        let index = self.index(Pixel { i, j });
        let landed = self.pixels[index];
        for k in 0..2 {
            let item = Item { is_other_model: k == 1, ..Item::of_image(self.beam) };
            let (Some(said), Some(exact)) = (said[k], exact[k]) else {
                judged.missing(item);
                continue;
            };
            let (said, exact) = (said.at(i, j), exact.at(i, j));
            let storage = recorded.storage_of(SensorId::Camera, item);
            // n u Sigma of the recording's sum, and what n numbers lose that are too small for its arithmetic.
            let count = f64::from(landed.count);
            let rounding = count * recorded.precision.unit_roundoff * landed.flux[k]
                + count * least_normal(recorded.precision) * recorded.precision.unit_roundoff;
            let base = landed.bound[k] + rounding;
            let difference = |from: f64, bound: f64| {
                let stored = 0.5 * (storage.ulp(said) + Storage::F64.ulp(from));
                Difference {
                    item,
                    error: (said - from).abs(),
                    ulps: if said == from { 0.0 } else { (said - from).abs() / storage.ulp(from) },
                    // Nothing is exactly 0.
                    bound: if from == 0.0 && bound == 0.0 { 0.0 } else { bound + stored },
                    is_lost: from != 0.0 && 0.5 * storage.ulp(from) >= from,
                }
            };
            let of_truth = difference(exact, base);
            let own = difference(landed.flux[k], base);
            let (difference, class) = if of_truth.is_within() {
                (of_truth, Class::Agree)
            } else if landed.class != Class::Agree && own.is_within() {
                judged.ruled("the sum over its own pencils");
                if landed.class == Class::Defect {
                    let (said, exact) = (format!("{said:e}"), format!("{exact:e}"));
                    judged.note(&format!("it adds up a pencil that is wrong: {said}, true is {exact}"));
                }
                (own, landed.class)
            } else if let Some(subset) = self.options.get(&index).and_then(|options| {
                subsets(options, k)
                    .map(|[flux, bound]| difference((exact + flux).max(0.0), base + bound))
                    .find(Difference::is_within)
            }) {
                judged.ruled(
                    "rounding: a pencil on the border of the pixel, or of a shadow, may go either way",
                );
                (subset, Class::Rounding)
            } else {
                (of_truth, Class::Agree)
            };
            judged.difference(&difference, class);
        }
    }
}

/// By how much each choice of what may be there changes a sum, and how far that may be off.
fn subsets(options: &[Possible], k: usize) -> impl Iterator<Item = [f64; 2]> {
    let few = &options[..options.len().min(SUBSETS)];
    (1_u32..1 << few.len()).map(move |chosen| {
        let one = |[flux, bound]: [f64; 2], (index, option): (usize, &Possible)| {
            if chosen >> index & 1 == 1 {
                [flux + option.flux[k], bound + option.bound[k]]
            } else {
                [flux, bound]
            }
        };
        few.iter().enumerate().fold([0.0; 2], one)
    })
}

/// A flux of an image's pixels is one of these quantities for each beam.
impl Item {
    /// The flux of a beam on the image, by the scene's model.
    pub fn of_image(beam: usize) -> Self {
        Self { beam: Some(beam as u32), ..Quantity::PixelFlux.into() }
    }
}
