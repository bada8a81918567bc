//! Standard output and standard error, and a spinner if standard error is a terminal.

use std::io::{IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use raypencil::Progress;
use raypencil::io::{harmless, harmless_line};
use raypencil::survey::Warning;

/// The first error of a write to standard output since the command began; nothing for a closed pipe.
static FAILED_WRITE: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// Prints to standard output. A closed pipe (`| head`) is not an error; any other failure is, once the command ends:
/// see [`failed_write`].
pub(crate) fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    note(out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()));
}

/// Keeps the error of a write to standard output.
pub(crate) fn note(written: std::io::Result<()>) {
    if let Err(error) = written
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
    for warning in warnings {
        complain(&format!("warning: {warning}\n"));
    }
}

/// Whether standard error shows colours.
pub(crate) fn in_colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// A spinner with the name of the current stage. Hidden if standard error is not a terminal.
#[derive(Debug)]
pub(crate) struct Spinner {
    bar: ProgressBar,
}

impl Spinner {
    pub(crate) fn new() -> Self {
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed:>4} {msg}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(100));
        Self { bar }
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
