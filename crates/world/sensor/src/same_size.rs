//! Check of image sizes.

use raypencil_scene::Image;

/// Panics unless two rasters have the same size: a mistake of the program, not of its input.
pub(crate) fn assert_same_size<A: Copy, B: Copy>(a: &Image<A>, b: &Image<B>, what: &str) {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()), "size of {what}");
}
