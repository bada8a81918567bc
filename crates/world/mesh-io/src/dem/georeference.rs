//! Places of the pixels of a GeoTIFF: tie point, scale, transformation. (OGC 19-008r4, GeoTIFF 1.1)

use std::io::{Read, Seek};

use raypencil_files::Fault;

use crate::dem::coordinate_system::{AxisSystem, GivenUnits, systems};
use crate::dem::gdal_metadata::GdalMetadata;
use crate::dem::geo_keys::GeoKeys;
use crate::dem::nodata;
use crate::dem::registration::Registration;
use crate::dem::tags::{Tags, tag_name};
use crate::dem::unit::LengthUnit;

/// Tag numbers.
const PIXEL_SCALE: u16 = 33550;

const TIE_POINT: u16 = 33922;

const TRANSFORMATION: u16 = 34264;

/// Maximum absolute map coordinate and spacing, metres. At 1e9 m a double has steps of a tenth of a micrometre.
const MAX_COORDINATE_M: f64 = 1e9;

/// Places of the middles of pixels on the map, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    /// Middle of pixel (0, 0).
    pub first: [f64; 2],
    /// Step from a pixel to the next of its row: along x, to the east.
    pub column: f64,
    /// Step from a row to the next: along y; negative if rows run to the south, as in most files.
    pub row: f64,
}

impl Placement {
    /// A placement in another unit, in metres.
    fn to_metres(self, unit: LengthUnit) -> Self {
        Self {
            first: self.first.map(|coordinate| unit.to_metres(coordinate)),
            column: unit.to_metres(self.column),
            row: unit.to_metres(self.row),
        }
    }
}

/// Places of a file's pixels, and the meaning of their samples.
pub(super) struct Georeference {
    pub placement: Placement,
    pub registration: Registration,
    /// The coordinate systems of the map and of the heights.
    pub systems: [AxisSystem; 2],
    /// Sample that stands for "not known"; `None` if the file names none.
    pub nodata: Option<f64>,
}

/// Reads and checks the places of the posts and the meaning of their samples.
pub(super) fn read(
    tags: &Tags,
    file: &mut (impl Read + Seek),
    given: GivenUnits,
) -> Result<Georeference, Fault> {
    let keys = GeoKeys::read(tags, file)?;
    let registration = keys.registration()?;
    let metadata = GdalMetadata::read(tags, file)?;
    let systems = systems(&keys, &metadata, given)?;
    let placement = placement(tags, file, registration, systems[0].unit.unit)?;
    Ok(Georeference { placement, registration, systems, nodata: nodata::declared(tags, file)? })
}

/// The affine map from pixels to metres, for a map in `unit`. It may scale and translate, but not rotate.
fn placement(
    tags: &Tags,
    file: &mut (impl Read + Seek),
    registration: Registration,
    unit: LengthUnit,
) -> Result<Placement, Fault> {
    // (0, 0) is the outer corner of a pixel that is an area, whose post is in the middle.
    let half = match registration {
        Registration::Area | Registration::AreaByDefault => 0.5,
        Registration::Point => 0.0,
    };
    let (place, placement) = match tags.reals(file, TRANSFORMATION)? {
        Some(matrix) => (TRANSFORMATION, agreeing(by_matrix(&matrix, half)?, tags, file, half)?),
        None => (PIXEL_SCALE, by_tie_point(tags, file, half)?),
    };
    let placement = placement.to_metres(unit);
    let Placement { first: [x, y], column, row } = placement;
    if !(column > 0.0
        && row != 0.0
        && [x, y, column, row].iter().all(|value| value.abs() <= MAX_COORDINATE_M))
    {
        let found = format!("pixel (0, 0) at ({x}, {y}), pixels {column} and rows {row} apart");
        return Err(Fault::new(
            tag_name(place),
            found,
            "coordinates within 1e9 m, columns to the east, and pixels of some size",
        ));
    }
    Ok(placement)
}

/// Placement by the transformation matrix.
fn by_matrix(matrix: &[f64], half: f64) -> Result<Placement, Fault> {
    let expected = "sixteen numbers that scale and move x and y, and neither turn, shear nor touch heights";
    let unfit = || Fault::new(tag_name(TRANSFORMATION), format!("{matrix:?}"), expected);
    // Row by row: x = a i + d, y = f j + h; z is the sample itself. (GeoTIFF 1.1, section 7.4.5.3)
    let &[a, b, c, d, e, f, g, h, i, j, scale_z, z, k, l, m, n] = matrix else { return Err(unfit()) };
    let is_plain = [b, c, e, g, i, j, z, k, l, m] == [0.0; 10] && n == 1.0;
    if !is_plain || !(scale_z == 0.0 || scale_z == 1.0) {
        return Err(unfit());
    }
    Ok(Placement { first: [d + a * half, h + f * half], column: a, row: f })
}

/// The placement by the matrix, if a pixel scale and a tie point beside it say the same: a program may take the one or
/// the others. CHOICE: places to a thousandth of a pixel, and spacings to a millionth, because writers round.
fn agreeing(
    matrix: Placement,
    tags: &Tags,
    file: &mut (impl Read + Seek),
    half: f64,
) -> Result<Placement, Fault> {
    if tags.reals(file, PIXEL_SCALE)?.is_none() || tags.reals(file, TIE_POINT)?.is_none() {
        return Ok(matrix);
    }
    let tie = by_tie_point(tags, file, half)?;
    let near = |a: f64, b: f64, step: f64, part: f64| (a - b).abs() <= part * step.abs();
    let is_same = near(tie.first[0], matrix.first[0], tie.column, 1e-3)
        && near(tie.first[1], matrix.first[1], tie.row, 1e-3)
        && near(tie.column, matrix.column, tie.column, 1e-6)
        && near(tie.row, matrix.row, tie.row, 1e-6);
    if is_same {
        return Ok(matrix);
    }
    let place =
        format!("{}, {} and {}", tag_name(TRANSFORMATION), tag_name(PIXEL_SCALE), tag_name(TIE_POINT));
    let words = |of: Placement| {
        format!("({}, {}) and steps of {} and {}", of.first[0], of.first[1], of.column, of.row)
    };
    let found = format!("the middle of pixel (0, 0) at {}, and at {}", words(matrix), words(tie));
    Err(Fault::new(place, found, "one place: take the matrix or the two others out"))
}

/// Placement by the pixel scale and one tie point.
fn by_tie_point(tags: &Tags, file: &mut (impl Read + Seek), half: f64) -> Result<Placement, Fault> {
    let missing = |tag: u16| {
        let expected = format!(
            "a place in the map: {} and {}, or {} (gdal_translate -a_ullr gives one to a bare picture)",
            tag_name(PIXEL_SCALE),
            tag_name(TIE_POINT),
            tag_name(TRANSFORMATION)
        );
        Fault::new(tag_name(tag), "missing", expected)
    };
    let scale = tags.reals(file, PIXEL_SCALE)?.ok_or_else(|| missing(PIXEL_SCALE))?;
    let tie = tags.reals(file, TIE_POINT)?.ok_or_else(|| missing(TIE_POINT))?;
    let &[scale_x, scale_y, scale_z] = scale.as_slice() else {
        return Err(Fault::new(tag_name(PIXEL_SCALE), format!("{scale:?}"), "three numbers"));
    };
    let &[i, j, k, x, y, z] = tie.as_slice() else {
        return Err(Fault::new(tag_name(TIE_POINT), format!("{} numbers", tie.len()), "six: one tie point"));
    };
    // A negative scale is ambiguous: some writers mean a flipped model by it, others nothing.
    if !(scale_x > 0.0 && scale_y > 0.0) {
        return Err(Fault::new(
            tag_name(PIXEL_SCALE),
            format!("{scale:?}"),
            "two numbers above zero, then 0 or 1",
        ));
    }
    if !(scale_z == 0.0 || scale_z == 1.0) || [k, z] != [0.0; 2] {
        let found = format!("heights scaled by {scale_z} and moved from {k} to {z}");
        return Err(Fault::new(
            format!("{} and {}", tag_name(PIXEL_SCALE), tag_name(TIE_POINT)),
            found,
            "plain heights",
        ));
    }
    Ok(Placement {
        first: [x + (half - i) * scale_x, y - (half - j) * scale_y],
        column: scale_x,
        row: -scale_y,
    })
}
