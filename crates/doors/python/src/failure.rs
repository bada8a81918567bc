//! An error on its way to Python.

use std::error::Error;
use std::io;

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use raypencil::io::{SceneIoError, readable};

/// Why a call failed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// In words; `class` is the name of the exception in `raypencil._errors`.
    Words { text: String, class: &'static str },
    /// The work was told to stop.
    Cancelled,
}

const PLAIN: &str = "RaypencilError";
const FILE: &str = "RaypencilFileError";
const MISSING: &str = "RaypencilFileNotFoundError";

impl Failure {
    /// An error in words.
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self::Words { text: text.into(), class: PLAIN }
    }

    /// A file that is not there.
    pub(crate) fn missing(text: impl Into<String>) -> Self {
        Self::Words { text: text.into(), class: MISSING }
    }

    /// An error, and what may help.
    pub(crate) fn with_help(error: &(dyn Error + 'static), help: Option<String>) -> Self {
        let text = help.map_or_else(|| error.to_string(), |help| format!("{error}\n  help: {help}"));
        Self::Words { text: readable(&text).into_owned(), class: class_of(error) }
    }

    /// The exception.
    pub(crate) fn into_exception(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Cancelled => PyKeyboardInterrupt::new_err(()),
            Self::Words { text, class } => {
                let made = py
                    .import("raypencil._errors")
                    .and_then(|errors| errors.getattr(class))
                    .and_then(|class| class.call1((text,)));
                made.map_or_else(|error| error, PyErr::from_value)
            }
        }
    }
}

/// The class of an exception by what caused the error: the file system or the content.
fn class_of(error: &(dyn Error + 'static)) -> &'static str {
    let mut next = Some(error);
    while let Some(error) = next {
        if let Some(SceneIoError::Source { problem, .. }) = error.downcast_ref::<SceneIoError>() {
            return if problem == "does not exist" { MISSING } else { PLAIN };
        }
        if let Some(error) = error.downcast_ref::<io::Error>() {
            return match error.kind() {
                io::ErrorKind::NotFound => MISSING,
                io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput | io::ErrorKind::UnexpectedEof => {
                    PLAIN
                }
                _ => FILE,
            };
        }
        next = error.source();
    }
    PLAIN
}

impl<E: Error + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::with_help(&error, None)
    }
}
