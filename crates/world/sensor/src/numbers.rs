//! The numbers of a frame alone, for those who expose frame after frame. Most pixels of a frame are dark.

use rayon::prelude::*;
use raypencil_scene::Image;

use crate::dark_pixels::{DarkPixels, LANES};
use crate::image_sensor::{ImageSensor, difference, fluxes};

/// Pixels that a thread digitises at once.
const BLOCK: usize = 256 * LANES;

/// What [`ImageSensor::fixed_pattern`] keeps.
#[derive(Debug, Clone, PartialEq)]
pub struct FixedPattern {
    sensor: ImageSensor,
    size: (u32, u32),
    /// DSNU of each pixel, electrons.
    dark_signals: Vec<f64>,
}

impl FixedPattern {
    /// Whether it is that of this sensor, for images of that size.
    pub fn is_of(&self, sensor: &ImageSensor, size: (u32, u32)) -> bool {
        self.sensor == *sensor && self.size == size
    }
}

impl ImageSensor {
    /// [`DigitalImage::numbers`](crate::DigitalImage::numbers) of [`ImageSensor::expose`] alone, without the other images, as any type that holds a
    /// `u16`.
    ///
    /// # Panics
    /// As [`ImageSensor::expose`].
    pub fn numbers<T: Copy + From<u16> + Send + Sync>(
        &self,
        optical: &Image<f64>,
        background: Option<&Image<f64>>,
        frame: u64,
    ) -> Image<T> {
        self.numbers_with(None, optical, background, frame)
    }

    /// The same with a [fixed pattern](ImageSensor::fixed_pattern) that is kept from frame to frame: it changes no number,
    /// and takes a fraction of the time.
    ///
    /// ```
    /// use raypencil_scene::Image;
    /// use raypencil_sensor::ImageSensor;
    ///
    /// let (sensor, flux) = (ImageSensor::cmos(), Image::filled(8, 4, 1e-15));
    /// let pattern = sensor.fixed_pattern(8, 4);
    /// for frame in 0..3 {
    ///     let numbers: Image<u16> = sensor.numbers_with(Some(&pattern), &flux, None, frame);
    ///     assert_eq!(numbers, sensor.numbers(&flux, None, frame));
    /// }
    /// ```
    ///
    /// # Panics
    /// As [`ImageSensor::expose`]; and if the pattern is another sensor's, or of another size.
    pub fn numbers_with<T: Copy + From<u16> + Send + Sync>(
        &self,
        pattern: Option<&FixedPattern>,
        optical: &Image<f64>,
        background: Option<&Image<f64>>,
        frame: u64,
    ) -> Image<T> {
        let size = (optical.width(), optical.height());
        if let Some(pattern) = pattern {
            assert!(pattern.is_of(self, size), "the fixed pattern of another sensor");
        }
        let flux = fluxes(optical, background);
        let dark = self.dark_electrons();
        let number = |index: usize| {
            let dark_signal = pattern.map(|pattern| pattern.dark_signals[index]);
            self.digitised(self.pixel(flux(index), dark, frame, index, dark_signal).signal)
        };
        // Without noise all dark pixels are equal, and most pixels are dark.
        let in_the_dark =
            self.is_noiseless().then(|| self.digitised(self.pixel(0.0, dark, frame, 0, None).signal));
        // The DSNU of each pixel must be known, or there is none.
        let dark_pixels =
            if self.dsnu > 0.0 && pattern.is_none() { None } else { DarkPixels::new(self, dark) };
        let together = |first: usize, numbers: &mut [T]| {
            let is_dark = (first..first + numbers.len()).all(|index| flux(index) == 0.0);
            match (in_the_dark, &dark_pixels) {
                (Some(number), _) if is_dark => numbers.fill(number.into()),
                (_, Some(pixels)) if is_dark && numbers.len() == LANES => {
                    let mut dark_signals = [0.0; LANES];
                    if let Some(pattern) = pattern {
                        dark_signals.copy_from_slice(&pattern.dark_signals[first..first + LANES]);
                    }
                    let (quick, sure) = pixels.numbers(frame, first as u32, &dark_signals);
                    for (lane, of_pixel) in numbers.iter_mut().enumerate() {
                        *of_pixel = if sure[lane] { quick[lane] } else { number(first + lane) }.into();
                    }
                }
                _ => (first..).zip(numbers).for_each(|(index, of_pixel)| *of_pixel = number(index).into()),
            }
        };
        let mut numbers = vec![T::from(0); optical.cells().len()];
        numbers.par_chunks_mut(BLOCK).enumerate().for_each(|(block, numbers)| {
            for (group, numbers) in numbers.chunks_mut(LANES).enumerate() {
                together(block * BLOCK + group * LANES, numbers);
            }
        });
        Image::from_cells(optical.width(), optical.height(), numbers)
    }

    /// The part of the noise that is the same in every frame, for images of this size.
    pub fn fixed_pattern(&self, width: u32, height: u32) -> FixedPattern {
        let pixels = (0..width as usize * height as usize).into_par_iter();
        let dark_signals = pixels.map(|index| self.dark_signal(index as u32)).collect();
        FixedPattern { sensor: *self, size: (width, height), dark_signals }
    }

    /// [`ImagePair::difference`](crate::ImagePair::difference) of [`ImageSensor::expose_pair`] alone, without the other images. Here both
    /// frames have a background of their own, the lit one first.
    ///
    /// # Panics
    /// As [`ImageSensor::expose`].
    pub fn lit_minus_unlit(
        &self,
        pattern: Option<&FixedPattern>,
        optical: &Image<f64>,
        backgrounds: [Option<&Image<f64>>; 2],
        pair: u64,
    ) -> Image<i32> {
        let off = Image::filled(optical.width(), optical.height(), 0.0);
        let lit = self.numbers_with(pattern, optical, backgrounds[0], 2 * pair);
        let unlit = self.numbers_with(pattern, &off, backgrounds[1], 2 * pair + 1);
        difference(&lit, &unlit)
    }
}
