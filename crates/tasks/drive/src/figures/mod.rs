//! Figures after the paper's figures 11 to 16: the camera's view, the local map, the obstacle map, the navigator map.
//!
//! ```text
//! figure        a figure with its caption; the layout that figures share
//! known_extent  the known cells of a map
//! elevation_key the key of elevations
//! camera_figure figures 11 and 14
//! relief        figures 12 and 15
//! top           figures 13 and 16: from above, over the elevations in grey
//! ```

mod camera_figure;
mod elevation_key;
mod figure;
mod known_extent;
mod relief;
mod top;

use crate::figures::camera_figure::camera_figure;
use crate::figures::relief::relief;
use crate::figures::top::map_figures;
use crate::job::DriveJob;
use crate::run::DriveRun;

pub(crate) use figure::Figure;

/// All figures of a drive: four, or two if the drive made no obstacle map.
pub(crate) fn figures(job: &DriveJob, run: &DriveRun) -> Vec<Figure> {
    let mut all = vec![
        Figure {
            stem: "camera-view",
            caption:
                "The camera's view at the end, with the stripes in the colours of their beams. (Figures 11 and 14)"
                    .into(),
            drawing: camera_figure(&run.last_view, job.plan.rig.beams.len()),
        },
        Figure {
            stem: "local-map",
            caption: format!(
                "The local terrain map at the end, {} m between its points, drawn to scale; unknown cells are open. \
                 (Figures 12 and 15)",
                job.plan.map.spacing
            ),
            drawing: relief(&run.map),
        },
    ];
    all.extend(map_figures(job, run));
    all
}
