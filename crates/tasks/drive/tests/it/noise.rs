//! The camera's noise in recorded images: new in each.

use super::driven::NOISY;
use super::ground::{SIZE, frames};
use super::readers::npy;

#[test]
fn no_two_images_of_a_drive_have_the_same_noise() {
    // In the scan of the first frame the stripes sweep most of the image.
    let images: Vec<Vec<f64>> = (1..frames())
        .flat_map(|frame| [0, 1].map(|beam| format!("images/{frame:06}-beam{beam}.npy")))
        .map(|name| npy(&NOISY.recorded(&name)).values)
        .collect();
    let threshold = NOISY.json("recording/setup.json")["extraction"]["threshold"].as_f64().unwrap();
    let [columns, rows] = SIZE;
    // Pixels that are dark in all images, and four rows away from any light: blur does not reach them.
    let is_dark = |column: usize, row: usize| {
        let near = row.saturating_sub(4)..=(row + 4).min(rows - 1);
        near.clone().all(|row| images.iter().all(|image| image[row * columns + column] < threshold))
    };
    let dark: Vec<usize> =
        (0..rows * columns).filter(|index| is_dark(index % columns, index / columns)).collect();
    assert!(dark.len() > 10_000, "{}", dark.len());
    let count = dark.len() as f64;
    let noise: Vec<Vec<f64>> = images
        .iter()
        .map(|image| {
            let mean = dark.iter().map(|&index| image[index]).sum::<f64>() / count;
            dark.iter().map(|&index| image[index] - mean).collect()
        })
        .collect();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / count;
    let variance = product(&noise[0], &noise[0]);
    // A mean product of independent numbers has the standard error variance / sqrt(count); five of them are allowed, which
    // one of the 325 pairs exceeds in one of 5,000 drives, and the seed is fixed. Numbers are rounded to whole ones: the
    // noise must be larger.
    assert!(variance > 4.0, "{variance}");
    for (index, a) in noise.iter().enumerate() {
        assert!((product(a, a) / variance - 1.0).abs() < 5.0 * (4.0 / count).sqrt(), "image {index}");
        for (other, b) in noise[..index].iter().enumerate() {
            let share = product(a, b) / variance;
            assert!(
                share.abs() < 5.0 / count.sqrt(),
                "images {other} and {index} share {share} of their noise"
            );
        }
    }
}
