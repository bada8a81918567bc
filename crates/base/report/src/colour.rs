//! Colours of pictures and drawings.

/// A colour: red, green and blue, each from 0 to 255, in sRGB.
pub type Colour = [u8; 3];

/// A colour as CSS and SVG write it, `#1d1f22`.
pub(crate) fn css_hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
