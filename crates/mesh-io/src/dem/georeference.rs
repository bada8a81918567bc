//! Places of the pixels of a GeoTIFF: tie point, scale, transformation, geo keys. (OGC 19-008r4, GeoTIFF 1.1)

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use raypencil_files::Fault;

use crate::dem::registration::Registration;
use crate::dem::tags::{Tags, tag_name};

/// Tag numbers.
const PIXEL_SCALE: u16 = 33550;

const TIE_POINT: u16 = 33922;

const TRANSFORMATION: u16 = 34264;

const GEO_KEYS: u16 = 34735;

const METADATA: u16 = 42112;

const NODATA: u16 = 42113;

/// Maximum absolute map coordinate and spacing, metres. At 1e9 m a double has steps of a tenth of a micrometre.
const MAX_COORDINATE_M: f64 = 1e9;

/// Code of the metre among units of length. (EPSG 9001)
const METRE_CODE: u16 = 9001;

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

/// Places of a file's pixels, and the meaning of their samples.
pub(super) struct Georeference {
    pub placement: Placement,
    pub registration: Registration,
    pub nodata: Option<f64>,
}

/// Reads and checks the places of the posts and the meaning of their samples.
pub(super) fn read(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<Georeference, Fault> {
    let keys = GeoKeys::read(tags, file)?;
    let registration = keys.registration()?;
    keys.check_units()?;
    check_metadata(tags, file)?;
    let placement = placement(tags, file, registration)?;
    Ok(Georeference { placement, registration, nodata: nodata(tags, file)? })
}

/// Short values of the geo keys, by key. Texts and doubles, whose values are in other tags, are left out.
struct GeoKeys(BTreeMap<u16, u16>);

impl GeoKeys {
    fn read(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<Self, Fault> {
        let mut keys = BTreeMap::new();
        let Some(values) = tags.integers(file, GEO_KEYS)? else { return Ok(Self(keys)) };
        let values: Vec<u16> = values.iter().map(|&value| u16::try_from(value).unwrap_or(u16::MAX)).collect();
        let unfit = |found: String| {
            let expected = "version 1, its revision, and four numbers for each of as many keys as it says";
            Fault::new(tag_name(GEO_KEYS), found, expected)
        };
        let (head, rest) = values.split_at_checked(4).ok_or_else(|| unfit(format!("{values:?}")))?;
        let count = usize::from(head[3]);
        if head[0] != 1 || rest.len() < 4 * count {
            return Err(unfit(format!("{head:?} and {} more numbers", rest.len())));
        }
        for key in rest.chunks_exact(4).take(count) {
            // Location 0: the value is in this tag.
            if key[1] == 0 {
                keys.insert(key[0], key[3]);
            }
        }
        Ok(Self(keys))
    }

    /// A fault of the value of a geo key.
    fn fault(key: u16, key_name: &str, value: u16, expected: &str) -> Fault {
        Fault::new(format!("{}, key {key} {key_name}", tag_name(GEO_KEYS)), value.to_string(), expected)
    }

    /// Meaning of a pixel. CHOICE: an area if the file states nothing, as in GeoTIFF 1.0 and GDAL.
    fn registration(&self) -> Result<Registration, Fault> {
        match self.0.get(&1025) {
            None => Ok(Registration::AreaByDefault),
            Some(1) => Ok(Registration::Area),
            Some(2) => Ok(Registration::Point),
            Some(&other) => {
                Err(Self::fault(1025, "GTRasterTypeGeoKey", other, "1 (PixelIsArea) or 2 (PixelIsPoint)"))
            }
        }
    }

    /// Refuses other units than metres, along any axis that has a key.
    fn check_units(&self) -> Result<(), Fault> {
        match self.0.get(&1024) {
            Some(2) => {
                let expected =
                    "map coordinates in metres, not degrees: project the model first (gdalwarp -t_srs)";
                return Err(Self::fault(1024, "GTModelTypeGeoKey", 2, expected));
            }
            Some(3) => {
                let expected =
                    "map coordinates, not geocentric ones: project the model first (gdalwarp -t_srs)";
                return Err(Self::fault(1024, "GTModelTypeGeoKey", 3, expected));
            }
            _ => {}
        }
        for (key, key_name) in [(3076, "ProjLinearUnitsGeoKey"), (4099, "VerticalUnitsGeoKey")] {
            match self.0.get(&key) {
                None | Some(&METRE_CODE) => {}
                Some(&other) => return Err(Self::fault(key, key_name, other, "9001, metres")),
            }
        }
        Ok(())
    }
}

/// Refuses heights that GDAL would scale or shift, or that are in another unit than metres.
fn check_metadata(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<(), Fault> {
    let Some(text) = tags.text(file, METADATA)? else { return Ok(()) };
    // <Item name="SCALE" sample="0" role="scale">0.1</Item>: at most one item of a role for the one band.
    let item = |role: &str| {
        let (_, after) = text.split_once(&format!("role=\"{role}\""))?;
        let (_, value) = after.split_once('>')?;
        Some(value.split('<').next().unwrap_or(value).trim().to_string())
    };
    for (role, neutral) in [("scale", 1.0), ("offset", 0.0)] {
        if let Some(value) = item(role).filter(|value| value.parse() != Ok(neutral)) {
            let expected = format!("{neutral}: apply it first (gdal_translate -unscale)");
            return Err(Fault::new(tag_name(METADATA), format!("a {role} of {value:?}"), expected));
        }
    }
    let is_metre =
        |unit: &str| ["", "m", "metre", "metres", "meter", "meters"].contains(&unit.to_lowercase().as_str());
    match item("unittype") {
        Some(unit) if !is_metre(&unit) => {
            Err(Fault::new(tag_name(METADATA), format!("heights in {unit:?}"), "metres"))
        }
        _ => Ok(()),
    }
}

/// Sample that stands for "not known"; `None` if the file names none.
fn nodata(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<Option<f64>, Fault> {
    let Some(text) = tags.text(file, NODATA)? else { return Ok(None) };
    match text.trim().parse() {
        Ok(value) => Ok(Some(value)),
        Err(_) => Err(Fault::new(tag_name(NODATA), format!("{text:?}"), "a number, such as -9999 or nan")),
    }
}

/// The affine map from pixels to metres. It may scale and translate, but not rotate.
fn placement(
    tags: &Tags,
    file: &mut (impl Read + Seek),
    registration: Registration,
) -> Result<Placement, Fault> {
    // (0, 0) is the outer corner of a pixel that is an area, whose post is in the middle.
    let half = match registration {
        Registration::Area | Registration::AreaByDefault => 0.5,
        Registration::Point => 0.0,
    };
    let (place, placement) = match tags.reals(file, TRANSFORMATION)? {
        Some(matrix) => (TRANSFORMATION, by_matrix(&matrix, half)?),
        None => (PIXEL_SCALE, by_tie_point(tags, file, half)?),
    };
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
