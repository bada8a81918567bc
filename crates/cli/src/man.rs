//! `raypencil man`: the manual pages of this command, one for each command below it.

use clap::Command;
use clap_mangen::Man;
use raypencil::io::{create_folder, write_atomically};
use serde_json::json;

use crate::args::{ManPages, command_line};
use crate::console::say;
use crate::{Outcome, Trouble};

pub(crate) fn man(command: &ManPages, json: bool) -> Result<Outcome, Trouble> {
    let mut pages = Vec::new();
    // `help` is no command of its own, and needs no page.
    let mut whole = command_line().disable_help_subcommand(true);
    whole.build();
    collect(&whole, &mut pages);
    create_folder(&command.output)?;
    for (name, page) in &pages {
        write_atomically(command.output.join(name), |file| file.write_all(page))?;
    }
    let names: Vec<&str> = pages.iter().map(|(name, _)| name.as_str()).collect();
    let folder = command.output.display().to_string();
    say(&match json {
        true => format!("{:#}\n", json!({ "folder": folder, "files": names })),
        false => format!("{folder}: {} pages\n", names.len()),
    });
    Ok(Outcome::Fine)
}

/// The pages of a command and of all below it, each with the name of its file.
fn collect(command: &Command, pages: &mut Vec<(String, Vec<u8>)>) {
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render(&mut page).expect("memory takes all that is written");
    pages.push((man.get_filename(), page));
    command.get_subcommands().filter(|below| !below.is_hide_set()).for_each(|below| collect(below, pages));
}
