//! Stripes from a file in place of the rover's own extraction: other people's edges, found in recorded images.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use raypencil_files::{Fault, FileError, Limits, read_npy_numbers};
use raypencil_report::counted;
use raypencil_rover::{BeamEdge, CameraImage, EdgePoint, Exposure, StripeExtractor, Stripes};
use raypencil_scene::SceneError;

/// Numbers of a row: frame, step, beam, column, row.
const COLUMNS: usize = 5;

/// Largest file, bytes: 40 bytes an edge, of fifty million edges.
const MAX_BYTES: u64 = 2_000_000_000;

/// Edges of a whole drive, by frame and step of a scan.
#[derive(Debug)]
pub struct StripeFile {
    path: PathBuf,
    edges: BTreeMap<Taken, Vec<BeamEdge>>,
    /// The images that were asked for, each with its beam.
    asked: Mutex<BTreeSet<(Taken, usize)>>,
}

/// When an image was taken: its frame, and the step of a scan.
type Taken = (u64, Option<u32>);

impl StripeFile {
    /// Reads `stripes.npy` of a folder (docs/formats/recording.md). The frames need not be in order, but the edges of an
    /// exposure enter the map in the order of the file.
    /// `beams` is how many the rover has: an edge of a beam that it does not have is refused.
    ///
    /// # Errors
    /// A file that cannot be read, with the row that is wrong and what was expected.
    pub fn read(folder: &Path, beams: usize) -> Result<Self, FileError> {
        let path = folder.join("stripes.npy");
        let fault = |place: String, found: String, expected: &str| {
            FileError::Array(Fault::new(place, found, expected).in_file(&path))
        };
        let limits = Limits { bytes: MAX_BYTES, ..Limits::default() };
        let numbers = read_npy_numbers(&path, &limits)?;
        if numbers.shape.len() != 2 || numbers.shape[1] != COLUMNS as u64 {
            let expected = "(n, 5): frame, step, beam, column, row";
            return Err(fault("shape".into(), format!("{:?}", numbers.shape), expected));
        }
        let mut edges: BTreeMap<_, Vec<BeamEdge>> = BTreeMap::new();
        for (index, row) in numbers.values.chunks_exact(COLUMNS).enumerate() {
            let whole = |column: usize, name: &str, least: f64| {
                let value = row[column];
                let is_whole = value.fract() == 0.0 && (least..=f64::from(u32::MAX)).contains(&value);
                let place = || format!("row {index}, {name}");
                let expected = if least < 0.0 {
                    "a whole number from 0, or -1: no scan"
                } else {
                    "a whole number from 0"
                };
                if is_whole { Ok(value) } else { Err(fault(place(), value.to_string(), expected)) }
            };
            let (frame, step) = (whole(0, "frame", 0.0)? as u64, whole(1, "step", -1.0)?);
            let (beam, column) = (whole(2, "beam", 0.0)? as usize, whole(3, "column", 0.0)? as u32);
            if beam >= beams {
                let expected = format!("0 to {}: beams are counted from 0", beams.saturating_sub(1));
                return Err(fault(format!("row {index}, beam"), beam.to_string(), &expected));
            }
            let at = row[4];
            if !(0.0..=f64::from(u32::MAX)).contains(&at) {
                let expected = "pixels from the image's upper border";
                return Err(fault(format!("row {index}, row"), at.to_string(), expected));
            }
            let step = (step >= 0.0).then_some(step as u32);
            // The pixel that holds the row; its middle is half a pixel below its upper border.
            let edge = EdgePoint { i: column, j: at.floor() as u32, row: at };
            edges.entry((frame, step)).or_default().push(BeamEdge { beam, edge });
        }
        for (&(frame, step), of) in &edges {
            if let Some(BeamEdge { beam, edge }) = given_twice(of) {
                let step = step.map_or_else(String::new, |step| format!(", step {step}"));
                let place = format!("frame {frame}{step}, beam {beam}, column {}, row {}", edge.i, edge.row);
                return Err(fault(place, "given twice".into(), "each edge once"));
            }
        }
        Ok(Self { path, edges, asked: Mutex::default() })
    }
}

/// An edge of an exposure that is there twice.
fn given_twice(edges: &[BeamEdge]) -> Option<BeamEdge> {
    let mut sorted = edges.to_vec();
    sorted
        .sort_by(|a, b| (a.beam, a.edge.i).cmp(&(b.beam, b.edge.i)).then(a.edge.row.total_cmp(&b.edge.row)));
    sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}

impl StripeExtractor for StripeFile {
    fn stripes(&self, exposure: Exposure, image: &CameraImage) -> Result<Stripes, SceneError> {
        let (width, height) = match image {
            CameraImage::Flux(image) => (image.width(), image.height()),
            CameraImage::Numbers(image) => (image.width(), image.height()),
        };
        let taken = (exposure.frame, exposure.step);
        let found = self.edges.get(&taken).map_or(&[][..], Vec::as_slice);
        let mut asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        let mut edges = Vec::new();
        for of in found {
            if exposure.beam.is_some_and(|beam| beam != of.beam) {
                continue;
            }
            asked.insert((taken, of.beam));
            let EdgePoint { i, row, .. } = of.edge;
            if i >= width || row > f64::from(height) {
                let field = format!("{}: edge in frame {}", self.path.display(), exposure.frame);
                let expected = format!("a place in the image of {width} x {height} pixels");
                return Err(SceneError::new(field, format!("column {i}, row {row}"), expected));
            }
            // On the lower border of the image: it belongs to the last row of pixels.
            let edge = EdgePoint { j: of.edge.j.min(height.saturating_sub(1)), ..of.edge };
            edges.push(BeamEdge { edge, ..*of });
        }
        Ok(Stripes { edges, columns_left_out: 0 })
    }

    fn left_over(&self) -> Option<String> {
        let asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        let all = self.edges.iter().flat_map(|(taken, edges)| edges.iter().map(move |of| (*taken, of.beam)));
        let mut left = all.filter(|of| !asked.contains(of));
        let ((frame, step), beam) = left.next()?;
        let count = 1 + left.count();
        let step = step.map_or_else(String::new, |step| format!(", step {step} of a scan"));
        Some(format!(
            "{} of {} {} of no image of this drive; the first is of frame {frame}{step}, beam {beam}.",
            counted(count as u64, "edge", "edges"),
            self.path.display(),
            if count == 1 { "is" } else { "are" },
        ))
    }
}

#[cfg(test)]
mod tests {
    use raypencil_files::write_npy_numbers;
    use raypencil_scene::Image;

    use super::*;

    fn written(numbers: &[f64]) -> (tempfile::TempDir, Result<StripeFile, FileError>) {
        let folder = tempfile::tempdir().unwrap();
        let shape = [numbers.len() as u64 / 5, 5];
        write_npy_numbers(folder.path().join("stripes.npy"), &shape, numbers).unwrap();
        let read = StripeFile::read(folder.path(), 2);
        (folder, read)
    }

    #[test]
    fn each_exposure_gets_its_own_edges() {
        let rows = [
            [3.0, -1.0, 0.0, 2.0, 4.5],
            [3.0, -1.0, 1.0, 2.0, 1.25],
            [3.0, 7.0, 0.0, 1.0, 0.5],
            [2.0, -1.0, 0.0, 5.0, 3.0],
            [5.0, -1.0, 0.0, 0.0, 5.0],
        ];
        let (_folder, file) = written(&rows.concat());
        let file = file.unwrap();
        let image = CameraImage::Numbers(Image::filled(6, 5, 0));
        let at = |frame, step, beam| file.stripes(Exposure { frame, step, beam }, &image).map(|s| s.edges);
        let edge = |beam, i, j, row| BeamEdge { beam, edge: EdgePoint { i, j, row } };
        assert_eq!(at(3, None, Some(0)).unwrap(), [edge(0, 2, 4, 4.5)]);
        assert_eq!(at(3, None, None).unwrap(), [edge(0, 2, 4, 4.5), edge(1, 2, 1, 1.25)]);
        assert_eq!(at(3, Some(7), Some(0)).unwrap(), [edge(0, 1, 0, 0.5)]);
        // On the lower border of the image of 5 rows: in the last of them, and not in one that is not there.
        assert_eq!(at(5, None, None).unwrap(), [edge(0, 0, 4, 5.0)]);
        assert!(at(4, None, None).unwrap().is_empty());
        // Of frame 2 nothing was asked.
        let left = file.left_over().unwrap();
        assert!(
            left.starts_with("1 edge of ")
                && left.ends_with("is of no image of this drive; the first is of frame 2, beam 0."),
            "{left}"
        );
        // The image has columns 0 to 5: a narrower one refuses the edge of frame 2.
        assert!(at(2, None, None).is_ok());
        assert_eq!(file.left_over(), None);
        let narrow = CameraImage::Numbers(Image::filled(5, 5, 0));
        let refused = file.stripes(Exposure { frame: 2, step: None, beam: None }, &narrow).unwrap_err();
        assert!(refused.to_string().contains("frame 2 is column 5, row 3"), "{refused}");
    }

    #[test]
    fn wrong_files_are_refused_with_their_place() {
        for (row, words) in [
            ([0.5, -1.0, 0.0, 0.0, 0.0], "row 0, frame"),
            ([0.0, -2.0, 0.0, 0.0, 0.0], "row 0, step"),
            ([0.0, -1.0, f64::NAN, 0.0, 0.0], "row 0, beam"),
            ([0.0, -1.0, 2.0, 0.0, 0.0], "row 0, beam: 2; expected 0 to 1"),
            ([0.0, -1.0, 0.0, -1.0, 0.0], "row 0, column"),
            ([0.0, -1.0, 0.0, 0.0, f64::INFINITY], "row 0, row"),
        ] {
            let (_folder, file) = written(&row);
            let error = file.unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        // One edge twice, apart; another row of its column is another edge.
        let edge = [3.0, 7.0, 1.0, 2.0, 4.5];
        let (_folder, file) = written(&[edge, [3.0, 7.0, 1.0, 2.0, 5.5], edge].concat());
        let error = file.unwrap_err().to_string();
        let words = "frame 3, step 7, beam 1, column 2, row 4.5: given twice; expected each edge once";
        assert!(error.contains(words), "{error}");
        let folder = tempfile::tempdir().unwrap();
        write_npy_numbers(folder.path().join("stripes.npy"), &[4], &[0.0; 4]).unwrap();
        let error = StripeFile::read(folder.path(), 2).unwrap_err().to_string();
        assert!(error.contains("(n, 5)"), "{error}");
    }
}
