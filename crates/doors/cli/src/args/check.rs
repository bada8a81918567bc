//! The arguments of `check`.

use std::path::PathBuf;

use clap::Args;
use raypencil::Precision;
use raypencil::cast::CloudFrame;

use crate::args::declared::DeclaredArguments;
use crate::parsers::{cloud_frame, number, precision};

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # Embree's recording, which was computed in single precision.
  raypencil check data/packs/pyramids data/candidates/embree/pyramids --arithmetic f32
  # Your renderer's files, with a report.
  raypencil check data/packs/hard my-renders -o out/check
  # A camera.exr of Blender.
  raypencil check data/packs/pyramids my-renders --channel depth.Z=ViewLayer.Depth.Z --miss 1e10
  # A depth image of 16 bits in millimetres, camera/depth.Z.png.
  raypencil check data/packs/pyramids my-depths --scale 0.001
  # A driver's point cloud, held to a pack of a LiDAR's scan.
  raypencil check out/vlp16-pack my.pcd --frame sensor
  # The third cloud of a simulator's bag.
  raypencil check out/vlp16-pack my_0.mcap --message 3 --frame sensor")]
pub(crate) struct Check {
    /// Folder of the reference pack, with its manifest.json, of an input pack, or of a pack of rays.
    #[arg(value_name = "PACK")]
    pub(crate) pack: PathBuf,

    /// Folder of the answers to check: EXR, NPY, NPZ, PFM, PNG or TIFF files or a Zarr store, named as docs/formats/files.md
    /// says, or as --channel declares. For an input pack:
    /// triangles.npy, and reflectivity.npy if there is one. For a pack of rays: arrays as `cast` writes them, or a point cloud, a
    /// .pcd, a .ply, or a PointCloud2 of a bag (.mcap).
    #[arg(value_name = "CANDIDATE")]
    pub(crate) candidate: PathBuf,

    /// Arithmetic in which the answers were computed, which may differ from their storage. Default: as their
    /// candidate.json says, else f64.
    #[arg(long, value_name = "ARITHMETIC", value_parser = precision())]
    pub(crate) arithmetic: Option<Precision>,

    /// Number that means "no hit" in every channel of numbers, such as 0, -1 or nan; of whole numbers with --scale, as the file
    /// has it. Numbers that are not finite, and faces of -1 or 4294967295, always do; but of rays of a set, -Inf says that what is
    /// hit is too near for the sensor.
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true, value_parser = number)]
    pub(crate) miss: Option<f64>,

    /// Leave out the channel of faces, face.I.
    #[arg(long)]
    pub(crate) no_faces: bool,

    /// Frame of the points of a cloud: that of the mesh, of the sensor when it fires each ray, as a driver gives them, or of the
    /// sensor at the start or the end of its scan. Without it: mesh.
    #[arg(long, value_name = "FRAME", value_parser = cloud_frame())]
    pub(crate) frame: Option<CloudFrame>,

    /// Topic of a bag that has the cloud. Without it: the only one with clouds.
    #[arg(long, value_name = "TOPIC")]
    pub(crate) topic: Option<String>,

    /// Which of the topic's clouds, from 1. Without it: the only one.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) message: Option<u64>,

    #[command(flatten)]
    pub(crate) declared: DeclaredArguments,

    /// Compare every answer of a pack of sensors with the referee's; without it all of at most 50,000 answers, of more 6,905 that are drawn,
    /// and each by which a ray is wrong. A published pack is known by its digest. The answers of a pack of rays are all computed again.
    #[arg(long)]
    pub(crate) verify: bool,

    /// Seed by which answers are drawn; default: another one each time, which the check prints.
    #[arg(long, value_name = "SEED", conflicts_with = "verify")]
    pub(crate) seed: Option<u64>,

    /// Folder for report.html, junit.xml, summary.md and check.json; without it none are written.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}
