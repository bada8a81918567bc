//! `raypencil completions`: the script by which a shell completes the words of this command.

use clap_complete::aot::generate;

use crate::args::{Completions, command_line};
use crate::console::print;
use crate::{Outcome, Trouble};

pub(crate) fn completions(command: &Completions) -> Result<Outcome, Trouble> {
    let mut script = Vec::new();
    generate(command.shell, &mut command_line(), "raypencil", &mut script);
    // A script has no line to spare: --quiet leaves it whole.
    print(&String::from_utf8_lossy(&script));
    Ok(Outcome::Fine)
}
