//! The arguments of `terrain generate`.

use std::path::PathBuf;

use clap::Args;

use crate::parsers::{number, window};

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Ground like that of the Viking 1 site, a square of 10 m.
  raypencil terrain generate --preset viking1 --seed 7 --extent 10 -o out/ground.glb
  # Rocks on an elevation model of your own.
  raypencil terrain generate --coarse dem.tif --rock-coverage 0.1 -o out/rocky.glb
  # The same on 24 m of a model that is kilometres wide.
  raypencil terrain generate --coarse dem.tif --window 1200,3400,24,24 -o out/part.glb")]
pub(crate) struct TerrainGenerate {
    /// Preset of all parameters: smooth, viking1, pathfinder, crater_field, crevassed or worst (docs/guide/terrain.md).
    #[arg(long, value_name = "NAME", default_value = "viking1")]
    pub(crate) preset: String,

    /// Seed of all random numbers; the same seed gives the same terrain.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,

    /// Side length of the square terrain, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = number)]
    pub(crate) extent: Option<f64>,

    /// Distance between neighbouring posts, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = number)]
    pub(crate) post_spacing: Option<f64>,

    /// Distance from the middle within which posts stand at a quarter of the spacing, metres; within 2.5 times of it
    /// they stand at half. 0: one spacing everywhere.
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = number)]
    pub(crate) fine_radius: Option<f64>,

    /// Fraction of the area that rocks cover, 0 to 0.4.
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = number)]
    pub(crate) rock_coverage: Option<f64>,

    /// Diameter of the smallest rocks, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = number)]
    pub(crate) rock_smallest: Option<f64>,

    /// Number of crevasses.
    #[arg(long, value_name = "N")]
    pub(crate) crevasses: Option<u32>,

    /// Elevation model (GeoTIFF) whose posts the surface interpolates; the terrain gets its extent.
    #[arg(long, value_name = "DEM", conflicts_with = "extent")]
    pub(crate) coarse: Option<PathBuf>,

    /// Part of the elevation model: x and y of its lower left corner, width and height, metres of the map.
    // `requires` alone says nothing beside an argument that --coarse cannot stand beside.
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", requires = "coarse", conflicts_with = "extent", allow_hyphen_values = true, value_parser = window)]
    pub(crate) window: Option<[f64; 4]>,

    /// Output file.
    #[arg(short, long, value_name = "FILE.glb")]
    pub(crate) output: PathBuf,
}
