//! Light of sun and sky behind the images of one exposure: lit by the laser, and unlit.

use raypencil_rover::ExposureTimes;
use raypencil_scene::Image;

/// Background of an exposure, watts per pixel.
#[derive(Debug, Clone)]
pub(crate) struct Background {
    /// Behind the image with the laser on.
    pub lit: Image<f64>,
    /// Behind the image with the laser off, if the vehicle has moved on for it; `None`: the same.
    pub unlit: Option<Image<f64>>,
}

impl Background {
    /// Put together from the poses of an exposure: the first `lit` images are of the image with the laser on. `None` without images.
    pub(crate) fn new(images: &[&Image<f64>], lit: usize, times: &ExposureTimes) -> Option<Self> {
        let (lit, unlit) = images.split_at(lit.min(images.len()));
        let exposed = |images: &[&Image<f64>]| times.exposed(images.iter().copied());
        Some(Self { lit: exposed(lit)?, unlit: exposed(unlit) })
    }

    /// That of the image with the laser off.
    pub(crate) fn unlit(&self) -> &Image<f64> {
        self.unlit.as_ref().unwrap_or(&self.lit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lit_and_unlit_images_have_their_own_means() {
        let images = [1.0, 3.0, 5.0, 9.0].map(|watts| Image::filled(2, 1, watts));
        let images: Vec<_> = images.iter().collect();
        let times = ExposureTimes { samples: 2, ..ExposureTimes::default() };
        let both = Background::new(&images, 2, &times).unwrap();
        assert_eq!((both.lit.at(1, 0), both.unlit().at(0, 0)), (2.0, 7.0));
        let lit = Background::new(&images[..2], 2, &times).unwrap();
        assert_eq!((lit.lit.at(1, 0), lit.unlit().at(0, 0)), (2.0, 2.0));
        assert!(Background::new(&[], 1, &times).is_none());
        // In a scan the vehicle stands, and there is one image.
        let still = Background::new(&images[3..], 1, &times).unwrap();
        assert_eq!(still.lit.at(0, 0), 9.0);
    }
}
