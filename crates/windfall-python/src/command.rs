//! Commands of windfall.

use crate::work::beside;
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs a command: result, messages and exit status.
///
/// * `words`: what would stand on the command line after `windfall`
#[pyfunction]
#[pyo3(signature = (words, progress=None))]
pub fn call(
    py: Python<'_>,
    words: Vec<OsString>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, String, u8)> {
    let answer = beside(py, progress, |watch| windfall_cli::call(words, watch))?;
    Ok((answer.said.result, answer.said.messages, answer.status))
}

/// The program `windfall`; its exit status.
///
/// * `words`: its command line, beginning with the name of the program
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| windfall_cli::main(words))
}
