//! The rover: from the images of its camera to an elevation map, an obstacle map and a navigator map.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! Source: step 9 of the paper (section 3) and its section 7, "Building the local obstacle map". One frame goes through
//! these modules in order:
//!
//! 1. `stripe` (with `otsu`): [`Extraction`] finds the lower edges of the light stripes in an image; `stripe_extractor`:
//!    [`StripeExtractor`], for algorithms in its place; `stripe_assignment`: the beam of each stripe, if several are lit
//!    in one image;
//! 2. `triangulation` (with `rig`): [`Triangulation`] turns edge pixels into points of the beam's lower edge plane, in
//!    the vehicle frame;
//! 3. `localisation` (with `vehicle` and `noise_stream`): [`Localisation`] measures position, attitude and the distance
//!    to the ground, with errors;
//! 4. `mapper`, `elevation_map` and `map_update`: [`Mapper`] estimates the vehicle's pose (mended: `elevation_estimate`,
//!    `registration`), moves the [`ElevationMap`] and enters the points; `known_drift`: what ages with the way; `grid_estimate`: the map at its
//!    grid points; `local_mapper`: [`LocalMapper`], for maps in its place;
//! 5. `obstacle_map`, `traversability`, `wheel_tests` and `gap`: in one of [`FRAMES_PER_OBSTACLE_MAP`] frames, [`ObstacleMap`] tests a
//!    radial grid by [`TraversabilityRules`];
//! 6. `navigator_map`: [`navigator_map()`] joins the ends of the sectors by labelled vectors.
//!
//! `rules` are the switches between printed and mended rules. `true_vehicle` is the vehicle on the true ground, by the
//! crate `chassis`; the rover knows nothing of it.
//!
//! `route` and `scan` decide where the vehicle drives and when it stops to pan its beams. `drive_plan` holds all
//! settings. `drive` puts everything together: [`Drive`] takes a renderer for the images.
//!
//! The crate does no IO and reads no clock; random numbers are keyed by (seed, purpose, index). Every number that the
//! paper does not print is a named field; `docs/theory/rover.md` lists them with the sentences of the paper.
//!
//! ```
//! use glam::{DVec2, DVec3};
//! use raypencil_rover::{
//!     Attitude, Label, LocalisationReading, MapSize, Mapper, ObstacleMap, RadialGrid, TraversabilityRules,
//!     VectorRules, Vehicle, navigator_map,
//! };
//!
//! // A vehicle at (0, 0) measures level ground and, from x = 3 m on, a step of 0.4 m.
//! let vehicle = Vehicle::default();
//! let reading =
//!     LocalisationReading { position: DVec2::ZERO, attitude: Attitude::default(), proximity: Some(0.0) };
//! let mut mapper = Mapper::start(vehicle, MapSize::default(), &reading, 0.0);
//! let points = (-20..60).flat_map(|i| (-40..=40).map(move |j| {
//!     let (x, y) = (0.1 * f64::from(i), 0.1 * f64::from(j));
//!     DVec3::new(x, y, if x < 2.95 { 0.0 } else { 0.4 })
//! }));
//! mapper.update(&reading, points);
//!
//! // By the printed tests: straight ahead the slope from axle to axle is 0.4 / 1.2 at x = 3 m; the maximum is 0.35 / 1.2.
//! let (rules, grid) = (TraversabilityRules::as_printed(&vehicle), RadialGrid::for_vehicle(&vehicle));
//! let obstacles = ObstacleMap::extract(mapper.map(), &vehicle, &rules, &grid, &mapper.pose());
//! let ahead = obstacles.sectors[15];
//! assert_eq!(ahead.label, Label::Obstacle);
//! assert!((ahead.radius - 3.0).abs() < 1e-9);
//! // The next sector ends at an obstacle, too: so does the vector between them.
//! let vectors = navigator_map(&obstacles, &VectorRules::for_vehicle(&vehicle));
//! assert_eq!(vectors[14].label, Label::Obstacle);
//! ```

mod bend;
mod drive;
mod drive_plan;
mod elevation_estimate;
mod elevation_map;
mod exposure_times;
mod gap;
mod grid_estimate;
mod known_drift;
mod local_mapper;
mod localisation;
mod map_update;
mod mapper;
mod navigator_map;
mod noise_stream;
mod obstacle_map;
mod otsu;
mod registration;
mod rig;
mod route;
mod rules;
mod scan;
mod stripe;
mod stripe_assignment;
mod stripe_extractor;
mod traversability;
mod triangulation;
mod true_limits;
mod true_vehicle;
mod vehicle;
mod vehicle_plane;
mod wheel_tests;

pub use drive::{CameraPipeline, Drive, DriveFrame, FoundEdge, MeasuredPoint};
pub use drive_plan::{DrivePlan, ExposureMode, PointLookup, RULE_NAMES};
pub use elevation_map::{ElevationMap, ElevationSource, GridPoint, Inconsistency, MapSize, Sight};
pub use exposure_times::{ExposureTimes, MAX_BLUR_SAMPLES};
pub use gap::{GapRule, MapWithShadows};
pub use grid_estimate::GridEstimate;
pub use known_drift::KnownDrift;
pub use local_mapper::{LocalMapper, MissionStart};
pub use localisation::{Localisation, LocalisationErrors, LocalisationReading, PositionFixes};
pub use map_update::MapPoint;
pub use mapper::{KnownNoise, MapUpdate, Mapper, StripePoint};
pub use navigator_map::{LabelledVector, VectorRules, navigator_map};
pub use obstacle_map::{
    FRAMES_PER_OBSTACLE_MAP, Label, ObstacleMap, RadialGrid, SectorEnd, obstacle_map_due,
};
pub use otsu::otsu_threshold;
pub use rig::{OnVehicle, Pan, Rig};
pub use route::{Route, RoutePose};
pub use rules::{MapRules, Rule, StartRule};
pub use scan::{ScanReason, ScanRule, Sweep};
pub use stripe::{Detection, EdgePoint, Extraction, StripeLocation};
pub use stripe_extractor::{BeamEdge, CameraImage, Exposure, RigExtraction, StripeExtractor, Stripes};
pub use traversability::{
    ErrorMargins, Missing, MissingReason, SlopeLimits, Traversability, TraversabilityRules,
    TraversabilityTest, VehiclePart,
};
pub use triangulation::{SheetPlane, Triangulation, TriangulationTable};
pub use true_limits::TrueLimits;
pub use vehicle::{Attitude, Stance, Vehicle};

/// The README's example, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_rover;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
