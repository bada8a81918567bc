//! The arguments of `man` and `reference`, which write pages about the command itself.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # For this user; `man raypencil-validate` finds it there.
  raypencil man -o ~/.local/share/man/man1
  # To look at one page without installing it: `man out/man/raypencil-cast.1`.
  raypencil man -o out/man")]
pub(crate) struct ManPages {
    /// Folder for the pages, one for each command.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # The pages of this repository.
  raypencil reference -o docs/reference/commands")]
pub(crate) struct ReferencePages {
    /// Folder for the pages, one for each command.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}
