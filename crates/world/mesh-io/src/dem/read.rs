//! GeoTIFF to an elevation model: all posts, or those inside a window.

use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek};
use std::ops::RangeInclusive;
use std::path::Path;

use glam::DVec2;
use raypencil_files::{Fault, FileError, Sha256Digest, file_sha256};
use raypencil_terrain::HeightGrid;

use crate::dem::blocks::Blocks;
use crate::dem::coordinate_system::GivenUnits;
use crate::dem::facts::DemFacts;
use crate::dem::georeference::{self, Georeference};
use crate::dem::heights::{Raw, heights};
use crate::dem::lattice::Lattice;
use crate::dem::model::Dem;
use crate::dem::nodata::NoData;
use crate::dem::tags::Tags;
use crate::dem::unit::{HeightUnit, LengthUnit};

/// Maximum number of cells between posts. 2^24 cells make 2^25 faces, the limit of a GLB.
const MAX_CELLS: u64 = 1 << 24;

/// Maximum number of images of a file that are examined. All but the first are overviews or masks.
const MAX_IMAGES: usize = 64;

/// Bit of NewSubfileType that marks an image as a smaller one of another. (TIFF 6.0, page 36)
const REDUCED_FLAG: u64 = 1;

/// Bit of NewSubfileType that marks an image as a mask. (TIFF 6.0, page 36)
const MASK_FLAG: u64 = 4;

/// Allowed range of map coordinates, metres.
pub const MAP_RANGE_M: RangeInclusive<f64> = -1e9..=1e9;

/// Allowed range of the sides of a window, metres.
pub const WINDOW_SIDE_RANGE_M: RangeInclusive<f64> = 1e-3..=1e9;

/// What to read of a GeoTIFF, and what it does not say itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DemOptions {
    /// x and y of the lower left corner, width and height, metres of the map; `None`: all posts.
    pub window: Option<[f64; 4]>,
    /// Samples that stand for unknown heights.
    pub nodata: NoData,
    /// Unit of the map, over what the file says.
    pub unit: Option<LengthUnit>,
    /// Unit of the heights, over what the file says.
    pub z_unit: Option<HeightUnit>,
}

impl From<Option<[f64; 4]>> for DemOptions {
    fn from(window: Option<[f64; 4]>) -> Self {
        Self { window, ..Self::default() }
    }
}

/// Reads the heights of a GeoTIFF: all of them, or those inside a window.
///
/// Coordinates and heights become metres by the units that the file states, each by its own. A file whose unit is not known is
/// refused, and so is one of whose heights a constant lies so far from all others that it can hardly be one.
/// [`DemOptions`] say what a file does not.
///
/// `window` is x and y of its lower left corner, its width and its height, metres of the map. Posts on its border
/// belong to it. Only the strips and tiles that it touches are read.
///
/// Limits: 2^24 cells between the posts, 2^22 strips or tiles of at most 512 MiB each. Strips or tiles that share bytes are
/// refused before any is decoded, so that the work is bounded by the length of the file.
///
/// # Errors
/// Names the file and the tag, strip, tile or pixel that is wrong, what was found there and what was expected.
///
/// ```
/// use glam::DVec2;
/// use raypencil_mesh_io::{read_dem, write_geotiff};
/// use raypencil_terrain::HeightGrid;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("dem.tif");
/// let (corner, spacing) = (DVec2::new(10.0, 20.0), DVec2::splat(0.5));
/// let heights = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
/// write_geotiff(&path, &HeightGrid { columns: 3, rows: 2, corner, spacing, heights }, None)?;
///
/// // Columns are at x = 10, 10.5 and 11: the window from 10.2 has the last two.
/// let dem = read_dem(&path, Some([10.2, 20.0, 1.0, 0.5]))?;
/// assert_eq!((dem.posts.columns, dem.posts.rows), (2, 2));
/// assert_eq!(dem.posts.heights, [2.0, 3.0, 5.0, 6.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_dem(path: impl AsRef<Path>, window: Option<[f64; 4]>) -> Result<Dem, FileError> {
    read_dem_with(path, &window.into())
}

/// Reads the heights of a GeoTIFF as [`read_dem`] does, with what it does not say itself.
///
/// # Errors
/// As [`read_dem`].
pub fn read_dem_with(path: impl AsRef<Path>, options: &DemOptions) -> Result<Dem, FileError> {
    let path = path.as_ref();
    let unreadable = |error| FileError::io(path, "read", error);
    // Asked before the file is opened: opening a pipe waits for its writer.
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(unreadable(std::io::Error::new(std::io::ErrorKind::InvalidInput, "not a regular file")));
    }
    let file = BufReader::new(File::open(path).map_err(unreadable)?);
    read(path, file, metadata.len(), options).map_err(|fault| FileError::Dem(fault.in_file(path)))
}

/// Reads the bytes of a GeoTIFF as [`read_dem`] does; `file` is its name in messages.
///
/// # Errors
/// As [`read_dem`].
pub fn dem_from_bytes(bytes: &[u8], file: &Path, window: Option<[f64; 4]>) -> Result<Dem, FileError> {
    let length = bytes.len() as u64;
    read(file, Cursor::new(bytes), length, &window.into())
        .map_err(|fault| FileError::Dem(fault.in_file(file)))
}

/// All posts of an elevation model, what its file says, and the digest of the file.
///
/// # Errors
/// As [`read_dem`].
pub fn read_posts(path: &Path) -> Result<(HeightGrid, DemFacts, Sha256Digest), FileError> {
    let dem = read_dem(path, None)?;
    let (_, sha) = file_sha256(path).map_err(|error| FileError::io(path, "read", error))?;
    let facts = dem.facts();
    Ok((dem.posts, facts, sha))
}

fn read(path: &Path, mut file: impl Read + Seek, length: u64, options: &DemOptions) -> Result<Dem, Fault> {
    let window = options.window;
    let tags = Tags::first(&mut file, length)?;
    let blocks = Blocks::of(&tags, &mut file)?;
    let given = GivenUnits { map: options.unit, heights: options.z_unit };
    let Georeference { placement, registration, systems: [map, vertical], nodata } =
        georeference::read(&tags, &mut file, given)?;
    refuse_other_images(&tags, &mut file)?;

    let lattice = Lattice::new(placement, [blocks.width, blocks.height]);
    let [columns, rows] = lattice.within(window)?;
    let count = [&columns, &rows].map(|range| u64::from(range.end() - range.start()) + 1);
    if count.contains(&1) {
        let found = format!("{} x {} posts", count[0], count[1]);
        return Err(Fault::new(lattice.place(window), found, "at least 2 x 2, for a cell between them"));
    }
    if (count[0] - 1) * (count[1] - 1) > MAX_CELLS {
        let found = format!("{} x {} posts", count[0], count[1]);
        let expected = format!("at most {MAX_CELLS} cells between posts: choose a part by a window");
        return Err(Fault::new(lattice.place(window), found, expected));
    }

    // Rows of posts are counted from the south, rows of most files from the north.
    let is_southward = placement.row < 0.0;
    let (first, last) = (*rows.start(), *rows.end());
    let in_file = match is_southward {
        true => blocks.height - 1 - last..=blocks.height - 1 - first,
        false => first..=last,
    };
    let unknown: Vec<f64> = nodata.iter().chain(&options.nodata.values).copied().collect();
    let samples = blocks.read(&tags, file, length, [columns.clone(), in_file.clone()], &unknown)?;
    let raw = Raw {
        samples,
        columns: count[0] as usize,
        first: [*columns.start(), *in_file.start()],
        spacing: lattice.spacing,
    };
    let mut heights = heights(raw, vertical.unit, &options.nodata, &|sample| blocks.decimal(sample))?;
    if is_southward {
        let width = count[0] as usize;
        let mut left = heights.as_mut_slice();
        while left.len() >= 2 * width {
            let (upper, rest) = left.split_at_mut(width);
            let (rest, lower) = rest.split_at_mut(rest.len() - width);
            upper.swap_with_slice(lower);
            left = rest;
        }
    }
    let unknown = heights.iter().filter(|height| height.is_nan()).count();
    let start = DVec2::new(f64::from(*columns.start()), f64::from(first));
    let posts = HeightGrid {
        // Both are at most 2^24.
        columns: count[0] as u32,
        rows: count[1] as u32,
        // Adding zero turns -0 into +0.
        corner: lattice.corner + lattice.spacing * start + DVec2::ZERO,
        spacing: lattice.spacing,
        heights,
    };
    let given_nodata = options.nodata.values.clone();
    let file = path.to_path_buf();
    Ok(Dem { file, posts, registration, map, heights: vertical, nodata, given_nodata, unknown })
}

/// Refuses a file with a mask, a second image that marks unknown posts: their samples would be taken for heights. And one whose first image
/// of several is a reduced one: the model stands behind it.
fn refuse_other_images(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<(), Fault> {
    let mut next = tags.next;
    if next != 0 && tags.integer(file, 254)?.unwrap_or(0) & REDUCED_FLAG != 0 {
        let expected = "the model itself, and smaller images of it behind it";
        return Err(Fault::new("image 0", "a smaller image of another one (NewSubfileType 1)", expected));
    }
    for image in 1..MAX_IMAGES {
        if next == 0 {
            break;
        }
        let other = tags.directory(file, next)?;
        if other.integer(file, 254)?.unwrap_or(0) & MASK_FLAG != 0 {
            let expected = "no mask, but a sample for what is not known (gdalwarp -dstnodata)";
            return Err(Fault::new(format!("image {image}"), "a mask", expected));
        }
        next = other.next;
    }
    Ok(())
}
