//! Elevation models: GeoTIFF files of heights on a regular grid. `docs/guide/dem.md` has the rules of what is read.

mod blocks;
mod georeference;
mod lattice;
mod model;
mod read;
mod registration;
mod tags;
mod write;

pub use model::{Dem, MAX_ERROR_RANGE_M};
pub use read::{MAP_RANGE_M, WINDOW_SIDE_RANGE_M, dem_from_bytes, read_dem, read_mesh, read_posts};
pub use registration::Registration;
pub use write::write_geotiff;
