//! The rover itself: what it makes of its camera's images, and where it may drive.
//!
//! Step 9 of the paper (§3) and its §7, in the order of one frame:
//!
//! 1. [`Extraction`] finds the lower edges of the light stripes in an image;
//! 2. [`Triangulation`] turns edge pixels into points of the beam's lower edge plane, vehicle frame;
//! 3. [`Mapper`] knows the vehicle's elevation, moves the [`ElevationMap`] and enters the points;
//! 4. every [`FRAMES_PER_OBSTACLE_MAP`] frames, [`ObstacleMap`] tests a radial grid by [`TraversabilityRules`], and
//!    [`navigator_map`] joins the ends of its sectors by labelled vectors.
//!
//! [`Vehicle`] settles on the ground, [`Route`] says where it drives, [`Localisation`] what it knows of that, [`ScanRule`]
//! and [`Sweep`] when it stops to pan its beams.
//!
//! [`Drive`] puts all of it together, with a renderer for the images.
//!
//! Pure: no IO, no clocks, and random numbers keyed by (seed, purpose, index). Every number that the paper does not
//! print is a named parameter; `docs/rover.md` lists them all, with the sentence of the paper that each belongs to.
//!
//! ```
//! use glam::{DVec2, DVec3};
//! use raypencil_rover::{
//!     Attitude, Label, Mapper, MapSize, ObstacleMap, TraversabilityRules, RadialGrid, LocalisationReading, Vehicle, VectorRules,
//!     navigator_map,
//! };
//!
//! // A vehicle at (0, 0) that sees a wall of 0.4 m from x = 3 on, and level ground before it.
//! let vehicle = Vehicle::default();
//! let sensed = LocalisationReading { position: DVec2::ZERO, attitude: Attitude::default(), proximity: Some(0.0) };
//! let mut mapper = Mapper::start(vehicle, MapSize::default(), &sensed, 0.0);
//! let seen = (0..60).flat_map(|i| (-40..=40).map(move |j| {
//!     let (x, y) = (0.1 * f64::from(i), 0.1 * f64::from(j));
//!     DVec3::new(x, y, if x < 2.95 { 0.0 } else { 0.4 })
//! }));
//! mapper.update(&sensed, seen);
//!
//! let grid = RadialGrid::for_vehicle(&vehicle);
//! let rules = TraversabilityRules::for_vehicle(&vehicle);
//! let obstacles = ObstacleMap::extract(mapper.map(), &vehicle, &rules, &grid, &mapper.pose());
//! let ahead = obstacles.sectors[15];
//! assert_eq!(ahead.label, Label::Obstacle);
//! assert!((ahead.radius - 3.0).abs() < 0.11);
//! let vectors = navigator_map(&obstacles, &VectorRules::for_vehicle(&vehicle));
//! assert_eq!(vectors[14].label, Label::Obstacle);
//! ```

mod check;
mod drive;
mod elevation_map;
mod gap;
mod localisation;
mod mapper;
mod navigator_map;
mod noise_stream;
mod obstacle_map;
mod otsu;
mod rig;
mod route;
mod scan;
mod stripe;
mod traversability;
mod triangulation;
mod vehicle;

pub use drive::{
    CameraImage, CameraPipeline, Drive, DriveFrame, DrivePlan, Exposure, ExposureMode, MeasuredPoint,
};
pub use elevation_map::{ElevationMap, ElevationSource, GridPoint, Inconsistency, MapSize};
pub use gap::GapRule;
pub use localisation::{Localisation, LocalisationErrors, LocalisationReading, PositionFixes};
pub use mapper::{MapUpdate, Mapper};
pub use navigator_map::{LabelledVector, VectorRules, navigator_map};
pub use obstacle_map::{
    FRAMES_PER_OBSTACLE_MAP, Label, ObstacleMap, RadialGrid, SectorEnd, obstacle_map_due,
};
pub use otsu::otsu_threshold;
pub use rig::{OnVehicle, Pan, Rig};
pub use route::{Route, RoutePose};
pub use scan::{ScanReason, ScanRule, Sweep};
pub use stripe::{Detection, EdgePoint, Extraction, StripeLocation};
pub use traversability::{SlopeLimits, Traversability, TraversabilityRules, TraversabilityTest};
pub use triangulation::{SheetPlane, Triangulation, TriangulationTable};
pub use vehicle::{Attitude, Stance, Vehicle};
