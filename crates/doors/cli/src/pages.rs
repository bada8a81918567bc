//! Pages that the program makes of its own arguments: where they are written.

use std::path::Path;

use clap::Command;
use raypencil::io::{begin_files, write_atomically};
use serde_json::json;

use crate::args::command_line;
use crate::console::say;
use crate::{Outcome, Trouble};

/// Writes the page of each command into `folder`; `page` gives its name and its bytes. A command that no help names has none.
pub(crate) fn write_pages(
    folder: &Path,
    json: bool,
    page: impl Fn(&Command) -> (String, Vec<u8>),
) -> Result<Outcome, Trouble> {
    // `help` is no command of its own, and needs no page.
    let mut whole = command_line().disable_help_subcommand(true);
    whole.build();
    let mut names = Vec::new();
    begin_files(folder)?;
    let mut commands = vec![&whole];
    while let Some(command) = commands.pop() {
        let (name, bytes) = page(command);
        write_atomically(folder.join(&name), |file| file.write_all(&bytes))?;
        names.push(name);
        let below: Vec<&Command> = command.get_subcommands().filter(|below| !below.is_hide_set()).collect();
        commands.extend(below.into_iter().rev());
    }
    let folder = folder.display().to_string();
    say(&match json {
        true => format!("{:#}\n", json!({ "folder": folder, "files": names })),
        false => format!("{folder}: {} pages\n", names.len()),
    });
    Ok(Outcome::Fine)
}
