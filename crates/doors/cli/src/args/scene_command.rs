//! The arguments of `scene`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::scene::SceneArguments;

#[derive(Debug, Subcommand)]
pub(crate) enum SceneCommand {
    /// Print a scene with its units, and draw rig and ground from above and from the side.
    #[command(after_help = "Examples:
  # The numbers of the default rig.
  raypencil scene show
  # A terrain of your own, with a picture.
  raypencil scene show ground.glb -o out/ground.svg")]
    Show(SceneShow),
    /// Write a scene file with every key and its meaning.
    #[command(after_help = "Examples:
  # The default rig on the built-in pyramids, to be changed.
  raypencil scene init my-scene.toml")]
    Init(SceneInit),
}

#[derive(Debug, Args)]
pub(crate) struct SceneShow {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,

    /// File for the picture, .svg or .png; without it none is drawn.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SceneInit {
    /// The new file; one that is there already is refused.
    #[arg(value_name = "FILE.toml", default_value = "scene.toml")]
    pub(crate) file: PathBuf,
}
