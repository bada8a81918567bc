//! When the exposures of a frame are, and how the vehicle moves meanwhile. (docs/theory/rover.md)

use raypencil_scene::{SceneError, check_count, check_range};

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
}

/// Maximum number of images of an exposure.
pub const MAX_BLUR_SAMPLES: u32 = 64;

impl Default for ExposureTimes {
    fn default() -> Self {
        Self { interval: 0.0, has_unlit: false, duration: 0.0, samples: 1 }
    }
}

impl ExposureTimes {
    /// Whether all exposures of a frame are from one pose.
    pub fn is_at_once(&self) -> bool {
        self.interval == 0.0 && self.samples == 1
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
    /// assert_eq!(blurred.moments(1.0).collect::<Vec<_>>(), [0.998, 1.002]);
    /// ```
    pub fn lit(&self, lit: usize) -> f64 {
        (lit * if self.has_unlit { 2 } else { 1 }) as f64 * self.interval
    }

    /// Times of the images of an exposure with its middle at `middle`, in its unit.
    pub fn moments(&self, middle: f64) -> impl Iterator<Item = f64> + use<> {
        let Self { duration, samples, .. } = *self;
        let share = move |sample| (f64::from(sample) + 0.5) / f64::from(samples) - 0.5;
        (0..samples).map(move |sample| middle + duration * share(sample))
    }

    /// Checks every field, and that `lit` lit exposures fit in a frame of `frame_time` seconds. The error names the first
    /// one that is out of range.
    ///
    /// # Errors
    /// As a part of `field`.
    pub fn validate(&self, field: &str, lit: usize, frame_time: f64) -> Result<(), SceneError> {
        check_range(|| format!("{field}.interval"), self.interval, 0.0, 1e3, "s")?;
        check_range(|| format!("{field}.duration"), self.duration, 0.0, 1e5, "s")?;
        check_count(|| format!("{field}.samples"), self.samples.into(), 1, MAX_BLUR_SAMPLES.into())?;
        // An image is read out before the next exposure begins.
        if self.interval > 0.0 && self.interval < self.duration {
            let expected = format!("0, or at least the duration of an exposure, {} s", self.duration);
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
