//! `raypencil reference`: the reference of the command line in Markdown, made from the arguments themselves. The pages
//! of docs/reference/commands are its work.

use std::fmt::Write as _;

use clap::{Arg, Command};

use crate::args::ReferencePages;
use crate::pages::write_pages;
use crate::{Outcome, Trouble};

pub(crate) fn reference(command: &ReferencePages, json: bool) -> Result<Outcome, Trouble> {
    write_pages(&command.output, json, |command| (file_name(command), page(command).into_bytes()))
}

/// The commands below a command that its help names.
fn below(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|below| !below.is_hide_set())
}

/// `terrain-generate.md` for `raypencil terrain generate`; `raypencil.md` for the command line itself.
fn file_name(command: &Command) -> String {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    name.strip_prefix("raypencil-").map_or("raypencil.md".into(), |name| format!("{name}.md"))
}

/// A command's full name, `raypencil terrain generate`.
fn full_name(command: &Command) -> &str {
    command.get_bin_name().unwrap_or_else(|| command.get_name())
}

fn page(command: &Command) -> String {
    let mut page = format!(
        "<!-- Made by `raypencil reference`; a change belongs into crates/doors/cli/src/args. -->\n\n# {}\n\n",
        full_name(command)
    );
    let about = command.get_long_about().or_else(|| command.get_about());
    let _ = writeln!(page, "{}\n", about.map(|text| sentence(&text.to_string())).unwrap_or_default());
    let usage = command.clone().render_usage().to_string();
    let _ = writeln!(page, "```text\n{}\n```", usage.trim_start_matches("Usage: "));
    if command.has_subcommands() {
        page += "\n## Commands\n\n";
        for below in below(command) {
            let about = below.get_about().map(|text| sentence(&text.to_string())).unwrap_or_default();
            let _ = writeln!(page, "* [{}]({}): {about}", full_name(below), file_name(below));
        }
    }
    // The options of every command stand on the first page alone.
    let is_first = file_name(command) == "raypencil.md";
    let shown = |argument: &&Arg| {
        !argument.is_hide_set() && (is_first || !argument.is_global_set()) && argument.get_id() != "help"
    };
    let (positionals, options): (Vec<&Arg>, Vec<&Arg>) =
        command.get_arguments().filter(shown).partition(|argument| argument.is_positional());
    for (title, arguments) in [("Arguments", positionals), ("Options", options)] {
        if !arguments.is_empty() {
            let _ = writeln!(page, "\n## {title}\n");
            arguments.into_iter().for_each(|argument| page += &entry(argument));
        }
    }
    if let Some(examples) = command.get_after_help() {
        let examples = examples.to_string();
        let lines = examples.lines().skip(1).map(|line| line.strip_prefix("  ").unwrap_or(line));
        let _ = writeln!(page, "\n## Examples\n\n```sh\n{}\n```", lines.collect::<Vec<_>>().join("\n"));
    }
    if !is_first {
        page += "\n[The options of every command](raypencil.md#options)\n";
    }
    page
}

/// An argument, as an item of a list.
fn entry(argument: &Arg) -> String {
    let mut text = match argument.is_positional() {
        true => format!("* `{argument}`"),
        false => {
            let short = argument.get_short().map(|short| format!("`-{short}`, ")).unwrap_or_default();
            format!("* {short}`{argument}`")
        }
    };
    let help = argument.get_long_help().or_else(|| argument.get_help());
    let _ = write!(text, ": {}", help.map(|help| sentence(&help.to_string())).unwrap_or_default());
    let takes_values = argument.get_action().takes_values();
    let defaults: Vec<String> =
        argument.get_default_values().iter().map(|value| format!("`{}`", value.display())).collect();
    if takes_values && !defaults.is_empty() {
        let _ = write!(text, " Default: {}.", defaults.join(", "));
    }
    let values: Vec<String> = argument
        .get_possible_values()
        .iter()
        .filter(|value| takes_values && !value.is_hide_set())
        .map(|value| format!("`{}`", value.get_name()))
        .collect();
    if !values.is_empty() {
        let _ = write!(text, " Values: {}.", values.join(", "));
    }
    text + "\n"
}

/// A help text as Markdown: what looks like a tag or a link is none, and the full stop that clap drops is there.
fn sentence(text: &str) -> String {
    let text = text.trim().replace('<', "\\<").replace('*', "\\*").replace("[[", "\\[\\[");
    if text.ends_with('.') { text } else { text + "." }
}
