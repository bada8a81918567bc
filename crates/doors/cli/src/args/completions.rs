//! The arguments of `completions`.

use clap::Args;
use clap_complete::Shell;

#[derive(Debug, Args)]
#[command(after_help = "Examples:
  # For this user, in bash.
  raypencil completions bash > ~/.local/share/bash-completion/completions/raypencil
  # In fish.
  raypencil completions fish > ~/.config/fish/completions/raypencil.fish
  # In zsh: the folder has to be one of $fpath.
  raypencil completions zsh > ~/.zfunc/_raypencil")]
pub(crate) struct Completions {
    /// The shell that will read the script.
    #[arg(value_name = "SHELL", value_enum)]
    pub(crate) shell: Shell,
}
