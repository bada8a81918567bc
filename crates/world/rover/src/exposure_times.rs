//! When the exposures of a frame are, and how the vehicle moves meanwhile. (docs/theory/rover.md)

use std::ops::Range;

use raypencil_scene::{Image, SceneError, check_count, check_range};

/// Times of the exposures of a frame that is no scan. By default all of them are at the time of the frame, and short.
///
/// The paper has no word of it. In a scan the vehicle stands, so that nothing of this matters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExposureTimes {
    /// Time from one exposure of a frame to the next, seconds. The middle of the first is the time of the frame.
    pub interval: f64,
    /// Whether each exposure is followed by one without the laser, which counts as an exposure too.
    pub has_unlit: bool,
    /// Duration of an exposure, seconds, if `samples` is more than 1.
    pub duration: f64,
    /// Number of images along the way whose mean an exposure is: at the middles of so many equal parts of its duration. 1: the
    /// vehicle stands still meanwhile.
    pub samples: u32,
    /// Time from the exposure of one row of the image to that of the next, seconds: a rolling shutter. The first row is exposed at
    /// the time of the exposure. 0: all rows at once.
    pub row_time: f64,
    /// Number of bands of rows of a rolling shutter. All rows of a band are seen from where the vehicle is when its middle row is
    /// exposed. With a rolling shutter, `bands` times `samples` is at most [`MAX_BLUR_SAMPLES`].
    pub bands: u32,
}

/// Maximum number of images of which an exposure is put together.
pub const MAX_BLUR_SAMPLES: u32 = 64;

/// Number of bands of a rolling shutter, if nobody gives another. CHOICE: at 0.3 m/s and 33 ms for all rows the vehicle moves by
/// 0.6 mm within a band, and no row is off by more than half of that.
const DEFAULT_BANDS: u32 = 16;

impl Default for ExposureTimes {
    fn default() -> Self {
        Self {
            interval: 0.0,
            has_unlit: false,
            duration: 0.0,
            samples: 1,
            row_time: 0.0,
            bands: DEFAULT_BANDS,
        }
    }
}

impl ExposureTimes {
    /// Whether all exposures of a frame are from one pose.
    pub fn is_at_once(&self) -> bool {
        self.interval == 0.0 && self.samples == 1 && self.row_time == 0.0
    }

    /// Middle of the exposure of the lit group number `lit` (a beam in turn, or all together), seconds after the frame.
    ///
    /// ```
    /// use raypencil_rover::ExposureTimes;
    ///
    /// // 20 ms from one to the next, lit and unlit in turn: the second beam is lit after 40 ms.
    /// let times = ExposureTimes { interval: 0.02, has_unlit: true, ..ExposureTimes::default() };
    /// assert_eq!((times.lit(0), times.lit(1)), (0.0, 0.04));
    /// // An exposure of 8 ms as the mean of two images: 2 ms before its middle and 2 ms after it.
    /// let blurred = ExposureTimes { duration: 8e-3, samples: 2, ..ExposureTimes::default() };
    /// assert_eq!(blurred.moments(1.0, 480).collect::<Vec<_>>(), [0.998, 1.002]);
    /// // A rolling shutter of 4 rows in 2 bands, 0.5 s from row to row: their middles are rows 0.5 and 2.5.
    /// let rolling = ExposureTimes { row_time: 0.5, bands: 2, ..ExposureTimes::default() };
    /// assert_eq!(rolling.moments(1.0, 4).collect::<Vec<_>>(), [1.25, 2.25]);
    /// ```
    pub fn lit(&self, lit: usize) -> f64 {
        (lit * if self.has_unlit { 2 } else { 1 }) as f64 * self.interval
    }

    /// The bands of an image of `height` rows, the first rows first. One without a rolling shutter.
    fn rows(&self, height: u32) -> Vec<Range<u32>> {
        let bands = if self.row_time > 0.0 { self.bands.clamp(1, height.max(1)) } else { 1 };
        let first = |band: u32| (u64::from(band) * u64::from(height) / u64::from(bands)) as u32;
        (0..bands).map(|band| first(band)..first(band + 1)).collect()
    }

    /// Times of the images of an exposure of `height` rows with its middle at `middle`, in seconds: for each part of its duration
    /// those of the bands.
    pub fn moments(&self, middle: f64, height: u32) -> impl Iterator<Item = f64> + use<> {
        let Self { duration, samples, row_time, .. } = *self;
        let share = move |sample| (f64::from(sample) + 0.5) / f64::from(samples) - 0.5;
        // In the middle of rows a to b - 1 is row (a + b - 1) / 2.
        let middle_row = |rows: &Range<u32>| 0.5 * (f64::from(rows.start) + f64::from(rows.end) - 1.0);
        let late: Vec<f64> = self.rows(height).iter().map(|rows| row_time * middle_row(rows)).collect();
        (0..samples).flat_map(move |sample| {
            let at = middle + duration * share(sample);
            late.clone().into_iter().map(move |late| if late > 0.0 { at + late } else { at })
        })
    }

    /// The image of an exposure of the images at its [`ExposureTimes::moments`]: each row is the mean of those of its band. A lone
    /// image is as it is. `None` without images.
    pub fn exposed<'a>(&self, images: impl IntoIterator<Item = &'a Image<f64>>) -> Option<Image<f64>> {
        let mut images = images.into_iter().peekable();
        let mut light = images.next()?.clone();
        if images.peek().is_none() {
            return Some(light);
        }
        let (bands, width) = (self.rows(light.height()), light.width() as usize);
        let cells = |rows: &Range<u32>| rows.start as usize * width..rows.end as usize * width;
        for (number, image) in (1..).zip(images) {
            let cells = cells(&bands[number % bands.len()]);
            let band = &mut light.cells_mut()[cells.clone()];
            if number < bands.len() {
                // The first image's rows stand here so far, as in all other bands.
                band.copy_from_slice(&image.cells()[cells]);
            } else {
                band.iter_mut().zip(&image.cells()[cells]).for_each(|(pixel, more)| *pixel += more);
            }
        }
        let share = 1.0 / f64::from(self.samples);
        light.cells_mut().iter_mut().for_each(|pixel| *pixel *= share);
        Some(light)
    }

    /// Checks every field, and that `lit` lit exposures of `height` rows fit in a frame of `frame_time` seconds. The error names the
    /// first one that is out of range.
    ///
    /// # Errors
    /// As a part of `field`.
    pub fn validate(&self, field: &str, lit: usize, frame_time: f64, height: u32) -> Result<(), SceneError> {
        check_range(|| format!("{field}.interval"), self.interval, 0.0, 1e3, "s")?;
        check_range(|| format!("{field}.duration"), self.duration, 0.0, 1e5, "s")?;
        check_count(|| format!("{field}.samples"), self.samples.into(), 1, MAX_BLUR_SAMPLES.into())?;
        check_range(|| format!("{field}.row_time"), self.row_time, 0.0, 1e3, "s")?;
        if self.row_time > 0.0 {
            let most = u64::from(MAX_BLUR_SAMPLES / self.samples);
            check_count(|| format!("{field}.bands"), self.bands.into(), 1, most)?;
        }
        let rolling = self.row_time * f64::from(height.saturating_sub(1));
        let takes = self.duration + rolling;
        let is_long = |time: f64, limit: f64| time > limit * (1.0 + 1e-9);
        if is_long(rolling, frame_time) {
            let value = format!("{} s, thus {rolling} s for {height} rows", self.row_time);
            let expected = format!("all rows within the {frame_time} s of a frame");
            return Err(SceneError::new(format!("{field}.row_time"), value, expected));
        }
        // Along the way of an exposure that is longer than a frame the vehicle would be at two places at once.
        if !self.is_at_once() && is_long(takes, frame_time) {
            let rows =
                if rolling > 0.0 { format!(", and {rolling} s for {height} rows") } else { String::new() };
            let value = format!("{} s{rows}", self.duration);
            let expected = format!("an exposure within the {frame_time} s of a frame");
            return Err(SceneError::new(format!("{field}.duration"), value, expected));
        }
        // An image is exposed and read out before the next one: another beam is lit then.
        if self.interval > 0.0 && self.interval < takes * (1.0 - 1e-9) {
            let expected = format!("0, or at least the duration of an exposure, {takes} s");
            return Err(SceneError::new(
                format!("{field}.interval"),
                format!("{} s", self.interval),
                expected,
            ));
        }
        let exposures = lit * if self.has_unlit { 2 } else { 1 };
        // A frame of a tenth of a second has room for exposures at 0 and 0.05 s. 1e-9 is for rounding.
        if exposures as f64 * self.interval > frame_time * (1.0 + 1e-9) {
            let value = format!("{} s between {exposures} exposures", self.interval);
            let expected = format!("all of them within the {frame_time} s of a frame");
            return Err(SceneError::new(format!("{field}.interval"), value, expected));
        }
        Ok(())
    }
}
