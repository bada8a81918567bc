//! The command as users run it: exit codes, output, files.

mod answers_lost;
mod basics;
mod campaign;
mod cast;
mod check;
mod diagnosis;
mod diff;
mod drive;
mod folder_faults;
mod folders;
mod forged_packs;
mod help;
mod injection;
mod manners;
mod messages;
mod other_programs;
mod packs;
mod ray_packs;
mod ray_sets;
mod scene;
mod sweep;
mod terrain;
mod tools;

use std::path::Path;
use std::process::{Command, Output};

/// The binary, to be run in `folder`.
fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_raypencil"));
    command.args(arguments).current_dir(folder).env("NO_COLOR", "1");
    command
}

fn raypencil(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().expect("the binary runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Asserts the exit code and returns the standard output.
#[track_caller]
fn screen(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = raypencil(folder, arguments);
    let screen = text(&output.stdout);
    assert_eq!(output.status.code(), Some(code), "{screen}{}", text(&output.stderr));
    screen
}

/// Asserts an error: exit code 2, empty standard output, and a message that contains all of `words`.
#[track_caller]
fn assert_trouble(output: &Output, words: &[&str]) {
    // The message may be wrapped, with a bar before each line.
    let message = text(&output.stderr);
    let message: Vec<&str> = message.split_whitespace().filter(|word| *word != "│").collect();
    let message = message.join(" ");
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert_eq!(text(&output.stdout), "");
    for word in words {
        assert!(message.contains(word), "`{word}` is not in:\n{message}");
    }
}
