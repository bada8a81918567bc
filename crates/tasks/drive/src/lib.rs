//! Drives of the rover: the whole vision system from the renderer to the maps, with one renderer or with two in
//! lockstep, and the folder of results.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Source: steps 1 to 9 of the paper (section 3), its maps (section 7) and its sample runs (section 8, figures 11 to
//! 16). This crate joins the renderers, `sensor` and `rover`; it has no step of its own. With two renderers it compares
//! everything that their light becomes: pixels, edge points, map cells and labels.
//!
//! From floor to top:
//!
//! 1. `error`: [`DriveError`]; `labels`: words of labels;
//! 2. `keys`: names of a scene file in errors; `beam_columns`, `warnings`, `job`: [`DriveJob`], everything that defines a drive;
//!    `start`: the pose of `[vehicle]` against how the vehicle stands;
//! 3. `shadow_map`, `sun`: light of sun and sky behind the stripes; `through_optics`: [`ThroughOptics`], a renderer
//!    behind the camera's optics;
//! 4. `recorded_exposure`, `differences`: [`Differences`] between two sides, stage by stage;
//! 5. `swept_ground`, `sector_truth`: [`SectorTruth`], the obstacle maps against what the vehicle can pass;
//!    `point_errors`: [`PointErrors`], the points against the true ground;
//! 6. `camera_view`, `animation_frame`: pictures of a frame;
//! 7. `recording`: [`RecordContents`], images, points, poses and maps for other people's programs; `stripe_file`:
//!    [`StripeFile`], their stripes in place of the rover's;
//!    `history`: the drive frame by frame, for the page;
//!    `renderer_drive`, `run`: [`drive()`] itself and its [`DriveRun`];
//! 8. `counts`, `facts`, `summary`, `document`: [`drive_document`], which every report prints, and [`drive_json`];
//! 9. `figures`, `animation`, `maps`, `explorer`, `folder`: [`write_drive`], the folder with all files.
//!
//! `docs/guide/drive.md` describes routes, settings and files.
//!
//! ```
//! use raypencil_drive::{DriveJob, drive, drive_document};
//! use raypencil_scanline::Scanline;
//! use raypencil_scene::Silent;
//! use raypencil_scene_io::load_text;
//!
//! // A small camera with beams to match, on the paper's pyramids, driven by 0.6 m.
//! let scene = "version = 1
//!     vehicle = { position_m = [-0.6, 0] }
//!     camera = { width_px = 96, height_px = 96, pixel_pitch_um = 96 }
//!     beam = [{ rows = 2 }, { rows = 2 }]
//!     terrain = { builtin = 'pyramids' }
//!     drive = { waypoints_m = [[0.6, 0]], frames_per_s = 3, scans = false }";
//! let job = DriveJob::new(&load_text(scene, "small")?, None, "small.toml".into())?;
//! let run = drive(&job, &[&Scanline::default()], &Silent)?;
//! // 0.6 m at 0.3 m/s take 2 s: 7 frames at 3 per second, both ends included.
//! assert!(drive_document(&job, &run).screen().ends_with("\n7 frames driven; all 31 sectors end unknown.\n"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod animation;
mod animation_frame;
mod background;
mod beam_columns;
mod camera_view;
mod counts;
mod differences;
mod document;
mod error;
mod exact_map;
mod explorer;
mod facts;
mod figures;
mod folder;
mod history;
mod job;
mod keys;
mod labels;
mod maps;
mod point_errors;
mod recorded_exposure;
mod recording;
mod renderer_drive;
mod run;
mod sector_truth;
mod shadow_map;
mod start;
mod stripe_file;
mod summary;
mod sun;
mod swept_ground;
mod through_optics;
mod true_rules;
mod warnings;

pub use differences::{Differences, FluxDifferences, StageDifferences};
pub use document::{drive_document, drive_json};
pub use error::DriveError;
pub use folder::{WrittenDrive, write_drive};
pub use job::{DriveJob, drive_renderer};
pub use maps::camera_info::camera_info;
pub use maps::obstacle_grid::occupancy_grid;
pub use maps::occupancy::{Occupancy, OccupancyGrid, occupancy_files, write_occupancy};
pub use maps::ply::{MarkedPoint, write_ply};
pub use maps::vectors::{VectorOnMap, vectors_csv, vectors_geojson};
pub use point_errors::PointErrors;
pub use recording::RecordContents;
pub use run::{DriveExtras, DriveProgress, DriveRun, drive, drive_with};
pub use sector_truth::{Missed, NotFound, SectorTruth};
pub use stripe_file::StripeFile;
pub use through_optics::ThroughOptics;
pub use true_rules::TrueRules;

/// The README's example, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
#[path = "../tests/unit/common.rs"]
mod common;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_drive;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
