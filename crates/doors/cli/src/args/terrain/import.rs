//! The arguments of `terrain import`.

use std::path::PathBuf;

use clap::Args;
use raypencil::io::{DEFAULT_REFLECTIVITY, UpAxis};

use super::dem::DemArgs;
use crate::parsers::{named_file, number, numbers, reflectivity, up_axis};

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # All of an elevation model, simplified by at most 2 cm.
  raypencil terrain import dem.tif --max-error 0.02 -o out/ground.glb
  # A window of it, 50 m wide and high.
  raypencil terrain import dem.tif --window 1000,2000,50,50 -o out/window.glb
  # Heights in US survey feet, of which the file says nothing; -9999 is no height.
  raypencil terrain import dem.tif --z-unit ftUS --nodata -9999 -o out/ground.glb")]
pub(crate) struct TerrainImport {
    /// An elevation model: a GeoTIFF with one band. Or a mesh: .stl, .obj, .ply, .glb or .gltf.
    #[arg(value_name = "FILE", value_parser = named_file())]
    pub(crate) file: PathBuf,

    /// Axis of a mesh that points up. Without it: y for glTF, as its specification says, z for STL, OBJ and PLY.
    #[arg(long, value_name = "AXIS", value_parser = up_axis())]
    pub(crate) up: Option<UpAxis>,

    /// Metres for each unit of a mesh: 0.001 if the file is in millimetres. Without it: 1.
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true, value_parser = number)]
    pub(crate) scale: Option<f64>,

    /// Import only the posts in this window: x and y of its lower left corner, width and height, metres of the map.
    #[arg(long, value_name = "X,Y,W,H", value_parser = numbers::<4>, allow_hyphen_values = true)]
    pub(crate) window: Option<[f64; 4]>,

    #[command(flatten)]
    pub(crate) dem: DemArgs,

    /// Simplify the mesh; maximum vertical distance of a post from the simplified terrain, metres.
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = number)]
    pub(crate) max_error: Option<f64>,

    /// Reflectivity of the terrain, 0 to 1; in glTF, of the materials that state none.
    #[arg(long, value_name = "R", default_value_t = DEFAULT_REFLECTIVITY, allow_hyphen_values = true, value_parser = reflectivity)]
    pub(crate) reflectivity: f64,

    /// Output file.
    #[arg(short, long, value_name = "FILE.glb")]
    pub(crate) output: PathBuf,
}
