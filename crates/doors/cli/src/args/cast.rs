//! The arguments of `cast`.

use std::path::PathBuf;

use clap::Args;
use raypencil::CastRay;
use raypencil::cast::{BagFields, PcdData};
use raypencil::io::{Setting, UpAxis};

use crate::parsers::{bag_fields, named_file, number, pcd_data, ray, setting, up_axis};

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # A file of rays on a mesh.
  raypencil cast data/rays/cube.obj data/rays/cube.npy -o out/cast
  # One ray, all its hits in exact order.
  raypencil cast data/rays/cube.obj --ray 0.1,0.2,5,0,0,-1 --all
  # A LiDAR's pattern, and whether a renderer answers it rightly.
  raypencil cast data/rays/cube.obj data/rays/vlp16.toml --with tracer
  # The same as a bag of ROS 2, as the driver of the sensor gives it.
  raypencil cast data/rays/cube.obj data/rays/vlp16.toml --bag velodyne -o out/vlp16")]
pub(crate) struct Cast {
    /// A mesh: .glb, .gltf, .stl, .obj or .ply, or a folder with vertices.npy and faces.npy. Or a scene file (.toml) with
    /// tables [[rays]]: its terrain, and its own sets of rays unless others are given; its camera and beams are left out.
    #[arg(value_name = "MESH", value_parser = named_file())]
    pub(crate) mesh: PathBuf,

    /// Rays: NPY of shape (..., 6), (..., 8) or (..., 9), or CSV: origin, direction, and if wanted t_min, t_max, then t_blind, a
    /// sensor's shortest range. `-` is standard input. Or sets of rays, such as patterns of LiDAR: TOML with tables [[rays]].
    #[arg(value_name = "RAYS", conflicts_with = "ray")]
    pub(crate) rays: Option<PathBuf>,

    /// A ray by its numbers, separated by commas: ox,oy,oz,dx,dy,dz and if wanted t_min,t_max, then t_blind. Its answers are
    /// printed. May be repeated.
    #[arg(long, value_name = "NUMBERS", value_parser = ray, allow_hyphen_values = true)]
    pub(crate) ray: Vec<CastRay>,

    /// Let rays pass through the backs of faces. Without it both sides are hit.
    #[arg(long)]
    pub(crate) fronts_only: bool,

    /// Ask for all hits of each ray, in exact order.
    #[arg(long)]
    pub(crate) all: bool,

    /// Ask whether each ray hits anything.
    #[arg(long)]
    pub(crate) any: bool,

    /// Ask how far each ray may be moved sideways, parallel to itself, before its answer changes.
    #[arg(long)]
    pub(crate) margins: bool,

    /// Axis of the mesh that points up: with `y` each vertex (x, y, z) becomes (x, -z, y). Without it no axis is turned, whatever the
    /// format.
    #[arg(long, value_name = "AXIS", value_parser = up_axis())]
    pub(crate) up: Option<UpAxis>,

    /// Multiply each coordinate of the mesh by this, rounded once: 0.001 if the file is in millimetres and the rays in metres.
    /// Without it: 1.
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true, value_parser = number)]
    pub(crate) scale: Option<f64>,

    /// Exit with 0 even if none of the rays of a file or a set hits anything. Rays of --ray may miss in any case.
    #[arg(long)]
    pub(crate) allow_empty: bool,

    /// Set a key of the scene file MESH, as in `validate`. May be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    pub(crate) set: Vec<Setting>,

    /// Compare a renderer's first hits with the exact ones, ray by ray. Exit code 1: a ray is wrong.
    #[arg(long, value_name = "RENDERER", value_parser = ["tracer"])]
    pub(crate) with: Option<String>,

    /// Write the cloud of each set as a bag of ROS 2 too, DIR/rosbag: PointCloud2 in the sensor's frame with the fields of a driver,
    /// poses (TF) and clock.
    #[arg(long, value_name = "FIELDS", value_parser = bag_fields(), requires = "output")]
    pub(crate) bag: Option<BagFields>,

    /// With --bag: leave out rays without a point. Without it the cloud is organised: rows and columns, NaN where nothing is hit.
    #[arg(long, requires = "bag")]
    pub(crate) bag_dense: bool,

    /// How the points of PCD files are stored. Without it: binary.
    #[arg(long, value_name = "DATA", value_parser = pcd_data(), requires = "output")]
    pub(crate) pcd: Option<PcdData>,

    /// Cast the set of a spinning head in scans of so many firing sequences, and write a cloud for each: DIR/scans/*.pcd, and with --bag
    /// one bag of all. Rays and answers of one scan at a time are in memory; of sets in a scene file the rays of all. There are no arrays and no page then.
    #[arg(long, value_name = "SEQUENCES", value_parser = clap::value_parser!(u64).range(1..), requires = "output")]
    #[arg(conflicts_with_all = ["all", "any", "margins", "with", "ray"])]
    pub(crate) scans: Option<u64>,

    /// Folder for the answers: NPY arrays of the rays' own shape, and summary.json. For sets of rays also point clouds and
    /// pictures; several sets have a folder each.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}
