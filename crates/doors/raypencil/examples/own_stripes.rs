//! One's own stripe extraction in the rover, in place of the paper's thresholding: the centroid of the brightest peak of each
//! column. The same drive by both, and how far off the true ground their points are.
//!
//!     cargo run --release -p raypencil --features examples --example own_stripes [pyramids|facets|SCENE.toml]

use std::error::Error;
use std::sync::Arc;

use raypencil::drive::{DriveExtras, DriveJob, drive_with};
use raypencil::io::{Overrides, load};
use raypencil::rover::{
    BeamEdge, CameraImage, EdgePoint, Exposure, SheetPlane, StripeExtractor, StripeLocation, Stripes,
};
use raypencil::{Image, Scanline, SceneError, Silent};

/// Rows on either side of the brightest pixel that count as its peak.
const HALF_WINDOW: usize = 3;

/// The brightest pixel of each column, refined by the centroid of the light around it. It finds one stripe a column, and is not
/// misled by a threshold that is too low for a bright image.
#[derive(Debug)]
struct BrightestPeak {
    /// Smallest digital number that counts as laser light.
    least: f64,
}

impl BrightestPeak {
    /// Peak of one column: the row of the brightest pixel and that of the centroid.
    fn peak(&self, column: &[f64]) -> Option<(usize, f64)> {
        let brightest = (0..column.len()).rev().max_by(|&a, &b| column[a].total_cmp(&column[b]))?;
        if column[brightest] < self.least {
            return None;
        }
        let window = brightest.saturating_sub(HALF_WINDOW)..(brightest + HALF_WINDOW + 1).min(column.len());
        let (mut light, mut moment) = (0.0, 0.0);
        for row in window {
            let value = column[row].max(0.0);
            light += value;
            // The middle of a pixel is half a pixel below its upper border.
            moment += value * (row as f64 + 0.5);
        }
        Some((brightest, moment / light))
    }
}

impl StripeExtractor for BrightestPeak {
    fn stripes(&self, exposure: Exposure, image: &CameraImage) -> Result<Stripes, SceneError> {
        // One peak a column cannot tell beams apart: this extractor needs them lit in turn.
        let Some(beam) = exposure.beam else {
            return Err(SceneError::new(
                "exposures",
                "together",
                "in turn, for the brightest peak of a column",
            ));
        };
        let values: Image<f64> = match image {
            CameraImage::Flux(image) => image.clone(),
            CameraImage::Numbers(image) => {
                let cells = image.cells().iter().map(|&number| f64::from(number)).collect();
                Image::from_cells(image.width(), image.height(), cells)
            }
        };
        let column = |i: u32| (0..values.height()).map(|j| values.at(i, j)).collect::<Vec<f64>>();
        let edges = (0..values.width()).filter_map(|i| {
            let (brightest, row) = self.peak(&column(i))?;
            Some(BeamEdge { beam, edge: EdgePoint { i, j: brightest as u32, row } })
        });
        Ok(Stripes { edges: edges.collect(), columns_left_out: 0 })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "pyramids".into());
    let mut job = DriveJob::new(&load(&name, &Overrides::default())?, None, name.clone())?;
    // A centroid lies on the middle plane of the light sheet: the rover must triangulate with that plane.
    job.plan.extraction.place = StripeLocation::Centroid;
    assert_eq!(SheetPlane::for_location(job.plan.extraction.place), SheetPlane::Middle);
    let renderer = Scanline::default();
    let own: Arc<dyn StripeExtractor> = Arc::new(BrightestPeak { least: 400.0 });
    for (label, extractor) in [("thresholding", None), ("brightest peak", Some(own))] {
        let extras = DriveExtras { extractor, ..DriveExtras::default() };
        let run = drive_with(&job, &[&renderer], extras, &Silent)?;
        let (errors, truth) = (&run.point_errors, &run.truth);
        println!(
            "{label:15} {:7} points, {:5.1} mm rms off the ground, {:5.1} % less than 1 cm; obstacles missed {:.1} %, false {:.1} %",
            errors.points,
            1e3 * errors.rms(),
            100.0 * errors.share_within_1cm(),
            100.0 * truth.missed_share(),
            100.0 * truth.false_share()
        );
    }
    Ok(())
}
