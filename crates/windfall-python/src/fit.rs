//! Fits of recordings in memory.

use crate::arrays::npy_of;
use crate::request::{parsed, raised};
use crate::work::beside;
use clap::Parser;
use pyo3::exceptions::{PyIndexError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use serde::Serialize;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use windfall_campaign::impacts::run::{FittedRecording, fit_bytes};
use windfall_campaign::pipeline::request::FitRequest as Fit;
use windfall_campaign::recording::request::RecordingRequest;
use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_files::error::Error;
use windfall_files::on_threads::on_threads;
use windfall_files::progress::{Progress, for_each, quiet};

/// What is fitted, and how.
#[derive(Parser)]
struct FitWords {
    #[command(flatten)]
    fit: Fit,
    #[command(flatten)]
    recording: RecordingRequest,
}

/// What is asked of fits: options of `windfall fit`.
#[pyclass(frozen)]
pub struct FitRequest {
    words: Arc<FitWords>,
}

#[pymethods]
impl FitRequest {
    #[new]
    fn new(words: Vec<OsString>) -> PyResult<FitRequest> {
        let words: FitWords = parsed(words)?;
        let fit = &words.fit;
        if fit.figures.is_some() || fit.detail.is_some() || fit.card.is_some() {
            let told = "fits of arrays write nothing; what --detail writes is in `detail`";
            return Err(PyValueError::new_err(told));
        }
        let words = Arc::new(words);
        Ok(FitRequest { words })
    }
}

/// A fitted recording.
#[pyclass(frozen)]
pub struct Fitted {
    fitted: Arc<FittedRecording>,
}

#[pymethods]
impl Fitted {
    /// How many laws were fitted.
    fn __len__(&self) -> usize {
        self.fitted.outcome().impacts.len()
    }

    /// What the impact is called.
    fn id(&self, place: usize) -> PyResult<&str> {
        Ok(&self.fit(place)?.id)
    }

    /// Name of a law.
    fn law(&self, place: usize) -> PyResult<&str> {
        Ok(&self.fit(place)?.law)
    }

    /// What `windfall fit --format json` would print of the fit of a law.
    fn impact(&self, place: usize) -> PyResult<String> {
        json(self.fit(place)?)
    }

    /// What it would print of each law that could not be fitted.
    fn failed(&self) -> PyResult<Vec<String>> {
        self.fitted.outcome().failed.iter().map(json).collect()
    }

    /// What `windfall fit --detail` would write of a law, as JSON.
    fn detail(&self, py: Python<'_>, place: usize) -> PyResult<String> {
        let law = self.fit(place)?.law;
        let fitted = Arc::clone(&self.fitted);
        let detail = beside(py, None, move |_| fitted.detail(&law))?;
        detail
            .map(|own| own.to_string())
            .map_err(|error| raised(py, &error))
    }
}

impl Fitted {
    fn fit(&self, place: usize) -> PyResult<&ImpactOutcome> {
        let fit = self.fitted.outcome().impacts.get(place);
        fit.ok_or_else(|| PyIndexError::new_err("there are fewer fits"))
    }
}

fn json(own: &impl Serialize) -> PyResult<String> {
    let text = serde_json::to_string(own);
    text.map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// A recording in memory: its name, and the names and doubles of its columns.
type Given = (String, Vec<(String, PyBackedBytes)>);

/// A fit, or what is wrong, and whether with the request.
type Found = (Option<Fitted>, Option<(String, bool)>);

/// Fits recordings at once, with the bits of single fits.
///
/// * `request`: with `--threads`, on that many
#[pyfunction]
#[pyo3(signature = (held, request, progress=None))]
pub fn fit(
    py: Python<'_>,
    held: Vec<Given>,
    request: &FitRequest,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Found>> {
    let held = held.iter().map(|(name, columns)| held_of(name, columns));
    let held: Vec<Held> = held.collect::<PyResult<_>>()?;
    let words = Arc::clone(&request.words);
    // A thread of its own would be much of the time of one fit, which is not interrupted.
    if let ([one], None) = (held.as_slice(), words.fit.threads) {
        return Ok(vec![found(py.detach(|| fit_one(one, &words, &quiet)))]);
    }
    let fits = beside(py, progress, move |watch| {
        let threads = words.fit.threads;
        let one = |at: usize| fit_one(&held[at], &words, &quiet);
        let work = || for_each(&*watch, held.len(), one);
        // The threads that are there do for all cores.
        match threads {
            None => work(),
            threads => on_threads(threads, work),
        }
    })?;
    let fits = fits.map_err(|error| raised(py, &error))?;
    Ok(fits.into_iter().map(found).collect())
}

/// The name and the bytes that a file of NumPy would have.
type Held = (String, Arc<[u8]>);

fn held_of(name: &str, columns: &[(String, PyBackedBytes)]) -> PyResult<Held> {
    let columns: Vec<(&str, &[u8])> = columns
        .iter()
        .map(|(name, doubles)| (name.as_str(), &**doubles))
        .collect();
    Ok((format!("{name}.npy"), npy_of(&columns)?.into()))
}

fn found(fit: Result<Fitted, Error>) -> Found {
    match fit {
        Ok(fitted) => (Some(fitted), None),
        Err(error) => (None, Some((error.to_string(), error.is_request()))),
    }
}

fn fit_one((name, bytes): &Held, words: &FitWords, progress: Progress) -> Result<Fitted, Error> {
    let held = (Path::new(name), Arc::clone(bytes));
    let fitted = fit_bytes(held, &words.recording, &words.fit, progress)?;
    let fitted = Arc::new(fitted);
    Ok(Fitted { fitted })
}
