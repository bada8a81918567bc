//! Light of sun and sky behind the images of one exposure: lit by the laser, and unlit.

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
    /// Means over the poses of an exposure: the first `lit` images are of the image with the laser on. `None` without images.
    pub(crate) fn new(images: &[&Image<f64>], lit: usize) -> Option<Self> {
        let (lit, unlit) = images.split_at(lit.min(images.len()));
        Some(Self { lit: mean(lit)?, unlit: mean(unlit) })
    }

    /// That of the image with the laser off.
    pub(crate) fn unlit(&self) -> &Image<f64> {
        self.unlit.as_ref().unwrap_or(&self.lit)
    }
}

fn mean(images: &[&Image<f64>]) -> Option<Image<f64>> {
    let (first, others) = images.split_first()?;
    let mut mean = (*first).clone();
    if others.is_empty() {
        return Some(mean);
    }
    for image in others {
        mean.cells_mut().iter_mut().zip(image.cells()).for_each(|(pixel, more)| *pixel += more);
    }
    let share = 1.0 / images.len() as f64;
    mean.cells_mut().iter_mut().for_each(|pixel| *pixel *= share);
    Some(mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lit_and_unlit_images_have_their_own_means() {
        let images = [1.0, 3.0, 5.0, 9.0].map(|watts| Image::filled(2, 1, watts));
        let images: Vec<_> = images.iter().collect();
        let both = Background::new(&images, 2).unwrap();
        assert_eq!((both.lit.at(1, 0), both.unlit().at(0, 0)), (2.0, 7.0));
        let lit = Background::new(&images[..2], 2).unwrap();
        assert_eq!((lit.lit.at(1, 0), lit.unlit().at(0, 0)), (2.0, 2.0));
        assert!(Background::new(&[], 1).is_none());
    }
}
