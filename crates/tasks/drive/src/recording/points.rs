//! Edges of the stripes and their points, row by row.

use std::fmt::Write as _;
use std::path::Path;

use raypencil_files::{FileError, GrowingFile, NpyRows};
use raypencil_rover::{DriveFrame, EdgePoint};

/// First line of `points.csv`.
const HEADER: &str =
    "frame,step,beam,column,row_px,x_m,y_m,z_m,global_x_m,global_y_m,global_z_m,standard_error_m\n";

/// The three files, as they grow.
#[derive(Debug)]
pub(super) struct PointFiles {
    stripes: NpyRows,
    points: NpyRows,
    text: GrowingFile,
}

impl PointFiles {
    pub(super) fn create(folder: &Path) -> Result<Self, FileError> {
        let mut text = GrowingFile::create(folder.join("points.csv"))?;
        text.add(HEADER)?;
        Ok(Self {
            stripes: NpyRows::create(folder.join("stripes.npy"), 5)?,
            points: NpyRows::create(folder.join("points.npy"), 11)?,
            text,
        })
    }

    pub(super) fn add(&mut self, frame: &DriveFrame) -> Result<(), FileError> {
        let key = |step: Option<u32>, beam: usize, edge: &EdgePoint| {
            [frame.index as f64, step.map_or(-1.0, f64::from), beam as f64, f64::from(edge.i), edge.row]
        };
        for found in &frame.edges {
            self.stripes.push(&key(found.step, found.beam, &found.edge))?;
        }
        let mut lines = String::new();
        for measured in &frame.measured {
            let [index, step, beam, column, row] = key(measured.step, measured.beam, &measured.edge);
            let [x, y, z] = measured.point.to_array();
            let [gx, gy, gz] = (frame.believed * measured.point).to_array();
            self.points.push(&[index, step, beam, column, row, x, y, z, gx, gy, gz])?;
            let error = measured.standard_error;
            // Writing into a text cannot fail.
            let _ =
                writeln!(lines, "{index},{step},{beam},{column},{row},{x},{y},{z},{gx},{gy},{gz},{error}");
        }
        self.text.add(lines)
    }

    pub(super) fn finish(self) -> Result<(), FileError> {
        let Self { stripes, points, text } = self;
        stripes.finish()?;
        points.finish()?;
        text.finish().map(drop)
    }
}
