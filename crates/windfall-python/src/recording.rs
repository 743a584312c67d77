//! Recordings of any format.

use crate::request::{parsed, raised};
use crate::work::beside;
use clap::Parser;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::ffi::OsString;
use std::path::PathBuf;
use windfall_campaign::settings::open_options::{OpenRequest, open_options};
use windfall_files::error::Error;
use windfall_files::inputs::check_regular;
use windfall_files::text::column_role::{seconds_per_unit, unit_in};
use windfall_formats::contents::{Contents, TimeBase};
use windfall_formats::open::open;

/// What is read, and how.
#[derive(Parser)]
struct ReadWords {
    file: PathBuf,
    #[command(flatten)]
    open: OpenRequest,
}

/// A recording with all its samples.
#[pyclass(frozen)]
pub struct Recording {
    contents: Contents,
    columns: Vec<Vec<f64>>,
}

/// Reads a recording of any format.
///
/// * `words`: options of `windfall inspect` that say how, and the file
#[pyfunction]
pub fn read(py: Python<'_>, words: Vec<OsString>) -> PyResult<Recording> {
    let words: ReadWords = parsed(words)?;
    let recording = beside(py, None, move |_| read_all(&words))?;
    recording.map_err(|error| raised(py, &error))
}

fn read_all(words: &ReadWords) -> Result<Recording, Error> {
    check_regular(&words.file)?;
    let options = open_options(&words.open)?;
    let mut reader = open(&words.file, &options).map_err(Error::Format)?;
    let wanted: Vec<usize> = (0..reader.contents().channels.len()).collect();
    let columns = reader.read_whole(&wanted).map_err(Error::Format)?;
    Ok(Recording {
        contents: reader.contents().clone(),
        columns,
    })
}

#[pymethods]
impl Recording {
    /// Format of the file.
    #[getter]
    fn format(&self) -> String {
        self.contents.format.to_string()
    }

    /// Names and units of the channels, in the order of the file.
    #[getter]
    fn channels(&self) -> Vec<(String, Option<String>)> {
        let channels = self.contents.channels.iter();
        channels
            .map(|own| (own.name.clone(), unit_in(own)))
            .collect()
    }

    /// What is wrong with the file: code and sentence.
    #[getter]
    fn notes(&self) -> Vec<(&'static str, String)> {
        let notes = self.contents.notes.iter();
        notes.map(|own| (own.code(), own.to_string())).collect()
    }

    /// Samples of a channel, as the bytes of double precision numbers.
    fn samples<'py>(&self, py: Python<'py>, channel: usize) -> PyResult<Bound<'py, PyBytes>> {
        let column = self.columns.get(channel).ok_or_else(absent)?;
        bytes_of(py, column.iter().copied(), column.len())
    }

    /// Times of the samples of a channel in s, in the same form; nothing where the file does not
    /// tell them.
    fn times<'py>(&self, py: Python<'py>, channel: usize) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let column = self.columns.get(channel).ok_or_else(absent)?;
        match self.contents.channels[channel].time {
            TimeBase::Unknown => Ok(None),
            TimeBase::Uniform { start, interval } => {
                let times = (0..column.len()).map(|row| start + row as f64 * interval);
                bytes_of(py, times, column.len()).map(Some)
            }
            TimeBase::Channel(at) => {
                let scale = seconds_per_unit(&self.contents.channels[at]);
                let times = self.columns[at].iter().map(|time| time * scale);
                bytes_of(py, times, self.columns[at].len()).map(Some)
            }
        }
    }
}

fn absent() -> PyErr {
    PyValueError::new_err("the recording has no channel of this number")
}

fn bytes_of<'py>(
    py: Python<'py>,
    values: impl Iterator<Item = f64>,
    length: usize,
) -> PyResult<Bound<'py, PyBytes>> {
    PyBytes::new_with(py, length * size_of::<f64>(), |bytes| {
        for (place, value) in bytes.chunks_exact_mut(size_of::<f64>()).zip(values) {
            place.copy_from_slice(&value.to_ne_bytes());
        }
        Ok(())
    })
}
