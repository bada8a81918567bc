//! Files for map servers, geographers and robots. `docs/guide/drive.md` has the conventions.
//!
//! ```text
//! yaml           numbers and texts in YAML
//! camera_info    the camera's calibration for ROS
//! occupancy      occupancy grids for Nav2's map_server
//! obstacle_grid  an obstacle map as an occupancy grid
//! elevations     an elevation map as images and as an elevation model
//! ply            measured points
//! vectors        navigator maps as GeoJSON and CSV
//! ```

pub(crate) mod camera_info;
pub(crate) mod elevations;
pub(crate) mod obstacle_grid;
pub(crate) mod occupancy;
pub(crate) mod ply;
pub(crate) mod vectors;
mod yaml;
