//! How an error is shown: with colours of our own, and without any that names or files bring along.

use std::borrow::Cow;
use std::fmt;

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode};
use raypencil::io::{harmless, readable};

use crate::console::{in_colour, note};

/// An error whose words are harmless. A scene file's text was made so when the error was made, and keeps its marks.
#[derive(Debug)]
struct Shown<'a> {
    words: String,
    help: Option<String>,
    error: &'a dyn Diagnostic,
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words)
    }
}

impl std::error::Error for Shown<'_> {}

impl Diagnostic for Shown<'_> {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.error.code()
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.error.source_code()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.error.labels()
    }
}

/// A text without the numbers that the system gives its errors, as in "(os error 17)": the words before them say it.
pub(crate) fn without_codes_of_the_system(text: &str) -> String {
    let mut parts = text.split(" (os error ");
    let mut plain = parts.next().unwrap_or_default().to_string();
    for part in parts {
        match part.split_once(')') {
            Some((number, rest)) if number.bytes().all(|byte| byte.is_ascii_digit()) => plain.push_str(rest),
            _ => plain.push_str(&format!(" (os error {part}")),
        }
    }
    plain
}

/// The message of an error: what is wrong, where, what was expected; for a scene file with the line and a caret.
pub(crate) fn rendered(error: &dyn Diagnostic) -> String {
    let shown = Shown {
        words: readable(&without_codes_of_the_system(&harmless(&error.to_string()))).into_owned(),
        help: error.help().map(|help| readable(&harmless(&help.to_string())).into_owned()),
        error,
    };
    let theme = if in_colour() { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let mut text = String::new();
    let is_rendered =
        GraphicalReportHandler::new_themed(theme).with_links(false).render_report(&mut text, &shown);
    if is_rendered.is_err() {
        text = format!("{shown}\n");
    }
    text
}

/// Prints what clap says: a help text to standard output, an error to standard error. An error repeats the arguments, so one
/// about words with codes of terminals, or about long words, is shown without any colour.
pub(crate) fn print_usage(error: &clap::Error, has_codes: bool) {
    let plain = error.render().to_string();
    match (error.use_stderr(), readable(&plain)) {
        (true, Cow::Owned(shorter)) => crate::console::complain(&shorter),
        (true, Cow::Borrowed(plain)) if has_codes => crate::console::complain(plain),
        _ => note(error.print()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_the_system_are_left_out() {
        let text = "x: cannot write: No space left on device (os error 28), twice (os error 28)";
        assert_eq!(without_codes_of_the_system(text), "x: cannot write: No space left on device, twice");
        assert_eq!(without_codes_of_the_system("a (os error x) b"), "a (os error x) b");
    }
}
