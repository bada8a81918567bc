//! The threshold that parts an image in light and dark. (N. Otsu, "A threshold selection method from gray-level
//! histograms", 1979)

use raypencil_scene::Image;

/// Histogram bins of Otsu's method. CHOICE: 256, as for a camera of 8 bits.
const HISTOGRAM_BINS: usize = 256;

/// The value at and above which Otsu's method calls a pixel lit, or `None` for an image of one value.
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
    // The variance between the two classes, w0 w1 (mu0 - mu1)^2, is largest at the best cut.
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
            // No pixel between: any cut there is as good, so the middle one is taken.
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
    fn two_values_are_parted_half_way() {
        // 5 and 100: no pixel between, so the middle of all best cuts, within a bin of 95 / 256.
        let values = (0..64).map(|n| if n < 6 { 100.0 } else { 5.0 }).collect();
        let level = otsu_threshold(&Image::from_cells(8, 8, values)).unwrap();
        assert!((level - 52.5).abs() < 0.38, "{level}");
    }

    #[test]
    fn a_few_lit_pixels_with_spread_are_parted_from_a_spread_dark() {
        // Dark 0 to 15, light 180 to 255, one pixel in 32 lit.
        let values = (0..4096_u32).map(|n| if n % 32 == 0 { 180 + (n / 32 * 7) % 76 } else { n % 16 } as u16);
        let level = otsu_threshold(&Image::from_cells(64, 64, values.collect())).unwrap();
        assert!(level > 15.0 && level < 180.0, "{level}");
    }

    #[test]
    fn an_image_of_one_value_has_no_threshold() {
        assert_eq!(otsu_threshold(&Image::filled(4, 4, 7_u16)), None);
    }
}
