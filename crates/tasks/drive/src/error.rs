//! Errors of a drive: the reasons why it cannot start, and files that cannot be written.

use raypencil_files::FolderError;
use raypencil_scene::SceneError;

/// Maximum number of frames per drive: one hour at 10 Hz. Each frame keeps about 2,000 edge points in memory.
pub(crate) const MAX_FRAMES: u64 = 36_000;

/// Reason why a drive cannot start or go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DriveError {
    /// The scene has no route: no `[drive]` table, no waypoints on the command line, no built-in route.
    #[error(
        "there is no drive; expected --to X,Y, a scene file with a [drive] table (docs/guide/drive.md), or a built-in \
         ground: pyramids, facets"
    )]
    NoDrive,
    /// The scene has a `[drive]` without waypoints, and none were given otherwise.
    #[error("the drive has no waypoints; expected --to X,Y, or waypoints_m in [drive] (docs/guide/drive.md)")]
    NoWaypoints,
    /// The scene has no beam.
    #[error(
        "the scene has no beam: no stripe is lit, and nothing can be measured; expected one [[beam]] or more"
    )]
    NoBeams,
    /// The flux model's unit is W/m, which no camera can expose.
    #[error(
        "flux model eq1 is in W/m, which no camera can expose; expected radiometric, or a drive without sensor, optics, \
         electronics and sun"
    )]
    Unit,
    /// The route has more than 36,000 frames.
    #[error(
        "the route has more than {MAX_FRAMES} frames; expected a shorter route, a higher speed or fewer frames per \
         second"
    )]
    Frames,
    /// The plan, the scene or the camera's settings hold a number out of range.
    #[error(transparent)]
    Plan(#[from] SceneError),
    /// A file or folder could not be written.
    #[error(transparent)]
    Folder(#[from] FolderError),
}
