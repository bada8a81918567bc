//! Standard output and standard error, and a spinner if standard error is a terminal.

use std::io::{IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use clap::ColorChoice;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use raypencil::Progress;
use raypencil::io::{harmless, harmless_line};
use raypencil::survey::Warning;

use crate::closed_output;

/// The first error of a write to standard output since the command began; nothing for a closed pipe.
static FAILED_WRITE: Mutex<Option<std::io::Error>> = Mutex::new(None);

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

fn manners() -> MutexGuard<'static, Manners> {
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

/// Prints to standard output, all of it. A closed pipe (`| head`) is not an error; any other failure is, once the command
/// ends: see [`failed_write`].
pub(crate) fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    note(out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()));
}

/// Keeps the error of a write to standard output.
pub(crate) fn note(written: std::io::Result<()>) {
    if let Err(error) = closed_output::error().map_or(written, Err)
        && error.kind() != std::io::ErrorKind::BrokenPipe
    {
        failed().get_or_insert(error);
    }
}

fn failed() -> MutexGuard<'static, Option<std::io::Error>> {
    FAILED_WRITE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes the error of a write to standard output: an answer that nobody got is no answer.
pub(crate) fn failed_write() -> Option<std::io::Error> {
    failed().take()
}

/// Whether standard output is a terminal, which has an edge.
pub(crate) fn is_terminal() -> bool {
    std::io::stdout().is_terminal()
}

/// Prints to standard error. That it cannot be printed is nothing to tell anybody.
pub(crate) fn complain(text: &str) {
    complain_in_colour(&harmless(text));
}

/// The same for a text with colours of our own, of which every other part is harmless already.
pub(crate) fn complain_in_colour(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
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

/// Whether lines may tell how far a work is: standard error is no terminal, on which a bar is drawn.
pub(crate) fn shows_lines() -> bool {
    !manners().is_quiet && !std::io::stderr().is_terminal()
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
    // A hidden bar needs no thread that draws it.
    if !bar.is_hidden() {
        bar.enable_steady_tick(tick);
    }
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
        self.bar.set_message(harmless_line(what));
    }
}

impl Drop for Spinner {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
