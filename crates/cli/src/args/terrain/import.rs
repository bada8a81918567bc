//! The arguments of `terrain import`.

use std::path::PathBuf;

use clap::Args;
use raypencil::io::DEFAULT_REFLECTIVITY;

use crate::parsers::numbers;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # All of an elevation model, simplified by at most 2 cm.
  raypencil terrain import dem.tif --max-error 0.02 -o out/ground.glb
  # A window of it, 50 m wide and high.
  raypencil terrain import dem.tif --window 1000,2000,50,50 -o out/window.glb")]
pub(crate) struct TerrainImport {
    /// A GeoTIFF with one band, in metres.
    #[arg(value_name = "DEM")]
    pub(crate) dem: PathBuf,

    /// Import only the posts in this window: x and y of its lower left corner, width and height, metres of the map.
    #[arg(long, value_name = "X,Y,W,H", value_parser = numbers::<4>, allow_hyphen_values = true)]
    pub(crate) window: Option<[f64; 4]>,

    /// Simplify the mesh; maximum vertical distance of a post from the simplified terrain, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) max_error: Option<f64>,

    /// Reflectivity of the terrain, 0 to 1.
    #[arg(long, value_name = "R", default_value_t = DEFAULT_REFLECTIVITY, allow_hyphen_values = true)]
    pub(crate) reflectivity: f64,

    /// Output file.
    #[arg(short, long, value_name = "FILE.glb")]
    pub(crate) output: PathBuf,
}
