//! Work beside the interpreter: other threads of Python go on, and Ctrl-C stops it.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use windfall_cli::Watch;

/// How often the interpreter is asked for signals, and told of progress.
const LOOK: Duration = Duration::from_millis(50);
/// Stack of the thread that works: that of a main thread.
const STACK: usize = 8 << 20;

/// How far the work has come, and whether it is to stop.
#[derive(Default)]
struct State {
    stopped: AtomicBool,
    done: AtomicUsize,
    all: AtomicUsize,
}

/// Does work on a thread of its own.
///
/// * `progress`: is called with the items done and all items, on the thread that called
/// * `work`: takes what tells it whether to go on
///
/// # Errors
/// What a handler of signals raised, such as `KeyboardInterrupt`, once the work has stopped;
/// the work panicked.
pub fn beside<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let state = Arc::new(State::default());
    let (send, receive) = sync_channel(1);
    let watch = watch(Arc::clone(&state));
    let thread = std::thread::Builder::new().stack_size(STACK);
    // Whoever waits is told by the end of the channel, should this panic.
    thread.spawn(move || {
        let _ = send.send(work(watch));
    })?;
    let receive = Mutex::new(receive);
    let mut raised = None;
    loop {
        let next = py.detach(|| {
            let receive = receive.lock().unwrap_or_else(PoisonError::into_inner);
            receive.recv_timeout(LOOK)
        });
        // What Ctrl-C finds finished is not given back either.
        let interrupted = py.check_signals().and_then(|()| tell(&state, progress));
        if let Err(error) = interrupted {
            state.stopped.store(true, Ordering::Relaxed);
            raised.get_or_insert(error);
        }
        let error = match (next, raised.take()) {
            (Ok(done), None) => return Ok(done),
            (Ok(_), Some(error)) => error,
            (Err(RecvTimeoutError::Timeout), still) => {
                raised = still;
                continue;
            }
            (Err(RecvTimeoutError::Disconnected), _) => {
                PyRuntimeError::new_err("windfall has a defect: its work ended in a panic")
            }
        };
        return Err(error);
    }
}

fn watch(state: Arc<State>) -> Watch {
    Arc::new(move |done, all| {
        state.all.store(all, Ordering::Relaxed);
        state.done.fetch_max(done, Ordering::Relaxed);
        match state.stopped.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    })
}

fn tell(state: &State, progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
    let all = state.all.load(Ordering::Relaxed);
    match progress {
        Some(progress) if all > 0 => {
            progress.call1((state.done.load(Ordering::Relaxed), all))?;
            Ok(())
        }
        _ => Ok(()),
    }
}
