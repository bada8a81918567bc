//! The returns of a beam's pencils: visible to the camera or not, at which pixel, and the flux that arrives.

use crate::{Image, Maybe, Sample};

/// A pixel of the camera's image: column `i` of row `j`, row 0 on top.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, bytemuck::Zeroable)]
pub struct Pixel {
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
}

impl Sample for Pixel {
    const NOTHING: Self = Self { i: u32::MAX, j: u32::MAX };
    fn is_nothing(&self) -> bool {
        self.i == u32::MAX
    }
}

/// The return of one pencil that hits: its point as the camera sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Return {
    /// Whether the camera sees the point: its front is turned to the camera, it lies beyond the focal length
    /// and on the image, and no other face meets the segment between it and the image plane.
    pub visible: bool,
    /// Pixel in which the point lands, hidden or not; `None` if it lands outside the image.
    pub pixel: Option<Pixel>,
    /// r: distance of the point from the projection centre *along the camera's normal axis*, metres. Negative
    /// behind the camera.
    pub depth: f64,
    /// cos(phi): of the angle between the camera's normal axis and the ray from the projection centre to
    /// the point.
    pub cos_off_axis: f64,
    /// cos(theta): of the angle between the face's normal and the direction to the projection centre; negative
    /// where the camera is behind the face.
    pub cos_view: f64,
    /// The flux that arrives in the pixel, watts (`eq1`: W/m); 0 if the point is not visible.
    pub flux: f64,
}

/// The returns of one beam. Every quantity is optional.
#[derive(Debug, Clone, PartialEq)]
pub struct Returns {
    /// Columns of every raster.
    pub columns: u32,
    /// Rows of every raster.
    pub rows: u32,
    /// [`Return::visible`]; false where there is no hit.
    pub visible: Option<Image<bool>>,
    /// [`Return::pixel`].
    pub pixel: Option<Image<Maybe<Pixel>>>,
    /// [`Return::depth`], metres.
    pub depth: Option<Image<Maybe<f64>>>,
    /// [`Return::cos_off_axis`].
    pub cos_off_axis: Option<Image<Maybe<f64>>>,
    /// [`Return::cos_view`].
    pub cos_view: Option<Image<Maybe<f64>>>,
    /// [`Return::flux`], watts (`eq1`: W/m); 0 where there is no hit.
    pub flux: Option<Image<f64>>,
}

impl Returns {
    /// Rasters of every quantity, without a hit anywhere.
    pub fn empty(columns: u32, rows: u32) -> Self {
        Self {
            columns,
            rows,
            visible: Some(Image::filled(columns, rows, false)),
            pixel: Some(Image::filled(columns, rows, Maybe::NONE)),
            depth: Some(Image::filled(columns, rows, Maybe::NONE)),
            cos_off_axis: Some(Image::filled(columns, rows, Maybe::NONE)),
            cos_view: Some(Image::filled(columns, rows, Maybe::NONE)),
            flux: Some(Image::filled(columns, rows, 0.0)),
        }
    }

    /// No quantity: the answer of a renderer that does not support the request.
    pub fn unsupported(columns: u32, rows: u32) -> Self {
        Self {
            columns,
            rows,
            visible: None,
            pixel: None,
            depth: None,
            cos_off_axis: None,
            cos_view: None,
            flux: None,
        }
    }

    /// Writes the return of pencil (i, j) into the rasters that exist.
    pub fn put(&mut self, i: u32, j: u32, back: &Return) {
        fn write<T: Copy>(raster: &mut Option<Image<T>>, i: u32, j: u32, value: T) {
            if let Some(image) = raster {
                image.set(i, j, value);
            }
        }
        write(&mut self.visible, i, j, back.visible);
        write(&mut self.pixel, i, j, back.pixel.into());
        write(&mut self.depth, i, j, Maybe::some(back.depth));
        write(&mut self.cos_off_axis, i, j, Maybe::some(back.cos_off_axis));
        write(&mut self.cos_view, i, j, Maybe::some(back.cos_view));
        write(&mut self.flux, i, j, back.flux);
    }
}
