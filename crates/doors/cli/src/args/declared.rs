//! What somebody declares about a recording of another program.

use clap::Args;
use raypencil::io::DeclaredChannel;
use raypencil::pack::Declarations;

use crate::parsers::{declared_channel, metres};

#[derive(Debug, Default, Args)]
pub(crate) struct DeclaredArguments {
    /// Take a channel of the files as a map: depth.Z=ViewLayer.Depth.Z. May be repeated. MAP says what the numbers are: depth.Z
    /// along the optical axis, range.T along the ray. With the sensor (camera/depth.Z=Z) if the path of the file does not name it.
    /// CHANNEL is its name in the file, with part or path before it (PART/Z, depth/Y) if several have that name. A candidate.json
    /// can declare the same under "channels".
    #[arg(long = "channel", value_name = "MAP=CHANNEL", value_parser = declared_channel)]
    pub(crate) channels: Vec<DeclaredChannel>,

    /// Metres for each unit of range.T, depth.Z and view.Z in whole numbers, such as 0.001 for depth images of 16 bits in
    /// millimetres. 0 then means "no hit". In candidate.json "scale".
    #[arg(long, value_name = "METRES", value_parser = metres)]
    pub(crate) scale: Option<f64>,
}

impl DeclaredArguments {
    pub(crate) fn is_empty(&self) -> bool {
        self.channels.is_empty() && self.scale.is_none()
    }

    pub(crate) fn declarations(&self) -> Declarations {
        Declarations { channels: self.channels.clone(), scale: self.scale, ..Declarations::default() }
    }
}
