//! Elevation models: GeoTIFF files of heights on a regular grid. `docs/formats/terrain.md` has the rules of what is read.

mod blocks;
mod citation;
mod codec;
mod coordinate_system;
mod epsg;
mod facts;
mod gdal_metadata;
mod geo_keys;
mod georeference;
mod heights;
mod lattice;
mod model;
mod nodata;
mod outliers;
mod read;
mod registration;
mod tags;
mod target;
mod unit;
mod write;

pub use coordinate_system::{AxisSystem, UnitSource};
pub use facts::{DemFacts, SpikeFacts};
pub use model::{Dem, MAX_ERROR_RANGE_M};
pub use nodata::NoData;
pub use outliers::Spikes;
pub use read::{
    DemOptions, MAP_RANGE_M, WINDOW_SIDE_RANGE_M, dem_from_bytes, read_dem, read_dem_with, read_posts,
};
pub use registration::Registration;
pub use unit::{HeightUnit, LengthUnit};
pub use write::write_geotiff;
