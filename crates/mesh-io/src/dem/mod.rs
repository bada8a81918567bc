//! Elevation models: GeoTIFF files of heights on a regular grid. `docs/guide/dem.md` says what is read and how.

pub(crate) mod blocks;
pub(crate) mod georeference;
pub(crate) mod tags;
pub(crate) mod write;

use glam::DVec2;
use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use crate::dem::blocks::Blocks;
use crate::dem::georeference::Placement;
use crate::dem::tags::Tags;
use raypencil_files::{Fault, FileError, Sha256Digest, file_sha256};
use raypencil_scene::{Material, Mesh};
use raypencil_terrain::{Ground, HeightGrid, indices_within, simplify};

/// The most cells between posts that are read: 2^24, which make 2^25 faces, the most that a GLB may have.
const MOST_CELLS: u64 = 1 << 24;

/// Images of a file that are looked at; all but the first are overviews or masks.
const MOST_IMAGES: usize = 64;

/// The bit of NewSubfileType that says that an image is a mask. (TIFF 6.0, page 36)
const IS_MASK: u64 = 4;

/// Map coordinates, and sides of a window, metres.
pub const MAP_M: RangeInclusive<f64> = -1e9..=1e9;

pub const WINDOW_M: RangeInclusive<f64> = 1e-3..=1e9;

/// Bounds of simplification, metres.
pub const MAX_ERROR_M: RangeInclusive<f64> = 1e-6..=1e6;

/// What a pixel of an elevation model is. Posts are at the middles of pixels, whichever it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Registration {
    /// An area: the tie point is at a pixel's outer corner, so that posts are half a pixel further in.
    Area,
    /// The same, because the file does not say.
    AreaByDefault,
    /// A point: the tie point is at a post.
    Point,
}

impl Registration {
    /// Whether the file says it.
    pub fn is_stated(self) -> bool {
        self != Self::AreaByDefault
    }

    /// `area` or `point`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Area | Self::AreaByDefault => "area",
            Self::Point => "point",
        }
    }
}

/// An elevation model, or the part of one inside a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Dem {
    /// The file.
    pub file: PathBuf,
    /// Heights in the global frame: x to the east, y to the north, metres of the map.
    pub posts: HeightGrid,
    /// What a pixel is.
    pub registration: Registration,
    /// The sample that stands for "not known" beside NaN, if the file names one.
    pub nodata: Option<f64>,
    /// How many of the posts are not known.
    pub unknown: usize,
}

/// Reads the heights of a GeoTIFF: all, or those inside the `window` of x and y of its lower left corner, width
/// and height, metres of the map. Posts on its border belong to it. Only strips and tiles that it touches are read.
///
/// # Errors
/// Names the file and the tag, strip, tile or pixel that is wrong, what was found there and what was expected.
pub fn read_dem(path: impl AsRef<Path>, window: Option<[f64; 4]>) -> Result<Dem, FileError> {
    let path = path.as_ref();
    let unreadable = |error| FileError::io(path, "read", error);
    // Asked before the file is opened: opening a pipe waits for its writer.
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(unreadable(std::io::Error::new(std::io::ErrorKind::InvalidInput, "not a regular file")));
    }
    let file = BufReader::new(File::open(path).map_err(unreadable)?);
    read(path, file, metadata.len(), window).map_err(|fault| FileError::Dem(fault.in_file(path)))
}

/// The same from the bytes of a file; `file` is for messages.
///
/// # Errors
/// As [`read_dem`].
pub fn dem_from_bytes(bytes: &[u8], file: &Path, window: Option<[f64; 4]>) -> Result<Dem, FileError> {
    let length = bytes.len() as u64;
    read(file, Cursor::new(bytes), length, window).map_err(|fault| FileError::Dem(fault.in_file(file)))
}

/// The mesh of a part of an elevation model, and the digest of its whole file.
pub fn load(
    path: &Path,
    window: Option<[f64; 4]>,
    max_error: Option<f64>,
    reflectivity: f64,
) -> Result<(Mesh, Sha256Digest), FileError> {
    let mesh = read_dem(path, window)?.mesh(max_error, reflectivity)?;
    let (_, sha) = file_sha256(path).map_err(|error| FileError::io(path, "read", error))?;
    Ok((mesh, sha))
}

/// All posts of an elevation model, and the digest of its file.
pub fn posts(path: &Path) -> Result<(HeightGrid, Sha256Digest), FileError> {
    let posts = read_dem(path, None)?.posts;
    let (_, sha) = file_sha256(path).map_err(|error| FileError::io(path, "read", error))?;
    Ok((posts, sha))
}

fn read(
    path: &Path,
    mut file: impl Read + Seek,
    length: u64,
    window: Option<[f64; 4]>,
) -> Result<Dem, Fault> {
    let tags = Tags::first(&mut file, length)?;
    let blocks = Blocks::of(&tags, &mut file)?;
    let georeference::Georeference { placement, registration, nodata } =
        georeference::read(&tags, &mut file)?;
    refuse_masks(&tags, &mut file)?;

    let lattice = Lattice::new(placement, [blocks.width, blocks.height]);
    let [columns, rows] = lattice.within(window)?;
    let count = [&columns, &rows].map(|range| u64::from(range.end() - range.start()) + 1);
    if count.contains(&1) {
        let found = format!("{} x {} posts", count[0], count[1]);
        return Err(Fault::new(lattice.part(window), found, "at least 2 x 2, for a cell between them"));
    }
    if (count[0] - 1) * (count[1] - 1) > MOST_CELLS {
        let found = format!("{} x {} posts", count[0], count[1]);
        let expected = format!("at most {MOST_CELLS} cells between posts: choose a part by a window");
        return Err(Fault::new(lattice.part(window), found, expected));
    }

    // Posts count rows from the south, most files from the north.
    let is_southward = placement.row < 0.0;
    let (first, last) = (*rows.start(), *rows.end());
    let in_file = match is_southward {
        true => blocks.height - 1 - last..=blocks.height - 1 - first,
        false => first..=last,
    };
    let mut heights = blocks.read(&tags, file, length, [columns.clone(), in_file], nodata)?;
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
        // Adding zero makes the minus of -0 go.
        corner: lattice.corner + lattice.spacing * start + DVec2::ZERO,
        spacing: lattice.spacing,
        heights,
    };
    Ok(Dem { file: path.to_path_buf(), posts, registration, nodata, unknown })
}

/// Refuses a file whose unknown posts are told by a second image: their samples would look like heights.
fn refuse_masks(tags: &Tags, file: &mut (impl Read + Seek)) -> Result<(), Fault> {
    let mut next = tags.next;
    for image in 1..MOST_IMAGES {
        if next == 0 {
            break;
        }
        let other = tags.directory(file, next)?;
        if other.integer(file, 254)?.unwrap_or(0) & IS_MASK != 0 {
            let expected = "no mask, but a sample for what is not known (gdalwarp -dstnodata)";
            return Err(Fault::new(format!("image {image}"), "a mask", expected));
        }
        next = other.next;
    }
    Ok(())
}

/// Where all posts of a file are, rows counted from the south.
struct Lattice {
    corner: DVec2,
    spacing: DVec2,
    size: [u32; 2],
}

impl Lattice {
    fn new(placement: Placement, size: [u32; 2]) -> Self {
        let Placement { first: [x, y], column, row } = placement;
        let south = if row < 0.0 { y + row * f64::from(size[1] - 1) } else { y };
        Self { corner: DVec2::new(x, south), spacing: DVec2::new(column, row.abs()), size }
    }

    /// The columns and rows of the posts inside a window.
    fn within(&self, window: Option<[f64; 4]>) -> Result<[RangeInclusive<u32>; 2], Fault> {
        let Some([x, y, width, height]) = window else {
            return Ok(self.size.map(|count| 0..=count - 1));
        };
        let found = || format!("x {x} to {}, y {y} to {} m", x + width, y + height);
        if !([x, y, width, height].iter().all(|value| value.is_finite()) && width > 0.0 && height > 0.0) {
            return Err(Fault::new(
                "window",
                found(),
                "x and y of its lower left corner, a width and a height",
            ));
        }
        let columns = indices_within(self.corner.x, self.spacing.x, self.size[0], x, x + width);
        let rows = indices_within(self.corner.y, self.spacing.y, self.size[1], y, y + height);
        match (columns, rows) {
            (Some(columns), Some(rows)) => Ok([columns, rows]),
            _ => {
                let steps = DVec2::new(f64::from(self.size[0] - 1), f64::from(self.size[1] - 1));
                let (low, high) = (self.corner, self.corner + self.spacing * steps);
                let posts = format!("posts of x {} to {}, y {} to {} m", low.x, high.x, low.y, high.y);
                Err(Fault::new("window", format!("no post in {}", found()), posts))
            }
        }
    }

    /// What there is too little or too much of, for messages.
    fn part(&self, window: Option<[f64; 4]>) -> String {
        match window {
            Some(_) => "window".to_string(),
            None => format!("{} and {}", tags::name(256), tags::name(257)),
        }
    }
}

impl Dem {
    /// The ground through all posts, or with a bound in metres one with fewer faces that is nowhere farther from a
    /// post along z. Its one material is called `ground`.
    ///
    /// # Panics
    /// If the bound is not above zero.
    pub fn ground(&self, max_error: Option<f64>, reflectivity: f64) -> Ground {
        let material = Material { name: "ground".to_string(), reflectivity };
        match max_error {
            Some(max_error) => simplify(&self.posts, max_error, material),
            None => self.posts.ground(material),
        }
    }

    /// The mesh of [`Dem::ground`].
    ///
    /// # Errors
    /// A bound outside 1e-6 to 1e6 m; no cell with four known posts; posts so near to each other, or so far from
    /// the scene origin, that single precision cannot hold them apart; a reflectivity outside 0 to 1.
    pub fn mesh(&self, max_error: Option<f64>, reflectivity: f64) -> Result<Mesh, FileError> {
        let unfit = |place: &str, found: String, expected: String| {
            FileError::Dem(Fault::new(place, found, expected).in_file(&self.file))
        };
        if let Some(value) = max_error.filter(|value| !MAX_ERROR_M.contains(value)) {
            return Err(unfit("largest error", format!("{value} m"), "1e-6 to 1e6 m".to_string()));
        }
        let ground = self.ground(max_error, reflectivity);
        if ground.faces.is_empty() {
            let found = format!("{} of {} posts not known", self.unknown, self.posts.heights.len());
            return Err(unfit("samples", found, "a cell with four known posts".to_string()));
        }
        let origin = self.file.display().to_string();
        let mesh = ground.into_mesh().map_err(|source| FileError::Scene { origin, source })?;
        // An f32 of this size is good to 2^-23 of it, so that four steps keep columns and rows apart.
        let reach =
            mesh.bounds().map_or(0.0, |[low, high]| low.abs().max(high.abs()).truncate().max_element());
        let needed = 4.0 * reach / 8_388_608.0;
        let spacing = self.posts.spacing.min_element();
        if spacing < needed {
            let found = format!("posts {spacing} m apart, up to {reach} m from the scene origin");
            let expected = format!("at least {needed} m apart: vertices are offsets in single precision");
            return Err(unfit("spacing", found, expected));
        }
        Ok(mesh)
    }
}
