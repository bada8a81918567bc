//! Convolution of an image with a kernel by direct summation, in a fixed order.
//!
//! A Fourier transform would be faster for wide kernels. Fast implementations choose their instructions by the
//! machine, however, and thereby change the bits.

use rayon::prelude::*;
use raypencil_scene::Image;

use crate::Kernel;
use crate::kernel::KernelForm;

/// Image after a convolution.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvolvedImage {
    /// Light that arrives in each cell.
    pub image: Image<f64>,
    /// Light that leaves the image over its sides, in the image's unit. The image's sum plus this is the sum of
    /// the input.
    pub lost: f64,
}

/// Spreads the light of each cell by the kernel. It is dark outside the image, and light that leaves it is lost.
///
/// ```
/// use raypencil_scene::Image;
/// use raypencil_sensor::{Kernel, convolve};
///
/// // A quarter moves left, a quarter right; from the first cell the left quarter of 8 is lost.
/// let kernel = Kernel::from_weights(3, 1, &[1.0, 2.0, 1.0])?;
/// let out = convolve(&Image::from_cells(3, 1, vec![8.0, 0.0, 4.0]), &kernel);
/// assert_eq!(out.image.cells(), &[4.0, 3.0, 2.0]);
/// assert_eq!(out.lost, 2.0 + 1.0);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn convolve(image: &Image<f64>, kernel: &Kernel) -> ConvolvedImage {
    match &kernel.form_image {
        KernelForm::Separable { across, down } => {
            let (middle, left_over_sides) = convolve_rows(image, across);
            let (image, left_over_ends) = convolve_columns(&middle, down);
            ConvolvedImage { image, lost: left_over_sides + left_over_ends }
        }
        KernelForm::Dense { columns, weights } => convolve_dense(image, *columns, weights),
    }
}

/// Range of a row outside of which it is dark: first cell, and the cell after the last.
fn lit_range(row: &[f64]) -> (usize, usize) {
    let first = row.iter().position(|value| *value != 0.0).unwrap_or(row.len());
    let last = row.iter().rposition(|value| *value != 0.0).map_or(first, |last| last + 1);
    (first, last)
}

/// Adds to `row` the light that one row of the kernel sends there from `source`, a row of the image.
fn add_spread(row: &mut [f64], source: &[f64], span: (usize, usize), weights: &[f64]) {
    let half = weights.len() / 2;
    for i in span.0..span.1 {
        let value = source[i];
        // Most of an image is dark, and 0 adds nothing.
        if value == 0.0 {
            continue;
        }
        let first = i.saturating_sub(half);
        let end = (i + half + 1).min(row.len());
        for (sum, weight) in row[first..end].iter_mut().zip(&weights[first + half - i..]) {
            *sum += value * weight;
        }
    }
}

/// Fraction of the light of cell `at` that leaves a row of `count` cells over its ends.
fn share_leaving(weights: &[f64], at: usize, count: usize) -> f64 {
    let half = weights.len() / 2;
    let before: f64 = weights[..half.saturating_sub(at)].iter().sum();
    let after: f64 = weights[(half + count - at).min(weights.len())..].iter().sum();
    before + after
}

fn convolve_rows(image: &Image<f64>, weights: &[f64]) -> (Image<f64>, f64) {
    let width = image.width() as usize;
    let mut out = Image::filled(image.width(), image.height(), 0.0);
    let shares: Vec<f64> = (0..width).map(|i| share_leaving(weights, i, width)).collect();
    let lost: Vec<f64> = out
        .cells_mut()
        .par_chunks_mut(width)
        .zip(image.cells().par_chunks(width))
        .map(|(row, source)| {
            add_spread(row, source, lit_range(source), weights);
            source.iter().zip(&shares).map(|(value, share)| value * share).sum()
        })
        .collect();
    // Summed row after row, in any distribution over threads.
    (out, lost.iter().sum())
}

fn convolve_columns(image: &Image<f64>, weights: &[f64]) -> (Image<f64>, f64) {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let half = weights.len() / 2;
    let row = |j: usize| &image.cells()[j * width..(j + 1) * width];
    let spans: Vec<(usize, usize)> = (0..height).map(|j| lit_range(row(j))).collect();
    let mut out = Image::filled(image.width(), image.height(), 0.0);
    out.cells_mut().par_chunks_mut(width).enumerate().for_each(|(j, sums)| {
        for from in j.saturating_sub(half)..(j + half + 1).min(height) {
            let weight = weights[j + half - from];
            let (first, end) = spans[from];
            for (sum, value) in sums[first..end].iter_mut().zip(&row(from)[first..end]) {
                *sum += value * weight;
            }
        }
    });
    let lost = (0..height).map(|j| row(j).iter().sum::<f64>() * share_leaving(weights, j, height)).sum();
    (out, lost)
}

fn convolve_dense(image: &Image<f64>, columns: usize, weights: &[f64]) -> ConvolvedImage {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let half = [columns / 2, weights.len() / columns / 2];
    let row = |j: usize| &image.cells()[j * width..(j + 1) * width];
    let of_kernel = |j: usize| &weights[j * columns..(j + 1) * columns];
    let spans: Vec<(usize, usize)> = (0..height).map(|j| lit_range(row(j))).collect();
    let mut out = Image::filled(image.width(), image.height(), 0.0);
    out.cells_mut().par_chunks_mut(width).enumerate().for_each(|(j, sums)| {
        for from in j.saturating_sub(half[1])..(j + half[1] + 1).min(height) {
            add_spread(sums, row(from), spans[from], of_kernel(j + half[1] - from));
        }
    });
    // Light leaves over the sides from kernel rows that stay within the image, and with whole kernel rows that do
    // not.
    let totals: Vec<f64> = (0..2 * half[1] + 1).map(|k| of_kernel(k).iter().sum()).collect();
    let lost: Vec<f64> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut lost = 0.0;
            for i in spans[j].0..spans[j].1 {
                let value = row(j)[i];
                let near_a_side = i < half[0] || i + half[0] >= width || j < half[1] || j + half[1] >= height;
                if value == 0.0 || !near_a_side {
                    continue;
                }
                let share: f64 = (0..2 * half[1] + 1)
                    .map(|k| {
                        let to = j + k;
                        let stays = to >= half[1] && to - half[1] < height;
                        if stays { share_leaving(of_kernel(k), i, width) } else { totals[k] }
                    })
                    .sum();
                lost += value * share;
            }
            lost
        })
        .collect();
    ConvolvedImage { image: out, lost: lost.iter().sum() }
}

/// Image whose pixels are sums of `oversampling x oversampling` cells of a finer image, row by row.
///
/// # Panics
/// If the finer image is not a whole number of pixels wide and high.
pub fn binned(fine: &Image<f64>, oversampling: u32) -> Image<f64> {
    let whole = oversampling > 0
        && fine.width().is_multiple_of(oversampling)
        && fine.height().is_multiple_of(oversampling);
    assert!(whole, "{} x {} cells, {oversampling} to a pixel", fine.width(), fine.height());
    let (width, height) = (fine.width() / oversampling, fine.height() / oversampling);
    let (cells, side) = (fine.width() as usize, oversampling as usize);
    let mut out = Image::filled(width, height, 0.0);
    if width > 0 {
        let bands = fine.cells().par_chunks(cells * side);
        out.cells_mut().par_chunks_mut(width as usize).zip(bands).for_each(|(row, band)| {
            for source in band.chunks(cells) {
                for (sum, part) in row.iter_mut().zip(source.chunks(side)) {
                    for value in part {
                        *sum += value;
                    }
                }
            }
        });
    }
    out
}
