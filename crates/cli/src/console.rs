//! Standard output and standard error, and a spinner if standard error is a terminal.

use std::borrow::Cow;
use std::io::{IsTerminal, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use raypencil::Progress;
use raypencil::survey::Warning;

/// Prints to standard output. A closed pipe (`| head`) is not an error.
pub(crate) fn say(text: &str) {
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
