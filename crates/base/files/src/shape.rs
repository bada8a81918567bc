//! Sizes of arrays: the size that a header claims, checked before memory is asked for, and the size of planes to be
//! written.

use raypencil_scene::Image;

use crate::error::Fault;
use crate::limits::{Limits, MAX_EXPANSION, MAX_INFLATED_BYTES};

/// Shape of an array, as its header claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    pub rows: u64,
    pub columns: u64,
    pub components: u64,
}

/// Maximum components of a cell. An array with more has another meaning than channels.
const MAX_COMPONENTS: u64 = 1024;

impl Shape {
    /// Refuses a shape without cells, a shape beyond `limits`, and a shape that does not need exactly the `bytes` that
    /// follow the header. `number_bytes` is the size of one number.
    ///
    /// The planes of an accepted shape therefore take at most 4 times the memory of the file.
    pub(crate) fn check(&self, number_bytes: u64, bytes: u64, limits: &Limits) -> Result<(), Fault> {
        self.check_size(limits)?;
        let &Self { rows, columns, components } = self;
        // At most 2^64 cells times 2^13 bytes.
        let claimed = u128::from(rows * columns) * u128::from(components * number_bytes);
        if claimed > u128::from(limits.bytes) {
            let found = format!("{rows} rows of {columns} columns, {components} components");
            return Err(Fault::new("shape", found, format!("at most {} bytes", limits.bytes)));
        }
        // CHOICE: surplus bytes are refused as well. Header and numbers then do not belong together, and every
        // number may be in a wrong place.
        if claimed != u128::from(bytes) {
            let expected = format!("the {claimed} bytes of its shape ({})", why_not_so_long(bytes, claimed));
            return Err(Fault::new("numbers", format!("{bytes} bytes"), expected));
        }
        Ok(())
    }
}

/// What may be wrong with a file that has so many bytes of numbers in place of those that its shape claims.
pub(crate) fn why_not_so_long(bytes: u64, claimed: u128) -> &'static str {
    match u128::from(bytes) < claimed {
        true => "is the file cut off?",
        false => "is its shape right?",
    }
}

impl Shape {
    /// Refuses a shape without cells, a shape beyond `limits`, and one whose planes would take far more memory than a
    /// compressed file of `file_bytes` needs: a small one could ask for gigabytes.
    pub(crate) fn check_decoded(&self, file_bytes: u64, limits: &Limits) -> Result<(), Fault> {
        let &Self { rows, columns, components } = self;
        let doubles = u128::from(rows) * u128::from(columns) * u128::from(components) * 8;
        let most = MAX_INFLATED_BYTES.max(MAX_EXPANSION.saturating_mul(file_bytes)).min(limits.bytes);
        if doubles > u128::from(most) {
            let found = format!("{columns} x {rows} cells of {components} components in {file_bytes} bytes");
            return Err(Fault::new("size", found, format!("at most {most} bytes as doubles")));
        }
        self.check_size(limits)
    }

    /// Refuses a shape without cells, and a shape of too many.
    fn check_size(&self, limits: &Limits) -> Result<(), Fault> {
        let &Self { rows, columns, components } = self;
        let refuse = |expected: String| {
            let found = format!("{rows} rows of {columns} columns, {components} components");
            Err(Fault::new("shape", found, expected))
        };
        let sides = u64::from(u32::MAX);
        if rows == 0 || columns == 0 || rows > sides || columns > sides || rows * columns > limits.cells {
            return refuse(format!("1 to {} cells", limits.cells));
        }
        if components == 0 || components > MAX_COMPONENTS {
            return refuse(format!("1 to {MAX_COMPONENTS} components"));
        }
        if let Some((width, height)) = limits.size
            && (columns, rows) != (width.into(), height.into())
        {
            return refuse(format!("{height} rows of {width} columns"));
        }
        Ok(())
    }
}

/// Columns and rows that all images have in common.
pub(crate) fn common_size<T: Copy>(planes: &[&Image<T>]) -> Result<(u32, u32), Fault> {
    let size = |image: &Image<T>| (image.width(), image.height());
    let Some((first, rest)) = planes.split_first() else {
        return Err(Fault::new("images", "none", "at least one"));
    };
    match rest.iter().find(|plane| size(plane) != size(first)) {
        None => Ok(size(first)),
        Some(other) => {
            let ((width, height), (columns, rows)) = (size(first), size(other));
            Err(Fault::new(
                "images",
                format!("{columns} x {rows}"),
                format!("{width} x {height} as the first"),
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is found of a shape that is refused.
    fn refusal(result: Result<(), Fault>) -> Option<String> {
        result.err().map(|fault| fault.to_string())
    }

    #[test]
    fn a_compressed_size_is_that_of_all_components_and_may_equal_the_limit() {
        let shape = Shape { rows: 3, columns: 5, components: 4 };
        // 3 x 5 cells of 4 doubles.
        let check = |bytes: u64| refusal(shape.check_decoded(0, &Limits { bytes, ..Limits::default() }));
        assert_eq!(check(480), None);
        let expected = "size: 5 x 3 cells of 4 components in 0 bytes; expected at most 479 bytes as doubles";
        assert_eq!(check(479).as_deref(), Some(expected));
        // 2^26 doubles, and as many as a file of 2^24 bytes may have.
        let large = Limits { bytes: u64::MAX, cells: u64::MAX, size: None };
        let of = |rows: u64, file_bytes: u64| {
            refusal(Shape { rows, columns: 1 << 16, components: 2 }.check_decoded(file_bytes, &large))
        };
        assert_eq!((of(512, 0), of(513, 0).is_some()), (None, true));
        assert_eq!((of(1024, 1 << 24), of(1025, 1 << 24).is_some()), (None, true));
    }

    #[test]
    fn sides_cells_and_components_may_equal_their_limits() {
        let limits = Limits { cells: 15, ..Limits::default() };
        let check = |rows: u64, columns: u64, components: u64| {
            Shape { rows, columns, components }.check_size(&limits).is_ok()
        };
        assert!(check(3, 5, 1) && check(15, 1, MAX_COMPONENTS) && check(1, 15, 1));
        assert!(!check(4, 4, 1) && !check(0, 5, 1) && !check(5, 0, 1));
        assert!(!check(1, 1, 0) && !check(1, 1, MAX_COMPONENTS + 1));
        let most = Limits { cells: u64::MAX, ..limits };
        let side = u64::from(u32::MAX);
        let of = |rows: u64, columns: u64| Shape { rows, columns, components: 1 }.check_size(&most).is_ok();
        assert!(of(side, side) && !of(side + 1, 1) && !of(1, side + 1));
    }
}
