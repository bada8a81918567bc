//! Plots: pictures with their axes, scale bar and rings, and how many cells they may have.

use crate::picture::Reduction;
use crate::scale::{Scale, Tick};

/// Maximum number of cells of all pictures of a page together. An indexed picture takes at most one byte per cell,
/// base64 a third more: 4 MB for the pictures of the default rig at full size, in practice less than half of it.
pub const MAX_PICTURE_CELLS: u64 = 3_300_000;

/// Maximum number of columns, and of rows, of a picture; a page shows no more.
pub const MAX_PICTURE_SIDE: u32 = 1024;

/// Minimum of the limit that [`max_side_of_pictures`] gives.
const MIN_SIDE_LIMIT: u32 = 32;

/// Maximum ratio of a picture's width to its height. The rows of flatter pictures are stretched.
const MAX_ASPECT: u64 = 8;

/// A picture with its title, scale bar, note and rings.
#[derive(Debug)]
pub struct Plot {
    /// Title above the picture.
    pub title: String,
    /// Description of the picture, for those who do not see it.
    pub alt: String,
    /// Address of the picture, usually [`crate::Picture::data_uri`].
    pub source: String,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Whether the picture shows differences, which are drawn cell by cell; ranges are drawn smoothly.
    pub of_differences: bool,
    /// Scale bar; `None` if no cell has a value.
    pub bar: Option<Bar>,
    /// Text below the picture.
    pub note: String,
    /// Rings around defects.
    pub marks: Vec<Ring>,
}

/// A scale bar.
#[derive(Debug, Clone)]
pub struct Bar {
    /// The colour map as a CSS gradient.
    pub gradient: String,
    /// Labelled values along the bar.
    pub ticks: Vec<Tick>,
    /// Quantity and unit.
    pub label: &'static str,
    /// Whether the legend names hits on one side only.
    pub one_sided: bool,
    /// Whether the legend names the rings around defects.
    pub marked: bool,
}

/// A ring around one or more defects of a picture.
#[derive(Debug)]
pub struct Ring {
    /// Place from the left edge of the picture, 0, to the right edge, 1.
    pub across: f64,
    /// Place from the upper edge of the picture, 0, to the lower edge, 1.
    pub down: f64,
    /// Text of the ring, such as the ray.
    pub title: String,
}

/// Maximum number of columns and rows at which the pictures of maps of these sizes, `pictures_each` of every map, have
/// at most [`MAX_PICTURE_CELLS`] cells together.
///
/// It is [`MAX_PICTURE_SIDE`], halved as often as needed, but not below 32.
///
/// ```
/// use raypencil_report::{MAX_PICTURE_SIDE, max_side_of_pictures};
///
/// // Three pictures of 1024 x 1024 cells are 3.1 million; four are too many, and become 512 x 512.
/// assert_eq!(max_side_of_pictures(&[(1024, 1024)], 3), MAX_PICTURE_SIDE);
/// assert_eq!(max_side_of_pictures(&[(1024, 1024)], 4), 512);
/// ```
pub fn max_side_of_pictures(sizes: &[(u32, u32)], pictures_each: u64) -> u32 {
    let cells = |max_side: u32| -> u64 {
        let drawn = sizes.iter().map(|&(width, height)| {
            let (columns, rows) = Reduction::to_fit(width, height, max_side).size_of(width, height);
            u64::from(columns) * u64::from(rows)
        });
        pictures_each * drawn.sum::<u64>()
    };
    let mut max_side = MAX_PICTURE_SIDE;
    while max_side > MIN_SIDE_LIMIT && cells(max_side) > MAX_PICTURE_CELLS {
        max_side /= 2;
    }
    max_side
}

/// Whether a picture of a map of this size takes the full width of the page, and its height in widths of a column.
pub fn shape(width: u32, height: u32) -> (bool, u64) {
    let drawn_height = u64::from(height) * u64::from(stretch(width, height));
    (u64::from(width) >= 3 * drawn_height, drawn_height)
}

/// Height of the drawn rows in widths of a column: 1, or more for maps more than 8 times as wide as high.
pub fn stretch(width: u32, height: u32) -> u32 {
    (u64::from(width) / (MAX_ASPECT * u64::from(height))).max(1) as u32
}

/// Ticks of an axis of `cells` cells, at most `max_ticks + 1` of them. Labels are indices, at the middle of their cell.
pub fn cells_axis(cells: u32, max_ticks: u32) -> Vec<Tick> {
    Scale::linear(-0.5, f64::from(cells) - 0.5).ticks(max_ticks.min(cells))
}

/// Note on a reduction, for the page; `None` if every cell is drawn.
pub fn reduced_to(Reduction { columns, rows }: Reduction) -> Option<String> {
    (columns > 1 || rows > 1).then(|| {
        format!(
            "Reduced to fit: {columns} × {rows} cells become one, the middle one of a map and the farthest \
             from zero of a difference."
        )
    })
}
