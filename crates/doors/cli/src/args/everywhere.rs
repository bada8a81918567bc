//! The options of every command.

use bytesize::ByteSize;
use clap::{Args, ColorChoice};

use crate::memory;

/// The options of every command.
#[derive(Debug, Args)]
pub(crate) struct Everywhere {
    /// Print JSON instead of text.
    #[arg(long, global = true, help_heading = "Options of every command")]
    pub(crate) json: bool,

    /// Show no progress and no warnings, and only the last line of the result. Errors stay; so does all of --json.
    #[arg(long, global = true, help_heading = "Options of every command")]
    pub(crate) quiet: bool,

    /// Colours on a terminal. By default none if the variable NO_COLOR is set.
    #[arg(
        long,
        global = true,
        value_name = "WHEN",
        default_value_t = ColorChoice::Auto,
        value_enum,
        help_heading = "Options of every command"
    )]
    pub(crate) color: ColorChoice,

    /// Number of worker threads; default: all cores. Results do not depend on it.
    #[arg(
        long,
        global = true,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024),
        help_heading = "Options of every command"
    )]
    pub(crate) threads: Option<u16>,

    /// Replace what an output folder holds of something else: results of another command, scene, mesh or pack, or another pack.
    #[arg(long, global = true, help_heading = "Options of every command")]
    pub(crate) force: bool,

    /// Refuse work that would take more memory, such as 2GB or 512MiB; default: the memory of the machine. Asked before the work
    /// begins, by render, validate, minimise, pack, check, probe, drive and cast.
    #[arg(
        long,
        global = true,
        value_name = "SIZE",
        value_parser = memory::size,
        help_heading = "Options of every command"
    )]
    pub(crate) max_memory: Option<ByteSize>,
}
