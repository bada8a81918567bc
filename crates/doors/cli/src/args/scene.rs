//! The scene of a command, and what is changed in it.

use clap::Args;
use raypencil::FluxModel;
use raypencil::io::{Overrides, Setting, quoted};

use crate::parsers::{flux_model, number, pair, setting};

/// The scene, and what is changed in it.
#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// A built-in terrain (pyramids, facets), a scene .toml, a terrain (.glb, .gltf, .stl, .obj, .ply), or an
    /// elevation model .tif.
    #[arg(value_name = "SCENE", default_value = "pyramids")]
    pub(crate) scene: String,

    /// Full fan angle of every beam, degrees.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = number)]
    pub(crate) fan: Option<f64>,

    /// Thickness of every beam, millimetres.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = number)]
    pub(crate) thickness: Option<f64>,

    /// Flux model; default: the scene's.
    #[arg(long, value_name = "MODEL", value_parser = flux_model())]
    pub(crate) flux: Option<FluxModel>,

    /// Position of the vehicle on the ground: global x,y in metres.
    #[arg(long, value_name = "X,Y", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub(crate) at: Option<[f64; 2]>,

    /// Heading of the vehicle, degrees to the left of the global x axis.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = number)]
    pub(crate) heading: Option<f64>,

    /// Set a key of the scene file, in the file's units: camera.pitch_down_deg=25, beam.0.thickness_mm=4; beam.KEY sets
    /// every beam. May be repeated; the other options come after it.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pub(crate) settings: Vec<Setting>,
}

impl SceneArguments {
    /// The changes of the scene.
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides {
            at: self.at,
            heading_deg: self.heading,
            fan_deg: self.fan,
            thickness_mm: self.thickness,
            flux_model: self.flux,
            settings: self.settings.clone(),
            for_drive: false,
        }
    }

    /// These arguments as typed on the command line.
    pub(crate) fn typed(&self) -> String {
        let mut words = vec![quoted(&self.scene)];
        if let Some(fan) = self.fan {
            words.push(format!("--fan {fan}"));
        }
        if let Some(thickness) = self.thickness {
            words.push(format!("--thickness {thickness}"));
        }
        if let Some(flux) = self.flux {
            words.push(format!("--flux {}", flux.word()));
        }
        if let Some([x, y]) = self.at {
            words.push(format!("--at {x},{y}"));
        }
        if let Some(heading) = self.heading {
            words.push(format!("--heading {heading}"));
        }
        words.extend(self.settings.iter().map(typed_setting));
        words.join(" ")
    }
}

/// A setting as typed on the command line.
pub(crate) fn typed_setting(setting: &Setting) -> String {
    format!("--set {}", quoted(&setting.to_string()))
}
