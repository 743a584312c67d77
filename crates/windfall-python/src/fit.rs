//! Fits of recordings in memory.

use crate::request::{parsed, raised};
use crate::work::beside;
use clap::Parser;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use std::ffi::OsString;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use windfall_campaign::impacts::run::{FittedRecording, fit_bytes};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::recording::request::RecordingRequest;
use windfall_files::error::Error;
use windfall_files::on_threads::on_threads;
use windfall_files::progress::{Progress, for_each, quiet};

/// What is fitted, and how.
#[derive(Parser)]
struct FitWords {
    #[command(flatten)]
    fit: FitRequest,
    #[command(flatten)]
    recording: RecordingRequest,
}

/// A fitted recording.
#[pyclass(frozen)]
pub struct Fitted {
    fitted: Arc<FittedRecording>,
    /// Id and law of each of its fits.
    #[pyo3(get)]
    fits: Vec<(String, String)>,
    /// Laws that could not be fitted.
    #[pyo3(get)]
    failed: usize,
}

#[pymethods]
impl Fitted {
    /// What `windfall fit --format json` would print.
    fn json(&self) -> PyResult<String> {
        let text = self.fitted.outcome().json();
        text.map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }

    /// What `windfall fit --detail` would write of a law, as JSON.
    fn detail(&self, py: Python<'_>, law: String) -> PyResult<String> {
        let fitted = Arc::clone(&self.fitted);
        let detail = beside(py, None, move |_| fitted.detail(&law))?;
        detail
            .map(|own| own.to_string())
            .map_err(|error| raised(py, &error))
    }
}

/// A recording in memory: its name, and the bytes of a file of any format.
type Held = (String, PyBackedBytes);

/// A fit, or what is wrong, and whether with the request.
type Found = (Option<Fitted>, Option<(String, bool)>);

/// Fits recordings at once, with the bits of single fits.
///
/// * `words`: options of `windfall fit`; with `--threads`, on that many
#[pyfunction]
#[pyo3(signature = (held, words, progress=None))]
pub fn fit(
    py: Python<'_>,
    held: Vec<Held>,
    words: Vec<OsString>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Found>> {
    let words = request(words)?;
    let fit = &words.fit;
    if fit.figures.is_some() || fit.detail.is_some() || fit.card.is_some() {
        let told = "fits of arrays write nothing; what --detail writes is in `detail`";
        return Err(PyValueError::new_err(told));
    }
    let held = held.into_iter().map(|own| (own.0, Arc::from(&*own.1)));
    let held: Vec<(String, Arc<[u8]>)> = held.collect();
    // A thread of its own would be much of the time of one fit, which is not interrupted.
    if let ([one], None) = (held.as_slice(), fit.threads) {
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

fn found(fit: Result<Fitted, Error>) -> Found {
    match fit {
        Ok(fitted) => (Some(fitted), None),
        Err(error) => (None, Some((error.to_string(), error.is_request()))),
    }
}

/// Requests that are remembered: to read one takes as long as to fit an impact, and the next
/// recording usually has the same.
const REMEMBERED: usize = 8;

/// What words ask for.
///
/// # Errors
/// They cannot be used.
fn request(words: Vec<OsString>) -> PyResult<Arc<FitWords>> {
    static KNOWN: Mutex<Vec<(Vec<OsString>, Arc<FitWords>)>> = Mutex::new(Vec::new());
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, own)) = known().iter().find(|own| own.0 == words) {
        return Ok(Arc::clone(own));
    }
    let request = Arc::new(parsed::<FitWords>(words.clone())?);
    let mut known = known();
    known.truncate(REMEMBERED - 1);
    known.insert(0, (words, Arc::clone(&request)));
    Ok(request)
}

fn fit_one(
    (name, bytes): &(String, Arc<[u8]>),
    words: &FitWords,
    progress: Progress,
) -> Result<Fitted, Error> {
    let held = (Path::new(name), Arc::clone(bytes));
    let fitted = fit_bytes(held, &words.recording, &words.fit, progress)?;
    let outcome = fitted.outcome();
    let fits = outcome.impacts.iter();
    let fits = fits.map(|own| (own.id.clone(), own.law.clone())).collect();
    let failed = outcome.failed.len();
    Ok(Fitted {
        fitted: Arc::new(fitted),
        fits,
        failed,
    })
}
