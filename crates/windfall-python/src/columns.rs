//! Tables for libraries that know Arrow, through its interface of C.

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use std::path::PathBuf;
use windfall_files::sheet::arrow_stream_of;

/// The rows of a Parquet or Arrow file as an `ArrowArrayStream` in a capsule, which whoever takes
/// it reads and closes.
#[pyfunction]
pub fn arrow_stream(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyCapsule>> {
    let stream = arrow_stream_of(&path).map_err(|error| {
        let told = format!("{}: {error}", path.display());
        PyOSError::new_err(told)
    })?;
    PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
}
