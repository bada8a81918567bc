//! Stripe extraction as an exchangeable part of the rover: one's own algorithm in place of [`Extraction`].

use std::fmt::Debug;

use raypencil_scene::{Image, SceneError};

use crate::rig::{Pan, Rig};
use crate::scan::Sweep;
use crate::stripe::{EdgePoint, Extraction};
use crate::triangulation::{SheetPlane, Triangulation};

/// Identity of an exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// Index of the frame.
    pub frame: u64,
    /// Index of the sweep position in a vertical scan; otherwise `None`.
    pub step: Option<u32>,
    /// Index of the lit beam. `None`: all beams.
    pub beam: Option<usize>,
}

/// Image that the camera passes to the stripe extraction.
#[derive(Debug, Clone, PartialEq)]
pub enum CameraImage {
    /// Flux per pixel, watts: the camera has no steps 6 to 8.
    Flux(Image<f64>),
    /// Digital numbers. They may be negative after subtraction of an unlit image.
    Numbers(Image<i32>),
}

/// Edge of a beam's stripe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamEdge {
    /// Index of the beam.
    pub beam: usize,
    /// Edge in the image.
    pub edge: EdgePoint,
}

/// Stripes found in one exposure.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stripes {
    /// Edges, in the order in which their points enter the map. [`Extraction`] gives them beam by beam, each in row-major
    /// order of the image.
    pub edges: Vec<BeamEdge>,
    /// Number of image columns with light that was left out, because more than one beam may have lit it.
    pub columns_left_out: usize,
}

/// Extraction of stripes from the camera's images: the first part of step 9. [`Extraction`] is the rover's own;
/// [`crate::Drive::with_extractor`] takes any other.
///
/// The row of an edge is in pixels from the image's upper border. The plan's [`crate::StripeLocation`] says what it is the
/// row of: with `Centroid`, the middle plane of the light sheet, otherwise its lower edge plane. Each edge is
/// triangulated with the plane of its beam.
///
/// `crates/doors/raypencil/examples/own_stripes.rs` swaps in an extractor of its own.
pub trait StripeExtractor: Debug + Send + Sync {
    /// Stripes in an image. If `exposure.beam` is some beam, only that one was lit.
    ///
    /// # Errors
    /// A reason why there is no answer, which ends the drive.
    fn stripes(&self, exposure: Exposure, image: &CameraImage) -> Result<Stripes, SceneError>;

    /// What it has for images that it was never asked for, as one sentence: a drive warns of it at its end.
    fn left_over(&self) -> Option<String> {
        None
    }
}

/// The rover's own extraction, for a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct RigExtraction {
    extraction: Extraction,
    rig: Rig,
    /// Angles of a scan's positions.
    pans: Vec<Pan>,
}

impl RigExtraction {
    /// The extraction of a plan.
    pub fn new(extraction: Extraction, rig: &Rig, sweep: &Sweep) -> Self {
        Self { extraction, rig: rig.clone(), pans: sweep.pans().collect() }
    }

    /// The planes on which the edges of an exposure lie.
    fn sheets(&self, exposure: Exposure) -> Vec<Triangulation> {
        let pan = exposure.step.and_then(|step| self.pans.get(step as usize));
        let rig = pan.map_or_else(|| self.rig.clone(), |pan| self.rig.panned(*pan));
        let plane = SheetPlane::for_location(self.extraction.place);
        (0..rig.beams.len()).map(|beam| Triangulation::new(&rig, beam, plane)).collect()
    }
}

impl StripeExtractor for RigExtraction {
    fn stripes(&self, exposure: Exposure, image: &CameraImage) -> Result<Stripes, SceneError> {
        let extraction = &self.extraction;
        let (by_beam, columns_left_out) = match (exposure.beam, image) {
            (Some(beam), image) => {
                let edges = match image {
                    CameraImage::Flux(image) => extraction.edges(image),
                    CameraImage::Numbers(image) => extraction.edges(image),
                };
                (vec![(beam, edges)], 0)
            }
            (None, image) => {
                let sheets = self.sheets(exposure);
                let (edges, left_out) = match image {
                    CameraImage::Flux(image) => extraction.edges_by_plane(image, &sheets),
                    CameraImage::Numbers(image) => extraction.edges_by_plane(image, &sheets),
                };
                (edges.into_iter().enumerate().collect(), left_out)
            }
        };
        let of_beam = |(beam, edges): (usize, Vec<EdgePoint>)| {
            edges.into_iter().map(move |edge| BeamEdge { beam, edge })
        };
        Ok(Stripes { edges: by_beam.into_iter().flat_map(of_beam).collect(), columns_left_out })
    }
}
