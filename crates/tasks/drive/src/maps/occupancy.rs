//! Occupancy grid for Nav2's `map_server`: a YAML file and the PGM image beside it. (Nav2 1.x, nav2_map_server; ROS
//! map_server)

use std::path::Path;

use raypencil_files::{FileError, write_atomically};

use crate::maps::yaml::real;

/// Occupancy of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occupancy {
    /// The vehicle may be there.
    Free,
    /// The vehicle may not be there.
    Occupied,
    /// It is unknown whether the vehicle may be there.
    Unknown,
}

impl Occupancy {
    /// Pixel of the image: 254 is 0.4 % occupied and 0 is 100 %. CHOICE: unknown cells have 128, 50 %, and not the
    /// usual 205, because that is 19.6 %, which is below Nav2's default `free_thresh` of 0.25 and so counts as free.
    fn pixel(self) -> u8 {
        match self {
            Self::Free => 254,
            Self::Occupied => 0,
            Self::Unknown => 128,
        }
    }
}

/// Occupancy grid.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyGrid {
    /// Number of cells along x.
    pub columns: u32,
    /// Number of cells along y.
    pub rows: u32,
    /// Side of a cell, metres.
    pub resolution: f64,
    /// Global x and y of the outer corner of the first cell, metres.
    pub origin: [f64; 2],
    /// Cells row by row, the row of smallest y first.
    pub cells: Vec<Occupancy>,
}

/// YAML text that names the file `image` beside it, and the bytes of that image (PGM).
///
/// ```
/// use raypencil_drive::{Occupancy, OccupancyGrid, occupancy_files};
///
/// let cells = vec![Occupancy::Free, Occupancy::Occupied];
/// let grid = OccupancyGrid { columns: 1, rows: 2, resolution: 0.1, origin: [-1.0, 2.5], cells };
/// let (yaml, pgm) = occupancy_files(&grid, "map.pgm");
/// assert!(yaml.starts_with("image: map.pgm\nmode: trinary\nresolution: 0.1\norigin: [-1.0, 2.5, 0.0]\n"));
/// // The image begins with the row of largest y: occupied is 0, free 254.
/// assert_eq!(pgm, b"P5\n1 2\n255\n\x00\xfe");
/// ```
pub fn occupancy_files(grid: &OccupancyGrid, image: &str) -> (String, Vec<u8>) {
    let [x, y] = grid.origin.map(real);
    let yaml = format!(
        "image: {image}\nmode: trinary\nresolution: {}\norigin: [{x}, {y}, 0.0]\nnegate: 0\n\
         occupied_thresh: 0.65\nfree_thresh: 0.25\n",
        real(grid.resolution)
    );
    let mut pgm = format!("P5\n{} {}\n255\n", grid.columns, grid.rows).into_bytes();
    // Images begin with the top row, that of largest y.
    let rows = grid.cells.chunks_exact(grid.columns as usize).rev();
    pgm.extend(rows.flatten().map(|cell| cell.pixel()));
    (yaml, pgm)
}

/// Writes `NAME.pgm` and `NAME.yaml` into a folder. The image comes first, so that the YAML never names a missing
/// image.
///
/// # Errors
/// A file that could not be written, with its path.
pub fn write_occupancy(folder: &Path, name: &str, grid: &OccupancyGrid) -> Result<(), FileError> {
    let image = format!("{name}.pgm");
    let (yaml, pgm) = occupancy_files(grid, &image);
    write_atomically(folder.join(image), |file| file.write_all(&pgm))?;
    write_atomically(folder.join(format!("{name}.yaml")), |file| file.write_all(yaml.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fields_are_those_of_map_server_and_rows_begin_in_the_north() {
        use Occupancy::{Free, Occupied, Unknown};
        let grid = OccupancyGrid {
            columns: 2,
            rows: 2,
            resolution: 0.1,
            origin: [-1.0, 2.5],
            cells: vec![Free, Occupied, Unknown, Free],
        };
        let (yaml, pgm) = occupancy_files(&grid, "obstacles.pgm");
        let expected = [
            "image: obstacles.pgm",
            "mode: trinary",
            "resolution: 0.1",
            "origin: [-1.0, 2.5, 0.0]",
            "negate: 0",
            "occupied_thresh: 0.65",
            "free_thresh: 0.25",
        ];
        assert_eq!(yaml.lines().collect::<Vec<_>>(), expected);
        assert_eq!(pgm, b"P5\n2 2\n255\n\x80\xfe\xfe\x00");
        // map_server computes (255 - pixel) / 255: occupied above 0.65, free below 0.25.
        for (cell, occupied, free) in [(Free, false, true), (Occupied, true, false), (Unknown, false, false)]
        {
            let share = f64::from(255 - cell.pixel()) / 255.0;
            assert_eq!((share > 0.65, share < 0.25), (occupied, free));
        }
    }

    #[test]
    fn very_large_and_very_small_numbers_are_yaml_numbers() {
        let grid = OccupancyGrid {
            columns: 1,
            rows: 1,
            resolution: 1e-7,
            origin: [-1e16, 2.5e-6],
            cells: vec![Occupancy::Free],
        };
        let (yaml, _) = occupancy_files(&grid, "map.pgm");
        assert!(yaml.contains("\nresolution: 1.0e-7\norigin: [-1.0e+16, 2.5e-6, 0.0]\n"), "{yaml}");
    }
}
