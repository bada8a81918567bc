//! Points as bytes, one after the other: each with the same fields at the same places.

use raypencil_files::Fault;

use super::columns::{Cloud, CloudColumn, CloudStorage, check_names};

/// What the numbers of a field are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PackedKind {
    /// Whole, of either sign.
    Signed,
    /// Whole, 0 or more.
    Unsigned,
    /// Real, of 4 or 8 bytes.
    Real,
}

/// A field of packed points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackedField {
    /// Its name: `x`.
    pub name: String,
    /// Its place in a point, bytes.
    pub offset: usize,
    /// What its numbers are.
    pub kind: PackedKind,
    /// Bytes of a number: 1, 2, 4 or 8.
    pub size: usize,
    /// Numbers of a point; only fields of one are kept.
    pub count: usize,
}

impl PackedField {
    pub(super) fn bytes(&self) -> usize {
        self.size * self.count
    }

    /// Whether it is a field that somebody may ask for. `_` is padding.
    pub(super) fn is_kept(&self) -> bool {
        self.count == 1 && self.name != "_"
    }

    pub(super) fn storage(&self) -> CloudStorage {
        match (self.kind, self.size) {
            (PackedKind::Real, 4) => CloudStorage::Single,
            (PackedKind::Real, _) => CloudStorage::Double,
            _ => CloudStorage::Whole,
        }
    }

    /// The number of these bytes.
    pub(super) fn number(&self, bytes: &[u8], is_big_endian: bool) -> f64 {
        let mut word = [0; 8];
        word[..self.size].copy_from_slice(bytes);
        if is_big_endian {
            word[..self.size].reverse();
        }
        let bits = u64::from_le_bytes(word);
        match (self.kind, self.size) {
            (PackedKind::Real, 4) => f64::from(f32::from_bits(bits as u32)),
            (PackedKind::Real, _) => f64::from_bits(bits),
            (PackedKind::Unsigned, _) => bits as f64,
            (PackedKind::Signed, _) => {
                // Sign extension: the sign bit is moved to the top and back.
                let shift = 64 - 8 * self.size;
                ((bits << shift) as i64 >> shift) as f64
            }
        }
    }
}

/// Refuses a field that stands there twice, and an x, y or z that is not one number.
pub(super) fn check_fields(fields: &[PackedField]) -> Result<(), Fault> {
    let names: Vec<String> = fields.iter().map(|field| field.name.clone()).collect();
    check_names(&names)?;
    for (index, field) in fields.iter().enumerate() {
        let place = || format!("field `{}`", field.name);
        if field.name != "_" && fields[..index].iter().any(|other| other.name == field.name) {
            return Err(Fault::new(place(), "a second one", "each field once"));
        }
        if ["x", "y", "z"].contains(&field.name.as_str()) && field.count != 1 {
            return Err(Fault::new(place(), format!("COUNT {}", field.count), "a single number"));
        }
    }
    Ok(())
}

/// Points in rows, as a message of a robot has them.
#[derive(Debug, Clone, Copy)]
pub struct PackedPoints<'a> {
    /// What a point consists of.
    pub fields: &'a [PackedField],
    /// Points of a row, and rows.
    pub size: [u64; 2],
    /// Bytes from one point of a row to the next.
    pub point_step: usize,
    /// Bytes from one row to the next.
    pub row_step: usize,
    /// Whether the highest byte of a number is the first.
    pub is_big_endian: bool,
    /// The bytes of all rows.
    pub data: &'a [u8],
}

impl PackedPoints<'_> {
    /// The cloud of these points, with those of its fields that `keeps` names.
    ///
    /// ```
    /// use raypencil_mesh_io::{PackedField, PackedKind, PackedPoints};
    ///
    /// let real = |(name, offset): (&str, usize)| {
    ///     PackedField { name: name.into(), offset, kind: PackedKind::Real, size: 4, count: 1 }
    /// };
    /// let fields = [("x", 0), ("y", 4), ("z", 8)].map(real);
    /// let data: Vec<u8> = [1.0_f32, 2.0, 3.5].iter().flat_map(|part| part.to_be_bytes()).collect();
    /// let points = PackedPoints {
    ///     fields: &fields, size: [1, 1], point_step: 12, row_step: 12, is_big_endian: true, data: &data,
    /// };
    /// assert_eq!(points.cloud(|_| true)?.column("z").unwrap().values, [3.5]);
    /// # Ok::<(), raypencil_files::Fault>(())
    /// ```
    ///
    /// # Errors
    /// No x, y or z of one number each; a field twice, or beyond the end of its point; rows that overlap, or other bytes than these steps say.
    pub fn cloud(&self, keeps: impl Fn(&str) -> bool) -> Result<Cloud, Fault> {
        let Self { fields, size: [width, height], point_step, row_step, .. } = *self;
        check_fields(fields)?;
        for field in fields {
            let end = field.size.checked_mul(field.count).and_then(|bytes| bytes.checked_add(field.offset));
            if end.is_none_or(|end| end > point_step) {
                let found = format!("{} x {} bytes at {}", field.count, field.size, field.offset);
                let expected = format!("an end within the {point_step} bytes of a point");
                return Err(Fault::new(format!("field `{}`", field.name), found, expected));
            }
        }
        let row = width.checked_mul(point_step as u64);
        if row.is_none_or(|row| row > row_step as u64) {
            let found = format!("{row_step} bytes");
            return Err(Fault::new(
                "row_step",
                found,
                format!("{width} points of {point_step} bytes, or more"),
            ));
        }
        if height.checked_mul(row_step as u64) != Some(self.data.len() as u64) {
            let found = format!("{} bytes", self.data.len());
            return Err(Fault::new("data", found, format!("{height} rows of {row_step} bytes")));
        }
        let kept = fields.iter().filter(|field| field.is_kept() && keeps(&field.name));
        let column = |field: &PackedField| {
            let number = |point: &[u8]| {
                let bytes = &point[field.offset..field.offset + field.size];
                field.number(bytes, self.is_big_endian)
            };
            // Rows of no bytes have no points, and no chunks either.
            let rows = self.data.chunks_exact(row_step.max(1));
            let of_row = |row: &[u8]| {
                row[..width as usize * point_step].chunks_exact(point_step).map(number).collect()
            };
            CloudColumn {
                name: field.name.clone(),
                storage: field.storage(),
                values: rows.flat_map(|row| -> Vec<f64> { of_row(row) }).collect(),
            }
        };
        Ok(Cloud { width, height, columns: kept.map(column).collect() })
    }
}
