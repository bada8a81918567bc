//! Standard output and error: a spinner while there is someone to watch it, quiet where there is not.

use std::borrow::Cow;
use std::io::{IsTerminal, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use raypencil::Progress;

/// Prints to standard output. A reader that has gone away (`| head`) is no trouble of ours.
pub(crate) fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush());
}

/// Prints to standard error.
pub(crate) fn complain(text: &str) {
    let _ = std::io::stderr().lock().write_all(harmless(text).as_bytes());
}

/// A text without what commands a terminal, or turns the direction of writing: names come from files that anybody may
/// have made. Colours stay.
fn harmless(text: &str) -> Cow<'_, str> {
    let commands = |letter: char| letter.is_control() && !"\n\t".contains(letter);
    let turns = |letter: char| matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if !text.contains(|letter| commands(letter) || turns(letter)) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len());
    for (at, letter) in text.char_indices() {
        let stays = !(commands(letter) || turns(letter)) || is_colour(&text[at..]);
        out.push(if stays { letter } else { char::REPLACEMENT_CHARACTER });
    }
    out.into()
}

/// Whether a text starts with a code that changes the colour: ESC, `[`, numbers, `m`. (ECMA-48, 8.3.117)
fn is_colour(text: &str) -> bool {
    let Some(code) = text.strip_prefix("\u{1b}[") else { return false };
    in_colour()
        && code.trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == ';').starts_with('m')
}

/// Whether standard error takes colours.
pub(crate) fn in_colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// A spinner that names the stage at work. It stays hidden where standard error is no terminal.
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
    fn nothing_commands_a_terminal() {
        assert_eq!(harmless("caf\u{e9}\n\t\u{3c6}"), "caf\u{e9}\n\t\u{3c6}");
        for code in ["\u{1b}[2J", "\u{7}", "\r", "\u{9b}2J", "\u{202e}", "\0"] {
            let first = code.chars().next().expect("a letter");
            assert!(!harmless(code).contains(first), "{code:?}");
        }
    }
}
