//! Row-major rasters, and the compact optional value that their cells hold.

use bytemuck::Zeroable;
use glam::DVec3;

use crate::{FaceId, SceneError};

/// A raster of `width x height` cells, row by row from the top.
///
/// ```
/// use raypencil_scene::Image;
///
/// let mut image = Image::from_cells(3, 2, vec![1, 2, 3, 4, 5, 6]);
/// // Column 2 of row 1 is the last cell.
/// assert_eq!(image.at(2, 1), 6);
/// image.set(0, 1, 9);
/// assert_eq!(image.cells(), [1, 2, 3, 9, 5, 6]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Image<T> {
    width: u32,
    height: u32,
    cells: Vec<T>,
}

impl<T: Copy> Image<T> {
    /// A raster whose cells all hold `value`.
    pub fn filled(width: u32, height: u32, value: T) -> Self {
        Self { width, height, cells: vec![value; width as usize * height as usize] }
    }

    /// A raster whose cells are all zero: memory that costs nothing until it is written.
    pub(crate) fn zeroed(width: u32, height: u32) -> Self
    where
        T: Zeroable,
    {
        Self { width, height, cells: bytemuck::zeroed_vec(width as usize * height as usize) }
    }

    /// A raster of given cells, row by row.
    ///
    /// # Panics
    /// If there are not exactly `width * height` cells.
    pub fn from_cells(width: u32, height: u32, cells: Vec<T>) -> Self {
        assert_eq!(cells.len(), width as usize * height as usize, "cells of a {width} x {height} image");
        Self { width, height, cells }
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The cell in column `i` of row `j`.
    ///
    /// # Panics
    /// If the image has no such cell.
    pub fn at(&self, i: u32, j: u32) -> T {
        assert!(i < self.width && j < self.height, "({i}, {j}) in a {} x {} image", self.width, self.height);
        self.cells[j as usize * self.width as usize + i as usize]
    }

    /// Replaces the cell in column `i` of row `j`.
    ///
    /// # Panics
    /// If the image has no such cell.
    pub fn set(&mut self, i: u32, j: u32, value: T) {
        assert!(i < self.width && j < self.height, "({i}, {j}) in a {} x {} image", self.width, self.height);
        self.cells[j as usize * self.width as usize + i as usize] = value;
    }

    /// All cells, row by row.
    pub fn cells(&self) -> &[T] {
        &self.cells
    }

    /// All cells, row by row, to be written.
    pub fn cells_mut(&mut self) -> &mut [T] {
        &mut self.cells
    }
}

/// A type with one value of its own that can mean "nothing here".
pub trait Sample: Copy + Zeroable {
    /// The value that means nothing; never a value of a quantity.
    const NOTHING: Self;
    /// Whether this is [`Sample::NOTHING`].
    fn is_nothing(&self) -> bool;
}

impl Sample for f64 {
    const NOTHING: Self = Self::NAN;
    fn is_nothing(&self) -> bool {
        self.is_nan()
    }
}

impl Sample for DVec3 {
    const NOTHING: Self = Self::NAN;
    fn is_nothing(&self) -> bool {
        self.x.is_nan()
    }
}

impl Sample for FaceId {
    const NOTHING: Self = Self(u32::MAX);
    fn is_nothing(&self) -> bool {
        self.0 == u32::MAX
    }
}

/// An `Option<T>` that is no larger than `T`, so that a raster of a million of them stays compact.
///
/// ```
/// use raypencil_scene::Maybe;
///
/// // Files write "no hit" as infinity; in code it is `None`.
/// assert_eq!(Maybe::some(2.5).get(), Some(2.5));
/// assert_eq!(Maybe::<f64>::NONE.get(), None);
/// ```
#[derive(Debug, Clone, Copy, Zeroable)]
#[repr(transparent)]
pub struct Maybe<T>(T);

impl<T: Sample> Maybe<T> {
    /// Nothing here.
    pub const NONE: Self = Self(T::NOTHING);

    /// A value.
    pub fn some(value: T) -> Self {
        debug_assert!(!value.is_nothing(), "a value of a quantity is never the one that means nothing");
        Self(value)
    }

    /// What is here, if anything.
    pub fn get(self) -> Option<T> {
        if self.0.is_nothing() { None } else { Some(self.0) }
    }
}

impl<T: Sample> From<Option<T>> for Maybe<T> {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::NONE, Self::some)
    }
}

impl<T: Sample + PartialEq> PartialEq for Maybe<T> {
    fn eq(&self, other: &Self) -> bool {
        self.get() == other.get()
    }
}

/// Maximum number of cells of a sensor: its maps stay within a few gigabytes.
const MAX_CELLS: u64 = 1 << 26;

/// Refuses a sensor without cells, or with more cells than memory should be asked for.
pub(crate) fn check_cells(
    field: &str,
    across: &str,
    columns: u32,
    down: &str,
    rows: u32,
) -> Result<(), SceneError> {
    for (name, count) in [(across, columns), (down, rows)] {
        if count == 0 || count > 1 << 20 {
            return Err(SceneError::new(format!("{field}.{name}"), count, "1 to 1048576"));
        }
    }
    if u64::from(columns) * u64::from(rows) > MAX_CELLS {
        return Err(SceneError::new(
            format!("{field}.{across} x {down}"),
            format!("{columns} x {rows}"),
            format!("at most {MAX_CELLS} cells"),
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_follow_each_other_row_by_row() {
        // 3 columns and 2 rows: column 2 of row 1 is the last of six cells, column 0 of row 1 the fourth.
        let mut image = Image::from_cells(3, 2, vec![10, 11, 12, 20, 21, 22]);
        assert_eq!((image.at(0, 1), image.at(2, 0), image.at(2, 1)), (20, 12, 22));
        image.set(1, 1, 9);
        assert_eq!(image.cells(), [10, 11, 12, 20, 9, 22]);
    }
}
