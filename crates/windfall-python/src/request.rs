//! Requests of Python, and what is wrong with them.

use clap::Parser;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::ffi::OsString;
use windfall_files::error::Error;

/// Words of a command line as a request.
pub fn parsed<T: Parser>(words: Vec<OsString>) -> PyResult<T> {
    let words = std::iter::once(OsString::from("windfall")).chain(words);
    T::try_parse_from(words).map_err(|error| {
        let text = error.render().to_string();
        let text = text.trim_end();
        PyValueError::new_err(text.strip_prefix("error: ").unwrap_or(text).to_owned())
    })
}

/// An error as Python raises it: `ValueError`, where the request was wrong, or `WindfallError`.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    let text = error.to_string();
    if error.is_request() {
        return PyValueError::new_err(text);
    }
    let kind = py.import("windfall._errors");
    let kind = kind.and_then(|errors| errors.getattr("WindfallError"));
    let value = kind.and_then(|kind| kind.call1((text,)));
    value.map_or_else(|other| other, PyErr::from_value)
}
