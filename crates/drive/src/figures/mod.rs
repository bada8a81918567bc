//! Figures in the spirit of the paper's 11 to 16: the camera's view, the local map, the obstacle map, the navigator map.
//!
//! ```text
//! camera_view   figures 11 and 14
//! relief        figures 12 and 15
//! top           figures 13 and 16: from above, over the elevations in grey
//! axes          what figures share: axes, and the key of elevations
//! ```

pub(crate) mod axes;
pub(crate) mod camera_view;
pub(crate) mod relief;
pub(crate) mod top;

use crate::job::DriveJob;
use crate::run::DriveRun;
use raypencil_report::{Colour, Drawing};
use raypencil_rover::{ElevationMap, GridPoint, Label};

/// A figure, the name of its files and what it shows.
pub(crate) struct Figure {
    pub stem: &'static str,
    pub caption: String,
    pub drawing: Drawing,
}

/// Longest side of a plot, pixels.
pub(crate) const PLOT: f64 = 560.0;

/// Around it: left, above, right, below.
pub(crate) const MARGIN: [f64; 4] = [64.0, 24.0, 160.0, 56.0];

/// All of them. Without an obstacle map there are two.
pub(crate) fn figures(job: &DriveJob, run: &DriveRun) -> Vec<Figure> {
    let mut all = vec![
        Figure {
            stem: "camera-view",
            caption:
                "What the camera sees at the end, stripes in the colours of their beams. (Figures 11 and 14)"
                    .into(),
            drawing: camera_view::camera_view(&run.last_view, job.plan.rig.beams.len()),
        },
        Figure {
            stem: "local-map",
            caption: format!(
                "The local terrain map at the end, {} m between its points, drawn to scale; what is not known is open. \
                 (Figures 12 and 15)",
                job.plan.map.spacing
            ),
            drawing: relief::relief(&run.map),
        },
    ];
    all.extend(top::maps(job, run));
    all
}

/// The colour of a label, in all figures.
pub(crate) fn colour(label: Label) -> Colour {
    match label {
        Label::Obstacle => [200, 40, 30],
        Label::Unknown => [208, 140, 0],
        Label::Visibility => [0, 104, 201],
    }
}

/// The word of a label, in all files.
pub(crate) fn word(label: Label) -> &'static str {
    match label {
        Label::Obstacle => "obstacle",
        Label::Unknown => "unknown",
        Label::Visibility => "visibility",
    }
}

/// The least and the greatest known elevation, and the grid points that hold all that is known.
pub(crate) fn known(map: &ElevationMap) -> Option<([f64; 2], [GridPoint; 2])> {
    let mut found: Option<([f64; 2], [GridPoint; 2])> = None;
    for point in map.points() {
        let Some(z) = map.elevation(point) else { continue };
        let (heights, [low, high]) = found.get_or_insert(([z, z], [point, point]));
        *heights = [heights[0].min(z), heights[1].max(z)];
        *low = GridPoint { i: low.i.min(point.i), j: low.j.min(point.j) };
        *high = GridPoint { i: high.i.max(point.i), j: high.j.max(point.j) };
    }
    found
}

/// From how many grid points one is drawn, so that there are at most so many along either side.
pub(crate) fn stride(low: GridPoint, high: GridPoint, most: i64) -> i64 {
    let longest = (high.i - low.i).max(high.j - low.j).max(0);
    longest / most + 1
}
