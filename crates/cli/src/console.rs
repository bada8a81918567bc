//! Standard output and standard error, and a spinner if standard error is a terminal.

use std::borrow::Cow;
use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use clap::ColorChoice;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use raypencil::Progress;
use raypencil::survey::Warning;

/// How a command talks. A process has one standard output, so these are of the process.
#[derive(Debug)]
struct Manners {
    /// No progress, no warnings.
    is_quiet: bool,
    /// Of a result only its last line.
    is_short: bool,
    color: ColorChoice,
    /// The last line so far, where the result is short.
    last_line: Option<String>,
}

static MANNERS: Mutex<Manners> =
    Mutex::new(Manners { is_quiet: false, is_short: false, color: ColorChoice::Auto, last_line: None });

fn manners() -> std::sync::MutexGuard<'static, Manners> {
    // Nothing panics while it is held; what it holds is whole in any case.
    MANNERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Begins a command: with `is_quiet` it shows no progress and no warnings, and only the last line of a text. JSON stays
/// whole.
pub(crate) fn begin(is_quiet: bool, is_json: bool, color: ColorChoice) {
    *manners() = Manners { is_quiet, is_short: is_quiet && !is_json, color, last_line: None };
}

/// Ends a command: prints the last line of its result, if that is all that is wanted.
pub(crate) fn end() {
    let last_line = manners().last_line.take();
    if let Some(line) = last_line {
        print(&format!("{line}\n"));
    }
}

/// Prints a result, or a part of it, to standard output.
pub(crate) fn say(text: &str) {
    let mut manners = manners();
    if !manners.is_short {
        drop(manners);
        return print(text);
    }
    // What is indented belongs to the line above it.
    if let Some(line) = text.lines().rfind(|line| !line.trim().is_empty() && !line.starts_with(' ')) {
        manners.last_line = Some(line.to_string());
    }
}

/// Prints to standard output, all of it. A closed pipe (`| head`) is not an error.
pub(crate) fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush());
}

/// Whether standard output is a terminal, which has an edge.
pub(crate) fn is_terminal() -> bool {
    std::io::stdout().is_terminal()
}

/// Prints to standard error.
pub(crate) fn complain(text: &str) {
    let _ = std::io::stderr().lock().write_all(harmless(text).as_bytes());
}

/// Prints warnings to standard error, so that standard output holds nothing but the result.
pub(crate) fn warn(warnings: &[Warning]) {
    if manners().is_quiet {
        return;
    }
    for warning in warnings {
        complain(&format!("warning: {warning}\n"));
    }
}

/// Replaces control codes of terminals and changes of the writing direction, since names come from untrusted files.
/// Colours stay.
fn harmless(text: &str) -> Cow<'_, str> {
    let is_control = |letter: char| letter.is_control() && !"\n\t".contains(letter);
    let changes_direction = |letter: char| matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if !text.contains(|letter| is_control(letter) || changes_direction(letter)) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len());
    for (at, letter) in text.char_indices() {
        let stays = !(is_control(letter) || changes_direction(letter)) || is_colour(&text[at..]);
        out.push(if stays { letter } else { char::REPLACEMENT_CHARACTER });
    }
    out.into()
}

/// Whether a text begins with a colour code: ESC, `[`, numbers, `m`. (ECMA-48, 8.3.117)
fn is_colour(text: &str) -> bool {
    let Some(code) = text.strip_prefix("\u{1b}[") else { return false };
    in_colour()
        && code.trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == ';').starts_with('m')
}

/// Whether standard error shows colours.
pub(crate) fn in_colour() -> bool {
    let color = manners().color;
    match color {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        // An empty NO_COLOR is as none. (no-color.org)
        ColorChoice::Auto => {
            std::io::stderr().is_terminal()
                && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
        }
    }
}

/// A progress bar of `length` steps, with the template's layout. Hidden if standard error is not a terminal, or by
/// `--quiet`.
pub(crate) fn progress_bar(length: u64, template: &str) -> ProgressBar {
    shown(ProgressBar::new(length), template, Duration::from_millis(200))
}

fn shown(bar: ProgressBar, template: &str, tick: Duration) -> ProgressBar {
    if manners().is_quiet {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(tick);
    bar
}

/// A spinner with the name of the current stage. Hidden if standard error is not a terminal, or by `--quiet`.
#[derive(Debug)]
pub(crate) struct Spinner {
    bar: ProgressBar,
}

impl Spinner {
    pub(crate) fn new() -> Self {
        let bar = ProgressBar::new_spinner();
        Self { bar: shown(bar, "{spinner} {elapsed:>4} {msg}", Duration::from_millis(100)) }
    }
}

impl Progress for Spinner {
    fn stage(&self, what: &str) {
        self.bar.set_message(what.to_string());
    }
}

impl Drop for Spinner {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_codes_are_replaced() {
        assert_eq!(harmless("caf\u{e9}\n\t\u{3c6}"), "caf\u{e9}\n\t\u{3c6}");
        for code in ["\u{1b}[2J", "\u{7}", "\r", "\u{9b}2J", "\u{202e}", "\0"] {
            let first = code.chars().next().expect("a letter");
            assert!(!harmless(code).contains(first), "{code:?}");
        }
    }
}
