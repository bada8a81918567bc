//! Otsu's threshold between the lit and the dark pixels of an image. (N. Otsu, "A threshold selection method from
//! gray-level histograms", 1979)

use raypencil_scene::Image;

/// Bins of the histogram between the smallest and the largest value. CHOICE: 256, as for a camera of 8 bits.
const HISTOGRAM_BINS: usize = 256;

/// Threshold by Otsu's method: pixels at or above it are lit. `None` for an image of one value.
///
/// ```
/// use raypencil_rover::otsu_threshold;
/// use raypencil_scene::Image;
///
/// // Two dark pixels of 10 and two lit ones of 90. Every cut between them is equally good: the middle one, 50, is
/// // taken, within one bin of 80 / 256.
/// let image = Image::from_cells(2, 2, vec![10.0, 10.0, 90.0, 90.0]);
/// assert!((otsu_threshold(&image).unwrap() - 50.0).abs() < 0.32);
/// ```
pub fn otsu_threshold<T: Copy + Into<f64>>(image: &Image<T>) -> Option<f64> {
    let values = || image.cells().iter().map(|&cell| cell.into());
    let low = values().fold(f64::INFINITY, f64::min);
    let high = values().fold(f64::NEG_INFINITY, f64::max);
    if !(high > low) {
        return None;
    }
    let width = (high - low) / HISTOGRAM_BINS as f64;
    let mut counts = [0_u64; HISTOGRAM_BINS];
    for value in values() {
        counts[(((value - low) / width) as usize).min(HISTOGRAM_BINS - 1)] += 1;
    }
    let all = image.cells().len() as f64;
    let sum: f64 = counts.iter().enumerate().map(|(bin, &count)| bin as f64 * count as f64).sum();
    // The best cut has the largest variance between the two classes, w0 w1 (mu0 - mu1)^2.
    let (mut dark, mut dark_sum) = (0.0, 0.0);
    let (mut best, mut cuts) = (-1.0, (0, 0));
    for (bin, &count) in counts.iter().enumerate().take(HISTOGRAM_BINS - 1) {
        dark += count as f64;
        dark_sum += bin as f64 * count as f64;
        let light = all - dark;
        if light <= 0.0 {
            break;
        }
        let between = dark_sum / dark - (sum - dark_sum) / light;
        let variance = dark * light * between * between;
        if variance > best {
            (best, cuts) = (variance, (bin, bin));
        } else if variance == best {
            // No pixel lies between these cuts, so that they are equally good: take the middle one.
            cuts.1 = bin;
        }
    }
    let cut = 0.5 * (cuts.0 + cuts.1) as f64 + 1.0;
    Some(low + width * cut)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_values_are_separated_half_way() {
        // No pixel lies between 5 and 100: the cuts after 1 to 255 of 256 bins are equally good, and 128 is their middle.
        let values = (0..64).map(|n| if n < 6 { 100.0 } else { 5.0 }).collect();
        let level = otsu_threshold(&Image::from_cells(8, 8, values)).unwrap();
        assert_eq!(level, 52.5);
    }

    #[test]
    fn few_lit_pixels_of_many_values_are_separated_from_dark_ones_of_many_values() {
        // Dark pixels have 0 to 15, lit ones 180 to 255; one pixel in 32 is lit.
        let values = (0..4096_u32).map(|n| if n % 32 == 0 { 180 + (n / 32 * 7) % 76 } else { n % 16 } as u16);
        let level = otsu_threshold(&Image::from_cells(64, 64, values.collect())).unwrap();
        assert!(level > 15.0 && level < 180.0, "{level}");
    }

    #[test]
    fn the_cut_is_the_best_of_all_in_whole_numbers() {
        // Whole numbers from 0 to 256: a bin is 1 wide, and 256 lies in the last one with 255. So a pixel's bin is its
        // value, at most 255, and the threshold t parts those below t from the others. All 255 thresholds are tried,
        // each from the pixels: by the sums S and numbers N of both parts, (S0 N1 - S1 N0)^2 / (N0 N1) is the variance
        // between them, times a constant. Fractions of whole numbers are compared by their cross products.
        let mut random = 1_u64;
        for round in 0..60 {
            // Few pixels: a part that is off by one pixel, or by one value, has another best threshold.
            let (dark, lit, every) = (3 + round * 4, 2 + (round * 37) % 250, 2 + round % 5);
            let mut values: Vec<u64> = (0..24)
                .map(|n| {
                    random = random
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    if n % every == 0 { 256 - (random >> 40) % lit } else { (random >> 40) % dark }
                })
                .collect();
            (values[1], values[2]) = (0, 256);
            let score = |t: u64| -> (u128, u128) {
                let part = |is_lit: bool| {
                    let bins =
                        values.iter().map(|value| *value.min(&255)).filter(|bin| (*bin >= t) == is_lit);
                    bins.fold((0_i128, 0_i128), |(n, sum), bin| (n + 1, sum + i128::from(bin)))
                };
                let ((n0, s0), (n1, s1)) = (part(false), part(true));
                ((s0 * n1 - s1 * n0).pow(2) as u128, (n0 * n1) as u128)
            };
            let scores: Vec<(u64, (u128, u128))> = (1..=255).map(|t| (t, score(t))).collect();
            let is_less = |a: (u128, u128), b: (u128, u128)| a.0 * b.1 < b.0 * a.1;
            let best =
                scores.iter().fold(scores[0].1, |best, one| if is_less(best, one.1) { one.1 } else { best });
            let equal: Vec<u64> =
                scores.iter().filter(|one| !is_less(one.1, best)).map(|one| one.0).collect();
            let expected = 0.5 * (equal[0] + equal[equal.len() - 1]) as f64;
            let image = Image::from_cells(6, 4, values.iter().map(|value| *value as f64).collect());
            assert_eq!(otsu_threshold(&image), Some(expected), "round {round}: {equal:?}");
        }
    }

    #[test]
    fn an_image_of_one_value_has_no_threshold() {
        assert_eq!(otsu_threshold(&Image::filled(4, 4, 7_u16)), None);
    }
}
