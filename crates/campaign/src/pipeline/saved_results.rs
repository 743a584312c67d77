//! Results that go into the store while others are still being worked out.

use std::collections::HashSet;
use std::mem::take;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use windfall_files::error::Error;

/// Time between two writings: what a crash may cost.
const EVERY: Duration = Duration::from_secs(1);

/// A result: position in the campaign's entries, key, what was found.
pub(crate) type Keyed<T> = (usize, String, T);

/// Results of one evaluation on their way into the store.
pub(crate) struct SavedResults<T, W> {
    write: W,
    state: Mutex<State<T>>,
}

struct State<T> {
    waiting: Vec<Keyed<T>>,
    /// Keys of those that are in the store.
    saved: HashSet<String>,
    /// When the last ones were taken to be written.
    last: Instant,
    /// Why they cannot be written.
    failed: Option<Error>,
}

impl<T: Clone, W: Fn(&[Keyed<T>]) -> Result<(), Error>> SavedResults<T, W> {
    /// None yet.
    ///
    /// * `write`: writes some results, all or none of them
    pub(crate) fn new(write: W) -> Self {
        Self {
            write,
            state: Mutex::new(State {
                waiting: Vec::new(),
                saved: HashSet::new(),
                last: Instant::now(),
                failed: None,
            }),
        }
    }

    /// Whether results could not be written, and further work is in vain.
    pub(crate) fn failed(&self) -> bool {
        self.state().failed.is_some()
    }

    /// Takes a result. Once in a while it is written together with all that wait, by the thread
    /// that brings it; the others go on.
    pub(crate) fn add(&self, position: usize, key: &str, found: &T) {
        let own = (position, key.to_owned(), found.clone());
        let mut state = self.state();
        state.waiting.push(own);
        if state.last.elapsed() < EVERY {
            return;
        }
        state.last = Instant::now();
        let waiting = take(&mut state.waiting);
        drop(state);
        self.save(waiting);
    }

    /// Keys of the results that were written; those that still wait are left to the caller,
    /// unless the work was stopped.
    ///
    /// # Errors
    /// Results could not be written.
    pub(crate) fn finish(self, stopped: bool) -> Result<HashSet<String>, Error> {
        if stopped {
            let waiting = take(&mut self.state().waiting);
            self.save(waiting);
        }
        let state = self.state.into_inner();
        let state = state.unwrap_or_else(PoisonError::into_inner);
        state.failed.map_or(Ok(state.saved), Err)
    }

    fn save(&self, waiting: Vec<Keyed<T>>) {
        if waiting.is_empty() {
            return;
        }
        let written = (self.write)(&waiting);
        let mut state = self.state();
        match written {
            Ok(()) => state.saved.extend(waiting.into_iter().map(|own| own.1)),
            Err(error) => state.failed = Some(error),
        }
    }

    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
