//! SVG to PNG by `resvg`, with a font that is compiled in. The fonts of the machine are never read, so that a picture
//! has the same letters everywhere.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{Options, Tree};

use crate::png;

/// Pixels of the PNG per pixel of the page, along either side. CHOICE: at 2 thin lines and letters read well in print.
const PIXELS_PER_PAGE_PIXEL: u32 = 2;

/// The first font that a drawing names.
const FONT: &[u8] = epaint_default_fonts::UBUNTU_LIGHT;

static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_source(Source::Binary(Arc::new(FONT)));
    Arc::new(fonts)
});

/// A page of `width` by `height` pixels as PNG.
///
/// # Panics
/// If `svg` is not SVG, which would be a fault of the drawing that wrote it.
pub(crate) fn page(svg: &str, width: u32, height: u32) -> Vec<u8> {
    let options = Options { fontdb: Arc::clone(&FONTS), ..Options::default() };
    let tree = Tree::from_str(svg, &options).expect("a page as SVG");
    let mut pixels = Pixmap::new(PIXELS_PER_PAGE_PIXEL * width, PIXELS_PER_PAGE_PIXEL * height)
        .expect("a page of at least one pixel");
    resvg::render(
        &tree,
        Transform::from_scale(PIXELS_PER_PAGE_PIXEL as f32, PIXELS_PER_PAGE_PIXEL as f32),
        &mut pixels.as_mut(),
    );
    // Every page has a white background, so that no pixel is transparent.
    let colours: Vec<u8> =
        pixels.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    png::rgb(pixels.width(), pixels.height(), &colours)
}
