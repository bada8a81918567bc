//! The first page of the help: the commands in groups. clap itself lists them in one.

use std::fmt::Write as _;

use clap::Command;
use clap::builder::StyledStr;
use clap::builder::styling::Styles;

/// The commands by what they are for. A test holds that each is in one group.
pub(super) const GROUPS: &[(&str, &[&str])] = &[
    ("Simulate", &["validate", "render", "probe", "drive", "sweep", "cast"]),
    ("Test renderers, yours and ours", &["check", "pack", "diff", "campaign", "minimise"]),
    ("Scenes and terrains", &["scene", "terrain"]),
    ("Tools", &["completions", "man"]),
];

/// Characters of a line. clap's own texts are as wide where it does not measure the terminal.
const WIDTH: usize = 100;

/// The command with its groups on the first page.
pub(super) fn with_groups(command: Command) -> Command {
    let header = Styles::styled().get_header().to_owned();
    let literal = Styles::styled().get_literal().to_owned();
    let longest = GROUPS.iter().flat_map(|(_, names)| names.iter()).map(|name| name.len()).max();
    let column = longest.unwrap_or(0) + 4;
    let mut text = String::from("{before-help}{about-with-newline}\n{usage-heading} {usage}\n");
    for (title, names) in GROUPS {
        let _ = writeln!(text, "\n{header}{title}:{header:#}");
        for name in *names {
            let about = command.find_subcommand(name).and_then(Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            let mut lines = wrapped(&about, WIDTH - column).into_iter();
            let gap = column - 2 - name.len();
            let first = lines.next().unwrap_or_default();
            let _ = writeln!(text, "  {literal}{name}{literal:#}{:gap$}{first}", "");
            for line in lines {
                let _ = writeln!(text, "{:column$}{line}", "");
            }
        }
    }
    let _ = write!(
        text,
        "\n`raypencil help COMMAND` tells all of a command, with examples.\n\n\
         {header}Options:{header:#}\n{{options}}{{after-help}}"
    );
    command.help_template(StyledStr::from(text))
}

/// A text in lines of at most `width` characters.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}
