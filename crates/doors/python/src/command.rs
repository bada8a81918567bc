//! The command line.

use std::ffi::OsString;

use pyo3::prelude::*;
use raypencil::harness::contender;

/// Runs the command `raypencil`; the program's name comes first. Returns its exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| raypencil_cli::run_with(arguments, &contender))
}
